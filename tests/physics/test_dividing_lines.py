"""The line between the groups in a cell: shares of the solids, misfits, and bodies that end in void along a common rim."""

import numpy as np
import pytest

from hydro2d.mesh.grid import Grid
from hydro2d.physics import dividing_lines
from hydro2d.physics.contact_faces import GAP
from hydro2d.physics.dividing_lines import BETWEEN, SEPARATION_FULL, SEPARATION_START, STEEPER
from hydro2d.physics.interfaces import youngs_gradient
from tests.physics.continuity import changes_in_proportion

steeper = dividing_lines.steeper.py_func
separation_weight = dividing_lines.separation_weight.py_func
share_at = dividing_lines.share_at.py_func
share_fall = dividing_lines.share_fall.py_func
void_around = dividing_lines.void_around.py_func
misfit = dividing_lines.misfit.py_func
fitting_line = dividing_lines.fitting_line.py_func

#: cells of the mesh along either side, after the ghosts, and the cell in its middle
N, MIDDLE = 5, 4
LEVEL, GRADED = np.arange(N + 1.0), np.cumsum(1.0 + 0.3 * np.sin(np.arange(N + 1.0)))
meshes = pytest.mark.parametrize("edges", [LEVEL, GRADED], ids=["level", "graded"])
#: places of a rim or a face in a cell
OFFSETS = (0.1, 0.3, 0.5, 0.7, 0.9)


class Shares:
    """Shares of the hard and the soft group in the cells of a planar mesh; the ghosts are unknown."""

    def __init__(self, hard, soft, edges=LEVEL):
        self.grid = g = Grid(edges, edges, "planar")
        self.hard, self.soft = np.full((2, *g.shape), np.nan)
        self.hard[g.inside], self.soft[g.inside] = hard, soft
        #: what functions of a cell take: the mesh and the shares, and with the sizes of the cells
        self.both = np.array([g.g, g.g + N, g.g, g.g + N]), self.hard, self.soft
        self.mesh = *self.both, g.dr, g.dz

    def slopes(self, j: int, i: int) -> tuple[float, float, float, float]:
        """Youngs' slopes of the hard and of the soft group."""
        return tuple(slope for f in (self.hard, self.soft) for slope in youngs_gradient.py_func(
            j, i, *(f[j + b, i + a] for b, a in (
                (-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))), self.grid.dr, self.grid.dz))

    def line(self, j: int, i: int) -> tuple[float, float, float]:
        """`fitting_line` of a cell: (normal of size |n_r| + |n_z| = 1, share of the hard side)."""
        share = self.hard[j, i] / (self.hard[j, i] + self.soft[j, i])
        n_r, n_z, share = fitting_line(j, i, share, *self.slopes(j, i), *self.mesh)
        size = abs(n_r) + abs(n_z)
        return n_r / size, n_z / size, share


