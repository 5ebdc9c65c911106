"""The files of a deck's models, code and tables, and of its own results: puts their texts into the deck."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from hydro2d.base.errors import DeckError
from hydro2d.files.toml import model_tables, result_tables
from hydro2d.files.whole import read_text

Complaint = Callable[[tuple, str], DeckError]


def read(data: dict, complaint: Complaint, trust: bool = True) -> dict:
    """The deck with the texts of its files in it.

    Every ``file`` of a model becomes ``model``, its name, ``code``, its text, and ``code_from``; every ``table`` becomes
    ``table_data``, its text, and ``table_from``. A file replaces a model of hydro2d in an included deck. Every ``file`` of a
    result becomes ``code`` and ``code_from``. ``data`` is changed.
    ``complaint(path, message)`` makes the error for a key of the deck; it is raised here. Without ``trust`` no file is read.
    """
    for path, table in model_tables(data):
        if "file" in table:
            _take_code(path, table, complaint, trust)
        if "table" in table:
            _take_text(path, table, "table", ("table_data", "table_from"), complaint, trust)
    for path, table in result_tables(data):
        if "file" in table:
            _take_text(path, table, "file", ("code", "code_from"), complaint, trust)
    return data


def _take_code(path: tuple, table: dict, complaint: Complaint, trust: bool) -> None:
    from hydro2d.materials import outside

    if not trust:
        raise complaint((*path, "file"), "names a file of code, which only a deck that is run may do")
    if not isinstance(table["file"], str):
        raise complaint((*path, "file"), "must be the name of a Python file")
    try:
        model = outside.read(table["file"], path[-1])
    except outside.ModelError as error:
        raise complaint((*path, "file"), str(error)) from None
    if "code" not in table and table.get("model") not in (None, model.name, *model.kind.models):
        raise complaint((*path, "model"), f'is "{table["model"]}", but the model in {table["file"]} is "{model.name}"')
    del table["file"]
    table |= {"model": model.name, "code": model.text, "code_from": model.file}


def _take_text(path: tuple, table: dict, key: str, become: tuple[str, str], complaint: Complaint, trust: bool) -> None:
    """Puts the text and the name of the file under a key into a table, under two others."""
    if not trust:
        raise complaint((*path, key), "names a file, which only a deck that is run may do")
    if not isinstance(table[key], str):
        raise complaint((*path, key), f"must be the name of a file with {'a table' if key == 'table' else 'Python code'}")
    try:
        text = read_text(Path(table[key]), DeckError)
    except DeckError as error:
        raise complaint((*path, key), str(error)) from None
    table |= dict(zip(become, (text, Path(table.pop(key)).name), strict=True))
