"""Analytic models with materials of the library: finds every input and its source, then evaluates the model.

An input comes, in this order, from the user, a deck, the material library, the geometry of a cylinder of equal mass, its
default, and last the example of the model, which is always stated.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from hydro2d.analytic import model_materials
from hydro2d.analytic.model_materials import Given
from hydro2d.base import units
from hydro2d.base.errors import unknown
from hydro2d.materials import library
from hydro2d.materials.material import Material
from hydro2d.penetration import catalogue
from hydro2d.penetration.inputs import FROM_LIBRARY, ROD_DIAMETER, ROD_LENGTH, ROD_MASS
from hydro2d.penetration.model import Input, InputError, Model, Value

VELOCITY = "velocity"
EXAMPLE = "the model's example"
#: the side that an input belongs to, by the first part of its name
SIDES = {"rod": "rod", "nose": "rod", "target": "target", "cavity": "target"}
DIAMETER, LENGTH, MASS = CYLINDER = (ROD_DIAMETER.name, ROD_LENGTH.name, ROD_MASS.name)
LIBRARY = {side: {f"{side}.{last}" for last in FROM_LIBRARY} for side in ("rod", "target")}


@dataclass(frozen=True)
class Request:
    """The choices of a user: materials, inputs by name in SI, a geometry (from a deck), the plastic strain of the strengths."""

    rod: Material | None = None
    target: Material | None = None
    settings: Mapping[str, Value] = field(default_factory=dict)
    geometry: Mapping[str, Given] = field(default_factory=dict)
    strain: float = 0.0

    @property
    def thickness(self) -> float | None:
        """Thickness of the target over the length of the rod; None unless both are given."""
        given = {name: each.value for name, each in self.geometry.items()} | dict(self.settings)
        thickness, length = given.get("target.thickness"), given.get("rod.length")
        return thickness / length if isinstance(thickness, float) and isinstance(length, float) and length else None


@dataclass(frozen=True)
class Case:
    """A model with all its inputs."""

    model: Model
    inputs: Mapping[str, Given]

    @property
    def values(self) -> dict[str, Value]:
        return {name: given.value for name, given in self.inputs.items()}

    @property
    def borrowed(self) -> list[str]:
        """Names of the inputs that come from the model's example."""
        return sorted(name for name, given in self.inputs.items() if EXAMPLE in given.source)

    def rows(self, velocities: Sequence[float]) -> list[dict[str, float | str]]:
        """Outputs by name, with the velocity, at impact velocities in m/s. Raises InputError."""
        return [{VELOCITY: velocity, **self._at(velocity, len(velocities) > 1)} for velocity in velocities]

    def _at(self, velocity: float, one_of_many: bool) -> dict[str, float | str]:
        try:
            return self.model(velocity, self.values)
        except InputError as error:
            raise InputError(f"at {velocity:g} m/s: {error}" if one_of_many else str(error)) from None

    def transition(self) -> float | None:
        """Impact velocity above which the rod is no longer rigid, m/s; None if it is always rigid."""
        return self.model.limit(self.values)


def named(name: str) -> Model:
    """A model of the catalogue. Raises InputError with the nearest name."""
    if name not in catalogue.MODELS:
        raise InputError(unknown("model", name, catalogue.MODELS))
    return catalogue.MODELS[name]


def example(model: Model) -> Case:
    """The model with the inputs of its example."""
    return resolve(model, Request())


def settings(texts: Sequence[str], models: Sequence[Model]) -> dict[str, Value]:
    """Inputs by name in SI from key=value. Raises InputError if no model has the key or the value is not allowed."""
    known = {entry.name: entry for model in models for entry in model.inputs}
    if set(CYLINDER) & set(known):
        known |= {entry.name: entry for entry in (ROD_DIAMETER, ROD_LENGTH, ROD_MASS)}
    values = {}
    for text in texts:
        key, equals, value = (part.strip() for part in text.partition("="))
        if not equals:
            raise InputError(f'--set "{text}": expected key=value')
        if key not in known:
            raise InputError(f"--set {text}: {unknown('input', key, known)}")
        values[key] = known[key].check(_si(known[key], value))
    return values


