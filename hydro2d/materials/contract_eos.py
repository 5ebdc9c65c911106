"""The checks of equations of state; the first line of each docstring says what is required."""

from __future__ import annotations

import itertools

import numpy as np

from eos.layout import E0, RHO0
from hydro2d.materials.contract_case import NOBODY, Case, near, require


def eos_is_chosen(case: Case) -> None:
    """compiled with the other equations of state, the model gives the same numbers"""
    from eos import dispatch

    par = case.row
    for rho, e in case.states():
        through, alone = dispatch.evaluate(case.module.ID, rho, e, case.virgin, par), case.evaluate(rho, e, par)
        require(through == alone, f"evaluate({rho:g}, {e:g}) is {alone}, and {through} by its ID")
    require(np.isnan(dispatch.evaluate(NOBODY, 1.0, 1.0, case.virgin, par)).all(), "an ID of no model gives numbers")


def derivatives(case: Case) -> None:
    """dp/drho and dp/de are the derivatives of p"""
    par = case.row
    for rho, e in case.states():
        p, dpdrho, dpde, _ = case.evaluate(rho, e, par)
        d = 1e-5 * rho
        below = (p - case.evaluate(rho - d, e, par)[0]) / d
        above = (case.evaluate(rho + d, e, par)[0] - p) / d
        at = f"at rho = {rho:g} kg/m^3, e = {e:g} J/kg"
        one_sided = abs(rho - par[0]) <= d or (case.has_kinks and not near(below, above, 1e-3))
        require(_is_slope(dpdrho, below, above, one_sided),
                f"{at} dp/drho is {dpdrho:g}, and p rises by {0.5 * (below + above):g}")
        d = max(1e-4 * e, 0.01)
        above, below = ((case.evaluate(rho, e + step, par)[0] - p) / step for step in (d, -d))
        one_sided = case.has_kinks and not near(below, above, 1e-3)
        require(_is_slope(dpde, below, above, one_sided), f"{at} dp/de is {dpde:g}, and p rises by {0.5 * (below + above):g}")


def _is_slope(value: float, below: float, above: float, one_sided: bool) -> bool:
    """Whether a derivative is the mean of the slopes on both sides, or if it is one-sided either of them."""
    if one_sided:
        return near(value, below, 2e-4) or near(value, above, 2e-4)
    return near(value, 0.5 * (below + above), 1e-7)


def sound_speed(case: Case) -> None:
    """the sound speed is real in the stated range"""
    par = case.row
    for rho, e in case.states():
        p, dpdrho, dpde, _ = case.evaluate(rho, e, par)
        square = dpdrho + p * dpde / rho**2
        require(square > 0.0, f"at rho = {rho:g} kg/m^3, e = {e:g} J/kg c^2 is {square:g}")


def rest(case: Case) -> None:
    """at the density at rest and zero energy, the pressure is exactly zero"""
    par = case.row
    p = case.evaluate(par[0], 0.0, par)[0]
    require(p == 0.0, f"p is {p:g} Pa at rho = {par[0]:g} kg/m^3, e = 0")


def finite(case: Case) -> None:
    """every positive density gives finite numbers and no negative temperature; beyond a table all of them are NaN"""
    par = case.row
    for rho, e in itertools.product((1e-300, 1e-100, 1e-12, 1.0, 1e3, 1e5, 1e9), (-1e6, 0.0, 1e8)):
        values = case.evaluate(rho, e, par)
        kept = (np.isfinite(values).all() and values[3] >= 0.0) or (case.has_kinks and np.isnan(values).all())
        require(kept, f"evaluate({rho:g}, {e:g}) is {tuple(map(float, values))}")


