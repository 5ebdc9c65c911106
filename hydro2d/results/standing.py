"""Where a run stands: how far it is, what it has written, and which of its stop conditions is likely to end it, and when."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hydro2d.output import history
from hydro2d.running.progress import duration, moment, number
from hydro2d.running.run import HISTORY

#: the last rows of the history, as a share of all, from which the present deceleration is taken, and the fewest
RECENT, FEWEST = 0.25, 5
#: a speed that falls by less than this share of it in these rows is constant
ROUNDING = 1e-6


@dataclass(frozen=True)
class End:
    """What may end a run: the condition in words, and the time of the simulation, s, at which it will be met."""

    reason: str
    time: float


def lines(run, status: str, message: str, progress: dict) -> list[str]:
    """What there is to say of a run (results.Results), one line for each thing.

    status, message, progress : of its directory, as study.layout.Case has them

    Raises HistoryError, VtkError.
    """
    columns = run.history if (run.directory / HISTORY).exists() else {}
    summary = {} if progress else run.summary  # that of a run that is being continued is out of date
    now = _last(columns) | {name: value for name, value in (summary or progress).items() if value is not None}
    said = {"run": run.tables.get("title") or run.label, "state": status + (f": {message}" if message else "")}
    if summary:
        said["state"] = f"{status}: {summary.get('stop_reason') or message}"
    if now.get("time_s") is not None:
        said["time"] = f"{moment(now['time_s'])}, cycle {int(now.get('cycles', 0))}"
        if now.get("wall_s") is not None:
            said["time"] += f", {duration(now['wall_s'])} of computing"
    if not summary:
        said["end"] = _end(run.tables.get("stop", {}), columns, now, progress)
    if now.get("penetration_depth_m") is not None:
        said["depth"] = number(now["penetration_depth_m"], 1e3, ".2f", "mm")
        if run.measured_depth is not None:
            said["depth"] += f", in the experiment {number(run.measured_depth, 1e3, '.2f', 'mm')}"
    if now.get("regime"):
        said["rod"] = f"{now['regime']}, {number(now.get('rod_length_m'), 1e3, '.2f', 'mm')} long"
    dumps = run.dumps
    said["dumps"] = f"{len(dumps)}, the last at {moment(dumps[-1][0])}" if dumps else "none"
    return [f"{name:<7} {text}" for name, text in said.items()]


def _last(columns: dict[str, np.ndarray]) -> dict:
    """The last row of the history by the names that summary.json has."""
    if not columns or not len(columns["time"]):
        return {}
    row = {name: values[-1].item() for name, values in columns.items()}
    regime = row.pop("regime", -1)
    found = {"time_s": row["time"], "cycles": row.get("cycle", 0), "regime": history.REGIMES[regime] if regime >= 0 else None}
    return found | {name: row[name] for name in ("penetration_depth_m", "rod_length_m") if np.isfinite(row.get(name, np.nan))}


def _end(stop: dict, columns: dict[str, np.ndarray], now: dict, progress: dict) -> str:
    """The condition that is likely to end a run, and how long that will take at the present pace."""
    found = sorted(ends(stop, columns), key=lambda each: each.time)
    if not found:
        return "not known: no stop condition can be foreseen"
    first, time = found[0], now.get("time_s", 0.0)
    share, left = progress.get("fraction"), progress.get("left_s")
    said = f"{first.reason}, at {moment(first.time)}"
    if share and left is not None and 0.0 < time <= first.time:  # left_s is the rest of the time that `fraction` is a share of
        said += f", in about {duration(left * share / (1.0 - share) * (first.time - time) / time)}" if share < 1.0 else ""
    return said + (", unless the rod goes through before" if stop.get("perforation") else "")


def ends(stop: dict, columns: dict[str, np.ndarray]) -> Iterator[End]:
    """The stop conditions whose time can be foreseen: end time, number of cycles, and speeds by the present deceleration.

    stop : the section of the resolved deck;  columns : of the history, which may be empty
    """
    if stop.get("time") is not None:
        yield End("end time", stop["time"])
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
            yield from _reached(f"{reason} as it slows now", time, -np.abs(speed[-rows:]), -(slow or 0.0))


def _reached(reason: str, time: np.ndarray, values: np.ndarray, limit: float) -> Iterator[End]:
    """When values that rise in time reach a limit, by a straight line through them; nothing if they do not rise."""
    known = np.isfinite(values)
    if known.sum() < FEWEST:
        return
    slope, start = np.polyfit(time[known] - time[-1], values[known], 1)
    if slope * np.ptp(time) > ROUNDING * np.max(np.abs(values[known])):
        yield End(reason, time[-1] + max((limit - start) / slope, 0.0))
