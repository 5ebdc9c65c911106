"""The force on a rod against its speed, from run directories, compared with the resistance of cavity expansion.

    python -m problems.sliding.drag RUN [RUN ...] [--window MICROSECONDS] [--json]

The force is the deceleration of the rod's centre of mass times the rod's mass, divided by its cross-section. The deceleration
is the slope of a line fitted to the velocities in a window of time. Cavity expansion is the model `forrestal` on the run's own
deck: A Y N1 + B rho N2 V^2 on the whole nose, with A and B for a compressible cavity in the target's material. Runs need not
have ended.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import hydro2d

#: smallest number of rows of the history to which a line is fitted
ROWS = 4


@dataclass(frozen=True)
class Window:
    """A window: time (s) and depth (m) at its middle, and speed (m/s) and deceleration (m/s^2) of the fitted line there."""

    time: float
    depth: float
    speed: float
    deceleration: float


def windows(time: np.ndarray, speed: np.ndarray, depth: np.ndarray, width: float) -> list[Window]:
    """Consecutive windows of ``width`` (s) from the first time on, except those that the history covers by less than half."""
    fitted = []
    for k in range(math.ceil((time[-1] - time[0]) / width * (1.0 - 1e-9))):
        here = (time >= time[0] + (k - 1e-9) * width) & (time <= time[0] + (k + 1 + 1e-9) * width)
        if np.count_nonzero(here) < ROWS or np.ptp(time[here]) < 0.5 * width:
            continue
        middle = float(0.5 * (time[here][0] + time[here][-1]))
        slope, level = np.polyfit(time[here] - middle, speed[here], 1)
        fitted.append(Window(middle, float(np.interp(middle, time, depth)), float(level), -float(slope)))
    return fitted


def measure(directory: Path | str, width: float = 10e-6) -> dict:
    """Force (Pa, over the rod's cross-section) by window, with the values of theory and experiment; SI.

    Raises hydro2d.Error.
    """
    run = hydro2d.open_run(directory)
    if "rod_mean_velocity_m_s" not in run.history:
        raise hydro2d.ResultsError(f"{directory} has no rod: its deck has no [penetration]")
    case = hydro2d.penetration_model("forrestal", run.deck)
    rod, target = (run.deck.body_named(getattr(run.deck.penetration, key)) for key in ("rod", "target"))
    impact = abs(rod.velocity[1] - target.velocity[1])
    mass, section = case.values["rod.mass"], 0.25 * math.pi * case.values["rod.diameter"] ** 2
    time, depth = run.history["time"], run.history["penetration_depth_m"]
    speed = run.direction * run.history["rod_mean_velocity_m_s"]
    rows = [
        {"time": at.time, "depth": at.depth, "speed": at.speed, "force": mass * at.deceleration / section,
         "cavity": case.rows([max(at.speed, 0.0)])[0]["resistance"]}
        for at in windows(time, speed, depth, width)
    ]

    def mean(reached: float, left: float = 0.0) -> float | None:
        """Mean resistance over a depth (m) at the end of which the rod's speed is ``left`` (m/s)."""
        return 0.5 * mass * (impact**2 - left**2) / (section * reached) if reached else None

    return {
        "run": run.label, "ended": bool(run.summary), "velocity": impact, "mass": mass, "section": section, "rows": rows,
        "speed": float(speed[-1]), "depth": float(depth[-1]), "mean": mean(depth[-1], speed[-1]),
        "cavity_depth": case.rows([impact])[0]["depth"],
        "measured_depth": run.measured_depth, "measured_mean": mean(run.measured_depth),
    }


def table(result: dict) -> str:
    """The measurements as Markdown."""
    lines = [f"**{result['run']}**, {result['velocity']:.0f} m/s{'' if result['ended'] else ', not ended'}", "",
             "| time, us | depth, cm | speed, m/s | force, GPa | cavity expansion, GPa | ratio |",
             "|---|---|---|---|---|---|"]
    for row in result["rows"]:
        lines.append(
            f"| {row['time'] * 1e6:.0f} | {row['depth'] * 1e2:.2f} | {row['speed']:.1f} | {row['force'] * 1e-9:.2f} "
            f"| {row['cavity'] * 1e-9:.2f} | {row['force'] / row['cavity']:.2f} |"
        )
    mean = "" if result["mean"] is None else f", mean resistance {result['mean'] * 1e-9:.2f} GPa"
    lines += ["", f"* run: {result['depth'] * 1e2:.1f} cm with {result['speed']:.0f} m/s left{mean}",
              f"* cavity expansion: {result['cavity_depth'] * 1e2:.1f} cm"]
    if result["measured_depth"]:
        lines.append(f"* experiment: {result['measured_depth'] * 1e2:.1f} cm; from a rigid rod a mean resistance of "
                     f"{result['measured_mean'] * 1e-9:.2f} GPa")
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """The command. Returns 2 if a directory holds no run with a rod."""
    parser = argparse.ArgumentParser(prog="python -m problems.sliding.drag", description=__doc__.splitlines()[0])
    parser.add_argument("run", nargs="+", type=Path, help="a run directory, finished or not")
    parser.add_argument("--window", type=float, default=10.0, help="length of a window in microseconds (10)")
    parser.add_argument("--json", action="store_true", help="print JSON, SI units")
    given = parser.parse_args(arguments)
    try:
        results = [measure(directory, given.window * 1e-6) for directory in given.run]
    except hydro2d.Error as error:
        print(error, file=sys.stderr)
        return 2
    print(json.dumps(results, indent=2) if given.json else "\n\n".join(map(table, results)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
