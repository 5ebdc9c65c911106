"""The decks and materials that come with hydro2d."""

from __future__ import annotations

from pathlib import Path


def problems_folder() -> Path:
    """The folder of decks and materials: next to the package in a checkout, inside it when installed."""
    here = Path(__file__).resolve().parent.parent
    for folder in (here.parent / "problems", here / "problems"):
        if (folder / "materials").is_dir():
            return folder
    raise FileNotFoundError("the folder problems/materials is missing from this installation")


def shipped_file(path: Path) -> Path | None:
    """The shipped file with a path below `problems`, with or without this folder in front; None if there is none."""
    parts = path.parts[1:] if path.parts[:1] == ("problems",) else path.parts
    file = problems_folder().joinpath(*parts)
    return file if not path.is_absolute() and file.is_file() else None
