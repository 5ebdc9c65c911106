"""Named materials: the library, the materials of a deck, and the rows of numbers that kernels read.

A material is an equation of state, a strength model, a damage model, a melting line and a fracture pressure. Every number of
the library has its source and a confidence. Doubtful printed values are kept as variants, beside the default.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from hydro2d import units
from hydro2d.errors import DeckError, Sources, unknown
from hydro2d.materials.cracking import cracking_pressure, opens_cracks, over
from hydro2d.mesh.fields import INTERNAL, Field
from hydro2d.parameters import Parameter
from hydro2d.toml import PARTS, merge, parse, problems_folder

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

#: its tables of numbers: those of its models, and its melting line
TABLES = (*PARTS, "melting")
_KEYS = (*TABLES, "fracture_pressure", "title", "note", "source", "confidence", "variants", "variant", "based_on")
_ABOUT = ("source", "confidence", "note")
#: keys of a part that choose the model, the one that it stands over, and its table; the names of files have become two of these
_CHOICE = ("model", "code", "code_from", "solid", "table_data", "table_from")

if TYPE_CHECKING:
    from hydro2d.materials.outside import Outside
    from hydro2d.materials.sesame import Table

Fail = Callable[[tuple, str], Exception]


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
    solid : name of the equation of state that it stands over, if it stands over one; its parameters are among the numbers
    table, table_from : the text of its table, or that of its solid, if there is one, and the name of the file
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
        """Says that its code is not run; empty for a trusted model."""
        from hydro2d.materials import outside

        what = f"the {outside.KINDS[part].title} {self.name} ({self.file})"
        return "" if self.trusted else f"the code of {what}, which the deck of the run carries, is not run"

    def module(self, part: str) -> ModuleType:
        """Its functions and constants."""
        from hydro2d.materials import outside

        found = self.outside(part)
        return found.module if found else outside.KINDS[part].models[self.name]

    @property
    def title(self) -> str:
        """Its name, with that of the one that it stands over, and of its table."""
        over, table = f" over {self.solid}" if self.solid else "", f" ({self.table_from})" if self.table else ""
        return f"{self.name}{over}{table}"

    def base(self) -> tuple[ModuleType | Table, ...]:
        """What its row is made from beside its numbers: the equation of state that it stands over, and the table."""
        from hydro2d.materials import sesame

        over = (_solid(self.solid)[0],) if self.solid else ()
        return (*over, sesame.read(self.table)) if self.table else over

    def as_deck(self) -> dict:
        """The model as a table of a deck, every number in SI."""
        code = {"code_from": self.file, "code": self.code} if self.code else {}
        solid = {"solid": self.solid} if self.solid else {}
        table = {"table_from": self.table_from, "table_data": self.table} if self.table else {}
        return {"model": self.name, **solid, **self.values, **code, **table}


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
    #: the parameters of its melting line (strength/melting.py), empty without one
    melting: Mapping[str, Number] = field(default_factory=dict)
    variants: Mapping[str, str] = field(default_factory=dict)
    #: whether it sets its damage model itself, even to none
    says_damage: bool = field(default=False, compare=False)

    @property
    def reference_density(self) -> float:
        """Density at zero pressure and energy, kg/m^3."""
        return self.eos.numbers["reference_density"].value

    @property
    def has_strength(self) -> bool:
        return self.strength.name != "hydrodynamic"

    def as_deck(self) -> dict:
        """The material as a table of a deck, every number in SI."""
        data: dict = {"title": self.title} if self.title else {}
        if self.fracture_pressure is not None:
            data["fracture_pressure"] = self.fracture_pressure.value
        if self.melting:
            data["melting"] = {key: number.value for key, number in self.melting.items()}
        for part in PARTS:
            data[part] = getattr(self, part).as_deck()
        return data

    def unread(self) -> list[str]:
        """Says of each model that is not trusted that its code is not run."""
        return [said for part in PARTS if (said := getattr(self, part).unread(part))]

    def tables(self) -> list[dict]:
        """Entries of its tables in a summary."""
        from hydro2d.materials import sesame

        return [{"kind": "table", "name": self.name, "file": self.eos.table_from, "sha256": sesame.digest(self.eos.table)}
                ] if self.eos.table else []

    def from_outside(self) -> list[Outside]:
        """Its models from outside. Raises ModelError if one is not trusted."""
        found = [each for part in PARTS if (each := getattr(self, part).outside(part))]
        below = _solid(self.eos.solid)[1] if self.eos.solid else None
        return [*found, below] if below else found


@functools.cache
def _library() -> tuple[dict[str, dict], Sources]:
    """Raw tables of the library by name, and the places of their keys."""
    tables: dict[str, dict] = {}
    sources = Sources()
    for file in sorted((problems_folder() / "materials").glob("*.toml")):
        text = file.read_text(encoding="utf-8")
        data = parse(text, str(file))
        twice = sorted(set(data) & set(tables))
        if twice:
            raise DeckError(f"{file}: material {twice[0]} is defined in another file as well")
        sources.add(str(file), data, text)
        tables.update({name: _sourced(table, "chosen") for name, table in data.items()})
    return tables, sources


def _sourced(table: dict, confidence: str, about: dict | None = None) -> dict:
    """The table with source and confidence added to every number, so that it can be merged with another."""
    about = {"source": "", "confidence": confidence, **(about or {}), **_about(table), "note": ""}
    result = {key: value for key, value in table.items() if key not in ("source", "confidence")}
    for part in TABLES:
        if isinstance(table.get(part), dict):
            own = {**about, **_about(table[part])}
            rest = {key: value for key, value in table[part].items() if key not in _ABOUT}
            result[part] = {key: value if key in _CHOICE else _with(value, own) for key, value in rest.items()}
    if "fracture_pressure" in table:
        result["fracture_pressure"] = _with(table["fracture_pressure"], about)
    if "variants" in table:
        result["variants"] = {key: _sourced(entry, confidence, about) for key, entry in table["variants"].items()}
    return result


def _about(table: dict) -> dict:
    return {key: table[key] for key in ("source", "confidence") if key in table}


def _with(number, about: dict) -> dict:
    return {**about, **number} if isinstance(number, dict) else {**about, "value": number}


def names() -> list[str]:
    """The materials of the library."""
    return sorted(_library()[0])


def load(name: str, variant: str | None = None) -> Material:
    """A material of the library, or one of its variants. Raises DeckError if there is none."""
    tables, sources = _library()

    def fail(path: tuple, message: str) -> DeckError:
        return DeckError(f"{sources.where((name, *path), tables)}: material {name}: {message}")

    if name not in tables:
        raise DeckError(unknown("material", name, tables))
    return _build(name, _varied(tables[name], variant, fail), fail, True)


def from_deck(name: str, tables: Mapping[str, dict], fail: Fail, trust: bool = True) -> Material:
    """The material ``name`` of a deck: one of its own tables, or one of the library.

    ``fail(path, message)`` makes the error for a key of [materials]; it is raised here. Without ``trust`` no code of the deck
    is run, unless this process has run it before.
    """
    if name not in tables:
        return load(name)
    return _build(name, _based(name, tables, fail, ()), lambda path, text: fail((name, *path), text), trust)


def _based(name: str, tables: Mapping[str, dict], fail: Fail, chain: tuple[str, ...]) -> dict:
    """The raw table of a material of a deck, merged with the material on which it is based."""
    if not isinstance(tables[name], dict):
        raise fail((name,), "a material must be a table")
    variants = tables[name].get("variants", {})
    if not isinstance(variants, dict) or not all(isinstance(entry, dict) for entry in variants.values()):
        raise fail((name, "variants"), "must hold a table for each variant")
    own = _sourced(tables[name], "deck")
    base = own.get("based_on")
    if base is None:
        if "eos" not in own:
            hint = f'; to change a material of the library, write based_on = "{name}"' if name in names() else ""
            raise fail((name,), f"has no eos{hint}")
        raw = own
    elif not isinstance(base, str):
        raise fail((name, "based_on"), "must be the name of a material")
    elif base in tables and base != name:
        if base in chain:
            raise fail((name, "based_on"), f"are based on each other in a circle: {' -> '.join((*chain, name, base))}")
        raw = _overlaid(_based(base, tables, fail, (*chain, name)), own)
    elif base in names():
        raw = _overlaid(_library()[0][base], own)
    else:
        raise fail((name, "based_on"), unknown("material", str(base), {*names(), *tables} - {name}))
    return _varied(raw, own.get("variant"), lambda path, text: fail((name, *path), text), own)


def _overlaid(base: dict, over: dict) -> dict:
    """``over`` on ``base``; a part that names another model replaces the whole part.

    With another equation of state the melting line goes, which stands on its density and its Grueneisen coefficient.
    """
    base = dict(base)
    for part in PARTS:
        old, new = base.get(part), over.get(part)
        tables = isinstance(old, dict) and isinstance(new, dict)
        if tables and any(new.get(key, old.get(key)) != old.get(key) for key in ("model", "code", "solid")
                          if key != "solid" or key in old):
            del base[part]
            if part == "eos":
                base.pop("melting", None)
    return merge(base, {key: value for key, value in over.items() if key not in ("based_on", "variant")})


def _varied(raw: dict, variant, fail: Fail, own: dict | None = None) -> dict:
    """The table with one or several of its variants applied, and then the numbers of the deck itself."""
    chosen = [] if variant is None else [variant] if isinstance(variant, str) else variant
    known = raw.get("variants", {})
    if not isinstance(chosen, list):
        raise fail(("variant",), "must be the name of a variant or a list of names")
    for name in chosen:
        if str(name) not in known:
            raise fail(("variant",), unknown("variant", str(name), known))
        raw = _overlaid(raw, {key: value for key, value in known[name].items() if key != "title"})
    return _overlaid(raw, own) if own and chosen else raw


def _build(name: str, raw: dict, fail: Fail, trust: bool) -> Material:
    for key in raw:
        if key not in _KEYS:
            raise fail((key,), unknown("key", key, _KEYS))
    eos = _model(raw.get("eos"), "eos", None, {}, fail, trust)
    own = eos.numbers
    strength = _model(raw.get("strength"), "strength", "hydrodynamic", own, fail, trust)
    damage = _model(raw.get("damage"), "damage", "none", own, fail, trust)
    fracture = None
    if "fracture_pressure" in raw:
        fracture = _number(raw["fracture_pressure"], "Pa", ("fracture_pressure",), fail)
        if fracture.value <= 0:
            raise fail(("fracture_pressure",), f"must be positive (a tension), is {fracture.value:g}")
    melting = _melting(raw.get("melting"), eos, fail)
    variants = {key: str(entry.get("title", "")) for key, entry in raw.get("variants", {}).items()}
    title, note = str(raw.get("title", "")), str(raw.get("note", ""))
    return Material(name, title, note, eos, strength, damage, fracture, melting, variants, raw.get("damage") is not None)


def _chosen(raw, part: str, fail: Fail) -> tuple[ModuleType, str, str]:
    """The module that a part's table chooses, and the name and text of its file where it is from outside."""
    from hydro2d.materials import outside

    models = outside.KINDS[part].models
    if not isinstance(raw, dict) or not isinstance(raw.get("model"), str):
        raise fail((part,), f"needs a model (allowed: {', '.join(models)}) or a file")
    name = raw["model"]
    try:
        if "code" in raw:
            found = outside.from_text(str(raw["code"]), str(raw.get("code_from", name)), part)
        elif name in models:
            return models[name], "", ""
        else:
            found = outside.from_package(part, name)
    except outside.ModelError as error:
        raise fail((part,), str(error)) from None
    if found is None:
        raise fail((part, "model"), unknown(f"{part} model", name, [*models, *outside.in_packages(part)]))
    if found.name != name:
        raise fail((part, "model"), f'is "{name}", but the model in {found.file} is "{found.name}"')
    found.offer()
    return found.module, found.file, found.text


