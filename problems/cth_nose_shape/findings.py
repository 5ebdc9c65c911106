"""Effects of advection, sliding and failure on the twelve shots: the tables of the nose-shape study, from kept rows.

    python -m problems.cth_nose_shape.findings [FILE] [--figure PATH]

FILE is what `advection.toml` keeps. The tables are printed in Markdown: depth and loss of length of every shot in every way to
compute it; how many rods end as in the experiments; and by how much the depth differs between the choices of advection, failure
and sliding. The figure has depth against velocity, as Figures 2 and 3 of the study have it, with a dot for every run
with failure by tensile pressure.
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from statistics import fmean, median, stdev

import hydro2d
from problems.cth_nose_shape import members, rigid_rod
from problems.cth_nose_shape.rigid_rod import Result, Shot

HERE = Path(__file__).parent
FILE = HERE / "results" / "advection.csv"
#: axes of the study other than the shots, and its schemes of advection
AXES = ("sliding", "failure", "advection")
SCHEMES = ("ke", "momentum", "both")

Runs = dict[tuple[str, ...], dict[Shot, list[Result]]]


def grouped(results: Sequence[Result]) -> Runs:
    """The runs by the way in which they were computed, and shot."""
    found: Runs = {}
    for result in results:
        if result.shot is not None:
            way = tuple(result.labels[axis] for axis in AXES)
            found.setdefault(way, {}).setdefault(result.shot, []).append(result)
    return found


def shots_of(found: Runs, nose: str) -> list[Shot]:
    """The shots with a nose, by alloy and velocity."""
    return sorted({shot for cases in found.values() for shot in cases if shot.nose == nose})


def _cell(runs: Sequence[Result]) -> str:
    """Median depth, the least and the largest, and median loss of length; runs that are not to be trusted are marked."""
    through = sum(run.depth is None for run in runs)
    mark = "" if all(run.trusted for run in runs) else rigid_rod.DOUBTFUL
    lost = median(run.loss for run in runs)
    loss = f"{lost:.1f} %" if lost < 10.0 else f"{lost:.0f} %"
    if through == len(runs):
        return f"perforated{mark}, {loss}"
    depths = sorted(run.reach for run in runs)
    spread = f" ({depths[0]:.1f} to {depths[-1]:.1f})" if len(depths) > 1 else ""
    some = f", {through} of {len(runs)} perforated" if through else ""
    return f"{median(depths):.1f}{mark}{spread}{some}, {loss}"


def depths(found: Runs, nose: str) -> list[str]:
    """Lines of Markdown: a row for each way to compute, a column for each shot with this nose."""
    shots, measured = shots_of(found, nose), rigid_rod.experiments()
    if not shots:
        return [f"No run of `advection.toml` with {nose} rods is kept."]
    lines = [f"| sliding, failure, advection | {' | '.join(f'{shot.alloy}, {shot.velocity:g} m/s' for shot in shots)} |",
             "|---" * (len(shots) + 1) + "|", f"| experiment | {' | '.join(str(measured[shot]) for shot in shots)} |"]
    for way, cases in found.items():
        if any(shot in cases for shot in shots):
            cells = [_cell(cases[shot]) if shot in cases else "" for shot in shots]
            lines.append(f"| {', '.join(way)} | {' | '.join(cells)} |")
    return lines


def scores(found: Runs) -> list[str]:
    """Lines of Markdown: what every way to compute has right."""
    return members.scores({", ".join(way): cases for way, cases in found.items()}, "sliding, failure, advection")


def difference(one: Sequence[Result], other: Sequence[Result]) -> tuple[float, float | None]:
    """By how much the mean depth of some runs exceeds that of others, per cent, and its standard error.

    Members of the same number lie in the same place on the mesh, so that they are compared in pairs. Members of one side are
    left out; there must be a pair.
    """
    depths = [{run.member: run.reach for run in runs} for runs in (one, other)]
    members = sorted(set.intersection(*map(set, depths)))
    more, mean = [depths[0][n] - depths[1][n] for n in members], fmean(depths[1][n] for n in members)
    error = 100.0 / mean * stdev(more) / math.sqrt(len(more)) if len(more) > 1 else None
    return 100.0 * fmean(more) / mean, error


def compared(found: Runs, nose: str, axis: str) -> list[str]:
    """Lines of Markdown: by how much each choice on an axis deepens the holes of the first choice, by shot and in the mean."""
    shots, place = shots_of(found, nose), AXES.index(axis)
    others = ", ".join(name for name in AXES if name != axis)
    lines = [f"| {others} | {axis} | {' | '.join(f'{shot.alloy}, {shot.velocity:g} m/s' for shot in shots)} | mean |",
             "|---" * (len(shots) + 3) + "|"]
    first, *choices = dict.fromkeys(way[place] for way in found)
    rests = dict.fromkeys((*way[:place], *way[place + 1 :]) for way in found)
    for rest, choice in itertools.product(rests, choices):
        those, these = (found.get((*rest[:place], value, *rest[place:]), {}) for value in (first, choice))
        differences = {shot: difference(these[shot], those[shot]) for shot in shots
                       if {run.member for run in these.get(shot, ())} & {run.member for run in those.get(shot, ())}}
        if differences:
            cells = [_difference(*differences[shot]) if shot in differences else "" for shot in shots]
            errors = [error for _, error in differences.values()]
            of_mean = None if None in errors else math.sqrt(sum(error**2 for error in errors)) / len(errors)
            mean = _difference(fmean(value for value, _ in differences.values()), of_mean)
            lines.append(f"| {', '.join(rest)} | {choice} | {' | '.join(cells)} | {mean} |")
    return lines


def _difference(value: float, error: float | None) -> str:
    return f"{value:+.1f} %" if error is None else f"{value:+.1f} ± {error:.1f} %"


def draw(found: Runs, failure: str = "P"):
    """A matplotlib Figure: a panel for each treatment of sliding and alloy, a colour for each scheme, hemispherical rods."""
    ways = list(dict.fromkeys(way[:2] for way in found if way[1] == failure))
    figure, panels = hydro2d.new_figure(9.0, 2.9 * len(ways), len(ways), 2, sharex="col", sharey=True)
    for way, row in zip(ways, panels, strict=True):
        schemes_of = {scheme: found.get((*way, scheme), {}) for scheme in SCHEMES}
        for alloy, axes in zip(rigid_rod.ALLOYS, row, strict=True):
            members.panel(axes, rigid_rod.NOSES["hemi"], alloy, schemes_of, 8.0)
            axes.set_title(f"{', '.join(way)}: {alloy}", fontsize="medium")
    members.finish(figure, panels, 5)
    return figure


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=Path, default=FILE)
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args(arguments)
    try:
        results = rigid_rod.read(given.file)
        found = grouped(results)
        if not found:
            print("there is no finished case of a shot", file=sys.stderr)
            return 2
        for nose in rigid_rod.NOSES.values():
            print("\n".join([*depths(found, nose), ""]))
        print("\n".join([*scores(found), ""]))
        for axis in reversed(AXES):
            print("\n".join([*compared(found, rigid_rod.NOSES["hemi"], axis), ""]))
        print("\n".join(rigid_rod.notes(results)))
        if given.figure:
            hydro2d.save_figure(draw(found), given.figure)
    except (hydro2d.Error, OSError, KeyError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
