"""Measurements of every body, and at tracers and gauges."""

import math
import re

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.materials import quantities
from hydro2d.measure import bodies, station_columns, tracers
from hydro2d.measure.summary import OF_EVERY_BODY, PROJECTILE, Summary
from hydro2d.mesh import sums
from hydro2d.output import derived_quantities
from hydro2d.results.reading import Results
from hydro2d.running.run import run
from hydro2d.solver.simulation import Simulation
from tests.decks import body, entry, mesh, plate, stop
from tests.restarts import restarted

DECK = (
    mesh(("20 mm", 40), ("-15 mm", "25 mm", 80))
    + body("ball", "W_alloy", "sphere", centre=[0.0, "-6.3 mm"], radius="5 mm", velocity="800 m/s")
    + plate("10 mm")
    + entry("tracer", name="mid", r=0.0, z="-5 mm")
    + entry("gauge", name="line", r=0.0, z="1.2 mm", z_end="9.2 mm", points=3)
    + entry("gauge", name="void", r="15 mm", z="-10 mm")
    + stop("10 us")
)
#: fields, and the equal quantities of stations
SAME = {"pressure": "pressure_Pa", "density": "density_kg_m3", "temperature": "temperature_K", "von_mises": "von_mises_Pa",
        "plastic_strain": "plastic_strain"}
MASS = 4.0 / 3.0 * math.pi * 0.005**3 * 18160.0


def started(cycles: int = 0, *overrides: str) -> Simulation:
    sim = Simulation(decks.loads(DECK, list(overrides)))
    for _ in range(cycles):
        sim.step()
    return sim


@pytest.fixture(scope="module")
def struck() -> Simulation:
    return started(160)


def test_a_ball_before_the_impact():
    measurement = bodies.measure(started())["ball"]
    assert measurement["mass_kg"] == pytest.approx(MASS, rel=1e-12)
    assert measurement["momentum_N_s"] == pytest.approx(800.0 * MASS, rel=1e-12)
    assert measurement["kinetic_energy_J"] == pytest.approx(0.5 * MASS * 800.0**2, rel=1e-12)
    assert measurement["velocity_m_s"] == pytest.approx(800.0, rel=1e-12)
    assert [measurement[key] for key in ("failed_mass_kg", "outflow_kg", "inflow_kg")] == [0.0, 0.0, 0.0]
    ends = [measurement[key] for key in ("r_min_m", "r_max_m", "z_min_m", "z_max_m")]
    assert ends == pytest.approx([0.0, 5e-3, -11.3e-3, -1.3e-3], abs=0.1e-3)


def test_a_run_calls_the_ball_a_ball_and_gives_one_number_for_each_thing(tmp_path, capsys):
    run(decks.loads(DECK, ["stop.cycles=160"]), tmp_path / "shot")
    said = capsys.readouterr().out
    assert re.search(r"^ball length  +\d", said, re.M)
    assert "strain of the ball" in said
    assert "rod" not in said.split("done:")[1]
    summary = Results(tmp_path / "shot").summary
    shape, ball = summary["projectile"], summary["bodies"]["ball"]
    assert shape["body"] == "ball"
    for old, new in PROJECTILE.items():
        assert summary[old] == shape[new], old
    for old, new in OF_EVERY_BODY.items():
        assert summary[old] == pytest.approx((summary["bodies"]["plate"] if "target" in old else ball)[new], rel=1e-12), old
    assert 0.0 < 0.5 * ball["mass_kg"] * ball["velocity_m_s"] ** 2 < ball["kinetic_energy_J"]
    assert 0.0 < shape["length_m"] < 0.01


def test_a_body_may_have_the_name_of_a_table():
    tables = {"projectile": {"mass_kg": 1.0}, "body": {"z_max_m": 0.1}}
    summary = {"conservation": {"mass": {"projectile": 1e-15}}, "bodies": tables}
    assert Summary.sound(summary) == (summary, [])
    assert Summary.sound({"projectile": {"body": 3, "length_m": "long"}})[1] == ["projectile.body", "projectile.length_m"]


def test_the_extent_of_a_plate_between_faces():
    plate = bodies.measure(started(0, 'body.plate.thickness="10.13 mm"'))["plate"]
    assert [plate[key] for key in ("r_min_m", "r_max_m", "z_min_m", "z_max_m")] == pytest.approx([0.0, 0.02, 0.0, 10.13e-3])


