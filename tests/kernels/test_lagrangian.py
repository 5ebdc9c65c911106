"""The Lagrangian step: masses of vertices, energy, rotation and strain of stress."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.kernels import mixed_strength
from hydro2d.mesh.grid import Grid
from hydro2d.physics.stress import von_mises
from hydro2d.solver.simulation import Simulation
from tests.decks import box, material, mesh, stop, table, walls
from tests.kernels.pieces import constrain

BLOCK = (
    mesh([{"to": 0.5, "cells": 6}, {"cells": 4, "ratio": 1.1}], [{"to": 0.6, "cells": 7}, {"cells": 3, "ratio": 1.15}],
         geometry="cylindrical")
    + walls("r_max", "z_min", "z_max")
    + box("block", "metal", z=[0.0, 5.0])
    + material("metal", "Al6061_T6")
    + table("materials.metal.strength", model="elastic-plastic", shear_modulus="26 GPa", yield_stress="1e6 GPa")
    + table("numerics", active_region=False)
    + table("failure", tensile="none")
    + stop(1.0)
)
GEOMETRIES = ("cylindrical", "planar")


def engine(text: str = BLOCK, *overrides: str):
    return Simulation(deck.loads(text, overrides)).engine


def lagrangian(e, dt: float) -> None:
    """The Lagrangian step of the cycle, with a chosen time step."""
    e.close_cells()
    e.choose_step()
    e.dt = dt
    e.accelerate()
    e.deform()


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_corner_masses_add_up(geometry):
    g = Grid([0.0, 0.1, 0.25, 0.3], [0.0, 0.2, 0.5], geometry)
    inside = slice(g.g, g.g + g.nr)
    np.testing.assert_allclose(2 * g.cm_in[inside] + 2 * g.cm_out[inside], 1.0, rtol=1e-15)


# ---------------------------------------------------------------------------------------------------- forces


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_axis_accelerates_like_the_rest(geometry):
    """An axial pressure gradient, uniform on a graded mesh, gives all vertices the same axial acceleration."""
    e = engine(BLOCK, f'mesh.geometry="{geometry}"')
    s, g = e.state, e.grid
    gradient = 1e9
    e.close_cells()
    e.choose_step()
    g.interior(s.p)[...] = 5e8 + gradient * g.zc[g.inside[0], None]
    e.accelerate()
    rows, columns = slice(g.g + 1, g.g + g.nz), slice(g.g, g.g + g.nr)  # not the walls
    exact = -gradient / e.table.rho0[0] * e.dt
    np.testing.assert_allclose(s.v[0, rows, columns], exact, rtol=1e-13)
    assert np.abs(s.u[0, rows, columns]).max() < 1e-12 * abs(exact)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_uniform_pressure_moves_nothing(geometry):
    e = engine(BLOCK, f'mesh.geometry="{geometry}"', "body.block.energy=1e5")
    s, g = e.state, e.grid
    lagrangian(e, 1e-6)
    assert s.p[g.inside].min() > 1e8
    assert np.hypot(s.u, s.v).max() < 1e-12 * 1e-6 * s.p[g.inside].max() / e.table.rho0[0] / g.dr.min()


# ---------------------------------------------------------------------------------------------------- energy

SECOND = """
[[body]]
name = "tungsten"
material = "W_alloy"
shape = "sphere"
centre = 0.3
radius = 0.26
[[body]]
name = "block"
material = "metal"
shape = "box"
z = [0.12, 0.77]
r = [0.0, 0.83]
"""
MIXED = BLOCK[:BLOCK.index("[[body]]")] + SECOND + BLOCK[BLOCK.index("[materials.metal]"):]
MODES = [f'numerics.mixed_strength="{mode}"' for mode in mixed_strength.STRENGTH_MODES]
SLIDING = 'sliding.method="slip-layer"', 'sliding.hard=["tungsten"]', "sliding.yield_factor=1.3"


def energy(e) -> float:
    """Internal energy by the masses of the bodies, which the Lagrangian step keeps, and kinetic energy."""
    s, g = e.state, e.grid
    if not hasattr(e, "masses"):
        e.masses = s.vof * s.rho * g.volume
    return np.sum(e.masses * s.e) + 0.5 * np.sum(s.mass * (s.u**2 + s.v**2))


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize(("text", "options"), [
    (BLOCK, ()), *((MIXED, (mode,)) for mode in MODES), (MIXED, ('numerics.mixed_cell="uniform"',)), (MIXED, SLIDING)],
    ids=["pure", *mixed_strength.STRENGTH_MODES, "uniform closure", "slip-layer"])
def test_lagrangian_step_conserves_energy_to_round_off(geometry, text, options):
    e = engine(text, f'mesh.geometry="{geometry}"', *options)
    s, g = e.state, e.grid
    random = np.random.default_rng(2)
    inside = (slice(None), *g.inside)
    present = s.vof[inside] > 0
    for k, size in ((1, 2e4), (2, 2e7), (3, 2e7), (4, 2e7)):
        s.q[(k, *inside)] = np.where(present, size * random.normal(size=present.shape), 0.0)
    for w in (s.u, s.v):
        w[0][g.inside_vertices] = 20.0 * random.normal(size=(g.nz + 1, g.nr + 1))
    s.u[s.mass == 0.0] = s.v[s.mass == 0.0] = 0.0
    constrain(e)
    e.find_slip_zones()
    before = energy(e)
    lagrangian(e, 2e-6)
    work = 0.5 * np.sum(s.mass * ((s.u - s.u0) ** 2 + (s.v - s.v0) ** 2))
    assert work > 1e-5 * before  # there is motion
    assert energy(e) == pytest.approx(before, rel=1e-13)


# ---------------------------------------------------------------------------------------------------- strain and spin


def driven(e, u, v, dt: float, steps: int):
    """Strains the bodies by a prescribed velocity, without forces and without a remap."""
    s = e.state
    for _ in range(steps):
        e.close_cells()
        e.choose_step()
        e.dt = dt
        e.accelerate()
        s.u[0] = s.u0[0] = u
        s.v[0] = s.v0[0] = v
        e.deform()
        e.state.q[:2] = e.first  # neither heat nor the second-order volume of a rotation in finite steps


def deviators(e):
    """(rr, zz, rz) of the block in MPa, once it is uniform."""
    s, g = e.state, e.grid
    fields = [g.interior(field[0]) for field in (s.srr, s.szz, s.srz)]
    for field in fields:
        np.testing.assert_allclose(field, field[0, 0], rtol=1e-9, atol=1e-3)
    return np.array([field[0, 0] for field in fields]) / 1e6


def planar_block(*overrides):
    e = engine(BLOCK, 'mesh.geometry="planar"', *overrides)
    e.first = e.state.q[:2].copy()
    return e, *np.meshgrid(e.grid.r - 0.4, e.grid.z - 0.5)


@pytest.mark.parametrize(("degrees", "expected"), [
    (30, (75.0, 25.0, 43.301)), (90, (0.0, 100.0, 0.0)), (360, (100.0, 0.0, 0.0)), (-30, (75.0, 25.0, -43.301))])
def test_stress_turns_with_a_rigid_block(degrees, expected):
    e, r, z = planar_block()
    e.state.srr[0][e.grid.inside] = 100e6
    rate = np.radians(np.sign(degrees)) / 1e-6
    driven(e, -rate * z, rate * r, 1e-6, abs(degrees))
    stress = deviators(e)
    np.testing.assert_allclose(stress, expected, atol=0.1)
    assert von_mises(*stress) == pytest.approx(von_mises(100.0, 0.0, 0.0), rel=1e-11)
    assert np.all(e.state.ep == 0.0)


@pytest.mark.parametrize("steps", [100, 200])
def test_rotation_converges_at_second_order(steps):
    """Per step the angle is 2 atan(spin/2): the error of a turn is 2 pi spin^2/12."""
    e, r, z = planar_block()
    e.state.srr[0][e.grid.inside] = 100e6
    spin = 2 * np.pi / steps
    driven(e, -spin / 1e-6 * z, spin / 1e-6 * r, 1e-6, steps)
    angle = steps * 2 * np.arctan(spin / 2)
    np.testing.assert_allclose(deviators(e), 100 * np.array(
        [np.cos(angle) ** 2, np.sin(angle) ** 2, np.sin(angle) * np.cos(angle)]), atol=1e-7)


@pytest.mark.parametrize(("strain", "srz", "srr"), [(0.1, 2.59567e3, 0.129892e3), (1.0, 21.8782e3, 11.9521e3)])
def test_simple_shear_with_jaumanns_rate(strain, srz, srr):
    """s_rz = G sin(gamma), s_rr = G (1 - cos(gamma))."""
    e, r, z = planar_block()
    driven(e, strain / 1000 / 1e-7 * z, np.zeros_like(r), 1e-7, 1000)
    np.testing.assert_allclose(deviators(e), (srr, -srr, srz), rtol=2e-3)


def test_simple_shear_beyond_yield():
    e, r, z = planar_block('materials.metal.strength.yield_stress="300 MPa"')
    driven(e, 1e-3 / 1e-7 * z, np.zeros_like(r), 1e-7, 1000)
    rr, zz, rz = deviators(e)
    assert rz == pytest.approx(173.2013, rel=1e-5)
    assert rr == pytest.approx(1.1538, rel=2e-3)
    assert von_mises(rr, zz, rz) == pytest.approx(300.0, rel=1e-12)
    elastic = 300e6 / (3 * 26e9) * np.sqrt(3)
    ep = e.grid.interior(e.state.ep[0])
    np.testing.assert_allclose(ep, (1.0 - elastic) / np.sqrt(3), rtol=1e-4)