def _solid(name: str) -> tuple[ModuleType, Outside | None]:
    """The equation of state, without internal variables, that another one stands over: its module, and what is from outside.

    Raises ValueError for a name of none.
    """
    from hydro2d.materials import outside

    models = outside.KINDS["eos"].models
    below = None if name in models else outside.from_package("eos", name)
    found = below.module if below else models.get(name)
    if found is None or hasattr(found, "INTERNAL"):
        plain = [each for each, module in models.items() if not hasattr(module, "INTERNAL")]
        raise ValueError(unknown("equation of state without memory", name, [*plain, *outside.in_packages("eos")]))
    return found, below


def _table(module: ModuleType, raw: dict, part: str, fail: Fail) -> tuple[str, str]:
    """Text and name of the table that a part's model is made from; empty for a model that has none."""
    from hydro2d.materials import sesame

    if not hasattr(module, "FROM_TABLE"):
        if "table_data" in raw or "table_from" in raw:
            raise fail((part, "table"), f"{module.NAME} has no table")
        return "", ""
    text = raw.get("table_data")
    if not isinstance(text, str):
        raise fail((part,), f"{module.NAME} needs table, the name of a file with a table of the SESAME type 301")
    name = str(raw.get("table_from", "table"))
    try:
        sesame.read(text)
    except sesame.TableError as problem:
        raise fail((part, "table"), f"{name}: {problem}") from None
    return text, name


