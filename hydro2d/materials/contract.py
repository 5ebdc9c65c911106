"""The checks that every equation of state, strength model and damage model must pass, whether part of hydro2d or from outside.

``CHECKS`` has the checks for each part of a material. Each is a function of a Case, and the first line of its docstring says
what is required. It raises Broken if a model fails, and returns the reason if it does not apply. The tests of hydro2d and
``hydro2d check-model`` run the same checks.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import ModuleType

import numpy as np

from hydro2d.base.parameters import NON_NEGATIVE, POSITIVE
from hydro2d.materials.contract_case import Broken, Case, require
from hydro2d.materials.contract_eos import (
    derivatives,
    eos_is_chosen,
    finite,
    memory,
    pressure_rises,
    rest,
    sound_speed,
    temperature,
)
from hydro2d.materials.contract_strength import (
    cell_size,
    constant_yield,
    cracks,
    damage,
    internal_variables,
    melt,
    moduli,
    monotone,
    strength_is_chosen,
    virgin,
    weakening,
    yield_floor,
)
from hydro2d.materials.form import wrong_row
from hydro2d.materials.outside import KINDS
from hydro2d.materials.sesame import Table


def row(case: Case) -> None:
    """row(values) returns as many numbers as the kernels read, and none of them is NaN"""
    if wrong := wrong_row(case.row, case.kind, case.values):
        raise Broken(wrong)


def wrong_parameters(case: Case) -> None:
    """row refuses parameters that are unknown, missing or not numbers, and names them"""
    refused(case, {**case.values, "colour": 1.0}, 'unknown parameter "colour"')
    for parameter in case.parameters:
        refused(case, {**case.values, parameter.name: math.nan}, parameter.name)
        if parameter.required:
            rest = {name: value for name, value in case.values.items() if name != parameter.name}
            refused(case, rest, f"{parameter.name}' is missing")


def ranges(case: Case) -> None:
    """row refuses negative and zero values where the range of a parameter excludes them"""
    for parameter in case.parameters:
        for number in {POSITIVE: (-1.0, 0.0), NON_NEGATIVE: (-1.0,)}.get(parameter.sign, ()):
            refused(case, {**case.values, parameter.name: number}, f"{parameter.name} = {number:g}")


def refused(case: Case, values: Mapping[str, float], words: str) -> None:
    """Raises Broken unless `row` raises a ValueError with these words in it."""
    try:
        case.packed(values)
    except ValueError as error:
        require(words in str(error), f"row says {error}, without {words}: use hydro2d.base.parameters.collect")
    else:
        raise Broken(f"row takes a parameter that is wrong ({words})")


_ALL = (row, wrong_parameters, ranges)
CHECKS: dict[str, tuple[Callable[[Case], str | None], ...]] = {
    "eos": (*_ALL, eos_is_chosen, derivatives, sound_speed, rest, finite, pressure_rises, temperature, memory),
    "strength": (*_ALL, strength_is_chosen, moduli, virgin, monotone, melt, yield_floor, weakening, constant_yield,
                 internal_variables),
    "damage": (*_ALL, damage, cell_size, cracks),
}


def case_of_table(table: Table, rest: float, T: float) -> Case:
    """The case of a table with a density at rest, kg/m^3, at a temperature, K: states between its points, within its range."""
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
