"""The axes of a report's figures: responses of the runs, and varied quantities, by name and in the reader's units."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from hydro2d.base.errors import unknown
from hydro2d.base.units import COMMON, reader_unit
from hydro2d.measure.summary import Summary
from hydro2d.output.history import unit
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE
from hydro2d.study.records.differences import flatten, text
from hydro2d.study.records.record import Record, is_number
from hydro2d.study.records.study_directory import Axis, Study

DEPTH, RESIDUAL, IMPACT = "penetration_depth_m", "rod_residual_velocity_m_s", "velocity"
LENGTH_RATIO, RADIUS_RATIO = "rod_length_ratio", "rod_radius_ratio"
#: responses of decks without a projectile, of their first body
OF_BODY = ("velocity_m_s", "z_max_m")
#: numbers of the outcome, by their names in figures and by their own
OF_OUTCOME = {DEPTH: "depth_m", RESIDUAL: "residual_velocity_m_s", LENGTH_RATIO: "length_ratio", RADIUS_RATIO: "radius_ratio"}
OF_OUTCOME |= {name: name for name in OF_OUTCOME.values()}
#: the name of each case, if nothing else is varied
CASE = "case"
#: lengths of a study are depths, which are given in cm
LENGTH = ("cm", 1e2)
TITLES = {
    DEPTH: "depth", RESIDUAL: "residual velocity", "rod_tail_velocity_m_s": "tail velocity",
    "rod_length_m": "projectile length",
    LENGTH_RATIO: "final / initial length", RADIUS_RATIO: "largest / initial radius",
}
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([^\d\s].*?)?\s*$")
_ENDING = re.compile(r"_(kg_m3|J_kg|m_s|N_s|kg|Pa|K|J|s|m2|m3|m)$")


@dataclass(frozen=True)
class Response:
    """A number of each run: its name, its title with the unit, the unit, and the factor from SI to it."""

    name: str
    title: str
    unit: str
    factor: float

    def value(self, record: Record) -> float | None:
        """The value for a run in the reader's unit; None if it has none."""
        number = raw(record, self.name)
        return None if number is None else number * self.factor


@dataclass(frozen=True)
class Variable:
    """Something that is varied. ``values`` by case, numbers or words; ``order`` of the words, None for numbers.

    impact : whether it is the impact velocity, in m/s
    """

    name: str
    title: str
    values: Mapping[str, float | str]
    order: tuple[str, ...] | None = None
    impact: bool = False

    def value(self, record: Record) -> float | str | None:
        """The value for a run; None if it has none."""
        return self.values.get(record.case.name)


@dataclass(frozen=True)
class Choice:
    """Choice of figures: responses ``y`` over ``x``, a series for each combination of ``by``, None: of all else that varies."""

    x: Variable
    y: tuple[Response, ...]
    by: tuple[Variable, ...] | None = None


def choose(study: Study, records: Sequence[Record], x: str | None = None, y: Sequence[str] = (),
           by: Sequence[str] = ()) -> Choice:
    """Resolves the names, with sensible defaults. Raises StudyError for an unknown name."""
    names = y or _usual_responses(records)
    known = numbers(records)
    for name in y:
        if name not in known and name not in _listed():
            raise StudyError(f"--y: {unknown('response', name, known or _listed())}")
    chosen = variable(study, records, x, "--x") if x else usual_variable(study, records)
    split = tuple(variable(study, records, name, "--by") for name in by) if by else None
    return Choice(chosen, tuple(response(name) for name in dict.fromkeys(names)), split)


def response(name: str) -> Response:
    """A response by its name in summary.json or in cases.csv."""
    word, factor = readers(name)
    return Response(name, title(name) + (f" [{word}]" if word else ""), word, factor)


def readers(name: str) -> tuple[str, float]:
    """The reader's unit of a quantity, empty for a plain number, and the factor from SI to it."""
    si = unit(name)
    return LENGTH if si == "m" else ("", 1.0) if si == "1" else reader_unit(si)


def title(name: str) -> str:
    """A quantity in words, without its unit."""
    name = f"projectile_{name[4:]}" if name.startswith("rod_") and name not in TITLES else name
    return TITLES.get(name) or _ENDING.sub("", name).replace("_", " ").replace(".", " ")


def raw(record: Record, name: str) -> float | None:
    """A number of a run in SI. Some depths are bounds (`Outcome.depth_is`); a stopped projectile has zero residual velocity."""
    number = record.outcome[OF_OUTCOME[name]] if name in OF_OUTCOME else record.numbers.get(name)
    return number if number is not None and math.isfinite(number) else None


def numbers(records: Sequence[Record]) -> list[str]:
    """Names of all numbers that at least one run has."""
    return sorted({name for record in records for name in record.numbers})


def _listed() -> list[str]:
    """Numbers that every summary of a projectile has, for studies without one."""
    return [each.name for each in Summary.listed() if each.number and not any(part.isupper() for part in each.name.split("."))]


def _usual_responses(records: Sequence[Record]) -> list[str]:
    """Depth of projectiles, and the residual velocity if some perforate; else velocity and extent of the first body."""
    if any(record.setup for record in records):
        return [DEPTH, *([RESIDUAL] if any(record.perforated for record in records) else [])]
    body = next((record.body for record in records if record.body), None)
    return [f"bodies.{body}.{name}" for name in OF_BODY] if body else [DEPTH]


