"""hydro2d: a small, CTH-like, two-dimensional axisymmetric Eulerian hydrocode for rod-into-plate impact.

    import hydro2d

    deck = hydro2d.Deck.from_file("problems/perforation/sphere.toml", {"body.ball.velocity": "1200 m/s"})
    shot = hydro2d.run(deck, "runs/ball")
    shot.summary["penetration_depth_m"]
"""

import os
import sys


def _leave_current_directory() -> None:
    """Keeps `python -m hydro2d` from importing modules of the current directory, which may hold a stranger's files."""
    beside = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    asked = sys.argv[:1] == ["-m"] and any(word in ("hydro2d", "-mhydro2d") for word in sys.orig_argv)
    if asked and not sys.flags.safe_path and sys.path[0] != beside:
        del sys.path[0]


_leave_current_directory()

import importlib.util  # noqa: E402
from pathlib import Path  # noqa: E402
from typing import TYPE_CHECKING  # noqa: E402

__version__ = "0.3.0"

if TYPE_CHECKING:
    from hydro2d.api import Study, open_run, open_study, run, sweep
    from hydro2d.deck.deck import Deck
    from hydro2d.errors import DeckError, Error, UnphysicalState
    from hydro2d.materials.outside import register
    from hydro2d.results.reading import Results, ResultsError
    from hydro2d.running.run import RunError
    from hydro2d.solver.callbacks import every
    from hydro2d.solver.simulation import Simulation
    from hydro2d.study.definition import StudyError

#: modules of the public names, imported on first use, so that `import hydro2d` costs nothing
_PLACES = {
    "Deck": "hydro2d.deck.deck",
    "Simulation": "hydro2d.solver.simulation",
    "every": "hydro2d.solver.callbacks",
    "run": "hydro2d.api",
    "open_run": "hydro2d.api",
    "Results": "hydro2d.results.reading",
    "sweep": "hydro2d.api",
    "open_study": "hydro2d.api",
    "Study": "hydro2d.api",
    "register": "hydro2d.materials.outside",
    "Error": "hydro2d.errors",
    "DeckError": "hydro2d.errors",
    "RunError": "hydro2d.running.run",
    "UnphysicalState": "hydro2d.errors",
    "ResultsError": "hydro2d.results.reading",
    "StudyError": "hydro2d.study.definition",
}

__all__ = [
    "Deck",
    "DeckError",
    "Error",
    "Results",
    "ResultsError",
    "RunError",
    "Simulation",
    "Study",
    "StudyError",
    "UnphysicalState",
    "every",
    "open_run",
    "open_study",
    "register",
    "run",
    "sweep",
]


def _own_packages() -> None:
    """Raises ImportError if Python would import another package, or a user's file, as `eos` or `strength`."""
    beside = Path(__file__).resolve().parent.parent
    for name in ("eos", "strength"):
        spec = sys.modules[name].__spec__ if name in sys.modules else importlib.util.find_spec(name)
        file = spec.origin if spec is not None else None
        if file is None or Path(file).resolve().parent != beside / name:
            raise ImportError(f"hydro2d has its own package {name}, but Python finds another one at {file or 'no place'}: "
                              "rename that file, or install hydro2d in a separate environment")


_own_packages()


def __getattr__(name: str) -> object:
    if name not in _PLACES:
        raise AttributeError(f"module 'hydro2d' has no attribute {name!r}")
    return getattr(importlib.import_module(_PLACES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
