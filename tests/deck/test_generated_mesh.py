"""Meshes that a deck describes by `cells_across` and `reach`."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.study.plan import members, meshes

ROD = """
[[body]]
name = "rod"
shape = "rod"
nose = "hemispherical"
radius = "4 mm"
length = "40 mm"
tip = 0.0
material = "W_alloy"
velocity = "1 km/s"
"""
BODIES = {
    "rod": ROD,
    "back": ROD.replace("tip = 0.0", "tip = 0.0\ndirection = -1").replace('"1 km/s"', '"-1 km/s"'),
    "ball": '[[body]]\nname = "rod"\nshape = "sphere"\ncentre = "-4 mm"\nradius = "4 mm"\nmaterial = "W_alloy"\n'
            'velocity = "1 km/s"\n',
    "cylinder": '[[body]]\nname = "rod"\nshape = "box"\nr = [0.0, "4 mm"]\nz = ["-40 mm", 0.0]\nmaterial = "W_alloy"\n'
                'velocity = "1 km/s"\n',
    "disc": '[[body]]\nname = "rod"\nshape = "plate"\nz_front = "-4 mm"\nthickness = "4 mm"\nradius = "9 mm"\n'
            'material = "W_alloy"\nvelocity = "1 km/s"\n',
}
PLATE = '[[body]]\nname = "plate"\nshape = "plate"\nz_front = 0.0\nthickness = "300 mm"\nmaterial = "Al5083"\n'


def load(mesh: str, body: str = "rod", overrides=()) -> decks.Deck:
    plate = PLATE.replace("z_front = 0.0", 'z_front = "-300 mm"') if body == "back" else PLATE
    return decks.loads(f'[mesh]\n{mesh}\n{BODIES[body]}\n{plate}\n[stop]\ntime = "1 us"\n', overrides)


WORDS = 'cells_across = 8\nreach = "10 radii"'


@pytest.mark.parametrize("follow", ["", 'follow = "rod"'])
@pytest.mark.parametrize("body", BODIES)
def test_cells_across_and_reach_are_those_of_the_deck(body, follow):
    """8 cells across 4 mm; 10 radii ahead of the body and to its side; no jumps; an edge between cells at the leading end."""
    deck = load(f"{WORDS}\n{follow}", body)
    r, z = decks.edges(deck)
    reach = 10 * (9e-3 if body == "disc" else 4e-3)
    outer = 9e-3 if body == "disc" else 4e-3
    assert np.interp(4e-3, r, np.arange(len(r))) == pytest.approx(8.0)
    assert outer + reach <= r[-1] * (1 + 1e-9) <= (outer + reach) * 1.15
    ahead, behind = (-z[0], z[-1]) if body == "back" else (z[-1], -z[0])
    assert reach * (1 - 1e-9) <= ahead <= reach * 1.15
    length = 40e-3 if body in ("rod", "back", "cylinder") else 8e-3 if body == "ball" else 4e-3
    assert length < behind < length + 8e-3 + 16e-3
    assert np.abs(z).min() < 1e-12
    near = np.diff(z)[(z[:-1] > -length * 0.99) & (z[:-1] < 15e-3)] if body != "back" else np.diff(z)[np.abs(z[:-1]) < 15e-3]
    assert near == pytest.approx(0.5e-3)
    for edges in (r, z):
        sizes = np.diff(edges)
        assert np.maximum(sizes[1:] / sizes[:-1], sizes[:-1] / sizes[1:]).max() < 1.1 + 1e-9
    assert not [text for text in decks.warnings(deck) if "cells across" in text or "differ" in text]


def test_the_resolved_deck_has_segments_and_is_read_to_the_same_bits():
    deck = load(f'{WORDS}\nfollow = "rod"')
    again = decks.loads(deck.to_toml())
    assert (deck.mesh.cells_across, deck.mesh.reach, deck.mesh.follow) == (None, None, "rod")
    assert all(np.array_equal(*pair) for pair in zip(decks.edges(deck), decks.edges(again), strict=True))


def test_the_mesh_begins_where_the_deck_says():
    """The mesh begins at a wall, with the same fine cells above it."""
    deck = load('z_start = "-45 mm"\n' + WORDS)
    z = decks.edges(deck)[1]
    assert z[0] == -45e-3
    assert np.diff(z)[z[:-1] < 0.0] == pytest.approx(0.5e-3)


def test_a_body_may_be_named_and_a_reach_may_be_a_length():
    by_plate = load('cells_across = 60\nreach = "30 mm"\nacross = "plate"')
    r, z = decks.edges(by_plate)
    assert np.diff(r).min() == pytest.approx(5e-3)
    assert z[-1] == pytest.approx(330e-3)


@pytest.mark.parametrize(
    ("mesh", "said"),
    [
        ("cells_across = 8", "mesh: reach missing"),
        ('reach = "10 radii"', "mesh: cells_across missing"),
        ("", "mesh: r and z missing: a mesh needs r and z, its segments, or cells_across and reach"),
        ('z = [{to = "1 cm", cells = 10}]', "mesh: r missing"),
        (WORDS + '\nr = [{to = "1 cm", cells = 10}]', "cells_across and r are both given"),
        ('cells_across = 8\nreach = "ten radii"', "mesh.reach: "),
        ('cells_across = 8\nreach = "-1 radii"', "must be positive"),
        ('cells_across = 8\nreach = "10 s"', "mesh.reach: \"10 s\" is a time; expected a length"),
        (WORDS + '\nacross = "ball"', 'mesh.across: unknown body "ball"'),
        (WORDS + '\nacross = "plate"', 'mesh.reach: "plate" has no radius; give a length'),
        ('cells_across = 8\nreach = "900 km"', "mesh.reach: would need"),
    ],
)
def test_mistakes_are_reported(mesh, said):
    with pytest.raises(decks.DeckError, match=r"deck\.toml:\d+: ") as caught:
        load(mesh)
    assert said in str(caught.value)


def test_an_override_changes_the_cells_and_none_gives_way_to_segments():
    finer = load(WORDS, overrides=["mesh.cells_across=16"])
    assert np.diff(decks.edges(finer)[0]).min() == pytest.approx(0.25e-3)
    own = ['mesh.reach="none"', 'mesh.r=[{to="20 mm", cells=10}]', 'mesh.z=[{to="60 mm", cells=10}]', 'mesh.z_start="-50 mm"']
    assert len(decks.edges(load(WORDS, overrides=own))[0]) == 11


def test_members_and_finer_meshes_of_such_a_deck():
    """A shift by 0.3 of a cell, a flank a tenth of a cell farther in, and 4 cells instead of 8."""
    deck = load(f'{WORDS}\nfollow = "rod"')
    given = members.overrides(deck, {"mesh offset": 0.3, "flank offset": 0.1})
    changed = load(f'{WORDS}\nfollow = "rod"', overrides=given)
    (r, z), (new_r, new_z) = decks.edges(deck), decks.edges(changed)
    assert new_z - z == pytest.approx(0.15e-3, abs=1e-12)
    assert np.interp(4e-3, new_r, np.arange(len(r))) == pytest.approx(8.1)
    coarse = load(f'{WORDS}\nfollow = "rod"', overrides=meshes.settings(deck, 4))
    assert np.diff(decks.edges(coarse)[0]).min() == pytest.approx(1e-3)
    assert members.overrides(deck, {"first step": 0.999}) == ["numerics.initial_dt_factor=0.0999"]
