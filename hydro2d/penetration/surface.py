"""The surface of an axisymmetric projectile as rings, or as facets of rings: nose, shank and tail.

Body frame: the tip of the nose is the origin and z runs along the axis in the direction of flight, so that the body lies at
z <= 0 and the normals of the nose have a positive z component. A nose consists of arcs, cones and discs (``hydro2d.noses``). An
arc of radius S about the point (c, b) is

    r = c + S cos(theta),   z = b + S sin(theta),   normal (r, z) = (cos(theta), sin(theta))

with c = a - S for a nose that is tangent to a shank of radius a: S = a for a hemisphere, S = 2 a psi for an ogive of
caliber-radius-head psi.

Each ring has its exact area and the exact projection of that area along the axis, pi (r_outer^2 - r_inner^2). Their ratio is
the axial component of the surface's normal at one point of the ring (mean value theorem); the ring's normal and position are
those of that point. Projections therefore telescope: on a nose they sum to pi a^2 to round-off, and a uniform pressure
on the whole body has no resultant. explanation/penetration/rigid-axial, equations 4 and 5
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hydro2d.noses.base import Shaped
from hydro2d.noses.profile import Arc, Cone, Disc, Piece
from hydro2d.penetration.model import InputError, positive


@dataclass(frozen=True)
class Surface:
    """Facets of a body of revolution, flat arrays of one entry each, rings from the tip aft, sectors within a ring.

    ``z``, ``r`` position (m), ``azimuth`` angle of the facet's middle (rad), ``normal_z``, ``normal_r`` outward unit
    normal, ``area`` (m^2). With one sector a facet is a whole ring and the azimuth has no meaning.
    """

    z: np.ndarray
    r: np.ndarray
    azimuth: np.ndarray
    normal_z: np.ndarray
    normal_r: np.ndarray
    area: np.ndarray

    @property
    def points(self) -> np.ndarray:
        """Positions (n, 3) in the body frame: x, y, z with x = r cos(azimuth), y = r sin(azimuth)."""
        return _cartesian(self.r, self.azimuth, self.z)

    @property
    def normals(self) -> np.ndarray:
        """Outward unit normals (n, 3)."""
        return _cartesian(self.normal_r, self.azimuth, self.normal_z)

    @property
    def axial_area(self) -> np.ndarray:
        """Area times axial component of the normal: the projection along the axis, signed."""
        return self.area * self.normal_z


def nose_surface(nose: Shaped, rings: int = 100, sectors: int = 1) -> Surface:
    """The nose alone, in at least this many rings."""
    return _facets(_nose(nose, _count("rings", rings)), _count("sectors", sectors))


def body_surface(nose: Shaped, length: float, rings: int = 100, shank_rings: int = 100, tail_rings: int = 20,
                 sectors: int = 32) -> Surface:
    """Nose, cylindrical shank and flat tail; ``length`` (m) is that of the whole body, nose included."""
    positive(length=length)
    if length < nose.length:
        raise InputError(f"rod.length = {length:g}: shorter than its nose, {nose.length:g} m")
    parts = [
        _nose(nose, _count("rings", rings)),
        _shank(nose.radius, -nose.length, -length, _count("shank_rings", shank_rings)),
        _disc(Disc(nose.radius, -length), _count("tail_rings", tail_rings), -1.0)[:, ::-1],
    ]
    return _facets(np.concatenate(parts, axis=1), _count("sectors", sectors))


def _nose(nose: Shaped, rings: int) -> np.ndarray:
    """The rings of a nose from the tip aft, shared by its pieces in proportion to their lengths along the meridian."""
    lengths = [_length(piece) for piece in nose.pieces]
    shares = [math.ceil(rings * length / sum(lengths)) for length in lengths]
    return np.concatenate([_rings(*each) for each in zip(nose.pieces[::-1], shares[::-1], strict=True)], axis=1)


def angles(arc: Arc) -> tuple[float, float]:
    """Angles theta at the base of an arc and at its end nearest to the tip, rad."""
    return tuple(math.asin(min(max((z - arc.centre_z) / arc.radius, -1.0), 1.0)) for z in (arc.start, arc.end))


def _length(piece: Piece) -> float:
    """Length of a piece along the meridian, m."""
    if isinstance(piece, Arc):
        low, high = angles(piece)
        return piece.radius * (high - low)
    return piece.r if isinstance(piece, Disc) else math.hypot(piece.end - piece.start, piece.end_r - piece.start_r)


# Rings are rows z, r, normal_z, normal_r, area of one array.


def _rings(piece: Piece, rings: int) -> np.ndarray:
    if isinstance(piece, Arc):
        return _arc(piece, rings)
    return _cone(piece, rings) if isinstance(piece, Cone) else _disc(piece, rings, 1.0)


def _arc(arc: Arc, rings: int) -> np.ndarray:
    """An arc of radius S about (c, b): area = 2 pi S (c dtheta + S d(sin theta)), projection = pi d(r^2)."""
    low, high = angles(arc)
    S = arc.radius
    theta = np.linspace(high, low, rings + 1)
    r = np.maximum(arc.centre_r + S * np.cos(theta), 0.0)
    area = 2.0 * math.pi * S * (arc.centre_r * -np.diff(theta) - S * np.diff(np.sin(theta)))
    normal_z = np.pi * np.diff(r**2) / area
    normal_r = np.sqrt((1.0 - normal_z) * (1.0 + normal_z))
    return np.stack([arc.centre_z + S * normal_z, arc.centre_r + S * normal_r, normal_z, normal_r, area])


def _cone(cone: Cone, rings: int) -> np.ndarray:
    r, middle = _edges_and_centroids(cone.end_r, cone.start_r, rings)
    height, width = cone.end - cone.start, cone.start_r - cone.end_r
    slant = math.hypot(height, width)
    area = math.pi * np.diff(r**2) * slant / width
    z = cone.end - (middle - cone.end_r) * height / width
    return np.stack([z, middle, np.full(rings, width / slant), np.full(rings, height / slant), area])


def _disc(disc: Disc, rings: int, normal: float) -> np.ndarray:
    r, middle = _edges_and_centroids(0.0, disc.r, rings)
    return np.stack([np.full(rings, disc.z), middle, np.full(rings, normal), np.zeros(rings), math.pi * np.diff(r**2)])


def _shank(a: float, start: float, end: float, rings: int) -> np.ndarray:
    z = np.linspace(start, end, rings + 1)
    area = 2.0 * math.pi * a * -np.diff(z)
    return np.stack([0.5 * (z[1:] + z[:-1]), np.full(rings, a), np.zeros(rings), np.ones(rings), area])


def _edges_and_centroids(inner: float, outer: float, rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Equal steps in r, and the mean radius by area of each ring."""
    r = np.linspace(inner, outer, rings + 1)
    return r, 2.0 / 3.0 * np.diff(r**3) / np.diff(r**2)


def _facets(ring: np.ndarray, sectors: int) -> Surface:
    z, r, normal_z, normal_r, area = np.repeat(ring, sectors, axis=1)
    azimuth = np.tile(2.0 * math.pi * (np.arange(sectors) + 0.5) / sectors, ring.shape[1])
    return Surface(z, r, azimuth, normal_z, normal_r, area / sectors)


def _cartesian(across: np.ndarray, azimuth: np.ndarray, along: np.ndarray) -> np.ndarray:
    return np.stack([across * np.cos(azimuth), across * np.sin(azimuth), along], axis=1)


def _count(name: str, number: int) -> int:
    if number != int(number) or number < 1:
        raise InputError(f"{name} = {number}: must be a whole number of at least 1")
    return int(number)
