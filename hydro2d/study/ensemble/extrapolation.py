"""Means on several meshes, each with its scatter, extrapolated to cells of zero size if the sequence allows it.

Richardson's extrapolation, y = y0 + C h^p with the size h of the cells (Roache, J. Fluids Eng. 116 (1994) 405), assumes
that the difference between two meshes is an effect of the mesh. Here part of it is chance, so the means are drawn anew many
times within their errors, and only a fit that succeeds for most draws is accepted.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

#: orders p that a fit may have; outside them a sequence does not converge, or a few meshes cannot show it
ORDERS = np.linspace(0.5, 3.0, 251)
#: draws of the means, their seed, and the share of them that must converge
DRAWS, SEED, ENOUGH = 4000, 0, 0.9
#: smallest error of a mean in a fit, as a share of the change between meshes
EXACT = 3e-3
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
