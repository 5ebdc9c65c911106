"""Detonations in decks: light times in bodies, messages for decks, what burns and what stays as it is."""

import math

import numpy as np
import pytest

from eos import jwl
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.mesh.fields import INTERNAL
from hydro2d.running.check import check
from hydro2d.solver.simulation import Simulation
from tests.restarts import restarted

TEXT = """
[mesh]
r = [{ to = "10 mm", cells = 20 }]
z = [{ to = "20 mm", cells = 40 }]
[boundaries]
z_min = "wall"
[[body]]
name = "plug"
material = "copper_OFHC"
shape = "box"
r = ["0 mm", "5 mm"]
z = ["10 mm", "12 mm"]
[[body]]
name = "charge"
material = "TNT"
shape = "box"
r = ["0 mm", "8 mm"]
z = ["0 mm", "18 mm"]
[[source]]
name = "fuse"
kind = "detonation"
body = "charge"
points = [["0 mm", "0 mm", "0 us"]]
[numerics]
advection = "both"
[failure]
tensile = "none"
[stop]
time = "1 us"
"""


def light(simulation, variable=jwl.LIGHT):
    return simulation.grid.interior(simulation.state.q[INTERNAL + variable, 1])


def test_light_times_are_straight_and_bend_around_the_plug():
    simulation = Simulation(deck.loads(TEXT))
    times, grid = light(simulation), simulation.grid
    rows, columns = grid.inside
    r, z = grid.rc[columns], grid.zc[rows]
    assert times[19, 3] == pytest.approx(math.hypot(r[3], z[19]) / 6930.0, rel=1e-12)
    behind = math.hypot(5e-3, 10e-3) + 2e-3 + math.hypot(5e-3 - r[0], z[30] - 12e-3)
    assert behind - 1e-6 < times[30, 0] * 6930.0 < behind + 0.5e-3
    far = np.hypot(*np.meshgrid(r[:16], z[:20])) > 0.8e-3
    np.testing.assert_allclose(light(simulation, jwl.BURN_TIME)[:20, :16][far], 2.5 * 0.5e-3 / 6930.0, rtol=1e-12)
    assert simulation.warnings == []


def test_an_own_speed_and_width_and_several_sources():
    second = TEXT[TEXT.index("[[source]]"): TEXT.index("[numerics]")].replace("fuse", "other").replace(
        '["0 mm", "0 mm", "0 us"]', '["8 mm", "18 mm", "1 us"]')
    simulation = Simulation(deck.loads(TEXT + second, ["source.fuse.speed=4000 m/s", "source.fuse.widths=3"]))
    times, duration = light(simulation), light(simulation, jwl.BURN_TIME)
    assert times[0, 2] == pytest.approx(math.hypot(1.25e-3, 0.25e-3) / 4000.0, rel=1e-12)
    assert duration[0, 2] == pytest.approx(3 * 0.5e-3 / 4000.0)
    assert times[33, 15] == pytest.approx(1e-6 + math.hypot(0.25e-3, 1.25e-3) / 6930.0, rel=1e-12)
    assert duration[33, 15] == pytest.approx(2.5 * 0.5e-3 / 6930.0)


def test_nothing_burns_before_its_point_is_lit():
    """The cells at a point start to burn with it, and have burnt at the expected time; also if it is lit later."""
    simulation = Simulation(deck.loads(TEXT, ['source.fuse.points=[[0, 0, 0], ["8 mm", "18 mm", "1 us"]]']))
    times, duration = light(simulation), light(simulation, jwl.BURN_TIME)
    arrival, whole = math.hypot(0.25e-3, 0.25e-3) / 6930.0, 2.5 * 0.5e-3 / 6930.0
    for cell, start in (((0, 0), 0.0), ((35, 15), 1e-6)):
        assert times[cell] - jwl.LEAD * duration[cell] == pytest.approx(start, abs=1e-15)
        assert times[cell] + (1.0 - jwl.LEAD) * duration[cell] == pytest.approx(start + arrival + (1.0 - jwl.LEAD) * whole)


def test_the_reach_limits_what_is_lit():
    simulation = Simulation(deck.loads(TEXT, ['source.fuse.z=["0 mm", "6 mm"]']))
    assert (light(simulation)[:12, :16] < 2e-6).all()
    assert (light(simulation)[12:, :16] == jwl.NEVER).all()


