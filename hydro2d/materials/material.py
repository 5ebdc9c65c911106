"""A material and its models, each with all of their numbers, and the source of every number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import ModuleType
from typing import TYPE_CHECKING

from hydro2d.base.errors import unknown
from hydro2d.files.toml import PARTS

if TYPE_CHECKING:
    from hydro2d.materials.outside import Outside
    from hydro2d.materials.sesame import Table

#: how reliable a number is
CONFIDENCE = {
    "printed": "printed in the study that the material is taken from",
    "found": "read in a public source, not in the original",
    "recalled": "quoted from memory of the source, not read again",
    "doubtful": "quoted from memory with little certainty, or printed and improbable",
    "derived": "computed from other entries",
    "fitted": "fitted to measurements by a command of hydro2d",
    "chosen": "a choice of this library",
    "deck": "given by the deck",
    "default": "the default of the model",
}


@dataclass(frozen=True)
class Number:
    """A parameter in SI, with its source."""

    value: float
    unit: str
    source: str
    confidence: str
    note: str = ""


@dataclass(frozen=True)
class Model:
    """A model by name, with a number for every parameter; a model from outside also has the name and text of its file.

    trusted : whether this text, which may be a stranger's, may be run
    solid : name of the equation of state that it builds on, if there is one; its parameters are among the numbers
    table, table_from : the text of its table, or of its solid's, if there is one, and the name of the file
    """

    name: str
    numbers: Mapping[str, Number] = field(default_factory=dict)
    file: str = ""
    code: str = ""
    trusted: bool = True
    solid: str = ""
    table: str = ""
    table_from: str = ""

    @property
    def values(self) -> dict[str, float]:
        return {name: number.value for name, number in self.numbers.items()}

    def outside(self, part: str) -> Outside | None:
        """The model from outside, as a part of a material; None for a model of hydro2d.

        Raises ModelError if it is not trusted.
        """
        from hydro2d.materials import outside

        if not self.trusted:
            raise outside.ModelError(f"{self.unread(part)}; --trust, in Python trust=True, runs it")
        return outside.from_text(self.code, self.file, part) if self.code else None

    def unread(self, part: str) -> str:
        """A message that its code is not run; empty for a trusted model."""
        from hydro2d.materials import outside

        what = f"the {outside.KINDS[part].title} {self.name} ({self.file})"
        return "" if self.trusted else f"the code of {what}, which the deck of the run carries, is not run"

    def module(self, part: str) -> ModuleType:
        """Its functions and constants."""
        from hydro2d.materials import outside

        model = self.outside(part)
        return model.module if model else outside.KINDS[part].models[self.name]

    @property
    def title(self) -> str:
        """Its name, with those of the model that it builds on and of its table."""
        over, table = f" over {self.solid}" if self.solid else "", f" ({self.table_from})" if self.table else ""
        return f"{self.name}{over}{table}"

    def base(self) -> tuple[ModuleType | Table, ...]:
        """Further inputs of its row: the equation of state that it builds on, and the table."""
        from hydro2d.materials import sesame

        over = (solid_model(self.solid)[0],) if self.solid else ()
        return (*over, sesame.read(self.table)) if self.table else over

    def as_deck(self) -> dict:
        """The model as a table of a deck, every number in SI."""
        code = {"code_from": self.file, "code": self.code} if self.code else {}
        solid = {"solid": self.solid} if self.solid else {}
        table = {"table_from": self.table_from, "table_data": self.table} if self.table else {}
        numbers = {name: number.value for name, number in self.numbers.items()}
        return {"model": self.name, **solid, **numbers, **code, **table}


#: the keys of the tensions at which a material fractures
FRACTURE = ("fracture_pressure", "fracture_stress")


@dataclass(frozen=True)
class Material:
    """A resolved material, with all defaults filled in."""

    name: str
    title: str
    note: str
    eos: Model
    strength: Model
    damage: Model
    fracture_pressure: Number | None
    #: the largest principal stress that it bears
    fracture_stress: Number | None = None
    #: the parameters of its melting line (strength/melting.py), empty without one
    melting: Mapping[str, Number] = field(default_factory=dict)
    variants: Mapping[str, str] = field(default_factory=dict)
    #: whether it sets its damage model itself, even to "none"
    says_damage: bool = field(default=False, compare=False)
    #: parts, and tensions of fracture, that each of its variants sets
    variant_keys: Mapping[str, tuple[str, ...]] = field(default_factory=dict, compare=False)

    @property
    def reference_density(self) -> float:
        """Density at zero pressure and energy, kg/m^3."""
        return self.eos.numbers["reference_density"].value

    @property
    def has_strength(self) -> bool:
        return self.strength.name != "hydrodynamic"

    def number(self, part: str, key: str = "") -> Number | None:
        """A number by its keys in a deck, such as "eos" and "sound_speed", or "fracture_pressure" alone; None without it."""
        if not key:
            return getattr(self, part) if part in FRACTURE else None
        numbers = getattr(self, part).numbers if part in PARTS else self.melting if part == "melting" else {}
        return numbers.get(key)

    def variants_with(self, *keys: str) -> list[str]:
        """Names of the variants that set one of these keys."""
        return [name for name, own in self.variant_keys.items() if set(own) & set(keys)]

    def as_deck(self) -> dict:
        """The material as a table of a deck, every number in SI."""
        data: dict = {"title": self.title} if self.title else {}
        for key in FRACTURE:
            if (number := getattr(self, key)) is not None:
                data[key] = number.value
        if self.melting:
            data["melting"] = {key: number.value for key, number in self.melting.items()}
        for part in PARTS:
            data[part] = getattr(self, part).as_deck()
        return data

    def unread(self) -> list[str]:
        """A message for each model that is not trusted, that its code is not run."""
        return [said for part in PARTS if (said := getattr(self, part).unread(part))]

    def tables(self) -> list[dict]:
        """Entries of its tables in a summary."""
        from hydro2d.materials import sesame

        return [{"kind": "table", "name": self.name, "file": self.eos.table_from, "sha256": sesame.digest(self.eos.table)}
                ] if self.eos.table else []

    def from_outside(self) -> list[Outside]:
        """Its models from outside. Raises ModelError if one is not trusted."""
        models = [each for part in PARTS if (each := getattr(self, part).outside(part))]
        below = solid_model(self.eos.solid)[1] if self.eos.solid else None
        return [*models, below] if below else models


def solid_model(name: str) -> tuple[ModuleType, Outside | None]:
    """The equation of state, without internal variables, that another one builds on: its module, and the model from outside.

    Raises ValueError for an unknown name.
    """
    from hydro2d.materials import outside

    models = outside.KINDS["eos"].models
    below = None if name in models else outside.from_package("eos", name)
    solid = below.module if below else models.get(name)
    if solid is None or hasattr(solid, "INTERNAL"):
        plain = [each for each, module in models.items() if not hasattr(module, "INTERNAL")]
        raise ValueError(unknown("equation of state without memory", name, [*plain, *outside.in_packages("eos")]))
    return solid, below
