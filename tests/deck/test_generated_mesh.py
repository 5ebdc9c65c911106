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
        (WORDS + '\nz = [{to = "1 cm", cells = 10}]', "reach and z are both given"),
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


GRADED = f'{WORDS}\nfollow = "rod"\nfine = "3 radii"'


def longer(mesh: str, body: str = "rod", **changes) -> decks.Deck:
    """The deck with a rod of 100 mm."""
    return load(mesh, body, overrides={"body.rod.length": "100 mm", **changes})


def mirrored(edges: np.ndarray) -> np.ndarray:
    return -edges[::-1]


def test_cells_along_a_rod_are_fine_near_its_nose():
    """3 radii behind the nose and 5 ahead have cells of 0.5 mm; farther back no cell is more than a tenth larger than the one
    before, or than 2 mm; the ends of the mesh and the cells ahead are those of the mesh without grading."""
    even, graded = (decks.edges(longer(mesh)) for mesh in (GRADED.replace("3 radii", "none"), GRADED))
    r, z = graded
    assert np.array_equal(r, even[0])
    sizes = np.diff(z)
    assert sizes[(z[:-1] > -12.01e-3) & (z[1:] < 20.01e-3)] == pytest.approx(0.5e-3)
    assert sizes[z[1:] < -11.99e-3].min() > 0.5e-3 * 1.09
    assert 1.7e-3 < sizes[z[1:] <= 0].max() <= 2e-3
    assert sizes[:20] == pytest.approx(sizes[0], rel=1e-12)
    assert np.maximum(sizes[1:] / sizes[:-1], sizes[:-1] / sizes[1:]).max() < 1.1 + 1e-9
    assert z[z > -1e-6] == pytest.approx(even[1][even[1] > -1e-6], abs=1e-15)
    assert even[1][0] - 2e-3 < z[0] < -100e-3 - 3.4 * 4e-3
    assert not [text for text in decks.warnings(longer(GRADED)) if "cells" in text]


def test_a_rod_that_flies_the_other_way_has_the_mesh_in_a_mirror():
    one, other = (decks.edges(longer(GRADED, body))[1] for body in ("rod", "back"))
    assert mirrored(other) == pytest.approx(one, abs=1e-12)


def test_a_graded_mesh_is_written_out_as_segments():
    """The resolved deck has them and the same bits and set-up; a user who writes them gets the same mesh."""
    deck = longer(GRADED)
    again = decks.loads(deck.to_toml())
    by_hand = longer(GRADED, **decks.written_segments(deck))
    assert deck.mesh.fine is None
    for other in (again, by_hand):
        assert other.setup == deck.setup
        assert all(np.array_equal(*pair) for pair in zip(decks.edges(deck), decks.edges(other), strict=True))
    assert deck.setup != longer(GRADED.replace("3 radii", "none")).setup


def test_segments_in_r_or_a_start_in_z_of_ones_own_with_a_graded_mesh():
    own = longer(GRADED + '\nr = [{to = "40 mm", cells = 20}]\nz_start = "-120 mm"')
    r, z = decks.edges(own)
    assert (len(r), z[0]) == (21, -120e-3)
    assert np.diff(z)[(z[:-1] > -12.01e-3) & (z[1:] < 20.01e-3)] == pytest.approx(0.5e-3)
    assert 1.5e-3 < np.diff(z)[0] <= 2e-3
    short = decks.edges(load(GRADED + '\nz_start = "-41 mm"', overrides={"mesh.fine": "39 mm"}))[1]
    assert (short[0], len(short[short < 1e-9])) == (-41e-3, 83)


def test_members_and_finer_meshes_of_a_graded_mesh():
    """A shift by 0.3 of a cell; with 16 cells across, all cells are half as large and the ends of segments stay."""
    deck = longer(GRADED)
    z = decks.edges(deck)[1]
    given = ["body.rod.length=100 mm", *members.overrides(deck, {"mesh offset": 0.3})]
    shifted = decks.edges(load(GRADED, overrides=given))[1]
    assert shifted - z == pytest.approx(0.15e-3, abs=1e-12)
    fine = decks.edges(longer(GRADED, **meshes.settings(deck, 16)))[1]
    assert np.diff(fine)[(fine[:-1] > -12.01e-3) & (fine[1:] < 20.01e-3)] == pytest.approx(0.25e-3)
    assert len(fine) - 1 == pytest.approx(2 * (len(z) - 1), abs=2)


OTHER_ROD = ROD.replace('"rod"\nshape', '"sabot"\nshape').replace("tip = 0.0", 'tip = "-200 mm"')


@pytest.mark.parametrize(
    ("mesh", "body", "changes", "said"),
    [
        (GRADED.replace("3 radii", "41 mm"), "rod", {}, 'deck.toml:5: mesh.fine: is 0.041 m, and "rod" is 0.04 m long; give'),
        (GRADED.replace("3 radii", "0.4 mm"), "rod", {}, "fine: is 0.0004 m, less than one cell of 0.0005 m; 7 radii"),
        (GRADED.replace("3 radii", "-1 mm"), "rod", {}, "mesh.fine: must be positive"),
        (GRADED.replace("3 radii", "long"), "rod", {}, "mesh.fine: "),
        (GRADED, "ball", {}, 'mesh.fine: is for a body of shape "rod"; "rod" is a sphere: leave fine out'),
        (GRADED, "rod", {"mesh.across": "plate", "mesh.reach": "9 mm"}, 'shape "rod"; "plate" is a plate: leave fine out'),
        (GRADED + OTHER_ROD, "rod", {}, 'is for a rod that flies alone; "sabot" moves as well: leave fine out, or'),
        (GRADED, "rod", {"body.rod.direction": -1}, 'mesh.fine: "rod" flies tail first; give it direction = 1, or'),
        (GRADED, "rod", {"mesh.follow": "none"}, 'a mesh that does not follow it; add follow = "rod" or leave fine out'),
        (GRADED, "rod", {"mesh.follow": "arrow"}, 'mesh.follow: unknown body "arrow"'),
        (GRADED, "rod", {"mesh.geometry": "planar"}, "mesh.fine: is for a rod on the axis of a cylindrical mesh; leave it"),
        (GRADED + '\nz = [{to = "1 cm", cells = 10}]', "rod", {}, "fine and z are both given (z = [] cancels the segments"),
        ('fine = "3 radii"', "rod", {}, "mesh: cells_across and reach missing"),
    ],
)
def test_mistakes_with_a_graded_mesh_are_reported_in_one_line(mesh, body, changes, said):
    with pytest.raises(decks.DeckError) as caught:
        load(mesh, body, overrides=changes)
    assert said in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


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
