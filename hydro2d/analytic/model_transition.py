"""The velocity at which a rod stops being rigid: predictions of all models next to brackets from experiments, CTH and runs.

The bracket of experiments follows from their shots by one rule: a rod that went deeper than the hydrodynamic limit
L sqrt(rho_p/rho_t) stayed rigid, any other did not. The bracket lies between the fastest rigid rod and the slowest other one.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hydro2d.analytic import model_deck, models
from hydro2d.analytic.model_materials import Given
from hydro2d.analytic.model_text import columns, given_data, shown
from hydro2d.files.shipped import problems_folder
from hydro2d.materials import library
from hydro2d.measure.regime import LEFT
from hydro2d.penetration import catalogue
from hydro2d.penetration.model import InputError, Model
from hydro2d.results import reading

STUDY = "cth_nose_shape"
RULE = "rigid where deeper than the hydrodynamic limit L sqrt(rho_p/rho_t)"
#: caliber-radius-head of the study's ogive, which gives the printed mass, 63 g, with the printed length
OGIVE_CRH = 2.5
#: name of the bracket of each kind in cth_predictions.csv
KINDS = {"cth": "the CTH study", "test": "tests at thinner plates"}


def hydrodynamic_limit(length: float, rod: library.Material, target: library.Material) -> float:
    """Depth in m that a rod of this length in m reaches at any velocity if it is consumed: L sqrt(rho_p/rho_t)."""
    return length * math.sqrt(rod.reference_density / target.reference_density)


@dataclass(frozen=True)
class Shot:
    """One experiment; SI. ``depth_is`` is "measured", "estimated" or "at least"."""

    number: str
    rod: str
    target: str
    nose: str
    velocity: float
    mass: float
    depth: float
    length: float
    diameter: float
    depth_is: str = "measured"

    @property
    def limit(self) -> float:
        """The hydrodynamic limit of its depth, m."""
        return hydrodynamic_limit(self.length, library.load(self.rod), library.load(self.target))

    @property
    def stayed_rigid(self) -> bool:
        """Whether the rod stayed rigid, by ``RULE``."""
        return self.depth > self.limit


@dataclass(frozen=True)
class Bracket:
    """A transition lies between these velocities in m/s; None is an open end."""

    name: str
    low: float | None
    high: float | None
    source: str

    def off(self, velocity: float) -> float:
        """How far a velocity lies above (positive) or below the bracket, m/s; 0 inside."""
        if self.high is not None and velocity > self.high:
            return velocity - self.high
        return min(velocity - self.low, 0.0) if self.low is not None else 0.0


@dataclass(frozen=True)
class Prediction:
    """The prediction of one model; ``velocity`` None without a ``note`` means that the rod is rigid at any velocity."""

    model: Model
    case: models.Case
    velocity: float | None
    note: str = ""

    @property
    def in_words(self) -> str:
        """The velocity, or why there is none."""
        if self.velocity == 0.0:
            return "none: the rod is weaker than the target"
        return self.note or "rigid at any velocity" if self.velocity is None else f"{self.velocity:.0f} m/s"

    @property
    def knows_nose(self) -> bool:
        """Whether the shape of the nose is among the inputs."""
        return any(entry.name.startswith("nose.") for entry in self.model.inputs)


def _rows(name: str) -> list[dict[str, str]]:
    """Rows of a table of the study, by column."""
    with open(problems_folder() / STUDY / name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def experiments() -> list[Shot]:
    """The shots of the study."""
    return [
        Shot(row["shot"], row["rod"], row["target"], row["nose"], float(row["velocity_m_s"]), 1e-3 * float(row["mass_g"]),
             1e-2 * float(row["depth_cm"]), 1e-2 * float(row["length_cm"]), 1e-2 * float(row["diameter_cm"]),
             row["depth_is"])
        for row in _rows("experiments.csv")
    ]


def between(name: str, rigid: Iterable[float], others: Iterable[float], source: str) -> Bracket:
    """The bracket from the fastest rod that stayed rigid to the slowest that did not."""
    return Bracket(name, max(rigid, default=None), min(others, default=None), source)


def brackets(rod: str, target: str, nose: str) -> list[Bracket]:
    """The brackets of the study for a rod, target and nose, by their names in the library; empty if there are none."""
    shots = [shot for shot in experiments() if (shot.rod, shot.target, shot.nose) == (rod, target, nose)]
    known = []
    if shots:
        rigid, others = ([shot.velocity for shot in shots if shot.stayed_rigid is word] for word in (True, False))
        numbers = ", ".join(shot.number for shot in shots)
        known.append(between("experiment", rigid, others, f"shots {numbers}; {RULE}"))
    for row in _rows("cth_predictions.csv"):
        if (row["rod"], row["target"], row["nose"]) == (rod, target, nose):
            low, high = (float(row[key]) if row[key] else None for key in ("low_m_s", "high_m_s"))
            known.append(Bracket(KINDS[row["kind"]], low, high, row["source"]))
    return known


def of_runs(directories: Sequence[Path], nose: str) -> tuple[Bracket, list[tuple[str, ...]]]:
    """The bracket of finished runs with this nose, and a line for each: name, rod, target, nose, velocity, regime.

    Raises ResultsError for a run that has not ended.
    """
    rigid, others, lines = [], [], []
    for directory in directories:
        run = reading.Results(directory)
        if run.summary.regime is None:
            raise reading.ResultsError(f"{directory}: the run has not ended and has no regime")
        shot = model_deck.shot(run.deck)
        regime = run.summary.regime
        counted = shot.nose == nose and regime != LEFT
        if counted:
            (rigid if regime == "rigid" else others).append(shot.velocity)
        words = (run.label, shot.rod.name, shot.target.name, shot.nose, f"{shot.velocity:g} m/s", regime)
        why = "other nose" if shot.nose != nose else "not followed to its end"
        lines.append((*words, "" if counted else f"{why}, not counted"))
    return between("hydro2d", rigid, others, f"{len(rigid) + len(others)} runs; rigid by their summaries"), lines


def with_transition() -> list[Model]:
    """Models that predict when a rod stops being rigid."""
    return [model for model in catalogue.MODELS.values() if model.transition is not None]


def geometry(rod: str, nose: str) -> dict[str, Given]:
    """Diameter, mass and nose of the study's rods, for comparisons that name none; empty for another rod."""
    shots = [shot for shot in experiments() if (shot.rod, shot.nose) == (rod, nose)]
    if not shots:
        return {}
    source = "the study's shots"
    values = {
        "rod.diameter": Given(shots[0].diameter, source),
        "rod.mass": Given(sum(shot.mass for shot in shots) / len(shots), f"{source}, mean"),
    }
    if nose == "ogival":
        values["nose.crh"] = Given(OGIVE_CRH, "assumed: tangent ogive of the study's mass and length")
    return values


