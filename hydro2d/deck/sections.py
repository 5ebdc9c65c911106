"""The sections of a deck and all their keys, with defaults and meanings."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, PrivateAttr, model_validator

from hydro2d.base.keys import (
    FolderName,
    Length,
    Name,
    NotNegativeSpeed,
    PositiveLength,
    PositiveSpeed,
    PositiveTime,
    Section,
    Words,
)
from hydro2d.base.method_sections import Failure, Numerics, Sliding
from hydro2d.deck.boundary_section import Boundaries
from hydro2d.deck.mesh_sections import Mesh
from hydro2d.deck.shapes.registry import AnyBody
from hydro2d.sources.registry import AnySource


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
    from hydro2d.materials import quantities

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


class OwnFile(Section):
    """Results of your own: a Python file with one class of results and the function that measures them.

    A resolved deck has the text of the file in place of its name.
    """

    file: str | None = Field(None, description="the Python file, next to the deck", examples=["rim.py"])
    code: str | None = Field(None, description="its text, in a resolved deck", examples=["def measure(sim): ..."])
    code_from: str = Field("result", description="the name of that file", examples=["rim.py"])

    @model_validator(mode="after")
    def _has_a_file(self) -> OwnFile:
        if self.code is None:
            raise ValueError("file is missing: the Python file that measures the results")
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
    result: dict[Words, OwnFile] = Field({}, description="files of results of your own, each under a name of your choice")
    experiment: Experiment | None = None
    penetration: Penetration | None = None

    def to_toml(self) -> str:
        """The deck with every default written out and its materials in full; loading it gives the same deck."""
        from hydro2d.files.toml import dumps

        data = self.model_dump()
        data["materials"] = {name: material.as_deck() for name, material in self.materials.items()}
        return dumps(data)
