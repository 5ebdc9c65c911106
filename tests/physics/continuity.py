"""Functions that must not jump: where a decision once was, and along whole paths."""

from collections.abc import Callable

import numpy as np

#: steps around a value
STEPS = (1e-16, 1e-12, 1e-6)
#: round-off of shares of a cell
NOISE = 1e-14


def changes_in_proportion(function: Callable[[float], object], value: float, steepness: float, sides=(-1.0, 1.0)) -> None:
    """Asserts that in steps around the value no result changes by more than steepness times the step."""
    here = np.array(function(value))
    for step in STEPS:
        for side in sides:
            there = value + side * step
            change = np.abs(np.array(function(there)) - here).max()
            assert change <= steepness * abs(there - value) + NOISE, f"{value} to {there}: {change}"


def largest_jump(function: Callable[[float], object], low: float, high: float) -> float:
    """Change within the last of 45 intervals between low and high, each the half of the previous one with the larger change."""
    first, last = np.array(function(low)), np.array(function(high))
    for _ in range(45):
        middle = 0.5 * (low + high)
        between = np.array(function(middle))
        if np.abs(between - first).max() > np.abs(last - between).max():
            high, last = middle, between
        else:
            low, first = middle, between
    return float(np.abs(last - first).max())
