"""Numbers of a sample: the interval of a fraction, the spread of values, a probability from a count, bias and scatter."""

from __future__ import annotations

import math
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


class Bias(NamedTuple):
    """Ratios of computed to measured values, as a log-normal distribution.

    bias : their geometric mean;  low, high : the ends of its interval, None for one ratio
    scatter : standard deviation of their logarithms, None for one ratio
    model : the scatter without that of the measurements; None if that is not known or is as large as the scatter
    factor : the measured value of another shot lies within this factor of its computed one over the bias; None for one ratio
    least, most : the smallest and the largest ratio;  count : their number
    """

    bias: float
    low: float | None
    high: float | None
    scatter: float | None
    model: float | None
    factor: float | None
    least: float
    most: float
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


def bias_and_scatter(ratios: Sequence[float], measured_error: float | None = None, level: float = LEVEL) -> Bias:
    """Bias and scatter of computed values, from their ratios to measured ones (explanation/experience, 1 to 4).

    The logarithms of the ratios are taken as normally distributed, as by McGrattan and Toman (Metrologia 48 (2011) 173). The
    bias is the geometric mean of the ratios and the scatter the sample standard deviation of their logarithms, which is a
    relative standard deviation while it is small. The interval of the bias, and that of another shot, are Student's.

    ratios : computed over measured, one for each shot
    measured_error : relative standard deviation of the measurements, None if it is not known
    level : probability that the interval covers the bias, and that another shot is within the factor

    Raises ValueError without ratios, for one that is not positive and finite, and for a negative error.
    """
    logs = [math.log(ratio) if 0.0 < ratio < math.inf else math.nan for ratio in ratios]
    if not logs or any(map(math.isnan, logs)):
        raise ValueError(f"ratios: positive numbers are needed, at least one, are {list(ratios)}")
    if measured_error is not None and not 0.0 <= measured_error < math.inf:
        raise ValueError(f"measured_error = {measured_error:g}: must be non-negative")
    mean, count = math.fsum(logs) / len(logs), len(logs)
    if count == 1:
        return Bias(math.exp(mean), None, None, None, None, None, *ratios, *ratios, 1)
    from scipy.stats import t

    scatter = math.sqrt(math.fsum((each - mean) ** 2 for each in logs) / (count - 1))
    quantile = float(t.ppf(0.5 * (1.0 + level), count - 1))
    reach, factor = quantile * scatter / math.sqrt(count), math.exp(quantile * scatter * math.sqrt(1.0 + 1.0 / count))
    alone = None if measured_error is None else scatter**2 - measured_error**2
    model = math.sqrt(alone) if alone is not None and alone > 0.0 else None
    ends = math.exp(mean - reach), math.exp(mean + reach)
    return Bias(math.exp(mean), *ends, scatter, model, factor, min(ratios), max(ratios), count)
