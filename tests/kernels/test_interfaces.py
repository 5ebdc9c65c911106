"""Interfaces: circles, bodies and spheres in prescribed flows."""

from functools import partial

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.kernels import interfaces
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, mesh, stop, table, walls
from tests.kernels.cells import handle
from tests.physics.continuity import changes_in_proportion, largest_jump

#: E_geo = sum |f - f0| h^2 of Youngs' method with directionally split sweeps, from a prototype: flow, cells -> error
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
    """Stream function of Rider & Kothe, J. Comput. Phys. 141 (1998) 112: a vortex that reverses."""
    return np.sin(np.pi * x) ** 2 * np.sin(np.pi * y) ** 2 * np.cos(np.pi * t / period) / np.pi


def rotation(x, y, t):
    """Stream function of a rigid rotation in unit time, fixed at the walls."""
    return -np.pi * np.minimum((x - 0.5) ** 2 + (y - 0.5) ** 2, 0.25)


FLOWS = {"vortex 2": (partial(vortex, period=2.0), 2.0, 1.0), "vortex 8": (partial(vortex, period=8.0), 8.0, 1.0),
         "rotation": (rotation, 1.0, np.pi)}


def carry(engine, flow, steps: int) -> None:
    """Carries the bodies of an engine by the program's own interfaces and remap: flow(step) sets the swept volumes.

    No body has a velocity.
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
    """Swept volumes free of divergence to the last bit: differences of the stream function at mid-step."""
    s, g = engine.state, engine.grid
    r, z = np.meshgrid(g.r_edges, g.z_edges)
    rows, columns = g.inside_vertices

    def flow(step):
        psi = dt * stream(r, z, (step + 0.5) * dt)
        s.fr[rows, columns][:-1] = np.diff(psi, axis=0)
        s.fz[rows, columns][:, :-1] = -np.diff(psi, axis=1)

    return flow


@pytest.mark.thorough
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
    np.testing.assert_allclose(g.interior(s.rho[0])[vof > 0], 1.0, atol=1e-7)  # cells that lack less than the cutoff are filled


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
    """u = -C/r: the square of every radius falls by 2 C t; an interface straight in r^2/2 is kept exactly."""
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


#: no body a gas, and only the second of three bodies a gas
SOLIDS, GAS_BETWEEN = np.zeros(3, dtype=bool), np.array([False, True, False])
ONE_GROUP = np.zeros(3, dtype=np.int64)
#: the mesh goes on around the middle one of 5 x 5 cells, and no cell is in a contact
INSIDE, NO_CONTACT = np.array([0, 5, 0, 5]), np.zeros((5, 2), dtype=np.int64)
#: its row, as a part of the mesh
ONE_ROW = np.array([2, 3])


# ------------------------------------------------------------------------------------------- thin bodies among others

fill_strips = interfaces.fill_strips.source
nest = interfaces.nest.source
thinnest_body = interfaces.thinnest_body.py_func
keeps_order = interfaces.keeps_order.py_func
SHARE, ALONG, ACROSS, THIN = interfaces.SHARE, interfaces.ALONG, interfaces.ACROSS, interfaces.THIN

#: upright slabs that meet in the middle one of five columns: one that goes on to the left, a plate, one to the right
SLABS = ((-2.5, -0.2), (-0.2, 0.0), (0.0, 2.5))


def stack(slabs=SLABS, along_z=False):
    """(fractions, centroids) of slabs in 5 x 5 cells, upright or level; places from the middle of the middle cell on."""
    faces = np.arange(6) - 2.5
    vof, place = np.zeros((len(slabs), 5, 5)), np.zeros((2, len(slabs), 5, 5))
    for m, (first, last) in enumerate(slabs):
        low, high = np.clip(faces[:-1], first, last), np.clip(faces[1:], first, last)
        cut = (high > low) & (high - low < 1.0)
        vof[m], place[0, m] = high - low, np.where(cut, 0.5 * (low + high) - (faces[:-1] + 0.5), 0.0)
    if along_z:
        return vof.swapaxes(1, 2).copy(), place[::-1].swapaxes(2, 3).copy()
    return vof, place


def in_strip(slab, low, high):
    """(share, moment along in widths of the strip, moment across) of a slab between two places of the cell."""
    first, last = max(slab[0], low), min(slab[1], high)
    share = max(last - first, 0.0)
    return share, share * (0.5 * (first + last) - 0.5 * (low + high)) / (high - low), 0.0


def strips_of(vof, centroid, order, along_z=False, widths=(0.4, 0.6, 1.0), gases=SOLIDS, last=interfaces.ALL):
    strips = np.full((3, 4, len(vof)), np.nan)
    void = 1.0 - vof[:, 2, 2].sum()
    fill_strips(2, 2, last, widths, np.array(order), vof, void, strips, handle(
        dj=int(along_z), group=ONE_GROUP[:len(vof)], gases=gases, centroid=centroid, dr=np.ones(5), dz=np.ones(5)))
    return strips


def test_a_plate_next_to_void_keeps_its_place_too():
    """A gas from the left, a plate 0.2 thick behind a gap of 0.1, and no other body."""
    slabs = ((-2.5, -0.2), (-0.1, 0.1))
    for order in ((0, 1), (1, 0)):
        strips = strips_of(*stack(slabs), order)
        for n, ends in enumerate([(-0.5, -0.1), (-0.1, 0.5), (-0.5, 0.5)]):
            expected = np.transpose([in_strip(slab, *ends) for slab in slabs])
            np.testing.assert_allclose(strips[n, SHARE, 1], expected[SHARE, 1], atol=1e-14)
            np.testing.assert_allclose(strips[n, ALONG, 1], expected[ALONG, 1], atol=1e-14)
        assert strips[2, SHARE] == pytest.approx([0.3, 0.2], abs=1e-14)


def test_no_two_bodies_are_thin_without_each_other():
    """How thin a body is counts only with another in its cell or around; next to void alone its own `piece` handles it."""
    vof, _ = stack()
    thin = np.full(3, np.nan)
    assert thinnest_body(2, 2, False, np.arange(3), vof, thin) == 1.0
    assert thin.tolist() == [0.0, 1.0, 0.0]
    assert thinnest_body(2, 1, False, np.arange(3), vof, thin) == 0.0
    assert thin.tolist() == [0.0, 0.0, 0.0]
    vof[[0, 2], :, 2] = 0.0  # the plate is alone in its cell, between two bodies
    assert thinnest_body(2, 2, False, np.arange(3), vof, thin) == 1.0
    assert thin.tolist() == [0.0, 1.0, 0.0]
    vof[[0, 2]] = 0.0
    assert thinnest_body(2, 2, False, np.arange(3), vof, thin) == 0.0
    vof, _ = stack(((-2.5, 0.0), (0.0, 2.5)))
    vof[0, 2, 1], vof[0, [1, 3], 1], vof[0, :, 0] = 0.975, 0.975, 0.5
    assert thinnest_body(2, 2, False, np.arange(2), vof, thin[:2]) == pytest.approx(0.5)


def test_bodies_keep_their_order_next_to_another_group():
    vof, _ = stack()
    two_groups = np.array([1, 0, 0])
    assert keeps_order(2, 2, two_groups, SOLIDS, vof, 0.0) == (1.0, 1.0)
    assert keeps_order(2, 3, two_groups, SOLIDS, vof, 0.0) == (1.0, 1.0)  # some of the first body is in the next cell
    vof[0, :, 2] = 0.0
    assert keeps_order(2, 3, two_groups, SOLIDS, vof, 0.0) == (0.0, 0.0)
    vof[0, 1, 4] = 0.5 * interfaces.MEETING
    assert keeps_order(2, 3, two_groups, SOLIDS, vof, 0.0) == pytest.approx((0.5, 0.5))


def test_void_parts_the_groups_of_a_contact_and_the_order_ends():
    """Without a jump; the gap between them still identifies them."""
    vof, _ = stack()
    two_groups = np.array([1, 0, 0])

    def order(void):
        return keeps_order(2, 2, two_groups, SOLIDS, vof, void)

    assert order(interfaces.PARTING) == order(0.5) == (0.0, 1.0)
    assert order(0.5 * interfaces.PARTING) == pytest.approx((0.5, 1.0))
    for void in (0.0, interfaces.PARTING):
        changes_in_proportion(order, void, 1.5 / interfaces.PARTING, sides=(1.0,))
    assert keeps_order(2, 2, ONE_GROUP, GAS_BETWEEN, vof, 0.5) == (1.0, 1.0)  # a gas keeps it


@pytest.mark.parametrize("along_z", [False, True])
def test_of_contact_interface_cells_within_the_mesh_only_the_centroids_are_worked_out(along_z):
    vof, exact = stack(along_z=along_z)
    dj, di = (1, 0) if along_z else (0, 1)
    mixed, face = np.full((5, 5), 2, dtype=np.int64), np.zeros((5, 5))
    face[2, 2], face[2 + dj, 2 + di] = -0.1, 0.6
    columns = np.tile([2, 3], (5, 1))
    for mesh_box, left in ((INSIDE, True), (np.array([2, 3, 2, 3]), False)):
        centroid = exact.copy()
        centroid[:, [0, 2], 2, 2] = 0.0
        flux, place = np.zeros((3, 5, 5)), np.zeros((2, 3, 5, 5))
        interfaces.interface_volumes.source(0, handle(
            parts=ONE_ROW, dj=dj, di=di, mesh_box=mesh_box, contact_columns=columns, dr=np.ones(5), dz=np.ones(5),
            interface_order=np.arange(3), group=ONE_GROUP, gases=SOLIDS, mixed_count=np.ones(5, dtype=np.int64), mixed=mixed,
            face=face, pre_sweep_volume=np.ones((5, 5)), vof=vof, centroid=centroid, flux_volume=flux, flux_place=place,
            strips=np.zeros((5, 3, 4, 3))))
        np.testing.assert_allclose(centroid, exact, atol=1e-14)
        assert flux.any() != left


def test_bodies_become_thin_without_a_jump():
    """As the body to the left of a plate ceases to fill a cell, and as it vanishes; its centroid is not that of the slab."""
    vof, centroid = stack()
    centroid[:, 0, 2, 2] = -0.1, 0.1

    def strips(share):
        f = vof.copy()
        f[0, :, :2] *= share
        return strips_of(f, centroid, (0, 1, 2))[:, :THIN]

    assert np.abs(strips(1.0) - strips(0.9)).max() > 0.01
    for share in (1.0, 0.95):
        changes_in_proportion(strips, share, 30.0, sides=(-1.0,))
    assert largest_jump(strips, 0.0, 1.0) < 1e-11


def test_nested_bodies_come_in_their_order_or_the_thin_ones_first():
    """All weighted: with the plate last in the order, the line between it and void decides, otherwise its own box."""
    vof, centroid = stack(((-2.5, -0.2), (-0.1, 0.1)))
    strips = np.zeros((3, 4, 2))
    strips[0, THIN] = 0.0, 1.0
    widths, names = (0.4, 0.0, 0.0), handle(dj=0, centroid=centroid, dr=np.ones(5), dz=np.ones(5))
    nest(2, 2, interfaces.ALL, widths, True, 0.25, np.arange(2), vof, 0.5, False, strips, names)
    np.testing.assert_allclose(strips[0, SHARE], [0.25 * 0.3, 0.0], atol=1e-15)
    assert not strips[1:, :THIN].any()
    nest(2, 2, interfaces.ALL, widths, False, 0.75, np.arange(2), vof, 0.5, False, strips, names)
    np.testing.assert_allclose(strips[0, SHARE], [0.3, 0.75 * 0.1], atol=1e-14)  # the plate follows the gas


@pytest.mark.parametrize("along_z", [False, True])
def test_a_mixed_cell_says_where_its_bodies_lie_in_what_it_gives(along_z):
    """A tenth goes to the left, and six tenths to the right: places in these, and centroids that were not known."""
    vof, exact = stack(along_z=along_z)
    centroid = exact.copy()
    centroid[:, [0, 2], 2, 2] = 0.0  # those that neighbours place are found, however little was known
    dj, di = (1, 0) if along_z else (0, 1)
    mixed, face = np.full((5, 5), 2, dtype=np.int64), np.zeros((5, 5))
    face[2, 2], face[2 + dj, 2 + di] = -0.1, 0.6
    flux, place = np.zeros((3, 5, 5)), np.full((2, 3, 5, 5), np.nan)
    interfaces.interface_volumes.source(0, handle(
        parts=ONE_ROW, dj=dj, di=di, mesh_box=INSIDE, contact_columns=NO_CONTACT, dr=np.ones(5), dz=np.ones(5),
        interface_order=np.arange(3), group=ONE_GROUP, gases=SOLIDS, mixed_count=np.ones(5, dtype=np.int64), mixed=mixed,
        face=face, pre_sweep_volume=np.ones((5, 5)), vof=vof, centroid=centroid, flux_volume=flux, flux_place=place,
        strips=np.zeros((5, 3, 4, 3))))
    np.testing.assert_allclose(flux[:, 2, 2], [-0.1, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(flux[:, 2 + dj, 2 + di], [0.0, 0.1, 0.5], atol=1e-15)
    np.testing.assert_allclose(place[:, :, 2, 2], [[0.0, 0.0, 0.0]] * 2, atol=1e-14)
    np.testing.assert_allclose(place[0, :, 2 + dj, 2 + di], [0.0, (0.05 - 0.3) / 0.6, (0.35 - 0.3) / 0.6], atol=1e-14)
    np.testing.assert_allclose(place[1, :, 2 + dj, 2 + di], 0.0, atol=1e-14)
    np.testing.assert_allclose(centroid, exact, atol=1e-14)