def below(n_r: float, n_z: float, level: float, edges=LEVEL) -> np.ndarray:
    """Shares of the cells on the side n_r r + n_z z <= level, with exact areas: corners are cut off one after the other."""
    shares = np.zeros((N, N))
    for j in range(N):
        for i in range(N):
            corners = [(edges[i + a], edges[j + b]) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            kept = []
            for (r, z), (r2, z2) in zip(corners, corners[1:] + corners[:1], strict=True):
                here, there = level - n_r * r - n_z * z, level - n_r * r2 - n_z * z2
                kept += [(r, z)] if here >= 0.0 else []
                if here * there < 0.0:
                    part = here / (here - there)
                    kept.append((r + part * (r2 - r), z + part * (z2 - z)))
            x, y = np.array(kept).T if kept else np.zeros((2, 1))
            whole = (edges[i + 1] - edges[i]) * (edges[j + 1] - edges[j])
            shares[j, i] = 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / whole
    return np.clip(shares, 0.0, 1.0)


def filled_to(level: float, edges=LEVEL) -> np.ndarray:
    """Shares of a row of cells up to a place."""
    return np.clip((level - edges[:-1]) / np.diff(edges), 0.0, 1.0)


def rimmed(face: float, hard_rim: float, soft_rim: float, edges=LEVEL) -> Shares:
    """The hard body below the height of the face, the soft one above it, both out to the radius of their rims."""
    low = filled_to(face, edges)
    return Shares(np.outer(low, filled_to(hard_rim, edges)), np.outer(1.0 - low, filled_to(soft_rim, edges)), edges)


# ------------------------------------------------------------------------------------------------ the hard share


def around(hard: float, soft: float) -> Shares:
    """Cells of these shares, and of a quarter of hard body and nothing else at the corner of the mesh."""
    shares = Shares(np.full((N, N), hard), np.full((N, N), soft))
    shares.hard[2, 2], shares.soft[2, 2] = 0.25, 0.0
    return shares


def test_the_share_of_a_cell_with_void_is_known_the_less_the_more_void_there_is():
    """By 1/(1 + (void/GAP)^2), times what is filled."""
    for void, known in ((GAP, 0.5), (2.0 * GAP, 0.2), (0.5, 1.0 / 2501.0)):
        filled = 1.0 - void
        share, weight = share_at(MIDDLE, MIDDLE, *around(0.25 * filled, 0.75 * filled).both)
        assert share == pytest.approx(0.25)
        assert weight == pytest.approx(known * filled)


@meshes
def test_without_void_the_fall_of_the_hard_share_is_youngs_gradient(edges):
    """Which is four times the fall across the cell."""
    hard = np.random.default_rng(5).random((N, N))
    shares = Shares(hard, 1.0 - hard, edges)
    for j in range(3, N + 1):
        for i in range(3, N + 1):
            fall = share_fall(j, i, 0, 1, *shares.mesh), share_fall(j, i, 1, 0, *shares.mesh)
            np.testing.assert_allclose(4.0 * np.array(fall), shares.slopes(j, i)[:2], atol=1e-12)


# ------------------------------------------------------------------------------------------------ void around, misfits


def test_void_around_a_cell_is_the_most_of_nine_cells_in_the_mesh():
    hard, soft = np.full((N, N), 0.4), np.full((N, N), 0.6)
    soft[1, 1], soft[4, 4] = 0.5, 0.1
    shares = Shares(hard, soft)
    assert void_around(2, 2, *shares.both) == void_around(MIDDLE, MIDDLE, *shares.both) == pytest.approx(0.1)
    assert void_around(5, 5, *shares.both) == void_around(6, 6, *shares.both) == pytest.approx(0.5)
    assert void_around(5, 3, *shares.both) == pytest.approx(0.0)


def straight(angle: float, edges=LEVEL) -> tuple[Shares, tuple[float, float, float]]:
    """Bodies on either side of a straight line near the middle of a mesh, and the line of its middle cell."""
    n_r, n_z = np.cos(angle), np.sin(angle)
    at = edges[2] + 0.4 * (edges[3] - edges[2])
    hard = below(n_r, n_z, at * (n_r + n_z), edges)
    wide = edges[3] - edges[2]
    return Shares(hard, 1.0 - hard, edges), (n_r * wide, n_z * wide, hard[2, 2])


ANGLES = pytest.mark.parametrize("angle", [0.0, 0.3, np.pi / 4, 1.4, 2.5, 4.0, 5.5])


@meshes
@ANGLES
def test_a_line_that_fits_has_no_misfit(angle, edges):
    shares, line = straight(angle, edges)
    assert misfit(MIDDLE, MIDDLE, *line, *shares.mesh) < 1e-24
    assert misfit(MIDDLE, MIDDLE, 7.0 * line[0], 7.0 * line[1], line[2], *shares.mesh) < 1e-24  # whatever its length


def test_the_misfit_is_the_sum_of_the_squares_of_what_is_on_the_wrong_side():
    """An upright line in the middle of a cell; 0.2 of the hard body beyond it in one cell, 0.3 of the soft one in another."""
    hard, soft = np.zeros((2, N, N))
    hard[:, :2], hard[:, 2], soft[:, 2], soft[:, 3:] = 1.0, 0.5, 0.5, 1.0
    hard[3, 3], soft[3, 3], hard[1, 1], soft[1, 1] = 0.2, 0.8, 0.7, 0.3
    assert misfit(MIDDLE, MIDDLE, 1.0, 0.0, 0.5, *Shares(hard, soft).mesh) == pytest.approx(0.2**2 + 0.3**2)


@pytest.mark.parametrize("face", OFFSETS)
@pytest.mark.parametrize("rim", OFFSETS)
@pytest.mark.parametrize("wider", [0.05, 0.3, 0.6, 1.0])
def test_bodies_that_change_places_have_the_same_line(face, rim, wider):
    """Whichever is called hard, also where both rims are near and no line fits."""
    here = rimmed(2.0 + face, 2.0 + rim, 2.0 + rim + wider)
    n_r, n_z, share = here.line(MIDDLE, MIDDLE)
    turned = Shares(here.soft[here.grid.inside], here.hard[here.grid.inside])
    assert turned.line(MIDDLE, MIDDLE) == pytest.approx((-n_r, -n_z, 1.0 - share), abs=1e-6)


# ------------------------------------------------------------------------------------------------ the line that fits


@pytest.mark.parametrize("face", OFFSETS)
@pytest.mark.parametrize("rim", OFFSETS)
def test_an_upright_face_below_a_common_top_is_upright(face, rim):
    """The same with rows and columns changed."""
    flat = rimmed(2.0 + face, 2.0 + rim, 2.0 + rim)
    upright = Shares(flat.hard[flat.grid.inside].T, flat.soft[flat.grid.inside].T)
    assert upright.line(MIDDLE, MIDDLE) == pytest.approx((1.0, 0.0, face), abs=1e-6)


def test_a_cell_without_any_slope_has_no_line():
    """It has a crumb of both in void: the neighbours tell nothing."""
    hard, soft = np.zeros((2, N, N))
    hard[2, 2], soft[2, 2] = 0.2, 0.3
    shares = Shares(hard, soft)
    assert fitting_line(MIDDLE, MIDDLE, 0.4, *shares.slopes(MIDDLE, MIDDLE), *shares.mesh) == (0.0, 0.0, 0.4)


@pytest.mark.parametrize("void", [0.0, GAP, 0.1])
def test_the_line_turns_in_proportion_to_the_void(void):
    def line(void):
        shares, _ = straight(0.3)
        shares.soft[3:6, 5] -= void
        return shares.line(MIDDLE, MIDDLE)

    changes_in_proportion(line, void, 2e3, sides=(1.0,) if void == 0.0 else (-1.0, 1.0))


# --------------------------------------------------------------------------------------- which surface draws the line


@pytest.mark.parametrize("ratio", [1.0, 1.0 + STEEPER])
def test_the_steeper_surface_takes_over_without_a_jump(ratio):
    changes_in_proportion(lambda x: steeper(x, 1.0), ratio, 2.0 / STEEPER)
    assert steeper(1.0, 1.0) == 0.0
    assert steeper(1.2, 1.0) == 1.0
    assert steeper(1.0, 1.2) == 0.0


@pytest.mark.parametrize("void", [GAP, 2.0 * GAP])
@pytest.mark.parametrize("whole", [0.5 * BETWEEN, BETWEEN])
def test_void_parts_the_groups_without_a_jump(void, whole):
    changes_in_proportion(lambda x: separation_weight(x, 0.1 * whole, 1.0), void, 2.0 / GAP)
    changes_in_proportion(lambda x: separation_weight(0.1, x, 1.0), whole, 4.0 / BETWEEN)
    assert separation_weight(0.1, 0.0, 1.0) == 1.0
    for void in (SEPARATION_START, SEPARATION_FULL):
        changes_in_proportion(lambda x: separation_weight(x, 1.0, 1.0), void, 2.0 / (SEPARATION_FULL - SEPARATION_START))
    assert separation_weight(0.49, 1.0, 1.0) == 0.0
    assert separation_weight(0.76, 1.0, 1.0) == 1.0
    assert separation_weight(0.5 * GAP, 0.0, 1.0) == separation_weight(0.1, 2.0 * BETWEEN, 1.0) == 0.0
    assert separation_weight(0.1, 0.0, 0.0) == 0.0
