"""The bodies of a deck: their materials, shapes and velocities."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from hydro2d.base import units
from hydro2d.base.keys import (
    Angle,
    Interval,
    Length,
    Name,
    Number,
    Point,
    PositiveDensity,
    PositiveLength,
    PositiveNumber,
    Pressure,
    Section,
    SpecificEnergy,
    Speed,
    Temperature,
    Velocity,
)

#: most corners of a polygon
MOST_CORNERS = 5000


class Flow(Section):
    """A velocity directed away from a centre, speed (radius/distance)^exponent, for implosions and shells."""

    pattern: Literal["spherical", "cylindrical"] = Field(description="directed away from a point or from a line")
    speed: Speed = Field(description="speed at `radius`, outward positive", examples=["-200 m/s"])
    centre: Length = Field(0.0, description="axial position of the centre of a spherical flow", examples=["1 cm"])
    radius: PositiveLength = Field(1.0, description="distance at which the speed is `speed`", examples=["5 mm"])
    exponent: Number = Field(
        0.0, description="decay with distance; 2 (spherical) or 1 (cylindrical) conserves volume", examples=[2.0]
    )


class Body(Section):
    """Keys common to all bodies. Where bodies overlap, the first of them in the deck takes the space."""

    name: Name = Field(description="name of the body in fields, tables and other sections", examples=["rod"])
    material: str = Field(description="a material of the library or of [materials]; NAME:VARIANT is a variant of it",
                          examples=["W_alloy"])
    join: str | None = Field(None, description="an earlier body of the same material to merge with", examples=["shank"])
    velocity: Velocity = Field((0.0, 0.0), description="axial velocity, or [radial, axial]", examples=["1086 m/s"])
    flow: Flow | None = Field(
        None, description="velocity away from a centre, added to `velocity`",
        examples=[{"pattern": "spherical", "speed": "-200 m/s"}],
    )
    density: PositiveDensity | None = Field(
        None, description="initial density; default: the material's, or set by `temperature`", examples=["17.6 g/cm^3"]
    )
    energy: SpecificEnergy | None = Field(None, description="initial specific internal energy", examples=["10 kJ/kg"])
    pressure: Pressure | None = Field(None, description="initial pressure, instead of `energy`", examples=["1 GPa"])
    temperature: Temperature | None = Field(
        None, description="initial temperature, instead of `energy`; without `density`, the density follows from this "
        "temperature and `pressure`, or zero pressure (a gas: its own density)", examples=["300 K"],
    )

    @model_validator(mode="after")
    def _one_thermal_state(self):
        given = [key for key in ("energy", "pressure", "temperature") if getattr(self, key) is not None]
        if self.energy is not None and len(given) > 1:
            raise ValueError(f"give {' or '.join(given)}, not both")
        if len(given) == 2 and self.density is not None:
            raise ValueError("give two of density, pressure and temperature; the third follows")
        return self


def _one_of(model: Section, *keys: str) -> str:
    given = [key for key in keys if getattr(model, key) is not None]
    if len(given) != 1:
        raise ValueError(f"give exactly one of {', '.join(keys)}; given: {', '.join(given) or 'none'}")
    return given[0]


class Rod(Body):
    """A rod on the axis. `length` is the total length, nose included; the nose points along `direction`."""

    shape: Literal["rod"] = Field(description="a rod on the axis")
    nose: Literal["flat", "hemispherical", "ogive", "conical"] = Field("flat", description="profile of the nose")
    radius: PositiveLength | None = Field(None, description="radius of the shank", examples=["3.378 mm"])
    diameter: PositiveLength | None = Field(
        None, description="diameter of the shank, instead of `radius`", examples=["6.756 mm"]
    )
    length: PositiveLength = Field(description="total length, nose included", examples=["97.8 mm"])
    tip: Length = Field(description="axial position of the tip of the nose", examples=["0 mm"])
    direction: Literal[1, -1] = Field(1, description="+1: the nose points to +z")
    crh: PositiveNumber | None = Field(
        None, description="ogive: radius of the arc in diameters (tangent ogive)", examples=[3.0]
    )
    half_angle: Angle | None = Field(
        None, description="cone: half the angle at the tip; a plain number is in rad", examples=["30 deg"]
    )
    nose_length: PositiveLength | None = Field(
        None, description="ogive, cone: length of the nose, instead of `crh` or `half_angle`", examples=["10 mm"]
    )

    @model_validator(mode="before")
    @classmethod
    def _radius_or_diameter(cls, data):
        if isinstance(data, dict) and data.get("radius") is not None and data.get("diameter") is not None:
            if units.to_si(data["diameter"], "m") != 2 * units.to_si(data["radius"], "m"):
                raise ValueError("radius and diameter are both given and disagree")
        return data

    @model_validator(mode="after")
    def _geometry(self):
        if self.radius is None and self.diameter is None:
            raise ValueError("a rod needs its radius or its diameter")
        if self.nose in ("flat", "hemispherical"):
            stray = [key for key in ("crh", "half_angle", "nose_length") if getattr(self, key) is not None]
            if stray:
                raise ValueError(f"a {self.nose} nose has no {' and no '.join(stray)}")
        elif self.nose == "ogive":
            if self.half_angle is not None:
                raise ValueError("an ogive has no half_angle; give crh or nose_length")
            _one_of(self, "crh", "nose_length")
            if self.crh is not None and self.crh < 0.5:
                raise ValueError(f"crh of an ogive must be at least 0.5 (a hemisphere), is {self.crh:g}")
            if self.nose_length is not None and self.nose_length < self.rod_radius:
                raise ValueError("nose_length of a tangent ogive must be at least the radius")
        else:
            if self.crh is not None:
                raise ValueError("a cone has no crh; give half_angle or nose_length")
            _one_of(self, "half_angle", "nose_length")
            if self.half_angle is not None and not self.half_angle < math.pi / 2:
                raise ValueError('half_angle must be less than 90 degrees; a plain number is in rad, so write "30 deg"')
        if self.length < self.resolved_nose_length:
            raise ValueError(
                f"length ({self.length:g} m) is the total length and must not be less than the length of the nose "
                f"({self.resolved_nose_length:g} m)"
            )
        return self

    @property
    def rod_radius(self) -> float:
        """Radius of the shank in m, from the radius or the diameter in the deck."""
        return self.radius if self.radius is not None else self.diameter / 2

    @property
    def resolved_nose_length(self) -> float:
        """Length of the nose in m: a tangent ogive of caliber radius head crh has R sqrt(4 crh - 1)."""
        if self.nose == "flat":
            return 0.0
        if self.nose == "hemispherical":
            return self.rod_radius
        if self.nose_length is not None:
            return self.nose_length
        if self.nose == "ogive":
            return self.rod_radius * math.sqrt(4 * self.crh - 1)
        return self.rod_radius / math.tan(self.half_angle)


class Plate(Body):
    """A plate across the axis, from `z_front` towards +z."""

    shape: Literal["plate"] = Field(description="a plate across the axis")
    z_front: Length = Field(description="axial position of the face with the smaller z", examples=["0 mm"])
    thickness: PositiveLength = Field(description="extent along z", examples=["12 mm"])
    radius: PositiveLength | None = Field(
        None, description="outer radius; default: the plate reaches the edge of the mesh", examples=["25 cm"]
    )


class Box(Body):
    """A rectangle in the (r, z) plane: a cylinder, a tube or a washer."""

    shape: Literal["box"] = Field(description="a rectangle in the (r, z) plane")
    r: Interval | None = Field(None, description="[inner, outer] radius; default: the whole mesh", examples=[["5 mm", "8 mm"]])
    z: Interval = Field(description="[low, high] axial position", examples=[["0 mm", "20 mm"]])


def _centre(value) -> tuple[float, float]:
    if isinstance(value, (list, tuple)):
        if len(value) != 2:
            raise ValueError("expected an axial position or [r, z]")
        return units.to_si(value[0], "m"), units.to_si(value[1], "m")
    return 0.0, units.to_si(value, "m")


class Sphere(Body):
    """A sphere or a shell on the axis (a circle anywhere in planar geometry)."""

    shape: Literal["sphere"] = Field(description="a sphere or a shell")
    centre: Annotated[
        tuple[float, float],
        BeforeValidator(_centre),
        WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string"}, {"type": "array"}], "x-unit": "m"}),
    ] = Field(description="axial position of the centre, or [r, z]; with r > 0 in r-z the body is a ring", examples=["-5 mm"])
    radius: PositiveLength = Field(description="outer radius", examples=["5 mm"])
    inner_radius: PositiveLength | None = Field(None, description="inner radius of a shell", examples=["4 mm"])

    @model_validator(mode="after")
    def _shell(self):
        if self.inner_radius is not None and not self.inner_radius < self.radius:
            raise ValueError("inner_radius must be smaller than radius")
        return self


def _points(value):
    if not isinstance(value, (list, tuple)) or len(value) < 3:
        raise ValueError("a polygon needs at least three points [r, z]")
    if len(value) > MOST_CORNERS:
        raise ValueError(f"has {len(value)} corners; at most {MOST_CORNERS} are allowed")
    return value


class Polygon(Body):
    """A polygon in the (r, z) plane. Its edges must not cross. The last corner is joined to the first."""

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


def _cross(a, b, c, d) -> np.ndarray:
    """Whether the open segment ab and open segments cd cross each other: a, b (2,) and c, d (n, 2), result (n,)."""

    def side(p, q, x):
        return (q[..., 0] - p[..., 0]) * (x[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (x[..., 0] - p[..., 0])

    return (side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)


AnyBody = Annotated[Rod | Plate | Box | Sphere | Polygon, Field(discriminator="shape")]

SHAPES = {"rod": Rod, "plate": Plate, "box": Box, "sphere": Sphere, "polygon": Polygon}
