"""Strength in mixed cells: elastic trial of every body, the strain across a surface, and the return to the yield surface."""

from hydro2d.jit import point
from hydro2d.kernels.cut_cells import NORMAL_R, NORMAL_Z, meet_traction, surface_weight
from hydro2d.kernels.mixed_scratch import (
    ACROSS,
    ALONG,
    BESIDE,
    FLOW,
    HEAT,
    MEAN_RR,
    MEAN_RZ,
    MEAN_TT,
    MEAN_ZZ,
    MODULUS,
    NORMAL,
    RBZ,
    RR,
    SIZE,
    TRIAL_RR,
    TRIAL_RZ,
    TRIAL_ZZ,
    TT,
    YIELD,
    ZBR,
    ZZ,
)
from hydro2d.kernels.plastic_return import return_to_surface
from hydro2d.materials.rows import CUTOFF_DENSITY, DAMAGE_AT, EOS_AT, FACTOR, MELTING_AT, STRENGTH, STRENGTH_AT
from hydro2d.mesh.fields import DMG, EP, RHO, SRR, SRZ, SZZ
from hydro2d.physics.plasticity import carries_no_stress, deviator_power, forget, is_fluid, keep_internal, take_internal
from hydro2d.physics.stress import turn_and_strain, von_mises
from hydro2d.physics.traction import along_normal
from strength.dispatch import flow_stress, shear_modulus, turn, weakened
from strength.melting import melts, solid_modulus

#: mixed-cell strength by name, in the order of the integer that the kernels take
STRENGTH_MODES = ("volume", "solid", "zero", "max", "material")
VOLUME, SOLID, ZERO, MAX, MATERIAL = range(5)


@point
def dominant_body(j, i, hard, hard_threshold, vof):
    """The body whose strength dominates in a cell of the hard zone, -1 outside of it."""
    dominant = -1
    for m in range(vof.shape[0]):
        if hard[m] and vof[m, j, i] >= hard_threshold:
            dominant = m
    return dominant


@point
def work_of_deviators(j, i, dt, dominant, total, scale, group, motion, vof, q, mix):
    """What the deviators of every body do in the step: its own, or in the hard zone the dominant body's alone.

    In a cut cell the part across the surface is none of theirs: mix [j, NORMAL, m].

    Writes   mix [j, HEAT, m], J per radian
    """
    for m in range(vof.shape[0]):
        f = vof[m, j, i]
        mix[j, HEAT, m] = 0.0
        if f == 0.0:
            continue
        part = total if m == dominant else 0.0
        if dominant < 0:
            part = f * scale
        g = group[m]
        power = deviator_power(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i], motion[j, g, MEAN_RR],
                               motion[j, g, MEAN_ZZ], motion[j, g, MEAN_TT], motion[j, g, MEAN_RZ])
        power -= mix[j, NORMAL, m] * (motion[j, g, MEAN_RR] + motion[j, g, MEAN_ZZ] + motion[j, g, MEAN_TT])
        mix[j, HEAT, m] = part * dt * power


@point
def strain_deviators(j, i, rate, mode, firm, skin, group, models, materials, pm, tm, motion, vof, q, mix, internal):
    """Elastic trial of every body; returns the yield stress of the cell by mode (explanation/mixed-cells, equation 8).

    rate is the time step over the volume of the cell; firm is the share of it that is neither void nor gas, or that of all
    bodies where these are gases. Internal variables that are tensors turn with the material. In a cut cell the strain across
    the surface is left out, by the weight of that: `meet_traction` finds it, `strain_across` adds it.

    Updates  q (internal variables) [k, m, j, i]; scratch internal [j, k]
    Writes   mix [j, TRIAL_RR to TRIAL_RZ, m], deviators; mix [j, MODULUS, m], mix [j, YIELD, m], 0 without strength, all in Pa
    """
    cell_yield, largest_yield = 0.0, 0.0
    n_r, n_z, weight = skin[NORMAL_R, j, i], skin[NORMAL_Z, j, i], surface_weight(j, i, skin)
    inverse = 1.0 / weight if weight > 0.0 else 0.0
    for m in range(vof.shape[0]):
        f = vof[m, j, i]
        mix[j, YIELD, m] = 0.0
        mix[j, MODULUS, m] = 0.0
        mix[j, SIZE, m] = 0.0
        mix[j, ALONG, m] = 0.0
        mix[j, BESIDE, m] = 0.0
        if f == 0.0 or models[m, STRENGTH] == 0:
            continue
        g, model, par, rho = group[m], models[m, STRENGTH], materials[m, STRENGTH_AT:DAMAGE_AT], q[RHO, m, j, i]
        modulus = shear_modulus(model, pm[m, j, i], rho, tm[m, j, i], par)
        line = materials[m, MELTING_AT:EOS_AT]
        if melts(line):
            modulus = solid_modulus(modulus, rho, tm[m, j, i], line)
        strain_r, strain_z, strain_t = motion[j, g, RR] * rate, motion[j, g, ZZ] * rate, motion[j, g, TT] * rate
        strain_s = 0.5 * (motion[j, g, RBZ] + motion[j, g, ZBR]) * rate
        spin = 0.5 * (motion[j, g, RBZ] - motion[j, g, ZBR]) * rate
        across = along_normal(n_r, n_z, strain_r, strain_z, strain_s) * inverse
        strain_r -= across * n_r * n_r
        strain_z -= across * n_z * n_z
        strain_s -= across * n_r * n_z
        mix[j, BESIDE, m] = strain_r + strain_z + strain_t
        rr, zz, rz = turn_and_strain(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i], spin, 2.0 * modulus, strain_r,
                                     strain_z, strain_t, strain_s)
        take_internal(m, j, i, model, q, internal[j])
        turn(model, spin, internal[j])
        keep_internal(m, j, i, model, internal[j], q)
        mix[j, TRIAL_RR, m] = rr
        mix[j, TRIAL_ZZ, m] = zz
        mix[j, TRIAL_RZ, m] = rz
        mix[j, MODULUS, m] = modulus
        mix[j, SIZE, m] = 2.0 * (rr * rr + zz * zz + rr * zz + rz * rz)
        mix[j, ALONG, m] = along_normal(n_r, n_z, rr, zz, rz) * inverse
        if not (is_fluid(modulus) or carries_no_stress(q[DMG, m, j, i], rho, materials[m, CUTOFF_DENSITY])):
            flow = flow_stress(model, q[EP, m, j, i], 0.0, tm[m, j, i], pm[m, j, i], rho, par)
            mix[j, YIELD, m] = materials[m, FACTOR] * weakened(model, flow, 0.0, pm[m, j, i], q[DMG, m, j, i], par)
        cell_yield += f * mix[j, YIELD, m]
        largest_yield = max(largest_yield, mix[j, YIELD, m])
    if mode == ZERO:
        return 0.0
    return largest_yield if mode == MAX else cell_yield / firm


