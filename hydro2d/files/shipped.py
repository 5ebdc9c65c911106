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
