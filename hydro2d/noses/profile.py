"""The profile of a nose: pieces of its meridian, from the base to the tip.

The tip is the origin, z points in the direction of flight, and r is the distance from the axis, so that a nose lies at z <= 0.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Arc:
    """An arc of ``radius`` about (centre_r, centre_z), from z = start to z = end, m; r does not grow towards the tip."""

    centre_r: float
    centre_z: float
    radius: float
    start: float
    end: float


@dataclass(frozen=True)
class Cone:
    """A straight flank from (start_r, start) to (end_r, end), (r, z) in m."""

    start_r: float
    start: float
    end_r: float
    end: float


@dataclass(frozen=True)
class Disc:
    """A face across the axis at z, out to r, m."""

    r: float
    z: float = 0.0


Piece = Arc | Cone | Disc


def tangent_arc(radius: float, length: float) -> Arc:
    """The arc of a nose of this length that is tangent to a shank of this radius and meets the axis at the tip, m.

    Its radius is (length^2 + radius^2) / (2 radius) about a centre in the plane of the base. Equal lengths make a hemisphere.
    """
    rho = (length**2 + radius**2) / (2 * radius)
    return Arc(radius - rho, -length, rho, -length, 0.0)
