"""The checks that every equation of state, strength model and damage model must pass, whether part of hydro2d or from outside.

``CHECKS`` has the checks for each part of a material. Each is a function of a Case, and the first line of its docstring says
what is required. It raises Broken if a model fails, and returns the reason if it does not apply. The tests of hydro2d and
``hydro2d check-model`` run the same checks.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from eos.layout import E0, RHO0
from hydro2d.materials.outside import KINDS, Kind
from hydro2d.materials.sesame import Table
from hydro2d.parameters import NON_NEGATIVE, POSITIVE, Parameter

#: an ID that no model has
NOBODY = 99


class Broken(Exception):
    """A requirement that a model does not meet, with the state and the numbers."""


@dataclass(frozen=True)
class Case:
    """A model, with the numbers for its checks.

    values : its parameters in SI, with every term in use
    densities : densities in the stated range of an equation of state, over the density at rest;  energies : in J/kg
    constant : parameters for which the flow stress is constant, or None
    base : what `row` takes beside the parameters: the module of the solid that the model stands over, and the table
    """

    kind: Kind
    module: ModuleType
    values: Mapping[str, float]
    densities: tuple[float, ...] = tuple(np.linspace(0.95, 1.5, 12))
    energies: tuple[float, ...] = (0.0, 1e5, 3e6)
    constant: Mapping[str, float] | None = None
    base: tuple[ModuleType | Table, ...] = ()

    @property
    def row(self) -> np.ndarray:
        return self.packed(self.values)

    def packed(self, values: Mapping[str, float]) -> np.ndarray:
        """The row of these parameters."""
        return self.module.row(values, *self.base)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters of the model, and those of its solid that are given with them."""
        below = [each for over in self.base if isinstance(over, ModuleType) for each in over.PARAMETERS]
        return (*self.module.PARAMETERS, *(each for each in below if each.name not in self.module.GIVEN_TO_SOLID))

    @property
    def virgin(self) -> np.ndarray:
        """The internal variables of virgin material, float64[n]."""
        return np.array([field.at_rest(self.row) for field in getattr(self.module, "INTERNAL", ())])

    def evaluate(self, rho: float, e: float, par: np.ndarray) -> tuple[float, float, float, float]:
        """`evaluate` of an equation of state, of virgin material where it has internal variables."""
        state = (rho, e, self.virgin, par) if hasattr(self.module, "INTERNAL") else (rho, e, par)
        return self.module.evaluate(*state)

    def states(self) -> Iterator[tuple[float, float]]:
        """Densities (kg/m^3) and energies (J/kg) of the stated range, of a table those that it has."""
        par = self.row
        found = itertools.product((par[0] * ratio for ratio in self.densities), self.energies)
        return (state for state in found if not (self.has_kinks and math.isnan(self.evaluate(*state, par)[0])))

    @property
    def has_kinks(self) -> bool:
        """Whether slopes jump at the points of a table, that of the model or of its solid."""
        return any(isinstance(each, Table) for each in self.base)

    def given(self, *names: str) -> float | None:
        """The first of these parameters that the model has, as it is given or by default."""
        defaults = {parameter.name: parameter.default for parameter in self.parameters}
        return next((self.values.get(name, defaults[name]) for name in names if name in defaults), None)


def require(kept: bool, message: str) -> None:
    """Raises Broken with a message if a requirement is not met."""
    if not kept:
        raise Broken(message)


# ------------------------------------------------------------------------------------------------ what it says of itself


def row(case: Case) -> None:
    """row(values) returns as many numbers as the kernels read, and none of them is NaN"""
    found = case.row
    length, least = case.kind.length, "at least " if case.kind.part == "eos" else ""
    kept = isinstance(found, np.ndarray) and found.ndim == 1 and found.dtype == np.float64
    require(kept and (found.size == length or (least and found.size > length)),
            f"row gives {getattr(found, 'dtype', type(found).__name__)} {getattr(found, 'shape', '')}, not float64 "
            f"({least}{length},)")
    require(not np.isnan(found).any(), f"row has NaN in slot {np.isnan(found).argmax()}")
    if case.kind.part == "eos":
        density = case.values["reference_density"]
        require(found[RHO0] == density, f"slot RHO0 = {RHO0} of the row is {found[RHO0]:g}, not reference_density, {density:g}")


