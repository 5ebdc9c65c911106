"""Slave nodes: how firmly they are tied, and to which masters, all of it continuous in the fractions of the cells."""

import numpy as np
import pytest

from hydro2d.kernels.contact import extension
from hydro2d.kernels.contact.contact_geometry import REACH
from hydro2d.kernels.contact.extension import MASTERS, SPAN, TIED, UNDERFILLED, find_extensions, find_filled
from hydro2d.mesh.fields import DMG, RHO
from hydro2d.mesh.grid import Grid
from tests.kernels.cells import handle
from tests.physics.continuity import changes_in_proportion, largest_jump

in_debris = extension.in_debris.source
cell_weight = extension.cell_weight.source

#: cells of the mesh along either side, and those of a mesh whose cells differ
N = 11
LEVEL, GRADED = np.arange(N + 1.0), np.cumsum(1.0 + 0.2 * np.sin(np.arange(N + 1.0)))
#: no change so steep that it switches anything at once
STEEPNESS = 2e4


class Extensions:
    """Slaves among all vertices of both groups, where hard fills cells [j, i], a gas of the soft group some share, and its
    other body the rest of them.

    Rows and columns are those of the mesh without ghosts. The normal, from hard to soft, is everywhere the same. A gas has a
    thousandth of the density of the others.
    """

    def __init__(self, hard, normal, soft=None, damage=0.0, most_squares=1e6, edges=LEVEL, constrained=(-1, -1, -1, -1),
                 gas=0.0):
        self.grid = g = Grid(edges, edges, "planar")
        inside, mesh = g.inside, np.s_[g.g:g.g + N + 1, g.g:g.g + N + 1]
        vof, q = np.zeros((3, *g.shape)), np.ones((DMG + 1, 3, *g.shape))
        vof[2][inside], q[RHO, 2] = gas, 1e-3
        vof[1][inside] = hard
        vof[0][inside] = 1.0 - np.asarray(hard) - vof[2][inside] if soft is None else soft
        firm, both_bodies = vof[:2], np.stack([vof[0] + vof[2], vof[1]])
        mass = np.zeros((2, *g.vertex_shape))
        for dj, di in ((0, 0), (0, 1), (1, 0), (1, 1)):
            mass[:, dj:dj + g.shape[0], di:di + g.shape[1]] += 0.25 * both_bodies
        both = (mass > 0.0).all(axis=0)
        count, nodes, first = both.sum(axis=1), np.zeros(both.shape, dtype=np.int64), np.zeros(len(both) + 1, dtype=np.int64)
        for j in range(len(both)):
            nodes[j, : count[j]] = np.nonzero(both[j])[0]
        first[1:] = np.cumsum(count)
        slots, directions = int(first[-1]), np.zeros((3, 2, *both.shape))
        directions[:] = (np.array(normal) / np.hypot(*normal))[:, None, None]
        strength, number = np.zeros((slots, 2)), np.zeros((slots, 2), dtype=np.int64)
        where, weights = np.zeros((slots, 2, MASTERS + 1), dtype=np.int64), np.full((slots, 2, MASTERS + 1), np.nan)
        mesh_box = np.array([g.g, g.g + N, g.g, g.g + N])
        rows, q[DMG] = mesh_box[:2], 0.0
        q[DMG, 1] = damage
        filled, firmly = np.full((2, 2, *g.vertex_shape), np.nan)
        find_filled(0, handle(parts=rows, mesh_box=mesh_box, volume=g.volume, metrics=g.metrics, contact_node_count=count,
                    contact_nodes=nodes, hard=both_bodies[1], soft=both_bodies[0], firm=firm, mass=mass, filled=filled,
                    firmly=firmly))
        find_extensions(0, handle(parts=rows, mesh_box=mesh_box, constrained=np.array(constrained),
                        most_squares=most_squares, r=g.r, z=g.z,
                        contact_node_count=count, contact_nodes=nodes, first_slot=first, contact_normal=directions,
                        hard=both_bodies[1], soft=both_bodies[0], firm=firm, filled=filled, firmly=firmly,
                        inward=np.full((len(both), 4, 36), np.nan), group=np.array([0, 1, 0]), vof=vof, q=q,
                        gases=np.array([False, False, True]), volume=g.volume, metrics=g.metrics, strength=strength,
                        masters=number, where=where, weights=weights))
        self.first, self.mass, self.normal, self.ties = first, mass, directions, (strength, number, where, weights)
        self.count, self.nodes, self.hard = count, nodes, vof[1]
        #: by group, row and column: strength, and weights of all places of masters
        self.strength, self.weights = np.zeros((2, N + 1, N + 1)), np.zeros((2, N + 1, N + 1, MASTERS + 1))
        for j in range(g.g, g.g + N + 1):
            for k in range(count[j]):
                at = (j - g.g, nodes[j, k] - g.g)
                for b in range(2):
                    self.strength[b][at] = strength[first[j] + k, b]
                    n = number[first[j] + k, b]
                    self.weights[b][at][where[first[j] + k, b, :n]] = weights[first[j] + k, b, :n]
        self.slaves = np.argwhere(self.strength > 0.0)
        self.r, self.z = g.r[mesh[1]], g.z[mesh[0]]

    def of(self, b: int, j: int, i: int) -> dict[tuple[int, int], float]:
        """Weights of the masters of a slave by how many rows and columns away they are."""
        places = np.nonzero(self.weights[b, j, i, :MASTERS])[0]
        return {(int(n) // SPAN - REACH, int(n) % SPAN - REACH): self.weights[b, j, i, n] for n in places}

    def everything(self, b: int, j: int, i: int):
        """Strength, and weights as far as they count."""
        return [self.strength[b, j, i], *(self.strength[b, j, i] * self.weights[b, j, i])]


def half_plane(angle: float) -> np.ndarray:
    """Fractions of material on the side opposite to (cos, sin) of a line through the middle of cells of one size."""
    inside = (np.arange(20) + 0.5) / 20
    x = (np.arange(N)[:, None] + inside).ravel() - 0.5 * N + 0.1
    below = x[None, :] * np.cos(angle) + x[:, None] * np.sin(angle) <= 0.0
    return below.reshape(N, 20, N, 20).mean(axis=(1, 3))


def scattered(seed: int) -> np.ndarray:
    return np.clip(np.random.default_rng(seed).normal(half_plane(0.7), 0.3), 0.0, 1.0)


def block(**cells: float) -> np.ndarray:
    """A hard block of 3 x 3 cells from row and column 4 on, with other fractions in cells named like r5c4."""
    hard = np.zeros((N, N))
    hard[4:7, 4:7] = 1.0
    for name, fraction in cells.items():
        hard[int(name[1]), int(name[3])] = fraction
    return hard


# ---------------------------------------------------------------------------------------------------- small pieces


def test_debris_is_failed_material_of_the_other_group_that_fills_half_of_a_cell():
    vof, q = np.zeros((2, 6, 6)), np.zeros((DMG + 1, 2, 6, 6))
    vof[1, 2, 3], q[DMG, 1, 2, 3] = 0.5, 1.0
    mesh_box, group = np.array([0, 6, 0, 6]), np.array([0, 1])
    assert [(j, i) for j in range(7) for i in range(7) if in_debris(0, j, i, handle(mesh_box=mesh_box, group=group, vof=vof,
                                                                    q=q))] == [
        (2, 3), (2, 4), (3, 3), (3, 4)]
    assert not in_debris(1, 2, 3, handle(mesh_box=mesh_box, group=group, vof=vof, q=q))
    vof[1, 2, 3] = 0.49
    assert not in_debris(0, 2, 3, handle(mesh_box=mesh_box, group=group, vof=vof, q=q))
    vof[1, 2, 3], q[DMG, 1, 2, 3] = 1.0, 0.99
    assert not in_debris(0, 2, 3, handle(mesh_box=mesh_box, group=group, vof=vof, q=q))


@pytest.mark.parametrize(("row", "column", "expected"), [(5, 5, (0.5 / 0.5) ** 4), (5, 6, (1.5 / 2.5) ** 4), (5, 4, 0.0),
                                                         (8, 6, (1.5 / 14.5) ** 4)])
def test_a_cell_counts_by_its_distance_and_direction(row, column, expected):
    """From a vertex at its lower left, along r; nothing behind it and nothing beyond the mesh."""
    g = Grid(LEVEL, LEVEL, "planar")
    share, filled = np.ones(g.shape), np.ones(g.vertex_shape)
    for size in (9, 8, 6):
        mesh_box = np.array([0, size, 0, size])
        weight = cell_weight(5, 5, row, column, 1.0, 0.0, share, filled, handle(mesh_box=mesh_box))
        assert weight == pytest.approx(expected if row < size and column < size else 0.0)


# ------------------------------------------------------------------------------------------------------ beside a gas


def beside_gas(firm: float) -> Extensions:
    """A hard block to the left; to the right of it gas in the lower half and a soft solid in the upper one, with a share of
    that in the lowest of its cells, beside the block."""
    hard, soft, gas = np.zeros((3, N, N))
    hard[:, :4], hard[:, 4] = 1.0, 0.8
    soft[6:, 5:], soft[6:, 4] = 1.0, 0.2
    gas[:6, 5:], gas[:6, 4] = 1.0, 0.2
    soft[5, 4], gas[5, 4] = 0.2 * firm, 0.2 * (1.0 - firm)
    return Extensions(hard, (1.0, 0.0), soft, gas=gas)


def test_a_solid_is_not_tied_to_the_gas_beside_it():
    """The vertex at the end of the solid's edge has a master in the gas for as much of its mass as is gas."""
    found = beside_gas(0.5)
    assert found.strength[0, 6, 4] == 1.0
    in_gas = sum(weight for (dj, _), weight in found.of(0, 6, 4).items() if dj < 0)
    assert sum(found.of(0, 6, 4).values()) == pytest.approx(1.0, rel=1e-12)
    assert abs(in_gas) < 2e-3
    deep = found.of(0, 2, 4)  # in the gas
    assert sum(deep.values()) == pytest.approx(1.0, rel=1e-12)
    assert min(dj for dj, _ in deep) < 0 < max(dj for dj, _ in deep)


def test_a_solid_comes_into_a_gas_without_a_jump():
    assert largest_jump(lambda firm: beside_gas(firm).everything(0, 5, 4), 0.0, 1.0) < 1e-9


# ---------------------------------------------------------------------------------------------------- extensions

MESHES = [*((scattered(seed), (0.76, 0.64)) for seed in range(3)), *((half_plane(a), (np.cos(a), np.sin(a))) for a in (
    0.0, 0.4, np.pi / 4, 1.3, 2.5)), (block(), (1.0, 0.0)), (block(), (-0.6, 0.8))]


@pytest.mark.parametrize(("hard", "normal"), MESHES)
@pytest.mark.parametrize("most_squares", [1.0, 1e6])
def test_weights_add_up_to_one(hard, normal, most_squares):
    extensions = Extensions(hard, normal, most_squares=most_squares)
    assert len(extensions.slaves) >= 8
    for b, j, i in extensions.slaves:
        assert extensions.weights[b, j, i].sum() == pytest.approx(1.0, abs=1e-13)
    assert (extensions.weights[extensions.strength == 0.0] == 0.0).all()


@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 4, 1.3, 2.5])
@pytest.mark.parametrize("edges", [LEVEL, GRADED], ids=["level", "graded"])
def test_a_linear_field_is_met(angle, edges):
    """As long as it is a mean of cell values, and nothing is capped."""
    extensions = Extensions(half_plane(angle), (np.cos(angle), np.sin(angle)), edges=edges)
    field = 3.0 - 2.0 * extensions.r[None, :] + 0.7 * extensions.z[:, None]
    extended = 0
    for b, j, i in extensions.slaves:
        if 3 <= j <= N - 3 and 3 <= i <= N - 3:
            masters = extensions.of(b, j, i)
            assert extensions.weights[b, j, i, TIED] == 0.0
            assert sum(w * field[j + dj, i + di] for (dj, di), w in masters.items()) == pytest.approx(field[j, i], rel=1e-12)
            extended += 1
    assert extended >= 8


