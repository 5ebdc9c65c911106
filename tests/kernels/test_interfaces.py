"""Interfaces: circles, bodies and spheres in prescribed flows."""

from functools import partial

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.kernels import interfaces
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, mesh, stop, table, walls
from tests.physics.continuity import changes_in_proportion, largest_jump

#: E_geo = sum |f - f0| h^2 of Youngs' method with directionally split sweeps, a prototype's: flow, cells -> error
YOUNGS = {
    ("vortex 2", 32): 2.98e-3,
    ("vortex 2", 64): 8.38e-4,
    ("vortex 2", 128): 2.92e-4,
    ("vortex 8", 32): 6.50e-2,
    ("vortex 8", 64): 1.22e-2,
    ("vortex 8", 128): 2.23e-3,
    ("rotation", 32): 1.31e-3,
    ("rotation", 64): 4.04e-4,
    ("rotation", 128): 1.96e-4,
}


def in_a_box(n: int, *bodies: str, geometry: str = "planar") -> str:
    """Bodies in a box of n x n cells with sides of 1 m."""
    sides = mesh((1.0, n), (1.0, n), geometry=geometry) + walls("r_max", "z_min", "z_max")
    return sides + "".join(bodies) + table("numerics", active_region=False) + stop(1.0)


CIRCLE = body("circle", "gas_7_5", "sphere", centre=[0.5, 0.75], radius=0.15, energy=2.5)


def vortex(x, y, t, period):
    """Stream function of Rider & Kothe, J. Comput. Phys. 141 (1998) 112: a vortex that turns back."""
    return np.sin(np.pi * x) ** 2 * np.sin(np.pi * y) ** 2 * np.cos(np.pi * t / period) / np.pi


def rotation(x, y, t):
    """Stream function of a rigid rotation in unit time, held at the walls."""
    return -np.pi * np.minimum((x - 0.5) ** 2 + (y - 0.5) ** 2, 0.25)


FLOWS = {"vortex 2": (partial(vortex, period=2.0), 2.0, 1.0), "vortex 8": (partial(vortex, period=8.0), 8.0, 1.0),
         "rotation": (rotation, 1.0, np.pi)}


def carry(engine, flow, steps: int) -> None:
    """Carries the bodies of an engine by the program's own interfaces and remap: flow(step) sets the swept volumes.

    Nothing has a velocity.
    """
    for step in range(steps):
        flow(step)
        for second, (dj, di) in enumerate(((0, 1), (1, 0)) if step % 2 == 0 else ((1, 0), (0, 1))):
            engine.remap_bodies(dj, di, second)
            engine.remap_momentum(dj, di, second)
        vof = engine.state.vof
        assert vof.min() >= 0.0
        assert np.sum(vof, axis=0).max() <= 1.0 + 1e-12


def by_stream_function(engine, stream, dt: float):
    """Swept volumes that are free of divergence to the last bit: differences of the stream function at mid-step."""
    s, g = engine.state, engine.grid
    r, z = np.meshgrid(g.r_edges, g.z_edges)
    rows, columns = g.inside_vertices

    def flow(step):
        psi = dt * stream(r, z, (step + 0.5) * dt)
        s.fr[rows, columns][:-1] = np.diff(psi, axis=0)
        s.fz[rows, columns][:, :-1] = -np.diff(psi, axis=1)

    return flow


@pytest.mark.parametrize(("name", "n"), list(YOUNGS))
def test_circle_in_a_flow(name, n):
    stream, period, fastest = FLOWS[name]
    engine = Simulation(deck.loads(in_a_box(n, CIRCLE))).engine
    s, g = engine.state, engine.grid
    first = g.interior(s.vof[0]).copy()
    steps = int(np.ceil(period * fastest * n / 0.5))  # half a cell a step
    carry(engine, by_stream_function(engine, stream, period / steps), steps)
    vof = g.interior(s.vof[0])
    assert np.mean(np.abs(vof - first)) < 1.5 * YOUNGS[name, n]
    mass = np.sum(g.interior(s.vof[0] * s.rho[0])) + engine.audit.sinks["cutoff"].mass[0] * n * n
    assert mass == pytest.approx(np.sum(first), rel=1e-12)
    np.testing.assert_allclose(g.interior(s.e[0])[vof > 0], 2.5, rtol=1e-11)  # round-off over what little a cell keeps
    np.testing.assert_allclose(g.interior(s.rho[0])[vof > 0], 1.0, atol=1e-7)  # what lacks less than the cutoff is made full


def test_three_bodies_without_void_fill_every_cell():
    half, rest = box("half", "gas_5_3", r=[0.0, 0.5], z=[0.0, 1.0]), box("rest", "gas_7_5", z=[0.0, 1.0])
    engine = Simulation(deck.loads(in_a_box(32, CIRCLE, half, rest))).engine
    s, g = engine.state, engine.grid
    before = g.interior(s.vof * s.rho).sum(axis=(1, 2))
    assert np.abs(g.interior(s.vof).sum(axis=0) - 1.0).max() < 1e-12
    carry(engine, by_stream_function(engine, rotation, 1.0 / 256), 128)
    assert np.abs(g.interior(s.vof).sum(axis=0) - 1.0).max() < 1e-12
    after = g.interior(s.vof * s.rho).sum(axis=(1, 2)) + 32**2 * engine.audit.sinks["cutoff"].mass
    np.testing.assert_allclose(after, before, rtol=1e-12)


