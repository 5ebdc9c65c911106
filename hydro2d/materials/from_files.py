"""The files of a deck's models, code and tables: puts their texts into the deck."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from hydro2d.base.errors import DeckError
from hydro2d.files.toml import model_tables
from hydro2d.files.whole import read_text

Complaint = Callable[[tuple, str], DeckError]


def read(data: dict, complaint: Complaint, trust: bool = True) -> dict:
    """The deck with the texts of its files in it.

    Every ``file`` of a model becomes ``model``, its name, ``code``, its text, and ``code_from``; every ``table`` becomes
    ``table_data``, its text, and ``table_from``. A file replaces a model of hydro2d in an included deck. ``data`` is changed.
    ``complaint(path, message)`` makes the error for a key of the deck; it is raised here. Without ``trust`` no file is read.
    """
    for path, table in model_tables(data):
        if "file" in table:
            _take_code(path, table, complaint, trust)
        if "table" in table:
            _take_table(path, table, complaint, trust)
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


def _take_table(path: tuple, table: dict, complaint: Complaint, trust: bool) -> None:
    if not trust:
        raise complaint((*path, "table"), "names a file, which only a deck that is run may do")
    if not isinstance(table["table"], str):
        raise complaint((*path, "table"), "must be the name of a file with a table")
    try:
        text = read_text(Path(table["table"]), DeckError)
    except DeckError as error:
        raise complaint((*path, "table"), str(error)) from None
    table |= {"table_data": text, "table_from": Path(table.pop("table")).name}
