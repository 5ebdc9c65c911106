"""The edges of the mesh, from its segments."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from hydro2d.base.units import written
from hydro2d.deck.mesh_sections import Segment
from hydro2d.deck.sections import Deck

#: fraction of a cell by which a segment may miss a whole number of cells; beyond the second value a notice is given
_FIT, _TOLD = 1e-4, 1e-6
_LIMIT = 1_000_000
#: the smallest cell, as a fraction of its distance from the origin, whose edges still differ by many roundings
_SMALLEST = 1e-9
#: the smallest ratio to try, and a length greater than that of any mesh, m
_STEEPEST, _LARGEST = 1e-3, 1e300
#: largest logarithm of the ratio of the last cell of a graded segment to its first
_GROWTH = 50.0


class MeshError(ValueError):
    """A mesh or a segment that cannot be divided into cells; ``path`` is its key in the deck."""

    def __init__(self, path: tuple, message: str):
        super().__init__(message)
        self.path = path


def body(deck: Deck, name: str):
    """The body with this name. Raises KeyError if there is none."""
    for entry in deck.body:
        if entry.name == name:
            return entry
    raise KeyError(name)


def body_radius(deck: Deck, name: str) -> float | None:
    """Radius of a rod, a sphere or a plate with an edge; None for other bodies."""
    return next((entry.own_radius for entry in deck.body if entry.name == name), None)


def edges_along(deck: Deck, axis: str) -> np.ndarray:
    """Edges along "r" or "z", float64[n + 1]. Raises MeshError for a segment that cannot be divided into cells."""
    edges = [deck.mesh.r_start if axis == "r" else deck.mesh.z_start]
    for *_, new in _laid(deck, axis):
        edges += new.tolist()
    return np.array(edges)


def cells_between(edges: np.ndarray, low: float, high: float) -> float:
    """Number of cells from low to high within the mesh; a cell that is cut counts by its share. edges : (n + 1,)"""
    return float(np.diff(np.interp((low, high), edges, np.arange(len(edges))))[0])


def misfits(deck: Deck) -> Iterator[str]:
    """One sentence for each segment whose cells were adjusted because they miss a whole number by more than round-off."""
    for axis in ("r", "z"):
        for number, segment, start, new in _laid(deck, axis):
            size = _size(deck, segment)
            if segment.to is not None and size is not None and None is segment.cells is segment.ratio is segment.last:
                miss = abs(len(new) - (segment.to - start) / size)
                if miss > _TOLD:
                    yield f"mesh.{axis}[{number}]: ends {miss:.1g} of a cell from a whole number; the cells were adjusted"


def _laid(deck: Deck, axis: str) -> Iterator[tuple[int, Segment, float, np.ndarray]]:
    """The segments of an axis: number, segment, start, and the edges without the first. Raises MeshError."""
    start, previous = (deck.mesh.r_start if axis == "r" else deck.mesh.z_start), None
    for number, segment in enumerate(getattr(deck.mesh, axis)):
        try:
            new = _segment(deck, segment, start, previous, _as_written(deck, axis, number))
        except ValueError as problem:
            raise MeshError(("mesh", axis, number), str(problem)) from None
        yield number, segment, start, new
        previous = float(new[-1] - (new[-2] if len(new) > 1 else start))
        start = float(new[-1])


def _as_written(deck: Deck, axis: str, number: int) -> dict:
    """A segment as the author of the deck wrote it, with units; empty for a deck that was not read."""
    entries = getattr(deck, "_tables", {}).get("mesh", {}).get(axis)
    return entries[number] if entries else {}


def _segment(deck: Deck, segment: Segment, start: float, previous: float | None, entry: dict) -> np.ndarray:
    """Edges of one segment without its first."""
    size = _size(deck, segment)
    length = None if segment.to is None else segment.to - start
    if length is not None and length <= 0:
        raise ValueError(f"must end beyond its start at {start:g} m, ends at {segment.to:g} m")
    if segment.ratio is not None or segment.last is not None:
        return _graded(segment, start, length, size, previous)
    cells = segment.cells
    if cells is None:
        if length / size > _LIMIT:
            raise ValueError(f"would need {length / size:.3g} cells")
        cells = round(length / size)
        if cells < 1 or abs(cells * size - length) > _FIT * size:
            raise ValueError(_misfit(start, length, size, entry))
    end = segment.to if length is not None else start + cells * size
    return _checked(start, np.linspace(start, end, cells + 1)[1:])


def _misfit(start: float, length: float, size: float, entry: dict) -> str:
    """The message on cells that do not divide a segment, in the units of the deck, with the nearest ends and counts that do."""
    def shown(value: float, key: str, digits: int = 9) -> str:
        unit, factor = written(entry.get(key, entry.get("to")), "m")
        return f"{value / factor:.{digits}g} {unit}"

    counts = sorted({max(1, math.floor(length / size)), math.ceil(length / size)})
    ends = " or ".join(shown(start + count * size, "to") for count in counts)
    instead = " or ".join(f"{count} (of {shown(length / count, 'size', 4)})" for count in counts)
    return f"cells of {shown(size, 'size')} do not divide {shown(length, 'to')}; to = {ends} would fit, or cells = {instead}"


def _size(deck: Deck, segment: Segment) -> float | None:
    if segment.across is None:
        return segment.size if segment.size is not None else segment.first
    radius = body_radius(deck, segment.across)
    if radius is None:
        raise ValueError(f'across: "{segment.across}" is not a body with a radius')
    return radius / segment.cells_across


def _graded(segment: Segment, start: float, length: float | None, first: float | None, previous: float | None):
    if first is None:
        if previous is None:
            raise ValueError("the first segment of an axis needs `first`, the size of its first cell")
        first = previous * (segment.ratio or 1.0)
    if segment.cells is not None:
        if segment.cells * abs(math.log(segment.ratio)) > _GROWTH:
            raise ValueError(f"{segment.cells} cells with a ratio of {segment.ratio:g} shrink to nothing or grow without bound")
        sizes = first * segment.ratio ** np.arange(segment.cells)
        return _checked(start, start + np.cumsum(sizes))
    if first > length:
        raise ValueError(f"is {length:g} m long, less than its first cell of {first:g} m")
    if segment.last is not None:
        if segment.last > length:
            raise ValueError(f"is {length:g} m long, less than its last cell of {segment.last:g} m")
        ratio = (length - first) / (length - segment.last) if length > max(first, segment.last) else 1.0
        cells = 1 if ratio == 1.0 and length <= first else _count(first, ratio, length)
        target = None
    else:
        cells, target = _count(first, segment.ratio, length), segment.ratio
    ratio = _fitted_ratio(first, cells, length)
    if target is not None and abs(ratio - target) > 0.5 * abs(target - 1) + 0.01:
        raise ValueError(f"no number of cells fits {length:g} m with first = {first:g} m and a ratio near {target:g}")
    sizes = first * ratio ** np.arange(cells)
    edges = start + np.cumsum(sizes)
    edges[-1] = segment.to
    return _checked(start, edges)


def _count(first: float, ratio: float, length: float) -> int:
    """The whole number of graded cells nearest to a length."""
    if abs(ratio - 1) < 1e-12:
        cells = length / first
    else:
        grown = 1 + length * (ratio - 1) / first
        if grown <= 0:
            raise ValueError(f"cells that shrink by {ratio:g} from {first:g} m never reach {length:g} m")
        cells = np.log(grown) / np.log(ratio)
    if cells > _LIMIT:
        raise ValueError(f"would need {cells:.3g} cells")
    return max(1, round(cells))


def _fitted_ratio(first: float, cells: int, length: float) -> float:
    """The smallest ratio, to the last bit, with which ``cells`` cells that begin with ``first`` fill ``length``."""
    if cells == 1:
        return 1.0
    from scipy.optimize import brentq

    def missing(ratio: float) -> float:
        with np.errstate(over="ignore"):  # an infinite length is too long as well
            return min(first * float(np.sum(ratio ** np.arange(cells))), _LARGEST) - length

    high = 2.0
    while missing(high) < 0:
        high *= 2
    if missing(_STEEPEST) >= 0:
        return _STEEPEST
    low = brentq(missing, _STEEPEST, high, xtol=1e-18, rtol=4 * np.finfo(float).eps)
    while missing(low) >= 0:
        low = math.nextafter(low, 0.0)
    while missing(high := math.nextafter(low, math.inf)) < 0:
        low = high
    return 0.5 * (low + high)


def _checked(start: float, edges: np.ndarray) -> np.ndarray:
    if len(edges) > _LIMIT:
        raise ValueError(f"has {len(edges)} cells")
    smallest, farthest = float(np.min(np.diff(edges, prepend=start))), float(np.max(np.abs(edges)))
    if not smallest > _SMALLEST * farthest:
        raise ValueError(f"its smallest cell, {smallest:.3g} m, is lost in round-off at {farthest:.3g} m from the origin")
    return edges
