"""Gas under pressure next to elastic solids: one traction across the surface, wherever it cuts a cell.

Numbers in the docstrings are the present errors, and the earlier ones of cells with one pressure.
"""

import numpy as np
import pytest
from scipy import interpolate

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from problems.verification.exact.blake import Cavity, cylindrical
from problems.verification.exact.elastic_wall import displacements
from tests.decks import box, entry, mesh, stop, table, walls

DENSITY, SHEAR = 3000.0, 25e9
BULK = 125e9 / 3
#: sound in the gas, 1000 kg/m^3 under 1 MPa
GAS_SPEED = np.sqrt(1.4 * 1e6 / 1000.0)


def rock_and_gas() -> str:
    """An elastic rock, a gas under 1 MPa in it, and no failure."""
    return (
        table("materials.rock", eos={"model": "mie-grueneisen", "reference_density": DENSITY, "hugoniot_slope": 1.3,
                                     "grueneisen": 1.5, "sound_speed": np.sqrt(BULK / DENSITY), "specific_heat": 900.0},
              strength={"model": "elastic-plastic", "shear_modulus": SHEAR, "yield_stress": 1e11})
        + table("materials.gas", eos={"model": "ideal-gas", "reference_density": 1000.0, "adiabatic_index": 1.4,
                               "specific_heat": 700.0})
        + table("failure", tensile="none", strength_cutoff=0.0)
    )


def cylinder(outer: float, cell: float, cells: int) -> Simulation:
    """Gas within 0.1 m and rock up to a radius, on columns of cells, between two walls."""
    high = 3 * cell
    return Simulation(decks.loads(
        mesh((cell * cells, cells), (high, 3)) + walls("z_min", "z_max")
        + box("gas", "gas", r=[0.0, 0.1], z=[0.0, high], pressure="1 MPa") + box("rock", "rock", r=[0.1, outer], z=[0.0, high])
        + rock_and_gas() + stop("1 s")
    ))


def moved(simulation: Simulation, until: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(r, z of the vertices, their displacements along r and z) by the velocities during a run."""
    grid, time = simulation.grid, 0.0
    gone = np.zeros((2, grid.nz + 1, grid.nr + 1))
    after = np.zeros_like(gone)
    while simulation.time < until * (1.0 - 1e-12):
        simulation.step()
        before, after = after, np.array([grid.interior_vertices(x[0]) for x in (simulation.state.u, simulation.state.v)])
        gone += 0.5 * (simulation.time - time) * (before + after)
        time = simulation.time
    return grid.r[grid.g:grid.g + grid.nr + 1], grid.z[grid.g:grid.g + grid.nz + 1], *gone


@pytest.mark.parametrize("place", [0.05, 0.3, 0.7, 1.0])
def test_a_cylindrical_cavity_wherever_its_wall_cuts_a_cell(place):
    """After 60 us at 1.5, 2 and 2.5 radii, 10 cells per radius: 1.6 to 3.3 % too much; it was 8 to 11 %."""
    cell = 0.1 / (9.0 + place)
    r, _, gone, _ = moved(cylinder(50 * cell, cell, 50), 60e-6)
    at = [0.15, 0.2, 0.25]
    assert np.interp(at, r, gone[1]) == pytest.approx(cylindrical(Cavity(), at, 60e-6), rel=0.035)


@pytest.mark.parametrize("cells", [4, 8])
def test_a_tube_under_pressure(cells):
    """Largest displacement of the inner face, radius 100 mm, wall 10 mm: 1.7 and 0.7 % too much; it was 25 and 11 %."""
    simulation = cylinder(0.11, 0.01 / cells, 13 * cells)
    grid, largest = simulation.grid, 0.0
    area = np.diff(grid.r[grid.g:grid.g + grid.nr + 1] ** 2)
    while simulation.time < 70e-6:
        simulation.step()
        gas = grid.interior(simulation.state.vof[0])[0]
        largest = max(largest, np.sqrt(gas @ area) - 0.1)
    _, course = displacements(0.1, 0.11, 1e6, DENSITY, BULK, SHEAR, 1, 70e-6, impedance=1000.0 * GAS_SPEED, cells=200)
    assert largest == pytest.approx(course[:, 0].max(), rel=0.03)


def blake(place: float, cells: int) -> np.ndarray:
    """Displacement along rays over the exact one, less 1: [radii 0.15, 0.2, 0.3 m; 0, 15, ... 90 degrees from the axis]."""
    cell = 0.1 / (cells - 1.0 + place)
    number = int(10.2 * cells)
    simulation = Simulation(decks.loads(
        mesh((cell * number, number), (cell * number, number)) + walls("z_min")
        + entry("body", name="gas", material="gas", shape="sphere", centre=0.0, radius=0.1, pressure="1 MPa")
        + box("rock", "rock", r=[0.0, cell * number], z=[0.0, cell * number]) + rock_and_gas() + stop("1 s")
    ))
    r, z, along_r, along_z = moved(simulation, 160e-6)
    radii, angle = np.array([[0.15], [0.2], [0.3]]), np.radians(np.arange(0, 91, 15))
    at = np.stack(np.broadcast_arrays(radii * np.cos(angle), radii * np.sin(angle)), axis=-1)
    gone_r, gone_z = (interpolate.interpn((z, r), along, at) for along in (along_r, along_z))
    return (gone_r * np.sin(angle) + gone_z * np.cos(angle)) / Cavity().displacement(radii, 160e-6) - 1.0


@pytest.mark.parametrize(("place", "cells", "most"), [(1.0, 10, 0.06), (0.3, 10, 0.11), (1.0, 20, 0.035)])
def test_blakes_cavity(place, cells, most):
    """Mean of seven rays after 160 us: 5 % too much on 10 cells per radius, 9 to 10 % with the wall at 0.3, 3 % on 20."""
    assert np.abs(blake(place, cells).mean(axis=1)).max() < most


@pytest.mark.xfail(strict=True, reason="3 to 5 % on 10 cells per radius, 5 to 11 % with the wall at 0.3 of a cell")
def test_blakes_cavity_within_three_per_cent_on_every_ray():
    assert np.abs(blake(0.3, 10)).max() < 0.03
