"""A target of plane layers, each with its own cavity pressure, which acts only between its two free faces."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hydro2d.penetration.model import InputError, non_negative, positive


@dataclass(frozen=True)
class Layer:
    """``thickness`` (m, math.inf for a half space) of a material that resists with a Y + b rho Vn^2.

    ``density`` rho in kg/m^3, ``strength`` Y in Pa, ``a`` and ``b`` from cavity expansion, dimensionless.
    """

    thickness: float
    density: float
    strength: float
    a: float
    b: float

    def __post_init__(self) -> None:
        if not self.thickness > 0.0:
            raise InputError(f"thickness of a layer = {self.thickness:g}: must be positive")
        non_negative(density=self.density, strength=self.strength, a=self.a, b=self.b)

    @property
    def static(self) -> float:
        """a Y, Pa."""
        return self.a * self.strength

    @property
    def dynamic(self) -> float:
        """b rho, kg/m^3."""
        return self.b * self.density


def gap(thickness: float) -> Layer:
    """An empty space of this width between two plates."""
    positive(thickness=thickness)
    return Layer(thickness, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Target:
    """Layers stacked from depth 0 on: ``faces`` (m) between them, and pressures by layer, zero outside the target.

    Entry k of ``static`` (Pa) and ``dynamic`` (kg/m^3) belongs to the index k that ``locate`` returns: 0 is the space in front
    of the target, k is the k-th layer, and the last is the space behind it.
    """

    faces: np.ndarray
    static: np.ndarray
    dynamic: np.ndarray

    @property
    def back(self) -> float:
        """Depth of the rear face, m; infinite for a half space."""
        return float(self.faces[-1])

    def locate(self, depth: np.ndarray) -> np.ndarray:
        """The index of the layer at each depth; a face belongs to the layer behind it."""
        return np.searchsorted(self.faces, depth, side="right")


def stack(layers: Sequence[Layer]) -> Target:
    """The target of these layers, the first one struck. InputError for none, or for one behind a half space."""
    if not layers:
        raise InputError("layers: a target needs at least one")
    thickness = [layer.thickness for layer in layers]
    if math.inf in thickness[:-1]:
        raise InputError("layers: nothing can lie behind a half space")
    if thickness[-1] == math.inf and layers[-1].static == 0.0:
        raise InputError("layers: a half space without strength never stops a rod")
    faces = np.concatenate([[0.0], np.cumsum(thickness)])
    return Target(faces, _padded([layer.static for layer in layers]), _padded([layer.dynamic for layer in layers]))


def _padded(values: list[float]) -> np.ndarray:
    return np.array([0.0, *values, 0.0])
