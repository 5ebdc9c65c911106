"""Seven shots on several meshes, and one of them without softening: tables of the kept rows for the pages, and the figure.

    python -m problems.cth_nose_shape.convergence [--figure PATH]

The tables have the depth of every shot on every mesh, the length that is left, the volume of the hole, and the velocity of rods
that went through the plate: the median of the members, the least and the largest. Order, extrapolated value and grid
convergence index are those of the medians on the three finest meshes (hydro2d.grid_convergence); where some members hold and
others erode there are none. A last table has the depth of the shot of hollow_nose.toml with laws that do not soften.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import TypeVar

import hydro2d
from problems.cth_nose_shape import rigid_rod
from problems.cth_nose_shape.rigid_rod import Result, Shot

FILE = rigid_rod.EXPERIMENTS.with_name("results") / "convergence.csv"
#: the same shot with laws that do not soften, and the law that it has in FILE
HARD, HARD_SHOT, SOFT = FILE.with_name("hollow_nose.csv"), Shot.named("7039-1248"), "Steinberg-Guinan"

Key = TypeVar("Key")
ByCells = dict[float, list[Result]]
Meshes = dict[Shot, ByCells]


@dataclass(frozen=True)
class Quantity:
    """What is compared: a value of a run, None where it has none; its unit and its digits."""

    name: str
    unit: str
    digits: int
    of: Callable[[Result], float | None]


DEPTH = Quantity("depth", "cm", 1, lambda run: run.depth)
LENGTH = Quantity("length left", "mm", 1,
                  lambda run: 1e3 * rigid_rod.experiments()[run.shot].length * (1.0 - 1e-2 * run.loss))
HOLE = Quantity("volume of the hole", "cm³", 2, lambda run: run.hole)
RESIDUAL = Quantity("residual velocity", "m/s", 0, lambda run: run.residual)
QUANTITIES = (DEPTH, LENGTH, HOLE, RESIDUAL)


def found(path: Path = FILE) -> Meshes:
    """The runs of every shot by cells across the radius of the rod. Raises hydro2d.Error, OSError."""
    return dict(sorted(_by_cells(path, lambda run: run.shot).items()))


def softening() -> dict[str, ByCells]:
    """The runs of the shot of hollow_nose.toml by law of the rod and by cells. Raises hydro2d.Error, OSError."""
    return {SOFT: found()[HARD_SHOT], **_by_cells(HARD, lambda run: run.labels["law"])}


def _by_cells(path: Path, key: Callable[[Result], Key]) -> dict[Key, ByCells]:
    """The runs of a file by a key and by cells, the coarsest mesh first."""
    meshes: dict[Key, ByCells] = {}
    for run in sorted(rigid_rod.read(path), key=lambda run: float(run.labels[rigid_rod.CELLS])):
        meshes.setdefault(key(run), {}).setdefault(float(run.labels[rigid_rod.CELLS]), []).append(run)
    return meshes


def _values(runs: Sequence[Result], quantity: Quantity) -> list[float]:
    return sorted(value for run in runs if (value := quantity.of(run)) is not None)


def _cell(runs: Sequence[Result], quantity: Quantity) -> str:
    """Median, the least and the largest."""
    if not (values := _values(runs, quantity)):
        return ""
    middle, least, most = (f"{value:.{quantity.digits}f}" for value in (median(values), values[0], values[-1]))
    return middle if least == most else f"{middle} ({least} to {most})"


def _limit(meshes: ByCells, quantity: Quantity) -> str:
    """Extrapolated value, order and grid convergence index, or why there are none."""
    known = {cells: median(values) for cells, runs in meshes.items() if (values := _values(runs, quantity))}
    finest = dict(sorted(known.items())[-3:])
    if len(finest) < 3:
        return ""
    ends = {run.held for cells in finest for run in meshes[cells]}
    if len(ends) > 1:
        return "some hold, some erode"
    told = hydro2d.grid_convergence(finest)
    if told.order is None or told.value is None:
        return told.words
    return f"{told.value:.{quantity.digits}f}, order {told.order:.1f}, index {100.0 * told.index:.2g} %"


def table(meshes: Mapping[Key, ByCells], quantity: Quantity) -> list[str]:
    """Lines of Markdown: a row for each shot or law that has the quantity, a column for each mesh."""
    cells = sorted({number for each in meshes.values() for number in each})
    lines = [f"| {quantity.name}, {quantity.unit} | " + " | ".join(f"{number:g} cells" for number in cells)
             + " | extrapolated |", "|---" * (len(cells) + 2) + "|"]
    for shot, each in meshes.items():
        if any(_values(runs, quantity) for runs in each.values()):
            row = [_cell(each.get(number, ()), quantity) for number in cells]
            lines.append(f"| {shot} | " + " | ".join(row) + f" | {_limit(each, quantity)} |")
    return lines


def tables(meshes: Meshes) -> list[str]:
    """The tables of all quantities, and what is to be said of their runs."""
    lines = [line for quantity in QUANTITIES for line in (*table(meshes, quantity), "")]
    return [*lines[:-1], *rigid_rod.notes([run for each in meshes.values() for runs in each.values() for run in runs])]


def draw(meshes: Meshes):
    """A matplotlib Figure: depth and length left of every member against the size of the cells, a colour for each shot."""
    figure, panels = hydro2d.new_figure(9.0, 4.2, 1, 2)
    for axes, quantity in zip(panels[0], (DEPTH, LENGTH), strict=True):
        for number, (shot, each) in enumerate(meshes.items()):
            colour = rigid_rod.COLOURS[number % len(rigid_rod.COLOURS)]
            dots = [(1.0 / cells, value) for cells, runs in each.items() for value in _values(runs, quantity)]
            middle = [(1.0 / cells, median(values)) for cells, runs in each.items() if (values := _values(runs, quantity))]
            if dots:
                marker = "o" if number < len(rigid_rod.COLOURS) else "s"
                axes.plot(*zip(*dots, strict=True), marker, color=colour, markersize=4, alpha=0.6, label=str(shot))
                axes.plot(*zip(*middle, strict=True), color=colour, linewidth=0.8)
        axes.set_xlabel("size of the cells over the radius of the rod")
        axes.set_ylabel(f"{quantity.name} [{quantity.unit}]")
        axes.set_xlim(left=0.0)
        axes.set_ylim(bottom=0.0)
        axes.grid(alpha=0.3)
    figure.legend(*panels[0][1].get_legend_handles_labels(), fontsize="small", loc="outside lower center", ncols=3)
    return figure


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=Path, default=FILE)
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args(arguments)
    try:
        meshes = found(given.file)
        print("\n".join([*tables(meshes), "", *table(softening(), DEPTH)]))
        if given.figure:
            hydro2d.save_figure(draw(meshes), given.figure)
    except (hydro2d.Error, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
