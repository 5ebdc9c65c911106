"""Constants of a strength model from measured flow stresses, by least squares of the relative differences.

Points at or above a given strain rate were measured faster than heat can leave a specimen: along such a curve, plastic work
heats the model as it heats the specimen (rho c dT = w Y d(ep), w the share of the work that becomes heat). At slower rates the
temperature of the test is that of the point.

Every group of points (the hardnesses of a steel, the heats of an alloy) has constants of its own, except for those that all
groups share: a thermal exponent, for instance, if only some groups were measured hot enough to determine it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType

import numpy as np

from hydro2d.base.errors import DeckError, unknown
from hydro2d.base.parameters import NON_NEGATIVE
from hydro2d.files.whole import read_text
from hydro2d.materials import curves
from hydro2d.materials.material import Material
from strength import STRENGTH_MODELS

#: possible columns of a file of points
COLUMNS = ("strain", "rate", "temperature", "group", "stress", "skip")
#: columns of a file without a line that names them
DEFAULT_COLUMNS = ("strain", "rate", "temperature", "stress")
#: share of the plastic work that becomes heat; longest step in plastic strain along a heated curve
HEAT_SHARE, STEP = 0.9, 0.01
#: largest ratio of the singular values of the scaled Jacobian; beyond it the points do not determine a constant
WORST_CONDITION = 1e8
#: smallest share of its first value that a constant can fall to; share below which one that may be 0 counts as 0
LEAST, NOTHING = 1e-9, 1e-6
#: difference that counts for every point where a trial has impossible constants, so that the search turns back
IMPOSSIBLE = 10.0


@dataclass(frozen=True)
class Law:
    """A model that can be fitted.

    free : first values of the constants that a fit changes, those of ``stresses`` in units of the mean measured stress
    needed : other constants that the free ones require
    """

    model: ModuleType
    free: Mapping[str, float]
    stresses: frozenset[str]
    needed: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        return self.model.NAME

    def unit(self, name: str) -> str:
        """Unit of a constant. Raises DeckError if the model has none of this name."""
        for parameter in self.model.PARAMETERS:
            if parameter.name == name:
                return parameter.unit or "1"
        raise DeckError(unknown(f"constant of {self.name}", name, [parameter.name for parameter in self.model.PARAMETERS]))

    def may_be_zero(self, name: str) -> bool:
        return any(parameter.name == name and parameter.sign == NON_NEGATIVE for parameter in self.model.PARAMETERS)


#: first values of the free constants, which of them are stresses, and further constants that must be known
_LAWS = {
    "johnson-cook": (
        {"yield_stress": 0.8, "hardening": 0.6, "hardening_exponent": 0.3, "rate_coefficient": 0.01, "thermal_exponent": 0.8},
        ("yield_stress", "hardening"), ("melt_temperature",)),
    "zerilli-armstrong": (
        {"athermal_stress": 0.1, "thermal_stress": 1.5, "thermal_softening": 3e-3, "rate_hardening": 1e-4, "hardening": 0.6,
         "hardening_exponent": 0.3},
        ("athermal_stress", "thermal_stress", "hardening"), ()),
    "power-law": (
        {"yield_stress": 0.8, "hardening_exponent": 0.05}, ("yield_stress",), ("youngs_modulus", "poisson_ratio")),
    "steinberg-guinan": (
        {"yield_stress": 0.8, "hardening_coefficient": 30.0, "hardening_exponent": 0.1, "temperature_coefficient": 5e-4},
        ("yield_stress",), ()),
    "voce": (
        {"yield_stress": 0.8, "saturation": 0.4, "hardening_rate": 10.0, "rate_coefficient": 0.01, "thermal_exponent": 1.0},
        ("yield_stress", "saturation"), ("melt_temperature",)),
    "preston-tonks-wallace": (
        {"theta": 0.03, "s0": 0.012, "s_inf": 0.005, "y0": 0.008, "y_inf": 0.003, "kappa": 0.3}, (), ()),
}


def law(name: str) -> Law:
    """The law of this name. Raises DeckError for a model that cannot be fitted."""
    if name not in _LAWS:
        raise DeckError(unknown("model that can be fitted", name, _LAWS))
    free, stresses, needed = _LAWS[name]
    return Law(STRENGTH_MODELS[name], free, frozenset(stresses), needed)


def from_material(law: Law, material: Material) -> dict[str, float]:
    """The constants that a fit of this law does not change, if the material's own law or equation of state has them."""
    names = [parameter.name for parameter in law.model.PARAMETERS if parameter.name not in law.free]
    own = {**material.eos.values, **material.strength.values}
    return {name: own[name] for name in names if name in own}


def heating_of(material: Material, from_rate: float) -> Heating:
    """Heating of this material. Raises DeckError if its specific heat is not known."""
    heat = material.eos.numbers.get("specific_heat")
    if heat is None:
        raise DeckError(f"{material.name} has no specific heat")
    return Heating(from_rate, material.reference_density * heat.value)