def predict(model: Model, request: models.Request) -> Prediction:
    """The prediction of a model for a request. Raises InputError for impossible inputs."""
    case = models.resolve(model, request)
    try:
        return Prediction(model, case, case.transition())
    except InputError as error:
        return Prediction(model, case, None, str(error))


@dataclass(frozen=True)
class Comparison:
    """Predictions for a rod, target and nose, with known brackets."""

    title: str
    predictions: list[Prediction]
    brackets: list[Bracket]
    runs: list[tuple[str, ...]]

    def lines(self, inputs: bool = True) -> list[str]:
        """The table, the brackets, the runs and, if requested, all inputs, as text."""
        heads = ("model", "transition", *(f"from {entry.name}" for entry in self.brackets), "nose")
        lines = [self.title, "", *columns([heads, *map(self._row, self.predictions)])]
        if self.brackets:
            lines += ["", *columns((entry.name, extent(entry), entry.source) for entry in self.brackets)]
        if self.runs:
            lines += ["", "runs", *columns(self.runs)]
        return [*lines, "", "inputs", *columns(self._inputs())] if inputs else lines

    def _row(self, entry: Prediction) -> tuple[str, ...]:
        nose = "an input" if entry.knows_nose else "not an input"
        if entry.velocity is None:
            return entry.model.name, entry.in_words, *("" for _ in self.brackets), nose
        away = (distance(bracket.off(entry.velocity)) for bracket in self.brackets)
        return entry.model.name, entry.in_words, *away, nose

    def _inputs(self) -> list[tuple[str, ...]]:
        """All inputs of all models; if models differ, each value with its models."""
        users_of: dict[tuple[str, str, str], list[str]] = {}
        for entry in self.predictions:
            units_of = {each.name: each.unit for each in entry.model.inputs}
            for name, given in entry.case.inputs.items():
                users_of.setdefault((name, shown(given.value, units_of[name]), given.source), []).append(entry.model.name)
        names = [name for name, _, _ in users_of]
        return [(*key, ", ".join(users) if names.count(key[0]) > 1 else "") for key, users in sorted(users_of.items())]

    def data(self) -> dict:
        """The comparison for JSON."""
        return {
            "title": self.title,
            "models": [
                {"model": entry.model.name, "transition_velocity": entry.velocity, "note": entry.note,
                 "nose_counts": entry.knows_nose, "inputs": given_data(entry.case.inputs, entry.model)}
                for entry in self.predictions
            ],
            "brackets": [vars(entry) for entry in self.brackets],
            "runs": [list(line) for line in self.runs],
        }


def distance(off: float) -> str:
    """A distance from a bracket in words."""
    return "inside" if off == 0.0 else f"{abs(off):.0f} m/s {'above' if off > 0.0 else 'below'}"


def extent(bracket: Bracket) -> str:
    """A bracket in words."""
    if bracket.low is None or bracket.high is None:
        known = [f"{word} {end:g} m/s" for word, end in (("above", bracket.low), ("below", bracket.high)) if end is not None]
        return known[0] if known else "nothing known"
    if bracket.low > bracket.high:
        return f"none: rigid at {bracket.low:g} m/s, not at {bracket.high:g} m/s"
    return f"{bracket.low:g} to {bracket.high:g} m/s"


def compare(request: models.Request, nose: str, runs: Sequence[Path] = ()) -> Comparison:
    """The transitions of all models for a rod and a target; ``nose`` is the nose of the brackets and of the runs to include."""
    if request.rod is None or request.target is None:
        raise InputError("transition: a rod and a target are needed, by --rod and --target or by --deck")
    rod, target = request.rod.name, request.target.name
    if not request.geometry:
        request = replace(request, geometry=geometry(rod, nose))
    request = replace(request, settings={**request.settings, "nose.shape": nose})
    known, lines = brackets(rod, target, nose), []
    if runs:
        bracket, lines = of_runs(runs, nose)
        known.append(bracket)
    title = f"rod no longer rigid: {rod} into {target}, {nose} nose"
    return Comparison(title, [predict(model, request) for model in with_transition()], known, lines)