def _below(module: ModuleType, raw: dict, part: str, fail: Fail) -> ModuleType | None:
    """The equation of state of the solid that a part's model stands over; None where it stands over none."""
    if not getattr(module, "OVER_SOLID", False):
        if "solid" in raw:
            raise fail((part, "solid"), f"{module.NAME} stands over no other equation of state")
        return None
    if not isinstance(raw.get("solid"), str):
        raise fail((part,), f"{module.NAME} needs solid, the name of the equation of state of its solid")
    try:
        below, outside = _solid(raw["solid"])
    except ValueError as problem:
        raise fail((part, "solid"), str(problem)) from None
    if outside:
        outside.offer()
    return below


def _parameters(module: ModuleType, below: ModuleType | None) -> dict[str, Parameter]:
    """The parameters of a model by name, with those of the solid that it stands over, where it does."""
    of_solid = [each for each in below.PARAMETERS if each.name not in module.GIVEN_TO_SOLID] if below else []
    return {parameter.name: parameter for parameter in (*of_solid, *module.PARAMETERS)}


def _model(raw, part: str, default: str | None, eos: Mapping, fail: Fail, trust: bool) -> Model:
    """A model with all its parameters: given, taken from the equation of state, or the model's default."""
    if raw is None:
        if default is None:
            raise fail((), f"has no {part}")
        raw = {"model": default}
    if not trust and _has_strange_code(raw, part):
        return _unread(raw, part, fail)
    module, file, code = _chosen(raw, part, fail)
    below = _below(module, raw, part, fail)
    text, table_from = _table(below or module, raw, part, fail)
    numbers = _numbers(module.NAME, _parameters(module, below), raw, part, eos, fail)
    return Model(module.NAME, numbers, file, code, solid=raw.get("solid", ""), table=text, table_from=table_from)


