"""Contents of a cell: gases, groups, several bodies, the surface between them and its normal.

skin : normal and kind of the surface in a cell, rows of `traction`;  vof : fractions [m, j, i]
"""

from hydro2d.jit import point
from hydro2d.mesh.fields import SRR, SRZ, SZZ
from hydro2d.physics.traction import BESIDE_GAS, INTERFACE, JOINT, KIND, NORMAL_R, NORMAL_Z, along_normal, pull_left


@point
def is_beside_gas(j, i, gases, vof):
    """Whether a cell contains a gas."""
    has_gas = False
    for m in range(vof.shape[0]):
        has_gas = has_gas or (vof[m, j, i] > 0.0 and gases[m])
    return has_gas


@point
def contains_group(g, j, i, group, vof):
    """Whether a cell contains a body of group g."""
    contains = False
    for m in range(vof.shape[0]):
        contains = contains or (group[m] == g and vof[m, j, i] > 0.0)
    return contains


@point
def joins_solids(j, i, strong, vof):
    """Whether a cell contains several bodies of which one has strength, so that more than pressure acts between them."""
    number, solid = 0, False
    for m in range(vof.shape[0]):
        number += 1 if vof[m, j, i] > 0.0 else 0
        solid = solid or (vof[m, j, i] > 0.0 and strong[m])
    return solid and number > 1


@point
def fullest(j, i, vof):
    """The body that fills most of a cell."""
    first = 0
    for m in range(1, vof.shape[0]):
        first = m if vof[m, j, i] > vof[first, j, i] else first
    return first


@point
def dominant_body(j, i, hard_bodies, threshold, vof):
    """Body whose strength dominates in a cell of the hard zone, the hard body that fills most of it; -1 outside it."""
    dominant, most = -1, 0.0
    for m in range(vof.shape[0]):
        if hard_bodies[m] and vof[m, j, i] >= threshold and vof[m, j, i] > most:
            dominant, most = m, vof[m, j, i]
    return dominant


@point
def side_of_joint(m, j, i, first, gas, gases, vof):
    """Side of the surface, 1 or -1, on which body m is in cell (j, i), filled by bodies of one group; 0 for neither.

    If the cell contains a gas, gases are on one side and all other bodies on the other; else the body that fills most of it,
    `first`, is on one side and the rest on the other.
    """
    if gas:
        return -1.0 if gases[m] else 1.0
    if vof[m, j, i] == 0.0:
        return 0.0
    return 1.0 if m == first else -1.0


@point
def surface_weight(j, i, skin):
    """Weight of the surface in a cell, 0 to 1."""
    return min(skin[NORMAL_R, j, i] * skin[NORMAL_R, j, i] + skin[NORMAL_Z, j, i] * skin[NORMAL_Z, j, i], 1.0)


@point
def normal_deviator(m, j, i, skin, q):
    """n . s . n of body m in cell (j, i), times the weight of its surface."""
    return along_normal(skin[NORMAL_R, j, i], skin[NORMAL_Z, j, i], q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i])


@point
def pull_of(j, i, void, skin):
    """Share of a tension that a cut cell carries: none where two groups meet, all where bodies of one fill it (`pull_left`)."""
    if skin[KIND, j, i] == JOINT or skin[KIND, j, i] == BESIDE_GAS:
        return 1.0
    return 0.0 if skin[KIND, j, i] == INTERFACE else pull_left(void, surface_weight(j, i, skin))