def wrong_parameters(case: Case) -> None:
    """row refuses parameters that are unknown, missing or not numbers, and names them"""
    refused(case, {**case.values, "colour": 1.0}, "unknown parameter 'colour'")
    for parameter in case.parameters:
        refused(case, {**case.values, parameter.name: math.nan}, parameter.name)
        if parameter.required:
            rest = {name: value for name, value in case.values.items() if name != parameter.name}
            refused(case, rest, f"{parameter.name}' is missing")


def ranges(case: Case) -> None:
    """row refuses negative and zero values where the range of a parameter excludes them"""
    for parameter in case.parameters:
        for number in {POSITIVE: (-1.0, 0.0), NON_NEGATIVE: (-1.0,)}.get(parameter.sign, ()):
            refused(case, {**case.values, parameter.name: number}, f"{parameter.name} = {number}")


def refused(case: Case, values: Mapping[str, float], words: str) -> None:
    """Raises Broken unless `row` raises a ValueError with these words in it."""
    try:
        case.packed(values)
    except ValueError as error:
        require(words in str(error), f"row says {error}, without {words}: use hydro2d.parameters.collect")
    else:
        raise Broken(f"row takes a parameter that is wrong ({words})")


# ------------------------------------------------------------------------------------------------ equations of state


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
    """Whether a derivative is the mean of the slopes on both sides, or where it is one-sided either of them."""
    if one_sided:
        return near(value, below, 2e-4) or near(value, above, 2e-4)
    return near(value, 0.5 * (below + above), 1e-7)


def near(value: float, expected: float, share: float) -> bool:
    """Whether two numbers are equal within a fraction of the second, or within 1e-12."""
    return abs(value - expected) <= max(share * abs(expected), 1e-12)


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
        found = case.evaluate(rho, e, par)
        kept = (np.isfinite(found).all() and found[3] >= 0.0) or (case.has_kinks and np.isnan(found).all())
        require(kept, f"evaluate({rho:g}, {e:g}) is {tuple(map(float, found))}")


def pressure_rises(case: Case) -> None:
    """p rises with density without a jump, also outside the stated range"""
    par = case.row
    rho = par[0] * np.linspace(0.3, 8.0, 20001)
    e = case.energies[-1] if case.has_kinks else 1e5
    found = np.array([case.evaluate(x, e, par)[:2] for x in rho])
    if case.has_kinks:
        inside = ~np.isnan(found[:, 0])
        require(inside.sum() > 1000, f"the table has {inside.sum()} of {inside.size} densities at {e:g} J/kg")
        rho, found = rho[inside], found[inside]
    ends = np.array([found[:-1, 1], found[1:, 1]]) * np.diff(rho)
    rise, expected = np.diff(found[:, 0]), ends.mean(axis=0)  # between those of both ends, where a slope jumps
    wrong = ~(rise > 0.0) | (rise - ends.max(axis=0) > 5e-3 * abs(expected)) | (ends.min(axis=0) - rise > 5e-3 * abs(expected))
    k = int(wrong.argmax())
    require(not wrong.any(), f"from rho = {rho[k]:g} to {rho[k + 1]:g} kg/m^3 p rises by {rise[k]:g} Pa, and dp/drho says "
                             f"{expected[k]:g}")  # fmt: skip


def temperature(case: Case) -> str | None:
    """the temperature is consistent with the pressure, T ds = de - p drho/rho^2: d(1/T)/drho|e = -d(p/(rho^2 T))/de|rho"""
    if hasattr(case.module, "INTERNAL"):
        return "what the internal variables store is not in the energy of the pressure"
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
    """internal variables stay as they are while nothing happens, and finite and within their bounds whatever happens"""
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
        found = case.module.evaluate(rho, e, internal, par)
        kept = np.isfinite(found).all() or (case.has_kinks and np.isnan(found).all())
        require(kept, f"{at}, and evaluate is {tuple(map(float, found))}")
    return None


# ------------------------------------------------------------------------------------------------ strength


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
    for found, state in zip(shear[1:-1], states().T, strict=True):
        expected = case.module.shear_modulus(*state, par)
        at = "p = {:g} Pa, rho = {:g} kg/m^3, T = {:g} K".format(*state)
        require(not case.module.CONSTANT_MODULUS or expected == par[SHEAR],
                f"at {at} the modulus is {expected:g} Pa, not slot SHEAR of the row, {par[SHEAR]:g}")
        require(found == expected, f"at {at} the modulus is {expected:g} Pa, and {found:g} in a row")


