"""Two groups of bodies in contact: apertures of faces, flow through them, and volumes that pressure moves between cells."""

from math import sqrt

from hydro2d.jit import point
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, CM_IN, CM_OUT, FACE_R
from hydro2d.physics.traction import FILM, smoothstep

#: share of void in a cell of both groups up to which they touch
GAP = 0.01
#: share of a difference of p_c between two neighbouring cells of the surface that evens out in a step
EVENING = 0.05


@point
def end_apertures(first, last):
    """Apertures of a face at both ends, open where the level is 0 or more; levels at the ends, linear between.

    With the length a open from one end they are (2 a - a^2, a^2): the integrals of the two linear shape functions over a, as a
    share of the whole integral of 1/2.
    """
    if first >= 0.0 and last >= 0.0:
        return 1.0, 1.0
    if first < 0.0 and last < 0.0:
        return 0.0, 0.0
    if first >= 0.0:
        a = first / (first - last)
        return (2.0 - a) * a, a * a
    a = last / (last - first)
    return a * a, (2.0 - a) * a


@point
def known(aperture, soft_mass, hard_mass):
    """Aperture of the hard group at a vertex, 1 or 0 where one group is alone there."""
    if hard_mass == 0.0:
        return 0.0
    return 1.0 if soft_mass == 0.0 else aperture


@point
def dual_share(g, j, i, mesh_box, volume, metrics, hard, soft):
    """Share of the dual cell of vertex (j, i), as far as it lies in the mesh, that group g fills."""
    whole, part = 0.0, 0.0
    for row in range(max(j - 1, mesh_box[0]), min(j + 1, mesh_box[1])):
        for column in range(max(i - 1, mesh_box[2]), min(i + 1, mesh_box[3])):
            corner = volume[row, column] * (metrics[CM_OUT, column] if column < i else metrics[CM_IN, column])
            whole += corner
            part += corner * (hard[row, column] if g == 1 else soft[row, column])
    return part / whole


@point
def gas_share(j, i, hard, soft, firm):
    """Share of cell (j, i) that gases fill; firm : shares that the other bodies of either group fill [b, j, i]."""
    return (hard[j, i] - firm[1, j, i]) + (soft[j, i] - firm[0, j, i])


@point
def weight_beside(j, i, row, column, hard, soft, firm):
    """Weight of the aperture in cell (j, i) for the face shared with (row, column), which may be full of one group.

    The face of a full cell next to a gap belongs to the full cell alone: void cannot press on it. Gas in (j, i) is as good as
    void, and where there is more of it than a FILM, a cell with as much void or gas counts as full: the least share of what
    presses there would throw the gas, which weighs nothing.

    firm : shares that the bodies of the soft and of the hard group other than gases fill [b, j, i]
    """
    gap = smoothstep((1.0 - firm[1, j, i] - firm[0, j, i]) / GAP - 0.5)
    void, gas = 1.0 - hard[row, column] - soft[row, column], gas_share(row, column, hard, soft, firm)
    full = smoothstep(1.0 - (void + max(gas - FILM, 0.0)) / GAP)
    beside = smoothstep(gas_share(j, i, hard, soft, firm) / FILM)
    return 1.0 - gap * ((1.0 - beside) * full + beside * smoothstep(1.0 - max(void + gas - FILM, 0.0) / GAP))


@point
def weights_beside(j, i, row, column, hard, soft, firm):
    """`weight_beside` of cell (j, i) and of its neighbour (row, column) for the face between them."""
    return weight_beside(j, i, row, column, hard, soft, firm), weight_beside(row, column, j, i, hard, soft, firm)


@point
def own_inward(j, i, mesh_box, constrained, share):
    """Direction from vertex (j, i) into bodies that fill `share` of the cells: towards the 16 cells around it, by share over
    distance squared.

    A unit vector, or (0, 0) where they cancel. The axis and walls are mirrors; beyond other edges there is nothing.
    """
    along_r, along_z = 0.0, 0.0
    for row in range(j - 2, j + 2):
        for column in range(i - 2, i + 2):
            at_j, at_i = row, column
            if row < mesh_box[0] and constrained[2] == mesh_box[0]:
                at_j = 2 * mesh_box[0] - 1 - row
            if row >= mesh_box[1] and constrained[3] == mesh_box[1]:
                at_j = 2 * mesh_box[1] - 1 - row
            if column < mesh_box[2] and constrained[0] == mesh_box[2]:
                at_i = 2 * mesh_box[2] - 1 - column
            if column >= mesh_box[3] and constrained[1] == mesh_box[3]:
                at_i = 2 * mesh_box[3] - 1 - column
            if mesh_box[0] <= at_j < mesh_box[1] and mesh_box[2] <= at_i < mesh_box[3]:
                y, x = row - j + 0.5, column - i + 0.5
                part = share[at_j, at_i] / (x * x + y * y)
                along_r += part * x
                along_z += part * y
    size = sqrt(along_r * along_r + along_z * along_z)
    return (along_r / size, along_z / size) if size > 1e-12 else (0.0, 0.0)