@pytest.mark.parametrize(("hard", "normal"), MESHES)
def test_means_of_cells_are_bounded_too(hard, normal):
    extensions = Extensions(hard, normal, most_squares=1.5)
    assert max(np.sum(extensions.weights[b, j, i] ** 2) for b, j, i in extensions.slaves) <= 1.5 + 1e-12


@pytest.mark.parametrize(("hard", "normal"), MESHES)
def test_a_mirrored_slave_has_mirrored_masters(hard, normal):
    here = Extensions(hard, normal, most_squares=2.0)
    along_r = Extensions(hard[:, ::-1], (-normal[0], normal[1]), most_squares=2.0)
    along_z = Extensions(hard[::-1], (normal[0], -normal[1]), most_squares=2.0)
    square = (2, N + 1, N + 1, SPAN, SPAN)
    for mirrored, axis in ((along_r, 2), (along_z, 1)):
        np.testing.assert_allclose(np.flip(mirrored.strength, axis), here.strength, atol=1e-14)
        turned = np.flip(mirrored.weights[..., :MASTERS].reshape(square), (axis, axis + 2))
        np.testing.assert_allclose(turned, here.weights[..., :MASTERS].reshape(square), atol=1e-14)
        np.testing.assert_allclose(np.flip(mirrored.weights[..., TIED], axis), here.weights[..., TIED], atol=1e-14)