def _melting(raw, eos: Model, fail: Fail) -> dict[str, Number]:
    """The parameters of a melting line: given, taken from the equation of state, or by default; empty without a line."""
    from strength import melting

    if raw is None:
        return {}
    if not isinstance(raw, dict):
        raise fail(("melting",), "must be a table")
    if eos.solid:
        raise fail(("melting",), f"{eos.title} does not say the density of the solid, on which a melting line stands")
    return _numbers(melting.NAME, {each.name: each for each in melting.PARAMETERS}, raw, "melting", eos.numbers, fail)


def _numbers(
    name: str, parameters: Mapping[str, Parameter], raw: dict, part: str, eos: Mapping, fail: Fail
) -> dict[str, Number]:
    """All parameters of what has this name: given by the table of a part, taken from the equation of state, or by default."""
    numbers = {}
    for key in raw:
        if key not in (*parameters, *_CHOICE):
            raise fail((part, key), _unknown_parameter(name, key, parameters))
    for key, parameter in parameters.items():
        if key in raw:
            number = _number(raw[key], parameter.unit or "1", (part, key), fail)
            try:
                parameter.check(number.value)
            except ValueError as problem:
                raise fail((part, key), str(problem)) from None
        elif parameter.from_eos and key in eos:
            number = eos[key]
        elif parameter.required:
            raise fail((part,), f"{name} needs {key} ({parameter.description}, {parameter.unit or '1'})")
        else:
            number = Number(float(parameter.default), parameter.unit or "1", f"{name} model", "default")
        numbers[key] = number
    return numbers