def virgin(case: Case) -> None:
    """slots SHEAR and YIELD of the row are the modulus and the flow stress of the virgin material at rest"""
    from strength.layout import SHEAR, YIELD

    par, T, rho = case.row, at_rest(case), case.given("reference_density") or 2700.0
    flow, modulus = case.module.flow_stress(0.0, 0.0, T, 0.0, rho, par), case.module.shear_modulus(0.0, rho, T, par)
    require(flow == par[YIELD], f"the flow stress is {flow:g} Pa, slot YIELD of the row {par[YIELD]:g}")
    require(modulus == par[SHEAR], f"the shear modulus is {modulus:g} Pa, slot SHEAR of the row {par[SHEAR]:g}")


def at_rest(case: Case) -> float:
    """The temperature at which a model has its own yield stress, K."""
    found = case.given("modulus_temperature", "reference_temperature")
    return found if isinstance(found, float) else 298.0


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
        found = case.module.flow_stress(ep, 1e6, T, p, rho, case.row)
        require(found == 0.0, f"the flow stress is {found:g} Pa at {T:g} K")
    return None


def yield_floor(case: Case) -> str | None:
    """the flow stress never falls below yield_floor"""
    if not hasattr(case.module, "yield_floor"):
        return "the model has no yield_floor"
    par, least = case.row, case.module.yield_floor(case.row)
    for ep, rate, (p, rho, T) in itertools.product((0.0, 0.01, 1.0), (0.0, 1e5), states().T):
        found = case.module.flow_stress(ep, rate, T, p, rho, par)
        require(found >= least, f"the flow stress is {found:g} Pa at ep = {ep:g}, T = {T:g} K, the floor {least:g}")
    return None


def weakening(case: Case) -> str | None:
    """damage weakens, and undamaged material has its flow stress to the last bit; compiled with the others, it is the same"""
    if not hasattr(case.module, "weakened"):
        return "the model has no weakened"
    from strength import dispatch

    par, shares = case.row, np.linspace(0.0, 1.0, 11)
    for rate, (p, rho, T) in itertools.product((0.0, 1e5), states().T):
        intact = case.module.flow_stress(0.1, rate, T, p, rho, par)
        found = [case.module.weakened(intact, rate, p, damage, par) for damage in shares]
        at = f"at rate {rate:g} 1/s and p = {p:g} Pa"
        require(found[0] == intact, f"{at} the flow stress without damage is {found[0]:g} Pa, not {intact:g}")
        in_order(-np.diff(found), shares, "damage", f"flow stress rises {at}")
        require(found[-1] >= 0.0, f"{at} the flow stress of crushed material is {found[-1]:g} Pa")
        through = dispatch.weakened(case.module.ID, intact, rate, p, 0.5, par)
        require(through == found[5], f"{at} the flow stress is {found[5]:g} Pa, and {through:g} by its ID")
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
                      f"says {expected:g} Pa")  # fmt: skip
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


_ALL = (row, wrong_parameters, ranges)
CHECKS: dict[str, tuple[Callable[[Case], str | None], ...]] = {
    "eos": (*_ALL, eos_is_chosen, derivatives, sound_speed, rest, finite, pressure_rises, temperature, memory),
    "strength": (*_ALL, strength_is_chosen, moduli, virgin, monotone, melt, yield_floor, weakening, constant_yield,
                 internal_variables),
    "damage": (*_ALL, damage, cracks),
}


def case_of_table(table: Table, rest: float, T: float) -> Case:
    """The case of a table with a density at rest, kg/m^3, at a temperature, K: states between its points, as far as it goes."""
    from eos import tabular

    low, high = max(table.density[0] / rest, 0.9), min(table.density[-1] / rest, 2.0)
    values = {"reference_density": rest, "reference_temperature": T}
    return Case(KINDS["eos"], tabular, values, tuple(np.linspace(low, high, 25)[1:-1]), (0.0, 1e5, 1e6, 3e6), base=(table,))


def case_of(part: str, module: ModuleType) -> Case:
    """The case that a model itself provides: EXAMPLE, and DENSITIES, ENERGIES and CONSTANT_YIELD if it has them.

    Raises Broken for one without EXAMPLE.
    """
    example = getattr(module, "EXAMPLE", None)
    require(isinstance(example, Mapping), "needs EXAMPLE, parameters in SI to try it with: a number for each, every term on")
    given = {"densities": "DENSITIES", "energies": "ENERGIES", "constant": "CONSTANT_YIELD"}
    own = {name: getattr(module, word) for name, word in given.items() if hasattr(module, word)}
    return Case(KINDS[part], module, example, **own)
