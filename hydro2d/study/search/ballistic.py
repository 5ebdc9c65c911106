"""The ballistic limit from the residual velocities of shots that differ by chance.

A shot at velocity V that goes through has the residual velocity of Lambert and Jonas,

    v_r = a (V^p - l^p)^(1/p)                                                                               (1)

with a limit l of its own: l is normally distributed about the ballistic limit L with the standard deviation s, and v_r about
(1) with s as well. So a shot that goes through measures L, as l = (V^p - (v_r/a)^p)^(1/p), and the more exactly the slower it
is behind the plate. A shot that is stopped says that its l is above V. With g = dl/dv_r the log likelihood of the shots is

    sum over perforations of  ln g - ln(s w) - (l - L)^2 / (2 s^2 w^2),  w^2 = 1 + g^2
    + sum over stopped shots of  ln Phi((L - V) / s)                                                        (2)

The estimates are medians of the posterior distribution of L, s, a and p. The 90 % interval has 4 % of it on either side: since
earlier shots have chosen the velocities, the one with 5 % contained the true limit in 89 % of 600 made-up searches. The
priors are flat in L, ln s and a, and normal in ln p. The distribution is sampled by walkers that move along lines through one
another, always with the same random numbers; all walkers move at once, so that it takes a fraction of a second.

Sources: Lambert and Jonas, BRL-R-1852 (1976), for (1); Goodman and Weare, Ensemble samplers with affine invariance, Comm. App.
Math. Comp. Sci. 5 (2010) 65, for the walkers. (2) and the priors are our own.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.analytic.catalogue import lambert_jonas
from hydro2d.study.outcomes.perforation import PERFORATED, STOPPED

if TYPE_CHECKING:
    import pandas

#: ends of the 90 % interval, shares of the posterior distribution
TAILS = (0.04, 0.96)
#: perforations at different velocities that an estimate needs: as many as (1) has constants
LEAST = 3
#: smallest and largest s, relative to the fastest shot; median and standard deviation of ln p, and its ends
SCATTERS, EXPONENT, EXPONENTS = (1e-3, 0.15), (math.log(2.2), 0.4), (0.0, math.log(20.0))
#: largest limit, relative to the fastest shot
BEYOND = 1.5
#: walkers, their steps, those that are left out at the beginning, and the largest stretch of a line
WALKERS, STEPS, FIRST, STRETCH = 80, 500, 200, 2.0


@dataclass(frozen=True)
class Limit:
    """The ballistic limit from a number of shots, velocities in m/s.

    limit_velocity, low, high : estimate, and ends of its 90 % interval
    scatter : standard deviation of the limits of single shots;  a, p : constants of (1)
    limits : limits of single shots, a sample of their distribution, shape (n,)
    perforated : number of shots that went through
    """

    limit_velocity: float
    low: float
    high: float
    scatter: float
    a: float
    p: float
    limits: np.ndarray
    perforated: int

    @property
    def in_words(self) -> str:
        """The limit with its interval."""
        return f"{self.limit_velocity:.1f} m/s, 90 % interval {self.low:.1f} to {self.high:.1f} m/s"

    @property
    def origin(self) -> str:
        """Where it comes from."""
        return (f"from {self.perforated} residual velocities by Lambert-Jonas, a = {self.a:.2f}, p = {self.p:.2g}; limits of "
                f"single shots scatter by {self.scatter:.2g} m/s")

    def residual(self, speeds: Sequence[float]) -> np.ndarray:
        """Residual velocities (1) at impact velocities, both in m/s."""
        constants = {"limit_velocity": self.limit_velocity, "a": self.a, "p": self.p}
        return np.array([lambert_jonas.residual_velocity(speed, **constants) for speed in speeds])


def of_shots(velocities: pandas.Series, residuals: pandas.Series) -> tuple[Limit | None, str]:
    """The ballistic limit from impact and residual velocities in m/s, 0 if the plate held; or None, and the reason."""
    different = velocities[residuals > 0.0].nunique()
    if not (residuals == 0.0).any():
        return None, "no shot was stopped"
    if different < LEAST:
        return None, f"a fit needs perforations at {LEAST} velocities, and there are {different}"
    return fit(velocities, residuals), ""


def residuals(shots: pandas.DataFrame) -> pandas.Series:
    """The residual velocities of the shots of a search that a fit can use, m/s, by index; 0 for a stopped projectile."""
    left = shots["residual_velocity_m_s"].where(shots["regime"] == PERFORATED).astype(float)
    usable = left.where((left > 0.0) & (left < shots["velocity_m_s"].astype(float)))
    return usable.mask(shots["regime"] == STOPPED, 0.0).dropna()


def fit(velocities: Sequence[float], residuals: Sequence[float]) -> Limit | None:
    """The ballistic limit from impact and residual velocities in m/s; the residual is 0 if the plate held.

    Without a perforation it is None. With fewer than LEAST it rests on the priors, and is good enough to place a shot.
    """
    return _fitted(tuple(sorted((float(v), float(left)) for v, left in zip(velocities, residuals, strict=True))))


@functools.lru_cache(maxsize=16)
def _fitted(shots: tuple[tuple[float, float], ...]) -> Limit | None:
    """`fit` of shots in order; every shot of a round asks for the same."""
    v, left = np.array(shots).reshape(-1, 2).T
    through = left > 0.0
    if not through.any():
        return None
    limit, scatter, a, p = _posterior(v[through], left[through], v[~through])
    rng = np.random.default_rng(1)
    low, middle, high = np.quantile(limit, [TAILS[0], 0.5, TAILS[1]])
    return Limit(float(middle), float(low), float(high), *(float(np.median(each)) for each in (scatter, a, p)),
                 limits=limit + scatter * rng.normal(size=limit.size), perforated=int(through.sum()))


def _posterior(v: np.ndarray, left: np.ndarray, stopped: np.ndarray) -> np.ndarray:
    """Samples of L, s (m/s), a and p, shape (4, n), from perforations and the velocities of stopped shots."""
    rng = np.random.default_rng(0)
    top = float(np.concatenate([v, stopped]).max())
    walkers = np.column_stack([
        np.median(np.sqrt(v**2 - left**2)) * rng.uniform(0.9, 1.1, WALKERS),
        np.log(0.05 * top) + rng.uniform(-1.0, 1.0, WALKERS),
        1.0 - (1.0 - (left / v).max()) * rng.uniform(0.0, 0.9, WALKERS), EXPONENT[0] + 0.2 * rng.normal(size=WALKERS),
    ])
    height = _log_density(walkers, v, left, stopped, top)
    half, samples = WALKERS // 2, []
    for step in range(STEPS):
        for mine, others in ((slice(None, half), slice(half, None)), (slice(half, None), slice(None, half))):
            partners = walkers[others][rng.integers(half, size=half)]
            z = (1.0 + (STRETCH - 1.0) * rng.random(half)) ** 2 / STRETCH
            moved = partners + z[:, None] * (walkers[mine] - partners)
            then = _log_density(moved, v, left, stopped, top)
            accepted = np.log(rng.random(half)) < 3.0 * np.log(z) + then - height[mine]
            walkers[mine][accepted], height[mine][accepted] = moved[accepted], then[accepted]
        if step >= FIRST:
            samples.append(walkers.copy())
    limit, scatter, a, p = np.concatenate(samples).T
    return np.array([limit, np.exp(scatter), a, np.exp(p)])


def _log_density(at: np.ndarray, v: np.ndarray, left: np.ndarray, stopped: np.ndarray, top: float) -> np.ndarray:
    """The likelihood (2) and the priors at L, ln s, a, ln p, shape (n, 4); -inf where they allow none."""
    from scipy.special import log_ndtr

    limit, log_s, a, log_p = at.T[:, :, None]
    s, p = np.exp(log_s), np.exp(np.clip(log_p, *EXPONENTS))
    with np.errstate(all="ignore"):
        behind = left / a
        own = v * (-np.expm1(p * np.log(behind / v))) ** (1.0 / p)
        slope = (behind / own) ** (p - 1.0) / a
        wide = s * np.sqrt(1.0 + slope**2)
        value = (np.log(slope / wide) - 0.5 * ((own - limit) / wide) ** 2).sum(axis=1)
    value = value + log_ndtr((limit - stopped) / s).sum(axis=1) - 0.5 * ((log_p[:, 0] - EXPONENT[0]) / EXPONENT[1]) ** 2
    low, high = (math.log(share * top) for share in SCATTERS)
    ends = np.array([[0.0, low, 0.0, EXPONENTS[0]], [BEYOND * top, high, 1.0, EXPONENTS[1]]])
    inside = ((at > ends[0]) & (at <= ends[1])).all(axis=1) & np.isfinite(value)
    return np.where(inside, value, -np.inf)
