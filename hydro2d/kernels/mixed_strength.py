"""Strength in mixed cells: elastic trial of every body, the strain across a surface, and the return to the yield surface."""

from hydro2d.jit import point
from hydro2d.kernels.cut_cells import NORMAL_R, NORMAL_Z, firm_share, traction_of_change
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
from hydro2d.mesh.grid import VOL_R
from hydro2d.physics.contents import surface_weight
from hydro2d.physics.plasticity import (
    carries_no_stress,
    deviator_power,
    forget,
    is_fluid,
    keep_internal,
    take_internal,
)
from hydro2d.physics.stress import release, stress_scale, turn_and_strain, von_mises
from hydro2d.physics.traction import along_normal
from strength.dispatch import flow_stress, shear_modulus, turn, weakened
from strength.melting import melts, solid_modulus

#: mixed-cell strength by name, in the order of the integer that the kernels take
STRENGTH_MODES = ("volume", "solid", "zero", "max", "material")
VOLUME, SOLID, ZERO, MAX, MATERIAL = range(5)


@point
def work_of_deviators(j, i, dominant, w):
    """Work of the deviators of every body in the step: of its own, or in the hard zone the dominant body's alone.

    In a cut cell the part across the surface is excluded: mix [j, NORMAL, m].

    Writes   mix [j, HEAT, m], J per radian
    """
    total = w.solid[j, i]
    scale = stress_scale(w.strength_mode == SOLID, total)
    for m in range(w.vof.shape[0]):
        f = w.vof[m, j, i]
        w.mix[j, HEAT, m] = 0.0
        if f == 0.0:
            continue
        part = total if m == dominant else 0.0
        if dominant < 0:
            part = f * scale
        g = w.group[m]
        power = deviator_power(w.q[SRR, m, j, i], w.q[SZZ, m, j, i], w.q[SRZ, m, j, i], w.motion[j, g, MEAN_RR],
                               w.motion[j, g, MEAN_ZZ], w.motion[j, g, MEAN_TT], w.motion[j, g, MEAN_RZ])
        power -= w.mix[j, NORMAL, m] * (w.motion[j, g, MEAN_RR] + w.motion[j, g, MEAN_ZZ] + w.motion[j, g, MEAN_TT])
        w.mix[j, HEAT, m] = part * w.dt * power


@point
def strain_deviators(j, i, rate, w):
    """Elastic trial of every body; returns the yield stress of the cell by mode (explanation/mixed-cells, equation 8).

    rate is the time step over the volume of the cell. Internal variables that are tensors turn with the material. In a cut cell
    the strain across the surface is left out, by the surface's weight: `traction_of_change` finds it, `strain_across` adds it.

    Updates  q (internal variables) [k, m, j, i]; scratch internal [j, k]
    Writes   mix [j, TRIAL_RR to TRIAL_RZ, m], deviators; mix [j, MODULUS, m], mix [j, YIELD, m], 0 without strength, all in Pa
    """
    cell_yield, largest_yield = 0.0, 0.0
    n_r, n_z, weight = w.skin[NORMAL_R, j, i], w.skin[NORMAL_Z, j, i], surface_weight(j, i, w.skin)
    inverse = 1.0 / weight if weight > 0.0 else 0.0
    for m in range(w.vof.shape[0]):
        f = w.vof[m, j, i]
        w.mix[j, YIELD, m] = 0.0
        w.mix[j, MODULUS, m] = 0.0
        w.mix[j, SIZE, m] = 0.0
        w.mix[j, ALONG, m] = 0.0
        w.mix[j, BESIDE, m] = 0.0
        if f == 0.0 or w.models[m, STRENGTH] == 0:
            continue
        g, model, par, rho = w.group[m], w.models[m, STRENGTH], w.materials[m, STRENGTH_AT:DAMAGE_AT], w.q[RHO, m, j, i]
        modulus = shear_modulus(model, w.pm[m, j, i], rho, w.tm[m, j, i], par)
        line = w.materials[m, MELTING_AT:EOS_AT]
        if melts(line):
            modulus = solid_modulus(modulus, rho, w.tm[m, j, i], line)
        strain_r, strain_z, strain_t = w.motion[j, g, RR] * rate, w.motion[j, g, ZZ] * rate, w.motion[j, g, TT] * rate
        strain_s = 0.5 * (w.motion[j, g, RBZ] + w.motion[j, g, ZBR]) * rate
        spin = 0.5 * (w.motion[j, g, RBZ] - w.motion[j, g, ZBR]) * rate
        across = along_normal(n_r, n_z, strain_r, strain_z, strain_s) * inverse
        strain_r -= across * n_r * n_r
        strain_z -= across * n_z * n_z
        strain_s -= across * n_r * n_z
        w.mix[j, BESIDE, m] = strain_r + strain_z + strain_t
        rr, zz, rz = turn_and_strain(w.q[SRR, m, j, i], w.q[SZZ, m, j, i], w.q[SRZ, m, j, i], spin, 2.0 * modulus, strain_r,
                                     strain_z, strain_t, strain_s)
        take_internal(m, j, i, model, w.q, w.internal[j])
        turn(model, spin, w.internal[j])
        keep_internal(m, j, i, model, w.internal[j], w.q)
        w.mix[j, TRIAL_RR, m] = rr
        w.mix[j, TRIAL_ZZ, m] = zz
        w.mix[j, TRIAL_RZ, m] = rz
        w.mix[j, MODULUS, m] = modulus
        w.mix[j, SIZE, m] = 2.0 * (rr * rr + zz * zz + rr * zz + rz * rz)
        w.mix[j, ALONG, m] = along_normal(n_r, n_z, rr, zz, rz) * inverse
        if not (is_fluid(modulus) or carries_no_stress(w.q[DMG, m, j, i], rho, w.materials[m, CUTOFF_DENSITY])):
            flow = flow_stress(model, w.q[EP, m, j, i], 0.0, w.tm[m, j, i], w.pm[m, j, i], rho, par)
            w.mix[j, YIELD, m] = w.materials[m, FACTOR] * weakened(model, flow, 0.0, w.pm[m, j, i], w.q[DMG, m, j, i], par)
        cell_yield += f * w.mix[j, YIELD, m]
        largest_yield = max(largest_yield, w.mix[j, YIELD, m])
    if w.strength_mode == ZERO:
        return 0.0
    return largest_yield if w.strength_mode == MAX else cell_yield / firm_share(j, i, w)


