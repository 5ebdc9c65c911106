"""Tables made from other equations of state: for users without one, and for tests against the tabulated model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import ModuleType

import numpy as np

from eos.layout import RHO0
from hydro2d.base.errors import DeckError
from hydro2d.materials.material import Material
from hydro2d.materials.sesame import Table

#: share of the temperatures that lie between zero and that at rest, and range of energies, J/kg, where a search begins
BELOW, FIRST = 0.2, 1e6
#: an energy is known when its interval is this share of it
_TOLERANCE, _MOST = 1e-15, 200


def points(low: float, rest: float, high: float, number: int) -> np.ndarray:
    """``number`` rising numbers from low to high, in equal ratios, with ``rest`` among them; float64[number]."""
    below = round((number - 1) * math.log(rest / low) / math.log(high / low))
    below = min(max(below, 1), number - 2)
    return np.concatenate([np.geomspace(low, rest, below + 1)[:-1], [rest], np.geomspace(rest, high, number - below)[1:]])


def temperatures(rest: float, high: float, number: int) -> np.ndarray:
    """``number`` temperatures from zero to high, K: in equal steps to that at rest, then in equal ratios; float64[number].

    If that at rest is zero, all in equal steps.
    """
    if rest == 0.0:
        return np.linspace(0.0, high, number)
    below = min(max(round(BELOW * (number - 1)), 1), number - 2)
    return np.concatenate([np.linspace(0.0, rest, below + 1)[:-1], [rest], np.geomspace(rest, high, number - below)[1:]])


def of_material(material: Material, density: np.ndarray, temperature: np.ndarray) -> Table:
    """`table_of` the equation of state of a material."""
    return table_of(material.name, material.eos.module("eos"), material.eos.values, density, temperature)


def table_of(name: str, module: ModuleType, values: Mapping[str, float], density: np.ndarray, temperature: np.ndarray) -> Table:
    """The table of an equation of state.

    name : of the material, for messages;  module, values : equation of state and its parameters by name, in SI
    density : float64[i], kg/m^3, rising;  temperature : float64[j], K, rising from 0 or more

    Raises DeckError for an equation of state with internal variables, and if no energy has one of the temperatures.
    """
    if hasattr(module, "INTERNAL") or hasattr(module, "FROM_TABLE"):
        raise DeckError(f"material {name}: {module.NAME} cannot be tabulated: " + (
            "its pressure depends on internal variables" if hasattr(module, "INTERNAL") else "it is a table"))
    par = module.row(values)
    p, e = np.empty((density.size, temperature.size)), np.empty((density.size, temperature.size))
    for i, rho in enumerate(density.tolist()):
        for j, T in enumerate(temperature.tolist()):
            e[i, j] = _energy(module, rho, T, par, name)
            p[i, j] = module.evaluate(rho, e[i, j], par)[0]
    rest = density == par[RHO0]
    p[rest] = np.where(np.abs(p[rest]) < 1e-3, 0.0, p[rest])  # Pa: round-off of the energy instead of zero
    return Table(np.array(density, dtype=float), np.array(temperature, dtype=float), p, e)


def _energy(module: ModuleType, rho: float, T: float, par: np.ndarray, name: str) -> float:
    """The greatest energy at which a material is not hotter than T, J/kg, by bisection."""
    def warmer(e: float) -> bool:
        return module.evaluate(rho, e, par)[3] > T

    low = high = 0.0
    step = FIRST
    while warmer(low):
        low, step = low - step, 2.0 * step
        if step > 1e300:
            raise DeckError(f"material {name}: no energy has a temperature of {T:g} K at {rho:g} kg/m^3")
    step = FIRST
    while not warmer(high):
        high, step = high + step, 2.0 * step
        if step > 1e300:
            raise DeckError(f"material {name}: no energy has a temperature of {T:g} K at {rho:g} kg/m^3")
    for _ in range(_MOST):
        middle = 0.5 * (low + high)
        if not (low < middle < high) or high - low <= _TOLERANCE * abs(middle):
            break
        low, high = (low, middle) if warmer(middle) else (middle, high)
    return low
