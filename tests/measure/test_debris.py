"""Debris behind a plate: masses, speeds, angles and fragments of bodies present from the start."""

import math

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.output.history import History, read, read_craters, read_debris
from hydro2d.solver.simulation import Simulation

DECK = """
numbers = "SI"
[mesh]
r = [{ to = "20 mm", cells = 40 }]
z_start = "-15 mm"
z = [{ to = "25 mm", cells = 80 }]
[[body]]
name = "ball"
material = "W_alloy"
shape = "sphere"
centre = "-6.3 mm"
radius = "5 mm"
velocity = "800 m/s"
[[body]]
name = "plate"
material = "Al5083"
shape = "plate"
z_front = 0.0
thickness = "4 mm"
[[body]]
name = "plug"
material = "Al5083"
shape = "box"
r = [0.0, "2 mm"]
z = ["8 mm", "10 mm"]
velocity = "300 m/s"
[[body]]
name = "ring"
material = "W_alloy"
shape = "box"
r = ["8 mm", "10 mm"]
z = ["12 mm", "13 mm"]
velocity = ["100 m/s", "100 m/s"]
[[body]]
name = "wall"
material = "Al5083"
shape = "plate"
z_front = "20 mm"
thickness = "3 mm"
[penetration]
rod = "ball"
targets = ["plate", "wall"]
[stop]
time = "10 us"
"""
PLUG = 2660.0 * math.pi * 0.002**2 * 0.002
RING = 18160.0 * math.pi * (0.010**2 - 0.008**2) * 0.001


def debris(*overrides):
    return Simulation(decks.loads(DECK, list(overrides))).debris()


def test_the_totals():
    totals = debris()["plate"].totals
    assert totals["mass_kg"] == pytest.approx(PLUG + RING, rel=1e-12)
    assert totals["momentum_N_s"] == pytest.approx(300.0 * PLUG + 100.0 * RING, rel=1e-12)
    assert totals["kinetic_energy_J"] == pytest.approx(0.5 * (300.0**2 * PLUG + 2.0 * 100.0**2 * RING), rel=1e-12)
    assert totals["velocity_m_s"] == pytest.approx(totals["momentum_N_s"] / totals["mass_kg"], rel=1e-12)
    assert totals["leading_velocity_m_s"] == pytest.approx(300.0)
    assert totals["cone_angle_rad"] == pytest.approx(math.pi / 4.0)  # the ring is most of the mass
    assert totals["fragments"] == 2
    assert totals["largest_fragment_kg"] == pytest.approx(RING, rel=1e-12)
    assert totals["dust_kg"] == pytest.approx(0.0, abs=1e-15)


def test_the_distributions_and_the_fragments():
    behind = debris()["plate"]
    assert behind.bodies == ["plug", "ring"]
    np.testing.assert_allclose(behind.by_speed.sum(axis=0), [PLUG, RING], rtol=1e-12)
    np.testing.assert_allclose(behind.by_angle.sum(axis=0), [PLUG, RING], rtol=1e-12)
    assert behind.speeds[np.nonzero(behind.by_speed[:, 0])[0][0] + 1] == pytest.approx(300.0)
    inside = np.nonzero(behind.by_angle[:, 1])[0]
    assert behind.angles[inside[0]] <= math.pi / 4.0 + 1e-12 <= behind.angles[inside[0] + 1] + 1e-9
    np.testing.assert_allclose(behind.fragments[0], [RING, 9.03e-3, 12.5e-3, 100.0, 100.0], rtol=5e-3)
    np.testing.assert_allclose(behind.fragments[1, 3:], [0.0, 300.0], atol=1e-9)
    assert behind.kinds.tolist() == [1, 0]


@pytest.mark.parametrize("z", [("8.1 mm", "8.3 mm"), ("8.35 mm", "8.65 mm")], ids=["in a cell", "in two"])
def test_a_piece_that_is_narrower_than_a_cell_is_a_fragment(z):
    totals = debris(f"body.plug.z={list(z)}")["plate"].totals
    assert (totals["fragments"], totals["dust_kg"]) == (2, pytest.approx(0.0, abs=1e-15))


def test_crumbs_are_dust():
    totals = debris('body.plug.z=["8.1 mm", "8.104 mm"]')["plate"].totals
    assert (totals["fragments"], totals["dust_kg"]) == (1, pytest.approx(PLUG * 0.002, rel=1e-9))


def test_the_last_target_has_nothing_behind_it():
    behind = debris()["wall"]
    assert (behind.bodies, behind.totals["mass_kg"], behind.totals["fragments"]) == ([], 0.0, 0)
    assert behind.totals["velocity_m_s"] is None
    assert behind.by_speed.shape == (40, 0)


def test_a_piece_of_a_plate_that_still_holds_is_none():
    """A plate that extends beyond its rear face by something joined to it has no debris there."""
    behind = debris("body.plug.join=plate", "body.plug.velocity=0", "body.plug.z=['3 mm', '6 mm']")["plate"]
    assert behind.bodies == ["ring"]


def test_debris_that_flies_down_is_counted_along_its_flight():
    turned = DECK
    for old, new in (('centre = "-6.3 mm"', 'centre = "16.3 mm"'), ('velocity = "800 m/s"', 'velocity = "-800 m/s"'),
                     ('z = ["8 mm", "10 mm"]', 'z = ["-6 mm", "-4 mm"]'), ('velocity = "300 m/s"', 'velocity = "-300 m/s"'),
                     ('z = ["12 mm", "13 mm"]', 'z = ["-9 mm", "-8 mm"]'),
                     ('["100 m/s", "100 m/s"]', '["100 m/s", "-100 m/s"]'),
                     ('z_front = "20 mm"', 'z_front = "-14 mm"')):
        assert old in turned
        turned = turned.replace(old, new)
    behind = Simulation(decks.loads(turned)).debris()["plate"]
    straight = debris()["plate"]
    assert dict(behind.totals) == pytest.approx(dict(straight.totals))
    assert behind.fragments[0, 4] == pytest.approx(-100.0)


def test_the_file_has_the_debris_as_well_as_the_holes(tmp_path):
    sim, file = Simulation(decks.loads(DECK)), History(tmp_path / "history.h5")
    file.append({"time": 0.0, "P/L": 0.5})
    file.craters, file.debris = sim.holes(), sim.debris()
    file.write()
    stored = read_debris(file.path)
    assert list(stored) == ["plate", "wall"]
    assert list(stored["plate"]["body"]) == ["plug", "ring"]
    np.testing.assert_array_equal(stored["plate"]["mass_by_speed_kg"], file.debris["plate"].by_speed)
    np.testing.assert_array_equal(stored["plate"]["fragment_velocity_z_m_s"], file.debris["plate"].fragments[:, 4])
    assert list(read_craters(file.path)) == ["plate", "wall"]
    assert {name: column.tolist() for name, column in read(file.path).items()} == {"time": [0.0], "P/L": [0.5]}