RING = (
    mesh((1.0, 40), (0.2, 8))
    + walls("z_min", "z_max")
    + box("ring", "gas_7_5", r=[0.63, 0.81], z=[0.0, 0.2])
    + table("numerics", active_region=False)
    + stop(1.0)
)


def test_ring_that_shrinks_keeps_its_volume():
    """u = -C/r: the square of every radius falls by 2 C t; a straight interface in r^2/2 is kept exactly."""
    engine = Simulation(deck.loads(RING)).engine
    s, g = engine.state, engine.grid
    step, steps = 2e-4, 400

    def flow(_):
        s.fr[:, g.g + 1:] = -step * g.dz[0]

    carry(engine, flow, steps)
    low, high = (0.5 * radius**2 - step * steps for radius in (0.63, 0.81))
    edges = 0.5 * g.r_edges**2
    exact = np.clip(np.minimum(high, edges[1:]) - np.maximum(low, edges[:-1]), 0.0, None) / np.diff(edges)
    np.testing.assert_allclose(g.interior(s.vof[0]), np.broadcast_to(exact, (8, 40)), atol=1e-7)
    volume = np.sum(g.interior(s.vof[0] * s.rho[0] * g.volume))
    assert volume + engine.audit.sinks["cutoff"].mass[0] == pytest.approx((high - low) * 0.2, rel=1e-12)


@pytest.mark.parametrize(("n", "error"), [(16, 4e-5), (32, 2e-5)])
def test_sphere_moved_along_the_axis_and_back(n, error):
    sphere = body("circle", "gas_7_5", "sphere", centre=0.3, radius=0.2, energy=2.5)
    engine = Simulation(deck.loads(in_a_box(n, sphere, geometry="cylindrical"))).engine
    s, g = engine.state, engine.grid
    first = g.interior(s.vof[0]).copy()

    def flow(step):
        s.fz[g.g + 1:g.g + n, :-1] = (0.4 if step < n else -0.4) * g.dz[0] * g.vol_r

    carry(engine, flow, 2 * n)
    volume = g.interior(g.volume)
    change = np.sum(volume * np.abs(g.interior(s.vof[0]) - first))
    assert change < error
    mass = np.sum(volume * g.interior(s.vof[0] * s.rho[0])) + engine.audit.sinks["cutoff"].mass[0]
    assert mass == pytest.approx(np.sum(volume * first), rel=1e-12)


def given(dj: int, void: float, w_low: float = 0.1, w_high: float = 0.2, everywhere: bool = False) -> np.ndarray:
    """What a cell gives of a body that has a corner there and of the one around it through both of its faces.

    The void is in the cell alone, or everywhere as a share of the body around.
    """
    edge = np.clip(2.5 - np.arange(5), 0.0, 1.0)
    body = np.outer(edge, edge)
    rest = 1.0 - body
    if everywhere:
        rest *= 1.0 - void / 0.75
    else:
        rest[2, 2] -= void
    vof = np.array([body, rest])
    mixed, face, flux = np.full((5, 5), 2, dtype=np.int64), np.zeros((5, 5)), np.zeros((2, 5, 5))
    face[2, 2], face[2 + dj, 3 - dj] = -w_low, w_high
    interfaces.interface_volumes_row.py_func(2, dj, 1 - dj, np.ones(5), np.ones(5), np.arange(2), np.ones(5, dtype=np.int64),
                                             mixed, face, np.ones((5, 5)), vof, np.zeros((2, 2, 5, 5)), flux,
                                             np.zeros((2, 2, 5, 5)), np.zeros((5, 3, 4, 2)))
    return np.array([flux[:, 2, 2], flux[:, 2 + dj, 3 - dj]])


@pytest.mark.parametrize("dj", [0, 1])
def test_what_a_cell_gives_does_not_jump_as_its_void_opens(dj):
    np.testing.assert_allclose(given(dj, 0.0).sum(axis=1), [-0.1, 0.2], rtol=1e-15)
    np.testing.assert_allclose(given(dj, 0.3)[:, 0], [-0.05, 0.0], rtol=1e-15)
    for void in (0.0, 1e-12):
        changes_in_proportion(lambda share: given(dj, share), void, 5.0, sides=(1.0,))
    assert largest_jump(lambda share: given(dj, share), 0.0, 0.5) < 1e-11
    assert largest_jump(lambda share: given(dj, share), 0.5e-12, 1.5e-12) < 1e-14


@pytest.mark.parametrize("dj", [0, 1])
def test_what_a_cell_gives_does_not_jump_as_the_body_around_a_corner_becomes_thin(dj):
    """With void everywhere the body around fills no cell any more: it comes first, by a box of its own."""
    def amidst_void(void):
        return given(dj, void, everywhere=True)

    np.testing.assert_allclose(amidst_void(0.3)[:, 1], [-0.1 * 0.45, 0.2 * 0.45], rtol=1e-14)  # it goes on beside the cell
    for void in (0.0, 0.75 * 0.05):
        changes_in_proportion(amidst_void, void, 30.0, sides=(1.0,))
    assert largest_jump(amidst_void, 0.0, 0.5) < 1e-11
