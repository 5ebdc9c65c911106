"""The sequential choice of velocities for an outcome that is partly chance.

The first round spreads its shots evenly from end to end of the interval. While the outcomes do not overlap, a round spreads
its shots over the gap between them and half its width beyond it on either side, so that an overlap can show. From then on a
shot goes to the velocity at which it adds most to the information on v50 and width together: where the determinant of
their information matrix becomes largest, at the estimate from all shots of earlier rounds (D-optimal design). For the last
shot of a round the width is the geometric mean of the estimate and of the largest that the shots allow, since otherwise a
width that is too small by chance would persist. Without a change of outcomes, a round goes into the widest gap.

Shots at the best velocity would nearly all be repeats of two velocities. Each is therefore moved a little from it, at random:
if the outcome depends on the velocity irregularly, shots then sample that irregularity, which repeats would not.

If the outcome is perforation, and one shot was stopped and another one went through, the residual velocities say more than the
outcomes (`ballistic`). From then on the shots of a round go to quantiles of the limits of single shots, most of them a little
above the ballistic limit, where a residual velocity measures it best; no velocity is used twice.

The shots of a round are chosen one after another without waiting for outcomes, so that they can run at the same time. Which
velocities are chosen depends on the outcomes of earlier rounds alone, not on which run of a round ends first.

Source: Neyer, A D-optimality-based sensitivity test, Technometrics 36 (1994) 61. The rounds are our own design: Neyer's test
has one shot at a time, and needs a guess of the width while the outcomes do not overlap.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from hydro2d.study.search import ballistic, logit

#: share of its width by which a gap is widened at both ends, so that shots can show an overlap
WIDER = 0.5
#: largest distance of a shot from the best velocity, relative to s of the fit
SCATTER = 0.3
#: number of candidate velocities in the interval
CANDIDATES = 1001
#: quantiles of the limits of single shots for the first and for the last shot of a round
QUANTILES = (0.4, 0.97)
#: velocities that differ by less, relative to the interval, are the same
SAME = 1e-5


def begin_of_round(number: int, size: int) -> int:
    """The number of the first shot in the round of a shot; shots are counted from 0."""
    return number // size * size


def next_speed(speeds: Sequence[float], outcomes: Sequence[bool | None], ends: tuple[float, float], size: int,
               seed: int = 0, residuals: Sequence[float | None] | None = None) -> float:
    """The velocity of the next shot, m/s.

    speeds, outcomes : of all shots so far, None for those without a known outcome; outcomes of the round under way are not used
    ends : slowest and fastest velocity;  size : shots of a round;  seed : of the random part of the choice
    residuals : of a search for a ballistic limit, residual velocities in m/s, 0 for a stopped shot, None if not known
    """
    begin = begin_of_round(len(speeds), size)
    place = len(speeds) - begin
    if begin == 0:
        return float(np.linspace(*ends, size)[place])
    if residuals is None:
        return _by_outcomes(speeds, outcomes, ends, begin, size, seed)
    known = [(speed, left) for speed, left in zip(speeds[:begin], residuals, strict=False) if left is not None]
    limit = ballistic.fit(*zip(*known, strict=True)) if any(left == 0.0 for _, left in known) else None
    if limit is None:
        return _unused(_by_outcomes(speeds, outcomes, ends, begin, size, seed), speeds, ends)
    return _unused(float(np.quantile(limit.limits, np.linspace(*QUANTILES, size)[place])), speeds, ends)


def _unused(speed: float, speeds: Sequence[float], ends: tuple[float, float]) -> float:
    """The velocity in the interval nearest to one; if there was a shot at it, another one that is at least a step away."""
    speed, span, before = float(np.clip(speed, *ends)), ends[1] - ends[0], np.array(speeds)
    if np.abs(before - speed).min() > SAME * span:
        return speed
    step = span / max(CANDIDATES, 4 * len(before))
    others = np.clip(np.concatenate([before - step, before + step]), *ends)
    free = others[np.abs(others[:, None] - before).min(axis=1) > 0.5 * step]
    return float(free[np.argmin(np.abs(free - speed))])


def _by_outcomes(speeds: Sequence[float], outcomes: Sequence[bool | None], ends: tuple[float, float], begin: int, size: int,
                 seed: int) -> float:
    """The velocity of the next shot by the outcomes of the shots before `begin`, arguments as for `next_speed`."""
    place = len(speeds) - begin
    before = [(speed, outcome) for speed, outcome in zip(speeds[:begin], outcomes, strict=False) if outcome is not None]
    fitted = logit.fit_transition(*zip(*before, strict=True)) if before else None
    if fitted is not None and fitted.overlap:
        scale = fitted.scale if place < size - 1 else _wide(fitted, ends)
        best = _most_telling(fitted.v50, scale, np.array(speeds), np.linspace(*ends, CANDIDATES))
        beside = SCATTER * scale * np.random.default_rng([seed, len(speeds)]).uniform(-1.0, 1.0)
        return float(np.clip(best + beside, *ends))
    low, high = _gap(before, ends, speeds[:begin])
    share = (1.0 + 2.0 * WIDER) * (place + 1) / (size + 1) - WIDER
    return float(np.clip(low + (high - low) * share, *ends))


def _gap(before: Sequence[tuple[float, bool]], ends: tuple[float, float], speeds: Sequence[float]) -> tuple[float, float]:
    """The velocities between which the outcome changes; without a change, the middle half of the widest gap between shots."""
    fast = [speed for speed, outcome in before if outcome]
    slow = [speed for speed, outcome in before if not outcome]
    if slow and fast and max(slow) < min(fast):
        return max(slow), min(fast)
    low, high = max(pairwise(sorted({*ends, *speeds})), key=lambda gap: gap[1] - gap[0])
    return low + WIDER * (high - low) / (1.0 + 2.0 * WIDER), high - WIDER * (high - low) / (1.0 + 2.0 * WIDER)


def _wide(fitted: logit.Fit, ends: tuple[float, float]) -> float:
    """A scale between the estimate and the largest of the 90 % region, or that of the whole interval, m/s."""
    return math.sqrt(fitted.scale * min(fitted.region[:, 1].max(), (ends[1] - ends[0]) / logit.WIDTHS))


def _most_telling(v50: float, scale: float, speeds: np.ndarray, candidates: np.ndarray) -> float:
    """The candidate that, with the shots so far, makes the determinant of the information matrix largest."""
    together = np.column_stack([np.tile(speeds, (len(candidates), 1)), candidates])
    values = logit.information((together - v50) / scale, together)
    return float(candidates[np.argmax(values)])


def alike(outcomes: Sequence[bool | None], size: int) -> bool:
    """Whether two rounds have given one outcome only, so that the transition lies outside the interval."""
    return len(outcomes) >= 2 * size and len({outcome for outcome in outcomes if outcome is not None}) < 2
