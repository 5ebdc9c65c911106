"""The velocity at which half of the rods lose a third of their length, with its interval.

    python -m problems.cth_nose_shape.transitions [FILE ...]

prints the table of `transition.toml` and `transition_ogival.toml` in Markdown, from the rows that their searches keep.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import pandas

import hydro2d

HERE = Path(__file__).parent
FILES = tuple(HERE / "results" / f"{study}.csv" for study in ("transition", "transition_ogival"))
#: what tells one search from another
CASE = ("nose", "cells_across", "law", "plate")
#: velocities of the experiments between which the change lies, m/s: the fastest rod that stayed rigid, the next that eroded
EXPERIMENTS = {("hemispherical", "5083"): "1086 to 1200 m/s", ("hemispherical", "7039"): "1038 to 1165 m/s",
               ("ogival", "5083"): "above 1227 m/s", ("ogival", "7039"): "above 1291 m/s"}
HEAD = ("nose", "cells", "law", "plate", "experiments", "half of the rods", "90 % interval",
        "fastest that kept, slowest that lost", "runs")


def searches(runs: pandas.DataFrame) -> dict[tuple, pandas.DataFrame]:
    """The finished runs of every search, the slowest first: those of the newest method of which the search has some.

    runs : of `hydro2d.runs`;  the results have ``speed`` in m/s, and whether the rod ``kept`` two thirds of its length as well;
    plates are words
    """
    done = runs[runs["status"] == "done"]
    done = done.assign(plate=[each if isinstance(each, str) else f"{each:g}" for each in done["plate"]],
                       speed=[hydro2d.to_si(each, "m/s") for each in done["velocity"]],
                       kept=done["length_ratio"] >= hydro2d.LEAST_KEPT_LENGTH)
    return {case: members[members["method"] == members["method"].max()].sort_values("speed", kind="stable")
            for case, members in done.groupby(list(CASE), sort=False)}


def fitted(runs: pandas.DataFrame):
    """v50 and the width of the change, from the runs of one search. Raises ValueError where they do not tell."""
    fit = hydro2d.fit_transition(runs["speed"], ~runs["kept"])
    if fit is None:
        raise ValueError("the runs do not tell the velocity of the change")
    return fit


def _said(runs: pandas.DataFrame) -> tuple[str, str, str]:
    """v50, its interval, and the runs on both sides; where all runs end alike, which bound they give."""
    held, lost = ([f"{speed:.0f}" for speed in runs["speed"][runs["kept"] == side]] for side in (True, False))
    if not (held and lost):
        return (f"above {held[-1]} m/s" if held else f"below {lost[0]} m/s"), "", ""
    try:
        fit = fitted(runs)
    except ValueError:
        return "not known", "", f"{held[-1]}, {lost[0]} m/s"
    return f"{fit.v50:.0f} m/s", _interval(fit.v50_low, fit.v50_high), f"{held[-1]}, {lost[0]} m/s"


def _interval(low: float | None, high: float | None) -> str:
    """An interval in words; None: it is open on this side."""
    if low is None:
        return "open" if high is None else f"below {high:.0f} m/s"
    return f"above {low:.0f} m/s" if high is None else f"{low:.0f} to {high:.0f} m/s"


def table(runs: pandas.DataFrame) -> list[str]:
    """Lines of Markdown: a row for each search, and what must be said of runs of other versions of the method."""
    lines = [f"| {' | '.join(HEAD)} |", "|---" * len(HEAD) + "|"]
    shown = searches(runs)
    for (nose, cells, law, plate), members in shown.items():
        half, interval, sides = _said(members)
        lines.append(f"| {nose} | {cells:g} | {law} | {plate} | {EXPERIMENTS[nose, plate[:4]]} | {half} | {interval} | {sides} "
                     f"| {len(members)} |")
    note = hydro2d.method_note(method for members in shown.values() for method in members["method"])
    return [*lines, "", note] if note else lines


def main(arguments: list[str]) -> int:
    """Prints the table. Returns the exit status."""
    parser = argparse.ArgumentParser(prog="transitions", description=__doc__.splitlines()[0])
    parser.add_argument("files", type=Path, nargs="*", default=FILES, help="rows of searches; default: those that are kept")
    try:
        print("\n".join(table(hydro2d.runs(*parser.parse_args(arguments).files))))
    except (hydro2d.Error, OSError) as problem:
        print(problem, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
