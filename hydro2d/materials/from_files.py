"""Models of a deck that are files: puts their texts into the deck."""

from __future__ import annotations

from collections.abc import Callable

from hydro2d.errors import DeckError
from hydro2d.toml import model_tables


def read(data: dict, complaint: Callable[[tuple, str], DeckError], trust: bool = True) -> dict:
    """The deck, in which every ``file`` of a model has become its ``model``, the name, ``code``, the text, and ``code_from``.

    A file replaces a model of hydro2d in an included deck. ``data`` is changed. ``complaint(path, message)`` makes the
    error for a key of the deck; it is raised here. Without ``trust`` no file is read.
    """
    for path, table in model_tables(data):
        if "file" not in table:
            continue
        from hydro2d.materials import outside

        if not trust:
            raise complaint((*path, "file"), "names a file of code, which only a deck that is run may do")
        if not isinstance(table["file"], str):
            raise complaint((*path, "file"), "must be the name of a Python file")
        try:
            found = outside.read(table["file"], path[-1])
        except outside.ModelError as error:
            raise complaint((*path, "file"), str(error)) from None
        if "code" not in table and table.get("model") not in (None, found.name, *found.kind.models):
            raise complaint((*path, "model"), f'is "{table["model"]}", but the model in {table["file"]} is "{found.name}"')
        del table["file"]
        table |= {"model": found.name, "code": found.text, "code_from": found.file}
    return data
