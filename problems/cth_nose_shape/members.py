"""The twelve shots by their members: depth and loss of length with their spread, a score for each law, and a figure with dots.

    python -m problems.cth_nose_shape.members RESULTS [RESULTS ...] [--cells NUMBER] [--figure PATH]

RESULTS are what `rigid_rod` reads: directories of studies with `[ensemble]`, or files of kept rows. With --cells only runs with
so many cells across the rod are taken. Two tables are printed in Markdown. In the first a cell has the median depth of the
members and the least and the largest, the median loss of length, and how many members end on the side of the transition on
which the experiment did. The second counts, for each law, members on that side, with the interval of their share that holds
with 90 %, and shots whose median depth is within the aim: 10 % for rods that stay rigid, 20 % for eroded ones, and a
perforation where there was one. In the figure each dot is a member.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import hydro2d
from problems.cth_nose_shape import rigid_rod
from problems.cth_nose_shape.rigid_rod import COLOURS, PLATE, Result, Shot

#: by how much a depth may be off, of that of the experiment
RIGID_WITHIN, ERODED_WITHIN = 0.10, 0.20


def grouped(results: list[Result]) -> dict[str, dict[Shot, list[Result]]]:
    """The members of every shot, by column and shot."""
    found: dict[str, dict[Shot, list[Result]]] = {}
    for result in results:
        if result.shot is not None:
            found.setdefault(result.column, {}).setdefault(result.shot, []).append(result)
    return found


def rigid() -> dict[Shot, bool]:
    """Whether the rod of each experiment stayed rigid, by its depth."""
    return {shot: told.rigid for shot, told in rigid_rod.experiments().items()}


def right(members: list[Result], stayed_rigid: bool) -> int:
    """How many members end as the experiment did: two thirds of the length left, or not."""
    return sum(result.held == stayed_rigid for result in members)


def cell(members: list[Result], stayed_rigid: bool | None) -> str:
    """A cell of the table."""
    through = sum(result.depth is None for result in members)
    depths = sorted(result.reach for result in members)
    depth = f"{median(depths):.1f} cm" if 2 * through < len(members) else "perforated"
    if through in (0, len(members)) and depths[0] < depths[-1]:
        depth += f" ({depths[0]:.1f} to {depths[-1]:.1f})"
    elif through not in (0, len(members)):
        depth += f" ({through} of {len(members)} perforated, least {depths[0]:.1f} cm)"
    lost = median(result.loss for result in members)
    told = f"{depth}, {lost:.1f} %" if lost < 10.0 else f"{depth}, {lost:.0f} %"
    return told if stayed_rigid is None else f"{told}, {right(members, stayed_rigid)} of {len(members)}"


def table(found: dict[str, dict[Shot, list[Result]]]) -> list[str]:
    """Lines of Markdown: a row for each shot, a column for each law."""
    measured, sides = rigid_rod.experiments(), rigid()
    shots = sorted({shot for cases in found.values() for shot in cases})
    lines = ["| shot | experiment | " + " | ".join(found) + " |", "|---" * (len(found) + 2) + "|"]
    for shot in shots:
        cells = [cell(cases[shot], sides.get(shot)) if shot in cases else "" for cases in found.values()]
        lines.append(f"| {shot} | {measured.get(shot, '')} | " + " | ".join(cells) + " |")
    return lines


def within_aim(members: list[Result], shot: Shot) -> bool:
    """Whether the median depth of a shot's members is as near to the measured one as was aimed at."""
    measured, through = rigid_rod.experiments()[shot], 2 * sum(result.depth is None for result in members) >= len(members)
    if measured.kind == "at least":
        return through
    most = RIGID_WITHIN if measured.rigid else ERODED_WITHIN
    return not through and abs(median(result.reach for result in members) / (1e2 * measured.depth) - 1.0) <= most


@dataclass(frozen=True)
class Score:
    """What the runs of one column have right.

    shots : those that were run;  members, right : their members, and how many of these end as the experiment did
    sure : shots of which nine in ten members do;  aimed : shots whose depth is within the aim
    """

    shots: tuple[Shot, ...]
    members: int
    right: int
    sure: tuple[Shot, ...]
    aimed: tuple[Shot, ...]


