"""Sod's shock tube along both axes: error, order of convergence, plateaus, and equal results along both axes."""

import numpy as np
import pytest

from problems.verification.exact.riemann import sod
from tests.verification.running import ADVECTION, Line, advection, between, crossing, run

EXACT = sod()
GAMMA = 1.4


def shock_tube(choice: str, cells: int = 200) -> Line:
    """Along z, with square cells."""
    return Line(run("sod_z", f"mesh.z=[{{to=1.0, cells={cells}}}]", f"mesh.r=[{{to={4 / cells}, cells=4}}]",
                    advection(choice)))


def density_error(line: Line) -> float:
    """L1 error of density at the end time of the run."""
    exact = EXACT.sample((line.x - 0.5) / line.simulation.time)[0]
    return float(np.sum(np.abs(line.body("rho") - exact) * line.dx))


@pytest.mark.parametrize("choice", ADVECTION)
def test_density(choice):
    assert density_error(shock_tube(choice)) <= 0.006


@pytest.mark.parametrize("choice", ["momentum", "both"])
def test_order(choice):
    """First order, as a shock allows. `ke` is left out: its gain of momentum does not vanish with the cells."""
    order = np.log2(density_error(shock_tube(choice, 100)) / density_error(shock_tube(choice, 200)))
    assert order >= 0.9


#: relative errors of p and u on the plateaus, and of the shock's speed; one cell is 0.3 % of the shock's way.
#: `both` conserves what the jump conditions need; `momentum` loses energy and `ke` gains momentum at the shock.
PLATEAU = {"both": (1e-3, 3e-3), "momentum": (3e-3, 3e-3), "ke": (15e-3, 15e-3)}


@pytest.mark.parametrize("choice", ADVECTION)
def test_plateaus(choice):
    line = shock_tube(choice)
    xi = (line.x - 0.5) / line.simulation.time
    plateau, shock = PLATEAU[choice]
    pressure = (GAMMA - 1) * line.body("rho") * line.body("e")
    for low, high in ((EXACT.left_wave[1], EXACT.u), (EXACT.u, EXACT.right_wave[1])):
        here = between(xi, low, high, 0.25)
        assert pressure[here].mean() == pytest.approx(EXACT.p, rel=plateau)
    here = between((line.xv - 0.5) / line.simulation.time, EXACT.left_wave[1], EXACT.right_wave[1], 0.2)
    assert line.velocity[here].mean() == pytest.approx(EXACT.u, rel=plateau)
    assert crossing(xi, pressure, 0.5 * (EXACT.p + 0.1)) == pytest.approx(EXACT.right_wave[1], rel=shock)


def test_quantities_that_the_choices_conserve():
    """Energy balances to round-off with the amounts in the audit; the study's choices trade momentum for energy."""
    recorded = {}
    for choice in ADVECTION:
        simulation = shock_tube(choice).simulation
        assert abs(simulation.conservation()["total_energy"]) < 1e-12
        sink = simulation.audit.sinks["advection"]
        recorded[choice] = (sink.energy / simulation.audit.start.energy, sink.momentum)
    assert abs(recorded["both"][0]) < 1e-12
    assert 1e-4 < recorded["momentum"][0] < 1e-3  # kinetic energy discarded
    start = simulation.audit.start  # the bound of P/M removes round-off, recorded with the rest
    scale = (2.0 * start.mass.sum() * start.energy) ** 0.5
    assert max(abs(recorded["momentum"][1]), abs(recorded["both"][1])) < 1e-15 * scale
    assert abs(recorded["ke"][0]) < 5e-5  # cut by the bound
    assert recorded["ke"][1] < 0.0  # momentum gained is a negative loss


@pytest.mark.parametrize("choice", ADVECTION)
def test_r_is_z(choice):
    """In planar geometry, and along z in cylindrical geometry as well, the profiles agree to round-off."""
    radial = Line(run("sod_r", advection(choice)), "r")
    for axial in (run("sod_z", 'mesh.geometry="planar"', advection(choice)), run("sod_z", advection(choice))):
        assert axial.cycle == radial.simulation.cycle
        for name in ("rho", "e"):
            assert np.max(np.abs(Line(axial).body(name) - radial.body(name))) < 1e-12
        assert np.max(np.abs(Line(axial).velocity - radial.velocity)) < 1e-12


@pytest.mark.parametrize("choice", ADVECTION)
def test_one_dimensional(choice):
    """Along z nothing depends on r and nothing moves along r."""
    simulation = run("sod_z", advection(choice))
    assert np.max(np.abs(simulation.state.u)) < 1e-12
    assert np.max(np.ptp(simulation.grid.interior(simulation.state.rho[0]), axis=1)) < 1e-12
