"""Warnings about features thinner than a few cells: bodies, coats, layers and gaps, where they are and where they fly to."""

import re

import pytest

from hydro2d.deck import deck

MESH = '[mesh]\nr = [{ to = "4 mm", size = "0.1 mm" }]\nz = [{ to = "4 mm", size = "0.1 mm" }]\n'
GRADED = '[mesh]\nr = [{ to = "4 mm", size = "0.5 mm" }]\n' \
         'z = [{ to = "5 mm", size = "0.5 mm" }, { to = "80 mm", ratio = 1.1 }]\n'
BACKWARDS = '[mesh]\nz_start = "-80 mm"\nr = [{ to = "4 mm", size = "0.5 mm" }]\n' \
            'z = [{ to = "-5 mm", first = "7.25 mm", last = "0.55 mm" }, { to = 0.0, size = "0.5 mm" }]\n'
FOLLOWING = '[mesh]\nfollow = "rod"\nr = [{ to = "4 mm", size = "0.1 mm" }]\nz_start = "-3 mm"\n' \
            'z = [{ to = "2 mm", size = "0.1 mm" }, { to = "12 mm", ratio = 1.1 }]\n'
REST = '[stop]\ntime = "36 us"\n[failure]\ntensile = "none"\n'
ALWAYS = "; stresses and waves in it need at least 4"
CLOSED = "; material beside a gap thinner than a cell may close it"


def body(name, rest, velocity=0, material="Al5083"):
    return f'[[body]]\nname = "{name}"\nmaterial = "{material}"\nvelocity = "{velocity} m/s"\n{rest}\n'


def box(name, z, velocity=0, r=("0 mm", "3 mm"), more=""):
    return body(name, f'shape = "box"\nr = ["{r[0]}", "{r[1]}"]\nz = ["{z[0]} mm", "{z[1]} mm"]\n{more}', velocity)


def ball(name, z, radius, velocity=0, more=""):
    return body(name, f'shape = "sphere"\ncentre = "{z} mm"\nradius = "{radius} mm"\n{more}', velocity)


def told(mesh, *bodies):
    texts = deck.warnings(deck.loads(mesh + "".join(bodies) + REST))
    return [text for text in texts if "cells across" in text or "gap" in text]


@pytest.mark.parametrize(
    ("bodies", "warned"),
    [
        ([box("foil", (0.53, 0.56))], [f'body "foil": 0.3 cells across it along z{ALWAYS}']),
        ([box("hot", (0.5, 0.8), r=("0 mm", "0.3 mm"))],
         [f'body "hot": 3.0 cells across it along r, 3.0 cells across it along z{ALWAYS}']),
        ([box("layer", (1.03, 1.06)), box("rear", (0.2, 1.03)), box("front", (1.06, 2.2))],
         [f'body "layer": 0.3 cells across it along z{ALWAYS}']),
        ([box("core", (0.5, 3.5), r=("0 mm", "2 mm")), box("coat", (0.47, 3.53), r=("0 mm", "2.05 mm"))],
         [f'body "coat": 0.5 cells across it along r{ALWAYS}']),
        ([box("core", (0.5, 3.5), r=("0 mm", "2 mm")), box("coat", (0.5, 3.5), r=("2 mm", "2.07 mm"))],
         [f'body "coat": 0.7 cells across it along r{ALWAYS}']),
        ([box("near", (0.5, 0.9)), box("far", (0.9, 0.95), more='join = "near"')], []),
        ([ball("ball", 2, 0.5)], []),
    ],
)
def test_bodies_coats_and_layers(bodies, warned):
    assert told(MESH, *bodies) == warned


def test_the_wall_of_a_shell_counts_and_not_its_diameter():
    (text,) = told(MESH, ball("shell", 2, 1.5, more='inner_radius = "1.46 mm"'))
    assert 0.4 <= float(re.match(r'body "shell": ([\d.]+) cells', text).group(1)) < 0.6
    assert told(MESH, ball("shell", 2, 1.5, more='inner_radius = "0.8 mm"')) == []


