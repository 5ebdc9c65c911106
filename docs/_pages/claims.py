"""What pages claim of the repository and of its kept results, for the sentences of docs/quoted.toml."""

from __future__ import annotations

import functools
import math
import sys
from collections.abc import Collection
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import hydro2d
from _pages import materials
from hydro2d.output import ending
from hydro2d.penetration import catalogue
from problems.cth_nose_shape import members, pages, rigid_rod
from problems.perforation import limits
from problems.validation import against_experiments

if TYPE_CHECKING:
    import pandas

    from hydro2d.results.reading import Results

WORDS = "none one two three four five six seven eight nine ten eleven twelve".split()


def words(numbers: Collection[int]) -> str:
    """Numbers up to twelve in words: "ten", or "five or six" where they differ; "five to seven" of more than two."""
    least, most = min(numbers), max(numbers)
    if least == most:
        return WORDS[least]
    return f"{WORDS[least]} {'or' if most == least + 1 else 'to'} {WORDS[most]}"


# tables of runs


def rows(table: pandas.DataFrame, *labels: str) -> pandas.DataFrame:
    """The members of the case of a study that has these labels on its axes, in their order."""
    for axis, label in zip(table.columns, labels, strict=False):
        table = table[table[axis] == label]
    return table.sort_index(level="member")


def depths(table: pandas.DataFrame, *labels: str) -> str:
    """Depths of a case's members in cm: "46.3, 46.5"."""
    return ", ".join(f"{100.0 * depth:.1f}" for depth in rows(table, *labels)["depth_m"])


def depth(table: pandas.DataFrame, *labels: str) -> float:
    """Depth of a case's unchanged run, cm."""
    return 100.0 * rows(table, *labels)["depth_m"].iloc[0]


def lost(table: pandas.DataFrame, *labels: str) -> float:
    """Length that the rod of a case's unchanged run has lost, per cent."""
    return 100.0 * (1.0 - rows(table, *labels)["length_ratio"].iloc[0])


def apart(table: pandas.DataFrame) -> float:
    """The difference of the largest and the least depth, per cent of the median."""
    return 100.0 * (table["depth_m"].max() - table["depth_m"].min()) / table["depth_m"].median()


# runs


def mesh_z(run: Results) -> tuple[float, float]:
    """Where the mesh begins and ends along z in the last state, m."""
    z = run.dump().z_edges
    return float(z[0]), float(z[-1])


def predicted_end(run: Results, time: float) -> float:
    """The end, in s, that `hydro2d status` predicted when the run had got to this time in s."""
    upto = run.history["time"] <= time
    end = ending.first(run.stop, {name: column[upto] for name, column in run.history.items()})
    assert end is not None, run.directory
    return end.time


# the twelve shots, by the law of strength of their rods


@functools.cache
def twelve() -> dict[str, tuple[members.Score, dict]]:
    """The score of every law on the usual mesh, and its runs by shot."""
    runs = rigid_rod.read(pages.RESULTS / "twelve_shots.csv", pages.USUAL)
    found = {law: (members.score(cases), cases) for law, cases in members.grouped(runs).items()}
    return {law: (score, cases) for law, (score, cases) in found.items() if score}


def laws() -> int:
    """Laws with which all shots were run."""
    return sum(len(score.shots) == shots() for score, _ in twelve().values())


def shots() -> int:
    """Shots that were measured."""
    return len(rigid_rod.experiments())


def as_seen() -> list[int]:
    """Shots that end as in the experiment, rigid or eroded, by the law."""
    return [len(score.sure) for score, _ in twelve().values()]


def aimed() -> list[int]:
    """Shots whose depth is within the aim, by the law."""
    return [len(score.aimed) for score, _ in twelve().values()]


def through() -> list[int]:
    """Shots that end as seen but perforate a plate that stopped the rod, by the law."""
    stopped = {shot for shot, told in rigid_rod.experiments().items() if told.kind != "at least"}

    def most_go_through(runs: list[rigid_rod.Result]) -> bool:
        return 2 * sum(run.depth is None for run in runs) >= len(runs)

    return [sum(most_go_through(cases[shot]) for shot in stopped & set(score.sure)) for score, cases in twelve().values()]


# runs against measurements


@functools.cache
def differences() -> list[float]:
    """Computed over measured values less one, of all comparisons for which nothing was chosen by looking at results."""
    found = against_experiments.rows()
    rows = [row for each in against_experiments.SETS if each.predicted for row in found[each.name]]
    return [median(row.computed) / row.measured - 1.0 for row in rows if row.measured and row.computed and not row.said]


def half_within() -> float:
    """The size of the differences, in per cent, that half of them do not exceed."""
    return 100.0 * median(map(abs, differences()))


def deepest() -> float:
    """The largest ratio of the depths of computed and measured rods of the twelve shots, without constants of another alloy."""
    rows = against_experiments.rows()[against_experiments.SETS[0].name]
    return max(median(row.computed) / row.measured for row in rows if row.measured and not row.said)


# the conical rod of problems/perforation


@functools.cache
def cone(velocity: float) -> float:
    """Velocity left behind the plate at a striking velocity, m/s, by the kept run of the deck as it stands."""
    runs = hydro2d.runs(limits.HERE / "results" / "limits_cone.csv")
    (left,) = runs[(runs["plate"] == "as it stands") & (runs["velocity"] == f"{velocity:g} m/s")]["residual_velocity_m_s"]
    return float(left)


def cone_limit() -> float:
    """The measured ballistic limit, m/s."""
    (limit,) = (each.limit for each in limits.measured() if each.deck == "cone")
    return limit


def cone_measured(velocity: float) -> float:
    """Velocity left by the formula of Lambert and Jonas, exponent 2, with the measured limit, m/s."""
    return math.sqrt(velocity**2 - cone_limit() ** 2)


# what there is


def analytic_models() -> int:
    """Analytic penetration models."""
    return len(catalogue.MODELS)


def library_numbers() -> int:
    """Numbers of the material library, without its variants and defaults of models."""
    return materials.counts().total()


def recalled() -> int:
    """Those of them that were quoted from memory."""
    return materials.counts()["recalled"]
