"""Tables of rows in a deck, such as [[time, value], ...], and the functions of time that such a table can be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from hydro2d.base import units

Rows = tuple[tuple[float, ...], ...]


@dataclass(frozen=True)
class Table:
    """Rows of numbers with a unit for each of their ``columns``.

    ``fewest`` and ``most`` say how many rows there may be. The first column of a ``rising`` table grows from row to row. With
    ``or_number``, one number in the unit of the last column may stand in place of the table.
    """

    columns: tuple[str, ...]
    fewest: int
    most: int
    rising: bool = False
    or_number: bool = False

    def read(self, value, unit: str, check: Callable[[float], float] | None = None) -> float | Rows:
        """The rows in SI; unit : of every column, with commas;  check : of the last column. ValueError names the row."""
        of = unit.split(", ")
        if self.or_number and not isinstance(value, (list, tuple)):
            return units.read(value, of[-1])
        row_in_words = f"[{', '.join(_column(*column) for column in zip(self.columns, of, strict=True))}]"
        if not isinstance(value, (list, tuple)) or not self.fewest <= len(value) <= self.most:
            raise ValueError(f"expected a table of {self.fewest} to {self.most} rows, [{row_in_words}, ...]")
        rows = []
        for number, row in enumerate(value):
            if not isinstance(row, (list, tuple)) or len(row) != len(of):
                raise ValueError(f"row {number} is not {row_in_words}")
            try:
                rows.append(tuple(units.read(part, own) for part, own in zip(row, of, strict=True)))
            except ValueError as problem:
                raise ValueError(f"row {number}: {problem}") from None
            self._compare(rows, of, check)
        return tuple(rows)

    def _compare(self, rows: list[tuple[float, ...]], of: list[str], check: Callable[[float], float] | None) -> None:
        """Refuses the last row if it does not follow the one before it, or its last number is not within its range."""
        number, row = len(rows) - 1, rows[-1]
        if check is not None:
            try:
                check(row[-1])
            except ValueError as problem:
                raise ValueError(f"the {self.columns[-1]} of row {number} {problem} {of[-1]}") from None
        if self.rising and number and not rows[-2][0] < row[0]:
            raise ValueError(f"the {self.columns[0]} of row {number}, {row[0]:g} {of[0]}, is not after that of the row before, "
                             f"{rows[-2][0]:g} {of[0]}")

    def schema(self, unit: str) -> dict:
        """Its JSON schema, with the units of the columns as ``x-unit``."""
        item = {"anyOf": [{"type": "number"}, {"type": "string"}]}
        row = {"type": "array", "items": item, "minItems": len(self.columns), "maxItems": len(self.columns), "x-unit": unit}
        table = {"type": "array", "items": row, "minItems": self.fewest, "maxItems": self.most}
        if not self.or_number:
            return table
        number = unit.split(", ")[-1]
        return {"anyOf": [{"type": "number", "x-unit": number}, {"type": "string"}, table], "x-unit": number}


def _column(name: str, unit: str) -> str:
    """A column in a message: places and times go without their unit."""
    return name if unit in ("m", "s") else f"{name} in {unit}"


#: a quantity as a function of time
OVER_TIME = Table(("time", "value"), 2, 100_000, rising=True)
#: the same, or a constant
CONSTANT_OR_OVER_TIME = replace(OVER_TIME, or_number=True)


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
