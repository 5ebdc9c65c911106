"""The decks that `hydro2d new` writes: one for each kind of shot, to be changed."""

from __future__ import annotations

from hydro2d.base.errors import DeckError, unknown
from hydro2d.files.shipped import problems_folder

#: the folder of the templates among the shipped decks
FOLDER = "templates"


def kinds() -> dict[str, str]:
    """The kinds of shots by name, in alphabetical order, with a one-line description: the first line of its file."""
    files = sorted((problems_folder() / FOLDER).glob("*.toml"))
    return {file.stem: file.read_text(encoding="utf-8").split("\n", 1)[0].removeprefix("# ") for file in files}


def text(kind: str) -> str:
    """The deck of a kind. Raises DeckError if there is none."""
    if kind not in (known := kinds()):
        raise DeckError(unknown("kind", kind, known))
    return (problems_folder() / FOLDER / f"{kind}.toml").read_text(encoding="utf-8")
