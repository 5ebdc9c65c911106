"""Velocities that edges prescribe: which components of which vertices, and when an edge that only pushes gives one."""

import numpy as np
import pytest

from hydro2d.physics import edges

is_constrained, edge_normal_velocity = edges.is_constrained.py_func, edges.edge_normal_velocity.py_func


def test_an_edge_holds_the_component_across_it():
    constrained = np.array([2, 9, -1, 7, -1, -1, -1, -1])
    assert is_constrained(4, 2, constrained) == (True, False)
    assert is_constrained(4, 9, constrained) == (True, False)
    assert is_constrained(7, 5, constrained) == (False, True)
    assert is_constrained(7, 2, constrained) == (True, True)
    assert is_constrained(4, 5, constrained) == (False, False)


@pytest.mark.parametrize(("edge", "free", "after"), [(0, 4.0, 4.0), (0, -4.0, 1.0), (1, 4.0, 1.0), (1, -4.0, -4.0),
                                                     (2, 4.0, 4.0), (3, 4.0, 1.0)])
def test_an_edge_that_only_pushes_lets_go_what_leaves_it(edge, free, after):
    assert edge_normal_velocity(edge, True, 1.0, free) == after
    assert edge_normal_velocity(edge, False, 1.0, free) == 1.0
