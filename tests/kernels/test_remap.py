"""The remap: the quantities that each advection choice keeps, and its entries in the audit."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.kernels import momentum
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, mesh, stop, table, walls
from tests.kernels.pieces import constrain, ghost_vertices, sweep_faces
from tests.kernels.test_interfaces import by_stream_function, carry, in_a_box, vortex

GEOMETRIES = ("cylindrical", "planar")


def box_with(**aluminium) -> str:
    """A ball of tungsten in a box between walls, with aluminium around it, between its z and its r if given."""
    return (
        mesh([{"to": 0.5, "cells": 8}, {"cells": 5, "ratio": 1.1}], [{"to": 0.6, "cells": 9}, {"cells": 4, "ratio": 1.15}],
             geometry="cylindrical")
        + walls("r_max", "z_min", "z_max")
        + body("tungsten", "W_alloy", "sphere", centre=0.3, radius=0.26)
        + box("aluminium", "Al7039", **aluminium)
        + table("numerics", active_region=False)
        + table("failure", damage="material")
        + stop(1.0)
    )


FULL = box_with(z=[0.0, 9.0])
WITH_VOID = box_with(z=[0.13, 0.77], r=[0.0, 0.83])


def engine(text: str, *overrides: str):
    return Simulation(deck.loads(text, overrides)).engine


def disturbed(e, seed: int, size: float = 1.0):
    """Random fields in every body and random velocities, zero at the walls."""
    s, g = e.state, e.grid
    random = np.random.default_rng(seed)
    inside = (slice(None), *g.inside)
    present = s.vof[inside] > 0
    noise = [0.02, 2e4, 2e7, 2e7, 2e7, 0.1, 0.1]
    s.rho[inside] *= 1.0 + size * noise[0] * random.uniform(-1, 1, size=present.shape)
    s.q[(slice(1, 5), *inside)] += np.where(present, size * random.normal(size=(4, *present.shape)), 0.0) * np.reshape(
        noise[1:5], (4, 1, 1, 1))
    s.q[(slice(5, 7), *inside)] += np.where(present, size * random.uniform(size=(2, *present.shape)), 0.0) * 0.1
    moving = s.mass[0][g.inside_vertices] > 0
    for w in (s.u, s.v):
        w[0][g.inside_vertices] = np.where(moving, 100.0 * random.normal(size=moving.shape), 0.0)
    e.prepare()
    constrain(e)
    e.audit = None
    e.prepare()


def remap_only(e, share: float = 0.3):
    """One remap by the given velocities: dt such that the fastest vertex crosses `share` of the smallest cell.

    The Lagrangian step that the remap undoes changes the volumes: densities and fractions follow the swept volumes.
    """
    s, g = e.state, e.grid
    ghost_vertices(e)
    s.u0[...], s.v0[...] = s.u, s.v
    e.dt = share * min(g.dr.min(), g.dz.min()) / np.hypot(s.u, s.v).max()
    sweep_faces(e)
    change = (s.fr[:-1, 1:] - s.fr[:-1, :-1]) + (s.fz[1:, :-1] - s.fz[:-1, :-1])
    stretch = np.ones(g.shape)
    stretch[g.inside] += change[g.inside] / g.volume[g.inside]
    void = 1.0 - s.vof.sum(axis=0)
    filled = np.where(void > 1e-12, np.minimum(1.0, stretch / np.maximum(s.vof.sum(axis=0), 1e-300)), stretch)
    s.vof[...] = np.where(s.vof == 1.0, 1.0, s.vof * filled / stretch)
    s.rho[...] /= filled
    for second, (dj, di) in enumerate(((0, 1), (1, 0)) if e.number % 2 == 0 else ((1, 0), (0, 1))):
        e.remap_bodies(dj, di, second)
        e.remap_momentum(dj, di, second)
    e.number += 1


@pytest.mark.parametrize("choice", momentum.ADVECTIONS)
@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("text", [FULL, WITH_VOID], ids=["full", "with void"])
def test_remap_conserves(choice, geometry, text):
    e = engine(text, f'numerics.advection="{choice}"', f'mesh.geometry="{geometry}"')
    disturbed(e, 3)
    for _ in range(4):
        remap_only(e)
    balance, sinks = e.audit.balance(e.state), e.audit.sinks
    assert np.abs(balance["mass"]).max() < 1e-13
    assert abs(balance["axial_momentum"]) < 1e-13
    assert abs(balance["total_energy"]) < 1e-13
    start = e.audit.start.energy
    if choice == "momentum":
        assert sinks["advection"].energy > 1e-4 * start
    if choice == "both":
        assert abs(sinks["advection"].energy) < 1e-13 * start
    if choice != "ke":
        assert abs(sinks["advection"].momentum) < 1e-13 * np.sqrt(2 * start * e.audit.start.mass.sum())
    else:
        assert sinks["advection"].momentum != 0.0
        assert abs(sinks["advection"].energy) < 1e-13 * start
        assert sinks["ke_bound"].energy > 1e-4 * start


def test_unbounded_ke_keeps_kinetic_energy():
    """Where no flow hits a wall, `ke` without its bound keeps the kinetic energy."""
    e = engine(WITH_VOID, 'mesh.geometry="planar"', "numerics.ke_bound=1e9", 'numerics.advection="ke"')
    disturbed(e, 4)
    e.state.u[..., : e.grid.g + 3] = e.state.u[..., -e.grid.g - 3 :] = 0.0
    e.state.v[:, : e.grid.g + 3] = 0.0
    start = 0.5 * np.sum(e.state.mass * (e.state.u**2 + e.state.v**2))
    remap_only(e)
    assert abs(e.audit.sinks["advection"].energy) < 1e-13 * start


def test_uniform_state_stays_uniform_in_a_vortex():
    """Swept volumes without divergence, a body that fills the mesh: every field stays uniform."""
    e = engine(in_a_box(24, box("circle", "W_alloy", z=[0.0, 1.0], energy=2.5)))
    s, g = e.state, e.grid
    for k, value in enumerate((18000.0, 5e4, 3e8, -1e8, 2e8, 0.3)):
        g.interior(s.q)[k] = value
    carry(e, by_stream_function(e, lambda x, y, t: vortex(x, y, t, 9.0), 0.4 / 24), 40)
    for k, value in enumerate((18000.0, 5e4, 3e8, -1e8, 2e8, 0.3)):
        np.testing.assert_allclose(g.interior(s.q)[k], value, rtol=1e-12)


COLUMN = (
    mesh((2.0, 2), (460.0, 460), geometry="planar")
    + walls("r_max")
    + box("gas", "gas_7_5", z=[0.0, 250.0])
    + table("numerics", active_region=False)
    + stop(1.0)
)


def carried(choice: str, profile, share: float, steps: int, bound: float = 1e9):
    """Radial velocity as a passive quantity, carried along z by `share` of a cell a step: before, after."""
    e = engine(COLUMN, f'numerics.advection="{choice}"', f"numerics.ke_bound={bound}")
    s, g = e.state, e.grid
    e.edges.constrained[:] = -1  # walls at the sides would stop it
    s.u[0] = profile(g.z)[:, None]
    first = s.u[0, :, g.g + 1].copy()
    s.fz[g.g:g.g + g.nz + 1, :-1] = share
    for _ in range(steps):
        s.u[...] = s.u[:, :, g.g + 1:g.g + 2]  # the mirror at the sides turns the sign
        for w, w0 in ((s.u, s.u0), (s.v, s.v0)):
            w0[...] = w
        e.remap_bodies(1, 0, 1)
        e.remap_momentum(1, 0, 1)
    moved = share * steps
    exact = np.clip(250.0 + moved - g.z_edges[:-1], 0.0, 1.0) * np.clip(g.z_edges[1:] - moved, 0.0, 1.0)
    np.testing.assert_allclose(g.interior(s.vof[0])[:, 0], exact, atol=1e-7)
    return first, s.u[0, :, g.g + 1].copy(), e


def top_hat(z):
    return ((z > 75) & (z <= 125)) * 1.0


def bump(z):
    return np.where((z > 75) & (z < 125), np.sin(np.pi * (z - 75) / 50) ** 2, 0.0)


def test_two_parcels():
    """A quarter of the vertex's mass comes in at 1 m/s, three quarters are at rest."""
    for choice, u, kinetic in (("momentum", 0.25, 0.25**2), ("both", 0.25, 0.25**2), ("ke", 0.5, 0.25)):
        _, after, _ = carried(choice, lambda z: (z <= 100.0) * 1.0, 0.25, 1)
        front = after[2 + 101]
        assert front == pytest.approx(u, rel=1e-14)
        assert front**2 == pytest.approx(kinetic, rel=1e-14)
    first, after, e = carried("both", lambda z: (z <= 100.0) * 1.0, 0.25, 1)
    # energy of the mesh, two columns wide: the energy lost by the velocities is heat
    assert np.sum(e.grid.interior(e.state.e[0])) == pytest.approx(2 * 0.5 * 0.25 * 0.75, rel=1e-13)


@pytest.mark.parametrize(("profile", "kept"), [(top_hat, 0.9526), (bump, 0.9981)])
def test_passive_velocity_keeps_its_energy(profile, kept):
    first, after, _ = carried("momentum", profile, 0.5, 400)
    assert np.sum(after) == pytest.approx(np.sum(first), rel=1e-12)
    assert np.sum(after**2) / np.sum(first**2) == pytest.approx(kept, abs=5e-3)


@pytest.mark.parametrize(("profile", "gained"), [(top_hat, 1.0557), (bump, 0.9955)])
def test_passive_velocity_by_kinetic_energy(profile, gained):
    first, after, _ = carried("ke", profile, 0.5, 400)
    assert np.sum(after**2) == pytest.approx(np.sum(first**2), rel=1e-12)
    assert np.sum(after) / np.sum(first) == pytest.approx(gained, abs=5e-3)
