"""A Gaussian process over points of the unit cube: the effect of each input by itself, and what they do together.

    k(x, x') = sum_i a_i M(|x_i - x_i'| / s_i) + b M(|(x - x')/l|) + c delta
    M(r) = (1 + sqrt(5) r + 5 r^2 / 3) exp(-sqrt(5) r)

M is Matern's correlation with nu = 5/2. Without the first sum every function that the rows allow would have interactions, and
total Sobol indices would be too large. The numbers a, s, b, l and c are the most probable ones for the rows, under wide
log-normal priors. Sources: Rasmussen & Williams, Gaussian Processes for Machine Learning (2006), (2.25), (4.17), (5.9), (5.12);
Duvenaud, Nickisch & Rasmussen, Adv. Neural Inf. Process. Syst. 24 (2011), for sums over inputs; Wilson et al., Proc. ICML 37
(2020) 10292, for draws from the posterior.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass

import numpy as np

#: degrees of freedom of Matern's correlation, 2 nu
FREEDOM = 5
#: medians of the priors of a, s, b, l and c, for results of unit variance on a unit cube, and their spreads in e-folds
MEDIANS, SPREADS = (0.3, 0.7, 0.1, 1.0, 1e-2), (2.0, 0.7, 2.0, 0.5, 3.0)
#: bounds in spreads from the median; starts of the search, as shifts of the length scales in e-folds
FARTHEST, STARTS = 4.0, (0.0, -1.0)
#: waves of which a draw from the prior consists; points that are evaluated at a time; sets of numbers among the draws; points
#: at which the variance of draws is compared with that of the posterior
WAVES, BLOCK, SETS, CHECKED = 512, 4096, 5, 256
#: added to the diagonal, in variances of the result, against round-off
LEAST_NOISE = 1e-10
#: no number between 0 and 1 of which a quantile is taken is nearer to them
CLOSEST = 2.0**-31


def one_thread() -> AbstractContextManager:
    """Linear algebra with one thread: matrices of a few hundred rows gain nothing from more, and the bits stay the same."""
    from threadpoolctl import threadpool_limits

    return threadpool_limits(1, "blas")


def correlation(r: np.ndarray) -> np.ndarray:
    """Matern's correlation with nu = 5/2 at scaled distances."""
    r = np.sqrt(FREEDOM) * r
    return (1.0 + r + r * r / 3.0) * np.exp(-r)


def _slope(r: np.ndarray) -> np.ndarray:
    """-2 dM/d(r^2): the derivative of M by the logarithm of a length is this times the squared scaled distance along it."""
    r = np.sqrt(FREEDOM) * r
    return FREEDOM / 3.0 * (1.0 + r) * np.exp(-r)


@dataclass(frozen=True)
class Numbers:
    """The numbers of the covariance: a, s, l float64[d], b, c; see the formula of the module."""

    a: np.ndarray
    s: np.ndarray
    b: float
    lengths: np.ndarray
    c: float

    @classmethod
    def of(cls, theta: np.ndarray) -> Numbers:
        """From their logarithms, float64[3 d + 2]."""
        d, values = (len(theta) - 2) // 3, np.exp(theta)
        return cls(values[:d], values[d : 2 * d], values[2 * d], values[2 * d + 1 : 3 * d + 1], values[-1])


def _prior(d: int) -> tuple[np.ndarray, np.ndarray]:
    """Means and spreads of the logarithms of the numbers, float64[3 d + 2]."""
    counts = (d, d, 1, d, 1)
    return np.repeat(np.log(MEDIANS), counts), np.repeat(SPREADS, counts)


def squares(one: list[np.ndarray], other: list[np.ndarray]) -> np.ndarray:
    """Squared distances along each input between points, float64[d, n, m]; an input has one or several coordinates."""
    from scipy.spatial.distance import cdist

    return np.stack([cdist(x, y, "sqeuclidean") for x, y in zip(one, other, strict=True)])


