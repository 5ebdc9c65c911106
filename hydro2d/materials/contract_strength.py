"""The checks of strength and damage models; the first line of each docstring says what is required."""

from __future__ import annotations

import itertools
import math

import numpy as np

from hydro2d.materials.contract_case import NOBODY, Case, near, require


def strength_is_chosen(case: Case) -> None:
    """compiled with the other strength models, the model gives the same numbers"""
    from strength import dispatch

    module, par = case.module, case.row
    for ep, rate, T, p, rho in itertools.product((0.0, 0.3), (0.0, 1e4), (300.0, 600.0), (-1e9, 5e9), (2600.0, 3000.0)):
        for name, state in (("flow_stress", (ep, rate, T, p, rho)), ("shear_modulus", (p, rho, T))):
            through, alone = getattr(dispatch, name)(module.ID, *state, par), getattr(module, name)(*state, par)
            require(through == alone, f"{name}{state} is {alone}, and {through} by its ID")
    kept = math.isnan(dispatch.flow_stress(NOBODY, 0.0, 0.0, 300.0, 0.0, 2700.0, par))
    require(kept and math.isnan(dispatch.shear_modulus(NOBODY, 0.0, 2700.0, 300.0, par)), "an ID of no model gives numbers")


def states() -> np.ndarray:
    """Rows of pressure, density and temperature: all combinations of some, with tension, expansion and melt among them."""
    pressures, densities = (-2e9, 0.0, 1e5, 3.3e10), (1900.0, 2700.0, 4001.7)
    return np.array(list(itertools.product(pressures, densities, (0.0, 298.0, 777.7, 3000.0)))).T


def moduli(case: Case) -> None:
    """a row of shear moduli equals the modulus of each cell, and is constant if the model says CONSTANT_MODULUS"""
    from strength import dispatch
    from strength.layout import SHEAR

    par = case.row
    p, rho, T = (np.concatenate([[math.nan], values, [math.nan]]) for values in states())
    shear = np.full(p.size, -1.0)
    dispatch.modulus_row(case.module.ID, par, 1, p.size - 2, p, rho, T, shear)
    require(shear[0] == shear[-1] == -1.0, "cells beside the row were written to")
    for modulus, state in zip(shear[1:-1], states().T, strict=True):
        expected = case.module.shear_modulus(*state, par)
        at = "p = {:g} Pa, rho = {:g} kg/m^3, T = {:g} K".format(*state)
        require(not case.module.CONSTANT_MODULUS or expected == par[SHEAR],
                f"at {at} the modulus is {expected:g} Pa, not slot SHEAR of the row, {par[SHEAR]:g}")
        require(modulus == expected, f"at {at} the modulus is {expected:g} Pa, and {modulus:g} in a row")


def virgin(case: Case) -> None:
    """slots SHEAR and YIELD of the row are the modulus and the flow stress of the virgin material at rest"""
    from strength.layout import SHEAR, YIELD

    par, T, rho = case.row, at_rest(case), case.given("reference_density") or 2700.0
    flow, modulus = case.module.flow_stress(0.0, 0.0, T, 0.0, rho, par), case.module.shear_modulus(0.0, rho, T, par)
    require(flow == par[YIELD], f"the flow stress is {flow:g} Pa, slot YIELD of the row {par[YIELD]:g}")
    require(modulus == par[SHEAR], f"the shear modulus is {modulus:g} Pa, slot SHEAR of the row {par[SHEAR]:g}")


def at_rest(case: Case) -> float:
    """The temperature at which a model has its own yield stress, K."""
    T = case.given("modulus_temperature", "reference_temperature")
    return T if isinstance(T, float) else 298.0


def monotone(case: Case) -> None:
    """strain and strain rate harden, heat softens, and neither flow stress nor modulus is negative"""
    module, par, T = case.module, case.row, np.linspace(0.0, 3000.0, 200)
    strains, rates = [0.0, 1e-12, 1e-6, *np.linspace(0.001, 5.0, 60), 1e3], [0.0, *np.geomspace(1e-9, 1e9, 60)]
    flow = np.array([module.flow_stress(ep, 1e3, 400.0, 1e9, 2750.0, par) for ep in strains])
    in_order(np.diff(flow), strains, "plastic strain", "flow stress falls")
    flow = np.array([module.flow_stress(0.1, rate, 400.0, 1e9, 2750.0, par) for rate in rates])
    in_order(np.diff(flow), rates, "strain rate", "flow stress falls")
    flow = np.array([module.flow_stress(0.1, 1e3, each, 1e9, 2750.0, par) for each in T])
    modulus = np.array([module.shear_modulus(1e9, 2750.0, each, par) for each in T])
    in_order(-np.diff(flow), T, "temperature", "flow stress rises")
    in_order(-np.diff(modulus), T, "temperature", "shear modulus rises")
    least = min(flow), min(modulus)
    require(min(least) >= 0.0, "flow stress and shear modulus fall to {:g} and {:g} Pa".format(*least))


