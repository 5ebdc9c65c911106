"""The page of commands, from the arguments that the program itself parses.

Cyclopts' own Sphinx extension is not used: it shows `--option` with a dash in examples, names a command by the arguments of
the build and drops the heading of `hydro2d model transition`.
"""

from __future__ import annotations

import enum
import inspect
import typing
from collections.abc import Iterator
from pathlib import Path

from _pages.markdown import NOTE, code, prose, table

#: what an argument's value is, by its type
VALUES = {str: "text", int: "whole number", float: "number", Path: "path", bool: "flag"}


def page() -> str:
    """Every command: what it does, its arguments, an example."""
    from hydro2d.cli.main import app

    commands = list(_commands(app, "hydro2d"))
    lead = (
        f"{NOTE} `hydro2d COMMAND --help` prints the same. An argument in capitals is given by its place, or by its name "
        "like an option: `--deck FILE`. Options whose value is *several* can be repeated."
    )
    index = table(
        ("command", "what it does"),
        ((f"[`{name}`](#{name.replace(' ', '-')})", prose(_paragraphs(command)[0])) for name, command in commands),
    )
    return "\n\n".join(
        ["# Commands", lead, index, f"{prose(app.help_epilogue)} [Files of a run](../files.md) has them as a table.",
         *(_command(name, command) for name, command in commands)]
    )


def _commands(app, name: str) -> Iterator[tuple[str, object]]:
    """Full name and application of every command, in the order of the alphabet."""
    for word in sorted(word for word in app if not word.startswith("-")):
        yield f"{name} {word}", app[word]
        yield from _commands(app[word], f"{name} {word}")


def _paragraphs(command) -> list[str]:
    """The text of the command's docstring before its parameters."""
    text = inspect.cleandoc(command.help).split("\n\nParameters\n", 1)[0]
    return [" ".join(part.split()) for part in text.split("\n\n")]


def _command(name: str, command) -> str:
    parts = [f"## `{name}`"]
    arguments = command.assemble_argument_collection(parse_docstring=True).filter_by(show=True)  # without names of groups
    examples = [part.removeprefix("Example: ") for part in _paragraphs(command) if part.startswith("Example: ")]
    parts += [prose(part) for part in _paragraphs(command) if not part.startswith("Example: ")]
    parts.append(code(_usage(name, command, arguments)))
    if arguments:
        parts.append(table(("argument", "value", "default", "meaning"), map(_row, arguments)))
    parts += [f"Example:\n\n{code(text, 'sh')}" for text in examples]
    return "\n\n".join(parts)


def _usage(name: str, command, arguments) -> str:
    if command.usage:
        return command.usage.removeprefix("Usage: ")
    words = [_place(entry) if entry.required else f"[{_place(entry)}]" for entry in arguments if entry.index is not None]
    named = [entry for entry in arguments if entry.index is None]
    words += [f"{entry.names[0]} {entry.names[0].lstrip('-').upper()}" for entry in named if entry.required]
    return " ".join([name, *words, *(["[OPTIONS]"] if any(not entry.required for entry in named) else [])])


def _place(entry) -> str:
    """The name of an argument that is given by its place."""
    return entry.names[0].lstrip("-").upper() + ("..." if _type(entry)[1] else "")


def _type(entry) -> tuple[object, bool]:
    """The type of one value, and whether there may be several."""
    hint, several = entry.hint, False
    while typing.get_args(hint) and typing.get_origin(hint) is not typing.Literal:
        several = several or typing.get_origin(hint) in (list, tuple)
        hint = next(part for part in typing.get_args(hint) if part is not type(None))
    return hint, several


def _row(entry) -> tuple[str, str, str, str]:
    names = [_place(entry)] if entry.index is not None else [name for name in entry.names if name not in entry.negatives]
    kind, several = _type(entry)
    value = ", ".join(f"`{word}`" for word in entry.get_choices() or ()) or VALUES.get(kind, str(kind))
    if several:
        value += ", several"
    default = "required" if entry.required else _default(entry.field_info.default)
    return ", ".join(f"`{name}`" for name in names), value, default, prose(entry.parameter.help or "")


def _default(value) -> str:
    if value is None or value is False or value is inspect.Parameter.empty:
        return ""
    return f"`{value.value if isinstance(value, enum.Enum) else value}`"
