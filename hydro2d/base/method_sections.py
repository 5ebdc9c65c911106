"""The sections of a deck about the method. Kernels read the numbers of these by the names of their keys."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from hydro2d.base import units
from hydro2d.base.keys import Fraction, NotNegative, PositiveNumber, Section, Time, within


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


#: the sections
METHOD_SECTIONS: tuple[type[Section], ...] = (Numerics, Sliding, Failure)


def numbers(section: type[Section]) -> dict[str, tuple[Any, str]]:
    """Kind (float, int or bool) and meaning of every key of a section that is always a number, by its name."""
    return {name: (field.annotation, field.description or "") for name, field in section.model_fields.items()
            if field.annotation in (float, int, bool)}
