"""Text of small decks, table by table: a deck is a sum of these, so that a test says only what matters to it.

``mesh((...), (...)) + rod("3 mm", "10 mm", tip=0.0, velocity="1000 m/s") + plate("20 mm") + stop("1 us")``

Every key that a table of the deck may have can be given by its own name; numbers are in SI units. The mesh comes first. Decks
that are themselves under test (how they are read, the messages about them) are written as text in their tests.
"""

from __future__ import annotations

import json

Value = str | float | bool | list | tuple | dict
Axis = tuple | list


def _written(value: Value) -> str:
    """A value of TOML on one line."""
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_written(each)}' for key, each in value.items())} }}"
    return json.dumps(value)


def _lines(head: str, keys: dict[str, Value]) -> str:
    return "".join(f"{line}\n" for line in (head, *(f"{key} = {_written(value)}" for key, value in keys.items())))


def table(name: str, /, **keys: Value) -> str:
    """A table that occurs once in a deck, as ``table("numerics", advection="ke")``."""
    return _lines(f"[{name}]", keys)


def entry(name: str, /, **keys: Value) -> str:
    """A table that may occur several times in a deck: a body, a tracer, a gauge."""
    return _lines(f"[[{name}]]", keys)


def mesh(r: Axis, z: Axis, **keys: Value) -> str:
    """The mesh, which comes first, after the line for the whole deck that its numbers are in SI units.

    An axis is (end, cells), (start, end, cells), or the list of its segments as in a deck. Instead of the number of cells, an
    int, the size of a cell may be given, a text or a float.
    """
    for name, axis in (("r", r), ("z", z)):
        if isinstance(axis, tuple):
            *start, end, cells = axis
            keys |= {f"{name}_start": each for each in start}
            axis = [{"to": end, ("cells" if isinstance(cells, int) else "size"): cells}]
        keys[name] = axis
    return 'numbers = "SI"\n' + table("mesh", **keys)


def walls(*edges: str, **others: Value) -> str:
    """Edges of the mesh that are walls, and other keys of the boundaries."""
    return table("boundaries", **{edge: "wall" for edge in edges}, **others)


def body(name: str, material: str, shape: str, **keys: Value) -> str:
    """A body of any shape."""
    return entry("body", name=name, material=material, shape=shape, **keys)


def box(name: str, material: str, **keys: Value) -> str:
    """A box between its r and z; without r it fills the mesh from side to side."""
    return body(name, material, "box", **keys)


def rod(radius: Value, length: Value, *, name: str = "rod", material: str = "W_alloy", nose: str = "hemispherical",
        **keys: Value) -> str:
    """A rod, of the tungsten alloy and with a hemispherical nose by default."""
    return body(name, material, "rod", nose=nose, radius=radius, length=length, **keys)


def plate(thickness: Value, *, name: str = "plate", material: str = "Al5083", z_front: Value = 0.0, **keys: Value) -> str:
    """A plate, of aluminium 5083 from z = 0 on by default."""
    return body(name, material, "plate", z_front=z_front, thickness=thickness, **keys)


def material(name: str, based_on: str, **keys: Value) -> str:
    """A material of the deck, based on one of the library."""
    return table(f"materials.{name}", based_on=based_on, **keys)


def contact(*hard: str, **keys: Value) -> str:
    """Contact between hard bodies and the others."""
    return table("sliding", method="contact", hard=list(hard), **keys)


def stop(time: Value, **keys: Value) -> str:
    """The end, at a time or before it."""
    return table("stop", time=time, **keys)