def covariance(distances: np.ndarray, numbers: Numbers) -> np.ndarray:
    """The covariance of points from their squared distances along each input, without c."""
    total = numbers.b * correlation(np.sqrt(np.tensordot(numbers.lengths**-2, distances, 1)))
    for a, s, own in zip(numbers.a, numbers.s, distances, strict=True):
        total += a * correlation(np.sqrt(own) / s)
    return total


def _misfit(theta: np.ndarray, distances: np.ndarray, y: np.ndarray) -> tuple[float, np.ndarray]:
    """Minus the logarithm of the posterior density of the numbers, and its gradient, float64[3 d + 2]."""
    from scipy.linalg import cho_factor, cho_solve

    numbers, d = Numbers.of(theta), len(distances)
    alone = [np.sqrt(own) / s for own, s in zip(distances, numbers.s, strict=True)]
    scaled = distances / numbers.lengths[:, None, None] ** 2
    r = np.sqrt(scaled.sum(axis=0))
    parts = [a * correlation(each) for a, each in zip(numbers.a, alone, strict=True)]
    together = numbers.b * correlation(r)
    total = together + sum(parts)
    total[np.diag_indices_from(total)] += numbers.c + LEAST_NOISE
    factor = cho_factor(total, lower=True)
    weights = cho_solve(factor, y)
    rest = cho_solve(factor, np.eye(len(y))) - np.outer(weights, weights)
    slope = numbers.b * _slope(r)
    gradient = np.empty_like(theta)
    for i in range(d):
        gradient[i] = np.vdot(rest, parts[i])
        gradient[d + i] = np.vdot(rest, numbers.a[i] * _slope(alone[i]) * alone[i] ** 2)
        gradient[2 * d + 1 + i] = np.vdot(rest, slope * scaled[i])
    gradient[2 * d] = np.vdot(rest, together)
    gradient[-1] = numbers.c * np.trace(rest)
    mean, spread = _prior(d)
    off = (theta - mean) / spread
    value = 0.5 * y @ weights + np.log(np.diag(factor[0])).sum() + 0.5 * off @ off
    return float(value), 0.5 * gradient + off / spread


