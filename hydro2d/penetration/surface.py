"""The surface of an axisymmetric projectile as rings, or as facets of rings: nose, shank and tail.

Body frame: the tip of the nose is the origin and z runs along the axis in the direction of flight, so that the body lies at
z <= 0 and the normals of the nose have a positive z component. A round nose is an arc of radius S about a point in the plane
of its base, at a distance b behind the tip:

    r = a - S + S cos(theta),   z = -b + S sin(theta),   normal (r, z) = (cos(theta), sin(theta))

with S = a for a hemisphere and S = 2 a psi for an ogive of caliber-radius-head psi; the other noses are a cone and a disc.

Each ring has its exact area and the exact projection of that area along the axis, pi (r_outer^2 - r_inner^2). Their ratio is
the axial component of the surface's normal at one point of the ring (mean value theorem); the ring's normal and position are
those of that point. Projections therefore telescope: on a nose they sum to pi a^2 to round-off, and a uniform pressure
on the whole body has no resultant. explanation/penetration/rigid-axial, equations 4 and 5
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hydro2d.penetration.model import InputError, positive

SHAPES = ("hemispherical", "ogival", "conical", "flat")


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


def radius_of_ogive(diameter: float, crh: float) -> float:
    """S = psi D, the radius of the arc of a tangent ogive; a hemisphere is psi = 1/2, and blunter arcs do not exist."""
    positive(diameter=diameter)
    if not crh >= 0.5:
        raise InputError(f"nose.crh = {crh:g}: a tangent ogive has at least 0.5, which is the hemisphere")
    return crh * diameter


def nose_length(shape: str, diameter: float, crh: float = 3.0, half_angle: float = 0.5) -> float:
    """Length of the nose, m: a; a sqrt(4 psi - 1); a / tan(half angle); 0."""
    positive(diameter=diameter)
    a = 0.5 * diameter
    if shape == "hemispherical":
        return a
    if shape == "ogival":
        radius_of_ogive(diameter, crh)
        return a * math.sqrt(4.0 * crh - 1.0)
    if shape == "conical":
        return a / math.tan(checked_half_angle(half_angle))
    if shape == "flat":
        return 0.0
    raise InputError(f"nose.shape = {shape!r}: choose one of {', '.join(SHAPES)}")


def checked_half_angle(half_angle: float) -> float:
    if not 0.0 < half_angle < 0.5 * math.pi:
        raise InputError(f"nose.half_angle = {half_angle:g}: must lie between 0 and pi/2 rad")
    return half_angle


def nose_surface(
    shape: str, diameter: float, crh: float = 3.0, half_angle: float = 0.5, rings: int = 100, sectors: int = 1
) -> Surface:
    """The nose alone; see the module for the shapes. InputError for an unknown shape or an impossible number."""
    return _facets(_nose(shape, diameter, crh, half_angle, _count("rings", rings)), _count("sectors", sectors))


def body_surface(
    shape: str,
    diameter: float,
    length: float,
    crh: float = 3.0,
    half_angle: float = 0.5,
    rings: int = 100,
    shank_rings: int = 100,
    tail_rings: int = 20,
    sectors: int = 32,
) -> Surface:
    """Nose, cylindrical shank and flat tail; ``length`` (m) is that of the whole body, nose included."""
    positive(diameter=diameter, length=length)
    base = nose_length(shape, diameter, crh, half_angle)
    if length < base:
        raise InputError(f"rod.length = {length:g}: shorter than its nose, {base:g} m")
    parts = [
        _nose(shape, diameter, crh, half_angle, _count("rings", rings)),
        _shank(0.5 * diameter, -base, -length, _count("shank_rings", shank_rings)),
        _disc(0.5 * diameter, -length, -1.0, _count("tail_rings", tail_rings))[:, ::-1],
    ]
    return _facets(np.concatenate(parts, axis=1), _count("sectors", sectors))


def _nose(shape: str, diameter: float, crh: float, half_angle: float, rings: int) -> np.ndarray:
    base, a = nose_length(shape, diameter, crh, half_angle), 0.5 * diameter
    if shape == "flat":
        return _disc(a, 0.0, 1.0, rings)
    if shape == "conical":
        return _cone(a, half_angle, rings)
    return _arc(a, a if shape == "hemispherical" else radius_of_ogive(diameter, crh), base, rings)


# Rings are rows z, r, normal_z, normal_r, area of one array.


def _arc(a: float, radius: float, base: float, rings: int) -> np.ndarray:
    """An arc of ``radius`` S: area = 2 pi S [(a - S) dtheta + S d(sin theta)], projection = pi d(r^2)."""
    theta = np.linspace(math.acos((radius - a) / radius), 0.0, rings + 1)
    r = a - radius + radius * np.cos(theta)
    r[0] = 0.0
    area = 2.0 * math.pi * radius * ((a - radius) * -np.diff(theta) - radius * np.diff(np.sin(theta)))
    normal_z = np.pi * np.diff(r**2) / area
    normal_r = np.sqrt((1.0 - normal_z) * (1.0 + normal_z))
    return np.stack([radius * normal_z - base, a - radius + radius * normal_r, normal_z, normal_r, area])


def _cone(a: float, half_angle: float, rings: int) -> np.ndarray:
    r, middle = _edges_and_centroids(a, rings)
    sine, cosine = math.sin(half_angle), math.cos(half_angle)
    area = math.pi * np.diff(r**2) / sine
    return np.stack([-middle / math.tan(half_angle), middle, np.full(rings, sine), np.full(rings, cosine), area])


def _disc(a: float, z: float, normal: float, rings: int) -> np.ndarray:
    r, middle = _edges_and_centroids(a, rings)
    return np.stack([np.full(rings, z), middle, np.full(rings, normal), np.zeros(rings), math.pi * np.diff(r**2)])


def _shank(a: float, start: float, end: float, rings: int) -> np.ndarray:
    z = np.linspace(start, end, rings + 1)
    area = 2.0 * math.pi * a * -np.diff(z)
    return np.stack([0.5 * (z[1:] + z[:-1]), np.full(rings, a), np.zeros(rings), np.ones(rings), area])


def _edges_and_centroids(a: float, rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Equal steps in r, and the mean radius by area of each ring."""
    r = np.linspace(0.0, a, rings + 1)
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
