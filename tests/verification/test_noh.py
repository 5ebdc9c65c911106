"""Noh's problem in one, two and three dimensions: a shock of infinite strength, and symmetry about the origin.

With 100 cells to the metre only 20 are behind the shock at the end. The smearing of the shock heats material that converges
through it, and with `both` the error of the plateau falls in proportion to the cell, which is asserted. The accuracy desired at
100 cells appears below as expected failures. The gas falls at 1 km/s.
"""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from problems.verification.exact.noh import Noh
from tests.decks import box, mesh, stop, walls
from tests.verification.running import ADVECTION, Line, advection, crossing, run

PLATEAU = (0.08, 0.17)  # between the heated core and the smeared shock at R = 0.2


def noh(j: int) -> Noh:
    return Noh(j, speed=1000.0)


def line(name: str, choice: str, cells: int) -> Line:
    return Line(run(name, f"mesh.r=[{{to=1.0, cells={cells}}}]", advection(choice)), "r")


def plateau(profile: Line, j: int) -> float:
    """Relative error of the mean density behind the shock."""
    here = (profile.x > PLATEAU[0]) & (profile.x < PLATEAU[1])
    return float(profile.body("rho")[here].mean() / noh(j).rho - 1)


def front(profile: Line, j: int) -> float:
    """Position of the shock less the exact one, in cells."""
    ahead = 4.0 ** (j - 1)
    found = crossing(profile.x, profile.body("rho"), 0.5 * (noh(j).rho + ahead))
    return (found - profile.simulation.time * 1e3 / 3) / profile.dx[0]


def test_planar():
    profile = line("noh_planar", "both", 100)
    assert abs(plateau(profile, 1)) < 0.02
    assert abs(front(profile, 1)) < 1.5
    ahead = (profile.x > 0.24) & (profile.x < 0.35)
    assert profile.body("rho")[ahead] == pytest.approx(1.0, rel=2e-3)
    assert np.max(np.abs(profile.simulation.state.v)) < 1e-9


def test_planar_does_not_converge_without_conservation():
    """At an infinite shock `momentum` discards 5.1 % of the energy, the bound of `ke` 1.2 %; they are 5 and 7 % too dense."""
    for choice, energy, dense in (("momentum", (0.05, 0.06), (0.05, 0.06)), ("ke", (0.011, 0.014), (0.065, 0.08))):
        profile = line("noh_planar", choice, 200)
        audit = profile.simulation.audit
        sink = sum(audit.sinks[name].energy for name in ("advection", "ke_bound")) / audit.start.energy
        assert energy[0] < sink < energy[1]
        assert dense[0] < plateau(profile, 1) < dense[1]
        assert abs(profile.simulation.conservation()["total_energy"]) < 1e-12


def test_cylindrical_converges():
    coarse, middle, fine = (plateau(line("noh_cylindrical", "both", n), 2) for n in (100, 200, 400))
    assert np.log2(coarse / middle) > 0.8
    assert np.log2(middle / fine) > 0.9
    assert abs(2 * fine - middle) < 0.02  # the limit of a first-order error
    assert all(abs(front(line("noh_cylindrical", "both", n), 2)) < 3 for n in (100, 200, 400))


class Wedge:
    """Density over distance from the origin in a spherical run, between two angles from the axis in degrees."""

    def __init__(self, simulation, low: float, high: float):
        grid = simulation.grid
        r, z = np.meshgrid(grid.interior(np.broadcast_to(grid.rc, grid.shape))[0], grid.zc[2 : 2 + grid.nz])
        distance, angle = np.hypot(r, z), np.degrees(np.arctan2(r, z))
        here = (angle >= low) & (angle < high)
        self.distance, self.density = distance[here], grid.interior(simulation.state.rho[0])[here]
        self.dx, self.time = grid.dr[2], simulation.time

    def plateau(self) -> float:
        here = (self.distance > PLATEAU[0]) & (self.distance < PLATEAU[1])
        return float(self.density[here].mean() / noh(3).rho - 1)

    def front(self) -> float:
        """Position of the shock less the exact one, in cells, from densities averaged over shells two cells thick."""
        shells = np.arange(0.1, 0.4, self.dx) + self.dx / 2
        means = [self.density[np.abs(self.distance - shell) < self.dx].mean() for shell in shells]
        return (crossing(shells, np.array(means), 0.5 * (noh(3).rho + 16)) - self.time * 1e3 / 3) / self.dx


