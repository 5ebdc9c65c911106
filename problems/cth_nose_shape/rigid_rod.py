"""Depth against velocity for the rods of the shots, from studies of strength models, meshes or plates: a table and a figure.

    python -m problems.cth_nose_shape.rigid_rod STUDY [STUDY ...] [--figure PATH] [--list]

The table is in Markdown. Each row is a shot, and each column a variant of whatever else the studies vary. The experiments stand
beside the runs. The figure also shows two analytic models, evaluated on the runs' own decks: `forrestal` for a rod that stays
rigid and `tate` for one that erodes. Cases that are not done are left out. `--list` prints other tables instead: every
finished case of each study, with regime, time and duration.
"""

from __future__ import annotations

import argparse
import csv
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hydro2d.analytic import model_deck, models
from hydro2d.errors import DeckError
from hydro2d.results import figures
from hydro2d.study import layout
from hydro2d.study.layout import StudyError

#: the label of a shot: nose, alloy and velocity; without a nose it means a hemispherical one
SHOT = re.compile(r"(?:(hemi|ogive)[- ])?(5083|7039)[- ](\d+)")
NOSES = {"hemi": "hemispherical", "ogive": "ogival"}
#: velocities of the analytic models, m/s
VELOCITIES = np.linspace(800.0, 1400.0, 61)
COLOURS = ("#1f4e79", "#b5651d", "#4f7942", "#8b3a62", "#5b6770")


@dataclass(frozen=True)
class Shot:
    """A row of the table: nose, alloy and velocity (m/s)."""

    nose: str
    alloy: str
    velocity: float

    @classmethod
    def named(cls, label: str) -> Shot | None:
        """The shot that the label of a case names; None if it names none."""
        found = SHOT.fullmatch(label)
        return found and cls(NOSES[found[1] or "hemi"], found[2], float(found[3]))

    def __str__(self) -> str:
        return f"{self.nose}, {self.alloy}, {self.velocity:g} m/s"


@dataclass(frozen=True)
class Experiment:
    """Depth (m), and whether it is "measured", "estimated" or "at least"."""

    depth: float
    kind: str

    def __str__(self) -> str:
        return {"at least": "perforated", "estimated": f"{self.depth * 1e2:.1f} cm (estimated)"}.get(
            self.kind, f"{self.depth * 1e2:.1f} cm")