@point
def meeting(j, i, mesh_box, hard, soft):
    """Whether both groups are in cell (j, i), or one group is and the other fills a cell next to it except for 1.5 GAP."""
    h, s = hard[j, i] > 0.0, soft[j, i] > 0.0
    if h and s:
        return True
    for row, column in ((j - 1, i), (j + 1, i), (j, i - 1), (j, i + 1)):
        if mesh_box[0] <= row < mesh_box[1] and mesh_box[2] <= column < mesh_box[3]:
            if (soft[row, column] if h else hard[row, column]) >= 1.0 - 1.5 * GAP:
                return True
    return False


@point
def blend(aperture, hard, soft):
    """Velocity of a face at one end: the hard group's by its aperture, the soft group's by 1 minus the aperture."""
    return aperture * hard + (1.0 - aperture) * soft


@point
def face_flow_r(j, i, g, aperture_r, u):
    """Sum of the velocities of both ends of r-face (j, i), m/s: of group g, or of both by aperture for g < 0."""
    if g >= 0:
        return u[g, j, i] + u[g, j + 1, i]
    return blend(aperture_r[0, j, i], u[1, j, i], u[0, j, i]) + blend(aperture_r[1, j, i], u[1, j + 1, i], u[0, j + 1, i])


@point
def face_flow_z(j, i, g, metrics, aperture_z, v):
    """Volume per time and radian through z-face (j, i), m^3/s: of group g, or of both by aperture for g < 0."""
    if g >= 0:
        return metrics[AZ_IN, i] * v[g, j, i] + metrics[AZ_OUT, i] * v[g, j, i + 1]
    return metrics[AZ_IN, i] * blend(aperture_z[0, j, i], v[1, j, i], v[0, j, i]) + metrics[AZ_OUT, i] * blend(
        aperture_z[1, j, i], v[1, j, i + 1], v[0, j, i + 1])


@point
def volume_rate(j, i, g, metrics, h, aperture_r, aperture_z, u, v):
    """Rate of change of the volume of cell (j, i) with the velocities of group g, or with both by aperture for g < 0."""
    radial = metrics[FACE_R, i + 1] * face_flow_r(j, i + 1, g, aperture_r, u) - metrics[FACE_R, i] * face_flow_r(j, i, g,
                                                  aperture_r, u)
    axial = face_flow_z(j + 1, i, g, metrics, aperture_z, v) - face_flow_z(j, i, g, metrics, aperture_z, v)
    return 0.5 * h * radial + axial


@point
def alternation(difference, here, there):
    """Part of a difference of p_c + q between two cells of the surface that goes up and down from cell to cell, Pa.

    here, there : by how much either cell exceeds the mean of its neighbours in the surface. A pattern of alternating sign has
    them opposite, a field that is linear along the surface has none, one that bends has them alike.
    """
    if here > 0.0 > there and difference > 0.0:
        return min(difference, min(here, -there))
    if here < 0.0 < there and difference < 0.0:
        return max(difference, max(here, -there))
    return 0.0


@point
def evened_volume(compliance, difference):
    """Volume that evens out a difference of p_c + q between two cells of the surface in a step (sliding, equation 8).

    compliance : V/K of the stiffer cell, m^3/Pa per radian;  difference : Pa
    """
    return EVENING * compliance * difference


@point
def closed_volume(area, dt, excess, rho, modulus):
    """Void that a full cell closes in a step dt: its face moves as fast as an acoustic wave, p/(rho c) (sliding, equation 9).

    area : of the face, across the surface, m^2 per radian;  excess : pressure beyond that of the void, Pa;
    rho, modulus : of the full cell, kg/m^3 and Pa
    """
    return area * dt * excess / sqrt(rho * modulus)


@point
def largest_of(g, j, i, group, vof):
    """Body of group g that fills the most of cell (j, i), -1 if none does."""
    largest, most = -1, 0.0
    for m in range(vof.shape[0]):
        if group[m] == g and vof[m, j, i] > most:
            largest, most = m, vof[m, j, i]
    return largest