def score(cases: dict[Shot, list[Result]]) -> Score | None:
    """The score of a column by its members of every shot; None if none of the shots was measured."""
    sides = rigid()
    known = {shot: members for shot, members in cases.items() if shot in sides}
    rights = {shot: right(members, sides[shot]) for shot, members in known.items()}
    sure = tuple(shot for shot, members in known.items() if 10 * rights[shot] >= 9 * len(members))
    aimed = tuple(shot for shot, members in known.items() if within_aim(members, shot))
    return Score(tuple(known), sum(map(len, known.values())), sum(rights.values()), sure, aimed) if known else None


def scores(found: dict[str, dict[Shot, list[Result]]], head: str = "law") -> list[str]:
    """Lines of Markdown: what every column has right; ``head`` says what the columns are."""
    lines = [f"| {head} | shots | members on the right side | shots with nine in ten on it | depths within the aim |",
             "|---|---|---|---|---|"]
    for column, cases in found.items():
        if told := score(cases):
            share = hydro2d.wilson(told.right, told.members)
            lines.append(f"| {column} | {len(told.shots)} | {share.words} | {len(told.sure)} | {len(told.aimed)} |")
    return lines


def draw(found: dict[str, dict[Shot, list[Result]]]):
    """A matplotlib Figure with a panel for each nose and alloy: a dot for every member; triangles are rods that perforate."""
    figure, panels = hydro2d.new_figure(9.6, 7.8, 2, 2, sharey=True)
    for nose, row in zip(rigid_rod.NOSES.values(), panels, strict=True):
        for alloy, axes in zip(rigid_rod.ALLOYS, row, strict=True):
            panel(axes, nose, alloy, found, 6.0)
            axes.set_title(f"{nose} nose, {alloy} aluminium", fontsize="medium")
    finish(figure, panels, 3)
    return figure


def panel(axes, nose: str, alloy: str, found: dict[str, dict[Shot, list[Result]]], apart: float) -> None:
    """Depth against velocity of the rods with a nose in a plate, and their experiments; columns stand ``apart`` m/s."""
    for number, (column, cases) in enumerate(found.items()):
        shift = apart * (number - 0.5 * (len(found) - 1))
        here = {shot.velocity + shift: members for shot, members in cases.items() if (shot.nose, shot.alloy) == (nose, alloy)}
        _dots(axes, column, COLOURS[number % len(COLOURS)], here)
    for marker, is_measured, label in (("s", True, "experiment"), ("^", False, "experiment, perforated")):
        shots = [(shot.velocity, 1e2 * told.depth) for shot, told in rigid_rod.experiments().items()
                 if (shot.nose, shot.alloy, told.kind != "at least") == (nose, alloy, is_measured)]
        axes.plot(*zip(*shots, strict=True) if shots else ([], []), marker, color="black", markersize=8,
                  markerfacecolor="none", label=label)
    axes.axhline(PLATE, color="black", linewidth=0.5, linestyle=":")
    axes.grid(alpha=0.3)


def finish(figure, panels, columns: int) -> None:
    """Labels of the axes of panels with depths, and one legend for all of them in so many columns."""
    for row in panels:
        row[0].set_ylabel("depth [cm]")
    for axes in panels[-1]:
        axes.set_xlabel("impact velocity [m/s]")
    panels[0][0].set_ylim(0.0, 60.0)
    figure.legend(*panels[0][0].get_legend_handles_labels(), fontsize="small", loc="outside lower center", ncols=columns)


def _dots(axes, column: str, colour: str, members: dict[float, list[Result]]) -> None:
    """The members of one law in one panel, by velocity, with a line through their medians."""
    places = sorted(members)
    axes.plot(places, [median(result.reach for result in members[at]) for at in places], color=colour, linewidth=0.8)
    for marker, through in (("o", False), ("^", True)):
        dots = [(at, result.reach) for at in places for result in members[at] if (result.depth is None) == through]
        axes.plot(*zip(*dots, strict=True) if dots else ([], []), marker, color=colour, markersize=5, alpha=0.6,
                  label="_" if through else column)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", type=Path)
    parser.add_argument("--cells", type=float)
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args(arguments)
    try:
        runs = [result for path in given.results for result in rigid_rod.read(path, given.cells)]
        results = list({result.identity: result for result in runs}.values())
        found = grouped(results)
        if not found:
            print("there is no finished case of a shot", file=sys.stderr)
            return 2
        print("\n".join([*table(found), "", *scores(found), *rigid_rod.notes(results)]))
        if given.figure:
            hydro2d.save_figure(draw(found), given.figure)
    except (hydro2d.Error, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
