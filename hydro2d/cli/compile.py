"""The command `hydro2d compile`: compiles kernels before a run needs them."""

from __future__ import annotations

import os
from pathlib import Path

from hydro2d.base.errors import TargetError
from hydro2d.base.terminal import say


def compile_kernels(*decks: Path, native: bool = False) -> int:
    """Compiles the kernels of decks, so that their runs begin at once.

    An installation that has brought compiled kernels needs this only for models of your own, and for --native.

    Example: hydro2d compile problems/cth_nose_shape/hemi_5083_1086_quick.toml

    Parameters
    ----------
    decks
        Input decks (TOML); default: shipped decks that together call every kernel.
    native
        Compile for the processor at hand, and use this code from now on in place of that which the installation has brought. It
        is a few per cent faster on processors with AVX-512; the results are the same.
    """
    if native:
        os.environ["HYDRO2D_TARGET"] = "native"  # read when hydro2d.jit is first imported
    from hydro2d.jit import cache, shipped, target
    from hydro2d.running import compile_all

    if native and shipped.IN_USE:
        raise TargetError("--native: this process has begun with the kernels of the installation; run it as a command")
    compile_all.compile_decks(decks or compile_all.shipped_decks())
    if native:
        shipped.prefer_native()
    say(f"compiled for {target.PROCESSOR}; kept in {cache.root()}")
    return 0
