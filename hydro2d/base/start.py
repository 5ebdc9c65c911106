"""The start of the package: Python finds hydro2d's own packages, and no file of the current directory in place of a module."""

import os
import sys


def leave_current_directory() -> None:
    """Keeps `python -m hydro2d` from importing modules of the current directory, which may hold a stranger's files."""
    beside = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    asked = sys.argv[:1] == ["-m"] and any(word in ("hydro2d", "-mhydro2d") for word in sys.orig_argv)
    if asked and not sys.flags.safe_path and sys.path[0] != beside:
        del sys.path[0]


leave_current_directory()

import importlib.util  # noqa: E402
from pathlib import Path  # noqa: E402


def check_own_packages() -> None:
    """Raises ImportError if Python would import another package, or a user's file, as `eos` or `strength`."""
    beside = Path(__file__).resolve().parent.parent.parent
    for name in ("eos", "strength"):
        spec = sys.modules[name].__spec__ if name in sys.modules else importlib.util.find_spec(name)
        file = spec.origin if spec is not None else None
        if file is None or Path(file).resolve().parent != beside / name:
            raise ImportError(f"hydro2d has its own package {name}, but Python finds another one at {file or 'no place'}: "
                              "rename that file, or install hydro2d in a separate environment")
