"""Tables of the SESAME type 301 as text: pressure and energy over density and temperature.

The text is that of the ASCII exchange files of SESAME tables: records, each with a heading `RECORD TYPE = 301 NWDS = n` and
its numbers in order. Of record 301 these are NR and NT, NR densities in Mg/m^3, NT temperatures in K, then NR times NT
pressures in GPa and energies in MJ/kg, the density running first. Free energies that may follow are not used, nor are records
of other types. A text of numbers alone is one record 301.

Lyon & Johnson, SESAME: the Los Alamos National Laboratory equation of state database, LA-UR-92-3407 (1992).
"""

from __future__ import annotations

import functools
import hashlib
import re
from dataclasses import dataclass

import numpy as np

from hydro2d.files.toml import MOST_TEXT

#: the units of the table in SI: Mg/m^3, GPa, MJ/kg
DENSITY, PRESSURE, ENERGY = 1e3, 1e9, 1e6
#: least number of densities and of temperatures; most characters, since a resolved deck contains them
LEAST, MOST = 3, MOST_TEXT - 100_000
_RECORD = re.compile(r"\s*(?:\d\s+)?RECORD\s+TYPE\s*=\s*(\d+)\s+NWDS\s*=\s*(\d+)\s*$", re.IGNORECASE)
_INDEX = re.compile(r"\s*(?:\d\s+)?INDEX\s+MATID\b", re.IGNORECASE)
#: numbers to a line of a text that is written here
_TO_A_LINE = 5


class TableError(ValueError):
    """A text that is not a table, or not one that a material can have; the message says where."""


@dataclass(frozen=True, eq=False)
class Table:
    """A table in SI: density float64[i], kg/m^3, temperature float64[j], K; pressure, Pa, and energy, J/kg, float64[i, j]."""

    density: np.ndarray
    temperature: np.ndarray
    pressure: np.ndarray
    energy: np.ndarray


def is_table(text: str) -> bool:
    """Whether a text begins as a table does: with a heading or with a number."""
    first = next((line for line in text.splitlines() if line.strip()), "")
    return bool(_RECORD.match(first) or _INDEX.match(first) or re.match(r"\s*[-+]?\.?\d", first))


@functools.lru_cache(maxsize=8)
def read(text: str) -> Table:
    """The table of a text. Raises TableError with the line, the number and what it should be."""
    if len(text) > MOST:
        raise TableError(f"has {len(text)} characters; at most {MOST} are read, since a resolved deck carries them")
    numbers, lines = _numbers(text)

    def wrong(k: int, message: str) -> TableError:
        return TableError(f"line {lines[k]}: {message}")

    for k, word in ((0, "densities"), (1, "temperatures")):
        if numbers.size < 2 or not (numbers[k] == np.floor(numbers[k]) and LEAST <= numbers[k] <= numbers.size):
            number = f"{numbers[k]:g}" if numbers.size > k else "nothing"
            raise TableError(f"record 301 begins with its numbers of densities and temperatures, each at least {LEAST}; that "
                             f"of {word} is {number}")
    nr, nt = int(numbers[0]), int(numbers[1])
    needed, whole = 2 + nr + nt + 2 * nr * nt, 2 + nr + nt + 3 * nr * nt
    if numbers.size not in (needed, whole):
        raise TableError(f"{nr} densities and {nt} temperatures take {needed} numbers, {whole} with free energies; there are "
                         f"{numbers.size}")
    bad = np.flatnonzero(~np.isfinite(numbers[:needed]))
    if bad.size:
        raise wrong(bad[0], f"{numbers[bad[0]]} is not a finite number")
    rho, T = numbers[2:][:nr], numbers[2 + nr:][:nt]
    for points, first, word, unit in ((rho, 2, "density", "Mg/m^3"), (T, 2 + nr, "temperature", "K")):
        if points[0] < 0.0:
            raise wrong(first, f"the first {word}, {points[0]:g} {unit}, is negative")
        if (falls := np.flatnonzero(~(np.diff(points) > 0.0))).size:
            k = falls[0]
            raise wrong(first + k + 1, f"{word} {k + 2}, {points[k + 1]:g} {unit}, is not above the one before, {points[k]:g}")
    start = 2 + nr + nt
    p, e = (numbers[start + n * nr * nt:][: nr * nt].reshape(nt, nr).T for n in (0, 1))
    if rho[0] == 0.0 and (pressed := np.flatnonzero(p[0] != 0.0)).size:
        j = pressed[0]
        raise wrong(start + j * nr, f"at density zero and {T[j]:g} K there is a pressure of {p[0, j]:g} GPa")
    falls = np.argwhere(~(np.diff(e, axis=1) > 0.0))
    if len(falls):
        i, j = falls[0]
        raise wrong(start + nr * nt + (j + 1) * nr + i, f"at {rho[i]:g} Mg/m^3 the energy does not rise from {T[j]:g} to "
                    f"{T[j + 1]:g} K: {e[i, j]:g} to {e[i, j + 1]:g} MJ/kg")
    table = Table(rho * DENSITY, T.copy(), p * PRESSURE, e * ENERGY)
    for array in vars(table).values():
        array.flags.writeable = False
    return table


def _numbers(text: str) -> tuple[np.ndarray, list[int]]:
    """The numbers of record 301, and the line of each. Raises TableError."""
    wanted, stated, numbers, lines, types = True, None, [], [], []
    for line, words in enumerate(text.splitlines(), start=1):
        heading = _RECORD.match(words)
        if heading:
            types.append(int(heading[1]))
            if types.count(301) > 1:
                raise TableError(f"line {line}: a second record 301: the file of a deck holds one material")
            wanted = types[-1] == 301
            if wanted:
                stated, numbers, lines = int(heading[2]), [], []
        elif _INDEX.match(words):
            wanted = False
            if types:
                raise TableError(f"line {line}: a second index: the file of a deck holds one material")
        elif wanted:
            for word in words.split():
                try:
                    numbers.append(float(word))
                except ValueError:
                    raise TableError(f"line {line}: {word[:40]!r} is not a number") from None
                lines.append(line)
    if types and 301 not in types:
        raise TableError(f"has no record 301, only {', '.join(map(str, types))}")
    if not types and not wanted:
        raise TableError("has an index and no record")
    if stated is not None and stated != len(numbers):
        raise TableError(f"its heading states {stated} numbers (NWDS); there are {len(numbers)}")
    return np.array(numbers), lines


def write(table: Table) -> str:
    """The text of a table: an index, and record 301 without free energies, in the nine digits of the exchange files."""
    nr, nt = table.density.size, table.temperature.size
    numbers = np.concatenate([[nr, nt], table.density / DENSITY, table.temperature, (table.pressure / PRESSURE).T.ravel(),
                              (table.energy / ENERGY).T.ravel()])
    index = (1.0, 0.0, 0.0, 1.0, 1.0, 301.0, float(numbers.size))
    return "".join([f" INDEX      MATID = {1:6d}    NWDS = {len(index):8d}\n", _lines(index),
                    f" RECORD     TYPE = {301:4d}     NWDS = {numbers.size:8d}\n", _lines(numbers)])


def _lines(numbers) -> str:
    words = [f"{number:16.8e}" for number in numbers]
    return "".join("".join(words[k: k + _TO_A_LINE]) + "\n" for k in range(0, len(words), _TO_A_LINE))


def digest(text: str) -> str:
    """SHA-256 of a text."""
    return hashlib.sha256(text.encode()).hexdigest()