def in_order(rises: np.ndarray, at, what: str, message: str) -> None:
    """Raises Broken where one of the rises is negative, or NaN."""
    wrong = ~(rises >= 0.0)
    k = int(wrong.argmax())
    require(not wrong.any(), f"the {message} from {what} {at[k]:g} to {at[k + 1]:g}")


def melt(case: Case) -> str | None:
    """there is no strength at and above the melting temperature"""
    if "melt_temperature" not in case.values:
        return "EXAMPLE has no melt_temperature"
    for ep, T, p, rho in ((0.5, case.values["melt_temperature"], 0.0, 2700.0), (0.5, 5e4, 5e9, 3000.0)):
        flow = case.module.flow_stress(ep, 1e6, T, p, rho, case.row)
        require(flow == 0.0, f"the flow stress is {flow:g} Pa at {T:g} K")
    return None


def yield_floor(case: Case) -> str | None:
    """the flow stress never falls below yield_floor"""
    if not hasattr(case.module, "yield_floor"):
        return "the model has no yield_floor"
    par, least = case.row, case.module.yield_floor(case.row)
    for ep, rate, (p, rho, T) in itertools.product((0.0, 0.01, 1.0), (0.0, 1e5), states().T):
        flow = case.module.flow_stress(ep, rate, T, p, rho, par)
        require(flow >= least, f"the flow stress is {flow:g} Pa at ep = {ep:g}, T = {T:g} K, the floor {least:g}")
    return None


def weakening(case: Case) -> str | None:
    """damage weakens, and undamaged material has its flow stress to the last bit; compiled with the others, it is the same"""
    if not hasattr(case.module, "weakened"):
        return "the model has no weakened"
    from strength import dispatch

    par, shares = case.row, np.linspace(0.0, 1.0, 11)
    for rate, (p, rho, T) in itertools.product((0.0, 1e5), states().T):
        intact = case.module.flow_stress(0.1, rate, T, p, rho, par)
        flow = [case.module.weakened(intact, rate, p, damage, par) for damage in shares]
        at = f"at rate {rate:g} 1/s and p = {p:g} Pa"
        require(flow[0] == intact, f"{at} the flow stress without damage is {flow[0]:g} Pa, not {intact:g}")
        in_order(-np.diff(flow), shares, "damage", f"flow stress rises {at}")
        require(flow[-1] >= 0.0, f"{at} the flow stress of crushed material is {flow[-1]:g} Pa")
        through = dispatch.weakened(case.module.ID, intact, rate, p, 0.5, par)
        require(through == flow[5], f"{at} the flow stress is {flow[5]:g} Pa, and {through:g} by its ID")
    return None


def constant_yield(case: Case) -> str | None:
    """with a constant yield stress the model is elastic-plastic to the last bit, including the return to the yield surface"""
    if case.constant is None:
        return "the model has no CONSTANT_YIELD"
    from strength import STRENGTH_MODELS, dispatch, radial_return
    from strength.layout import SHEAR, YIELD

    own, plain = case.module.row(case.constant), STRENGTH_MODELS["elastic-plastic"]
    G, Y = own[SHEAR], own[YIELD]
    rows = (case.module.ID, own), (plain.ID, plain.row({"shear_modulus": G, "yield_stress": Y, "max_yield_stress": Y}))
    grid = itertools.product((0.0, 1e-7, 0.3, 7.0), (298.0, 777.7, 3000.0), (-2e9, 0.0, 3.3e10), (2200.0, 4001.7))
    for ep, T, p, rho in grid:
        for seq in (0.5 * Y, Y, 1.000001 * Y, 1.37 * Y, 311.0 * Y):
            answers = []
            for model, par in rows:
                modulus = dispatch.shear_modulus(model, p, rho, T, par)
                flow = dispatch.flow_stress(model, ep, 4e5, T, p, rho, par)
                back = radial_return.plastic_increment(model, seq, ep, 1e-8, T, p, rho, modulus, 1.0, par, 0.0)
                answers.append((modulus, flow, *back))
            modulus, flow, dep, stress = answers[0]
            exact = (modulus, flow, stress) == (G, Y, Y) and near(dep, max(seq - Y, 0.0) / (3.0 * G), 1e-12)
            require(answers[0] == answers[1] and exact,
                    f"modulus, flow stress, plastic strain and stress are {answers[0]}, of elastic-plastic {answers[1]}")
    return None


