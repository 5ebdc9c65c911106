"""Depths of tungsten rods in steel: the results of runs, how a depth builds up, and figures with Odermatt's fit and the models.

    python -m problems.long_rods.depths RESULTS [RESULTS ...] [--keep FILE] [--histories FILE] [--figure PATH]
    python -m problems.long_rods.depths HISTORIES --parts PATH --cases CASE [CASE ...]
    python -m problems.long_rods.depths --pages [--check]

RESULTS is the directory of a study, finished or not, or a file in `results`, which has the finished cases of an earlier study.
The table is in Markdown. `--keep` writes all cases into a CSV file and `--histories` (of directories alone) the velocities and
depth of the rods against time. `--figure` draws depth over length against velocity, with Odermatt's fit and the models of the
catalogue, and `--parts` draws some cases of a file that --histories wrote. `--pages` fills the tables of the README and of
docs/explanation/tungsten-into-steel.md from the kept results; with `--check` it writes nothing and fails if one is another.

The depth is the largest of the run: the target springs back by up to 1 % while the run ends. The *slope* is the depth gained
per length of rod worn away, taken while the rod is worn by 2 to 6 diameters. The *end* is the depth that the last 4 diameters
of the rod add, in diameters.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

import hydro2d
from problems import kept

HERE = Path(__file__).parent
PAGES = (HERE / "README.md", HERE.parents[1] / "docs" / "explanation" / "tungsten-into-steel.md")
STUDIES = ("velocities", "hardness", "meshes", "choices", "chance")
DECKS = {10: "rod_10.toml", 20: "rod_20.toml", 30: "rod_30.toml"}
#: hardness for which Odermatt's fit is compared with armour steel, whose own is not known
BRINELL = 270.0
#: cells across the radius of the rod in all decks, and so in the studies other than meshes.toml
CELLS = 6.5
#: densities of rod and target in all decks, kg/m^3
DENSITIES = (17600.0, 7850.0)
#: range of wear of the rod over which the slope is taken, and the length left when the end begins, in diameters
STEADY, LAST = (2.0, 6.0), 4.0
VELOCITIES = np.linspace(1000.0, 2000.0, 41)
#: models of the catalogue, and how they are drawn
MODELS = {"tate": "--", "walker-anderson": "-.", "anderson-riegel": ":"}
COLOURS = {10: "#1f4e79", 20: "#c26a1b", 30: "#4f7942"}
#: numbers of a case after its labels: unit and digits are in the name of the column and here
NUMBERS = {"velocity_m_s": 0, "depth_over_length": 4, "slope": 3, "end_over_diameter": 2, "u_m_s": 0, "v_m_s": 0,
           "left_over_length": 3, "hole_over_diameter": 2, "time_us": 1, "minutes": 1}
HISTORY = ("case", "time_us", "depth_mm", "length_mm", "tail_m_s")
#: time between two rows of kept histories, us
EVERY = 1.0


def odermatt(velocity: float, slenderness: float, brinell: float, rod_density: float, target_density: float) -> float:
    """Depth over length of a tungsten rod in thick steel by the fit of Lanz and Odermatt; m/s, kg/m^3.

    P/L = 0.921 coth(0.283 + 0.0656 L/D) sqrt(rho_p/rho_t) exp(-s/(rho_p v^2)), s = (138 - 0.100 BHN) BHN, with v in km/s, for a
    Brinell hardness of 200 to 600, L/D >= 4 and a density of the rod of 16.5 to 19.3 g/cm^3. Lanz & Odermatt, 13th Int. Symp.
    Ballistics (1992), with the coefficients of "Odermatt 2000".
    """
    strength = (138.0 - 0.100 * brinell) * brinell
    size = 0.921 / math.tanh(0.283 + 0.0656 * slenderness)
    return size * math.sqrt(rod_density / target_density) * math.exp(-strength * 1e6 / (rod_density * velocity**2))


@dataclass(frozen=True)
class Result:
    """A finished case: its name, its labels on the axes, its slenderness L/D, the numbers of ``NUMBERS``, and its method."""

    name: str
    labels: dict[str, str]
    slenderness: int
    numbers: dict[str, float]
    method: str

    @property
    def velocity(self) -> float:
        return self.numbers["velocity_m_s"]

    @property
    def ratio(self) -> float:
        return self.numbers["depth_over_length"]

    @property
    def cells(self) -> float:
        """Cells across the radius of the rod."""
        return float(self.labels.get("cells", str(CELLS)).split()[0])

    @property
    def others(self) -> str:
        """The labels of the case other than the velocity and L/D."""
        return ", ".join(label for axis, label in self.labels.items() if axis not in ("velocity", "L/D"))

    @property
    def row(self) -> dict[str, str]:
        texts = {name: f"{round(self.numbers[name], digits):.12g}" for name, digits in NUMBERS.items()}
        return {**self.labels, "slenderness": str(self.slenderness), **texts, "method": self.method, "case": self.name}


def measured(history: dict[str, np.ndarray], diameter: float) -> dict[str, float]:
    """Depth and its parts from the history of a run; lengths in m.

    ``slope`` is dP/d(wear), and ``u`` and ``v`` are the velocities of the interface and the tail, by straight lines through the
    rows at which the wear is within ``STEADY``; NaN for a rod that was not worn that far, and so is ``end``.
    """
    time, depth, tail = history["time"], history["penetration_depth_m"], history["rod_tail_velocity_m_s"]
    wear = history["rod_length_m"][0] - history["rod_length_m"]
    deepest = int(np.argmax(depth))
    steady = (wear >= STEADY[0] * diameter) & (wear <= STEADY[1] * diameter) & (np.arange(time.size) <= deepest)
    slope = u = v = end = math.nan
    if steady.sum() >= 4 and wear.max() >= STEADY[1] * diameter:
        slope = float(np.polyfit(wear[steady], depth[steady], 1)[0])
        u = float(np.polyfit(time[steady], depth[steady], 1)[0])
        v = float(tail[steady].mean())
    short = np.flatnonzero(history["rod_length_m"] <= LAST * diameter)
    if short.size and short[0] <= deepest:
        end = float(depth[deepest] - depth[short[0]]) / diameter
    return {"depth": float(depth[deepest]), "time": float(time[deepest]), "slope": slope, "u": u, "v": v, "end": end,
            "left": float(history["rod_length_m"][deepest])}


def read(path: Path) -> list[Result]:
    """The finished cases of the directory of a study, or of a file of results. Raises StudyError, OSError."""
    return kept.read(path, ("case", "slenderness", *NUMBERS, "method"), _kept, _of)


def _kept(row: dict[str, str]) -> Result:
    labels = kept.labels(row, ("slenderness", *NUMBERS, "method"))
    return Result(row["case"], labels, int(row["slenderness"]), {name: float(row[name]) for name in NUMBERS}, row["method"])


def _of(case: hydro2d.Case) -> Result:
    summary = case.summary
    diameter, length = 2.0 * summary.rod_initial_radius_m, summary.rod_initial_length_m
    if "velocity" not in case.values or summary.crater is None:
        raise hydro2d.StudyError(f"{case.name}: its study has no axis of the velocity, or it made no hole")
    velocity = hydro2d.to_si(case.values["velocity"], "m/s")
    parts = measured(hydro2d.open_run(case.directory).history, diameter)
    numbers = (velocity, parts["depth"] / length, parts["slope"], parts["end"], parts["u"], parts["v"], parts["left"] / length,
               summary.crater.mean_diameter_m / diameter, 1e6 * parts["time"], summary.wall_s / 60.0)
    return Result(case.name, case.values, round(length / diameter), dict(zip(NUMBERS, numbers, strict=True)),
                  summary.method)


def keep(results: Sequence[Result], path: Path) -> None:
    """Writes a file of results. Raises OSError."""
    axes = dict.fromkeys(axis for result in results for axis in result.labels)
    kept.write(path, [*axes, "slenderness", *NUMBERS, "method", "case"], (result.row for result in results))


def keep_histories(directories: Sequence[Path], path: Path) -> None:
    """Writes depth, length and velocity of the tail of every finished case against time, a row every ``EVERY`` us."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(HISTORY)
        cases = (case for each in directories for case in hydro2d.open_study(each).cases)
        for case in (case for case in cases if case.status == "done"):
            history = hydro2d.open_run(case.directory).history
            time = 1e6 * history["time"]
            for n in np.searchsorted(time, np.arange(0.0, time[-1], EVERY)):
                table.writerow([case.name, f"{time[n]:.2f}", f"{1e3 * history['penetration_depth_m'][n]:.3f}",
                                f"{1e3 * history['rod_length_m'][n]:.3f}", f"{history['rod_tail_velocity_m_s'][n]:.1f}"])


