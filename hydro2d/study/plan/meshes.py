"""The mesh of a deck made finer or coarser, by the number of cells across the radius of its projectile."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.deck.identity import cells_to, with_radius
from hydro2d.deck.mesh_sections import Segment, as_text


def settings(deck: decks.Deck, cells: float) -> dict[str, Any]:
    """Segments in r and z for ``cells`` cells across the radius of the projectile, by deck key; all cells change by one factor.

    The first segment in r then has exactly this number; in the others a number of cells is rounded, and their ends stay. Graded
    segments keep the growth of their cells over a length: ratio becomes ratio^(1 / factor). Raises DeckError.
    """
    name, radius = with_radius(deck)
    if name is None:
        raise DeckError("no body of the deck has a radius, so cells across it cannot be counted")
    factor = cells / cells_to(deck, radius)
    (inner, _, end), *rest = _laid(deck, "r")
    if _is_graded(inner) or end < radius:
        raise DeckError(f'mesh.r[0]: the cells across "{name}" are not all of one size, so their number cannot be set')
    across = {"across": name, "cells_across": cells} if rest else {"to": end}
    first = {"cells": max(round(end * cells / radius), 1), **across}
    return {**decks.written_segments(deck),
            "mesh.r": [as_text(each) for each in (first, *(_scaled(*each, factor) for each in rest))],
            "mesh.z": [as_text(_scaled(*each, factor)) for each in _laid(deck, "z")]}


def _laid(deck: decks.Deck, axis: str) -> Iterator[tuple[Segment, int, float]]:
    """The segments of an axis with their numbers of cells and their ends, m."""
    edges = decks.edges(deck)[0 if axis == "r" else 1]
    start = 0
    for segment in getattr(deck.mesh, axis):
        stop = start + segment.cells if segment.to is None else int(np.argmin(np.abs(edges - segment.to)))
        yield segment, stop - start, float(edges[stop])
        start = stop


def _is_graded(segment: Segment) -> bool:
    return segment.ratio is not None or segment.last is not None


def _scaled(segment: Segment, count: int, end: float, factor: float) -> dict:
    """A segment with cells smaller by a factor."""
    if not _is_graded(segment) and segment.to is not None:
        return {"to": end, "cells": max(round(count * factor), 1)}
    given = segment.model_dump(exclude_none=True)
    for key in ("size", "first", "last"):
        if key in given:
            given[key] /= factor
    if "cells_across" in given:
        given["cells_across"] *= factor
    if "ratio" in given:
        given["ratio"] **= 1.0 / factor
    if "cells" in given:
        given["cells"] = max(round(given["cells"] * factor), 1)
    return given
