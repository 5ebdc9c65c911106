"""The fields of a page: one array of numbers for each scalar, component of a vector and body, and their ranges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from hydro2d.base.errors import Error
from hydro2d.base.units import reader_unit
from hydro2d.materials import quantities
from hydro2d.materials.quantities import Quantity
from hydro2d.output.datasets import COMPONENTS, quantities_of
from hydro2d.output.vtk import Dump

#: shares of the cells that may lie outside a colour range, and number of quantiles of a dump from which it is found
CLIPS = (0.0, 0.005, 0.01, 0.02, 0.05)
RANKS = 401


class ViewError(Error):
    """A run that cannot be shown in a page; the message is for the user."""


@dataclass(frozen=True)
class Stored:
    """A field: the word that names it, its name in dumps, component of a vector, body, title, unit and its scale."""

    word: str
    name: str
    title: str
    unit: str
    scale: float
    component: int | None = None
    body: str = ""
    is_magnitude: bool = False

    def magnitude(self) -> Stored:
        """The magnitude of the vector of which this is a component; it is not stored."""
        word, title = self.word.rpartition(":")[0], self.title.rpartition(" ")[0]
        return replace(self, word=word, title=title, component=None, is_magnitude=True)

    @property
    def parts(self) -> list[str]:
        """Words of the components of the vector whose magnitude this is; empty for anything else."""
        return [f"{self.word}:{part}" for part in COMPONENTS] if self.is_magnitude else []

    @property
    def is_share(self) -> bool:
        """Whether it is the volume fraction of a body, whose range is 0 to 1."""
        return self.word.startswith("volume_fraction:")

    def values(self, dump: Dump) -> np.ndarray | None:
        """Values of a dump in the reader's unit, shape (nz, nr); None if it has none."""
        array = dump.fields.get(self.name)
        if array is None:
            return None
        return (array if self.component is None else array[..., self.component]).astype(float) * self.scale


def asked(words: Iterable[str], dumps: list[Dump], run) -> list[Quantity]:
    """The quantities named by words, which are keys of quantities.TABLE or groups of them, in the order of the table.

    Raises FieldError, and ViewError if no dump has a quantity that was requested by its own name.
    """
    words, there = list(words), quantities_of(*dumps)
    if "all" in words:
        return there
    keys = quantities.expand(words)
    available = {quantity.key for quantity in there}
    for word in words:
        if word in quantities.BY_KEY and word not in available:
            raise ViewError(f'{run.directory}: the dumps have no "{word}", but {", ".join(sorted(available))}; '
                            f"{quantities.not_written(word)}")
    return [quantity for quantity in there if quantity.key in keys]


def arrays(chosen: Iterable[Quantity], dumps: list[Dump]) -> list[Stored]:
    """The stored arrays of chosen quantities, in their order: one for each component of a vector, one for each body."""
    fields = {name: values for dump in dumps for name, values in dump.fields.items()}
    return [each for quantity in chosen for each in _arrays_of(quantity, dumps[-1].bodies, fields)]


def _arrays_of(quantity: Quantity, bodies: list[str], fields: dict[str, np.ndarray]) -> Iterator[Stored]:
    unit, scale = reader_unit(quantity.unit)
    if quantity.per_body:
        for body in bodies:
            name, title = quantity.name(body), quantity.title.replace(" of {body}", "").replace(" for {body}", "")
            if name in fields:
                yield Stored(f"{quantity.key}:{body}", name, title, unit, scale, body=body)
    elif fields[quantity.name()].ndim == 3:
        for number, part in enumerate(COMPONENTS):
            title = f"{quantity.title} {part}"
            yield Stored(f"{quantity.key}:{part}", quantity.name(), title, unit, scale, component=number)
    else:
        yield Stored(quantity.key, quantity.name(), quantity.title, unit, scale)


class Ranges:
    """Ranges of a field over all dumps, without void: from smallest to largest value, and without the outermost cells."""

    def __init__(self) -> None:
        self._ranked: list[np.ndarray] = []
        self._cells: list[int] = []

    def add(self, values: np.ndarray, solid: np.ndarray) -> None:
        """Adds the values of one dump where `solid` is true, shapes (nz, nr)."""
        seen = values[solid & np.isfinite(values)]
        if seen.size:
            self._ranked.append(np.quantile(seen, np.linspace(0.0, 1.0, RANKS)))
            self._cells.append(seen.size)

    def clipped(self) -> list[list[float]]:
        """Low and high for each entry of CLIPS; 0 and 0 if there was no cell."""
        if not self._ranked:
            return [[0.0, 0.0] for _ in CLIPS]
        values, weights = np.concatenate(self._ranked), np.repeat(self._cells, RANKS)
        order = np.argsort(values)
        share = np.cumsum(weights[order]) / np.sum(weights)
        ends = [(np.searchsorted(share, clip), np.searchsorted(share, 1.0 - clip)) for clip in CLIPS]
        last = len(order) - 1
        return [[short(values[order[min(each, last)]]) for each in pair] for pair in ends]


def short(number: float) -> float:
    """A number rounded to seven digits, as in float32, which is short in a page."""
    return float(f"{number:.7g}")
