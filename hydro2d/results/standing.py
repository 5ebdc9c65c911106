"""How far a run has got, what it has written, and when and why it is likely to stop."""

from __future__ import annotations

import numpy as np

from hydro2d.base.terminal import duration, moment, number
from hydro2d.measure import outcome
from hydro2d.measure.regime import REGIMES
from hydro2d.measure.summary import Summary
from hydro2d.output import ending
from hydro2d.output.directory import HISTORY


def lines(run, status: str, message: str, progress: dict) -> list[str]:
    """The state of a run (results.Results), a line for each item.

    status, message, progress : of its directory, as in study.records.study_directory.Case

    Raises HistoryError, VtkError.
    """
    columns = run.history if (run.directory / HISTORY).exists() else {}
    summary = Summary() if progress else run.summary  # the summary of a run that is being continued is out of date
    now = _last(columns) | {name: value for name, value in dict(summary or progress).items() if value is not None}
    said = {"run": run.tables.get("title") or run.label, "state": status + (f": {message}" if message else "")}
    if summary:
        said["state"] = f"{status}: {outcome.ended_by(summary) or message}"
    if now.get("time_s") is not None:
        said["time"] = f"{moment(now['time_s'])}, cycle {int(now.get('cycles', 0))}"
        if now.get("wall_s") is not None:
            said["time"] += f", {duration(now['wall_s'])} of computing"
    if not summary:
        said["end"] = _end(run.stop, columns, now, progress, run.projectile)
    depth = now.get("penetration_depth_m")
    if depth is not None and summary.targets and summary.outcome and summary.outcome.perforated:
        said["through"] = outcome.beyond(summary.targets, number(now.get("nose_depth_m", depth), 1e3, ".2f", "mm"))
    elif depth is not None:
        said["depth"] = number(depth, 1e3, ".2f", "mm") + " so far" * outcome.so_far(summary)
        if run.measured_depth is not None:
            said["depth"] += f", in the experiment {number(run.measured_depth, 1e3, '.2f', 'mm')}"
    if now.get("regime"):
        said[run.projectile] = f"{now['regime']}, {number(now.get('rod_length_m'), 1e3, '.2f', 'mm')} long"
    dumps = run.dumps
    said["dumps"] = f"{len(dumps)}, the last at {moment(dumps[-1][0])}" if dumps else "none"
    width = max(map(len, said))
    return [f"{name:<{width}}  {text}" for name, text in said.items()]


def _last(columns: dict[str, np.ndarray]) -> dict:
    """The last row of the history, by the names in summary.json."""
    if not columns or not len(columns["time"]):
        return {}
    row = {name: values[-1].item() for name, values in columns.items()}
    regime = row.pop("regime", -1)
    last = {"time_s": row["time"], "cycles": row.get("cycle", 0), "regime": REGIMES[regime] if regime >= 0 else None}
    return last | {name: row[name] for name in ("penetration_depth_m", "rod_length_m") if np.isfinite(row.get(name, np.nan))}


def _end(stop: dict, columns: dict[str, np.ndarray], now: dict, progress: dict, projectile: str) -> str:
    """The condition that is likely to end a run, and how long that will take at the present pace."""
    first, time = ending.first(stop, columns), now.get("time_s", 0.0)
    if first is None:
        return "not known: no stop condition can be predicted"
    share, left = progress.get("fraction"), progress.get("left_s")
    said = f"should stop at {moment(first.time)} ({first.reason})"
    if share and left is not None and 0.0 < time <= first.time:  # left_s is for the rest, 1 - `fraction`
        said += f", {duration(left * share / (1.0 - share) * (first.time - time) / time)} from now" if share < 1.0 else ""
    return said + (f", unless the {projectile} perforates first" if stop.get("perforation") else "")