def internal_variables(case: Case) -> str | None:
    """internal variables change only with plastic strain or spin, as kinematic_modulus says"""
    if not hasattr(case.module, "INTERNAL"):
        return "the model has no INTERNAL"
    from strength import dispatch

    def evaluate(name: str, *values):
        own = getattr(case.module, name, None)
        return own(*values) if own else getattr(dispatch, name)(case.module.ID, *values)

    par, third = case.row, 1.0 / 3.0
    expected = 0.01 * evaluate("kinematic_modulus", par)
    for direction in ((2 * third, -third, 0.0), (-third, 2 * third, 0.0), (0.0, 0.0, math.sqrt(third))):  # von Mises norm 1
        internal = np.zeros(len(case.module.INTERNAL))
        evaluate("harden", 0.0, *direction, par, internal)
        evaluate("turn", 0.0, internal)
        require(not internal.any(), f"without plastic strain or spin, zeros become {internal.tolist()}")
        evaluate("harden", 0.01, *direction, par, internal)
        moved = evaluate("back_stress", internal)
        kept = all(near(component, expected * share, 1e-9) for component, share in zip(moved, direction, strict=True))
        require(kept, f"a plastic strain of 0.01 along {direction} moves the back stress by {moved} Pa, and kinematic_modulus "
                      f"says {expected:g} Pa")
        evaluate("turn", 0.1, internal)
        require(np.isfinite(internal).all(), f"after a plastic strain of 0.01 and a spin of 0.1 they are {internal.tolist()}")
    return None


# ------------------------------------------------------------------------------------------------ damage


def damage(case: Case) -> None:
    """damage grows only with plastic strain, and by a finite amount; compiled with the other models, it is the same"""
    from strength import dispatch

    module, par = case.module, case.row
    for rate, T, p, seq in itertools.product((0.0, 1e5), (298.0, 2000.0), (-1e9, 0.0, 1e10), (0.0, 1.0, 3e8)):
        at = f"at rate {rate:g} 1/s, T = {T:g} K, p = {p:g} Pa, von Mises stress {seq:g} Pa"
        none, some = (module.damage_increment(dep, rate, T, p, seq, par) for dep in (0.0, 0.01))
        require(none == 0.0, f"{at} damage grows by {none:g} without plastic strain")
        require(0.0 <= some < math.inf, f"{at} damage grows by {some:g} with a plastic strain of 0.01")
        through = dispatch.damage_increment(module.ID, 0.01, rate, T, p, seq, par)
        require(some == through, f"{at} the increment is {some:g}, and {through:g} by its ID")
    require(math.isnan(dispatch.damage_increment(NOBODY, 0.01, 0.0, 298.0, 0.0, 1.0, par)), "an ID of no model gives numbers")


def cell_size(case: Case) -> str | None:
    """the factor by the size of the cell is positive and never falls as cells grow; compiled with the others, it is the same"""
    if not hasattr(case.module, "size_factor"):
        return "the model has no size_factor"
    from strength import dispatch

    areas = np.geomspace(1e-12, 1e-4, 9)
    factors = np.array([case.module.size_factor(area, case.row) for area in areas.tolist()])
    require(bool(((factors > 0.0) & (factors < math.inf)).all()), f"a factor is not positive and finite: {factors.tolist()}")
    in_order(np.diff(factors), areas, "the area (m^2)", "factor falls")
    for area, factor in zip(areas.tolist(), factors, strict=True):
        through = dispatch.size_factor(case.module.ID, area, case.row)
        require(factor == through, f"in a cell of {area:g} m^2 the factor is {factor:g}, and {through:g} by its ID")
    return None


def cracks(case: Case) -> str | None:
    """where damage opens cracks, undamaged material bears all of its tension, failed material none; the opening is positive"""
    if not hasattr(case.module, "tension_left"):
        return "the model has no tension_left"
    from strength import dispatch

    module, par = case.module, case.row
    left = [module.tension_left(damage, par) for damage in np.linspace(0.0, 1.0, 101).tolist()]
    require(left[0] == 1.0, f"at damage 0 the share of the tension is {left[0]:g}, not 1")
    require(near(left[-1], 0.0, 1e-12), f"at damage 1 the share of the tension is {left[-1]:g}, not 0")
    require(all(low < high for high, low in itertools.pairwise(left)), "the share of the tension does not fall with damage")
    opening = module.full_opening(par)
    require(0.0 < opening < math.inf, f"full_opening is {opening:g} m")
    for name, values in (("tension_left", (0.3,)), ("full_opening", ())):
        own, through = getattr(module, name)(*values, par), getattr(dispatch, name)(module.ID, *values, par)
        require(own == through, f"{name} is {own:g}, and {through:g} by its ID")
    return None
