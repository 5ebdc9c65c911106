"""A mesh that travels with the core of a body: its velocity, the bodies that are coming, and its next place."""

from math import inf

from hydro2d.jit import control
from hydro2d.kernels.column_ranges import NOTHING
from hydro2d.mesh.grid import GHOSTS
from hydro2d.mesh.sums import HALF, axis_run, core_sums

#: entering material is looked up in a strip of at least this share of a cell, so that it has a height when the mesh rests
THINNEST = 1e-9


@control
def follow_core(w):
    """The mass-weighted mean velocity of the followed body's core, never backward; asks for help if the body has no core.

    Reads    z; volume [j, i]; vof, dmg, rho [m, j, i]; v [b, j-1/2, i-1/2]; group [m]
    Writes   core_run [2]; core [2]
    """
    m = w.followed
    axis_run(GHOSTS, w.nz, m, HALF, w.z, w.vof, w.dmg, w.core_run)
    first, last = w.core_run[0], w.core_run[1]
    if first < last:
        first, last = max(first - 1, GHOSTS), min(last + 1, GHOSTS + w.nz)
    core_sums(GHOSTS, w.nr, first, last, m, HALF, w.heading, inf, 0.0, w.volume, w.vof, w.dmg, w.rho, w.v[w.group[m]], w.core)
    if w.core[0] == 0.0:
        w.asks = 1
        return
    velocity = w.core[1] / w.core[0]
    w.mesh_speed = velocity if velocity * w.heading > 0.0 else 0.0


@control
def look_ahead(w):
    """Asks for the material of the strip that the leading edge crosses in the step, unless it is already in the ghost rows.

    Reads    z; dz; placed [2], heights between which the ghost rows have what is there
    """
    edge = w.z[GHOSTS + w.nz] if w.leading == 1 else w.z[GHOSTS]
    beside = GHOSTS + w.nz if w.leading == 1 else GHOSTS - 1
    height = max(abs(w.mesh_speed) * w.dt, THINNEST * w.dz[beside])
    low, high = (edge, edge + height) if w.leading == 1 else (edge - height, edge)
    w.asks = 0 if w.placed[0] <= low and high < w.placed[1] else 1


@control
def announce(w):
    """Gives bodies that may enter through the leading edge all columns of the ghost rows ahead as their range.

    Reads    z; reach [m], how far a body reaches along the way of the mesh; group [m]
    Updates  body_ranges [0, m, j, 2]; occupied [b, j, 2], of the two rows ahead
    """
    edge = w.z[GHOSTS + w.nz] if w.leading == 1 else w.z[GHOSTS]
    for ahead in range(2):
        row = GHOSTS + w.nz + ahead if w.leading == 1 else GHOSTS - 1 - ahead
        for m in range(w.group.shape[0]):
            w.body_ranges[0, m, row, 0], w.body_ranges[0, m, row, 1] = NOTHING, 0
        for b in range(w.occupied.shape[0]):
            w.occupied[b, row, 0], w.occupied[b, row, 1] = NOTHING, 0
        for m in range(w.group.shape[0]):
            if w.heading * w.reach[m] > w.heading * edge:
                w.body_ranges[0, m, row, 0], w.body_ranges[0, m, row, 1] = GHOSTS, GHOSTS + w.nr
                for b in range(w.group[m] + 1):
                    w.occupied[b, row, 0], w.occupied[b, row, 1] = GHOSTS, GHOSTS + w.nr


@control
def move_mesh(w):
    """Moves the mesh to where it is at the end of the step.

    Reads    z_start, zc_start, heights at the start
    Updates  offset [1]
    Writes   z, zc
    """
    w.offset[0] += w.advance
    for j in range(w.z.shape[0]):
        w.z[j] = w.z_start[j] + w.offset[0]
    for j in range(w.zc.shape[0]):
        w.zc[j] = w.zc_start[j] + w.offset[0]
