"""The output of `hydro2d model`: lists, pages, results, tables."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from hydro2d.analytic.model_materials import Given
from hydro2d.analytic.models import VELOCITY, Case
from hydro2d.base import units
from hydro2d.base.formats import in_shell
from hydro2d.files.whole import replacing
from hydro2d.penetration import catalogue
from hydro2d.penetration.inputs import FROM_LIBRARY
from hydro2d.penetration.model import Input, Model, Value

#: units of quantities typed in commands, by SI unit
TYPED = {"m": "mm", "kg": "g", "Pa": "MPa"}

def shown(value: Value, unit: str) -> str:
    """A value with its unit; a word as it is."""
    if value is None:
        return "not given"
    return value if isinstance(value, str) else units.show(value, unit, digits=6)


def columns(rows: Iterable[Sequence[str]], indent: str = "  ") -> list[str]:
    """Rows of text in aligned columns."""
    rows = list(rows)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [(indent + "  ".join(map(str.ljust, row, widths))).rstrip() for row in rows]


def overview() -> str:
    """Every model with its title."""
    lines = columns((model.name, model.title) for model in catalogue.MODELS.values())
    ends = "`hydro2d model NAME` explains one; `hydro2d model transition` compares their limits for rigid rods."
    return "\n".join([*lines, "", ends])


def default(entry: Input) -> str:
    """The default of an input in words."""
    if entry.required:
        return "material" if from_library(entry) else "required"
    return "none" if entry.default is None else shown(entry.default, entry.unit)


def from_library(entry: Input) -> bool:
    """Whether the material library gives this input."""
    side, _, last = entry.name.partition(".")
    return side in ("rod", "target") and last in FROM_LIBRARY


def meaning(entry: Input) -> str:
    """The description of an input, with its choices."""
    return entry.description + (f": {', '.join(entry.choices)}" if entry.choices else "")


def example_command(model: Model) -> str:
    """A command that shows the model at its example."""
    example = model.example
    words = ["hydro2d", "model", model.name]
    words += [word for side in ("rod", "target") for word in (f"--{side}", getattr(example, side)) if getattr(example, side)]
    words += ["--velocity", f"{example.velocity:g}m/s"]
    for name, value in example.values.items():
        if value is not None:
            unit = next(entry.unit for entry in model.inputs if entry.name == name)
            words += ["--set", f"{name}={value if isinstance(value, str) else _typed(value, unit)}"]
    return in_shell(*words)


def _typed(value: float, unit: str) -> str:
    """A quantity as typed in a command: a length in mm, a mass in g, a stress in MPa."""
    name = TYPED.get(unit, "" if unit == "1" else unit)
    return f"{value / units.COMMON[name][1] if unit in TYPED else value:.6g}{name}"


def page(model: Model) -> str:
    """Source, validity, inputs, outputs and an example of a model."""
    inputs = [(entry.name, entry.symbol, entry.unit or "word", default(entry), meaning(entry)) for entry in model.inputs]
    outputs = [(entry.name, entry.symbol, entry.unit or "word", "", entry.description) for entry in model.outputs]
    lines = [f"{model.name} (penetration model): {model.title}", "", f"Source: {model.source}", f"Validity: {model.validity}"]
    if model.transition is not None:
        lines.append("It gives the velocity at which a rod stops being rigid: `hydro2d model transition`.")
    lines += ["", "inputs", *columns([("name", "symbol", "unit", "default", "meaning"), *inputs])]
    lines += ["", "outputs", *columns([("name", "symbol", "unit", "", "meaning"), *outputs])]
    return "\n".join([*lines, "", "example", f"  {example_command(model)}"])


def inputs(case: Case) -> list[str]:
    """Every input with its value and source."""
    units_of = {entry.name: entry.unit for entry in case.model.inputs}
    return columns((name, shown(given.value, units_of[name]), given.source) for name, given in case.inputs.items())


def report(case: Case, rows: Sequence[dict[str, Value]], experience: Sequence[str] = ()) -> str:
    """The inputs, the outputs at one velocity or in a table, and lines of the experience with the model."""
    lines = [f"{case.model.name}: {case.model.title}", "", "inputs", *inputs(case), ""]
    if len(rows) > 1:
        return "\n".join([*lines, *table(case.model, rows), *_apart(experience)])
    (row,) = rows
    lines.append(f"at {row[VELOCITY]:g} m/s")
    return "\n".join(
        [*lines, *columns((entry.name, shown(row[entry.name], entry.unit), entry.description) for entry in case.model.outputs),
         *_apart(experience)]
    )


def _apart(lines: Sequence[str]) -> list[str]:
    """Lines below an empty one; none if there are none."""
    return ["", *lines] if lines else []


def heads(model: Model) -> list[str]:
    """Names of a table's columns with their units."""
    return [f"{VELOCITY} [m/s]"] + [entry.name + (f" [{entry.unit}]" if entry.unit else "") for entry in model.outputs]


def table(model: Model, rows: Sequence[dict[str, Value]]) -> list[str]:
    """Rows for the reader, with a head."""
    names = [VELOCITY, *(entry.name for entry in model.outputs)]
    cells = [[row[name] if isinstance(row[name], str) else f"{row[name]:.6g}" for name in names] for row in rows]
    return columns([heads(model), *cells])


def write_csv(model: Model, rows: Sequence[dict[str, Value]], path: Path) -> None:
    """Writes rows with all digits."""
    with replacing(path) as temporary, open(temporary, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(heads(model))
        writer.writerows([row[VELOCITY], *(row[entry.name] for entry in model.outputs)] for row in rows)


def plain(value: Value) -> Value:
    """A value that JSON can hold: null for a non-finite number."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def given_data(inputs: dict[str, Given], model: Model) -> dict[str, dict]:
    """Inputs for JSON."""
    units_of = {entry.name: entry.unit for entry in model.inputs}
    return {
        name: {"value": plain(given.value), "unit": units_of[name], "source": given.source} for name, given in inputs.items()
    }


def data(case: Case, rows: Sequence[dict[str, Value]], experience: Sequence[str] = ()) -> dict:
    """The contents of `report` for JSON."""
    return {
        "model": case.model.name,
        "title": case.model.title,
        "source": case.model.source,
        "inputs": given_data(case.inputs, case.model),
        "units": {VELOCITY: "m/s"} | {entry.name: entry.unit for entry in case.model.outputs},
        "results": [{name: plain(value) for name, value in row.items()} for row in rows],
        "experience": list(experience),
    }
