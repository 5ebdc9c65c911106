"""Parts too thin for the mesh: bodies, coats and layers of a few cells, and gaps of less than one.

They move at their own speed (explanation/interfaces, thin bodies), but a wave needs a few cells, and the material beside a
gap within one cell may close it. Lines along r and z are laid through all bodies, between the places where their outlines
turn. A point of a body is as thick as the shorter of the two pieces of lines through it that lie in the body. The body is as
thick as its thickest points, a tenth of it left out: a cone's tip does not make it thin, nor do corners make a coat thick.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import NamedTuple

from hydro2d.deck.checks import travel
from hydro2d.deck.flight import AXES, Count, Flights
from hydro2d.deck.layout import axis_edges, extent, layout
from hydro2d.deck.mesh import body
from hydro2d.deck.sections import Deck
from hydro2d.deck.shapes.outlines import Outline

#: a body needs at least this many cells across, and a gap this many
CELLS_ACROSS, CELLS_OF_A_GAP = 4, 1
#: the wall of a jacket, a rod with a core in it, needs at least this many
CELLS_ACROSS_WALL = 3
#: fraction of a length that is round-off
ROUNDING = 1e-9
#: a gap that narrows to less than this fraction of its width is a wedge next to a point of contact
WEDGE = 1e-3
#: where lines are laid between two levels, as fractions of the way, and the shares of it that they stand for
PLACES = {1e-6: 0.25, 0.5: 0.5, 1.0 - 1e-6: 0.25}
#: the part of a body that may be thicker than the reported thickness, as the corners of coats are
THICKER = 0.1
#: most levels that one outline adds; polygons with more corners have smooth curves
MOST_LEVELS = 40


class Piece(NamedTuple):
    """The part of a line from low to high (m), which lies in the body of that name."""

    low: float
    high: float
    name: str


@dataclass(frozen=True)
class Line:
    """A line through all bodies.

    at : its other coordinate, m;  width : of the strip that it stands for, m;  band : number of the interval between levels;
    pieces : in the order of places
    """

    at: float
    width: float
    band: int
    pieces: list[Piece]

    def piece_at(self, place: float) -> Piece | None:
        n = bisect_right(self.pieces, place, key=lambda piece: piece.low) - 1
        return self.pieces[n] if n >= 0 and self.pieces[n].high > place else None


class Point(NamedTuple):
    """A point of a body: the cells across the thinner of the two ways through it, the area, m^2, and that way with its axis."""

    cells: float
    area: float
    thin: str
    piece: Piece


def thin_things(deck: Deck) -> Iterator[str]:
    """One sentence for each body and each gap that is thin at the start or during flight at its own velocity."""
    flights = Flights(deck, {axis: axis_edges(deck, axis) for axis in AXES})
    lines = {axis: list(_lines(flights, axis)) for axis in AXES}
    yield from _thin_bodies(flights, lines)
    yield from _thin_gaps(flights, lines)


def _cells_in_words(counts: list[Count], what: str) -> str:
    """Numbers of cells and where they apply; ``what`` they count follows the first."""
    first, *later = counts
    return " and ".join([f"{first.in_words} cells {what}{first.where}", *(f"{count.in_words}{count.where}" for count in later)])


def _window(flights: Flights, axis: str) -> tuple[float, float]:
    """The part of an axis on which bodies count: the mesh, and everything ahead of a mesh that travels."""
    deck, (low, *_, high) = flights.deck, flights.edges[axis].tolist()
    if axis == "z" and (direction := travel(deck)):
        ends = list(chain.from_iterable(extent(entry, deck, "z") for entry in deck.body))
        return (low, max(high, *ends)) if direction > 0 else (min(low, *ends), high)
    return low, high


def _levels(shape: Outline, axis: str) -> list[float]:
    """Coordinates at which an outline begins, ends or turns along an axis."""
    if axis == "z":
        turns = {z for slab in shape.slabs for z in (slab.low, slab.high)}
    else:
        turns = {curve.r(z) for slab in shape.slabs for z in (slab.low, slab.high) for curve in (slab.inner, slab.outer)}
    levels = sorted(turns)
    return [*levels[:: math.ceil(len(levels) / MOST_LEVELS)], levels[-1]]


def _lines(flights: Flights, axis: str) -> Iterator[Line]:
    """Lines along an axis, three between every two levels of the other axis."""
    across = AXES[1 - AXES.index(axis)]
    window, (first, last) = _window(flights, axis), _window(flights, across)
    shapes = [(each.body.join or each.body.name, each.outline) for each in layout(flights.deck).bodies]
    inside = {level for _, shape in shapes for level in _levels(shape, across) if first < level < last}
    for band, (low, high) in enumerate(pairwise(sorted({first, last, *inside}))):
        for place, share in PLACES.items():
            at = low + place * (high - low)
            chords = [(name, shape.chords(axis, at)) for name, shape in shapes]
            yield Line(at, share * (high - low), band, _visible(chords, window))


def _visible(chords: list[tuple[str, list[tuple[float, float]]]], window: tuple[float, float]) -> list[Piece]:
    """The pieces of a line. Where bodies overlap, the first takes the space; pieces of one body that touch are one."""
    free, visible = [window], []
    for name, own in chords:
        for low, high in own:
            visible += [Piece(max(low, a), min(high, b), name) for a, b in free if max(low, a) < min(high, b)]
            free = [rest for a, b in free for rest in ((a, min(b, low)), (max(a, high), b)) if rest[0] < rest[1]]
    joined: list[Piece] = []
    for piece in sorted(visible):
        if joined and joined[-1].name == piece.name and _touch(joined[-1], piece):
            piece = Piece(joined.pop().low, piece.high, piece.name)
        joined.append(piece)
    return joined


def _touch(before: Piece, after: Piece) -> bool:
    return after.low - before.high <= ROUNDING * (after.high - before.low)


def _thin_bodies(flights: Flights, lines: dict[str, list[Line]]) -> Iterator[str]:
    points = _points(flights, lines)
    for entry in flights.deck.body:
        if entry.name not in points:
            continue
        thickest, said = _thickest(points[entry.name]), []
        wall = entry.is_slender and thickest.thin == "r" and thickest.piece.low > 0.0
        least = CELLS_ACROSS_WALL if wall else CELLS_ACROSS
        for axis in AXES if wall or not entry.is_slender else ("z",):
            pieces = [piece for line in lines[axis] for piece in line.pieces if piece.name == entry.name]
            low, high = min(piece.low for piece in pieces), max(piece.high for piece in pieces)
            if axis == thickest.thin:
                low, high = thickest.piece.low, thickest.piece.high
            if counts := flights.counts(axis, low, high, entry.velocity, least):
                said.append(_cells_in_words(counts, f"across it along {axis}"))
        if said:
            yield f'body "{entry.name}": {", ".join(said)}; stresses and waves in it need at least {least}'


def _points(flights: Flights, lines: dict[str, list[Line]]) -> dict[str, list[Point]]:
    """The thickness of each body at the points where lines cross."""
    cells = {(axis, piece): flights.begin(axis, piece.low, piece.high, body(flights.deck, piece.name).velocity).cells
             for axis in AXES for line in lines[axis] for piece in line.pieces}
    places = [line.at for line in lines["z"]]
    points: dict[str, list[Point]] = {}
    for line in lines["r"]:
        for piece in line.pieces:
            for upright in lines["z"][bisect_right(places, piece.low) : bisect_left(places, piece.high)]:
                crossing = upright.piece_at(line.at)
                if crossing is not None and crossing.name == piece.name:
                    ways = [Point(cells[axis, way], line.width * upright.width, axis, way)
                            for axis, way in zip(AXES, (piece, crossing), strict=True)]
                    points.setdefault(piece.name, []).append(min(ways, key=lambda way: way.cells))
    return points


def _thickest(points: list[Point]) -> Point:
    """The thickest point of a body once THICKER of its area is left out."""
    left = THICKER * sum(point.area for point in points)
    for point in sorted(points, key=lambda point: -point.cells):
        left -= point.area
        if left < 0.0:
            break
    return point


def _thin_gaps(flights: Flights, lines: dict[str, list[Line]]) -> Iterator[str]:
    """Gaps between two bodies, or within one, that their velocities do not close; the narrowest of each pair."""
    narrowest: dict[tuple[str, str], tuple[float, str]] = {}
    for axis, along in zip(AXES, (0, 1), strict=True):
        bored = axis == "r" and flights.deck.mesh.geometry == "cylindrical" and flights.edges["r"][0] == 0.0
        for (before, after), bands in _gaps(lines[axis], bored).items():
            velocity, other = (body(flights.deck, name).velocity for name in (before, after))
            gaps = list(_narrow(bands))
            if not gaps or velocity[along] > other[along]:
                continue
            low, high = min(gaps, key=lambda gap: gap[1] - gap[0])
            flight = (0.0, 0.0) if velocity != other or low == flights.edges[axis][0] else velocity
            if counts := flights.counts(axis, low, high, flight, CELLS_OF_A_GAP):
                where = f'in "{before}"' if before == after else f'between "{before}" and "{after}"'
                sentence = (f"gap of {_cells_in_words(counts, f'along {axis} {where}')}; "
                            "material beside a gap thinner than a cell may close it")
                pair = (min(before, after), max(before, after))
                narrowest[pair] = min(narrowest.get(pair, (math.inf, "")), (min(count.cells for count in counts), sentence))
    yield from (sentence for _, sentence in narrowest.values())


def _gaps(lines: list[Line], bored: bool) -> dict[tuple[str, str], dict[int, list[tuple[float, float]]]]:
    """Ends of the gaps between the pieces of lines, by the names before and after them and by band.

    bored : whether what lies between 0 and the first piece is a hole in its body
    """
    gaps: dict[tuple[str, str], dict[int, list[tuple[float, float]]]] = {}
    for line in lines:
        first = [Piece(0.0, 0.0, line.pieces[0].name)] if bored and line.pieces else []
        for before, after in pairwise([*first, *line.pieces]):
            if not _touch(before, after):
                gaps.setdefault((before.name, after.name), {}).setdefault(line.band, []).append((before.high, after.low))
    return gaps


def _narrow(bands: dict[int, list[tuple[float, float]]]) -> Iterator[tuple[float, float]]:
    """The widest place of the gap in each band that it crosses, without wedges and the bands next to them."""

    def width(gap: tuple[float, float]) -> float:
        return gap[1] - gap[0]

    runs: list[list[int]] = []
    for band in sorted(bands):
        if runs and band == runs[-1][-1] + 1:
            runs[-1].append(band)
        else:
            runs.append([band])
    for run in runs:
        gaps = [gap for band in run for gap in bands[band]]
        if width(min(gaps, key=width)) > WEDGE * width(max(gaps, key=width)):
            yield from (max(bands[band], key=width) for band in run)
