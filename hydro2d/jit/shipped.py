"""The compiled code that the package brings, if its wheel has some, and the target that follows from it.

Without HYDRO2D_TARGET this code is used wherever it fits, so that the first run begins at once. Where it does not, or once
`hydro2d compile --native` has been here, code is for the processor at hand.
"""

from __future__ import annotations

import functools
import hashlib
import os
from contextlib import suppress
from pathlib import Path

import llvmlite.binding

from hydro2d.base.errors import Error
from hydro2d.files.whole import read_json
from hydro2d.jit import cache, target

#: the folder of the code, and the file in it that says what it is for
SHIPPED, ABOUT = cache.ROOT / "hydro2d" / "_compiled", "about.json"
#: a feature of processors whose own code is faster than that of the named target (docs/explanation/speed.md)
WIDE = "avx512f"


def places(folder: str) -> tuple[Path, Path]:
    """The folders to search for the contents of a folder of the cache: in the package first, then in the cache."""
    return SHIPPED / os.path.basename(folder), Path(folder)


def about() -> dict[str, str]:
    """Everything that compiled code depends on."""
    return {**target.description(), "sources": cache.sources()}


def default() -> target.Target | None:
    """The target of the package's code if this process can use it; None: the processor at hand."""
    named = target.named()
    if target.is_numbas_choice() or named is None or named.missing() or not (SHIPPED / ABOUT).exists():
        return None
    fitting = {**target.versions(), "processor": named.name, "features": named.flags}
    with suppress(Error):  # `say_if_unused` says what is wrong
        if fitting.items() <= read_json(SHIPPED / ABOUT, Error).items() and not _mark("native").exists():
            return named
    return None


def prefer_native() -> None:
    """From now on processes use code for this processor, until another version of the package brings other code."""
    if (SHIPPED / ABOUT).exists():
        with cache.kept_if_possible():
            _mark("native").touch()


def _mark(name: str) -> Path:
    """A file in the user's cache, empty, for what is so on this processor as long as the package brings this code."""
    digest = hashlib.sha256(llvmlite.binding.get_host_cpu_name().encode() + (SHIPPED / ABOUT).read_bytes())
    return Path(cache.root()) / f"{name}-{digest.hexdigest()[:16]}"


def advice() -> str:
    """A line that says once in every cache how runs become faster than with the package's code; empty if there is no need."""
    if not IN_USE or not llvmlite.binding.get_host_cpu_features().get(WIDE) or (mark := _mark("told")).exists():
        return ""
    with suppress(OSError):
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.touch()
        return (f"the package's kernels for {target.PROCESSOR} are used; kernels for this processor are a few per cent "
                "faster: hydro2d compile --native")
    return ""  # nobody could remember that it was said


@functools.cache
def say_if_unused() -> None:
    """Says why the compiled code of the package cannot be used here, if there is some and nobody has asked for other code."""
    if not (SHIPPED / ABOUT).exists():
        return
    try:
        shipped = read_json(SHIPPED / ABOUT, Error)
        other = next(((what, shipped[what], here) for what, here in about().items() if shipped[what] != here), None)
    except (Error, KeyError) as problem:
        cache.say_once(f"the compiled code of the package is not used: {SHIPPED / ABOUT} does not say what it is for "
                       f"({problem})")
        return
    if other is None:
        return
    what, theirs, here = other
    named = target.named()
    if what == "sources":
        cache.say_once("the compiled code of the package is used in part: its sources were changed")
    elif what not in ("processor", "features") or named is None or shipped["processor"] != named.name:
        remedy = f" (pip install {what}=={theirs})" if what in ("numba", "llvmlite") else ""
        cache.say_once(f"the compiled code of the package is not used: it is for {what} {theirs}, here is {here}{remedy}")
    elif missing := named.missing():
        cache.say_once(f"the compiled code of the package is not used: it is for {named.name}, and this processor has no "
                       f"{', '.join(missing)}")


_DEFAULT = None if os.environ.get("HYDRO2D_TARGET") else default()
target.fix(_DEFAULT or target.asked_for())
#: whether this process uses the package's code because it is the default
IN_USE = _DEFAULT is not None and _DEFAULT.name == target.PROCESSOR