# ---------------------------------------------------------------------------------------------- continuity


def walked(values, fill, b, j, i, normal=(1.0, 0.0)):
    """Asserts that no result for a slave jumps at these values of a fraction, or anywhere between 0 and 1."""
    def of(fraction):
        return Extensions(fill(fraction), normal).everything(b, j, i)

    for value in values:
        changes_in_proportion(of, value, STEEPNESS)
    assert largest_jump(of, 1e-3, 1.0 - 1e-3) < 1e-9
    return of


def test_a_node_becomes_a_slave_by_degrees():
    """The share of a vertex goes through UNDERFILLED (0.1) and SURE (0.5)."""
    def fill(fraction):
        hard = np.zeros((N, N))
        hard[:, :5], hard[:, 5], hard[4, 4], hard[5, 5] = 1.0, 0.1, 0.8, fraction
        return hard

    of = walked((0.1, 0.5), fill, 1, 5, 5)
    assert [of(f)[0] for f in (0.05, 0.3, 0.9)] == pytest.approx([1.0, 0.5, 0.0])


@pytest.mark.parametrize("j", [5, 6])
def test_a_cell_is_a_master_by_degrees(j):
    """The least filled vertex of the only cell that counts goes through UNDERFILLED (0.2) and SURE (0.6)."""
    def fill(fraction):
        return block(r4c5=0.4, r5c4=0.4, r4c4=fraction)

    of = walked((0.2, 0.6), fill, 1, j, 7)
    corners = [(dj - j, di - 7) for dj in (5, 6) for di in (5, 6)]
    with_cell, without = (Extensions(fill(f), (1.0, 0.0)).of(1, j, 7) for f in (0.9, 0.1))
    assert set(with_cell) == set(corners)
    assert min(without.values()) > 0.0  # the mean of vertices
    assert of(0.9) != of(0.1)