def _has_strange_code(raw, part: str) -> bool:
    """Whether a part's table has code that this process has not run before."""
    from hydro2d.materials import outside

    return isinstance(raw, dict) and "code" in raw and not outside.is_known(str(raw["code"]), part)


def _unread(raw: dict, part: str, fail: Fail) -> Model:
    """A model from outside whose code is not run; its parameters are those that the table gives, in SI."""
    if not isinstance(raw.get("model"), str):
        raise fail((part, "model"), "is missing")
    numbers = {key: _number(number, "1", (part, key), fail) for key, number in raw.items() if key not in _CHOICE}
    if part == "eos" and "reference_density" not in numbers:
        raise fail((part,), f"{raw['model']} needs reference_density")
    return Model(raw["model"], numbers, str(raw.get("code_from", raw["model"])), str(raw["code"]), trusted=False)


def _unknown_parameter(model: str, key: str, parameters: Mapping) -> str:
    for parameter in parameters.values():
        if key.lower() == parameter.symbol.lower():
            return f'unknown parameter "{key}" of {model}; its name is "{parameter.name}"'
    return unknown(f"parameter of {model}", key, parameters)


def _number(raw: dict, unit: str, path: tuple, fail: Fail) -> Number:
    """A number from {value, source, confidence, note}."""
    for key in raw:
        if key not in ("value", *_ABOUT):
            raise fail((*path, key), unknown("key", key, ("value", *_ABOUT)))
    if "value" not in raw:
        raise fail(path, "needs a value")
    if str(raw["confidence"]) not in CONFIDENCE:
        raise fail(path, unknown("confidence", str(raw["confidence"]), CONFIDENCE))
    try:
        value = raw["value"] if raw["value"] == float("inf") else units.to_si(raw["value"], unit)
    except ValueError as problem:
        raise fail(path, str(problem)) from None
    return Number(value, unit, raw["source"], raw["confidence"], raw["note"])


#: a body is a gas beside the stiffest one if its bulk modulus at rest is below this share of that one's
GAS_MODULUS = 0.01


