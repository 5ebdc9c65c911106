"""Draws problems with exact solutions: the meshes of `results/accuracy_curves.csv` with the exact curve.

    python -m problems.verification.figures FOLDER [PROBLEM ...]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import hydro2d
from problems import kept
from problems.verification.accuracy import BY_NAME, Problem
from problems.verification.table import CURVE_COLUMNS, CURVES

#: colours from the coarsest mesh to the finest
COLOURS = ("#c9a66b", "#7aa6c2", "#1f4e79")


def draw(problem: Problem, rows: list[dict[str, str]]):
    """One figure: a line for each mesh, and the exact solution in black."""
    figure, ((axes,),) = hydro2d.new_figure(6.0, 3.6)
    every = []
    for cells, colour in zip(problem.cells, COLOURS, strict=True):
        mine = [row for row in rows if row["problem"] == problem.name and row["cells"] == str(cells)]
        x, y = (np.array([float(row[name]) for row in mine]) for name in ("x", "y"))
        every.append(x)
        marks = "o" if len(x) < 10 else ""
        axes.plot(x, y, color=colour, linewidth=1.2, marker=marks, markersize=4, label=f"{cells} cells {problem.resolution}")
    together = np.concatenate(every)
    if len(together):
        x = np.linspace(together.min(), together.max(), 1500)
        axes.plot(x, problem.exact(x), color="black", linewidth=0.9, linestyle="--", label="exact")
    axes.set_title(problem.title, fontsize=9)
    axes.set_xlabel(problem.axes[0], fontsize=8)
    axes.set_ylabel(problem.axes[1], fontsize=8)
    axes.tick_params(labelsize=7)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    return figure


def picture(problem: Problem) -> str:
    """The name of the picture of a problem."""
    return f"verification_{problem.name}.png"


def main(arguments: list[str] | None = None) -> int:
    """Draws the figures. Returns 2 if nothing is kept or the folder is wrong."""
    parser = argparse.ArgumentParser(prog="python -m problems.verification.figures", description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="where the pictures go")
    parser.add_argument("problems", nargs="*", choices=[[], *BY_NAME], metavar="PROBLEM", help="default: all")
    given = parser.parse_args(arguments)
    try:
        rows = kept.rows(CURVES, CURVE_COLUMNS)
        for name in given.problems or BY_NAME:
            if any(row["problem"] == name for row in rows):
                hydro2d.save_figure(draw(BY_NAME[name], rows), given.folder / picture(BY_NAME[name]))
    except (hydro2d.Error, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