def _si(entry: Input, text: str) -> Value:
    """A word as it is, a quantity in SI."""
    if entry.choices or entry.unit == "":
        return text
    try:
        return units.of_argument(text, entry.unit)
    except ValueError as error:
        raise InputError(f"{entry.name}: {error}") from None


def resolve(model: Model, request: Request) -> Case:
    """Every input of a model with its source. Raises InputError for an impossible or missing input."""
    chosen = {name: Given(value, "given") for name, value in request.settings.items()}
    given = {**_library(model, request), **request.geometry, **chosen}
    given.update(_cylinder(model, request, chosen, given.get("rod.density")))
    inputs = {}
    for entry in model.inputs:
        value = given.get(entry.name) or _fallback(model, request, entry)
        if value is not None:
            inputs[entry.name] = value
    case = Case(model, inputs)
    model.collect(case.values)
    return case


def _library(model: Model, request: Request) -> dict[str, Given]:
    """Inputs from the materials by name; without a chosen material, those of the example."""
    values = {}
    for side in ("rod", "target"):
        wanted = {entry.name for entry in model.inputs if entry.name in LIBRARY[side]} | {f"{side}.density"}
        material, about = getattr(request, side), ""
        if material is None:
            values.update((name, value) for name in wanted if (value := _example(model, name)) is not None)
            wanted -= set(values)
            name, about = getattr(model.example, side), f"; {EXAMPLE}"
            material = library.load(name) if name else None
        if material is not None:
            for last, given in model_materials.quantities(material, request.strain).items():
                if f"{side}.{last}" in wanted:
                    values[f"{side}.{last}"] = Given(given.value, given.source + about)
    return values


def _example(model: Model, name: str) -> Given | None:
    return Given(model.example.values[name], EXAMPLE) if name in model.example.values else None


def _fallback(model: Model, request: Request, entry: Input) -> Given | None:
    """The value of the example if the user chose nothing for that side, else the default, else the value of the example."""
    value, side = _example(model, entry.name), SIDES.get(entry.name.split(".")[0])
    if value is not None and all(getattr(request, each) is None for each in ([side] if side else ["rod", "target"])):
        return value
    return value if entry.required else Given(entry.default, "default")


def _cylinder(model: Model, request: Request, chosen: Mapping[str, Given], density: Given | None) -> dict[str, Given]:
    """Diameter, length and mass of a cylinder: the user's choices, supplemented to two, and the third from the density."""
    have = {name: chosen[name] for name in CYLINDER if name in chosen}
    if not have and not set(CYLINDER) & set(request.geometry) and request.rod is None:
        have = {name: value for name in CYLINDER if (value := _example(model, name)) is not None}
    needed = {entry.name for entry in model.inputs if entry.required}
    offers = [(name, request.geometry.get(name)) for name in CYLINDER]
    offers += [(name, _example(model, name)) for name in CYLINDER if name in needed]
    for name, value in offers:
        if value is not None and name not in have and len(have) < 2:
            have[name] = value
    missing = set(CYLINDER) - set(have)
    if len(missing) == 1 and density is not None:
        have.update(_third(missing.pop(), {name: entry.value for name, entry in have.items()}, density.value))
    return have


def _third(name: str, cylinder: Mapping[str, float], density: float) -> dict[str, Given]:
    source = "cylinder of the other two of rod.diameter, rod.length, rod.mass, and rod.density"
    if name == MASS:
        value = density * math.pi / 4.0 * cylinder[DIAMETER] ** 2 * cylinder[LENGTH]
    elif name == LENGTH:
        value = cylinder[MASS] / (density * math.pi / 4.0 * cylinder[DIAMETER] ** 2)
    else:
        value = math.sqrt(cylinder[MASS] / (density * math.pi / 4.0 * cylinder[LENGTH]))
    return {name: Given(value, source)}
