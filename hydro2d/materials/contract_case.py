"""A model with the numbers for its checks, and the exception for a requirement that is not met."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from hydro2d.base.parameters import Parameter
from hydro2d.materials.outside import Kind
from hydro2d.materials.sesame import Table

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
    base : further arguments of `row`: the module of the solid that the model builds on, and the table
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
        """`evaluate` of an equation of state, for virgin material if it has internal variables."""
        state = (rho, e, self.virgin, par) if hasattr(self.module, "INTERNAL") else (rho, e, par)
        return self.module.evaluate(*state)

    def states(self) -> Iterator[tuple[float, float]]:
        """Densities (kg/m^3) and energies (J/kg) of the stated range; for a table only those that it covers."""
        par = self.row
        states = itertools.product((par[0] * ratio for ratio in self.densities), self.energies)
        return (state for state in states if not (self.has_kinks and math.isnan(self.evaluate(*state, par)[0])))

    @property
    def has_kinks(self) -> bool:
        """Whether slopes jump at the points of a table, that of the model or of its solid."""
        return any(isinstance(each, Table) for each in self.base)

    def given(self, *names: str) -> float | None:
        """The value, given or default, of the first of these parameters that the model has."""
        defaults = {parameter.name: parameter.default for parameter in self.parameters}
        return next((self.values.get(name, defaults[name]) for name in names if name in defaults), None)


def require(kept: bool, message: str) -> None:
    """Raises Broken with a message if a requirement is not met."""
    if not kept:
        raise Broken(message)


def near(value: float, expected: float, share: float) -> bool:
    """Whether two numbers are equal within a fraction of the second, or within 1e-12."""
    return abs(value - expected) <= max(share * abs(expected), 1e-12)