def experiments() -> dict[Shot, Experiment]:
    """The twelve shots of experiments.csv."""
    with open(Path(__file__).with_name("experiments.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {Shot(row["nose"], row["target"].removeprefix("Al"), float(row["velocity_m_s"])):
            Experiment(1e-2 * float(row["depth_cm"]), row["depth_is"]) for row in rows}


def runs(directories: list[Path]) -> dict[str, dict[Shot, layout.Case]]:
    """The finished cases, by column and shot. Raises StudyError."""
    found: dict[str, dict[Shot, layout.Case]] = {}
    for directory in directories:
        for case in layout.read(directory).cases:
            shot = Shot.named(case.values.get("shot", ""))
            if shot is not None and case.status == layout.DONE:
                column = ", ".join(label for name, label in case.values.items() if name != "shot")
                found.setdefault(column, {})[shot] = case
    return found


def cell(case: layout.Case) -> str:
    """Depth (for a rod that perforated, its residual velocity) and loss of length."""
    told = case.summary
    loss = 100.0 * (1.0 - told["rod_length_m"] / told["rod_initial_length_m"])
    lost = f"{loss:.1f} %" if loss < 10.0 else f"{loss:.0f} %"
    if told.get("stop_reason", "").startswith("perforation"):
        return f"perforated at {told['rod_residual_velocity_m_s']:.0f} m/s, {lost}"
    return f"{told['penetration_depth_m'] * 1e2:.1f} cm, {lost}"


def table(found: dict[str, dict[Shot, layout.Case]]) -> list[str]:
    """Lines of Markdown."""
    measured = experiments()
    shots = sorted({shot for cases in found.values() for shot in cases}, key=lambda at: (at.nose, at.alloy, at.velocity))
    lines = ["| shot | experiment | " + " | ".join(found) + " |", "|---" * (len(found) + 2) + "|"]
    for shot in shots:
        cells = [cell(cases[shot]) if shot in cases else "" for cases in found.values()]
        lines.append(f"| {shot} | {measured.get(shot, '')} | " + " | ".join(cells) + " |")
    return lines


def listing(directories: list[Path]) -> list[str]:
    """Lines of Markdown: a table for each study, with a row for each case that is done. Raises StudyError."""
    lines = []
    for directory in directories:
        study = layout.read(directory)
        done = [case for case in study.cases if case.status == layout.DONE]
        lines += ["", f"{study.name}: {len(done)} of {len(study.cases)} runs.", "",
                  "| case | depth, loss of length | regime | time of flight, us | minutes |", "|---" * 5 + "|"]  # fmt: skip
        for case in done:
            told = case.summary
            words = [f"`{case.name}`", cell(case), told["regime"], f"{told['time_s'] * 1e6:.0f}", f"{told['wall_s'] / 60:.1f}"]
            lines.append("| " + " | ".join(words) + " |")
    return lines[1:]


def draw(found: dict[str, dict[Shot, layout.Case]]):
    """A matplotlib Figure with a panel for each alloy; markers are filled for hemispherical noses and open for ogival ones."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.6, 4.4), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, alloy in zip(figure.subplots(1, 2, sharey=True), ("5083", "7039"), strict=True):
        for number, (column, cases) in enumerate(found.items()):
            for nose, style in (("hemispherical", {}), ("ogival", {"markerfacecolor": "none", "linestyle": ":"})):
                there = sorted((shot for shot in cases if (shot.alloy, shot.nose) == (alloy, nose)), key=lambda at: at.velocity)
                there = [shot for shot in there if shot.velocity <= VELOCITIES[-1]]
                depths = [1e2 * cases[shot].summary["penetration_depth_m"] for shot in there]
                if there:
                    axes.plot([shot.velocity for shot in there], depths, marker="o", color=COLOURS[number % len(COLOURS)],
                              linewidth=1.2, label=column if nose == "hemispherical" else None, **style)  # fmt: skip
        for shot, experiment in experiments().items():
            if shot.alloy == alloy:
                axes.plot(shot.velocity, experiment.depth * 1e2, "^" if experiment.kind == "at least" else "s", markersize=9,
                          color="black", markerfacecolor="none" if shot.nose == "ogival" else "black", label="_")
        _theory(axes, alloy, found)
        axes.set_title(f"{alloy} aluminium")
        axes.set_xlabel("impact velocity [m/s]")
        axes.grid(alpha=0.3)
        axes.set_ylim(0.0, 60.0)
    axes.plot([], [], "ks", label="experiment (open: ogival)")
    figure.axes[0].set_ylabel("depth [cm]")
    axes.legend(fontsize=7, loc="upper left")
    return figure


def _theory(axes, alloy: str, found) -> None:
    """A rigid rod by `forrestal` and an eroding one by `tate`, on the deck of a hemispherical case."""
    cases = [case for column in found.values() for shot, case in column.items()
             if (shot.nose, shot.alloy) == ("hemispherical", alloy)]
    if not cases:
        return
    shot = model_deck.read(cases[0].directory / "deck.toml")
    for name, style in (("forrestal", "k--"), ("tate", "k-.")):
        case = models.resolve(models.named(name), models.Request(shot.rod, shot.target, geometry=shot.values))
        depths = [row["depth"] * 1e2 for row in case.rows(VELOCITIES.tolist())]
        axes.plot(VELOCITIES, depths, style, linewidth=0.8, label=f"model {name}")


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="+", type=Path)
    parser.add_argument("--figure", type=Path)
    parser.add_argument("--list", action="store_true", dest="every", help="list every finished case instead")
    given = parser.parse_args(arguments)
    try:
        if given.every:
            print("\n".join(listing(given.studies)))
            return 0
        found = runs(given.studies)
        if not found:
            print("these studies have no finished case of a shot", file=sys.stderr)
            return 2
        print("\n".join(table(found)))
        if given.figure:
            figures.save(draw(found), given.figure)
    except (StudyError, DeckError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