def test_a_vertex_is_a_master_by_degrees_and_the_other_group_in_the_end():
    """A block of two by two cells has one full vertex, which goes through UNDERFILLED (0) and SURE (0.4)."""
    def fill(fraction):
        hard = np.zeros((N, N))
        hard[4:6, 4:6] = [[1.0, 0.6], [0.4, fraction]]
        return hard

    walked((0.4,), fill, 1, 5, 6)
    assert Extensions(fill(0.9), (1.0, 0.0)).of(1, 5, 6) == {(0, -1): 1.0}
    alone = Extensions(fill(1e-3), (1.0, 0.0))
    assert alone.weights[1, 5, 6, TIED] > 0.9
    changes_in_proportion(lambda f: Extensions(fill(f), (1.0, 0.0)).everything(1, 5, 6), 1e-12, STEEPNESS, sides=(1.0,))


@pytest.mark.parametrize("seed", range(4))
def test_nothing_jumps_as_any_cell_fills(seed):
    """All slaves along a whole path from one scattered filling to another."""
    first, last = 0.02 + 0.96 * scattered(seed), 0.02 + 0.96 * scattered(seed + 10)

    def everything(way):
        extensions = Extensions((1.0 - way) * first + way * last, (0.76, 0.64), most_squares=2.0)
        firmly = extensions.strength[..., None] * extensions.weights
        return np.concatenate([extensions.strength.ravel(), firmly.ravel()])

    assert largest_jump(everything, 0.0, 1.0) < 1e-9


def pair(beyond: float) -> Extensions:
    """A crumb of both groups in void, by itself, and a hard block whose only vertex in reach is filled by UNDERFILLED and
    `beyond`."""
    hard, soft = np.zeros((N, N)), np.zeros((N, N))
    hard[4:6, 2:4] = UNDERFILLED + beyond
    hard[5, 5] = soft[5, 5] = 0.2
    return Extensions(hard, (1.0, 0.0), soft)