def table(results: Sequence[Result]) -> list[str]:
    """Lines of Markdown: a case in each row, in the order of the other labels, L/D and velocity."""
    lines = ["| case | L/D | velocity | P/L | slope | end | u, v | left | hole | Odermatt |", "|---" * 10 + "|"]
    labels = list(dict.fromkeys(each.others for each in results))
    for each in sorted(results, key=lambda each: (labels.index(each.others), each.slenderness, each.velocity)):
        n = each.numbers
        label = (each.others or "armour steel") + (f", member {each.name[-1]}" if each.name[-3:-1] == "_m" else "")
        fit = odermatt(each.velocity, each.slenderness, brinell(each), *DENSITIES)
        lines.append(
            f"| {label} | {each.slenderness} | {each.velocity:g} m/s | {each.ratio:.3f} | {_number(n['slope'], 2)} | "
            f"{_number(n['end_over_diameter'], 1, ' D')} | {_number(n['u_m_s'], 0)}, {_number(n['v_m_s'], 0)} m/s | "
            f"{n['left_over_length']:.0%} | {n['hole_over_diameter']:.1f} D | {fit:.2f} ({each.ratio / fit - 1.0:+z.0%}) |")
    return lines


def matrix(results: Sequence[Result], heads: str) -> list[str]:
    """Lines of Markdown: depth over length by velocity, with that of Odermatt's fit in brackets; a row for each other label.

    heads : the head of the column of labels
    """
    speeds = sorted({each.velocity for each in results})
    cells = {(each.others or f"L/D = {each.slenderness}", each.velocity): each for each in results}
    columns = " | ".join(f"{1e-3 * speed:g} km/s" for speed in speeds)
    lines = [f"| {heads} | {columns} |", "|---" * (len(speeds) + 1) + "|"]
    for label in dict.fromkeys(label for label, _ in cells):
        lines.append(f"| {label} | " + " | ".join(_with_fit(cells.get((label, speed))) for speed in speeds) + " |")
    return lines


