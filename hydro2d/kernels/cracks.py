"""Damage models that open cracks: the cracks of a cell at the end of the Lagrangian step, and the damage that they are."""

from eos.cracked import CRACKS as WIDTH
from eos.cracked import GROWTH, opened, solid_share
from hydro2d.jit import kernel, point
from hydro2d.kernels.column_ranges import columns
from hydro2d.materials.rows import CRACKS, DAMAGE, DAMAGE_AT, EOS_AT, MEMORY, TENSILE
from hydro2d.mesh.fields import CRUSHED, DMG, FAILED, RHO, SRR, SRZ, SZZ, E
from hydro2d.physics.fracture import crack_opening
from strength.dispatch import OPENS_CRACKS, full_opening, tension_left

#: cracks within so many full openings on either side of a cell are of the same crack, and those in so many cells at the least,
#: over which the remap spreads a crack
OPENINGS, REACH = 5.0, 2
#: cracks that fill this share of the volume have joined, whatever their opening
JOINED = 0.5


@point
def release(m, j, i, q):
    """Sets the deviator of body m in cell (j, i) to zero.

    Updates  q (deviators) [k, m, j, i]
    """
    q[SRR, m, j, i] = 0.0
    q[SZZ, m, j, i] = 0.0
    q[SRZ, m, j, i] = 0.0


@point
def part_cell(m, j, i, row, vof, q):
    """Makes void of the cracks of body m in cell (j, i), which bears no stress any more.

    Updates  vof [m, j, i]; q (density, deviators, the variables from ``row`` on) [k, m, j, i]
    """
    share = solid_share(q[RHO, m, j, i], q[row + WIDTH, m, j, i])
    vof[m, j, i] *= share
    q[RHO, m, j, i] /= share
    q[row + WIDTH, m, j, i] = 0.0
    q[row + GROWTH, m, j, i] = 0.0
    release(m, j, i, q)


@kernel
def open_cracks(part, parts, body_range, models, materials, vof, q):
    """Opens cracks where the tension is more than damaged material bears, and makes void of them where it has failed.

    Where they open, the deviator becomes zero. explanation/fracture, (9)

    Updates  vof [m, j, i]; q (crack volume and growth, deviators; where material has failed density, damage) [k, m, j, i]
    """
    for j in range(parts[part], parts[part + 1]):
        for m in range(vof.shape[0]):
            model, row = models[m, DAMAGE], models[m, MEMORY]
            if model not in OPENS_CRACKS:
                continue
            par = materials[m, EOS_AT:]
            damage_par = materials[m, DAMAGE_AT:TENSILE]
            tension = materials[m, CRACKS]
            first, n = columns(body_range[m, j, 0], body_range[m, j, 1])
            for x in range(n):
                i = first + x
                if vof[m, j, i] > 0.0:
                    damage, cracks, rho = q[DMG, m, j, i], q[row + WIDTH, m, j, i], q[RHO, m, j, i]
                    limit = tension * tension_left(model, damage, damage_par) if damage < 1.0 else 0.0
                    wide = opened(rho, q[E, m, j, i], limit, cracks, par)
                    q[row + WIDTH, m, j, i] = wide
                    q[row + GROWTH, m, j, i] = 0.0
                    if wide > cracks:
                        q[row + GROWTH, m, j, i] = 1.0
                        release(m, j, i, q)
                    if damage >= 1.0 or wide * rho >= JOINED:
                        q[DMG, m, j, i] = max(damage, FAILED)
                        part_cell(m, j, i, row, vof, q)


@point
def across(m, j, i, row, dj, di, reach, mesh_box, dr, dz, vof, q):
    """(opening of the crack of body m about cell (j, i), m; whether no other cell has more of it) along the offset (dj, di).

    Reads    vof [m, j, i]; q (density, crack volume in the variables from ``row`` on) [k, m, j, i]
    """
    own = crack_opening(vof[m, j, i], q[RHO, m, j, i], q[row + WIDTH, m, j, i], dz[j] if dj == 1 else dr[i])
    opening, widest = 0.0, own
    for k in range(-reach, reach + 1):
        jj, ii = j + k * dj, i + k * di
        if mesh_box[0] <= jj and jj < mesh_box[1] and mesh_box[2] <= ii and ii < mesh_box[3]:
            part = crack_opening(vof[m, jj, ii], q[RHO, m, jj, ii], q[row + WIDTH, m, jj, ii], dz[jj] if dj == 1 else dr[ii])
            opening += part
            widest = max(widest, part)
    return opening, own >= widest


@kernel
def damage_by_cracks(part, parts, mesh_box, dr, dz, group, body_range, models, materials, u, v, vof, q):
    """The damage of the cells in which cracks have opened: their volume per area, across the cell and its neighbours.

    The crack lies across the direction in which the cell stretches faster. Where it is fully open, the cell that has most of it
    fails, and the others bear no tension. explanation/fracture, (11)

    Reads    u, v [b, j, i]; vof [m, j, i]; q (density, crack volume and growth) [k, m, j, i]
    Updates  q (damage) [k, m, j, i]
    """
    for j in range(parts[part], parts[part + 1]):
        for m in range(vof.shape[0]):
            model, row, g = models[m, DAMAGE], models[m, MEMORY], group[m]
            if model not in OPENS_CRACKS:
                continue
            full = full_opening(model, materials[m, DAMAGE_AT:TENSILE])
            first, n = columns(body_range[m, j, 0], body_range[m, j, 1])
            for x in range(n):
                i = first + x
                if vof[m, j, i] > 0.0 and q[row + GROWTH, m, j, i] > 0.5 and q[DMG, m, j, i] < 1.0:
                    stretch_r = ((u[g, j, i + 1] - u[g, j, i]) + (u[g, j + 1, i + 1] - u[g, j + 1, i])) / dr[i]
                    stretch_z = ((v[g, j + 1, i] - v[g, j, i]) + (v[g, j + 1, i + 1] - v[g, j, i + 1])) / dz[j]
                    dj = 1 if stretch_z >= stretch_r else 0
                    reach = max(int(OPENINGS * full / (dz[j] if dj == 1 else dr[i])), REACH)
                    opening, most = across(m, j, i, row, dj, 1 - dj, reach, mesh_box, dr, dz, vof, q)
                    damage = max(q[DMG, m, j, i], opening / full)
                    if damage >= 1.0:
                        damage = FAILED if most else CRUSHED
                    q[DMG, m, j, i] = damage
