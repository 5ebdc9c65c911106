"""Bisection for the velocities at which a rod's regime changes, any number of runs at a time. It knows no files and no runs.

Regimes are ordered: rigid, deforming, eroding; or, for a ballistic limit, stopped, perforated. A transition to a regime lies
between the slowest run that has reached it and the fastest run below that which has not. All transitions use all runs. Where
runs are under way inside a bracket, the next goes into the middle of the widest gap that they leave: with three at a time a
bracket is quartered.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from hydro2d.output.history import GROWING

#: failed runs after which a search gives up
MOST_FAILED = 4


def bracket(found: Mapping[float, str], regime: str, order: Sequence[str] = GROWING) -> tuple[float | None, float | None]:
    """Velocities between which a regime is reached: the fastest below it and the slowest in it; None is an open end.

    found : regimes by velocity, or by anything that grows with it;  order : all of them
    """
    reached = {speed: order.index(each) >= order.index(regime) for speed, each in found.items()}
    high = min((speed for speed, yes in reached.items() if yes), default=None)
    low = max((speed for speed, yes in reached.items() if not yes and (high is None or speed < high)), default=None)
    return low, high


def disordered(found: Mapping[float, str], order: Sequence[str] = GROWING) -> list[tuple[float, float]]:
    """Pairs (slower, faster) of runs next to one another of which the faster has the lower regime."""
    speeds = sorted(found)
    return [(slow, fast) for slow, fast in pairwise(speeds) if order.index(found[fast]) < order.index(found[slow])]


@dataclass
class Search:
    """One search on positions 0 to count - 1, the velocities in their order.

    order : regimes as they grow with the velocity;  found : regimes by position;  failed : positions without one
    begun : those that a restart file would spare work
    """

    count: int
    found: dict[int, str] = field(default_factory=dict)
    failed: set[int] = field(default_factory=set)
    begun: set[int] = field(default_factory=set)
    order: Sequence[str] = GROWING

    def next(self, busy: Collection[int] = ()) -> int | None:
        """The position to run next while those of `busy` are run; None where nothing is left to find out."""
        if len(self.failed) >= MOST_FAILED:
            return None
        taken = {*busy, *self.failed}
        for end in (0, self.count - 1):
            if end not in self.found and end not in taken:
                return end
        options = [option for regime in self.order[1:] if (option := self._inside(regime, taken))]
        return min(options)[-1] if options else None

    def _inside(self, regime: str, taken: set[int]) -> tuple[int, int, int] | None:
        """A position in the bracket of a regime, behind what makes it less wanted: runs under way there, a narrow gap."""
        low, high = bracket(self.found, regime, self.order)
        first, last = 0 if low is None else low, self.count - 1 if high is None else high
        within = {position for position in taken if first < position < last}
        slow, fast = max(pairwise(sorted({first, *within, last})), key=lambda gap: gap[1] - gap[0], default=(first, first))
        if fast - slow < 2:
            return None
        begun = sorted(position for position in self.begun - taken - set(self.found) if first < position < last)
        return len(within - self.failed), slow - fast, begun[0] if begun else (slow + fast) // 2

    def further(self) -> int:
        """About how many runs are still to come after those that are under way."""
        ends = len({0, self.count - 1} - set(self.found) - self.failed)
        gaps = []
        for regime in self.order[1:]:
            low, high = bracket(self.found, regime, self.order)
            gaps.append((self.count - 1 if high is None else high) - (0 if low is None else low))
        return ends + sum((gap - 1).bit_length() for gap in gaps if gap > 1) if self.next() is not None else 0