@dataclass(frozen=True)
class Points:
    """Measured flow stresses (Pa) at plastic strains, strain rates (1/s), temperatures (K) of the test, and groups."""

    strain: np.ndarray
    rate: np.ndarray
    temperature: np.ndarray
    stress: np.ndarray
    group: np.ndarray

    def __len__(self) -> int:
        return self.strain.size

    def chosen(self, mask: np.ndarray) -> Points:
        """Those at which the mask, bool[n], is true."""
        return Points(*(getattr(self, name)[mask] for name in ("strain", "rate", "temperature", "stress", "group")))

    @property
    def groups(self) -> list[float]:
        return sorted(set(self.group.tolist()))

    def tests(self) -> list[np.ndarray]:
        """The points of each group, rate and temperature by rising strain, as indices."""
        order = np.lexsort((self.strain, self.temperature, self.rate, self.group))
        keys = [(self.group[n], self.rate[n], self.temperature[n]) for n in order]
        breaks = [n for n in range(1, len(order)) if keys[n] != keys[n - 1]]
        return np.split(order, breaks)


def read_points(path: Path, columns: Sequence[str] | None = None, unit: float = 1.0) -> Points:
    """Points of a file with a number in each column, separated by spaces or commas; ``#`` begins a comment.

    columns : the column names, from ``COLUMNS``; default: the first line if it names them, else ``DEFAULT_COLUMNS``
    unit : of the stresses, Pa

    Raises DeckError with the line that cannot be read.
    """
    text = read_text(path, DeckError).splitlines()
    lines = [(n, line.split("#")[0].replace(",", " ").split()) for n, line in enumerate(text, 1)]
    lines = [(n, words) for n, words in lines if words]
    if lines and not _is_number(lines[0][1][0]):
        named = lines.pop(0)[1]
        columns = columns or named
    columns = tuple(columns or DEFAULT_COLUMNS)
    for name in columns:
        if name not in COLUMNS:
            raise DeckError(f'{path}: unknown column "{name}" (known: {", ".join(COLUMNS)})')
    missing = [name for name in DEFAULT_COLUMNS if columns.count(name) != 1]
    if missing or columns.count("group") > 1:
        raise DeckError(f"{path}: needs one column each of {', '.join(DEFAULT_COLUMNS)} and at most one group, has "
                        f"{', '.join(columns)}")
    table = np.array([_numbers(path, n, words, len(columns)) for n, words in lines], dtype=float).reshape(-1, len(columns))
    if not len(table):
        raise DeckError(f"{path}: has no points")
    values = {name: table[:, k] for k, name in enumerate(columns) if name != "skip"}
    values["stress"] = values["stress"] * unit
    _check(path, [n for n, _ in lines], values)
    return Points(group=values.pop("group", np.zeros(len(table))), **values)


def _check(path: Path, lines: Sequence[int], values: Mapping[str, np.ndarray]) -> None:
    """Raises DeckError for a point that cannot have been measured."""
    bad = {"strain": values["strain"] < 0.0, "rate": values["rate"] <= 0.0, "temperature": values["temperature"] <= 0.0,
           "stress": values["stress"] <= 0.0}
    for name, mask in bad.items():
        if mask.any():
            must = "must not be negative" if name == "strain" else "must be positive"
            raise DeckError(f"{path}:{lines[int(np.argmax(mask))]}: {name} = {values[name][mask][0]:g}: {must}")


def _numbers(path: Path, line: int, words: Sequence[str], expected: int) -> list[float]:
    if len(words) != expected:
        raise DeckError(f"{path}:{line}: has {len(words)} numbers, expected {expected}")
    try:
        numbers = [float(word) for word in words]
    except ValueError as problem:
        raise DeckError(f"{path}:{line}: {problem}") from None
    if not np.isfinite(numbers).all():
        raise DeckError(f"{path}:{line}: has a number that is not finite")
    return numbers


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


@dataclass(frozen=True)
class Fit:
    """Constants (SI) of every group, their standard errors, and the relative residual model/measured - 1 of every point."""

    law: Law
    points: Points
    constants: Mapping[float, Mapping[str, float]]
    errors: Mapping[float, Mapping[str, float]]
    residual: np.ndarray
    shared: tuple[str, ...] = field(default=())

    @property
    def rms(self) -> float:
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def largest(self) -> float:
        return float(np.abs(self.residual).max())


@dataclass(frozen=True)
class Heating:
    """Heating of test specimens by plastic work.

    from_rate : strain rate from which plastic work heats the specimen, 1/s
    capacity : density times specific heat, J/(m^3 K)
    """

    from_rate: float
    capacity: float
    share: float = HEAT_SHARE

    def warming(self, rate: float) -> float:
        """Temperature gained by a unit of plastic work, K m^3/J."""
        return self.share / self.capacity if rate >= self.from_rate else 0.0


def computed(law: Law, values: Mapping[str, float], points: Points, heating: Heating | None) -> np.ndarray:
    """Flow stress of the law at every point, Pa, float64[n]; all points have the same constants."""
    row, stresses = law.model.row(values), np.empty(len(points))
    rho = values.get("reference_density", 1.0)  # a law that needs the density has its value at rest among its constants
    for test in points.tests():
        rate, T = float(points.rate[test[0]]), float(points.temperature[test[0]])

        def stress(ep: float, at: float, rate: float = rate) -> float:
            return law.model.flow_stress(ep, rate, at, 0.0, rho, row)

        warming = heating.warming(rate) if heating else 0.0
        stresses[test], _ = curves.along(stress, T, warming, points.strain[test].tolist(), STEP)
    return stresses