def most_probable(x: list[np.ndarray], y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Logarithms of the most probable numbers, float64[3 d + 2], and a root of their covariance (Laplace), float64[k, k]."""
    from scipy.optimize import minimize

    distances, (mean, spread) = squares(x, x), _prior(len(x))
    d = len(x)
    bounds = list(zip(mean - FARTHEST * spread, mean + FARTHEST * spread, strict=True))
    searches = []
    for shift in STARTS:
        start = mean.copy()
        start[d : 2 * d] += shift
        start[2 * d + 1 : -1] += shift
        searches.append(minimize(_misfit, start, (distances, y), "L-BFGS-B", jac=True, bounds=bounds))
    best = min(searches, key=lambda each: each.fun).x
    return best, _root(best, distances, y)


def _root(theta: np.ndarray, distances: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A root of the covariance of the numbers: of the inverse Hessian of the misfit; no direction is wider than the prior."""
    step, count = 1e-4, len(theta)
    hessian = np.empty((count, count))
    for n in range(count):
        shift = step * np.eye(count)[n]
        hessian[n] = (_misfit(theta + shift, distances, y)[1] - _misfit(theta - shift, distances, y)[1]) / (2.0 * step)
    values, directions = np.linalg.eigh(0.5 * (hessian + hessian.T))
    return directions / np.sqrt(np.maximum(values, 1.0 / max(SPREADS) ** 2))


class Process:
    """A Gaussian process through rows: x float64[n, k_i] for each of d inputs, y float64[n] of zero mean and unit variance."""

    def __init__(self, x: list[np.ndarray], y: np.ndarray, theta: np.ndarray):
        from scipy.linalg import cho_solve, cholesky

        self.x, self.y, self.numbers = x, y, Numbers.of(theta)
        total = covariance(squares(x, x), self.numbers)
        total[np.diag_indices_from(total)] += self.numbers.c + LEAST_NOISE
        self.factor = cholesky(total, lower=True)
        self.weights = cho_solve((self.factor, True), y)

    def mean(self, x: list[np.ndarray]) -> np.ndarray:
        """The mean at points, float64[n]."""
        return self._from_rows(x, self.weights)

    def missed(self) -> np.ndarray:
        """Each row minus its prediction by the others, float64[n]."""
        from scipy.linalg import cho_solve

        return self.weights / np.diag(cho_solve((self.factor, True), np.eye(len(self.y))))

    def draws(self, x: list[np.ndarray], number: int, generator: np.random.Generator) -> np.ndarray:
        """Functions that the rows allow, at points, float64[n, number]: draws from the posterior, without c.

        Each is the mean plus a draw from the prior, a sum of waves, that is corrected at the rows. A finite number of waves
        varies too little between the rows: the deviations from the mean are scaled to the variance of the posterior.
        """
        from scipy.linalg import cho_solve

        waves = self._waves(generator)
        heights = [generator.standard_normal((WAVES, number)) for _ in waves]

        def prior(points: list[np.ndarray]) -> np.ndarray:
            total = np.zeros((len(points[0]), number))
            for (variance, which, directions, phases), height in zip(waves, heights, strict=True):
                angle = np.hstack([points[i] for i in which]) @ directions + phases
                total += np.sqrt(2.0 * variance / WAVES) * np.cos(angle) @ height
            return total

        noise = np.sqrt(self.numbers.c) * generator.standard_normal((len(self.y), number))
        weights = cho_solve((self.factor, True), -prior(self.x) - noise)
        blocks = [[each[first : first + BLOCK] for each in x] for first in range(0, len(x[0]), BLOCK)]
        off = np.vstack([prior(block) + self._from_rows(block, weights) for block in blocks])
        some = np.linspace(0, len(off) - 1, min(len(off), CHECKED)).astype(int)
        scale = np.sqrt(self.variance([each[some] for each in x]).mean() / np.mean(off[some] ** 2))
        return self.mean(x)[:, None] + scale * off

    def variance(self, x: list[np.ndarray]) -> np.ndarray:
        """The variance of the functions that the rows allow, at points, float64[n]."""
        from scipy.linalg import solve_triangular

        known = solve_triangular(self.factor, covariance(squares(self.x, x), self.numbers), lower=True)
        return np.maximum(self.numbers.a.sum() + self.numbers.b - np.sum(known**2, axis=0), 0.0)

    def _from_rows(self, x: list[np.ndarray], weights: np.ndarray) -> np.ndarray:
        return covariance(squares(x, self.x), self.numbers) @ weights

    def _waves(self, generator: np.random.Generator) -> list[tuple[float, list[int], np.ndarray, np.ndarray]]:
        """Variance, inputs, wave vectors and phases of each term: vectors of Student's t with 2 nu degrees of freedom.

        They follow Sobol's sequence, so that the few short waves, of which the uncertainty between rows consists, are there.
        """
        from scipy.special import chdtri, ndtri
        from scipy.stats import qmc

        numbers, every = self.numbers, list(range(len(self.x)))
        terms = [(a, [i], np.full(self.x[i].shape[1], s)) for i, (a, s) in enumerate(zip(numbers.a, numbers.s, strict=True))]
        lengths = [np.full(self.x[i].shape[1], numbers.lengths[i]) for i in every]
        waves = []
        for variance, which, scale in [*terms, (numbers.b, every, np.concatenate(lengths))]:
            cube = qmc.Sobol(len(scale) + 1, scramble=True, seed=generator).random(WAVES).T
            cube = np.clip(cube, CLOSEST, 1.0 - CLOSEST)
            directions = ndtri(cube[1:]) * np.sqrt(FREEDOM / chdtri(FREEDOM, cube[0])) / scale[:, None]
            waves.append((variance, which, directions, generator.uniform(0.0, 2.0 * np.pi, WAVES)))
        return waves
