"""Docstrings as reStructuredText: arguments, attributes and errors as lists of definitions.

Our docstrings name an argument in a line ``name : what it is``, below a heading that is underlined or without one. Napoleon
would take what it is for a type, and the first words of a property for one too.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

#: an entry in a docstring: one or several names, and what follows the colon
ENTRY = re.compile(r"(?P<names>\*{0,2}[A-Za-z_]\w*(?:, \*{0,2}[A-Za-z_]\w*)*)(?: : (?P<text>.+))?")


def processed(app, what, name, thing, options, lines: list[str]) -> None:
    """The hook of autodoc: rewrites ``lines`` where they are."""
    lines[:] = converted(lines)


def converted(lines: list[str]) -> list[str]:
    """The lines of a docstring with its lists written as definitions."""
    return [line for paragraph in _paragraphs(lines) for line in (*_converted(paragraph), "")]


def _paragraphs(lines: list[str]) -> Iterator[list[str]]:
    """Runs of lines between blank ones; an indented run belongs to what is before it."""
    found: list[list[str]] = []
    blank = True
    for line in lines:
        if line.strip():
            if blank and not (found and line.startswith(" ")):
                found.append([])
            elif blank:
                found[-1].append("")
            found[-1].append(line)
        blank = not line.strip()
    yield from found


def _converted(paragraph: list[str]) -> list[str]:
    headed = len(paragraph) > 1 and set(paragraph[1]) == {"-"}
    entries = paragraph[2:] if headed else paragraph
    starts = [line for line in entries if line and not line.startswith(" ")]
    matches = [ENTRY.fullmatch(line) for line in starts]
    if not all(matches) or not (headed or all(match["text"] for match in matches)):
        return paragraph
    result = [f".. rubric:: {paragraph[0]}", ""] if headed else []
    for number, line in enumerate(entries):
        match = None if line.startswith(" ") else ENTRY.fullmatch(line)
        if match is None:
            result.append(line)
            continue
        described = number + 1 < len(entries) and entries[number + 1].startswith(" ")
        term = match["names"].replace("*", r"\*")
        if headed and described:  # what follows the colon is a type
            result.append(f"{term} : {match['text']}" if match["text"] else term)
        else:
            result += [term, *([f"    {match['text']}"] if match["text"] else [])]
    return result
