"""Damage models that open cracks: the cracks of a cell at the end of the Lagrangian step, and the damage that they are."""

from eos.cracked import opened, solid_share
from hydro2d.jit import kernel, point
from hydro2d.kernels.column_ranges import columns
from hydro2d.materials.rows import CRACKS, DAMAGE, DAMAGE_AT, EOS_AT, MEMORY, TENSILE
from hydro2d.mesh.fields import DMG, FAILED, RHO, SRR, SRZ, SZZ, E
from hydro2d.physics.fracture import crack_opening
from strength.dispatch import OPENS_CRACKS, full_opening, tension_left

#: row of `before`: whether cracks have opened in the step
GREW = 3
#: cells on either side of a cell whose cracks are of the same crack: the remap spreads it over them
REACH = 2
#: cracks that fill this share of the volume have joined, whatever their opening
JOINED = 0.5


@point
def part_cell(m, j, i, row, vof, q):
    """Makes void of the cracks of body m in cell (j, i), which bears no stress any more.

    Updates  vof [m, j, i]; q (density, deviators, crack volume in ``row``) [k, m, j, i]
    """
    share = solid_share(q[RHO, m, j, i], q[row, m, j, i])
    vof[m, j, i] *= share
    q[RHO, m, j, i] /= share
    q[row, m, j, i] = 0.0
    q[SRR, m, j, i] = 0.0
    q[SZZ, m, j, i] = 0.0
    q[SRZ, m, j, i] = 0.0


@kernel
def open_cracks(part, parts, body_range, models, materials, before, vof, q):
    """Opens cracks where the tension is more than damaged material bears, and makes void of them where it has failed.

    explanation/fracture, (9)

    Updates  vof [m, j, i]; q (crack volume; where material has failed density, deviators, damage) [k, m, j, i]
    Writes   before [4, m, j, i], row GREW
    """
    for j in range(parts[part], parts[part + 1]):
        for m in range(before.shape[1]):
            model, row = models[m, DAMAGE], models[m, MEMORY]
            if model not in OPENS_CRACKS:
                continue
            par, tension = materials[m, EOS_AT:], materials[m, CRACKS]
            damage_par = materials[m, DAMAGE_AT:TENSILE]
            first, n = columns(body_range[m, j, 0], body_range[m, j, 1])
            for x in range(n):
                i = first + x
                before[GREW, m, j, i] = 0.0
                if vof[m, j, i] > 0.0:
                    damage, cracks, rho = q[DMG, m, j, i], q[row, m, j, i], q[RHO, m, j, i]
                    limit = tension * tension_left(model, damage, damage_par) if damage < 1.0 else 0.0
                    wide = opened(rho, q[E, m, j, i], limit, cracks, par)
                    before[GREW, m, j, i] = 1.0 if wide > cracks else 0.0
                    q[row, m, j, i] = wide
                    if damage >= 1.0 or wide * rho >= JOINED:
                        q[DMG, m, j, i] = max(damage, FAILED)
                        part_cell(m, j, i, row, vof, q)


@kernel
def damage_by_cracks(part, parts, mesh_box, dr, dz, group, body_range, models, materials, u, v, before, vof, q):
    """The damage of the cells in which cracks have opened: their volume per area, across the cell and its neighbours.

    The crack lies across the direction in which the cell stretches faster. explanation/fracture, (11)

    Reads    u, v [b, j, i]; before [4, m, j, i]; vof [m, j, i]; q (density, crack volume) [k, m, j, i]
    Updates  q (damage) [k, m, j, i]
    """
    for j in range(parts[part], parts[part + 1]):
        for m in range(before.shape[1]):
            model, row, g = models[m, DAMAGE], models[m, MEMORY], group[m]
            if model not in OPENS_CRACKS:
                continue
            full = full_opening(model, materials[m, DAMAGE_AT:TENSILE])
            first, n = columns(body_range[m, j, 0], body_range[m, j, 1])
            for x in range(n):
                i = first + x
                if vof[m, j, i] > 0.0 and before[GREW, m, j, i] > 0.0 and q[DMG, m, j, i] < 1.0:
                    stretch_r = ((u[g, j, i + 1] - u[g, j, i]) + (u[g, j + 1, i + 1] - u[g, j + 1, i])) / dr[i]
                    stretch_z = ((v[g, j + 1, i] - v[g, j, i]) + (v[g, j + 1, i + 1] - v[g, j, i + 1])) / dz[j]
                    opening = 0.0
                    if stretch_z >= stretch_r:
                        for at in range(max(j - REACH, mesh_box[0]), min(j + REACH + 1, mesh_box[1])):
                            opening += crack_opening(vof[m, at, i], q[RHO, m, at, i], q[row, m, at, i], dz[at])
                    else:
                        for at in range(max(i - REACH, mesh_box[2]), min(i + REACH + 1, mesh_box[3])):
                            opening += crack_opening(vof[m, j, at], q[RHO, m, j, at], q[row, m, j, at], dr[at])
                    damage = max(q[DMG, m, j, i], opening / full)
                    q[DMG, m, j, i] = damage if damage < 1.0 else FAILED
