"""Velocities that edges of the mesh prescribe at a vertex.

`constrained` has two columns and two rows of vertices whose normal velocity is prescribed, then two columns and two rows where
the velocity along the edge is as well; -1 for none.
"""

from hydro2d.jit import point


@point
def is_constrained(j, i, constrained):
    """Whether edges prescribe the radial, and whether they prescribe the axial velocity of vertex (j, i).

    constrained : int64[8]
    """
    radial = i == constrained[0] or i == constrained[1] or j == constrained[6] or j == constrained[7]
    axial = j == constrained[2] or j == constrained[3] or i == constrained[4] or i == constrained[5]
    return radial, axial


@point
def edge_normal_velocity(edge, only_pushes, given, free):
    """Normal velocity of a vertex at an edge, m/s: the prescribed one, or its own if it leaves an edge that only pushes.

    edge : 0 to 3, `hydro2d.mesh.edges.base.EDGES`
    """
    return free if only_pushes and (free > 0.0 if edge % 2 == 0 else free < 0.0) else given
