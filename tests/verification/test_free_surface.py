"""Free surfaces in mid-cell: water at rest and a standing wave under a steady acceleration, a pressurised tube, a sphere."""

import functools

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from hydro2d.sources.acceleration import Acceleration
from problems.verification.exact.elastic_wall import displacements
from problems.verification.exact.vibration import Elastic, Spheroidal
from tests.decks import box, entry, mesh, stop, table, walls
from tests.verification.test_gas_beside_solids import BULK, DENSITY, GAS_SPEED, SHEAR, rock_and_gas

GRAVITY = 1e4
WATER = (
    entry("source", name="g", kind="acceleration", body="water", axial=-GRAVITY) + table("failure", tensile="none")
    + table("materials.water", strength={"model": "hydrodynamic"},
            eos={"model": "stiffened-gas", "reference_density": 1000.0, "sound_speed": 1000.0, "adiabatic_index": 7.0,
                 "specific_heat": 4180.0}) + stop("1 s")
)


def tank(depth: float, cell: float, wide: tuple[float, int], rows: int) -> Simulation:
    """Water, row by row under the pressure of its depth, with void above."""
    text = mesh(wide, (rows * cell, rows), geometry="planar") + walls("r_max", "z_min")
    for k in range(int(np.ceil(depth / cell - 1e-9))):
        low, high = k * cell, min((k + 1) * cell, depth)
        keys = {} if k == 0 else {"join": "water"}
        text += box("water" if k == 0 else f"part{k}", "water", r=[0.0, wide[0]], z=[low, high],
                    pressure=1e3 * GRAVITY * (depth - 0.5 * (low + high)), **keys)
    return Simulation(decks.loads(text + WATER))


@pytest.mark.parametrize("share", [0.02, 0.25, 0.5, 0.75, 0.9, 0.98, 1.0])
def test_water_at_rest(share):
    """Nothing moves, to 1e-14 m/s; it was 98 m/s at the surface and up to 5 m/s in the mean, with pressures 13 % off."""
    cell, fastest = 0.0125, 0.0
    simulation = tank(0.1 + share * cell, cell, (0.025, 2), 11)
    state, grid = simulation.state, simulation.grid
    while simulation.time < 10e-3:
        simulation.step()
        fastest = max(fastest, np.abs(grid.interior_vertices(state.v[0])).max())
    assert fastest < 1e-9
    assert grid.interior(state.p)[0] == pytest.approx(1e3 * GRAVITY * (0.1 + (share - 0.5) * cell), rel=1e-9)


@pytest.mark.parametrize("share", [0.02, 0.25, 0.5, 0.75, 0.9, 0.98, 1.0])
def test_water_at_rest_under_gravity_along_r(share, monkeypatch):
    """The same lying on its side, with what pushes along z turned to -r."""
    cell, fastest, depth = 0.0125, 0.0, 0.1 + share * 0.0125
    push = Acceleration.push
    monkeypatch.setattr(Acceleration, "push", lambda *at: push(*at)[::-1])
    text = mesh((11 * cell, 11), (0.025, 2), geometry="planar") + walls("z_min", "z_max")
    for k in range(int(np.ceil(depth / cell - 1e-9))):
        low, high = k * cell, min((k + 1) * cell, depth)
        keys = {} if k == 0 else {"join": "water"}
        text += box("water" if k == 0 else f"part{k}", "water", r=[low, high], z=[0.0, 0.025],
                    pressure=1e3 * GRAVITY * (depth - 0.5 * (low + high)), **keys)
    simulation = Simulation(decks.loads(text + WATER))
    state, grid = simulation.state, simulation.grid
    while simulation.time < 10e-3:
        simulation.step()
        fastest = max(fastest, np.abs(grid.interior_vertices(state.u[0])).max())
    assert fastest < 1e-9
    assert grid.interior(state.p)[:, 0] == pytest.approx(1e3 * GRAVITY * (depth - 0.5 * cell), rel=1e-9)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.75])
def test_a_standing_wave(share):
    """32 cells per wave, 2 mm high: period 0.25 to 0.63 % long, 0.5 to 1 % lower after half of a period; there was no wave."""
    high, wide = 2e-3, 0.1
    cell, k = wide / 16, np.pi / wide
    depth = 0.1 + share * cell
    simulation = tank(depth, cell, (wide, 16), 20)
    state, grid, omega = simulation.state, simulation.grid, np.sqrt(GRAVITY * k * np.tanh(k * depth))
    r, z = grid.r[grid.g:grid.g + grid.nr + 1], grid.z[grid.g:grid.g + grid.nz + 1, None]
    speed, there = high * omega / np.sinh(k * depth), grid.interior_vertices(state.mass[0]) > 0.0
    grid.interior_vertices(state.u[0])[...] = -speed * np.sin(k * r) * np.cosh(k * z) * there
    grid.interior_vertices(state.v[0])[...] = speed * np.cos(k * r) * np.sinh(k * z) * there
    state.u[0, :, grid.g], simulation.engine.audit = 0.0, None
    simulation.engine.prepare()
    times, heights = [], []
    while simulation.time < 1.55 * 2 * np.pi / omega:
        simulation.step()
        filled = grid.interior(state.vof).sum(axis=(0, 1)) * cell
        times.append(simulation.time)
        heights.append(2 * np.mean((filled - filled.mean()) * np.cos(k * grid.rc[grid.g:grid.g + grid.nr])))
    t, a = np.array(times), np.array(heights)
    n = np.nonzero(a[:-1] * a[1:] < 0.0)[0]
    nodes = t[n] - a[n] * (t[n + 1] - t[n]) / (a[n + 1] - a[n])
    assert len(nodes) == 3
    assert nodes[2] - nodes[0] == pytest.approx(2 * np.pi / omega, rel=0.008)
    for half in range(3):
        crest = np.abs(a[(t > half * np.pi / omega) & (t < (half + 1) * np.pi / omega)]).max()
        assert crest == pytest.approx(high, rel=0.02)


