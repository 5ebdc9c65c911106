"""Edges with a prescribed velocity: inflow pushes like a piston, a bar that is fed in flies on unchanged."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.running import check
from hydro2d.solver.simulation import Simulation
from tests.decks import box, mesh, stop, table, walls
from tests.verification.running import ADVECTION, advection, finish

PISTON = (
    mesh(("100 mm", 100), ("4 mm", 4), geometry="planar")
    + walls("r_max", "z_min", "z_max", r_min="velocity", r_min_velocity="300 m/s")
    + box("gas", "gas_7_5", r=[0.0, "100 mm"], z=[0.0, "4 mm"], pressure="0.1 MPa")
    + stop("150 us")
)
UP, GAMMA, P = 300.0, 1.4, 1e5
#: largest error of pressure and density behind the shock; `ke` gains momentum (explanation/remap)
ERROR = {"ke": 0.01, "momentum": 0.01, "both": 0.005}
#: cells that the shock needs to form: from then on it is this far behind, on every mesh
LATE = 3.5


def run(text: str, *options: str) -> Simulation:
    return finish(decks.loads(text, options))


def turned(text: str) -> str:
    """The problem turned to the other axis."""
    for first, second in (("r =", "@ ="), ("z =", "r ="), ("@ =", "z ="), ("r_min", "@_min"), ("z_min", "r_min"),
                          ("@_min", "z_min"), ("r_max", "@_max"), ("z_max", "r_max"), ("@_max", "z_max")):
        text = text.replace(first, second)
    return text


def shock(up: float, rho: float, p: float) -> tuple[float, float, float]:
    """Speed, pressure and density of the shock that a piston drives into an ideal gas at rest."""
    c = np.sqrt(GAMMA * p / rho)
    speed = 0.25 * (GAMMA + 1.0) * up + np.hypot(0.25 * (GAMMA + 1.0) * up, c)
    return speed, p + rho * speed * up, rho * speed / (speed - up)


def audit_closes(simulation: Simulation, to: float = 1e-12) -> None:
    balance = simulation.conservation()
    assert max(map(abs, balance["mass"].values())) < to
    assert abs(balance["axial_momentum"]) < to
    assert abs(balance["total_energy"]) < to


@pytest.mark.parametrize("choice", ADVECTION)
@pytest.mark.parametrize("text", [PISTON, turned(PISTON)], ids=["along r", "along z"])
def test_inflow_drives_the_shock_of_a_piston(text, choice):
    simulation = run(text, advection(choice))
    s, g = simulation.state, simulation.grid
    rho0, p0 = simulation.table.rho0[0], P
    speed, pressure, density = shock(UP, rho0, p0)
    axis = 1 if text is PISTON else 0
    p = g.interior(s.p).mean(axis=1 - axis)
    rho = g.interior(s.rho)[0].mean(axis=1 - axis)
    x = 1e-3 * (np.arange(len(p)) + 0.5)
    assert p[x < 0.9 * speed * simulation.time].mean() == pytest.approx(pressure, rel=ERROR[choice])
    shocked = (x > 1.2 * UP * simulation.time) & (x < 0.9 * speed * simulation.time)  # material there at first, not the inflow
    assert rho[shocked].mean() == pytest.approx(density, rel=ERROR[choice])
    front = x[np.argmax(p < 0.5 * (pressure + p0))]
    assert 0.0 < speed * simulation.time - front < LATE * 1e-3
    audit_closes(simulation)


FED = (
    mesh(("9 mm", 12), ("12 mm", 16))
    + table("boundaries", z_min="velocity", z_min_velocity="1000 m/s")
    + box("bar", "W_alloy", r=[0.0, "3 mm"], z=[0.0, "2 mm"], velocity="1000 m/s")
    + stop("8 us")
)


@pytest.mark.parametrize("choice", ADVECTION)
def test_a_bar_that_is_fed_flies_on(choice):
    simulation = run(FED, advection(choice))
    s, g = simulation.state, simulation.grid
    volume = (g.interior(s.vof)[0] * g.volume[g.inside]).sum()
    assert volume == pytest.approx(0.5 * 3e-3**2 * (2e-3 + 1000.0 * simulation.time), rel=1e-9)
    filled = g.interior(s.vof)[0] > 0
    assert np.abs(g.interior(s.pm)[0][filled]).max() < 1e6
    audit_closes(simulation)


def test_an_edge_that_takes_away_lets_a_bar_out():
    """The edge draws out whatever reaches it at its own velocity."""
    simulation = run(FED.replace("z_min", "z_max"), "stop.time=15e-6")
    assert simulation.body_sums(0)[0].sum() < 1e-9
    audit_closes(simulation)


def test_check_says_the_velocity():
    edges = "boundaries: r_min axis, r_max outflow, z_min velocity 1000 m/s, z_max outflow"
    assert any(line.strip() == edges for line in check.check(decks.loads(FED)).lines(1))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (['boundaries.z_max="velocity"'], "needs z_max_velocity"),
        (['boundaries.z_max_velocity="3 m/s"'], 'has no meaning without z_max = "velocity"'),
        (['sliding.method="contact"', 'sliding.hard=["bar"]'], "a contact allows no edge with a velocity"),
    ],
)
def test_senseless_settings_are_reported(options, words):
    with pytest.raises(decks.DeckError, match=words):
        decks.loads(FED, options)
