"""A material from its raw table: the models that it chooses, and a number for every parameter.

The raw table is that of a deck or of the library, all of its numbers with source and confidence, variants and base applied.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import ModuleType

from hydro2d.base import units
from hydro2d.base.errors import unknown
from hydro2d.base.parameters import Parameter
from hydro2d.files.toml import PARTS
from hydro2d.materials.material import CONFIDENCE, FRACTURE, Material, Model, Number, solid_model

#: tables of numbers of a material: those of its models, and its melting line
TABLES = (*PARTS, "melting")
_KEYS = (*TABLES, *FRACTURE, "title", "note", "source", "confidence", "variants", "variant", "based_on")
ABOUT = ("source", "confidence", "note")
#: keys of a part that choose the model, the one that it builds on, and its table; two of these come from the names of files
CHOICE = ("model", "code", "code_from", "solid", "table_data", "table_from")

#: makes the error for a key: from its path and a message
Fail = Callable[[tuple, str], Exception]


def build(name: str, raw: dict, fail: Fail, trust: bool) -> Material:
    """The material of a raw table. ``fail(path, message)`` makes the error for a key of it, which is raised here."""
    for key in raw:
        if key not in _KEYS:
            raise fail((key,), unknown("key", key, _KEYS))
    eos = _model(raw.get("eos"), "eos", None, {}, fail, trust)
    own = eos.numbers
    strength = _model(raw.get("strength"), "strength", "hydrodynamic", own, fail, trust)
    damage = _model(raw.get("damage"), "damage", "none", own, fail, trust)
    fracture = {key: _tension(raw[key], key, fail) for key in FRACTURE if key in raw}
    melting = _melting(raw.get("melting"), eos, fail)
    variants = {key: str(entry.get("title", "")) for key, entry in raw.get("variants", {}).items()}
    title, note = str(raw.get("title", "")), str(raw.get("note", ""))
    fractures = [fracture.get(key) for key in FRACTURE]
    own_keys = {key: tuple(entry) for key, entry in raw.get("variants", {}).items()}
    return Material(name, title, note, eos, strength, damage, *fractures, melting, variants, raw.get("damage") is not None,
                    own_keys)


def _tension(raw, key: str, fail: Fail) -> Number:
    """A tension at which the material fractures."""
    tension = _number(raw, "Pa", (key,), fail)
    if tension.value <= 0:
        raise fail((key,), f"must be positive (a tension), is {tension.value:g}")
    return tension


def _chosen(raw, part: str, fail: Fail) -> tuple[ModuleType, str, str]:
    """The module that a part's table chooses, and the name and text of its file if it is from outside."""
    from hydro2d.materials import outside

    models = outside.KINDS[part].models
    if not isinstance(raw, dict) or not isinstance(raw.get("model"), str):
        raise fail((part,), f"needs a model (allowed: {', '.join(models)}) or a file")
    name = raw["model"]
    try:
        if "code" in raw:
            model = outside.from_text(str(raw["code"]), str(raw.get("code_from", name)), part)
        elif name in models:
            return models[name], "", ""
        else:
            model = outside.from_package(part, name)
    except outside.ModelError as error:
        raise fail((part,), str(error)) from None
    if model is None:
        raise fail((part, "model"), unknown(f"{part} model", name, [*models, *outside.in_packages(part)]))
    if model.name != name:
        raise fail((part, "model"), f'is "{name}", but the model in {model.file} is "{model.name}"')
    model.offer()
    return model.module, model.file, model.text


def _table(module: ModuleType, raw: dict, part: str, fail: Fail) -> tuple[str, str]:
    """Text and name of the table that a part's model is made from; empty for a model without a table."""
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
    """The equation of state of the solid that a part's model builds on; None if it builds on none."""
    if not getattr(module, "OVER_SOLID", False):
        if "solid" in raw:
            raise fail((part, "solid"), f"{module.NAME} does not build on another equation of state")
        return None
    if not isinstance(raw.get("solid"), str):
        raise fail((part,), f"{module.NAME} needs solid, the name of the equation of state of its solid")
    try:
        below, outside = solid_model(raw["solid"])
    except ValueError as problem:
        raise fail((part, "solid"), str(problem)) from None
    if outside:
        outside.offer()
    return below


def _parameters(module: ModuleType, below: ModuleType | None) -> dict[str, Parameter]:
    """The parameters of a model by name, with those of the solid that it builds on, if there is one."""
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
        raise fail(("melting",), f"{eos.title} does not say the density of the solid, which a melting line needs")
    return _numbers(melting.NAME, {each.name: each for each in melting.PARAMETERS}, raw, "melting", eos.numbers, fail)


def _numbers(
    name: str, parameters: Mapping[str, Parameter], raw: dict, part: str, eos: Mapping, fail: Fail
) -> dict[str, Number]:
    """All parameters of a model or line of this name: from the table of a part, the equation of state, or by default."""
    numbers = {}
    for key in raw:
        if key not in (*parameters, *CHOICE):
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
    numbers = {key: _number(number, "1", (part, key), fail) for key, number in raw.items() if key not in CHOICE}
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
        if key not in ("value", *ABOUT):
            raise fail((*path, key), unknown("key", key, ("value", *ABOUT)))
    if "value" not in raw:
        raise fail(path, "needs a value")
    if str(raw["confidence"]) not in CONFIDENCE:
        raise fail(path, unknown("confidence", str(raw["confidence"]), CONFIDENCE))
    try:
        value = raw["value"] if raw["value"] == float("inf") else units.to_si(raw["value"], unit)
    except ValueError as problem:
        raise fail(path, str(problem)) from None
    return Number(value, unit, raw["source"], raw["confidence"], raw["note"])
