"""Comparison of kept runs with every experiment, as the tables of docs/explanation/validation.md.

    python -m problems.validation.against_experiments

Prints three tables in Markdown: the sets, with their sources, the choices made and how to repeat them; the shots for which
nothing was chosen by looking at results; and those for which something was. All numbers come from the files in `results` next
to the studies.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import hydro2d
from problems import kept
from problems.cth_nose_shape import heads, members, rigid_rod
from problems.explosives import read as of_explosives
from problems.handbook import compare
from problems.long_rods import depths

HERE = Path(__file__).parent
PROBLEMS = HERE.parent


@dataclass(frozen=True)
class Set:
    """Experiments of one kind: name, source, the choices made, the command, whether nothing was chosen, and whether its runs
    count in experience.py."""

    name: str
    source: str
    chosen: str
    command: str
    predicted: bool = True
    studied: bool = True


SETS = (
    Set("tungsten into aluminium", "Scheffler, CTH nose-shape study, Table 2",
        "nothing: Steinberg and Guinan's law for the study's alloy, its fracture pressures, no friction, 8.5 cells",
        "sweep problems/cth_nose_shape/twelve_shots.toml"),
    Set("tungsten into aluminium, sintered alloy", "the same",
        "the rod's law: that of another alloy, one of four that were tried; density of the shots' rods",
        "sweep problems/cth_nose_shape/twelve_shots.toml", predicted=False),
    Set("tungsten into aluminium, 90W-7Ni-3Fe", "the same", "the same, another of the four",
        "sweep problems/cth_nose_shape/twelve_shots.toml", predicted=False),
    Set("tungsten into aluminium, Y925", "the same", "the same, the last of the four",
        "sweep problems/cth_nose_shape/twelve_shots.toml", predicted=False),
    Set("eroding rods", "Luk & Piekutowski, Int. J. Impact Engng 11 (1991) 323",
        "nothing: contact, the rod's fracture pressure, 6 cells", "sweep problems/validation/eroded_heads.toml"),
    Set("steel rods, 1.6 GPa", "Forrestal & Piekutowski, Int. J. Impact Engng 24 (2000) 57, as tabled by others",
        "the rod's yield stress, 1.6 GPa without hardening, and the plate's law, Steinberg and Guinan's, one of four",
        "sweep problems/validation/rigid_steel_rods.toml", predicted=False),
    Set("steel rods, fitted law", "the same",
        "nothing: the rod's law fitted to flow stresses of 4340, Rc 38, without looking at depths; Johnson and Cook's for 6061",
        "sweep problems/validation/steel_rods_fitted.toml"),
    Set("tungsten into armour steel", "Odermatt's fit to many shots, BHN 270, read in a public source",
        "nothing: 6.5 cells", "sweep problems/long_rods/velocities.toml"),
    Set("cylinder test", "Dobratz & Crawford, UCRL-52997 (1985), recalled", "nothing", "run problems/explosives/cylinder.toml"),
    Set("driven by an explosive", "Gurney's formula with the energies of the same handbook, recalled: a fit to many shots",
        "nothing", "run problems/explosives/sandwich.toml"),
    Set("blast in air", "Kingery and Bulmash's fit to many blasts in Swisdak's form, recalled",
        "nothing: cells of 25 mm, one run", "run problems/explosives/air_blast.toml", studied=False),
    Set("craters of aluminium balls", "NASA's equation, a fit to many shots (Cour-Palais 1987), with a Brinell hardness of 95",
        "nothing that is recorded: laws of the library, 8.5 cells, one run each", "run problems/hypervelocity/crater.toml",
        studied=False),
    Set("cone through 20 mm", "Borvik and others 2004, recalled: a limit of 249 m/s, with Recht and Ipson's formula",
        "nothing that is recorded: laws of the library, 10.5 cells, one run each", "run problems/perforation/cone.toml",
        studied=False),
    Set("striker bar", "elastic waves, exact", "nothing: contact, 5 cells, one run",
        "run problems/verification/striker_bar.toml", studied=False),
    Set("handbooks", "fits to experiments and theories: problems/handbook/results/expected.csv, written before the first run",
        "nothing: one run each", "run problems/handbook/bumper.toml", studied=False),
    Set("handbooks, decks changed", "the same",
        "after the first run: an empty bubble, four cells across the tube, a heavier wedge",
        "run problems/handbook/slam.toml", predicted=False, studied=False),
)

#: sets of which single_runs.csv has the shots
SINGLE = ("blast in air", "craters of aluminium balls", "cone through 20 mm", "striker bar")

#: metal that an explosive drives, by the deck of problems/explosives
DRIVEN = {"cylinder": "tube", "plate_push": "plate on a charge", "sandwich": "two plates around a charge"}


@dataclass(frozen=True)
class Row:
    """A shot: its set, its name, the measured value and its unit, and the values of the runs."""

    name: str
    shot: str
    measured: float | None
    unit: str
    computed: tuple[float, ...]
    said: str = ""
    digits: int = 1

    def __str__(self) -> str:
        values = [f"{value:.{self.digits}f}" for value in (min(self.computed), max(self.computed))] if self.computed else []
        middle = f"{median(self.computed):.{self.digits}f} {self.unit}".rstrip() if self.computed else ""
        spread = f" ({values[0]} to {values[1]}, {len(self.computed)} runs)" if len(self.computed) > 1 else ""
        given = "perforated" if self.measured is None else f"{self.measured:.{self.digits}f} {self.unit}".rstrip()
        difference = ""
        if self.measured is not None and self.computed and not self.said:
            difference = f"{round(100.0 * (median(self.computed) / self.measured - 1.0)):+d} %"
        return f"| {self.name} | {self.shot} | {given} | {self.said or middle + spread} | {difference} |"


def twelve(name: str, law: str) -> list[Row]:
    """The twelve shots with one law."""
    file = PROBLEMS / "cth_nose_shape/results/twelve_shots.csv"
    measured, rows = rigid_rod.experiments(), []
    by_shot = members.grouped(rigid_rod.read(file, heads.CELLS)).get(law, {})
    for shot, runs in sorted(by_shot.items(), key=lambda item: (item[0].nose, item[0].alloy, item[0].velocity)):
        experiment = measured[shot]
        through = sum(run.depth is None for run in runs)
        said = f"perforated in {through} of {len(runs)} runs" if through else ""
        depth = None if experiment.kind == "at least" else 1e2 * experiment.depth
        rows.append(Row(name, str(shot), depth, "cm", tuple(run.reach for run in runs), said))
    return rows


def eroding(name: str) -> list[Row]:
    """Luk and Piekutowski's rods, which fail by their fracture pressure."""
    return [Row(name, heads.SHOTS[run.labels["shot"]][0], heads.measured(run.labels["shot"]), "cm", (run.depth,))
            for run in rigid_rod.read(HERE / "results/eroded_heads.csv")
            if run.labels["failure"] == "fracture pressure" and run.depth is not None]


