"""Inputs that are normally distributed together: their points follow from independent ones by the Cholesky factor of their
correlations, z' = L z with C = L L^T.

Source: Stein, Technometrics 29 (1987) 143, for Latin hypercubes: each column keeps its strata and takes the order of z'.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hydro2d.study.plan.distributions import CLOSEST, Distribution


def groups(inputs: Sequence[Distribution]) -> list[list[int]]:
    """The numbers of the inputs by group: each input by itself, and those of a joint distribution together.

    Raises ValueError if one of these is missing.
    """
    keys = [each.key for each in inputs]
    found = [tuple(map(keys.index, each.joint)) if each.joint else (number,) for number, each in enumerate(inputs)]
    return [list(group) for group in dict.fromkeys(found)]


def correlation(inputs: Sequence[Distribution], group: Sequence[int]) -> np.ndarray:
    """The correlations of the inputs of a group, float64[group, group]."""
    return np.array([inputs[number].correlation or (1.0,) for number in group])


def correlated(inputs: Sequence[Distribution], cube: np.ndarray, strata: bool = False) -> np.ndarray:
    """Cumulative probabilities of the inputs, float64[n, inputs], from independent points of the unit cube of this shape.

    strata : each column keeps its numbers, in another order, so that it fills 0 to 1 as evenly as before

    Raises ValueError for correlations that are none.
    """
    from scipy.special import ndtr, ndtri

    made = np.array(cube, dtype=float)
    for group in groups(inputs):
        if len(group) > 1:
            z = ndtri(np.clip(made[:, group], CLOSEST, 1.0 - CLOSEST))
            points = ndtr(z @ np.linalg.cholesky(correlation(inputs, group)).T)
            if strata:
                ranks = points.argsort(axis=0).argsort(axis=0)
                points = np.take_along_axis(np.sort(made[:, group], axis=0), ranks, axis=0)
            made[:, group] = points
    return made


def follow(inputs: Sequence[Distribution], cube: np.ndarray, number: int) -> np.ndarray:
    """Points of the cube, float64[n, inputs], at which the others of an input's group have their conditional medians."""
    from scipy.special import ndtr, ndtri

    made, (group,) = np.array(cube, dtype=float), (group for group in groups(inputs) if number in group)
    z = ndtri(np.clip(made[:, number], CLOSEST, 1.0 - CLOSEST))
    for other, coefficient in zip(group, inputs[number].correlation, strict=False):
        if other != number:
            made[:, other] = ndtr(coefficient * z)
    return made
