"""Markdown from plain text: tables, code, prose whose characters mean nothing."""

from __future__ import annotations

import re
from collections.abc import Iterable

NOTE = "Generated from the code."


def table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A Markdown table."""
    heads = list(heads)
    cells = [[str(cell).replace("|", "\\|").replace("\n", " ") for cell in row] for row in rows]
    lines = ["| " + " | ".join(row) + " |" for row in (heads, *cells)]
    return "\n".join([lines[0], "|" + "---|" * len(heads), *lines[1:]])


def code(text: str, language: str = "text") -> str:
    """Text in a fixed-width block."""
    return f"```{language}\n{text.strip()}\n```"


def prose(text: str) -> str:
    """Plain text that Markdown shows as it is; what stands between backticks remains code, and options become code."""
    parts = text.split("`")
    if len(parts) % 2 == 0:
        return _literal(text)
    return "`".join(part if number % 2 else _literal(part) for number, part in enumerate(parts))


def _literal(text: str) -> str:
    text = re.sub(r"([\\*$])", r"\\\1", text).replace("<", "&lt;").replace("`", "\\`")
    return re.sub(r"(?<![\w-])(--[a-z][a-z-]*)", r"`\1`", text)