def steel(name: str, file: str, **labels: str) -> list[Row]:
    """Forrestal and Piekutowski's rods, of the runs with these labels."""
    measured = {round(experiment.velocity): 1e2 * experiment.penetration for path in sorted(HERE.glob("rigid_6061_*.toml"))
                if (experiment := hydro2d.Deck.from_file(path).experiment)}
    runs = [run for run in rigid_rod.read(HERE / "results" / file)
            if all(run.labels.get(axis) == label for axis, label in labels.items())]
    return [Row(name, f"{run.labels['shot']} m/s", measured[int(run.labels["shot"])], "cm", (run.depth,))
            for run in sorted(runs, key=lambda run: int(run.labels["shot"]))
            if int(run.labels["shot"]) in measured and run.depth is not None]


def armour(name: str) -> list[Row]:
    """Long rods, depth over length, against the fit."""
    rows = []
    kept = depths.read(PROBLEMS / "long_rods/results/velocities.csv")
    for run in sorted(kept, key=lambda run: (int(run.labels["L/D"]), run.velocity)):
        fit = depths.odermatt(run.velocity, float(run.labels["L/D"]), 270.0, *depths.DENSITIES)
        rows.append(Row(name, f"L/D {run.labels['L/D']}, {run.velocity:g} m/s", fit, "L", (run.ratio,), digits=2))
    return rows


def explosives(name: str) -> list[Row]:
    """Velocities of the wall of the cylinder test."""
    return [Row(name, f"{row['explosive']}, {row['quantity']}", *_of_explosive(row), digits=2)
            for row in of_explosives.kept() if row["quantity"].startswith("wall velocity")]


def gurney(name: str) -> list[Row]:
    """Final velocities of metal that an explosive drives."""
    return [Row(name, f"{DRIVEN[row['deck']]}, {row['explosive']}", *_of_explosive(row), digits=2)
            for row in of_explosives.kept() if row["quantity"] == "final velocity"]


def _of_explosive(row: dict[str, str]) -> tuple[float, str, tuple[float]]:
    """The expected value, its unit, and the value of the run."""
    return float(row["expected"]), row["unit"], (float(row["obtained"]),)


def single(name: str) -> list[Row]:
    """Shots that were run once."""
    columns = ("set", "shot", "unit", "measured", "computed", "digits")
    return [Row(name, row["shot"], float(row["measured"]), row["unit"], (float(row["computed"]),), digits=int(row["digits"]))
            for row in kept.rows(HERE / "single_runs.csv", columns) if row["set"] == name]


def handbooks(name: str, changed: bool) -> list[Row]:
    """The ten problems from handbooks: those whose deck was changed after the first run, or the others."""
    found = compare.obtained()
    return [Row(name, f"{row['deck']}, {row['quantity']}".replace("_", " "), float(row["expected"]), row["unit"],
                (float(found[row["deck"], row["quantity"]]["obtained"]),), digits=2)
            for row in compare.expected() if (row["deck"] in compare.CHANGED) == changed]


def rows() -> dict[str, list[Row]]:
    """The shots by set, in the order of SETS."""
    names = [each.name for each in SETS]
    laws = "Steinberg-Guinan", "Johnson-Cook, sintered", "Johnson-Cook, 90W", "Johnson-Cook, Y925"
    others = names[len(laws):]
    sets = (*map(twelve, names, laws), eroding(others[0]),
            steel(others[1], "rigid_steel_rods.csv", target="Steinberg-Guinan", rod="1.6 GPa"),
            steel(others[2], "steel_rods_fitted.csv", rod="fit, Rc 38"), armour(others[3]), explosives(others[4]),
            gurney(others[5]), *map(single, SINGLE), *map(handbooks, names[-2:], (False, True)))
    return dict(zip(names, sets, strict=True))


def tables() -> list[str]:
    """Lines of Markdown: the sets; the shots predicted; those for which something was chosen."""
    lines = ["| set | source | chosen | repeat with `hydro2d` |", "|---|---|---|---|"]
    lines += [f"| {each.name} | {each.source} | {each.chosen} | `{each.command}` |" for each in SETS]
    found = rows()
    for predicted in (True, False):
        lines += ["", "| set | shot | measured | computed | difference |", "|---|---|---|---|---|"]
        lines += [str(row) for each in SETS if each.predicted == predicted for row in found[each.name]]
    return lines


def main(arguments: list[str] | None = None) -> int:
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args(arguments)
    print("\n".join(tables()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