WEDGES = {"axis": (0, 10), "middle": (35, 55), "equator": (80, 90)}


def sphere(choice: str, cells: int, wedge: str) -> Wedge:
    simulation = run("noh_spherical", f"mesh.r=[{{to=1.0, cells={cells}}}]", f"mesh.z=[{{to=1.0, cells={cells}}}]",
                     advection(choice))
    return Wedge(simulation, *WEDGES[wedge])


@pytest.mark.parametrize("wedge", WEDGES)
def test_spherical_converges(wedge):
    coarse, fine = (sphere("both", n, wedge).plateau() for n in (100, 200))
    assert np.log2(coarse / fine) > 0.7


@pytest.mark.parametrize(("wedge", "least"), [("axis", -0.06), ("middle", -0.09), ("equator", -0.12)])
def test_spherical_plateau_and_front(wedge, least):
    """The plateau is 5, 8 and 11 % low on 100 cells and 3, 5 and 6 % on 200; the front is about a cell ahead on either."""
    coarse, fine = (sphere("both", n, wedge) for n in (100, 200))
    assert least < coarse.plateau() < fine.plateau() < 0.0
    assert 0 < fine.front() * fine.dx < coarse.front() * coarse.dx < 0.015


@pytest.mark.thorough
@pytest.mark.parametrize("choice", ["ke", "momentum"])
def test_spherical_does_not_converge_without_conservation(choice):
    """The density behind the shock grows beyond the exact one with the number of cells."""
    for wedge in WEDGES:
        coarse, fine = (sphere(choice, n, wedge).plateau() for n in (100, 200))
        assert fine > max(coarse, 0.05)


def test_spherical_front_is_a_sphere():
    """The shock is at one distance from the origin to half a cell, from the axis to the equator."""
    fronts = [sphere("both", 100, wedge).front() for wedge in WEDGES]
    assert max(fronts) - min(fronts) < 0.5


def test_spherical_conserves():
    for choice in ADVECTION:
        simulation = run("noh_spherical", "mesh.r=[{to=1.0, cells=100}]", "mesh.z=[{to=1.0, cells=100}]",
                         advection(choice))
        assert abs(simulation.conservation()["total_energy"]) < 1e-12


REASON = "first-order heating in the smeared shock; needs about {} cells to the metre (problems/verification/README.md)"


@pytest.mark.xfail(strict=True, reason=REASON.format("600"))
def test_wish_cylindrical():
    assert abs(plateau(line("noh_cylindrical", "both", 100), 2)) < 0.02


@pytest.mark.xfail(strict=True, reason=REASON.format("600"))
@pytest.mark.parametrize("wedge", WEDGES)
def test_wish_spherical(wedge):
    assert abs(sphere("both", 100, wedge).plateau()) < 0.05


@pytest.mark.parametrize("speed", [1.0, 1e-2])
def test_a_problem_in_units_of_one_is_as_accurate_as_at_a_kilometre_a_second(speed):
    """The least speed of sound follows the speeds of the deck."""
    densities = []
    for each in (1000.0, speed):
        size = 0.9 / 30
        simulation = Simulation(decks.loads(
            mesh((0.9, 30), (2 * size, 2), geometry="planar") + walls("z_min", "z_max")
            + box("gas", "gas_5_3", r=[0.0, 0.9], z=[0.0, 2 * size], density=1.0, energy=0.0, velocity=[-each, 0.0])
            + stop(0.5 / each)))
        while simulation.stop_reason() is None:
            simulation.step()
        densities.append(simulation.array("density")[0].max())
    assert densities[0] > 3.5
    assert densities[1] == pytest.approx(densities[0], rel=1e-3)