def beside(material: Material, points: Points, from_rate: float | None = None) -> np.ndarray:
    """Relative differences of the law of a material of the library from the measured stresses, float64[n]; nothing is fitted.

    from_rate : strain rate from which plastic work heats the specimen, 1/s

    Raises DeckError for a material without strength, and for one whose specific heat is needed and not known.
    """
    if not material.has_strength:
        raise DeckError(f"{material.name} has no strength")
    heating = heating_of(material, from_rate) if from_rate else None
    own = Law(material.strength.module("strength"), {}, frozenset())
    return computed(own, material.strength.values, points, heating) / points.stress - 1.0


def fit(
    law: Law, points: Points, given: Mapping[str, float], shared: Sequence[str] = (), heating: Heating | None = None
) -> Fit:
    """The constants with the least sum of squared relative differences.

    given : constants that are not fitted, SI
    shared : constants that are the same in all groups

    Raises DeckError for constants that are unknown or missing, and for those that the points do not determine.
    """
    from scipy.optimize import least_squares

    _check_names(law, given, shared)
    free = [name for name in law.free if name not in given]
    places: list[tuple[str, float | None]] = [(name, None) for name in free if name in shared]
    places += [(name, group) for group in points.groups for name in free if name not in shared]
    if not free:
        raise DeckError(f"{law.name}: no constant is left to fit")
    if len(points) < len(places):
        raise DeckError(f"{law.name}: {len(places)} constants need as many points, there are {len(points)}")
    members = {group: points.group == group for group in points.groups}
    level = {None: float(points.stress.mean()), **{g: float(points.stress[mask].mean()) for g, mask in members.items()}}
    scale = np.array([law.free[name] * (level[group] if name in law.stresses else 1.0) for name, group in places])

    def constants(x: np.ndarray) -> dict[float, dict[str, float]]:
        return _by_group(dict(zip(places, (x * scale).tolist(), strict=True)), points.groups, given)

    def residual(x: np.ndarray) -> np.ndarray:
        differences = np.empty(len(points))
        for group, values in constants(x).items():
            mask = members[group]
            try:
                differences[mask] = computed(law, values, points.chosen(mask), heating) / points.stress[mask] - 1.0
            except ValueError:
                differences[mask] = IMPOSSIBLE
        return differences

    try:
        for values in constants(np.ones(len(places))).values():
            law.model.row(values)
        best = least_squares(residual, np.ones(len(places)), bounds=(LEAST, np.inf), xtol=1e-10, ftol=1e-10)
    except ValueError as problem:
        raise DeckError(str(problem)) from None
    best.x[[x < NOTHING and law.may_be_zero(name) for x, (name, _) in zip(best.x, places, strict=True)]] = 0.0
    alone = len(points.groups) == 1
    names = [name if alone or group is None else f"{name} of group {group:g}" for name, group in places]
    spread = _spread(best.jac, 2.0 * best.cost, names) * scale
    errors = _by_group(dict(zip(places, spread.tolist(), strict=True)), points.groups, {})
    return Fit(law, points, constants(best.x), errors, best.fun, tuple(name for name in free if name in shared))


def _by_group(values: Mapping[tuple[str, float | None], float], groups: Sequence[float],
              given: Mapping[str, float]) -> dict[float, dict[str, float]]:
    """The values of every group, with those that all groups share and those that are given."""
    return {group: {**given, **{name: value for (name, own), value in values.items() if own in (None, group)}}
            for group in groups}


def _check_names(law: Law, given: Mapping[str, float], shared: Sequence[str]) -> None:
    """Raises DeckError for a constant that is unknown, missing, or shared without being fitted."""
    for name in given:
        law.unit(name)
    for name in shared:
        if name not in law.free or name in given:
            raise DeckError(f'"{name}" is not fitted, so groups cannot share it (fitted: {", ".join(law.free)})')
    required = [parameter.name for parameter in law.model.PARAMETERS if parameter.required and parameter.name not in law.free]
    missing = [name for name in dict.fromkeys((*law.needed, *required)) if name not in given]
    if missing:
        raise DeckError(f"{law.name}: a fit needs {', '.join(missing)}")


def _spread(jacobian: np.ndarray, squares: float, names: Sequence[str]) -> np.ndarray:
    """Standard errors of the scaled constants, from the sum of squares at the best ones.

    Raises DeckError for constants that the points do not determine.
    """
    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
    if sizes[-1] * WORST_CONDITION <= sizes[0]:
        doubtful = names[int(np.argmax(np.abs(directions[-1])))]
        raise DeckError(f"the points do not determine {doubtful}; keep it at a known value, or let groups share it")
    variance = squares / max(1, jacobian.shape[0] - jacobian.shape[1])
    return np.sqrt(variance * np.sum((directions / sizes[:, None]) ** 2, axis=0))
