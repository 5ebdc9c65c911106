"""Predicts which of its stop conditions will end a run, and when."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

#: share of the history's rows, the last ones, that give the present deceleration, and the smallest number of them
RECENT, FEWEST = 0.25, 5
#: a speed that falls by less than this share in these rows counts as constant
ROUNDING = 1e-6
#: the end that is known, not predicted
END_TIME = "end time"
#: addition to a reason whose time is predicted from the deceleration
AS_IT_SLOWS = "at its present deceleration"


@dataclass(frozen=True)
class End:
    """A possible end of a run: the condition in words, and the simulation time, s, at which it will be met."""

    reason: str
    time: float


def ends(stop: Mapping, columns: Mapping[str, np.ndarray]) -> Iterator[End]:
    """Stop conditions whose time can be predicted: end time, number of cycles, and speeds by the present deceleration.

    stop : the section of the resolved deck;  columns : of the history, which may be empty, `needed` at least
    """
    if stop.get("time") is not None:
        yield End(END_TIME, stop["time"])
    rows = max(FEWEST, int(RECENT * len(columns.get("time", ()))))
    if len(columns.get("time", ())) < FEWEST:
        return
    time = columns["time"][-rows:]
    if stop.get("cycles") is not None:
        yield from _reached(f"{stop['cycles']} cycles", time, columns["cycle"][-rows:].astype(float), stop["cycles"])
    slow, body = stop.get("speed_below"), stop.get("body")
    if slow is not None or stop.get("rebound"):
        speed = columns.get("rod_core_velocity_m_s", columns.get(f"body_{body}_velocity_m_s"))
        reason = "rebound" if slow is None else f"speed below {slow:g} m/s"
        if speed is not None:
            yield from _reached(f"{reason} {AS_IT_SLOWS}", time, -np.abs(speed[-rows:]), -(slow or 0.0))


def needed(stop: Mapping) -> tuple[str, ...]:
    """The columns of the history that `ends` uses."""
    return "time", "cycle", "rod_core_velocity_m_s", f"body_{stop.get('body')}_velocity_m_s"


def first(stop: Mapping, columns: Mapping[str, np.ndarray]) -> End | None:
    """The earliest predicted end; None if none can be predicted."""
    return min(ends(stop, columns), key=lambda each: each.time, default=None)


def _reached(reason: str, time: np.ndarray, values: np.ndarray, limit: float) -> Iterator[End]:
    """Yields the end at which rising values reach a limit, by a straight line through them; nothing if they do not rise."""
    known = np.isfinite(values)
    if known.sum() < FEWEST:
        return
    slope, start = np.polyfit(time[known] - time[-1], values[known], 1)
    if slope * np.ptp(time) > ROUNDING * np.max(np.abs(values[known])):
        yield End(reason, time[-1] + max((limit - start) / slope, 0.0))