@dataclass(frozen=True)
class MaterialTable:
    """The numbers of the materials for kernels, one row per slot m (a body, with all bodies that join it).

    ``eos_par`` is float64[m, k] as long as the longest row of the run, at least eos.ROW, ``strength_par`` float64[m,
    strength.ROW], ``damage_par`` float64[m, strength.DAMAGE_ROW]; the model ids are int64[m]; ``internal`` holds the internal
    variables of every strength model and then those of its equation of state, ``initial`` what virgin material has of them,
    ``memory`` the row of State.q in which those of the equation of state begin, int64[m]; ``fracture_pressure`` is a positive
    tension, inf where never, and ``cracking`` that at which cracks open, where the damage model opens them, else 0; ``melting``
    holds the melting lines that the deck uses, float64[m, strength.melting.ROW], NONE where there is none.
    """

    names: tuple[str, ...]
    materials: tuple[Material, ...]
    rho0: np.ndarray
    e0: np.ndarray
    eos_model: np.ndarray
    eos_par: np.ndarray
    strength_model: np.ndarray
    strength_par: np.ndarray
    internal: tuple[tuple[Field, ...], ...]
    initial: tuple[np.ndarray, ...]
    memory: np.ndarray
    damage_model: np.ndarray
    damage_par: np.ndarray
    fracture_pressure: np.ndarray
    cracking: np.ndarray
    melting: np.ndarray

    def __len__(self) -> int:
        return len(self.names)

    @property
    def remembers(self) -> bool:
        """Whether an equation of state has internal variables."""
        return any(INTERNAL + len(own) > first for own, first in zip(self.internal, self.memory, strict=True))

    def virgin(self, m: int) -> np.ndarray:
        """The internal variables of the equation of state of body m, as virgin material has them, float64[n]."""
        return self.initial[m][self.memory[m] - INTERNAL:]

    def spent(self, m: int) -> np.ndarray:
        """These of what it becomes at most: products, where it is an explosive (the model's SPENT), else virgin material."""
        found = getattr(self.materials[m].eos.module("eos"), "SPENT", None)
        return self.virgin(m) if found is None else np.array(found)

    def evaluate(self, m: int, rho: float, e: float) -> tuple[float, float, float, float]:
        """(p, dp/drho, dp/de, T) of virgin material of body m, see `eos.dispatch.evaluate`."""
        from eos.dispatch import evaluate

        return evaluate(self.eos_model[m], rho, e, self.virgin(m), self.eos_par[m])

    def limits(self, m: int, rho: float, internal: np.ndarray) -> str:
        """What the table of body m covers and which energies at a density, in words; empty where it has no table.

        internal : internal variables of its equation of state, float64[n]. Where that stands over the model of its solid, the
        table is the solid's, and the density of the solid is said as well.
        """
        from eos import cracked, layout

        model = self.materials[m].eos
        if not model.table:
            return ""
        module, par, said = model.module("eos"), self.eos_par[m], ""
        over = cracked if self.eos_model[m] == cracked.ID else module if model.solid else None
        if over:
            rho, par = over.density_of_solid(rho, internal, par), par[layout.SOLID_AT:]
            said = f"its solid has {rho:.6g} kg/m^3; "
        if model.solid:
            module = _solid(model.solid)[0]
        said += f"{model.table_from} has {module.span(par)}"
        energies = module.energies(rho, par)
        return said + (f"; at {rho:.6g} kg/m^3 energies of {energies[0]:.6g} to {energies[1]:.6g} J/kg" if energies else "")

    def sound_speeds(self, floor: float = 0.0) -> np.ndarray:
        """Bulk sound speed of every material at rest, m/s, float64[m]; floor : least square of it, (m/s)^2."""
        from eos.dispatch import sound_speed_squared

        squares = []
        for m in range(len(self)):
            p, dpdrho, dpde, _ = self.evaluate(m, self.rho0[m], self.e0[m])
            squares.append(sound_speed_squared(self.rho0[m], p, dpdrho, dpde, floor))
        return np.sqrt(squares)

    def gases(self) -> np.ndarray:
        """Which bodies are gases beside the others, bool[m]: bulk modulus at rest below GAS_MODULUS of the largest one."""
        moduli = self.rho0 * self.sound_speeds() ** 2
        return moduli < GAS_MODULUS * moduli.max()


def _row(module: ModuleType, model: Model, material: Material) -> np.ndarray:
    try:
        return module.row(model.values, *model.base())
    except ValueError as problem:
        raise DeckError(f"material {material.name}: {problem}") from None


def _variables(eos_modules, eos_par, strength_modules, strength_par) -> dict:
    """What a table says of internal variables: those of the strength model of every body, then of its equation of state."""
    internal, initial = [], []
    for parts in zip(zip(strength_modules, strength_par, strict=True), zip(eos_modules, eos_par, strict=True), strict=True):
        own = [(field, row) for module, row in parts for field in getattr(module, "INTERNAL", ())]
        internal.append(tuple(field for field, _ in own))
        initial.append(np.array([field.at_rest(row) for field, row in own]))
    first = [INTERNAL + len(getattr(module, "INTERNAL", ())) for module in strength_modules]
    return {"internal": tuple(internal), "initial": tuple(initial), "memory": np.array(first, dtype=np.int64)}


