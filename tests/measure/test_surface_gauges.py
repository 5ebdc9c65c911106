"""Gauges that stay on a surface: its position, its side, and the velocity of a free surface."""

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.measure.surfaces import surfaces
from hydro2d.solver.simulation import Simulation
from tests.restarts import restarted

DECK = """
[mesh]
geometry = "planar"
r = [{ to = "2 mm", cells = 4 }]
z_start = "-3 mm"
z = [{ to = "8 mm", size = "0.1 mm" }]
[boundaries]
r_max = "wall"
[[body]]
name = "flyer"
material = "Al5083"
shape = "plate"
z_front = "-2.03 mm"
thickness = "2 mm"
velocity = "400 m/s"
[[body]]
name = "target"
material = "Al5083"
shape = "plate"
z_front = 0.0
thickness = "4.04 mm"
[[gauge]]
name = "rear"
r = "1 mm"
z = "4 mm"
surface = "target"
[[gauge]]
name = "tail"
r = "1 mm"
z = "-2 mm"
surface = "flyer"
[failure]
tensile = "none"
[stop]
time = "2 us"
"""


def test_the_ends_of_a_body_on_a_line():
    edges = np.linspace(0.0, 1.0, 11)
    column = np.array([0.0, 0.3, 1.0, 1.0, 0.8, 0.1, 0.0, 0.0, 0.6, 1.0])
    ends = surfaces(column, edges)
    assert ends == [(pytest.approx(0.17), -1), (pytest.approx(0.49), 1), (pytest.approx(0.84), -1)]
    assert surfaces(np.ones(4), np.arange(5.0)) == surfaces(np.zeros(4), np.arange(5.0)) == []


def test_the_place_of_a_surface_is_smooth_as_it_moves():
    edges = np.linspace(0.0, 1.0, 11)
    for end in np.linspace(0.35, 0.75, 41):
        column = np.clip((end - edges[:-1]) / 0.1, 0.0, 1.0)
        ((position, side),) = surfaces(column, edges)
        assert (position, side) == (pytest.approx(end, abs=1e-12), 1)


def test_a_gauge_begins_on_the_nearest_surface():
    sim = Simulation(decks.loads(DECK))
    np.testing.assert_allclose(sim.stations.places[:, 1], [4.04e-3, -2.03e-3], atol=1e-9)
    assert sim.stations.measure()["gauge_tail"]["velocity_z_m_s"] == pytest.approx(400.0)


def test_the_velocity_of_a_free_surface():
    """A flyer of the same material: after the release the rear moves with the flyer's velocity, less the elastic precursor."""
    sim, way, peak = Simulation(decks.loads(DECK)), 0.0, 0.0
    while sim.time < 1.5e-6:
        sim.step()
        speed = sim.stations.measure()["gauge_rear"]["velocity_z_m_s"]
        way, peak = way + speed * sim.dt, max(peak, speed)
    measured = sim.stations.measure()["gauge_rear"]
    assert measured["z_m"] - 4.04e-3 == pytest.approx(way, rel=0.02)
    assert 0.93 * 400.0 < peak < 1.03 * 400.0
    assert measured["peak_speed_m_s"] >= peak
    assert abs(measured["pressure_Pa"]) < 0.1 * sim.stations.measure()["gauge_rear"]["peak_pressure_Pa"] + 1e9


def test_it_continues_from_a_restart_to_the_same_bits():
    sim = Simulation(decks.loads(DECK))
    for _ in range(60):
        sim.step()
    other = restarted(sim)
    for each in (sim, other):
        for _ in range(20):
            each.step()
    assert sim.stations.places.tobytes() == other.stations.places.tobytes()
    assert sim.stations.measure() == other.stations.measure()


def test_a_surface_that_has_gone_is_nowhere():
    sim = Simulation(decks.loads(DECK))
    sim.state.vof[1] = 0.0
    sim.stations.record(sim.engine.given)
    measured = sim.stations.measure()["gauge_rear"]
    assert measured["z_m"] is None
    assert measured["velocity_z_m_s"] is None
    sim.stations.record(sim.engine.given)
    assert sim.stations.measure()["gauge_rear"]["z_m"] is None