def test_bodies_have_the_momentum_of_the_vertices(struck):
    measured, whole, s, g = bodies.measure(struck), np.zeros(2), struck.state, struck.grid
    sums.vertex_totals(g.g, g.nz, g.nr, s.mass, s.u, s.v, whole)
    momentum, kinetic = (2.0 * math.pi * whole).tolist()
    assert sum(body["momentum_N_s"] for body in measured.values()) == pytest.approx(momentum, rel=1e-12)
    assert sum(body["kinetic_energy_J"] for body in measured.values()) == pytest.approx(kinetic, rel=1e-12)
    assert measured["plate"]["velocity_m_s"] > 0.0


def test_outflow_from_the_mesh_is_counted():
    sim = started(0, "mesh.z=[{ to = '-2 mm', cells = 26 }]", "gauge=[]", "body=[{ name = 'ball', material = 'W_alloy', "
                  "shape = 'sphere', centre = [0.0, '-7.5 mm'], radius = '5 mm', velocity = '800 m/s' }]")
    while sim.time < 4e-6:
        sim.step()
    measurement = bodies.measure(sim)["ball"]
    assert measurement["outflow_kg"] > 0.05 * MASS
    assert measurement["mass_kg"] + measurement["outflow_kg"] == pytest.approx(MASS, rel=1e-9)


def test_stations_have_what_the_fields_have(struck):
    cells, measurement = dict(derived_quantities.evaluated(struck)), struck.stations.measure()
    for name in ("tracer_mid", "gauge_line_1", "gauge_line_3"):
        station = measurement[name]
        j = int(np.searchsorted(struck.grid.z_edges, station["z_m"])) - 1
        at = {key: cells[quantities.BY_KEY[key].name()][j, 0] for key in (*SAME, "stress_zz", "stress_tt", "deviator_zz")}
        assert [station[SAME[key]] for key in SAME] == pytest.approx([at[key] for key in SAME], rel=1e-12)
        assert station["stress_zz_Pa"] == pytest.approx(at["stress_zz"], rel=1e-12)
        assert station["stress_zz_Pa"] == pytest.approx(at["deviator_zz"] - at["pressure"], rel=1e-12)
        assert station["stress_tt_Pa"] == pytest.approx(at["stress_tt"], rel=1e-12)
        assert station["peak_pressure_Pa"] >= station["pressure_Pa"] >= station["least_pressure_Pa"]


def test_tracers_move_and_gauges_stand(struck):
    measurement = struck.stations.measure()
    assert measurement["tracer_mid"]["z_m"] > -4e-3
    assert [measurement[f"gauge_line_{n}"]["z_m"] for n in (1, 2, 3)] == pytest.approx([1.2e-3, 5.2e-3, 9.2e-3])
    assert measurement["gauge_void"]["density_kg_m3"] == 0.0


def test_the_shock_reaches_one_gauge_after_the_other():
    """Waves in 5083 go at 5.3 to 6.5 km/s."""
    sim, arrived = started(), {}
    while len(arrived) < 2 and sim.time < 6e-6:
        sim.step()
        for name in ("gauge_line_1", "gauge_line_2"):
            if sim.stations.measure()[name]["pressure_Pa"] > 2e7:
                arrived.setdefault(name, sim.time)
    assert 4e-3 / 7.0e3 < arrived["gauge_line_2"] - arrived["gauge_line_1"] < 4e-3 / 5e3


def test_a_gauge_outside_of_a_mesh_that_travels_waits():
    sim = started(3, "mesh.follow=ball", 'gauge=[{ name = "far", r = 0.0, z = "40 mm" }]', "tracer=[]",
                  'body.plate.thickness="60 mm"')
    assert sim.stations.measure()["gauge_far"]["pressure_Pa"] is None


def test_peaks_and_places_are_in_the_restart():
    whole, second = started(40), restarted(started(20))
    for _ in range(20):
        second.step()
    assert second.stations.peaks.tobytes() == whole.stations.peaks.tobytes()
    assert second.stations.places.tobytes() == whole.stations.places.tobytes()


def test_a_nan_is_no_peak():
    peaks = np.array([station_columns.NO_PEAKS])
    tracers.keep_peaks(1.0, np.full((1, len(station_columns.QUANTITIES)), np.nan), peaks)
    assert peaks.tobytes() == np.array([station_columns.NO_PEAKS]).tobytes()


@pytest.mark.parametrize(
    ("gauge", "said"),
    [
        ('{ name = "a", r = 0.0, z = 0.0, points = 3 }', "a line of gauges needs an end"),
        ('{ name = "a", r = 0.0, z = 0.0, z_end = "1 mm" }', "a line of gauges needs an end"),
        ('{ name = "a", r = 0.0, z = "30 mm" }', "lies outside the mesh"),
        ('{ name = "a", r = 0.0, z = 0.0 }, { name = "a", r = 0.0, z = "1 mm" }',
         'the name "a" is already used by an earlier gauge'),
    ],
)
def test_a_wrong_gauge_is_reported(gauge, said):
    with pytest.raises(DeckError, match=said):
        decks.loads(DECK, [f"gauge=[{gauge}]"])


