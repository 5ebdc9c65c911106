"""Bisection for the velocities at which the regime of a rod changes, with any number of runs at a time; uses no files.

Regimes are ordered: rigid, deforming, eroding; for the loss of length kept, used up; for a ballistic limit stopped, perforated.
The transition to a regime lies between the slowest run that has reached it and the fastest slower run that has not. All
transitions use all runs. If runs are under way inside a bracket, the next one is placed in the middle of the widest gap between
them, so three at a time quarter a bracket.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from hydro2d.measure.regime import GROWING

#: failed runs after which a search gives up
MOST_FAILED = 4


def bracket(regimes: Mapping[float, str], regime: str, order: Sequence[str] = GROWING) -> tuple[float | None, float | None]:
    """Velocities between which a regime is reached: the fastest run below it and the slowest run in it; None is an open end.

    regimes : by velocity, or by anything that grows with it;  order : all regimes in order
    """
    reached = {speed: order.index(each) >= order.index(regime) for speed, each in regimes.items()}
    high = min((speed for speed, yes in reached.items() if yes), default=None)
    low = max((speed for speed, yes in reached.items() if not yes and (high is None or speed < high)), default=None)
    return low, high


def disordered(regimes: Mapping[float, str], order: Sequence[str] = GROWING) -> list[tuple[float, float]]:
    """Pairs (slower, faster) of neighbouring runs in which the faster one has the lower regime."""
    speeds = sorted(regimes)
    return [(slow, fast) for slow, fast in pairwise(speeds) if order.index(regimes[fast]) < order.index(regimes[slow])]


@dataclass
class Search:
    """One search on positions 0 to count - 1, the velocities in their order.

    order : regimes in the order of velocity;  found : regimes by position;  failed : positions without a regime
    begun : positions with a restart file to continue from
    """

    count: int
    found: dict[int, str] = field(default_factory=dict)
    failed: set[int] = field(default_factory=set)
    begun: set[int] = field(default_factory=set)
    order: Sequence[str] = GROWING

    def next(self, busy: Collection[int] = ()) -> int | None:
        """The position to run next while those in `busy` are running; None if no further run is useful."""
        if len(self.failed) >= MOST_FAILED:
            return None
        excluded = {*busy, *self.failed}
        for end in (0, self.count - 1):
            if end not in self.found and end not in excluded:
                return end
        options = [option for regime in self.order[1:] if (option := self._inside(regime, excluded))]
        return min(options)[-1] if options else None

    def _inside(self, regime: str, excluded: set[int]) -> tuple[int, int, int] | None:
        """A position in the bracket of a regime, after its rank: number of runs under way there, then width of the gap."""
        low, high = bracket(self.found, regime, self.order)
        first, last = 0 if low is None else low, self.count - 1 if high is None else high
        within = {position for position in excluded if first < position < last}
        slow, fast = max(pairwise(sorted({first, *within, last})), key=lambda gap: gap[1] - gap[0], default=(first, first))
        if fast - slow < 2:
            return None
        begun = sorted(position for position in self.begun - excluded - set(self.found) if first < position < last)
        return len(within - self.failed), slow - fast, begun[0] if begun else (slow + fast) // 2

    def further(self) -> int:
        """Approximate number of runs still to come after those under way."""
        ends = len({0, self.count - 1} - set(self.found) - self.failed)
        gaps = []
        for regime in self.order[1:]:
            low, high = bracket(self.found, regime, self.order)
            gaps.append((self.count - 1 if high is None else high) - (0 if low is None else low))
        return ends + sum((gap - 1).bit_length() for gap in gaps if gap > 1) if self.next() is not None else 0
