"""Compiles the kernels of decks before they are needed: for `hydro2d compile`, and for a wheel that brings compiled code.

    HYDRO2D_CACHE_DIR=FOLDER HYDRO2D_TARGET=x86-64-v3 python -m hydro2d.running.compile_all

gives FOLDER the contents of `hydro2d/_compiled` of a wheel; the wheel's build hook does this.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

from hydro2d import jit
from hydro2d.base import moving
from hydro2d.base.errors import TargetError
from hydro2d.base.terminal import say
from hydro2d.deck import deck as decks
from hydro2d.files.shipped import problems_folder
from hydro2d.files.whole import write_json
from hydro2d.jit import cache, shipped, store, target
from hydro2d.jit.compilation import announced
from hydro2d.physics.centroids import box_ends
from hydro2d.running import run

#: decks that together call every kernel: contact; tracers and a mesh that moves; light points of an explosive; a slip layer
DECKS = ("cth_nose_shape/hemi_5083_1086_quick", "spall/flyer", "explosives/sandwich", "verification/translation")
#: cycles that call every kernel: more than simulation.WATCH_EVERY
CYCLES = 11


def shipped_decks() -> list[Path]:
    """The decks that are compiled if none is named."""
    return [problems_folder() / f"{name}.toml" for name in DECKS]


def run_briefly(deck, second: bool = False) -> None:
    """Runs a few cycles of a deck in a temporary directory, so that its kernels are in the cache.

    second : whether a second process helps to compile
    """
    few = deck.model_copy(update={"stop": deck.stop.model_copy(update={"cycles": CYCLES})})
    with tempfile.TemporaryDirectory() as folder:
        run.run(few, Path(folder) / "compile", quiet=True, second=second)


def compile_decks(files: Sequence[Path]) -> None:
    """Compiles the kernels of the decks, and prints the time for each. Raises DeckError before anything is compiled."""
    for file, deck in [(file, decks.load(file)) for file in files]:
        with announced(moving.place(), deck if jit.threads() > 1 else None) as compiled:
            run_briefly(deck)
            lines = compiled.closing_lines()
        say(f"{file.name}: {'; '.join(lines) or 'was compiled already'}", flush=True)
    box_ends(1.0, 0.0, 0.0, 0.0, 0.0)  # results and outlines of bodies thinner than a cell call it


def main() -> None:
    """Compiles for a wheel: fills the cache, which must be empty, with only the code and its description.

    Raises TargetError for code that only this processor could run.
    """
    root = Path(cache.root())
    if target.named() is None or target.named().name != target.PROCESSOR:
        raise TargetError(f"code for {target.PROCESSOR} runs on no other processor: HYDRO2D_TARGET must name a target")
    if root.is_dir() and any(root.iterdir()):
        raise FileExistsError(f"{root} is not empty: HYDRO2D_CACHE_DIR must name a new folder")
    compile_decks(shipped_decks())
    for file in root.glob("*/*"):
        if file.suffix != store.ENDING:
            file.unlink()
    write_json(root / shipped.ABOUT, shipped.about())


if __name__ == "__main__":
    main()