@point
def strain_bodies_across(j, i, own, cell_yield, change, w):
    """Strains the bodies of a cut cell across its surface; returns p_c at the end of the step, Pa (`traction_of_change`).

    A body that flows does so at its current stress, which may exceed its yield stress because of its rate.

    Updates  mix [j, TRIAL_RR to TRIAL_RZ, m]
    """
    for m in range(w.vof.shape[0]):
        flow = w.mix[j, YIELD, m] if own else cell_yield
        if flow > 0.0:
            flow = max(flow, von_mises(w.q[SRR, m, j, i], w.q[SZZ, m, j, i], w.q[SRZ, m, j, i]))
        w.mix[j, FLOW, m] = flow
    target = traction_of_change(j, i, change, w)
    n_r, n_z, weight = w.skin[NORMAL_R, j, i], w.skin[NORMAL_Z, j, i], surface_weight(j, i, w.skin)
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] > 0.0 and w.models[m, STRENGTH] != 0:
            strained = 2.0 * w.mix[j, MODULUS, m] * w.mix[j, ACROSS, m]
            w.mix[j, TRIAL_RR, m] += strained * (n_r * n_r - weight / 3.0)
            w.mix[j, TRIAL_ZZ, m] += strained * (n_z * n_z - weight / 3.0)
            w.mix[j, TRIAL_RZ, m] += strained * n_r * n_z
    return target


@point
def return_deviators(j, i, own, cell_yield, dominant, w):
    """Returns the trial deviators to the yield surface: each body's own, or that of the cell. Melts lose theirs.

    In the hard zone the plastic heat of the dominant body is shared by f_m/Y_m among the solids, as in layers under one stress.

    Reads    the arrays that strain_deviators wrote
    Updates  q (deviators, plastic strain, damage, internal variables) [k, m, j, i]; mix [j, HEAT, m]; scratch internal [j, k]
    """
    volume = w.metrics[VOL_R, i] * w.dz[j]
    for m in range(w.vof.shape[0]):
        if w.vof[m, j, i] == 0.0 or w.models[m, STRENGTH] == 0:
            continue
        if is_fluid(w.mix[j, MODULUS, m]):
            forget(m, j, i, w.models[m, STRENGTH], w.q, w.internal[j])
            release(m, j, i, w.q)
            continue
        rr, zz, rz, dep, final = return_to_surface(
            m, j, i, w.mix[j, TRIAL_RR, m], w.mix[j, TRIAL_ZZ, m], w.mix[j, TRIAL_RZ, m], w.mix[j, MODULUS, m], own, cell_yield,
            w)
        gone = carries_no_stress(w.q[DMG, m, j, i], w.q[RHO, m, j, i], w.materials[m, CUTOFF_DENSITY])
        w.q[SRR, m, j, i] = 0.0 if gone else rr
        w.q[SZZ, m, j, i] = 0.0 if gone else zz
        w.q[SRZ, m, j, i] = 0.0 if gone else rz
        if m == dominant and dep > 0.0 and w.mix[j, YIELD, m] > 0.0:
            share_plastic_heat(j, i, m, dep * final * volume * w.solid[j, i], w.vof, w.mix)


@point
def share_plastic_heat(j, i, dominant, plastic, vof, mix):
    """Gives the plastic work of the dominant body to all solids, by f_m/Y_m.

    Updates  mix [j, HEAT, m]
    """
    whole = 0.0
    for m in range(vof.shape[0]):
        whole += vof[m, j, i] / mix[j, YIELD, m] if mix[j, YIELD, m] > 0.0 else 0.0
    for m in range(vof.shape[0]):
        share = vof[m, j, i] / mix[j, YIELD, m] if mix[j, YIELD, m] > 0.0 else 0.0
        mix[j, HEAT, m] += plastic * share / whole
    mix[j, HEAT, dominant] -= plastic
