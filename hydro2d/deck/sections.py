"""The sections of a deck and all their keys, with defaults and meanings."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, PrivateAttr, WithJsonSchema, model_validator

from hydro2d.base import units
from hydro2d.base.keys import (
    FolderName,
    Fraction,
    Length,
    Name,
    NotNegative,
    NotNegativeSpeed,
    PositiveLength,
    PositiveNumber,
    PositiveSpeed,
    PositiveTime,
    Section,
    Time,
    Words,
    within,
)
from hydro2d.deck.boundary_section import Boundaries
from hydro2d.deck.mesh_sections import Mesh
from hydro2d.deck.shapes.registry import AnyBody
from hydro2d.sources.registry import AnySource


class Numerics(Section):
    """Choices and coefficients of the method."""

    advection: Literal["ke", "momentum", "both"] = Field(
        "both", description="what the remap of velocities conserves: kinetic energy, momentum, or both (lost kinetic "
        "energy becomes heat); ke is clipped in strong shocks, and momentum discards kinetic energy there"
    )
    ke_bound: Annotated[float, within(1.0, 1e12, "below 1 a node could not keep the velocity of its own momentum")] = Field(
        1.05, description="upper bound of |u| / |momentum/mass| in the ke remap", examples=[1.1]
    )
    courant: Annotated[float, within(1e-3, 1.0, "above 1 no step is stable")] = Field(
        0.7, description="ratio of the time step to the time in which the fastest wave crosses a cell", examples=[0.4]
    )
    shock_courant: Annotated[float, within(1e-3, 1.0, "above 1 no step is stable")] = Field(
        0.5, description="this ratio in a shock, where the artificial viscosity acts; courant if that is less", examples=[0.4]
    )
    advective_courant: PositiveNumber = Field(
        0.4, le=0.5, description="largest fraction of a cell that material crosses in one step", examples=[0.3]
    )
    max_growth: Annotated[float, within(1.0, 2.0, "a step that grows faster exceeds the limits that set it")] = Field(
        1.1, description="largest ratio of successive time steps", examples=[1.05]
    )
    ramp_cycles: int = Field(
        100, ge=0, le=1_000_000, description="cycles over which the time step rises from its initial factor", examples=[200])
    initial_dt_factor: Fraction = Field(
        0.1, gt=0, description="ratio of the first time step to the stable one", examples=[0.05]
    )
    dt_min: Time = Field(1e-14, description="a time step below this ends the run as unphysical", examples=["1e-13 s"])
    viscosity_linear: Annotated[float, within(0.0, 2.0, "more viscosity only shortens the time step")] = Field(
        0.5, description="linear coefficient of the artificial viscosity", examples=[0.2]
    )
    viscosity_quadratic: Annotated[float, within(0.0, 4.0, "more viscosity only shortens the time step")] = Field(
        1.3, description="quadratic coefficient of the artificial viscosity", examples=[2.0]
    )
    hourglass: Annotated[float, within(0.0, 0.5, "a stronger filter is unstable")] = Field(
        0.05, description="coefficient of the hourglass filter", examples=[0.1]
    )
    steepness: Annotated[float, within(1.0, 2.0, "a steeper slope makes new extrema, a flatter one is first-order")] = (
        Field(2.0, description="largest slope of what the remap carries, in units of the smaller difference to a neighbour: 2 "
              "keeps waves sharp, and falls to 1 where density changes by 5 to 30 % from cell to cell, which keeps strong "
              "shocks round", examples=[1.0])
    )
    mixed_cell: Literal["tipton", "uniform"] = Field(
        "tipton", description="how the materials of a mixed cell share its volume change"
    )
    relaxation: Annotated[float, within(1e-6, 1.0, "at 1 the pressures meet within a step, above it they overshoot")] = Field(
        0.25, description="gamma of the pressure relaxation in mixed cells", examples=[0.5]
    )
    mixed_strength: Literal["volume", "solid", "zero", "max", "material"] = Field(
        "volume", description="strength of a mixed cell: mean over its volume, mean over the volume of the materials, none, "
        "the largest, or that of each material"
    )
    cutoff: Fraction = Field(
        1e-8, ge=1e-12, lt=0.01,
        description="volume fractions below this are removed and listed in the conservation audit; below 1e-12 is round-off",
        examples=[1e-09],
    )
    mass_floor: Fraction = Field(
        1e-6, description="fraction of a node's full mass below which its velocity is limited", examples=[1e-05]
    )
    clip_limit: Fraction = Field(
        0.02, description="fraction of the energy that a clip (sub-cutoff volume fractions, the bound of ke, the speed limit) "
        "may remove before the run ends as unphysical; with any value, a summary is trustworthy only up to 0.02",
        examples=[0.05],
    )
    active_region: bool = Field(True, description="skip cells that no signal has reached")
    interface_order: tuple[str, ...] = Field(
        (), description="order in which interfaces of bodies are placed in mixed cells; default: the hard bodies of a contact, "
        "then the others, in the order of the deck",
        examples=[["rod", "plate"]],
    )


def _width(value):
    """A number counts cells of the finest size. A string is a length and remains a string."""
    if isinstance(value, str):
        if units.to_si(value, "m") < 0:
            raise ValueError("must not be negative")
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value < 0:
        raise ValueError('expected a number of cells such as 2, or a length such as "0.8 mm"')
    return float(value)


def _factor(value):
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        if value <= 0:
            raise ValueError("must be positive")
        return float(value)
    if value not in ("radius", "printed", "off"):
        raise ValueError(f'must be "radius", "printed", "off" or a number, is {value!r}')
    return value


_NUMBER_OR_TEXT = {"anyOf": [{"type": "number"}, {"type": "string"}]}
Width = Annotated[float | str, BeforeValidator(_width), WithJsonSchema(_NUMBER_OR_TEXT)]
Factor = Annotated[float | str, BeforeValidator(_factor), WithJsonSchema(_NUMBER_OR_TEXT)]


class Sliding(Section):
    """Sliding between hard and soft bodies. Keys that do not mention a contact belong to the slip layer."""

    method: Literal["none", "slip-layer", "contact"] = Field(
        "none",
        description="none: tied contact, all bodies share one velocity field; slip-layer: soft material next to the hard "
        "bodies loses its shear stress; contact: the hard bodies have velocities of their own",
    )
    hard: tuple[str, ...] = Field(
        (), description="bodies that keep their own strength in mixed cells (slip layer) or have own velocities (contact)",
        examples=[["rod"]],
    )
    boundary_layer: Width = Field(
        2.0, description="width of the soft material that moves with the hard body: cells, or a length", examples=["0.8 mm"]
    )
    slip_layer: Width = Field(
        2.0, description="width of the soft material beyond it that loses shear: cells, or a length", examples=[3.0]
    )
    threshold: Fraction = Field(
        0.3, description="volume fraction of hard material from which a cell counts as hard", examples=[0.5]
    )
    yield_factor: Factor = Field(
        "off",
        description='factor on the yield stress of hard bodies: ((R + w)/R)^2 ("radius"), the same with the density in cgs for '
        'R ("printed"), a number, or "off"; a contact takes "off" or a number',
        examples=["radius"],
    )
    shear: Literal["fluid", "shear"] = Field(
        "fluid", description="what the slip layer loses: all deviatoric stress, or the shear stress along the interface"
    )
    friction: NotNegative = Field(
        0.0, description='Coulomb coefficient at the interface of a contact, or in the slip layer with shear = "shear"',
        examples=[0.05],
    )
    refresh: int = Field(5, ge=1, le=1_000_000, description="cycles between updates of the distance field", examples=[10])


class Failure(Section):
    """The failure models of the materials in use, and the opening of void."""

    tensile: Literal["material", "none"] = Field(
        "material", description="tensile failure at the fracture pressure of each material, or none"
    )
    damage: Literal["material", "none"] = Field("none", description="the damage model of each material, or none")
    melting: Literal["material", "none"] = Field(
        "none", description="no strength from the melting line of each material on, with any strength model; or as the "
        "strength model alone says"
    )
    tension: Literal["mean", "min"] = Field(
        "mean", description="fracture pressure of a mixed cell: mean by volume fraction, or the smallest"
    )
    max_opening: Fraction = Field(
        0.2, gt=0, description="largest fraction of a cell that becomes void in one cycle", examples=[0.1]
    )
    strength_cutoff: Fraction = Field(
        0.94, lt=1, examples=[0.9],
        description="low-density strength cutoff: fraction of the reference density below which a material carries no shear; "
        "0: never",
    )
    record: bool = Field(
        False, description="keep and write what has ended the strength of each body in each cell, as the fields failed_by and "
        "body_failed_by"
    )


class Stop(Section):
    """The end of the run: at the first of these conditions. The speed of a body is checked every 10 cycles.

    If the speed of the projectile, its rebound or perforation is watched, the run also ends when it has left the mesh. If
    a body is slower than `speed_below` at the start, its speed counts only once it has been faster.
    """

    time: PositiveTime | None = Field(None, description="end time", examples=["400 us"])
    cycles: int | None = Field(None, gt=0, le=10**12, description="number of cycles", examples=[1000])
    body: str | None = Field(None, description="the body watched; default: the projectile", examples=["rod"])
    speed_below: PositiveSpeed | None = Field(
        None, description="stop when the axial speed of that body's centre of mass, for a rod of its core, falls below this",
        examples=["5 m/s"],
    )
    rebound: bool = Field(False, description="stop when that body reverses the direction in which it first moved")
    perforation: Literal[False, True, "tail"] = Field(
        False, description="stop when the nose of the projectile is its radius beyond the rear face of the last target; tail: "
        "when its tail is beyond that face too"
    )


def _directory(value: str) -> str:
    if not value.strip() or "\0" in value:
        raise ValueError(f"{value!r} is not a path; leave the key out for runs/<name of the deck>")
    return value


def _fields(keys: tuple[str, ...]) -> tuple[str, ...]:
    """Names of quantities, and of groups of quantities. Their table is large and imported only if it is needed."""
    if set(keys) <= {"standard", "all"}:
        return keys
    from hydro2d.mesh import quantities

    try:
        quantities.expand(keys)
    except quantities.FieldError as error:
        raise ValueError(str(error)) from None
    return keys


class Output(Section):
    """The files written, their place and intervals."""

    directory: Annotated[str, AfterValidator(_directory)] | None = Field(
        None, description="run directory; default: runs/<name of the deck>", examples=["runs/shot_4344"]
    )
    history_interval: PositiveTime | None = Field(
        None, description="time between rows of the history; default: a thousandth of the end time", examples=["0.5 us"]
    )
    vtk_interval: PositiveTime | None = Field(
        None, description="time between dumps; default: a fiftieth of the end time", examples=["10 us"]
    )
    restart_interval: PositiveTime = Field(300.0, description="wall-clock time between restart files", examples=["10 min"])
    fields: Annotated[tuple[str, ...], AfterValidator(_fields)] = Field(
        ("standard",), description="fields of the VTK files, by name", examples=[["pressure", "von_mises", "velocity"]]
    )


class Tracer(Section):
    """A point that moves with the material."""

    name: Name = Field(description="name of the tracer in the history", examples=["tail"])
    r: Length = Field(description="radial position at time zero", examples=["0 mm"])
    z: Length = Field(description="axial position at time zero", examples=["-97 mm"])


class Gauge(Section):
    """A fixed point, or a line of them from (r, z) to (r_end, z_end); with `surface` they stay on it."""

    name: Name = Field(
        description="name of the gauge in the history; the points of a line are NAME_1, NAME_2 and so on", examples=["inside"]
    )
    r: Length = Field(description="radial position", examples=["0 mm"])
    z: Length = Field(description="axial position", examples=["2 cm"])
    r_end: Length | None = Field(
        None, description="radial position of the last point of a line; default: the same as the first", examples=["0 mm"]
    )
    z_end: Length | None = Field(
        None, description="axial position of the last point of a line; default: the same as the first", examples=["10 cm"]
    )
    points: int = Field(1, ge=1, le=10_000, description="number of points of the line, the ends included", examples=[9])
    surface: str | None = Field(
        None, description="a body on whose surface the gauge stays: the face nearest to (r, z) at the start; its velocity is "
        "that of the free surface", examples=["plate"],
    )
    along: Literal["r", "z"] | None = Field(
        None, description="the direction in which a gauge on a surface moves with it; default: z", examples=["r"]
    )

    @model_validator(mode="after")
    def _line(self) -> Gauge:
        if self.along is not None and self.surface is None:
            raise ValueError("along is for a gauge on a surface, which `surface` names")
        if (self.points > 1) != (self.r_end is not None or self.z_end is not None):
            raise ValueError("a line of gauges needs an end, r_end or z_end, and more than one of `points`")
        return self

    def places(self) -> list[tuple[str, tuple[float, float]]]:
        """Name and position (r, z) in m of each point."""
        if self.points == 1:
            return [(self.name, (self.r, self.z))]
        last = (self.r if self.r_end is None else self.r_end, self.z if self.z_end is None else self.z_end)
        shares = [n / (self.points - 1) for n in range(self.points)]
        return [(f"{self.name}_{n}", (self.r + share * (last[0] - self.r), self.z + share * (last[1] - self.z)))
                for n, share in enumerate(shares, 1)]


class Experiment(Section):
    """Measured results, shown next to those of the run; the run does not use them.

    If an override or an including deck changes the impact velocity (by more than 1 %) or the target, so that the deck is no
    longer this shot, the resolved deck has no experiment.
    """

    velocity: PositiveSpeed | None = Field(
        None, description="impact velocity of the shot; default: that of the projectile relative to its target",
        examples=["1086 m/s"],
    )
    target: str | None = Field(
        None, description="material of the target in the shot; default: that of the target", examples=["Al5083"]
    )
    penetration: PositiveLength | None = Field(None, description="depth below the original surface", examples=["44.8 cm"])
    qualifier: Literal["measured", "estimated", "at least"] = Field("measured", description="how the depth is known")
    residual_velocity: NotNegativeSpeed | None = Field(
        None, description="velocity of the projectile behind the last target; 0 if it did not perforate", examples=["199.7 m/s"]
    )
    source: str = Field(
        min_length=1, description="where the numbers come from", examples=["Scheffler, CTH nose-shape study, Table 2"]
    )

    @model_validator(mode="after")
    def _belongs_to_a_velocity(self):
        if self.residual_velocity is not None and self.velocity is None:
            raise ValueError("residual_velocity needs velocity, the impact velocity of the shot")
        return self


class Penetration(Section):
    """The bodies between which the penetration depth is measured."""

    rod: str = Field(description="the body that penetrates", examples=["rod"])
    target: str | None = Field(
        None, description="the body that is penetrated; of several, the first", examples=["plate"]
    )
    targets: tuple[str, ...] = Field(
        (), description="the bodies that are penetrated, in the order in which it reaches them; default: target alone",
        examples=[["front", "rear"]],
    )
    surface: Length | None = Field(
        None, description="original position of the face of the first target; default: its face in the deck", examples=["0 mm"]
    )

    @model_validator(mode="after")
    def _has_a_target(self):
        if self.target is None and not self.targets:
            raise ValueError("target or targets is missing: the bodies that are penetrated")
        if self.target is not None and self.targets and self.target != self.targets[0]:
            raise ValueError(f'target is "{self.target}" and the first of targets is "{self.targets[0]}"; give one of them')
        if len(set(self.targets)) < len(self.targets):
            raise ValueError("targets names a body twice")
        return self


class Deck(Section):
    """The tables of an input deck, in SI units. Sections are attributes: deck.numerics.courant, deck.body[0].name."""

    #: the layout of its bodies on its mesh, once `layout.layout` has made it
    _layout: Any = PrivateAttr(None)

    name: FolderName = Field("deck", description="name of the run; default: the name of the file", examples=["shot_4344"])
    title: str = Field(
        "", description="title for logs and pictures", examples=["Shot 4344: hemispherical nose, 5083 aluminium, 1086 m/s"]
    )
    numbers: Literal["SI"] | None = Field(
        None, description="SI: numbers without a unit are in SI units; without this key every quantity of this file, and of "
        "`--set`, names its unit, except 0", examples=["SI"],
    )
    mesh: Mesh
    boundaries: Boundaries = Boundaries()
    body: tuple[AnyBody, ...] = Field(min_length=1, description="bodies; where they overlap, the first of them takes the space")
    materials: dict[Words, Any] = Field({}, description="materials of this deck, each either complete or `based_on` another")
    numerics: Numerics = Numerics()
    sliding: Sliding = Sliding()
    failure: Failure = Failure()
    stop: Stop
    output: Output = Output()
    tracer: tuple[Tracer, ...] = ()
    gauge: tuple[Gauge, ...] = ()
    source: tuple[AnySource, ...] = Field((), description="what adds energy or momentum to bodies")
    derived: dict[str, str] = Field(
        {}, description="quantities by name, each a formula of short names and columns of the history, for the history, the "
        "summary and reports", examples=[{"P/L": "depth / length0"}],
    )
    experiment: Experiment | None = None
    penetration: Penetration | None = None

    def to_toml(self) -> str:
        """The deck with every default written out and its materials in full; loading it gives the same deck."""
        from hydro2d.files.toml import dumps

        data = self.model_dump()
        data["materials"] = {name: material.as_deck() for name, material in self.materials.items()}
        return dumps(data)