def resolve(deck) -> MaterialTable:
    """Model ids and parameter rows of the deck's slots.

    Raises DeckError for values that a model refuses, and for a model from outside that the kernels were loaded without.
    """
    import eos

    slots = [body for body in deck.body if body.join is None]
    chosen = [deck.materials[body.material] for body in slots]
    for material in chosen:
        for model in material.from_outside():
            model.require(f"material {material.name}: ")
    eos_modules = [material.eos.module("eos") for material in chosen]
    strength_modules = [material.strength.module("strength") for material in chosen]
    damages = [material.damage if deck.failure.damage == "material" else Model("none") for material in chosen]
    damage_modules = [damage.module("damage") for damage in damages]
    eos_rows = [_row(module, material.eos, material) for module, material in zip(eos_modules, chosen, strict=True)]
    tensile = [c.fracture_pressure.value if c.fracture_pressure else np.inf for c in chosen]
    if deck.failure.tensile == "none":
        tensile = [np.inf] * len(chosen)
    cracking = np.zeros(len(chosen))
    for m, material in enumerate(chosen):
        if opens_cracks(damage_modules[m]):
            cracking[m], tensile[m] = cracking_pressure(material, tensile[m]), np.inf
            eos_modules[m], eos_rows[m] = over(material, eos_rows[m])
    eos_par = np.zeros((len(chosen), max(row.size for row in eos_rows)))
    for row, own in zip(eos_par, eos_rows, strict=True):
        row[: own.size] = own
    strength_par = np.stack([_row(m, c.strength, c) for m, c in zip(strength_modules, chosen, strict=True)])
    damage_par = np.stack([_row(m, d, c) for m, d, c in zip(damage_modules, damages, chosen, strict=True)])
    table = MaterialTable(
        names=tuple(body.name for body in slots),
        materials=tuple(chosen),
        rho0=eos_par[:, eos.RHO0].copy(),
        e0=eos_par[:, eos.E0].copy(),
        eos_model=np.array([m.ID for m in eos_modules], dtype=np.int64),
        eos_par=eos_par,
        strength_model=np.array([m.ID for m in strength_modules], dtype=np.int64),
        strength_par=strength_par,
        **_variables(eos_modules, eos_par, strength_modules, strength_par),
        damage_model=np.array([m.ID for m in damage_modules], dtype=np.int64),
        damage_par=damage_par,
        fracture_pressure=np.array(tensile),
        cracking=cracking,
        melting=np.stack([_line_of(material, deck.failure.melting == "material") for material in chosen]),
    )
    for m, module in enumerate(strength_modules):
        if hasattr(module, "check_with"):
            _require_agreement(table, m, module)
    return table


def _line_of(material: Material, used: bool) -> np.ndarray:
    """The melting line of a material as kernels read it; NONE where it has none, or where it is not used."""
    from strength import melting

    if not (used and material.melting):
        return np.array(melting.NONE)
    try:
        return melting.row({name: number.value for name, number in material.melting.items()})
    except ValueError as problem:
        raise DeckError(f"material {material.name}: {problem}") from None


def _require_agreement(table: MaterialTable, m: int, strength: ModuleType) -> None:
    """Raises DeckError if the strength model of body m and its equation of state contradict each other."""
    material, rest = table.materials[m], table.rho0[m]
    try:
        strength.check_with(material.strength.values, lambda mu: table.evaluate(m, rest * (1.0 + mu), 0.0)[0])
    except ValueError as problem:
        raise DeckError(f"material {material.name}: {problem}") from None


def describe(name: str, variant: str | None = None) -> str:
    """The page of a material for ``hydro2d info``: every number with its unit, source and confidence."""
    material = load(name, variant)
    lines = [f"{material.name}: {material.title}"] + ([material.note] if material.note else [])
    parts: list[tuple[str, Mapping[str, Number]]] = [
        (f"{part}: {getattr(material, part).title}", getattr(material, part).numbers) for part in PARTS
    ]
    if material.melting:
        parts.append(("melting line", material.melting))
    if material.fracture_pressure is not None:
        parts.append(("failure", {"fracture_pressure": material.fracture_pressure}))
    for heading, numbers in parts:
        lines += ["", heading] + [_line(key, number) for key, number in numbers.items()]
    if material.variants:
        lines += ["", "variants"] + [f"  {key}: {title}" for key, title in material.variants.items()]
    used = {number.confidence for _, numbers in parts for number in numbers.values()}
    lines += ["", "confidence"] + [f"  {key}: {CONFIDENCE[key]}" for key in CONFIDENCE if key in used]
    return "\n".join(lines) + "\n"


def _line(key: str, number: Number) -> str:
    unit = "" if number.unit == "1" else number.unit
    about = "; ".join(part for part in (number.source, number.note) if part)
    return f"  {key:<24}{number.value:>12.6g} {unit:<10} {number.confidence:<9} {about}".rstrip()
