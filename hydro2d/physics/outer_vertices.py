"""Vertices outside of the cells that a body fills: how they are held by it (explanation/mixed-cells, equations 14 to 16)."""

from math import sqrt

from hydro2d.jit import point
from hydro2d.physics.edges import is_constrained
from hydro2d.physics.traction import smoothstep

#: velocity of a solid layer relative to its body, over the sound speed, from which the body does not hold it
GENTLE = 3e-3
#: velocity by the slope of the body, over the sound speed, that is noise
NOISE = 1e-9
#: rows of `anchors`: places and weights of the vertices that hold one
ROW, COLUMN, WEIGHT = range(3)
#: rows of `anchored`: velocity of an anchor before; mass that it takes over and momentum along r and z: from vertices below it,
#: above it and beside it, three rows each, so that a mirror image adds the same numbers in the same order
START_R, START_Z, TAKEN = range(3)
#: filled share of a cell up to which it does not count as full
PARTLY = 0.99
#: length of the mean normal of the cells around a vertex from which the vertex is held in full
CLEAR = 0.5


@point
def fullness(share):
    """Weight with which a cell with this filled share counts as full: 0 up to PARTLY, 1 without void."""
    return smoothstep((share - PARTLY) / (1.0 - PARTLY))


@point
def clearness(length):
    """Weight of a normal that is the mean of unit normals, by its length."""
    return smoothstep(length / CLEAR)


@point
def borne_share(filled, away, across):
    """Pressure half-way into the outermost layer over that of the cell inward of it: linear from there to the surface.

    filled : share of the cell that the layer fills; away : distance of the inner cell's centre along the normal, m; across :
    width of the cell along the normal, m. The inner centre lies away + (filled - 1/2) across under the surface, the middle of
    the layer filled across/2; at most a half.
    """
    depth, inner = 0.5 * filled * across, away + (filled - 0.5) * across
    return depth / inner if inner > 2.0 * depth else 0.5


@point
def lost_by_hold(inward, own, most):
    """Velocity into its body that a held vertex loses, m/s: by how much it sinks faster than `own`; negative if it gains some.

    inward : its velocity relative to the body, towards it;  own : that by the slope of the body's own velocity, by which the
    layer is compressed or stretched with it;  most : the velocity that the tensile strength of the body takes from a vertex
    that parts. Without tensile strength nothing pulls: a vertex that moves outward loses nothing.
    """
    if most == 0.0:
        return max(inward - max(own, 0.0), 0.0)
    return max(inward - own, -most)


@point
def gentleness(apart, sound):
    """Weight with which a solid takes its layer along: 1 where it moves with the body, 0 in a flow.

    apart : velocity of the layer relative to the body, m/s;  sound : sound speed, m/s. From GENTLE sound on, the layer flies.
    """
    return 1.0 - smoothstep(2.0 * abs(apart) / (GENTLE * sound) - 1.0)


@point
def beyond_noise(own, sound):
    """The part of a velocity beyond NOISE of the sound speed, m/s.

    A layer that followed the slope of its body to the last bit would feed noise back to it: round-off grew by e in 170 cycles.
    """
    return own - min(max(own, -NOISE * sound), NOISE * sound)


@point
def is_beside_open_edge(j, i, mesh_box, constrained):
    """Whether a cell around vertex (j, i) lies at an edge of the mesh that prescribes no velocity."""
    return ((i <= mesh_box[2] + 1 and constrained[0] < 0) or (i >= mesh_box[3] - 1 and constrained[1] < 0)
            or (j <= mesh_box[0] + 1 and constrained[2] < 0) or (j >= mesh_box[1] - 1 and constrained[3] < 0))


@point
def is_plain_fluid(j, i, gases, strong, vof):
    """Whether a cell contains neither a gas nor a body with strength."""
    plain = True
    for m in range(vof.shape[0]):
        plain = plain and not (vof[m, j, i] > 0.0 and (gases[m] or strong[m]))
    return plain


@point
def inward_step(j, i, n_r, n_z, dr, dz):
    """(step_r, step_z): a step of one cell inward from vertex (j, i), in columns and rows; n_r, n_z : outward normal."""
    step_r, step_z = -2.0 * n_r / (dr[i - 1] + dr[i]), -2.0 * n_z / (dz[j - 1] + dz[j])
    size = sqrt(step_r * step_r + step_z * step_z)
    return step_r / size, step_z / size


@point
def is_free(j, i, constrained):
    """Whether no edge prescribes (the radial, the axial) velocity of vertex (j, i)."""
    constrained_r, constrained_z = is_constrained(j, i, constrained)
    return not constrained_r, not constrained_z


@point
def taken(k, j, i, anchored):
    """Mass (k = 0) or momentum along r or z (k = 1, 2) that anchor (j, i) takes over from below, above and beside."""
    return (anchored[TAKEN + k, j, i] + anchored[TAKEN + 3 + k, j, i]) + anchored[TAKEN + 6 + k, j, i]


@point
def gain(j, i, held, mass, constrained, anchored):
    """(radial, axial) velocity that an anchor gains with all that it holds, m/s; none where an edge prescribes its velocity.

    held : share of the mass of a vertex that is held [j, i];  mass : of the vertices [j, i], kg per radian
    """
    free_r, free_z = is_free(j, i, constrained)
    whole = (1.0 - held[j, i]) * mass[j, i] + taken(0, j, i, anchored)
    u = taken(1, j, i, anchored) / whole if free_r and whole > 0.0 else 0.0
    v = taken(2, j, i, anchored) / whole if free_z and whole > 0.0 else 0.0
    return u, v


@point
def anchor(j, x, k, anchors):
    """(row, column, weight) of the k-th anchor of held vertex x of row j."""
    return int(anchors[j, x, ROW, k]), int(anchors[j, x, COLUMN, k]), anchors[j, x, WEIGHT, k]


@point
def start_anchor(j, i, u, v, anchored):
    """The velocity of vertex (j, i) before it holds others, and no mass and momentum taken over yet.

    Writes   anchored [11, j, i]
    """
    anchored[START_R, j, i] = u[j, i]
    anchored[START_Z, j, i] = v[j, i]
    for k in range(TAKEN, TAKEN + 9):
        anchored[k, j, i] = 0.0