@pytest.mark.parametrize("cells", [4, 8])
@pytest.mark.parametrize("shift", [0.0, 0.25, 0.5, 0.75])
def test_a_tube_with_both_surfaces_in_mid_cell(cells, shift):
    """Largest displacement under a gas of 1 MPa, 4 and 8 cells in the wall: 1.2 to 2.1 and 0.8 to 1.0 % too much; it was 7 to
    17 and 3 to 8 % in mid-cell."""
    cell = 0.01 / cells
    columns = [{"to": (13 * cells + shift) * cell, "cells": 13 * cells}]
    simulation = Simulation(decks.loads(
        mesh([{"to": shift * cell, "cells": 1}] * (shift > 0.0) + columns, (3 * cell, 3)) + walls("z_min", "z_max")
        + box("gas", "gas", r=[0.0, 0.1], z=[0.0, 3 * cell], pressure="1 MPa")
        + box("rock", "rock", r=[0.1, 0.11], z=[0.0, 3 * cell]) + rock_and_gas() + stop("1 s")
    ))
    grid, largest = simulation.grid, 0.0
    area = np.diff(grid.r[grid.g:grid.g + grid.nr + 1] ** 2)
    while simulation.time < 70e-6:
        simulation.step()
        largest = max(largest, np.sqrt(grid.interior(simulation.state.vof[0])[0] @ area) - 0.1)
    _, course = displacements(0.1, 0.11, 1e6, DENSITY, BULK, SHEAR, 1, 70e-6, impedance=1000.0 * GAS_SPEED, cells=200)
    assert largest == pytest.approx(course[:, 0].max(), rel=0.03)


ALUMINIUM, RADIUS = Elastic(2785.0, 5328.0, 27.6e9), 0.01


@functools.cache
def spheroidal(cells: int, place: float) -> tuple[float, float]:
    """(period over the exact one, part of the amplitude left after three periods) of the mode 0S2 of a free elastic sphere.

    place : cells between the surface and a line of the mesh, at the pole and at the equator
    """
    mode, size = Spheroidal(ALUMINIUM), RADIUS / (cells + place)
    edges = f"[{{to={(cells + 4) * size}, cells={cells + 4}}}]"
    simulation = Simulation(decks.load("problems/verification/breathing_sphere.toml", [
        f"mesh.r={edges}", f"mesh.z={edges}", 'stop.time="1 s"', "body.sphere.flow.speed=1e-9"]))
    state, grid = simulation.state, simulation.grid
    inside = grid.interior_vertices
    there = inside(state.mass[0]) > 0.0
    u, v = (inside(x) * there for x in mode.displacement(*np.meshgrid(grid.r, grid.z), RADIUS))
    inside(state.u[0])[...], inside(state.v[0])[...] = u, v  # at most 1.2 m/s
    state.u[0, :, grid.g], state.v[0, grid.g], simulation.engine.audit = 0.0, 0.0, None
    simulation.engine.prepare()
    period, times, sizes = mode.period(ALUMINIUM, RADIUS), [], []
    while simulation.time < 3.2 * period:
        simulation.step()
        mass = inside(state.mass[0])
        sizes.append((mass * (inside(state.u[0]) * u + inside(state.v[0]) * v)).sum() / (mass * (u**2 + v**2)).sum())
        times.append(simulation.time / period)
    t, a = np.array(times), np.array(sizes)
    n = np.nonzero(a[:-1] * a[1:] < 0.0)[0]
    nodes = t[n] - a[n] * (t[n + 1] - t[n]) / (a[n + 1] - a[n])
    return 2.0 * np.diff(nodes).mean(), a[t > 2.8].max()


@pytest.mark.thorough
@pytest.mark.parametrize("place", [0.0, 0.3, 0.6])
@pytest.mark.parametrize(("cells", "period", "lost"), [(8, 0.012, 0.03), (16, 0.004, 0.01), (32, 0.002, 0.005)])
def test_a_sphere_that_becomes_long_and_flat_in_turn(cells, period, lost, place):
    """Period 0.5 to 0.9, 0.2 and 0.05 % too long on 8, 16, 32 cells; 1 to 2.5, 0.3 to 0.9 and 0.4 % of the amplitude lost."""
    ratio, left = spheroidal(cells, place)
    assert ratio == pytest.approx(1.0, abs=period)
    assert left == pytest.approx(1.0, abs=lost)