def _with_fit(result: Result | None) -> str:
    if result is None:
        return ""
    return f"{result.ratio:.2f} ({odermatt(result.velocity, result.slenderness, brinell(result), *DENSITIES):.2f})"


def of_study(name: str) -> list[Result]:
    """The kept results of a study. Raises StudyError, OSError."""
    return read(HERE / "results" / f"{name}.csv")


def _cases_of(name: str) -> list[str]:
    return table(of_study(name))


def _matrix_of(name: str, heads: str) -> list[str]:
    return matrix(of_study(name), heads)


#: the tables of the pages by the name of their place
TABLES = {name: partial(_cases_of, name) for name in STUDIES} | {
    f"{name}-by-velocity": partial(_matrix_of, name, heads)
    for name, heads in (("velocities", "rod"), ("hardness", "steel"), ("choices", "choice"), ("meshes", "cells"))}


def brinell(result: Result) -> float:
    """Brinell hardness of the target: that of its label, by ASTM E140 for a Rockwell hardness, else ``BRINELL``."""
    label = result.labels.get("steel", "")
    known = {"fit Rc 32": 301.0, "fit Rc 38": 353.0}
    return known.get(label, float(label.removeprefix("BHN ")) if label.startswith("BHN ") else BRINELL)


def _number(value: float, digits: int, unit: str = "") -> str:
    return "-" if math.isnan(value) else f"{value:.{digits}f}{unit}"


def curve(name: str, slenderness: int, velocities: Sequence[float]) -> list[float]:
    """Depth over length by a model of the catalogue, for the rod and target of the deck.

    walker-anderson has the effective flow stress of the target that anderson-riegel computes from Johnson and Cook's law: the
    latter's coefficients come from the former's depths with that stress.
    """
    deck = hydro2d.Deck.from_file(HERE / DECKS[slenderness])
    target = deck.materials[deck.body_named(deck.penetration.target).material]
    law, heat = target.strength.values, target.eos.values["specific_heat"]
    keys = {"a": "yield_stress", "b": "hardening", "n": "hardening_exponent", "c": "rate_coefficient", "m": "thermal_exponent"}
    settings = {f"target.johnson_cook_{key}": law[word] for key, word in keys.items()}
    settings |= {"target.melt_temperature": law["melt_temperature"], "target.specific_heat": heat}
    speeds = [float(velocity) for velocity in velocities]
    by_curve = hydro2d.penetration_model("anderson-riegel", deck, settings)
    rows = by_curve.rows(speeds)
    if name != by_curve.model.name:
        stress = {"target.strength": rows[0]["effective_flow_stress"]} if name == "walker-anderson" else {}
        rows = hydro2d.penetration_model(name, deck, stress).rows(speeds)
    return [float(row["depth_over_length"]) for row in rows]


