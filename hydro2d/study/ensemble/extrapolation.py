"""Means on several meshes, each with its scatter, extrapolated to cells of zero size if the sequence allows it.

Richardson's extrapolation, y = y0 + C h^p with the size h of the cells (Roache, J. Fluids Eng. 116 (1994) 405), assumes
that the difference between two meshes is an effect of the mesh. Here part of it is chance, so the means are drawn anew many
times within their errors, and only a fit that succeeds for most draws is accepted. The grid convergence index, which others
quote, takes three values as they are.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

#: orders p that a fit may have; outside them a sequence does not converge, or a few meshes cannot show it
ORDERS = np.linspace(0.5, 3.0, 251)
#: draws of the means, their seed, and the share of them that must converge
DRAWS, SEED, ENOUGH = 4000, 0, 0.9
#: smallest error of a mean in a fit, as a share of the change between meshes
EXACT = 3e-3
#: factor of safety of the grid convergence index, the order of a smooth solution, and the largest that is looked for
SAFETY, FORMAL, HIGHEST = 1.25, 2.0, 20.0
#: largest probability of chance alone at which a change between meshes is accepted; chi^2 of one degree that a fit may have
CHANCE, MISFIT = 0.1, 3.84


class Level(NamedTuple):
    """The members on one mesh: cells across the projectile, their number, their mean, and their standard deviation."""

    cells: float
    count: int
    mean: float
    scatter: float

    @property
    def error(self) -> float:
        """Standard error of the mean."""
        return self.scatter / np.sqrt(self.count)


class Limit(NamedTuple):
    """The value that a sequence of meshes gives for cells of zero size.

    value, low, high : extrapolated, with a 90 % interval, and the order of convergence; None if it cannot be extrapolated
    words : the reason
    """

    value: float | None
    low: float | None
    high: float | None
    order: float | None
    words: str


class GridConvergence(NamedTuple):
    """Order, extrapolated value and grid convergence index of three meshes, a share of the value on the finest one.

    All are None if the values do not converge; ``words`` says why, and is empty if they do. An order above 2 is told as it is,
    but the value and the index are those of the order 2.
    """

    order: float | None
    value: float | None
    index: float | None
    words: str

    def __str__(self) -> str:
        """Such as "1.2 %, order 1.4", or the reason why there is none."""
        if self.index is None or self.order is None:
            return self.words or "0 %, since the meshes have the same value"
        return f"{1e2 * self.index:.2g} %, order {self.order:.2g}" + (" (taken as 2)" if self.order > FORMAL else "")


def grid_convergence(values: Mapping[float, float]) -> GridConvergence:
    """Order of convergence, extrapolated value and grid convergence index of the three finest meshes.

    The order p solves e32/e21 = r21^p (r32^p - 1)/(r21^p - 1) with the changes e and the ratios r of cell sizes between the
    meshes 3, 2 and 1, the finest. The index is the size of 1.25 (e21/y1)/(r21^p - 1): an estimate of the error of the mesh that
    should hold for 95 % of cases (Celik and others, J. Fluids Eng. 130 (2008) 078001). No more than the order of a smooth
    solution, 2, is taken, since a larger one is chance (Oberkampf and Roy, Verification and Validation in Scientific Computing,
    2010, 8.6). Values that go up and down, or whose changes do not fall, do not converge, and have none.

    Parameters
    ----------
    values : the value by cells across the projectile, or by any number to which the size of the cells is inverse

    Raises ValueError with fewer than three meshes.
    """
    if len(values) < 3:
        raise ValueError("an order of convergence needs three meshes or more")
    meshes = sorted(values)[-3:]
    coarse, fine = (values[other] - values[one] for one, other in itertools.pairwise(meshes))
    r32, r21 = (other / one for one, other in itertools.pairwise(meshes))
    finest = values[meshes[-1]]
    if fine == 0.0:
        return GridConvergence(None, finest, 0.0, "" if coarse == 0.0 else "the two finest meshes have the same value")
    if coarse / fine <= 0.0:
        return GridConvergence(None, None, None, "up and down from mesh to mesh")

    def ratio(p: float) -> float:
        return r21**p * math.expm1(p * math.log(r32)) / math.expm1(p * math.log(r21)) - coarse / fine

    if ratio(1e-6) >= 0.0:
        return GridConvergence(None, None, None, "the change grows from mesh to mesh")
    from scipy.optimize import brentq

    order = brentq(ratio, 1e-6, HIGHEST) if ratio(HIGHEST) > 0.0 else HIGHEST
    step = fine / math.expm1(min(order, FORMAL) * math.log(r21))
    return GridConvergence(order, finest + step, abs(SAFETY * step / finest) if finest else math.inf, "")


def level(cells: float, values: Sequence[float]) -> Level:
    """The mean and scatter of the members on a mesh."""
    members = np.asarray(values, dtype=float)
    return Level(cells, len(members), float(members.mean()), float(members.std(ddof=1)) if len(members) > 1 else 0.0)


def alike(samples: Sequence[Sequence[float]]) -> float:
    """Probability that means differ as much or more by chance alone (Alexander and Govern's test, for unequal scatter)."""
    from scipy.stats import alexandergovern

    if any(np.ptp(sample) == 0.0 for sample in samples):  # a mesh without scatter: no chance there
        return 1.0 if np.ptp(np.concatenate(samples)) == 0.0 else 0.0
    return float(alexandergovern(*samples).pvalue)


def limit(levels: Sequence[Level], samples: Sequence[Sequence[float]]) -> Limit:
    """The value for cells of zero size; ``samples``: the values of the members on each mesh, at least two on each."""
    if len(levels) < 3:
        return Limit(None, None, None, None, "an order needs three meshes or more")
    chance = alike(samples)
    if chance > CHANCE:
        words = f"the meshes differ by no more than chance (p = {chance:.2f}), so that no order can be seen"
        return Limit(None, None, None, None, f"{words}; the mean of all members is {_common(samples)}")
    draws = _draws(levels)
    values, orders, good = _fitted(np.array([each.cells for each in levels]), draws, _errors(levels))
    if good.mean() < ENOUGH:
        return Limit(None, None, None, None, _refused(levels, orders, float(good.mean())))
    low, value, high = np.quantile(values[good], (0.05, 0.5, 0.95))
    order = float(np.median(orders[good]))
    return Limit(float(value), float(low), float(high), order, f"{100 * good.mean():.0f} % of the draws converge")


def _common(samples: Sequence[Sequence[float]]) -> str:
    """The mean of all members and its standard error."""
    pooled = np.concatenate(samples)
    return f"{pooled.mean():.4g} +- {pooled.std(ddof=1) / np.sqrt(len(pooled)):.2g}"


def _errors(levels: Sequence[Level]) -> np.ndarray:
    """Standard errors of the means; a little more than zero if the members hardly differ."""
    return np.maximum([each.error for each in levels], EXACT * np.ptp([each.mean for each in levels]))


def _draws(levels: Sequence[Level]) -> np.ndarray:
    """Means drawn within their errors, by Student's t with n - 1 degrees, shape (DRAWS, levels)."""
    chance = np.random.default_rng(SEED)
    drawn = np.column_stack([chance.standard_t(each.count - 1, DRAWS) for each in levels])
    return np.array([each.mean for each in levels]) + drawn * _errors(levels)


def _fitted(cells: np.ndarray, draws: np.ndarray, errors: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """For each draw y0 and p of the best fit, and whether p is within the orders and the fit is good.

    The errors of a draw are those of the means twice: in the means, and in the draw.
    """
    powers = (cells[0] / cells) ** ORDERS[:, None]
    designs = np.stack([np.ones_like(powers), powers], axis=2) / errors[:, None]
    inverses, wanted = np.linalg.pinv(designs), (draws / errors).T
    misfits = np.sum(((designs @ inverses - np.eye(len(cells))) @ wanted) ** 2, axis=1)
    best, which = np.argmin(misfits, axis=0), np.arange(len(draws))
    good = (best > 0) & (best < len(ORDERS) - 1) & (misfits[best, which] < 2.0 * MISFIT * max(len(cells) - 2, 1))
    return np.einsum("nk,kn->n", inverses[best, 0], wanted), ORDERS[best], good


def _refused(levels: Sequence[Level], orders: np.ndarray, share: float) -> str:
    """Why a sequence is not extrapolated; ``orders``: of the best fits;  share : of the draws that converge."""
    steps = np.sign(np.diff([each.mean for each in levels]))
    few = f"{100 * share:.0f} % of the draws of the means converge"
    if np.any(steps != steps[0]):
        return f"the means go up and down from mesh to mesh; {few}"
    if np.mean(orders >= ORDERS[-1]) > 0.5:
        return (f"the change falls faster than with the order {ORDERS[-1]:g}, so that the coarsest mesh does not belong to the "
                f"sequence; {few}. A finer mesh in its place may")
    return f"the change does not fall as fast as with the order {ORDERS[0]:g}, or scatter hides it; {few}"
