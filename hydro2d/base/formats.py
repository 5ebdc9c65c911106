"""A name, or another text from someone's file, as each format holds it: one function for each format.

Names of bodies, materials, stations, derived quantities, axes and cases have any printable characters, and every format gives a
meaning to some of them. Nothing else in hydro2d quotes or escapes one.
"""

from __future__ import annotations

import html
import json
import os
import re
import shlex
import unicodedata
from collections.abc import Iterable
from pathlib import Path

#: categories of invisible characters that change the display: control, direction of writing, lines
_STEERING = frozenset(("Cc", "Cf", "Zl", "Zp"))
#: first characters that make a cell of a table a formula; the last four are those of a full-width keyboard
_FORMULA = tuple("=+-@\t\r\n＝＋－＠")
#: names that belong to devices on some file systems, whatever follows a dot
_DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(10))}
#: keys of TOML that need no quotation marks
_BARE = re.compile(r"[A-Za-z0-9_-]+")
#: longest part of the name of a file that comes from one name
LONGEST = 40


def shown(text: object) -> str:
    """A text whose only invisible characters are line feeds and tabs; others are spelled out, as in \\x1b."""
    text = str(text)
    if text.isprintable():
        return text
    return "".join(map(_shown, text))


def _shown(character: str) -> str:
    kind = unicodedata.category(character)
    if kind == "Cs":  # a byte of a file name that is not text
        return "?"
    return character if character in "\n\t" or kind not in _STEERING else character.encode("unicode_escape").decode()


def one_line(text: object) -> str:
    """A text as `shown` gives it, on one line, for a terminal or a log."""
    return shown(text).replace("\n", "\\n")


def file_name(name: str, longest: int = LONGEST) -> str:
    """A name as a part of the name of a file: ASCII letters, digits and + . _ -, of which every file system makes a file.

    Several names can give the same; `distinct` tells them apart.
    """
    text = re.sub(r"[^A-Za-z0-9.+_-]+", "-", name).strip("-.")[:longest].rstrip("-.") or "value"
    return f"_{text}" if text.lower().partition(".")[0] in _DEVICES else text


def distinct(names: Iterable[str]) -> list[str]:
    """The names, with -2, -3 and so on added to those that an earlier one equals but for capitals."""
    unique: dict[str, str] = {}
    for name in names:
        number, given = 2, name
        while given.casefold() in unique:
            given, number = f"{name}-{number}", number + 1
        unique[given.casefold()] = given
    return list(unique.values())


def html_id(name: str) -> str:
    """A name as the id of an element of a page: letters, digits, _ and -."""
    return re.sub(r"[^\w-]+", "-", name).strip("-")


def in_html(text: object) -> str:
    """A text between the tags of a page, or in an attribute."""
    return html.escape(shown(text))


def in_plotly(text: object) -> str:
    """A text that Plotly shows literally, in titles, legends, ticks and hover texts."""
    return html.escape(shown(text), quote=False)


def in_script(value) -> str:
    """Plain data as JSON that cannot end the element of a page that holds it. Raises ValueError for what is not finite."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def in_figure(text: object) -> str:
    """A text that matplotlib draws literally: a dollar sign does not begin a formula."""
    return shown(text).replace("$", r"\$")


def in_legend(text: object) -> str:
    """A text as the label of a line in a legend of matplotlib, which leaves out labels that begin with an underscore."""
    return in_figure(f" {text}" if str(text).startswith("_") else text)


def cell(text: str) -> str:
    """A text as a cell or head of a CSV file, such that no spreadsheet takes it for a formula."""
    return f"'{text}" if text.lstrip("'").startswith(_FORMULA) else text


def of_cell(text: str) -> str:
    """The text that `cell` made a cell of."""
    return text[1:] if text.startswith("'") and cell(text[1:]) == text else text


def in_hdf5(name: str) -> str:
    """A name of a dataset, where / would start a group."""
    return name.replace("/", "_per_")


def in_xml(name: str) -> str:
    """A name in a quoted attribute of an XML file, such as those of VTK."""
    return html.escape(name, quote=False).replace('"', "&quot;")  # xml.sax would load the web for this


def in_toml(name: str) -> str:
    """A name as a part of a dotted key."""
    return name if _BARE.fullmatch(name) else json.dumps(name, ensure_ascii=False).replace("\x7f", "\\u007f")


def in_shell(*words: str | Path) -> str:
    """Words as a line for a shell; a file whose name begins with a dash is no option."""
    paths = (os.path.join(".", word) if isinstance(word, Path) and str(word).startswith("-") else str(word) for word in words)
    return shlex.join(paths)