def draw(results: Sequence[Result]):
    """A matplotlib Figure: depth over length against velocity, a panel for each L/D that was run."""
    lengths = sorted({each.slenderness for each in results})
    figure, (panels,) = hydro2d.new_figure(max(1.0 + 3.2 * len(lengths), 6.4), 4.4, 1, len(lengths), sharey=True)
    for axes, ratio in zip(panels, lengths, strict=True):
        low, middle, high = ([odermatt(v, ratio, each, *DENSITIES) for v in VELOCITIES] for each in (350.0, BRINELL, 230.0))
        axes.fill_between(VELOCITIES, low, high, color="0.85", label="Odermatt's fit, BHN 230 to 350")
        axes.plot(VELOCITIES, middle, "k-", lw=1, label=f"the same, BHN {BRINELL:g}")
        for name, style in MODELS.items():
            axes.plot(VELOCITIES, curve(name, ratio, VELOCITIES), style, color="0.4", lw=1, label=f"model {name}")
        _runs(axes, [each for each in results if each.slenderness == ratio])
        axes.set_title(f"L/D = {ratio}", fontsize="medium")
        axes.set_xlabel("impact velocity [m/s]")
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("depth over length of the rod")
    figure.legend(*panels[0].get_legend_handles_labels(), fontsize="x-small", loc="outside lower center", ncols=3)
    return figure


def _runs(axes, results: Sequence[Result]) -> None:
    """Marks for the runs, a colour for each label; lines through three velocities and more."""
    labels = list(dict.fromkeys(each.others for each in results))
    for number, label in enumerate(labels):
        own = sorted((each.velocity, each.ratio) for each in results if each.others == label)
        shade = f"C{number}"
        form = "o-" if len(own) > 2 else "o"
        axes.plot(*zip(*own, strict=True), form, color=shade, ms=4, lw=1.2, label=label or "armour steel")


def draw_parts(path: Path, cases: Sequence[str]):
    """A matplotlib Figure of some cases of a file of histories: velocities of interface and tail, and depth against wear.

    Raises StudyError for a case that the file does not have.
    """
    rows = kept.rows(path, HISTORY)
    figure, ((left, right),) = hydro2d.new_figure(8.4, 3.8, 1, 2)
    for number, case in enumerate(cases):
        own = [row for row in rows if row["case"] == case]
        if not own:
            known = ", ".join(dict.fromkeys(row["case"] for row in rows))
            raise hydro2d.StudyError(f"{path}: has no case {case} (has: {known})")
        time, depth, length, tail = (np.array([float(row[name]) for row in own]) for name in HISTORY[1:])
        u = np.gradient(depth, time) * 1e3
        left.plot(time, tail, "-", color=f"C{number}", lw=1.2)
        left.plot(time, u, "--", color=f"C{number}", lw=1.2)
        right.plot((length[0] - length) / length[0], depth / length[0], "-", color=f"C{number}", lw=1.2, label=case)
    left.set(xlabel="time [us]", ylabel="velocity [m/s]", ylim=(0.0, None))
    right.set(xlabel="wear of the rod over its length", ylabel="depth over length")
    left.set_title("tail (lines) and interface (dashed)", fontsize="medium")
    right.legend(fontsize="x-small")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    return figure


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="*", type=Path)
    parser.add_argument("--keep", type=Path, metavar="FILE", help="write all cases to a CSV file")
    parser.add_argument("--histories", type=Path, metavar="FILE", help="write the histories of all cases to a CSV file")
    parser.add_argument("--figure", type=Path, help="draw depth against velocity")
    parser.add_argument("--parts", type=Path, help="draw the histories of --cases")
    parser.add_argument("--cases", nargs="+", default=[], metavar="CASE")
    parser.add_argument("--pages", action="store_true", help="fill the tables of the pages")
    parser.add_argument("--check", action="store_true", help="with --pages: write nothing, and fail if a table is another")
    given = parser.parse_args(arguments)
    try:
        if given.pages:
            return kept.fill(PAGES, TABLES, given.check)
        if given.parts:
            if len(given.results) != 1 or not given.results[0].is_file() or not given.cases:
                raise hydro2d.StudyError("--parts draws --cases of one file that --histories wrote")
            hydro2d.save_figure(draw_parts(given.results[0], given.cases), given.parts)
            return 0
        results = list({result.name: result for path in given.results for result in read(path)}.values())
        if not results:
            raise hydro2d.StudyError("there is no finished case")
        print("\n".join(table(results)))
        if given.keep:
            keep(results, given.keep)
        if given.histories:
            keep_histories([path for path in given.results if path.is_dir()], given.histories)
        if given.figure:
            hydro2d.save_figure(draw(results), given.figure)
    except (hydro2d.Error, ValueError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
