"""Ballistic limits of limits.csv and holes of holes_psaap.csv beside the kept runs: Markdown and a figure.

    python -m problems.perforation.limits [--figure PATH]

A limit comes from the residual velocities of its runs by the formula of Lambert and Jonas. The exponent is fitted where four or
more runs perforate; elsewhere it is 2.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import pandas

import hydro2d
from problems import kept

HERE = Path(__file__).parent
#: perforations from which on the exponent is fitted as well
ENOUGH = 4


@dataclass(frozen=True)
class Measured:
    """A row of limits.csv: the deck, the name of the shot, the limit in m/s, and whether that is a point of a fit."""

    deck: str
    shot: str
    limit: float
    fit: bool


@dataclass(frozen=True)
class Limit:
    """The limit by the runs with one label.

    label : that of the study;  limit : m/s;  stopped, through : the fastest run that was stopped and the slowest that went
    through, m/s; None if there is none;  runs : how many;  cells : across the radius;  method : version of the method
    """

    label: str
    limit: float
    stopped: float | None
    through: float
    runs: int
    cells: float
    method: str


@dataclass(frozen=True)
class Hole:
    """A hole: thickness of the plate in mm, velocity in km/s, area by the formula and by the run in mm^2, method of the run."""

    thickness: float
    velocity: float
    measured: float
    computed: float
    cells: float
    method: str


def measured() -> list[Measured]:
    """The rows of limits.csv."""
    return [Measured(row["deck"], row["shot"], float(row["limit_m_s"]), row["fit"] == "yes")
            for row in kept.rows(HERE / "limits.csv", ("deck", "shot", "limit_m_s", "fit"))]


def limits(deck: str) -> list[Limit]:
    """The limits by the kept runs of a deck, for each label; that of the deck as it stands first. Raises ValueError."""
    return [_limit(label, own) for label, own in _runs(deck).groupby("plate", sort=False)]


def _runs(deck: str) -> pandas.DataFrame:
    """The kept runs of a deck, with `striking` and `left`, the velocities before and behind the plate in m/s."""
    runs = hydro2d.runs(HERE / "results" / f"limits_{deck}.csv")
    left = [float(left) if through else 0.0
            for left, through in zip(runs["residual_velocity_m_s"], runs["perforated"], strict=True)]
    return runs.assign(striking=[hydro2d.to_si(velocity, "m/s") for velocity in runs["velocity"]], left=left)


def meshes(deck: str) -> list[Limit]:
    """The limits of a deck as it stands and on its other meshes."""
    first, *others = limits(deck)
    return [first, *(each for each in others if each.cells != first.cells)]


def _limit(label: str, runs: pandas.DataFrame) -> Limit:
    through = runs["left"] > 0.0
    fit = hydro2d.fit_residual_velocity(runs["striking"], runs["left"], p=None if through.sum() >= ENOUGH else 2.0)
    stopped = runs["striking"][~through]
    return Limit(label, fit.limit_velocity, None if stopped.empty else float(stopped.max()),
                 float(runs["striking"][through].min()), len(runs), float(runs["cells_across"].iloc[0]),
                 "; ".join(sorted(set(runs["method"]))))


def holes() -> list[Hole]:
    """The holes of holes_psaap.csv that have a kept run."""
    areas = {(row["thickness"], row["velocity"]): float(row["area_mm2"])
             for row in kept.rows(HERE / "holes_psaap.csv", ("thickness", "velocity", "area_mm2"))}
    return [Hole(1e3 * hydro2d.to_si(run["thickness"], "m"), 1e-3 * hydro2d.to_si(run["velocity"], "m/s"),
                 areas[run["thickness"], run["velocity"]], 0.25e6 * math.pi * run["derived.width_m"] ** 2,
                 run["cells_across"], run["method"])
            for _, run in hydro2d.runs(HERE / "results" / "holes_psaap.csv").iterrows()]


def lines() -> list[str]:
    """Both tables."""
    found = ["| shot | limit, m/s | runs | limit by the runs | stopped, through | ratio |", "|---" * 6 + "|"]
    for each in measured():
        for limit in limits(each.deck):
            stopped = "none" if limit.stopped is None else f"{limit.stopped:.0f}"
            found.append(f"| {each.shot} | {each.limit:.0f} | {limit.label}, {limit.runs} | {limit.limit:.0f} | "
                         f"{stopped}, {limit.through:.0f} | {limit.limit / each.limit:.2f} |")
    found += ["", "| plate, mm | velocity, km/s | hole by the formula, mm² | hydro2d | ratio |", "|---" * 5 + "|"]
    return found + [f"| {hole.thickness:g} | {hole.velocity:g} | {hole.measured:.2f} | {hole.computed:.2f} | "
                    f"{hole.computed / hole.measured:.2f} |" for hole in holes()]


def draw():
    """A matplotlib Figure: velocities behind the plate over the measured limit, and holes against the velocity."""
    figure, ((left, right),) = hydro2d.new_figure(9.0, 3.8, 1, 2)
    for number, each in enumerate(measured()):
        runs = _runs(each.deck)
        own = runs[runs["plate"] == runs["plate"].iloc[0]].sort_values("striking")
        left.plot(own["striking"] / each.limit, own["left"] / each.limit, ".-", color=f"C{number}", label=each.shot)
    left.axvline(1.0, color="black", linewidth=0.8, linestyle=":", label="measured limit")
    left.set(xlabel="striking velocity over the limit", ylabel="velocity left over the limit")
    for number, thickness in enumerate(sorted({hole.thickness for hole in holes()})):
        own = [hole for hole in holes() if hole.thickness == thickness]
        velocities = [hole.velocity for hole in own]
        right.plot(velocities, [hole.measured for hole in own], "--", color=f"C{number}", label=f"{thickness:g} mm, formula")
        right.plot(velocities, [hole.computed for hole in own], "o", color=f"C{number}", label=f"{thickness:g} mm, hydro2d")
    right.set(xlabel="striking velocity [km/s]", ylabel="area of the hole [mm$^2$]")
    for axes in (left, right):
        axes.legend(fontsize=7)
    return figure


def main(arguments: list[str] | None = None) -> int:
    """Prints the tables and draws the figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args(arguments)
    print("\n".join(lines()))
    if given.figure:
        hydro2d.save_figure(draw(), given.figure)
    return 0


if __name__ == "__main__":
    sys.exit(main())