@pytest.mark.parametrize(
    ("bodies", "warned"),
    [
        ([box("rear", (0.2, 1.03), 1000), box("front", (1.09, 2), 1000)],
         [f'gap of 0.6 cells along z between "rear" and "front"{CLOSED}']),
        ([box("b", (0.5, 1.03), 1000), box("c", (1.06, 2.3), 1000, more='join = "b"')],
         [f'gap of 0.3 cells along z in "b"{CLOSED}']),
        ([box("rod", (0.5, 3), r=("0 mm", "1 mm")), box("sleeve", (0.5, 3), r=("1.05 mm", "2 mm"))],
         [f'gap of 0.5 cells along r between "rod" and "sleeve"{CLOSED}']),
        ([box("tube", (0.5, 3), r=("0.06 mm", "1 mm"))], [f'gap of 0.6 cells along r in "tube"{CLOSED}']),
        ([box("tube", (0.5, 3), r=("0.1 mm", "1 mm"))], []),
        ([ball("ball", 2, 1, more='inner_radius = "0.03 mm"')], [f'gap of 0.3 cells along r in "ball"{CLOSED}']),
        ([box("rear", (0.2, 1.03), 1000), box("front", (1.09, 2))], []),
        ([box("rear", (0.2, 1.03), 1000), box("front", (1.15, 2), 1000)], []),
        ([box("rear", (0.2, 1.03), 1000), box("front", (1.03, 2), 1000)], []),
        ([ball("ball", 1, 0.9), box("plate", (1.9, 3))], []),
        ([body("cone", 'shape = "polygon"\npoints = [[0, "0.5 mm"], [0, "1.9 mm"], ["2 mm", "1.85 mm"], ["2 mm", "0.5 mm"]]'),
          box("plate", (1.9, 3))], []),
        ([box("rear", (0.2, 1.03)), box("filler", (1.03, 1.09)), box("front", (1.09, 2))],
         [f'body "filler": 0.6 cells across it along z{ALWAYS}']),
    ],
)
def test_gaps_and_slits(bodies, warned):
    """Gaps that their bodies close by themselves do not count, nor do wedges next to a point of contact."""
    assert told(MESH, *bodies) == warned


@pytest.mark.parametrize(("core", "warned"), [("1.75", "2.5"), ("1.7", None)])
def test_the_wall_of_a_jacket_needs_three_cells(core, warned):
    rods = [body(name, f'shape = "rod"\nradius = "{radius} mm"\nlength = "3 mm"\ntip = "3.5 mm"')
            for name, radius in (("core", core), ("jacket", 2))]
    expected = [f'body "jacket": {warned} cells across it along r; stresses and waves in it need at least 3'] if warned else []
    assert told(MESH, *rods) == expected


@pytest.mark.parametrize("sign", [1, -1])
def test_cells_are_counted_where_a_body_flies(sign):
    """The witness is hit at 40 mm; cells beyond it do not count."""
    plug, witness = sorted((sign * 1.25, sign * 2.75)), sorted((sign * 40, sign * 60))
    mesh = GRADED if sign > 0 else BACKWARDS
    (text,) = told(mesh, box("plug", plug, 1000 * sign), box("witness", witness))
    flown = 'body "plug": 3.0 cells across it along z and (.*) at z = (.*) mm, which it reaches after (.*) us'
    match = re.fullmatch(flown + ALWAYS, text)
    cells, place, time = (float(number) for number in match.groups())
    assert 34 < time <= 36
    assert place == pytest.approx(sign * (2 + time), abs=0.06)
    z = deck.edges(deck.loads(mesh + box("plug", plug) + REST))[1]
    assert cells == pytest.approx(deck.cells_between(z, 1e-3 * place - 0.75e-3, 1e-3 * place + 0.75e-3), abs=0.01)
    slow = told(mesh, box("plug", plug, 10 * sign), box("witness", witness))
    assert slow == [f'body "plug": 3.0 cells across it along z{ALWAYS}']


def test_a_gap_may_fly_into_larger_cells():
    (text,) = [text for text in told(GRADED, box("rear", (0, 2), 1000), box("front", (2.6, 4.8), 1000)) if "gap" in text]
    assert text.startswith("gap of 0.")
    assert 'along z between "rear" and "front" at z = ' in text


def test_a_flight_ends_at_what_the_first_body_of_the_same_velocity_meets():
    """A body behind another one goes no further than that one."""
    assert told(GRADED, box("rear", (0, 2), 1000), box("front", (2, 4.4), 1000), box("witness", (4.5, 60))) == []


def test_a_mesh_that_follows_a_body():
    """A body that moves with the mesh keeps its cells; a body ahead counts where the first one reaches it."""
    rod = box("rod", (-2, -0.5), 1000, r=("0 mm", "1 mm"))
    assert told(FOLLOWING, rod) == []
    for z in ((1, 1.03), (9, 9.03), (25, 25.03)):
        assert told(FOLLOWING, rod, box("layer", z)) == [
            f'body "layer": 0.3 cells across it along z where "rod" reaches it{ALWAYS}'], z
    assert told(FOLLOWING, rod, box("layer", (9, 9.5))) == []
    assert told(FOLLOWING, rod, box("one", (25, 26)), box("two", (26.05, 27))) == [
        f'gap of 0.5 cells along z between "one" and "two" where "rod" reaches it{CLOSED}']
