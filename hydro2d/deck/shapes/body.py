"""The base of all shapes: the keys that every body has, and the part that a body of this shape can play in a shot."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field, model_validator

from hydro2d.base.keys import (
    Length,
    Name,
    Number,
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
from hydro2d.deck.shapes.outlines import Outline


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

    # The part that bodies of a shape play. A shape overrides what differs from a body that is neither rod nor plate.
    #: whether it is taken for a target if the deck names none
    is_target: ClassVar[bool] = False
    #: word for its extent along z in messages
    extent_word: ClassVar[str] = "height"
    #: whether it must lie wholly in the mesh, and the key that puts a part of it at r < 0 of a cylindrical mesh
    must_be_whole: ClassVar[bool] = False
    radial_key: ClassVar[str | None] = None
    #: whether it is slender, so that it needs cells across its radius and its length needs none
    is_slender: ClassVar[bool] = False

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

    strength_factor: PositiveNumber | None = Field(
        None, description="factor on the flow stress of its material, at every strain, rate, temperature and pressure; the "
        "shear modulus stays as it is", examples=[1.05],
    )

    @model_validator(mode="after")
    def _one_thermal_state(self):
        given = [key for key in ("energy", "pressure", "temperature") if getattr(self, key) is not None]
        if self.energy is not None and len(given) > 1:
            raise ValueError(f"give {' or '.join(given)}, not both")
        if len(given) == 2 and self.density is not None:
            raise ValueError("give two of density, pressure and temperature; the third follows")
        return self

    def outline(self, r_start: float) -> Outline:
        """The outline; a body without an inner edge begins at ``r_start``, the inner edge of the mesh, m."""
        raise NotImplementedError

    @property
    def projectile_rank(self) -> int:
        """How soon it is taken for the projectile if the deck names none: the body with the highest rank is; 0: never."""
        return 0

    @property
    def own_radius(self) -> float | None:
        """Radius by which cells are counted across it and a yield factor is set, m; None for a shape without one."""
        return None

    @property
    def size(self) -> tuple[float, float] | None:
        """Diameter and length that its deck gives, m; None if they are those of its outline."""
        return None

    def resolved_width(self, r_start: float) -> float:
        """Length across which `mesh.cells_across` counts cells, m: the smaller of its width from the axis and its thickness."""
        outline = self.outline(r_start)
        (inner, outer), (low, high) = outline.extent("r"), outline.extent("z")
        return min(outer - max(inner, r_start), high - low)

    def reach_radius(self, r_start: float) -> float:
        """Radius that `mesh.reach = "N radii"` counts, m; inf for a body that reaches the edge of the mesh."""
        return self.outline(r_start).extent("r")[1]

    @property
    def lies_on_axis(self) -> bool:
        """Whether it is a solid projectile on the axis, whose length is that of its outline."""
        return False

    @property
    def nose_direction(self) -> int | None:
        """1 if its nose points towards +z, -1 for -z; None for a shape without a nose."""
        return None

    @property
    def thickness_in_models(self) -> float | None:
        """Thickness of a target, m, for the analytic models; None for other shapes."""
        return None
