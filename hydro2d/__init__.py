"""hydro2d: a small, CTH-like, two-dimensional axisymmetric Eulerian hydrocode for rod-into-plate impact.

    import hydro2d

    deck = hydro2d.Deck.from_file("problems/perforation/sphere.toml", {"body.ball.velocity": "1200 m/s"})
    shot = hydro2d.run(deck, "runs/ball")
    shot.summary.penetration_depth_m
"""

from hydro2d.base import start  # first: it leaves the current directory

start.check_own_packages()

import importlib  # noqa: E402
from typing import TYPE_CHECKING  # noqa: E402

from hydro2d.base.version import __version__ as __version__  # noqa: E402

if TYPE_CHECKING:
    from hydro2d.analytic.experience import Experience, Impact, impact_of
    from hydro2d.api import (
        Study,
        fit_residual_velocity,
        open_run,
        open_study,
        penetration_model,
        penetration_models,
        run,
        sweep,
    )
    from hydro2d.base.errors import DeckError, Error, UnphysicalState
    from hydro2d.base.method_version import METHOD
    from hydro2d.base.units import to_si
    from hydro2d.deck.deck import Deck
    from hydro2d.materials.outside import register
    from hydro2d.measure.regime import LEAST_KEPT_LENGTH
    from hydro2d.measure.summary import Summary
    from hydro2d.output.directory import RunError
    from hydro2d.results.figures import new_figure, save_figure
    from hydro2d.results.reading import Results, ResultsError
    from hydro2d.solver.callbacks import every
    from hydro2d.solver.simulation import Simulation
    from hydro2d.study.ensemble.chance import bias_and_scatter, wilson
    from hydro2d.study.ensemble.extrapolation import grid_convergence
    from hydro2d.study.plan.definition import StudyError
    from hydro2d.study.records.keeping import method_note
    from hydro2d.study.records.runs import runs
    from hydro2d.study.records.study_directory import Case
    from hydro2d.study.samples.kept import kept_samples
    from hydro2d.study.samples.objective import Objective
    from hydro2d.study.samples.results import Samples
    from hydro2d.study.search.logit import fit_transition

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
    "Case": "hydro2d.study.records.study_directory",
    "Samples": "hydro2d.study.samples.results",
    "Objective": "hydro2d.study.samples.objective",
    "runs": "hydro2d.study.records.runs",
    "kept_samples": "hydro2d.study.samples.kept",
    "method_note": "hydro2d.study.records.keeping",
    "penetration_model": "hydro2d.api",
    "penetration_models": "hydro2d.api",
    "fit_residual_velocity": "hydro2d.api",
    "fit_transition": "hydro2d.study.search.logit",
    "wilson": "hydro2d.study.ensemble.chance",
    "bias_and_scatter": "hydro2d.study.ensemble.chance",
    "grid_convergence": "hydro2d.study.ensemble.extrapolation",
    "Experience": "hydro2d.analytic.experience",
    "Impact": "hydro2d.analytic.experience",
    "impact_of": "hydro2d.analytic.experience",
    "to_si": "hydro2d.base.units",
    "Summary": "hydro2d.measure.summary",
    "LEAST_KEPT_LENGTH": "hydro2d.measure.regime",
    "METHOD": "hydro2d.base.method_version",
    "new_figure": "hydro2d.results.figures",
    "save_figure": "hydro2d.results.figures",
    "register": "hydro2d.materials.outside",
    "Error": "hydro2d.base.errors",
    "DeckError": "hydro2d.base.errors",
    "RunError": "hydro2d.output.directory",
    "UnphysicalState": "hydro2d.base.errors",
    "ResultsError": "hydro2d.results.reading",
    "StudyError": "hydro2d.study.plan.definition",
}

__all__ = [
    "LEAST_KEPT_LENGTH",
    "METHOD",
    "Case",
    "Deck",
    "DeckError",
    "Error",
    "Experience",
    "Impact",
    "Objective",
    "Results",
    "ResultsError",
    "RunError",
    "Samples",
    "Simulation",
    "Study",
    "StudyError",
    "Summary",
    "UnphysicalState",
    "bias_and_scatter",
    "every",
    "fit_residual_velocity",
    "fit_transition",
    "grid_convergence",
    "impact_of",
    "kept_samples",
    "method_note",
    "new_figure",
    "open_run",
    "open_study",
    "penetration_model",
    "penetration_models",
    "register",
    "run",
    "runs",
    "save_figure",
    "sweep",
    "to_si",
    "wilson",
]


def __getattr__(name: str) -> object:
    if name not in _PLACES:
        raise AttributeError(f"module 'hydro2d' has no attribute {name!r}")
    return getattr(importlib.import_module(_PLACES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
