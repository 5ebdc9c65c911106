"""The points of a sample: rows of values of deck keys, from a table or from the distributions of a study file."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from hydro2d.base import units
from hydro2d.files import csv_tables, toml
from hydro2d.study.plan import joint, relating
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE, Distribution, label
from hydro2d.study.plan.sample_section import MOST, Sample

#: the axis of a study that has the rows, and what their cases are called
AXIS, NAME = "row", "row{}"
#: a head with a unit; the index of an entry is a part of its key
_HEAD = re.compile(r"(.*?\S)\s*\[(?!\d+\])([^\[\]]*)\]")


@dataclass(frozen=True)
class Points:
    """The points of a sample.

    inputs : the uncertain deck keys;  rows : a value of each, in its unit, by point;  texts : the same as a deck has them
    method, seed, table : how they were made: "sobol", "latin-hypercube" or "table"; the seed; the name of the table
    results : further numbers of the runs that the table of results has;  notes : for the user
    """

    inputs: tuple[Distribution, ...]
    rows: tuple[tuple[Any, ...], ...]
    texts: tuple[tuple[Any, ...], ...]
    method: str
    seed: int | None = None
    table: str = ""
    results: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def relative(self) -> bool:
        """Whether an input relates to the value of the deck."""
        return any(each.relative for each in self.inputs)

    def settings(self, number: int, tables: Mapping[str, Any] = MappingProxyType({})) -> dict[str, Any]:
        """The deck keys and values of a point, counted from 0.

        tables : of the deck, with the values to which inputs relate

        Raises ValueError if the deck has no such value.
        """
        values = zip(self.inputs, self.texts[number], strict=True)
        return {each.key: relating.value(tables, each, text) if each.relative else text for each, text in values}

    @classmethod
    def of_data(cls, data: dict[str, Any]) -> Points:
        """The inverse of `data`; without the texts, which only a plan needs. Raises ValueError for a value that no row has."""
        inputs, rows = tuple(map(Distribution.of_data, data["inputs"])), tuple(map(tuple, data["rows"]))
        for number, row in enumerate(rows, 1):
            for each, value in zip(inputs, row, strict=True):
                if not each.has(value):
                    raise ValueError(f"row {number} of the sample has {value!r} as {each.head}")
        joint.correlated(inputs, np.full((1, len(inputs)), 0.5))
        return cls(inputs, rows, (), data["method"], data["seed"], data["table"], tuple(map(str, data["results"])))

    def inputs_of(self, row: int | str) -> dict[str, float | str]:
        """The values of the inputs in a row, counted from 1, by their heads."""
        return {each.head: value for each, value in zip(self.inputs, self.rows[int(row) - 1], strict=True)}

    def data(self) -> dict[str, Any]:
        """The contents as plain data, for JSON."""
        return {"method": self.method, "seed": self.seed, "table": self.table, "results": list(self.results),
                "inputs": [each.data() for each in self.inputs], "rows": [list(row) for row in self.rows]}


def together(sample: Sample) -> list[Distribution]:
    """The inputs of the joint distributions of a sample."""
    return [each for given in sample.joint for each in Distribution.of_joint(given)]


def points(sample: Sample, inputs: Sequence[Distribution], folder: Path) -> Points:
    """The points of a sample; `inputs` are the distributions of its keys, `folder` that of its table. Raises StudyError."""
    if sample.table is not None:
        return read(folder / sample.table, sample.results)
    cube, notes = _cube(sample, len(inputs))
    cube = joint.correlated(inputs, cube, strata=sample.method == "latin-hypercube")
    columns = [each.values(cube[:, number]) for number, each in enumerate(inputs)]
    chosen = [dict(zip(each.levels, sample.input[each.key].choice, strict=True)) if each.kind == CHOICE else None
              for each in inputs]
    texts = [[levels[value] if levels else _written(value, each.unit) for value in column]
             for each, column, levels in zip(inputs, columns, chosen, strict=True)]
    return Points(tuple(inputs), tuple(zip(*columns, strict=True)), tuple(zip(*texts, strict=True)), sample.method,
                  sample.seed or 0, results=sample.results, notes=notes)


def _cube(sample: Sample, dimensions: int):
    """Points of the unit cube, float64[n, dimensions], and notes on them."""
    from numpy.random import default_rng
    from scipy.stats import qmc

    generator, notes = default_rng(sample.seed or 0), ()
    if sample.method == "latin-hypercube":
        return qmc.LatinHypercube(dimensions, seed=generator).random(sample.n), notes
    engine = qmc.Sobol(dimensions, scramble=True, seed=generator)
    power = (sample.n - 1).bit_length()
    cube = engine.random_base2(power)[: sample.n]  # the first n of them: more points with the same seed keep the earlier ones
    if sample.n != 2**power:
        notes = (f"sample.n = {sample.n} is not a power of two, so that the points of Sobol's sequence do not fill the space "
                 f"evenly; {2 ** (power - 1)} or {2**power} would",)
    return cube, notes


def _written(value: float, unit: str) -> float | str:
    """A number as a deck has it."""
    return f"{value!r} {unit}" if unit else value


# ------------------------------------------------------------------------------------------------ tables


def read(file: Path, results: tuple[str, ...] = ()) -> Points:
    """The points of a table. Raises StudyError with file, row and column for a head or a cell that no deck can have."""
    heads, rows = _cells(file)
    keys, problems = [_head(head) for head in heads], []
    for number, (key, unit) in enumerate(keys):
        problems += _bad_head(file, number, heads, key, unit, keys)
    for row, cells in enumerate(rows, 1):
        if len(cells) != len(heads):
            problems.append(f"{file}: row {row} has {len(cells)} cells, and the head {len(heads)}")
            continue
        problems += [f'{place(file, row, head)}: {wrong}' for head, (_, unit), cell in zip(heads, keys, cells, strict=True)
                     if (wrong := _bad_cell(cell, unit))]
    if problems:
        raise StudyError("\n".join(problems))
    columns = [[_value(row[number]) for row in rows] for number in range(len(heads))]
    inputs = tuple(Distribution.of_column(key, unit, column) for (key, unit), column in zip(keys, columns, strict=True))
    values = [[label(value) for value in column] if each.kind == CHOICE else list(map(float, column))
              for each, column in zip(inputs, columns, strict=True)]
    texts = [[f"{cell} {unit}" if unit else _value(cell) for cell in column]
             for (_, unit), column in zip(keys, zip(*rows, strict=True), strict=True)]
    return Points(inputs, tuple(zip(*values, strict=True)), tuple(zip(*texts, strict=True)), "table", table=file.name,
                  results=results)


def place(file: Path, row: int, head: str) -> str:
    """A cell of a table in messages."""
    return f'{file}: row {row}, column "{head}"'


def _cells(file: Path) -> tuple[list[str], list[list[str]]]:
    """Heads and rows of a table. Raises StudyError."""
    lines = [cells for _, cells in csv_tables.lines(file, StudyError)]
    if len(lines) < 2:
        raise StudyError(f"{file}: needs a line of heads and at least one row")
    if len(lines) - 1 > MOST:
        raise StudyError(f"{file}: has {len(lines) - 1} rows; at most {MOST} are allowed")
    return lines[0], lines[1:]


def _head(head: str) -> tuple[str, str]:
    """Deck key and unit of a head such as "body.rod.velocity [m/s]"."""
    match = _HEAD.fullmatch(head)
    return (match[1], match[2].strip()) if match else (head, "")


def _bad_head(file: Path, number: int, heads: list[str], key: str, unit: str, keys: list[tuple[str, str]]) -> list[str]:
    """The mistake in a head, if there is one."""
    if not key:
        return [f"{file}: the head of column {number + 1} is empty"]
    if heads[number] != key and not unit:
        return [f'{file}: column "{heads[number]}": the unit is missing between the brackets']
    parts = toml.key_parts(key)
    if any(toml.key_parts(other) == parts for other, _ in keys[:number]):
        return [f'{file}: column {number + 1}, "{heads[number]}": there is already a column for {key}']
    if unit:
        try:
            units.of_kinds(f"1 {unit}", units.KINDS)
        except ValueError:
            return [f'{file}: column "{heads[number]}": "{unit}" is not a unit']
    return []


def _bad_cell(cell: str, unit: str) -> str | None:
    """The mistake in a cell, if there is one."""
    if not cell:
        return "is empty"
    try:
        if unit:
            units.to_si(cell, "1")
        elif (known := units.of_kinds(cell, units.KINDS)[1]) != "1":
            return f'"{cell}" has a unit; the head has the unit of a column, in brackets, such as [{known}]'
    except ValueError:
        return f'"{cell}" is not a number; the unit of the column is {unit}' if unit else None
    return None


def _value(cell: str) -> Any:
    """The value of a cell: a number, true or false, else text."""
    return toml.assignment(f"cell={cell}")[1]