def test_it_does_not_jump_to_another_surface():
    """The rear of the target is cut off by five cells: the surface there is another one."""
    sim = Simulation(decks.loads(DECK))
    z = sim.grid.zc[sim.grid.inside[0]]
    sim.grid.interior(sim.state.vof)[1][z > 3.5e-3] = 0.0
    sim.stations.record(sim.engine.given)
    assert sim.stations.measure()["gauge_rear"]["z_m"] is None


def test_a_gauge_along_r():
    text = DECK.replace('geometry = "planar"', "").replace('shape = "plate"', 'shape = "plate"\nradius = "1.4 mm"')
    sim = Simulation(decks.loads(text, ["gauge.rear.along=r", "gauge.rear.r=0.9 mm", "gauge.rear.z=2 mm"]))
    np.testing.assert_allclose(sim.stations.places[0], [1.4e-3, 2e-3], atol=3e-5)


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("gauge.rear.surface=targt", 'unknown body "targt"'),
        ("gauge.rear.along=z", ""),
        ("gauge.rear.along=x", "along"),
    ],
)
def test_refused_gauges(override, said):
    if not said:
        assert decks.loads(DECK, [override]).gauge[0].along == "z"
        return
    with pytest.raises(DeckError, match=said):
        decks.loads(DECK, [override])
    with pytest.raises(DeckError, match="along is for a gauge on a surface"):
        decks.loads(DECK.replace('surface = "target"', 'along = "r"'))


def test_a_body_without_a_surface_on_the_line_is_refused():
    with pytest.raises(DeckError, match='gauge "rear": "target" has no surface within the mesh on the line z = 0.002 m'):
        Simulation(decks.loads(DECK, ["gauge.rear.along=r", "gauge.rear.z=2 mm"]))


THIN = """
[mesh]
r = [{ to = "0.5 mm", size = "0.1 mm" }]
z = [{ to = "4 mm", size = "0.1 mm" }]
[boundaries]
r_max = "wall"
[[body]]
name = "foil"
material = "Al5083"
shape = "box"
z = ["1.03 mm", "END mm"]
velocity = "1000 m/s"
[[gauge]]
name = "front"
r = "0.2 mm"
z = "1.2 mm"
surface = "foil"
[[gauge]]
name = "back"
r = "0.2 mm"
z = "1 mm"
surface = "foil"
[failure]
tensile = "none"
[stop]
time = "2 us"
"""


@pytest.mark.parametrize("thickness", [0.03, 0.06, 0.09, 0.15])
def test_gauges_stay_on_a_body_narrower_than_a_cell(thickness):
    """Over ten cells of flight: both surfaces, and the velocity of the foil between them."""
    sim = Simulation(decks.loads(THIN.replace("END", f"{1.03 + thickness}")))
    places = np.array([1.03 + thickness, 1.03]) * 1e-3
    np.testing.assert_allclose(sim.stations.places[:, 1], places, atol=1e-9)
    while sim.time < 1e-6:
        sim.step()
        off = np.abs(sim.stations.places[:, 1] - places - 1000.0 * sim.time)
        assert off.max() < 1e-5, "a tenth of a cell"
    for name in ("front", "back"):
        assert sim.stations.measure()[f"gauge_{name}"]["velocity_z_m_s"] == pytest.approx(1000.0, rel=1e-9)


def test_a_gauge_finds_no_surface_of_a_crumb():
    with pytest.raises(DeckError, match="has no surface within the mesh"):
        Simulation(decks.loads(THIN.replace("END", "1.0309")))


def test_a_ring_has_two_surfaces_along_r():
    text = THIN.replace("END", "2").replace('z = ["1.03', 'r = ["0.23 mm", "0.26 mm"]\nz = ["1.03')
    text = text.replace('r = "0.2 mm"\nz = "1.2 mm"', 'r = "0.3 mm"\nz = "1.5 mm"\nalong = "r"')
    text = text.replace('z = "1 mm"', 'z = "1.5 mm"\nalong = "r"')
    sim = Simulation(decks.loads(text))
    np.testing.assert_allclose(sim.stations.places[:, 0], [0.26e-3, 0.23e-3], atol=1e-9)
