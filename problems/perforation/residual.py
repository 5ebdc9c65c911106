"""Residual against striking velocity for the Weldox 460 E shots, with the experiments: a Markdown table and a figure.

    python -m problems.perforation.residual STUDY [STUDY ...] [--figure PATH]

Cases that are not done are left out. The ballistic limits come from the formula of Lambert and Jonas, fitted to the shots and
to the runs.
"""

from __future__ import annotations

import argparse
import csv
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import hydro2d

COLOURS = {"blunt": "#1f4e79", "hemispherical": "#b5651d"}


@dataclass(frozen=True)
class Run:
    """A case: nose, striking and residual velocity (m/s; 0 if the plate stopped the rod), plug (kg, m/s), exit diameter (m)."""

    nose: str
    striking: float
    residual: float
    plug: float | None = None
    plug_velocity: float | None = None
    hole: float | None = None


def experiments() -> dict[tuple[str, float], float]:
    """Residual velocities of weldox_460e.csv by nose and striking velocity, m/s."""
    with open(Path(__file__).with_name("weldox_460e.csv"), encoding="utf-8") as file:
        return {(row["nose"], float(row["striking_m_s"])): float(row["residual_m_s"]) for row in csv.DictReader(file)}


def runs(directories: list[Path]) -> list[Run]:
    """The finished cases, sorted by nose and velocity. Raises StudyError."""
    cases = []
    for directory in directories:
        for case in hydro2d.open_study(directory).cases:
            if case.status == "done" and "nose" in case.values:
                summary, striking = case.summary, float(case.values["velocity"].split()[0])
                through, crater = summary.outcome.perforated, summary.crater
                cases.append(Run(case.values["nose"], striking, summary.outcome.residual_velocity_m_s if through else 0.0,
                                 *((crater.ejected_mass_kg, crater.ejected_velocity_m_s, crater.exit_diameter_m)
                                   if through else ())))
    return sorted(cases, key=lambda run: (run.nose, -run.striking))


def limit(pairs: list[tuple[float, float]]) -> str:
    """Ballistic limit fitted to (striking, residual) velocities in m/s, with a and p; if the fit fails, the reason."""
    try:
        fit = hydro2d.fit_residual_velocity(*zip(*pairs, strict=True))
    except ValueError as error:
        return str(error)
    return f"{fit.limit_velocity:.1f} m/s (a = {fit.a:.2f}, p = {fit.p:.2f})"


def table(cases: list[Run]) -> list[str]:
    """Lines of Markdown."""
    measured = experiments()
    lines = ["| nose | striking, m/s | residual: experiment | hydro2d | difference | plug and debris | hole at the rear |",
             "|---" * 7 + "|"]
    for run in cases:
        there = measured.get((run.nose, run.striking))
        difference = "" if there is None else f"{round(run.residual - there):+d} m/s"
        plug = "" if not run.plug else f"{1e3 * run.plug:.0f} g at {run.plug_velocity:.0f} m/s"
        hole = "" if run.hole is None else f"{1e3 * run.hole:.1f} mm"
        shot = "" if there is None else f"{there:.1f}"
        lines.append(f"| {run.nose} | {run.striking:g} | {shot} | {run.residual:.1f} | {difference} | {plug} | {hole} |")
    for nose in dict.fromkeys(run.nose for run in cases):
        shots = [(striking, left) for (name, striking), left in measured.items() if name == nose]
        lines += ["", f"Ballistic limit, {nose}: {limit(shots)} by the shots, "
                      f"{limit([(run.striking, run.residual) for run in cases if run.nose == nose])} by the runs"]
    return lines


def draw(cases: list[Run]):
    """A matplotlib Figure: filled markers for runs, open ones for experiments."""
    figure, ((axes,),) = hydro2d.new_figure(6.0, 4.4)
    measured = experiments()
    for nose, colour in COLOURS.items():
        mine = np.array([(run.striking, run.residual) for run in cases if run.nose == nose]).reshape(-1, 2)
        shots = np.array([(striking, left) for (name, striking), left in measured.items() if name == nose])
        axes.plot(*shots.T, "o", markerfacecolor="none", color=colour, label=f"{nose}, experiment")
        axes.plot(*mine.T, ".-", color=colour, label=f"{nose}, hydro2d")
    axes.set_xlabel("striking velocity [m/s]")
    axes.set_ylabel("residual velocity [m/s]")
    axes.legend()
    return figure


def main(arguments: list[str] | None = None) -> int:
    """Prints the table and draws the figure. Returns 2 if a directory is not a study."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("studies", nargs="+", type=Path)
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args(arguments)
    try:
        cases = runs(given.studies)
    except hydro2d.StudyError as error:
        print(error, file=sys.stderr)
        return 2
    print("\n".join(table(cases)))
    if given.figure:
        hydro2d.save_figure(draw(cases), given.figure)
    return 0


if __name__ == "__main__":
    sys.exit(main())