def test_the_radii_of_the_ends_and_the_length_of_a_body(struck):
    """A cone of cells, wide below; its length is that of its rows, and the length at the start is stored."""
    sim = started(0, 'body.plate.thickness="10 mm"')
    r, z = np.meshgrid(sim.grid.rc[sim.grid.inside[1]], sim.grid.zc[sim.grid.inside[0]])
    sim.grid.interior(sim.state.vof)[0] = (z > 0.0) & (z < 8e-3) & (r < 10e-3 - z)
    measurement = bodies.measure(sim)["ball"]
    assert measurement["radius_at_z_min_m"] == pytest.approx(9.5e-3)
    assert measurement["radius_at_z_max_m"] == pytest.approx(2e-3)
    assert measurement["length_m"] == pytest.approx(8e-3)
    assert measurement["initial_length_m"] == pytest.approx(10e-3, abs=0.2e-3)
    assert bodies.measure(struck)["ball"]["length_m"] < measurement["initial_length_m"]


# ----------------------------------------------------------------------------------------- bodies narrower than a cell


def thin(shape: str, planar: bool = False, cycles: int = 0) -> dict[str, float]:
    """Measurements of a body on cells of 0.1 mm that flies at 1000 m/s, and the distance flown, in mm."""
    kind = {"geometry": "planar"} if planar else {}
    sim = Simulation(decks.loads(mesh(("1 mm", 10), ("4 mm", 40), **kind) + shape + stop("10 us")))
    for _ in range(cycles):
        sim.step()
    lengths = {name: None if value is None else 1e3 * value for name, value in bodies.measure(sim)["thin"]
               if name.endswith("_m")}
    return lengths | {"way": 1e6 * sim.time}


def flying(low: float, high: float, inner: float, outer: float) -> str:
    return body("thin", "Al5083", "box", r=[f"{inner} mm", f"{outer} mm"], z=[f"{low} mm", f"{high} mm"], velocity="1000 m/s")


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("cycles", [0, 150])
@pytest.mark.parametrize(("low", "high"), [(1.03, 1.06), (1.085, 1.115), (1.04, 1.08)], ids=["inside", "astride", "wider"])
def test_a_foil_has_an_extent(low, high, cycles, planar):
    extent = thin(flying(low, high, 0.0, 0.4), planar, cycles)
    assert extent["way"] > 0.5 or cycles == 0
    z = [extent["z_min_m"] - extent["way"], extent["z_max_m"] - extent["way"]]
    assert z == pytest.approx([low, high], abs=2e-3)
    assert extent["length_m"] == pytest.approx(high - low, abs=2e-3)
    assert extent["initial_length_m"] == pytest.approx(high - low, abs=1e-9)
    assert [extent["r_min_m"], extent["r_max_m"]] == pytest.approx([0.0, 0.4], abs=2e-3)
    assert extent["radius_at_z_min_m"] == pytest.approx(0.4, abs=2e-3)


@pytest.mark.parametrize("planar", [False, True])
def test_a_coat_has_an_extent(planar):
    extent = thin(flying(1.03, 2.06, 0.33, 0.36), planar)
    ends = [extent[key] for key in ("r_min_m", "r_max_m", "z_min_m", "z_max_m")]
    assert ends == pytest.approx([0.33, 0.36, 1.03, 2.06], abs=1e-9)


def test_a_ball_of_less_than_a_cell_has_an_extent():
    """The box around it has its volume: its radius of 0.04 mm is correct to a tenth of a cell."""
    extent = thin(body("thin", "Al5083", "sphere", centre="1.05 mm", radius="0.04 mm", velocity="1000 m/s"))
    assert extent["r_max_m"] == pytest.approx(0.04, abs=0.01)
    assert [extent["z_min_m"], extent["z_max_m"]] == pytest.approx([1.01, 1.09], abs=0.01)


def test_a_crumb_has_no_extent():
    extent = thin(flying(1.0, 1.0 + 0.99e-3, 0.0, 0.4))
    assert {extent[key] for key in ("r_min_m", "r_max_m", "z_min_m", "z_max_m", "length_m", "radius_at_z_max_m")} == {None}
    assert thin(flying(1.0, 1.0 + 1.01e-3, 0.0, 0.4))["length_m"] == pytest.approx(1.01e-3)
