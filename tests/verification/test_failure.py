"""Material that has failed by damage: it stays failed, bears neither shear nor tension, and is counted."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.mesh.fields import FAILED, SRR, SRZ
from hydro2d.solver.simulation import Simulation
from tests.decks import box, mesh, plate, rod, stop, walls
from tests.verification.running import finish
from tests.verification.test_translation import ROD

STRAIN_FAILURE = """
[materials.rod_fails]
based_on = "W_alloy"
variant = "strain-failure"
[materials.plate_fails]
based_on = "Al5083"
variant = "strain-failure"
[failure]
damage = "material"
"""
FLIGHT = STRAIN_FAILURE + ROD.replace("W_alloy", "rod_fails")
#: two halves of a bar of one material, which part in the middle, at r = const nothing happens
BAR = STRAIN_FAILURE + (
    mesh(("2 mm", 4), ("-20 mm", "20 mm", 80))
    + walls("r_max")
    + box("low", "rod_fails", z=["-15 mm", "0 mm"], velocity="-20 m/s")
    + box("high", "rod_fails", z=["0 mm", "15 mm"], velocity="20 m/s", join="low")
    + stop("5 us")
)
#: a short rod that fails at a strain of 0.5, so that much of it does within a few microseconds
SHOT = STRAIN_FAILURE.replace('[materials.plate', 'damage.D1 = 0.5\n[materials.plate') + (
    mesh(("9 mm", 18), ("-12 mm", "18 mm", 60))
    + rod("2 mm", "10 mm", material="rod_fails", nose="flat", tip=0.0, velocity="2000 m/s")
    + plate("16 mm", material="plate_fails")
    + stop("9 us")
)
SLIP_LAYER = """
[sliding]
method = "slip-layer"
hard = ["rod"]
yield_factor = "off"
"""
CONTACT = SLIP_LAYER.replace("slip-layer", "contact")


def fail_everything(simulation: Simulation) -> None:
    simulation.state.dmg[:] = np.where(simulation.state.vof > 0.0, FAILED, 0.0)


def failed(simulation: Simulation) -> np.ndarray:
    """Where a body [m, j, i] has failed."""
    s = simulation.state
    return (s.dmg >= 1.0) & (s.vof > 0.0)


@pytest.mark.parametrize("advection", ["ke", "momentum", "both"])
def test_what_has_failed_stays_failed_while_it_moves(advection):
    """Some 120 cycles across 24 cells: a mean of ones, with round-off, is one."""
    simulation = Simulation(deck.loads(FLIGHT, ["stop.time=12 us", f'numerics.advection="{advection}"']))
    fail_everything(simulation)
    while simulation.stop_reason() is None:
        simulation.step()
    present = simulation.state.vof > 0.0
    assert np.all(simulation.state.dmg[present] == FAILED)


@pytest.mark.parametrize("cells", [4, 8])
def test_a_thin_failed_layer_does_not_heal_as_it_moves(cells):
    """Rows of a rod that have failed, across 24 cells: what mixes with sound material by halves counts as failed."""
    simulation = Simulation(deck.loads(FLIGHT, ["stop.time=12 us"]))
    grid, s = simulation.grid, simulation.state
    middle = int(np.median(np.nonzero(grid.interior(s.vof)[0].sum(axis=1))[0]))
    grid.interior(s.dmg)[0, middle - cells // 2 : middle + cells // 2] = FAILED
    before = simulation.of_bodies()["rod"]["failed_mass_kg"]
    while simulation.stop_reason() is None:
        simulation.step()
    assert 0.75 * before < simulation.of_bodies()["rod"]["failed_mass_kg"] < 1.1 * before


@pytest.mark.parametrize(("broken", "speed"), [(True, 20.0), (False, 0.0)], ids=["failed", "intact"])
def test_a_failed_bar_parts_without_tension(broken, speed):
    """Halves at -20 and 20 m/s: a whole bar stops them by 1.5 GPa of tension, which it bears; a failed one parts."""
    simulation = Simulation(deck.loads(BAR))
    if broken:
        fail_everything(simulation)
    pull = 0.0
    while simulation.time < 2e-6:
        simulation.step()
        pull = min(pull, float(simulation.state.p.min()))
    middle = np.abs(simulation.grid.z_edges) < 6e-3
    v = np.abs(simulation.grid.interior_vertices(simulation.state.v)[0, middle])
    assert (pull == 0.0) == broken
    assert np.median(v) == pytest.approx(speed, abs=1.0)


@pytest.mark.parametrize("sliding", ["", SLIP_LAYER, CONTACT], ids=["sticking", "slip-layer", "contact"])
def test_debris_bears_no_shear_and_no_tension_and_is_counted(sliding):
    """In the cells of a shot in which rod and plate fail; the pressure is that of the cells as the cycle before left them."""
    counts, alone = [], []

    def watch(simulation):
        s, where = simulation.state, failed(simulation)
        if alone:
            assert np.all(s.p[alone.pop()] >= 0.0)
        if simulation.cycle % 5 == 0:
            assert np.all(s.q[SRR : SRZ + 1, where] == 0.0)
            alone.append((where & (s.vof == 1.0)).any(axis=0))
            found = simulation.diagnostics()
            counts.append((found["rod_failed_mass_kg"], found["target_failed_mass_kg"]))
            assert found["rod_failed_mass_kg"] + found["rod_core_mass_kg"] <= found["rod_mass_kg"] * (1 + 1e-12)

    simulation = finish(deck.loads(SHOT + sliding), watch)
    found = simulation.diagnostics()
    rod, plate = counts[-1]
    assert 0.02 < rod / found["rod_mass_kg"] < 0.9
    assert plate > 0.02 * found["rod_mass_kg"]
    assert abs(simulation.conservation()["total_energy"]) < 1e-2
