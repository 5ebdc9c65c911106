"""JSON schema of the materials of a deck, for editors and for ``hydro2d info``."""

from __future__ import annotations

from hydro2d.materials.material import CONFIDENCE
from hydro2d.materials.outside import KINDS, Kind, in_packages
from strength import melting

_QUANTITY = {"anyOf": [{"type": "number"}, {"type": "string"}, {"type": "object"}]}
_TEXT = {"type": "string"}
_ABOUT = {
    "source": {**_TEXT, "description": "where the numbers come from"},
    "confidence": {"enum": list(CONFIDENCE), "description": "how reliable they are"},
}
_SOLID = {
    "solid": {**_TEXT, "description": "the equation of state that the model builds on, if it needs one; its parameters "
              "are in the same table", "examples": ["mie-grueneisen"]},
}
_TABLE = {
    "table": {**_TEXT, "description": "a file with a table of the SESAME type 301, relative to the deck, for a model "
              "made from one", "examples": ["aluminium.301"]},
    "table_data": {**_TEXT, "description": "the text of that file, which resolved decks contain instead of its name",
                   "examples": ["3 3 0.1 0.2 0.3 0 300 600 ..."]},
    "table_from": {**_TEXT, "description": "the name of that file", "examples": ["aluminium.301"]},
}


def definitions() -> dict[str, dict]:
    """Schemas of a material of a deck and of the tables in it, by title: Material, Eos, Strength, Damage and Melting."""
    return {**{part.capitalize(): _part(kind) for part, kind in KINDS.items()}, "Melting": _melting(), "Material": _material()}


def _melting() -> dict:
    """The table of a melting line."""
    numbers = {each.name: {**_QUANTITY, "x-unit": each.unit or "1", "description": each.description}
               for each in melting.PARAMETERS}
    return {
        "type": "object", "title": "Melting", "additionalProperties": False,
        "description": "The melting line of a material; at and above it there is no strength; see `hydro2d info melting`.",
        "properties": {**_ABOUT, **numbers},
    }


def _part(kind: Kind) -> dict:
    """The table of a model, without the keys of models from outside."""
    known: dict[str, list[tuple[str, str, str]]] = {}
    for name, module in kind.models.items():
        for parameter in module.PARAMETERS:
            known.setdefault(parameter.name, []).append((name, parameter.unit or "1", parameter.description))
    keys = {
        "model": {"enum": [*kind.models, *in_packages(kind.part)], "description": f"the {kind.title}"},
        "file": {**_TEXT, "description": "a Python file with a model of your own, relative to the deck, instead of `model`",
                 "examples": ["my_model.py"]},
        "code": {**_TEXT, "description": "the text of that file, which resolved decks contain instead of its name",
                 "examples": ["NAME = 'my-model'"]},
        "code_from": {**_TEXT, "description": "the name of that file", "examples": ["my_model.py"]},
        **({**_SOLID, **_TABLE} if kind.part == "eos" else {}),
        **_ABOUT,
        **{key: {**_QUANTITY, "x-unit": entries[0][1], "description": _meanings(entries)} for key, entries in known.items()},
    }
    ours = {"not": {"required": ["file"]}, "properties": {"model": {"enum": list(kind.models)}}}
    return {
        "type": "object", "title": kind.part.capitalize(),
        "description": f"The {kind.title} of a material; `hydro2d info MODEL` has its equation.",
        "properties": keys, "if": ours, "then": {"propertyNames": {"enum": list(keys)}},
    }


def _material() -> dict:
    return {
        "type": "object", "title": "Material", "additionalProperties": False,
        "description": "A material: complete with its equation of state, or `based_on` another, from which it differs.",
        "properties": {
            "based_on": {**_TEXT,
                         "description": "a material of the library or of the deck, for everything that is not given here"},
            "variant": {"anyOf": [_TEXT, {"type": "array", "items": _TEXT}],
                        "description": "variants of it to apply"},
            "eos": {"$ref": "#/$defs/Eos", "description": "equation of state"},
            "strength": {"$ref": "#/$defs/Strength", "description": "strength model; without one there is no shear stress"},
            "damage": {"$ref": "#/$defs/Damage", "description": 'damage model; used with failure.damage = "material"'},
            "melting": {"$ref": "#/$defs/Melting", "description": 'melting line; used with failure.melting = "material"'},
            "fracture_pressure": {**_QUANTITY, "x-unit": "Pa", "description": "tension at which the material opens, positive; "
                                  'used with failure.tensile = "material"'},
            "fracture_stress": {**_QUANTITY, "x-unit": "Pa", "description": "largest principal stress that the material bears, "
                                'positive; beyond it fails for good; used with failure.tensile = "material"'},
            "title": {**_TEXT, "description": "title for `hydro2d info`"},
            "note": {**_TEXT, "description": "further remarks"},
            **_ABOUT,
            "variants": {"type": "object", "description": "tables by name that `variant` can apply to the material"},
        },
    }


def _meanings(entries: list[tuple[str, str, str]]) -> str:
    """The meaning of a parameter, by model if models differ."""
    meanings: dict[str, list[str]] = {}
    for model, _, meaning in entries:
        meanings.setdefault(meaning, []).append(model)
    return "; ".join(f"{meaning} ({', '.join(models)})" for meaning, models in meanings.items())
