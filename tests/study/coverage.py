"""How often the 90 % intervals of searches with a budget contain the truth: `python -m tests.study.coverage [SEARCHES] [RUNS]`.

Every outcome is made up: it is logistic in velocity, with known v50 and width. The searches begin on several intervals, with
seeds that no test uses. A search ends as `hydro2d transition` ends it: with its budget, or after two rounds of one outcome.

`python -m tests.study.coverage plates [SEARCHES] [RUNS]` does the same for ballistic limits. Behind a made-up plate a shot has
the residual velocity of Lambert and Jonas for a limit of its own, and a scatter on top of it.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pandas

from hydro2d.penetration import lambert_jonas
from hydro2d.study.ensemble import chance
from hydro2d.study.search import ballistic, logit, sequence

#: the first seed; tests use those from 0 on
FIRST = 500_000
#: shots of a round
ROUND = 4


class Transition(NamedTuple):
    """A made-up transition and the interval in which it is searched, m/s."""

    v50: float
    width: float
    ends: tuple[float, float]


#: narrow, usual and wide changes of the outcome; short and long intervals; a transition near an end
TRANSITIONS = (
    Transition(1210.0, 15.0, (900.0, 1500.0)),
    Transition(1210.0, 60.0, (900.0, 1500.0)),
    Transition(1210.0, 200.0, (900.0, 1500.0)),
    Transition(1210.0, 60.0, (1150.0, 1300.0)),
    Transition(1210.0, 60.0, (600.0, 2400.0)),
    Transition(935.0, 60.0, (900.0, 1500.0)),
)


class Held(NamedTuple):
    """Number of searches for one transition that give an estimate, and of those whose intervals contain v50 and the width."""

    told: int
    v50: int
    width: int


def searched(true: Transition, seed: int, runs: int = 40) -> tuple[list[float], list[bool]]:
    """A search for a made-up transition: velocities in m/s and outcomes of its shots."""
    rng = np.random.default_rng(seed)
    speeds, outcomes = [], []
    while len(speeds) < runs and not (len(speeds) % ROUND == 0 and sequence.alike(outcomes, ROUND)):
        speeds.append(sequence.next_speed(speeds, outcomes, true.ends, ROUND, seed))
        fast = 1.0 / (1.0 + math.exp(-(speeds[-1] - true.v50) * logit.WIDTHS / true.width))
        outcomes.append(bool(rng.random() < fast))
    return speeds, outcomes


class Plate(NamedTuple):
    """A made-up plate and the interval in which its limit is searched, m/s.

    scatter, noise : standard deviations of the limits of single shots, and of the residual velocity about the curve;
    a, p : of Lambert and Jonas
    """

    limit: float
    scatter: float
    noise: float
    a: float
    p: float
    ends: tuple[float, float]


#: limits that hardly scatter and that do; residual velocities that scatter; thin and thick plates; a limit near an end
PLATES = (
    Plate(331.0, 3.0, 0.0, 0.9, 2.3, (300.0, 700.0)),
    Plate(331.0, 3.0, 5.0, 0.9, 2.3, (300.0, 700.0)),
    Plate(331.0, 0.5, 0.0, 0.7, 2.0, (200.0, 500.0)),
    Plate(331.0, 15.0, 3.0, 0.8, 2.5, (200.0, 700.0)),
    Plate(900.0, 5.0, 10.0, 1.0, 3.0, (600.0, 1500.0)),
    Plate(331.0, 3.0, 3.0, 0.95, 1.8, (320.0, 420.0)),
)


def perforated(true: Plate, seed: int, runs: int = 12) -> tuple[list[float], list[float]]:
    """A search for the limit of a made-up plate: impact and residual velocities of its shots in m/s."""
    rng = np.random.default_rng(seed)
    speeds, left = [], []
    while len(speeds) < runs and not (len(speeds) % ROUND == 0 and sequence.alike([each > 0.0 for each in left], ROUND)):
        outcomes = [each > 0.0 for each in left]
        speeds.append(sequence.next_speed(speeds, outcomes, true.ends, ROUND, seed, left))
        own = true.limit + true.scatter * rng.normal()
        behind = lambert_jonas.residual_velocity(speeds[-1], limit_velocity=own, a=true.a, p=true.p)
        noisy = min(max(behind + true.noise * rng.normal(), 0.1), 0.999 * speeds[-1])
        left.append(noisy if behind > 0.0 else 0.0)
    return speeds, left


def measure_limits(searches: int, runs: int) -> tuple[int, int]:
    """Makes so many searches for the limit of each plate, prints how often intervals hold; counts of estimates and of these."""
    print(" limit scatter noise    a    p  interval     told  held  median size of the interval, root mean square error, m/s")
    told = held = 0
    for number, true in enumerate(PLATES):
        first = FIRST + number * searches
        shots = [pandas.DataFrame(zip(*perforated(true, seed, runs), strict=True)) for seed in range(first, first + searches)]
        found = [limit for each in shots if (limit := ballistic.of_shots(each[0], each[1])[0])]
        hits = sum(within(true.limit, each.low, each.high) for each in found)
        told, held = told + len(found), held + hits
        size, error = _median([each.high - each.low for each in found]), [each.limit_velocity - true.limit for each in found]
        columns = zip((true.limit, true.scatter, true.noise, true.a, true.p), (6, 7, 5, 4, 4), strict=True)
        print(*(f"{value:{width}g}" for value, width in columns), f" {true.ends[0]:4g} to {true.ends[1]:4g} {len(found):5} "
              f"{hits:5}  {size:.2f}, {math.sqrt(np.mean(np.square(error))):.2f}", flush=True)
    print(f"{runs} runs: the 90 % interval holds the limit in {chance.wilson(held, told).words}")
    return told, held


def within(value: float, low: float | None, high: float | None) -> bool:
    """Whether an interval contains a value; an end that is None is open."""
    return (low is None or low <= value) and (high is None or value <= high)


def measure(searches: int, runs: int) -> list[Held]:
    """Makes so many searches for each transition with so many runs, prints how often the intervals hold, and returns it."""
    print(f"{'v50':>6} {'width':>6}  {'interval':<12} {'told':>5} {'v50 held':>9} {'width held':>11}  "
          "median size of the interval of v50 and median estimate of the width, both over the width")
    counts = []
    for number, true in enumerate(TRANSITIONS):
        first = FIRST + number * searches
        fits = [logit.fit_transition(*searched(true, seed, runs)) for seed in range(first, first + searches)]
        estimates = [each for each in fits if each is not None]
        counts.append(Held(len(estimates), sum(within(true.v50, each.v50_low, each.v50_high) for each in estimates),
                           sum(within(true.width, each.width_low, each.width_high) for each in estimates)))
        size = _median([_size(each.v50_low, each.v50_high) for each in estimates]) / true.width
        estimate = _median([each.width for each in estimates]) / true.width
        print(f"{true.v50:6g} {true.width:6g}  {true.ends[0]:4g} to {true.ends[1]:4g} {counts[-1].told:5} {counts[-1].v50:9} "
              f"{counts[-1].width:11}  {size:.2f}, {estimate:.2f}", flush=True)
    estimated = sum(each.told for each in counts)
    for what, number in (("v50", sum(each.v50 for each in counts)), ("width", sum(each.width for each in counts))):
        share = chance.wilson(number, estimated)
        print(f"{runs} runs: the 90 % interval of {what} holds it in {100 * share.fraction:.1f} %: {share.words}")
    return counts


def _size(low: float | None, high: float | None) -> float:
    return math.inf if low is None or high is None else high - low


def _median(values: Sequence[float]) -> float:
    return float(np.median(values)) if values else math.nan


if __name__ == "__main__":
    if sys.argv[1:2] == ["plates"]:
        measure_limits(*map(int, sys.argv[2:] or (100, 12)))
    else:
        measure(*map(int, sys.argv[1:] or (200, 40)))