def pressure_rises(case: Case) -> None:
    """p rises with density without a jump, also outside the stated range, from the largest tension on"""
    par = case.row
    rho = par[0] * np.linspace(0.3, 8.0, 20001)
    e = case.energies[-1] if case.has_kinks else 1e5
    curve = np.array([case.evaluate(x, e, par)[:2] for x in rho])
    if case.has_kinks:
        inside = ~np.isnan(curve[:, 0])
        require(inside.sum() > 1000, f"the table has {inside.sum()} of {inside.size} densities at {e:g} J/kg")
        rho, curve = rho[inside], curve[inside]
    torn = int(np.argmin(curve[:, 0]))
    require(rho[torn] < par[0], f"p is least at rho = {rho[torn]:g} kg/m^3, above the density at rest")
    rho, curve = rho[torn:], curve[torn:]
    ends = np.array([curve[:-1, 1], curve[1:, 1]]) * np.diff(rho)
    rise, expected = np.diff(curve[:, 0]), ends.mean(axis=0)  # between those of both ends, where a slope jumps
    wrong = ~(rise > 0.0) | (rise - ends.max(axis=0) > 5e-3 * abs(expected)) | (ends.min(axis=0) - rise > 5e-3 * abs(expected))
    k = int(wrong.argmax())
    require(not wrong.any(), f"from rho = {rho[k]:g} to {rho[k + 1]:g} kg/m^3 p rises by {rise[k]:g} Pa, and dp/drho says "
                             f"{expected[k]:g}")


def temperature(case: Case) -> str | None:
    """the temperature is consistent with the pressure, T ds = de - p drho/rho^2: d(1/T)/drho|e = -d(p/(rho^2 T))/de|rho"""
    if hasattr(case.module, "INTERNAL"):
        return "the pressure's energy does not include that stored by the internal variables"
    par, checked, within = case.row, 0, getattr(case.module, "TEMPERATURE_WITHIN", 2e-3)
    for rho, e in case.states():
        p, _, dpde, T = case.evaluate(rho, e, par)
        if T < 50.0:
            continue
        checked += 1
        d = 1e-3 * rho
        by_rho = (case.evaluate(rho + d, e, par)[3] - case.evaluate(rho - d, e, par)[3]) / (2 * d)
        d = 1e-3 * max(e, 1.0)
        by_e = (case.evaluate(rho, e + d, par)[3] - case.evaluate(rho, e - d, par)[3]) / (2 * d)
        terms = T * dpde / rho**2, p * by_e / rho**2
        require(abs(by_rho - (terms[0] - terms[1])) < within * (abs(terms[0]) + abs(terms[1])),
                f"at rho = {rho:g} kg/m^3, e = {e:g} J/kg dT/drho is {by_rho:g}, not {terms[0] - terms[1]:g}")
    require(checked > 5, f"only {checked} states of the stated range have a temperature above 50 K")
    return None


def memory(case: Case) -> str | None:
    """internal variables stay as they are while nothing happens, and are always finite and within their bounds"""
    if not hasattr(case.module, "INTERNAL"):
        return "the model has no INTERNAL"
    from eos import dispatch

    par, virgin, rest = case.row, case.virgin, case.row[RHO0]
    bounds = [(field.least, field.most) for field in case.module.INTERNAL]
    internal = virgin.copy()
    case.module.update(rest, rest, par[E0], *np.zeros(7), par, internal)
    require((internal == virgin).all(), f"at rest {virgin.tolist()} become {internal.tolist()}")
    happened = 0.01, 1e6, 0.2, 0.3, 1e6, 1e-5, 1e-8  # strain, its work, damage twice, energy it releases, time and dt
    for rho, e in itertools.product(rest * np.array([0.3, 0.9, 1.0, 1.01, 1.5, 8.0]), (0.0, 1e5, 3e6)):
        internal, through = virgin.copy(), virgin.copy()
        case.module.update(rest, rho, e, *happened, par, internal)
        dispatch.update(case.module.ID, rest, rho, e, *happened, par, through)
        at = f"from rho = {rest:g} to {rho:g} kg/m^3 at e = {e:g} J/kg {virgin.tolist()} become {internal.tolist()}"
        kept = all(least <= value <= most for value, (least, most) in zip(internal, bounds, strict=True))
        require(kept, f"{at}, beyond {bounds}")
        require((through == internal).all(), f"{at}, and {through.tolist()} by its ID")
        values = case.module.evaluate(rho, e, internal, par)
        kept = np.isfinite(values).all() or (case.has_kinks and np.isnan(values).all())
        require(kept, f"{at}, and evaluate is {tuple(map(float, values))}")
    return None
