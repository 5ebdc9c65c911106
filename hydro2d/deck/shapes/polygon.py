"""A polygon in the (r, z) plane."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from hydro2d.base.keys import Point
from hydro2d.deck.shapes.body import Body
from hydro2d.deck.shapes.outlines import Line, Outline, Slab

#: heights of two corners that differ by less than this share of the largest one are the same
ROUND_OFF = 1e-14
#: a coordinate below this, in its unit, is 0
LEAST = 1e-13
#: most corners of a polygon
MOST_CORNERS = 5000


def _points(value):
    if not isinstance(value, (list, tuple)) or len(value) < 3:
        raise ValueError("a polygon needs at least three points [r, z]")
    if len(value) > MOST_CORNERS:
        raise ValueError(f"has {len(value)} corners; at most {MOST_CORNERS} are allowed")
    return [[_rounded(each) for each in point] if isinstance(point, (list, tuple)) else point for point in value]


def _rounded(coordinate):
    """A coordinate, 0 where a program has left round-off of it: 3e-19, "1.2e-16 mm"."""
    number = coordinate.split(maxsplit=1)[0] if isinstance(coordinate, str) and coordinate.strip() else coordinate
    try:
        return 0.0 if abs(float(number)) < LEAST else coordinate
    except (TypeError, ValueError):
        return coordinate


class Polygon(Body):
    """A polygon in the (r, z) plane. Its edges must not cross. The last corner is joined to the first."""

    radial_key: ClassVar[str | None] = "points"

    shape: Literal["polygon"] = Field(description="a polygon in the (r, z) plane")
    points: Annotated[tuple[Point, ...], BeforeValidator(_points)] = Field(
        description="corners [r, z], in order", examples=[[["0 mm", "0 mm"], ["4 mm", "-8 mm"], ["0 mm", "-8 mm"]]]
    )

    @model_validator(mode="after")
    def _simple(self):
        begin = np.array(self.points)
        end = np.roll(begin, -1, axis=0)
        for first in range(len(begin)):
            if (begin[first] == end[first]).all():
                raise ValueError(f"corner {first} is given twice")
            crossed = _cross(begin[first], end[first], begin[first + 1 :], end[first + 1 :])
            if crossed.any():
                raise ValueError(f"the edges from corner {first} and from corner {first + 1 + crossed.argmax()} cross")
        return self

    def outline(self, r_start: float) -> Outline:
        return polygon_outline(self.points)


def polygon_outline(points) -> Outline:
    """A polygon with corners (r, z) whose edges do not cross, cut into slabs at its corners."""
    corners = list(points)
    sides = list(zip(corners, corners[1:] + corners[:1], strict=True))
    bottom, top = (choice([[a[1], b[1]] for a, b in sides], axis=1) for choice in (np.min, np.max))
    levels = sorted({z for _, z in corners})
    thin = ROUND_OFF * max(map(abs, (levels[0], levels[-1], levels[-1] - levels[0])))
    slabs = []
    for low, high in zip(levels, levels[1:], strict=False):
        if high - low <= thin:  # two corners at one height but for round-off
            continue
        middle = 0.5 * (low + high)
        spanning = [_side(*sides[n]) for n in np.flatnonzero((bottom <= low) & (top >= high))]
        spanning.sort(key=lambda line: line.r(middle))
        slabs += [Slab(low, high, *pair) for pair in zip(spanning[::2], spanning[1::2], strict=True)]
    return Outline(tuple(slabs))


def _side(a: tuple[float, float], b: tuple[float, float]) -> Line:
    return Line(a[0], a[1], (b[0] - a[0]) / (b[1] - a[1]))


def _cross(a, b, c, d) -> np.ndarray:
    """Whether the open segment ab and open segments cd cross each other: a, b (2,) and c, d (n, 2), result (n,)."""

    def side(p, q, x):
        return (q[..., 0] - p[..., 0]) * (x[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (x[..., 0] - p[..., 0])

    return (side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)
