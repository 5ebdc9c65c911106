"""The page of materials, from the objects of the material library."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from _pages.markdown import NOTE, prose, table

#: parts of a material that have a model
PARTS = ("eos", "strength", "damage")


def page() -> str:
    """An index of the library, what the words of confidence mean, and a table of every material."""
    from hydro2d.materials import library

    lead = (
        f"{NOTE} `hydro2d info NAME` prints the same. [Models](models.md) has the equation of each model and the symbols of "
        "its parameters. All values are in SI units."
    )
    materials = [library.load(name) for name in library.names()]
    index = table(
        ("material", "density, kg/m^3", "strength", "damage", "fracture pressure, Pa", "variants", "what it is"),
        (
            (f"[`{m.name}`](#{m.name.lower()})", f"{m.reference_density:g}", _link(m, "strength"), _link(m, "damage"),
             f"{m.fracture_pressure.value:g}" if m.fracture_pressure else "", len(m.variants) or "", prose(m.title))
            for m in materials
        ),
    )
    many = counts()
    confidence = table(("confidence", "numbers", "meaning"),
                       ((f"`{word}`", many[word] or "", text) for word, text in library.CONFIDENCE.items()))
    words = f"The column *confidence* says how far a number can be trusted; variants are not counted:\n\n{confidence}"
    return "\n\n".join(["# Materials", lead, index, words, *map(_material, materials)])


def counts() -> Counter[str]:
    """How many numbers of the library have each confidence, without variants and without defaults of models."""
    from hydro2d.materials import library

    return Counter(number.confidence for name in library.names() for _, _, number in rows_of(library.load(name))
                   if number.confidence != "default")


def _link(material, part: str) -> str:
    """The name of a part's model with a link to its equation; nothing where the material has none."""
    name = getattr(material, part).name
    if name in ("none", "hydrodynamic"):
        return ""
    double = part == "damage"  # the page of models has the strength model of the same name before it
    return f"[`{name}`](models.md#{name}{'-1' if double else ''})"


def rows_of(material) -> Iterator[tuple[str, str, object]]:
    """Model, parameter and number of every number of a material."""
    for part in PARTS:
        model = getattr(material, part)
        for name, number in model.numbers.items():
            yield f"{part}: {model.name}", name, number
    for name, number in material.melting.items():
        yield "melting", name, number
    for model, name in (("tensile-pressure", "fracture_pressure"), ("tensile-stress", "fracture_stress")):
        if (number := getattr(material, name)) is not None:
            yield model, name, number


def _cells(number) -> tuple[str, str, str, str]:
    unit = "" if number.unit == "1" else number.unit
    return f"{number.value:.6g}", unit, number.confidence, prose("; ".join(filter(None, (number.source, number.note))))


def _material(material) -> str:
    from hydro2d.materials import library

    heads = ("model", "parameter", "value", "unit", "confidence", "source")
    rows = [(f"`{model}`", f"`{name}`", *_cells(number)) for model, name, number in rows_of(material)]
    parts = [f"## `{material.name}`", f"{prose(material.title)}."]
    if material.note:
        parts.append(f"{prose(material.note)}.")
    parts.append(table(heads, rows))
    for key, title in material.variants.items():
        parts.append(f"**Variant** `{key}`: {prose(title)}." if title else f"**Variant** `{key}`.")
        base = {(model, name): number for model, name, number in rows_of(material)}
        varied = rows_of(library.load(material.name, key))
        changed = [(model, name, number) for model, name, number in varied if base.get((model, name)) != number]
        parts.append(table(heads, ((f"`{model}`", f"`{name}`", *_cells(number)) for model, name, number in changed)))
    return "\n\n".join(parts)