def is_velocity(axis: Axis) -> bool:
    """Whether an axis is the velocity of a body."""
    return axis.key is not None and axis.key.startswith("body.") and axis.key.endswith(".velocity")


def usual_variable(study: Study, records: Sequence[Record]) -> Variable:
    """The impact velocity if it varies, else the first numeric axis, else the first axis; without axes the case.

    A sample without other axes is drawn against the first of its inputs that is a number. At one velocity the cases are drawn
    side by side, since all marks would otherwise lie above one another.
    """
    speeds = {record.velocity for record in records} - {None}
    axes = [of_axis(axis, study) for axis in study.axes if len(axis.values) > 1 and not axis.is_of_points]
    if len(speeds) > 1 or len(records) == 1 and speeds and not axes:
        return impact(records)
    numeric = [axis for axis in axes if axis.order is None]
    return (numeric or axes or [_first_input(study, records) or _cases(records)])[0]


def _first_input(study: Study, records: Sequence[Record]) -> Variable | None:
    """The first input of a sample that is a number; None without a sample, or if no deck of the runs has such a key."""
    numbers = [each.key for each in study.sample.inputs if each.kind != CHOICE] if study.sample else []
    flat = _flat(records) if numbers else {}
    return next((_of_key(key, flat) for key in numbers if any(key in deck for deck in flat.values())), None)


def _flat(records: Sequence[Record]) -> dict[str, dict[str, object]]:
    """The decks of the runs, by case, as values by key."""
    return {record.case.name: flatten(record.deck) for record in records if record.deck}


def variable(study: Study, records: Sequence[Record], name: str, option: str) -> Variable:
    """An axis, the impact velocity, a deck key or a number of the runs, by its name. Raises StudyError."""
    axes = {axis.name: axis for axis in study.axes}
    with_velocity = any(record.velocity is not None for record in records)
    axis = axes.get(name)
    if with_velocity and (is_velocity(axis) if axis else name == IMPACT):
        return impact(records)
    if axis is not None:
        return of_axis(axis, study)
    flat = _flat(records)
    keys = {key for deck in flat.values() for key in deck}
    if name in keys:
        return _of_key(name, flat)
    known = numbers(records)
    if name in known:
        quantity = response(name)
        values = {each.case.name: quantity.value(each) for each in records}
        return Variable(name, quantity.title, {case: value for case, value in values.items() if value is not None})
    allowed = [*axes, *([IMPACT] if with_velocity else []), *known, *keys]
    raise StudyError(f"{option}: {unknown('axis, deck key or number of the runs', name, dict.fromkeys(allowed))}")


def impact(records: Sequence[Record]) -> Variable:
    """The impact velocity."""
    values = {record.case.name: record.velocity for record in records if record.velocity is not None}
    return Variable(IMPACT, "impact velocity [m/s]", values, impact=True)


def _cases(records: Sequence[Record]) -> Variable:
    names = {record.case.name: record.case.group for record in records}
    return Variable(CASE, CASE, names, tuple(dict.fromkeys(names.values())))


def combinations(study: Study, records: Sequence[Record]) -> Variable | None:
    """The combinations of the axes of a study in words, in the order of its cases; None if no axis varies among the runs."""
    axes = [axis for axis in study.axes if not axis.is_of_points
            and len({record.case.values.get(axis.name) for record in records}) > 1]
    if not axes:
        return None
    words = {record.case.name: ", ".join(axis.said(record.case.values.get(axis.name, "")) for axis in axes)
             for record in records}
    return Variable(CASE, ", ".join(axis.name for axis in axes), words, tuple(dict.fromkeys(words.values())))


def of_axis(axis: Axis, study: Study) -> Variable:
    """An axis of a study: numbers if all its labels are numbers of one quantity, else words."""
    labels = {case.name: case.values[axis.name] for case in study.cases if axis.name in case.values}
    parsed = _in_one_unit(axis.values)
    if parsed is None:
        return Variable(axis.name, axis.name, labels, axis.values)
    word, numbers = parsed
    values = {case: numbers[label] for case, label in labels.items() if label in numbers}
    return Variable(axis.name, axis.name + (f" [{word}]" if word else ""), values)


def _in_one_unit(labels: Sequence[str]) -> tuple[str, dict[str, float]] | None:
    """Unit and numbers of labels such as "2 mm", in their own unit if it is the same for all, else in SI; None for words."""
    matches = {label: _QUANTITY.match(label) for label in labels}
    if not all(matches.values()):
        return None
    words = {match[2] or "" for match in matches.values()}
    if len(words) == 1 and (words <= {""} or words <= set(COMMON)):
        return words.pop(), {label: float(match[1]) for label, match in matches.items()}
    si = {COMMON[word][0] if word in COMMON else None for word in words}
    if len(si) > 1 or None in si:
        return None
    return si.pop(), {label: float(f"{float(match[1]) * COMMON[match[2]][1]:.12g}") for label, match in matches.items()}


def _of_key(key: str, decks: Mapping[str, Mapping[str, object]]) -> Variable:
    """A key of decks by case: numbers in SI, else words in the order in which they occur."""
    values = {case: deck[key] for case, deck in decks.items() if deck.get(key) is not None}
    if all(is_number(value) for value in values.values()):
        return Variable(key, f"{key} (SI)", {case: float(value) for case, value in values.items()})
    words = {case: text(value) for case, value in values.items()}
    return Variable(key, key, words, tuple(dict.fromkeys(words.values())))