@pytest.mark.parametrize(("override", "words"), [
    ("source.fuse.body=plug", r'source\[0\].body: body "plug" is no explosive: the equation of state of copper_OFHC is mie-'),
    ("source.fuse.points=[]", r"source\[0\].points: .*expected a table of 1 to 1000 rows"),
    ("source.fuse.points=[[0, 0]]", r"row 0 is not \[r, z, time\]"),
    ('source.fuse.points=[[0, 0, "1 mm"]]', "row 0: .*is a length; expected a time"),
    ("source.fuse.points=[[0, 0, 0], [0, 0, '-1 us']]", "the time of row 1 must not be negative"),
    ("source.fuse.speed=0", "must be positive"),
    ("body.charge.energy=1 MJ/kg", r"body\[1\].energy: would replace the energy of the detonation"),
    ("source.fuse.kind=burn", r"unknown kind .burn. \(allowed: acceleration, detonation, heating\)"),
])
def test_wrong_tables(override, words):
    with pytest.raises(DeckError, match=words):
        deck.loads(TEXT, [override])


@pytest.mark.parametrize("point", ['"9 mm", "2 mm"', '"2 mm", "11 mm"', '"0 mm", "-3 mm"', '"0 mm", "25 mm"'])
def test_a_point_outside_of_the_explosive(point):
    loaded = deck.loads(TEXT, [f'source.fuse.points=[[{point}, 0]]'])
    for start in (check, Simulation):
        with pytest.raises(DeckError, match=r'source "fuse": the point .* lies outside of its explosive, body "charge"$'):
            start(loaded)


@pytest.mark.parametrize("point", ['"8 mm", "18 mm"', '"8 mm", "0 mm"', '"5 mm", "10 mm"'])
def test_a_point_on_the_surface_is_inside(point):
    assert Simulation(deck.loads(TEXT, [f'source.fuse.points=[[{point}, 0]]'])).warnings == []


def test_an_explosive_that_nothing_lights():
    loaded = deck.loads(TEXT.replace(TEXT[TEXT.index("[[source]]"): TEXT.index("[numerics]")], ""))
    said = 'body "charge": an explosive without a source of kind "detonation"; nothing lights it'
    assert said in deck.warnings(loaded)
    assert said in check(loaded).warnings
    assert said not in deck.warnings(deck.loads(TEXT))


def test_parts_that_no_detonation_reaches():
    """A plug as wide as the charge: a third of it, 6 of 16 mm, lies behind."""
    loaded = deck.loads(TEXT, ['body.plug.r=["0 mm", "8 mm"]'])
    said = [f'source "fuse": no detonation reaches {6 / 16:.2%} of body "charge", which does not burn']
    assert Simulation(loaded).warnings == said
    assert [text for text in check(loaded).warnings if "fuse" in text] == said


def test_a_mesh_that_follows_is_refused():
    with pytest.raises(DeckError, match=r"source\[0\].kind: a detonation lights what is in the mesh at the start"):
        deck.loads(TEXT, ["mesh.follow=plug", "body.plug.velocity=100 m/s", "boundaries.z_min=outflow"])


def test_energy_closes_and_what_is_not_lit_stays():
    simulation = Simulation(deck.loads(TEXT, ['body.plug.r=["0 mm", "8 mm"]']))
    start = simulation.audit.start.energy
    simulation.run()
    assert start == pytest.approx(7e9 * math.pi * 8e-3**2 * 16e-3 / (2.0 * math.pi), rel=1e-12)
    assert abs(simulation.conservation()["total_energy"]) < 1e-13
    burnt, lit = light(simulation, jwl.BURNT), light(simulation)
    assert (burnt[:8, :8] == 1.0).all()
    assert (burnt[25:34, :15] == 0.0).all()
    np.testing.assert_allclose(lit[25:34, :15], jwl.NEVER, rtol=1e-12)
    assert simulation.doubts() == []
    assert simulation.conservation()["kinetic_energy_J"] > 0.01 * start


def test_a_restart_burns_on_to_the_same_bits():
    first = Simulation(deck.loads(TEXT))
    while first.time < 0.4e-6:
        first.step()
    second = restarted(first)
    for _ in range(5):
        first.step()
        second.step()
    np.testing.assert_array_equal(first.grid.interior(first.state.q), second.grid.interior(second.state.q))
