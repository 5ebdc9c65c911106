"""Damage models that open cracks: the cracks of a cell at the end of the Lagrangian step, and the damage they amount to."""

from eos.cracked import CRACKS as WIDTH
from eos.cracked import GROWTH, opened, solid_share
from hydro2d.jit import cell_rows, point
from hydro2d.kernels.column_ranges import columns
from hydro2d.materials.rows import CRACKS, DAMAGE, DAMAGE_AT, EOS_AT, MEMORY, RECORD, TENSILE
from hydro2d.mesh.fields import BY_DAMAGE, CRUSHED, DMG, FAILED, RHO, E
from hydro2d.physics.fracture import crack_opening, open_void
from hydro2d.physics.stress import release
from strength.dispatch import OPENS_CRACKS, full_opening, tension_left

#: reach on either side of a cell, in full openings, within which cracks belong to the same crack, and its least value in cells,
#: over which the remap spreads a crack
OPENINGS, REACH = 5.0, 2
#: cracks that fill this share of the volume have joined, at any opening
JOINED = 0.5


@point
def part_cell(m, j, i, w):
    """Turns the cracks of body m in cell (j, i) into void; the cell carries no stress any more.

    Updates  vof [m, j, i]; q (density, deviators, crack volume and growth) [k, m, j, i]
    """
    row = w.models[m, MEMORY]
    open_void(m, j, i, solid_share(w.q[RHO, m, j, i], w.q[row + WIDTH, m, j, i]), w.vof, w.q)
    w.q[row + WIDTH, m, j, i] = 0.0
    w.q[row + GROWTH, m, j, i] = 0.0
    release(m, j, i, w.q)


@cell_rows
def open_cracks(j, w):
    """Opens cracks where the tension exceeds that of damaged material, and turns them into void where it has failed.

    Where they open, the deviator becomes zero. explanation/fracture, (9)

    Updates  vof [m, j, i]; q (crack volume and growth, deviators; where material has failed density, damage and failure record)
             [k, m, j, i]
    """
    for m in range(w.vof.shape[0]):
        model, row = w.models[m, DAMAGE], w.models[m, MEMORY]
        if model not in OPENS_CRACKS:
            continue
        par = w.materials[m, EOS_AT:]
        damage_par = w.materials[m, DAMAGE_AT:TENSILE]
        tension = w.materials[m, CRACKS]
        first, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
        for x in range(n):
            i = first + x
            if w.vof[m, j, i] > 0.0:
                damage, cracks, rho = w.q[DMG, m, j, i], w.q[row + WIDTH, m, j, i], w.q[RHO, m, j, i]
                limit = tension * tension_left(model, damage, damage_par) if damage < 1.0 else 0.0
                wide = opened(rho, w.q[E, m, j, i], limit, cracks, par)
                w.q[row + WIDTH, m, j, i] = wide
                w.q[row + GROWTH, m, j, i] = 0.0
                if wide > cracks:
                    w.q[row + GROWTH, m, j, i] = 1.0
                    release(m, j, i, w.q)
                if damage >= 1.0 or wide * rho >= JOINED:
                    w.q[DMG, m, j, i] = max(damage, FAILED)
                    if w.models[m, RECORD] > 0:
                        w.q[w.models[m, RECORD], m, j, i] = BY_DAMAGE
                    part_cell(m, j, i, w)


@point
def across(m, j, i, dj, reach, w):
    """(opening of the crack of body m around cell (j, i), m; whether no other cell has more of it), along z if dj is 1, else r.

    Reads    vof [m, j, i]; q (density, crack volume) [k, m, j, i]
    """
    row, di = w.models[m, MEMORY], 1 - dj
    own = crack_opening(w.vof[m, j, i], w.q[RHO, m, j, i], w.q[row + WIDTH, m, j, i], w.dz[j] if dj == 1 else w.dr[i])
    opening, widest = 0.0, own
    for k in range(-reach, reach + 1):
        jj, ii = j + k * dj, i + k * di
        if w.mesh_box[0] <= jj and jj < w.mesh_box[1] and w.mesh_box[2] <= ii and ii < w.mesh_box[3]:
            length = w.dz[jj] if dj == 1 else w.dr[ii]
            part = crack_opening(w.vof[m, jj, ii], w.q[RHO, m, jj, ii], w.q[row + WIDTH, m, jj, ii], length)
            opening += part
            widest = max(widest, part)
    return opening, own >= widest


@cell_rows
def damage_by_cracks(j, w):
    """Damage of cells in which cracks have opened, by the cracks' volume per area across the cell and its neighbours.

    The crack lies across the direction in which the cell stretches faster. Where it is fully open, the cell with most of it
    fails, and the others carry no tension. explanation/fracture, (11)

    Reads    u, v [b, j, i]; vof [m, j, i]; q (density, crack volume and growth) [k, m, j, i]
    Updates  q (damage) [k, m, j, i]
    """
    for m in range(w.vof.shape[0]):
        model, row, g = w.models[m, DAMAGE], w.models[m, MEMORY], w.group[m]
        if model not in OPENS_CRACKS:
            continue
        full = full_opening(model, w.materials[m, DAMAGE_AT:TENSILE])
        first, n = columns(w.body_range[m, j, 0], w.body_range[m, j, 1])
        for x in range(n):
            i = first + x
            if w.vof[m, j, i] > 0.0 and w.q[row + GROWTH, m, j, i] > 0.5 and w.q[DMG, m, j, i] < 1.0:
                stretch_r = ((w.u[g, j, i + 1] - w.u[g, j, i]) + (w.u[g, j + 1, i + 1] - w.u[g, j + 1, i])) / w.dr[i]
                stretch_z = ((w.v[g, j + 1, i] - w.v[g, j, i]) + (w.v[g, j + 1, i + 1] - w.v[g, j, i + 1])) / w.dz[j]
                dj = 1 if stretch_z >= stretch_r else 0
                reach = max(int(OPENINGS * full / (w.dz[j] if dj == 1 else w.dr[i])), REACH)
                opening, most = across(m, j, i, dj, reach, w)
                damage = max(w.q[DMG, m, j, i], opening / full)
                if damage >= 1.0:
                    damage = FAILED if most else CRUSHED
                w.q[DMG, m, j, i] = damage
