"""A rigid body of revolution: its facets, its mass properties, and the load that a layered target puts on it.

The differential area force law: every facet inside a layer that moves into the target feels A Y + B rho Vn^2 of that layer
along its normal, and friction against its sliding. explanation/penetration/rigid-body, equations 4 to 8
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hydro2d.noses.base import Shaped
from hydro2d.penetration.layers import Target
from hydro2d.penetration.model import InputError, positive
from hydro2d.penetration.surface import Surface, body_surface, nose_surface

#: largest gap of a closed surface: resultant of a uniform pressure over the largest section
OPEN = 1e-9


@dataclass(frozen=True)
class Body:
    """Facets in the frame of the body with the centre of mass as origin and +z forward; SI.

    ``points`` and ``normals`` are [3, rings, sectors] with opposite sectors exactly mirrored in the axis; ``area``
    and ``flank`` (where the normal is across the axis) [rings, sectors]. ``tip`` is the z of the nose's tip;
    ``moments`` are the moments of inertia about the axis and across it, kg m^2.
    """

    points: np.ndarray
    normals: np.ndarray
    area: np.ndarray
    flank: np.ndarray
    mass: float
    moments: tuple[float, float]
    tip: float
    diameter: float

    @property
    def outline(self) -> np.ndarray:
        """The points [3, n] that mark the body: those of all facets, and the tip."""
        return np.concatenate([self.points.reshape(3, -1), [[0.0], [0.0], [self.tip]]], axis=1)

    @property
    def flank_projection(self) -> float:
        """Area of the shank as seen from the side, m^2."""
        return float(np.sum(self.area[self.flank])) / math.pi


def rigid(surface: Surface, mass: float) -> Body:
    """The homogeneous body inside a closed ``surface`` with an even number of sectors; ``mass`` in kg.

    Volume, centroid and moments come from the facets by the divergence theorem. InputError for an open surface.
    """
    positive(mass=mass)
    sectors = round(math.pi / surface.azimuth[0])
    if sectors % 2:
        raise InputError(f"sectors = {sectors}: a rigid body needs an even number")
    section = surface.axial_area
    if abs(np.sum(section)) > OPEN * np.sum(np.abs(section)):
        raise InputError("surface: not closed; a rigid body needs a nose, a shank and a tail")
    volume = np.sum(surface.z * section)
    centre = np.sum(surface.z**2 * section) / (2.0 * volume)
    along = np.sum((surface.z - centre) ** 3 * section) / (3.0 * volume)
    across = np.sum(surface.r**2 * surface.z * section) / volume
    points = surface.points - [0.0, 0.0, centre]
    return Body(
        points=_mirrored(points, sectors),
        normals=_mirrored(surface.normals, sectors),
        area=surface.area.reshape(-1, sectors),
        flank=(surface.normal_z == 0.0).reshape(-1, sectors),
        mass=mass,
        moments=(float(mass * across), float(mass * (0.5 * across + along))),
        tip=float(-centre),
        diameter=2.0 * float(np.max(surface.r)),
    )


def projectile(nose: Shaped, mass: float, length: float, rings: int = 50, shank_rings: int = 50, sectors: int = 16) -> Body:
    """A nose on its shank; ``length`` (m) is that of a cylinder of the same diameter and volume.

    InputError if the nose alone has more volume than that.
    """
    positive(length=length)
    tip = nose_surface(nose, rings)
    volume = float(np.sum((tip.z + nose.length) * tip.axial_area))
    whole = length + nose.length - volume / (math.pi * nose.radius**2)
    return rigid(body_surface(nose, whole, rings, shank_rings, sectors=sectors), mass)


def load(body: Body, target: Target, friction: float, touch: float, depth: float, inward: np.ndarray,
         velocity: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force (N) and torque about the centre of mass (N m), in the body's frame.

    ``depth`` of the centre of mass (m), ``inward`` unit vector of growing depth, ``velocity`` (m/s) and angular
    velocity ``spin`` (rad/s), all in the body's frame. ``touch`` (m/s) is the closing speed from which on the static
    pressure on the flank is fully developed.
    """
    x, y, z = body.points
    index = target.locate(depth + (inward[0] * x + inward[1] * y + inward[2] * z))
    if not np.any((index > 0) & (index < target.static.size - 1)):
        return np.zeros(3), np.zeros(3)
    motion = (
        velocity[0] + (spin[1] * z - spin[2] * y),
        velocity[1] + (spin[2] * x - spin[0] * z),
        velocity[2] + (spin[0] * y - spin[1] * x),
    )
    closing = motion[0] * body.normals[0] + motion[1] * body.normals[1] + motion[2] * body.normals[2]
    inside = np.maximum(closing, 0.0)
    share = np.where(body.flank, np.minimum(inside / touch, 1.0), inside > 0.0)
    pressure = (share * target.static[index] + target.dynamic[index] * inside**2) * body.area
    traction = [-pressure * n for n in body.normals]
    if friction > 0.0:
        traction = _rubbed(traction, friction * pressure, motion, closing, body.normals)
    fx, fy, fz = traction
    force = np.array([_total(fx), _total(fy), _total(fz)])
    torque = np.array([_total(y * fz - z * fy), _total(z * fx - x * fz), _total(x * fy - y * fx)])
    return force, torque


def _rubbed(traction, drag, motion, closing, normals):
    """The tractions with ``drag`` against the part of the motion that lies in the surface."""
    sliding = [v - closing * n for v, n in zip(motion, normals, strict=True)]
    speed = np.sqrt(sliding[0] ** 2 + sliding[1] ** 2 + sliding[2] ** 2)
    drag = np.divide(drag, speed, out=np.zeros_like(drag), where=speed > 0.0)
    return [t - drag * s for t, s in zip(traction, sliding, strict=True)]


def _total(facets: np.ndarray) -> float:
    """The sum, opposite sectors first, so that odd parts about the axis cancel to the last bit."""
    half = facets.shape[1] // 2
    return float(np.sum(facets[:, :half] + facets[:, half:]))


def _mirrored(vectors: np.ndarray, sectors: int) -> np.ndarray:
    """[3, rings, sectors] of the facets' vectors (n, 3), the second half turn an exact image of the first."""
    arranged = np.ascontiguousarray(vectors.T).reshape(3, -1, sectors)
    half = sectors // 2
    arranged[:2, :, half:] = -arranged[:2, :, :half]
    return arranged
