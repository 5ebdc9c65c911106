"""Outlines of bodies in the (r, z) half-plane.

An outline is a list of slabs. In a slab, z runs from ``low`` to ``high`` and the body fills r from an inner to an outer
curve. Both curves are smooth and monotone there, so volumes can be integrated exactly between their crossings with the
mesh. The inner curve of a solid body on the axis is the mirror image of its outer curve; a mesh that starts on the axis
never reaches the part at r < 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

#: lines along r by which the volume that two bodies share is computed
LINES = 500


@dataclass(frozen=True)
class Line:
    """r = r0 + slope (z - z0)."""

    r0: float
    z0: float = 0.0
    slope: float = 0.0

    @property
    def constant(self) -> bool:
        return self.slope == 0.0

    def r(self, z: float) -> float:
        return self.r0 if self.constant else self.r0 + self.slope * (z - self.z0)

    def z_at(self, r: float, low: float, high: float) -> float:
        """Where the curve, monotone from ``low`` to ``high``, reaches r."""
        return min(max(self.z0 + (r - self.r0) / self.slope, low), high)

    def mirrored(self) -> Line:
        return Line(-self.r0, self.z0, -self.slope)


@dataclass(frozen=True)
class Arc:
    """r = rc + sign sqrt(rho^2 - (z - zc)^2)."""

    rc: float
    zc: float
    rho: float
    sign: float = 1.0

    constant = False

    def r(self, z: float) -> float:
        x = abs(z - self.zc)
        return self.rc + self.sign * math.sqrt(max((self.rho - x) * (self.rho + x), 0.0))

    def z_at(self, r: float, low: float, high: float) -> float:
        """Where the curve, monotone from ``low`` to ``high``, reaches r."""
        x = abs(r - self.rc)
        away = math.sqrt(max((self.rho - x) * (self.rho + x), 0.0))
        z = self.zc + away if low + high > 2 * self.zc else self.zc - away
        return min(max(z, low), high)

    def mirrored(self) -> Arc:
        return Arc(-self.rc, self.zc, self.rho, -self.sign)


@dataclass(frozen=True)
class Slab:
    """The part of a body from z = low to z = high, between two curves."""

    low: float
    high: float
    inner: Line | Arc
    outer: Line | Arc

    def chords_along_z(self, r: float) -> list[tuple[float, float]]:
        """The pieces of the line at r that lie in the slab, from one crossing of a curve to the next."""
        crossings = [curve.z_at(r, self.low, self.high) for curve in (self.inner, self.outer) if not curve.constant]
        ends = sorted({self.low, self.high, *crossings})
        middles = [0.5 * (low + high) for low, high in pairwise(ends)]
        return [piece for piece, z in zip(pairwise(ends), middles, strict=True) if self.inner.r(z) < r < self.outer.r(z)]


@dataclass(frozen=True)
class Outline:
    """A body as slabs, which may lie side by side but do not overlap."""

    slabs: tuple[Slab, ...]

    def extent(self, axis: str) -> tuple[float, float]:
        """Smallest and largest coordinate along "r" (not below 0 for bodies on the axis) or "z"."""
        if axis == "z":
            return min(slab.low for slab in self.slabs), max(slab.high for slab in self.slabs)
        ends = [(slab, z) for slab in self.slabs for z in (slab.low, slab.high)]
        return min(slab.inner.r(z) for slab, z in ends), max(slab.outer.r(z) for slab, z in ends)

    def chords(self, axis: str, at: float) -> list[tuple[float, float]]:
        """The pieces of a line along "r" or "z" that lie in the body; ``at`` is the line's other coordinate."""
        if axis == "r":
            return [(slab.inner.r(at), slab.outer.r(at)) for slab in self.slabs if slab.low < at < slab.high]
        return [chord for slab in self.slabs for chord in slab.chords_along_z(at)]


def solid(low: float, high: float, outer: Line | Arc) -> Slab:
    """A slab of a body on the axis."""
    return Slab(low, high, outer.mirrored(), outer)


def rectangle(r: tuple[float, float], z: tuple[float, float]) -> Outline:
    """The outline of a plate or a box."""
    return Outline((Slab(z[0], z[1], Line(r[0]), Line(r[1])),))


def shared_volume(one: Outline, other: Outline, r: tuple[float, float], z: tuple[float, float], planar: bool
                  ) -> tuple[float, float]:
    """Volume that two outlines share, and that of the first, within a mesh; m^3 (planar: m^2, per depth).

    r, z : lowest and highest of the mesh, m. By the midpoint rule on LINES lines along r, to a few thousandths.
    """
    low, high = max(one.extent("z")[0], z[0]), min(one.extent("z")[1], z[1])
    both = whole = 0.0
    for k in range(LINES):
        at = low + (k + 0.5) / LINES * (high - low)
        mine, others = ([(max(a, r[0]), min(b, r[1])) for a, b in each.chords("r", at)] for each in (one, other))
        whole += sum(_across(a, b, planar) for a, b in mine)
        both += sum(_across(max(a, c), min(b, d), planar) for a, b in mine for c, d in others)
    return both * (high - low) / LINES, whole * (high - low) / LINES


def _across(low: float, high: float, planar: bool) -> float:
    """Area of the ring between two radii, m^2, or planar their distance, m; 0 if low exceeds high."""
    if not low < high:
        return 0.0
    return high - low if planar else math.pi * (high**2 - low**2)