@point
def strain_bodies_across(j, i, own, cell_yield, change, void, skin, p, bulk, models, vof, pm, km, q, mix):
    """Strains the bodies of a cut cell across its surface; returns p_c at the end of the step, Pa (`meet_traction`).

    A body that flows does so at the stress that it has, which may be above its yield stress by its rate.

    Updates  mix [j, TRIAL_RR to TRIAL_RZ, m]
    """
    for m in range(vof.shape[0]):
        flow = mix[j, YIELD, m] if own else cell_yield
        if flow > 0.0:
            flow = max(flow, von_mises(q[SRR, m, j, i], q[SZZ, m, j, i], q[SRZ, m, j, i]))
        mix[j, FLOW, m] = flow
    target = meet_traction(j, i, change, void, skin, p, bulk, vof, pm, km, mix)
    n_r, n_z, weight = skin[NORMAL_R, j, i], skin[NORMAL_Z, j, i], surface_weight(j, i, skin)
    for m in range(vof.shape[0]):
        if vof[m, j, i] > 0.0 and models[m, STRENGTH] != 0:
            strained = 2.0 * mix[j, MODULUS, m] * mix[j, ACROSS, m]
            mix[j, TRIAL_RR, m] += strained * (n_r * n_r - weight / 3.0)
            mix[j, TRIAL_ZZ, m] += strained * (n_z * n_z - weight / 3.0)
            mix[j, TRIAL_RZ, m] += strained * n_r * n_z
    return target


@point
def return_deviators(j, i, dt, own, cell_yield, dominant, volume, total, models, materials, pm, tm, vof, q, mix, internal):
    """Brings the trial deviators back to the yield surface: each body's own, or the one of the cell. Melts lose theirs.

    In the hard zone the plastic heat of the dominant body is shared by f_m/Y_m among what is solid, as in layers under one
    stress.

    Reads    what strain_deviators wrote
    Updates  q (deviators, plastic strain, damage, internal variables) [k, m, j, i]; mix [j, HEAT, m]; scratch internal [j, k]
    """
    bodies = vof.shape[0]
    for m in range(bodies):
        if vof[m, j, i] == 0.0 or models[m, STRENGTH] == 0:
            continue
        if is_fluid(mix[j, MODULUS, m]):
            forget(m, j, i, models[m, STRENGTH], q, internal[j])
            q[SRR, m, j, i] = 0.0
            q[SZZ, m, j, i] = 0.0
            q[SRZ, m, j, i] = 0.0
            continue
        rr, zz, rz, dep, final = return_to_surface(
            m, j, i, dt, mix[j, TRIAL_RR, m], mix[j, TRIAL_ZZ, m], mix[j, TRIAL_RZ, m], mix[j, MODULUS, m], own, cell_yield,
            models, materials, pm, tm, q, internal[j])
        gone = carries_no_stress(q[DMG, m, j, i], q[RHO, m, j, i], materials[m, CUTOFF_DENSITY])
        q[SRR, m, j, i] = 0.0 if gone else rr
        q[SZZ, m, j, i] = 0.0 if gone else zz
        q[SRZ, m, j, i] = 0.0 if gone else rz
        if m == dominant and dep > 0.0 and mix[j, YIELD, m] > 0.0:
            share_plastic_heat(j, i, m, dep * final * volume * total, vof, mix)


@point
def share_plastic_heat(j, i, dominant, plastic, vof, mix):
    """Gives the plastic work of the dominant body to all that is solid, by f_m/Y_m.

    Updates  mix [j, HEAT, m]
    """
    whole = 0.0
    for m in range(vof.shape[0]):
        whole += vof[m, j, i] / mix[j, YIELD, m] if mix[j, YIELD, m] > 0.0 else 0.0
    for m in range(vof.shape[0]):
        share = vof[m, j, i] / mix[j, YIELD, m] if mix[j, YIELD, m] > 0.0 else 0.0
        mix[j, HEAT, m] += plastic * share / whole
    mix[j, HEAT, dominant] -= plastic
