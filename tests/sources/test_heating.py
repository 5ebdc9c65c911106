"""Sources of energy: the tables of a deck, the energy deposited and its audit."""

import numpy as np
import pytest

from hydro2d.base import tables
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.mesh.grid import Grid
from hydro2d.solver.simulation import Simulation
from hydro2d.sources.base import Source
from hydro2d.sources.heating import Heating
from tests.restarts import restarted

TEXT = """
[mesh]
geometry = "planar"
r = [{ to = "4 mm", cells = 4 }]
z = [{ to = "20 mm", cells = 40 }]
[boundaries]
r_max = "wall"
[[body]]
name = "plate"
material = "Al5083"
shape = "plate"
z_front = "5 mm"
thickness = "10 mm"
[[source]]
name = "beam"
kind = "heating"
body = "plate"
r = ["0 mm", "2.5 mm"]
z = ["4 mm", "7.25 mm"]
power = [["0.1 us", "1e11 W/kg"], ["0.3 us", "3e11 W/kg"]]
[stop]
time = "0.4 us"
"""
ROWS = ((1.0, 2.0), (3.0, 4.0), (4.0, 0.0))


@pytest.mark.parametrize(("first", "last", "expected"), [
    (0.0, 10.0, 8.0), (1.0, 3.0, 6.0), (3.0, 4.0, 2.0), (0.0, 1.0, 0.0), (4.0, 9.0, 0.0), (1.5, 2.5, 3.0), (2.0, 3.5, 5.0),
    (3.0, 3.0, 0.0), (-5.0, 1.5, 1.125),
])
def test_the_integral_of_a_table(first, last, expected):
    assert tables.integral(ROWS, first, last) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize(("time", "expected"), [(0.0, 2.0), (2.0, 3.0), (3.5, 2.0), (9.0, 0.0)])
def test_the_value_of_a_table(time, expected):
    assert tables.at(ROWS, time) == expected


@pytest.mark.parametrize(("override", "words"), [
    ('source.beam.kind="burn"', r"source\[0\].kind: unknown kind .burn. \(allowed: acceleration, detonation, heating\)"),
    ('source.beam.body="plat"', "unknown body .plat.; did you mean"),
    ('source.beam.name="walls"', "is that of a sink of the audit"),
    ("source.beam.power=[[0, 1]]", "expected a table of 2 to 100000 rows"),
    ("source.beam.power=[[0, '1 W/kg'], [0, '2 W/kg']]", "the time of row 1, 0 s, is not after that of the row before"),
    ('source.beam.power=[[0, 0], ["1 us", "2 m"]]', "row 1: .*is a length; expected a power per mass"),
    ("source.beam.power=[[0, 0], [1]]", r"row 1 is not \[time, value in W/kg\]"),
    ("source.beam.z=['2 m', '1 m']", "the second must be greater than the first"),
    ("source.beam.pover=1", 'unknown key "pover"; did you mean "power"'),
])
def test_wrong_tables(override, words):
    with pytest.raises(DeckError, match=words):
        deck.loads(TEXT, [override])


def test_two_sources_of_one_name():
    with pytest.raises(DeckError, match="already used by an earlier source"):
        deck.loads(TEXT + TEXT[TEXT.index("[[source]]"): TEXT.index("[stop]")])


def test_the_share_of_cells_within_reach():
    """In r-z the share of the volume: of a cell from 1 to 2 mm, the part within 1.5 mm is 5/12."""
    grid = Grid([0.0, 1e-3, 2e-3, 3e-3], [0.0, 1e-3, 2e-3])
    beam = Heating(name="beam", kind="heating", body="plate", r=[0.0, 1.5e-3], z=[0.25e-3, 5e-3], power=ROWS)
    np.testing.assert_allclose(beam.share(grid), np.outer([0.75, 1.0], [1.0, 5 / 12, 0.0]), rtol=1e-13, atol=1e-15)
    ring = Heating(name="beam", kind="heating", body="plate", power=ROWS)
    np.testing.assert_array_equal(ring.share(grid), 1.0)


def test_energy_and_audit_close_to_round_off():
    """The integral of the power, 4e4 J/kg, goes to the mass within reach, 2.5 by 2.25 mm of aluminium before it moves."""
    simulation = Simulation(deck.loads(TEXT))
    simulation.run()
    given = -simulation.audit.sinks["beam"].energy
    assert given == pytest.approx(4e4 * 2660.0 * 2.5e-3 * 2.25e-3, rel=2e-3)
    balance = simulation.conservation()
    assert abs(balance["total_energy"]) < 1e-13
    assert balance["sinks"]["beam"] == {"mass_kg": 0.0, "momentum_N_s": 0.0, "energy_J": -given}
    assert simulation.sources.given == pytest.approx([4e4], rel=1e-12)
    assert simulation.conservation()["kinetic_energy_J"] > 0.0
    assert simulation.doubts() == []


def test_material_out_of_reach_stays_cold():
    simulation = Simulation(deck.loads(TEXT))
    while simulation.time < 0.15e-6:
        simulation.step()
    e = simulation.grid.interior(simulation.state.e)[0]
    assert e[11, 1] > 4e3
    assert np.all(np.abs(e[20:]) < 1e-30)  # heat left by sound waves of a few bits
    assert np.all(np.abs(e[:9]) < 1e-30)


def test_a_restart_goes_on_heating_to_the_same_bits():
    first = Simulation(deck.loads(TEXT))
    while first.time < 0.2e-6:
        first.step()
    second = restarted(first)
    for _ in range(5):
        first.step()
        second.step()
    np.testing.assert_array_equal(first.grid.interior(first.state.q), second.grid.interior(second.state.q))
    assert second.audit.sinks["beam"].energy == first.audit.sinks["beam"].energy
    np.testing.assert_array_equal(second.sources.given, first.sources.given)


def test_a_source_may_set_variables_before_the_first_step(monkeypatch):
    """Programmed burn needs this: a made-up kind gives every cell of a porous block another distention."""
    simulation = Simulation(deck.load("problems/verification/porous_compaction.toml"))

    class Crushed(Source):
        def begin(self, grid, reached):
            reached.variables["distention"][...] = 1.0 + grid.zc[grid.inside[0], None]
            return [f"{reached.mass.sum():.3g} kg"]

    simulation.sources._all = [(Crushed(name="press", body="block"), 0)]
    assert simulation.sources.begin() == [f"{2117.647 * 0.4e-3 * 39e-3:.3g} kg"]
    distention = simulation.grid.interior(simulation.state.q[7, 0])
    np.testing.assert_array_equal(distention[:, 1], 1.0 + simulation.grid.zc[simulation.grid.inside[0]])
