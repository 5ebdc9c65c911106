"""Vertices outside of full cells: what counts as full, what a cut cell bears, and when a vertex is held."""

import numpy as np
import pytest

from hydro2d.physics import outer_vertices
from hydro2d.physics.outer_vertices import CLEAR, GENTLE, NOISE, PARTLY, TAKEN
from tests.physics.continuity import changes_in_proportion

fullness = outer_vertices.fullness.py_func
clearness = outer_vertices.clearness.py_func
borne_share = outer_vertices.borne_share.py_func
lost = outer_vertices.lost_by_hold.py_func


def test_only_a_cell_without_void_is_full():
    assert [fullness(x) for x in (0.0, PARTLY, 0.5 * (1.0 + PARTLY), 1.0)] == pytest.approx([0.0, 0.0, 0.5, 1.0])
    assert fullness(1.0) == 1.0


def test_normals_that_cancel_hold_nothing():
    assert [clearness(x) for x in (0.0, 0.5 * CLEAR, CLEAR, 1.0)] == [0.0, 0.5, 1.0, 1.0]


@pytest.mark.parametrize("filled", [1e-6, 0.3, 0.9, 1.0])
def test_pressure_falls_linearly_to_the_surface(filled):
    """In a column under gravity the cell beneath bears filled + 1/2 of a cell, the layer half of its own."""
    assert borne_share(filled, 2.0, 2.0) == pytest.approx(0.5 * filled / (filled + 0.5))


def test_a_layer_never_bears_more_than_half():
    assert borne_share(0.1, 0.0, 2.0) == borne_share(0.1, 0.8, 2.0) == 0.5
    changes_in_proportion(lambda away: borne_share(0.3, away, 1.0), 0.5, 5.0)


def test_without_tensile_strength_a_vertex_loses_what_it_sinks_and_nothing_as_it_parts():
    assert lost(3.0, 0.0, 0.0) == lost(3.0, -1.0, 0.0) == 3.0
    assert lost(3.0, 2.0, 0.0) == 1.0
    assert lost(3.0, 4.0, 0.0) == 0.0
    assert lost(-3.0, 0.0, 0.0) == lost(-3.0, -4.0, 0.0) == 0.0


def test_noise_has_no_slope():
    beyond = outer_vertices.beyond_noise.py_func
    assert beyond(0.5 * NOISE * 5000.0, 5000.0) == beyond(-NOISE * 5000.0, 5000.0) == 0.0
    assert beyond(1.0, 5000.0) == 1.0 - NOISE * 5000.0
    assert beyond(-1.0, 5000.0) == -1.0 + NOISE * 5000.0


def test_a_layer_that_flies_is_not_held():
    gentleness = outer_vertices.gentleness.py_func
    assert gentleness(0.0, 5000.0) == gentleness(-0.5 * GENTLE * 5000.0, 5000.0) == 1.0
    assert gentleness(0.75 * GENTLE * 5000.0, 5000.0) == pytest.approx(0.5)
    assert gentleness(-GENTLE * 5000.0, 5000.0) == 0.0


#: columns 2 to 4 and rows 2 to 6 of a mesh with walls at its left and lower edge: places of the edges that prescribe a velocity
BOX, WALLS = (2, 7, 2, 5), np.array([2, -1, 2, -1, -1, -1, -1, -1])


def test_vertices_beside_open_edges():
    beside = outer_vertices.is_beside_open_edge.py_func
    assert [beside(2, i, BOX, WALLS) for i in range(2, 6)] == [False, False, True, True]
    assert [beside(j, 2, BOX, WALLS) for j in range(2, 8)] == [False, False, False, False, True, True]
    assert beside(3, 3, BOX, np.array([-1, 5, 2, 7, -1, -1, -1, -1]))


def test_a_plain_fluid_is_neither_a_gas_nor_strong():
    plain, vof = outer_vertices.is_plain_fluid.py_func, np.array([0.5, 0.0])[:, None, None]
    assert plain(0, 0, [False, True], [False, True], vof)
    assert not plain(0, 0, [True, False], [False, False], vof)
    assert not plain(0, 0, [False, False], [True, False], vof)


def test_a_step_inward_is_a_cell_long():
    step = outer_vertices.inward_step.py_func
    assert step(1, 1, 0.0, 1.0, [1.0, 3.0], [1.0, 1.0]) == (0.0, -1.0)
    assert step(1, 1, 0.6, 0.8, [1.0, 1.0], [1.0, 1.0]) == pytest.approx((-0.6, -0.8))
    assert step(1, 1, 0.6, 0.8, [2.0, 2.0], [1.0, 1.0]) == pytest.approx(np.array([-0.3, -0.8]) / np.hypot(0.3, 0.8))


def test_edges_prescribe_velocities():
    free = outer_vertices.is_free.py_func
    assert free(3, 3, WALLS) == (True, True)
    assert free(3, 2, WALLS) == (False, True)
    assert free(2, 3, WALLS) == (True, False)
    assert free(7, 5, np.array([-1, 5, -1, 7, -1, -1, -1, -1])) == (False, False)
    held = np.array([2, 5, 2, 7, -1, 5, -1, 7])
    assert free(3, 5, held) == free(7, 3, held) == (False, False)


def test_an_anchor_gains_the_momentum_of_all_three_sides():
    anchored, held, mass = np.zeros((11, 9, 7)), np.full((9, 7), 0.25), np.full((9, 7), 4.0)
    anchored[TAKEN:, 3, 3] = 1.0, 2.0, -1.0, 2.0, 3.0, -2.0, 4.0, 5.0, -7.0
    assert [outer_vertices.taken.py_func(k, 3, 3, anchored) for k in range(3)] == [7.0, 10.0, -10.0]
    gain = outer_vertices.gain.py_func
    assert gain(3, 3, held, mass, WALLS, anchored) == (1.0, -1.0)
    assert gain(3, 3, held, mass, np.array([3, -1, -1, -1, -1, -1, -1, -1]), anchored) == (0.0, -1.0)
    assert gain(3, 4, np.ones((9, 7)), mass, WALLS, anchored) == (0.0, 0.0)


def test_an_anchor_starts_with_its_velocity_and_nothing_taken():
    anchored, u, v = np.full((11, 2, 2), 9.0), np.full((2, 2), 3.0), np.full((2, 2), 4.0)
    outer_vertices.start_anchor.py_func(0, 1, u, v, anchored)
    assert list(anchored[:, 0, 1]) == [3.0, 4.0, *9 * [0.0]]
    assert np.all(anchored[:, 1] == 9.0)
    anchors = np.zeros((1, 2, 3, 4))
    anchors[0, 1, :, 2] = 5.0, 6.0, 0.25
    assert outer_vertices.anchor.py_func(0, 1, 2, anchors) == (5, 6, 0.25)
