"""The command `hydro2d compile`: compiles kernels before a run needs them."""

from __future__ import annotations

from pathlib import Path

from hydro2d.base.terminal import say


def compile_kernels(*decks: Path) -> int:
    """Compiles the kernels of decks, so that their runs begin at once.

    Example: hydro2d compile problems/cth_nose_shape/hemi_5083_1086_quick.toml

    Parameters
    ----------
    decks
        Input decks (TOML); default: shipped decks that together call every kernel.
    """
    from hydro2d.jit import cache, target
    from hydro2d.running import compile_all

    compile_all.compile_decks(decks or compile_all.shipped_decks())
    say(f"compiled for {target.PROCESSOR}; kept in {cache.root()}")
    return 0
