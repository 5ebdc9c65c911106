"""Numbers of a sample: the Wilson interval of a fraction, the spread of values, the probability estimated from a count."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

#: probability that an interval of a fraction covers the true one; ends of a spread as fractions of the members
LEVEL, LOW, HIGH = 0.9, 0.1, 0.9


class Share(NamedTuple):
    """The frequency of an event: successes of trials, their fraction, and the ends of its Wilson interval."""

    successes: int
    trials: int
    fraction: float
    low: float
    high: float

    @property
    def words(self) -> str:
        """'3 of 8 (21 to 58 %)'."""
        return f"{self.successes} of {self.trials} ({100 * self.low:.0f} to {100 * self.high:.0f} %)"


class Spread(NamedTuple):
    """Median of a sample, its 10 % and 90 % quantiles, and the number of values."""

    median: float
    low: float
    high: float
    count: int


def wilson(successes: int, trials: int, level: float = LEVEL) -> Share:
    """A fraction of runs with its interval after Wilson (J. Am. Stat. Assoc. 22 (1927) 209), which never leaves 0 to 1.

    successes, trials : number of runs with an outcome, and of all runs
    level : probability that the interval covers the true fraction

    The result has ``fraction``, ``low``, ``high``, and ``words``: "3 of 8 (21 to 58 %)". Raises ValueError without trials.
    """
    from scipy.stats import binomtest

    interval = binomtest(successes, trials).proportion_ci(level, method="wilson")
    return Share(successes, trials, successes / trials, float(interval.low), float(interval.high))


def wilson_interval(fraction: float, trials: int, level: float = LEVEL) -> tuple[float, float]:
    """The ends of Wilson's interval of a fraction of as many independent trials, which need not be whole successes."""
    from scipy.special import ndtri

    z = float(ndtri(0.5 + 0.5 * level)) / trials**0.5
    middle, half = fraction + 0.5 * z * z, z * (fraction * (1.0 - fraction) + 0.25 * z * z) ** 0.5
    return max((middle - half) / (1.0 + z * z), 0.0), min((middle + half) / (1.0 + z * z), 1.0)


def spread(values: Sequence[float]) -> Spread | None:
    """Median and 10 to 90 % of values, interpolated between neighbours (Hyndman and Fan's type 7); None without values."""
    if not len(values):
        return None
    low, median, high = np.quantile(np.asarray(values, dtype=float), (LOW, 0.5, HIGH))
    return Spread(float(median), float(low), float(high), len(values))


def probability(successes: int, trials: int) -> float:
    """Probability of an outcome from its frequency in trials: (successes + 1/2) / (trials + 1), Jeffreys' estimate.

    Unlike the fraction it is never 0 or 1, so that a logarithmic score stays finite after a miss.
    """
    return (successes + 0.5) / (trials + 1.0)
