"""Tables over time in a deck: [[time, value], ...], linear between the rows."""

from __future__ import annotations

from functools import partial
from typing import Annotated

import numpy as np
from pydantic import BeforeValidator, WithJsonSchema

from hydro2d.base import units

Rows = tuple[tuple[float, float], ...]

#: least and largest number of rows of a table
FEWEST, MOST = 2, 100_000


def _rows(value, unit: str) -> Rows:
    if not isinstance(value, (list, tuple)) or not FEWEST <= len(value) <= MOST:
        raise ValueError(f"expected a table of {FEWEST} to {MOST} rows, [[time, value in {unit}], ...]")
    rows = []
    for number, row in enumerate(value):
        if not isinstance(row, (list, tuple)) or len(row) != 2:
            raise ValueError(f"row {number} is not a pair [time, value in {unit}]")
        try:
            rows.append(tuple(units.in_reach(units.to_si(part, of), of) for part, of in zip(row, ("s", unit), strict=True)))
        except ValueError as problem:
            raise ValueError(f"row {number}: {problem}") from None
    for number, (before, after) in enumerate(zip(rows, rows[1:], strict=False), 1):
        if not before[0] < after[0]:
            raise ValueError(f"the time of row {number}, {after[0]:g} s, is not after that of the row before, {before[0]:g} s")
    return tuple(rows)


def _constant_or_rows(value, unit: str) -> float | Rows:
    if isinstance(value, (list, tuple)):
        return _rows(value, unit)
    return units.in_reach(units.to_si(value, unit), unit)


def _schema(unit: str) -> dict:
    item = {"anyOf": [{"type": "number"}, {"type": "string"}]}
    row = {"type": "array", "items": item, "minItems": 2, "maxItems": 2, "x-unit": f"s, {unit}"}
    return {"type": "array", "items": row, "minItems": FEWEST}


SpeedOverTime = Annotated[Rows, BeforeValidator(partial(_rows, unit="m/s")), WithJsonSchema(_schema("m/s"))]
AccelerationOverTime = Annotated[
    float | Rows, BeforeValidator(partial(_constant_or_rows, unit="m/s^2")),
    WithJsonSchema({"anyOf": [{"type": "number", "x-unit": "m/s^2"}, {"type": "string"}, _schema("m/s^2")], "x-unit": "m/s^2"}),
]
PowerOverTime = Annotated[Rows, BeforeValidator(partial(_rows, unit="W/kg")), WithJsonSchema(_schema("W/kg"))]


def at(rows: Rows, time: float) -> float:
    """The value at a time, s; the first value before the first row, the last one after the last row."""
    times, values = np.array(rows).T
    return float(np.interp(time, times, values))


def integral(rows: Rows, first: float, last: float) -> float:
    """Integral of the table from one time to another, s; exact, and zero before the first row and after the last one."""
    times, values = np.array(rows).T
    sums = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(times))])

    def until(time: float) -> float:
        time = min(max(time, times[0]), times[-1])
        k = min(int(np.searchsorted(times, time, side="right")), len(times) - 1) - 1
        return float(sums[k] + 0.5 * (values[k] + np.interp(time, times, values)) * (time - times[k]))

    return until(last) - until(first)
