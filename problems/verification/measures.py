"""What a problem with an exact solution consists of, and what several of their measures share.

A measure takes the results of a run that has ended and returns quantities; the exact values are those of the modules in
`exact`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

import hydro2d
from problems.verification.cells import Cells

#: the choices of numerics.advection, the default of this folder first
ADVECTION = ("both", "momentum", "ke")

Curve = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Quantity:
    """A number of a run and its exact value; the error is given in per cent of `of`, or of the exact value where `of` is 0."""

    name: str
    unit: str
    exact: float
    found: float
    of: float = 0.0

    @property
    def error(self) -> float:
        """Per cent."""
        return 100.0 * (self.found - self.exact) / abs(self.of or self.exact)


@dataclass(frozen=True)
class Problem:
    """A problem, its deck and how its mesh is refined.

    cells : number of cells of each mesh, in the sense of `resolution`
    refine : cells -> overrides of the deck
    variants : overrides by the name of the variant, the first of them drawn
    measure : a run that has ended, its number of cells -> quantities
    curve : a run that has ended -> the curve drawn; exact : x of the curve -> y, and labels of both axes
    columns : further columns of the history
    """

    name: str
    title: str
    deck: str
    resolution: str
    cells: tuple[int, ...]
    refine: Callable[[int], list[str]]
    measure: Callable[[hydro2d.Results, int], list[Quantity]]
    curve: Callable[[hydro2d.Results], Curve]
    exact: Callable[[np.ndarray], np.ndarray]
    axes: tuple[str, str]
    variants: dict[str, tuple[str, ...]] = field(default_factory=lambda: {"both": ('numerics.advection="both"',)})
    columns: dict[str, Callable[[hydro2d.Simulation], float]] = field(default_factory=dict)

    def overrides(self, variant: str, cells: int) -> list[str]:
        """Overrides of the deck of a run, their numbers in SI units."""
        return ["numbers=SI", *self.variants[variant], *self.refine(cells)]


def cells_of(run: hydro2d.Results) -> Cells:
    """The cells of a run at its end."""
    return Cells(run.simulation())


def advection(*choices: str) -> dict[str, tuple[str, ...]]:
    """Variants by advection; a run by `momentum` goes on however much energy it discards, to see what comes of it."""
    goes_on = {"momentum": ("numerics.clip_limit=1.0",)}
    return {choice: (f'numerics.advection="{choice}"', *goes_on.get(choice, ())) for choice in choices or ADVECTION}


def square(to: float, cells: int, z_start: float = 0.0) -> list[str]:
    """A mesh of ``cells`` cells in each direction."""
    return [f"mesh.r=[{{to={to}, cells={cells}}}]", f"mesh.z=[{{to={to}, cells={cells}}}]", f"mesh.z_start={z_start}"]


def column(to: float, cells: int, start: float = 0.0) -> list[str]:
    """Four columns of ``cells`` cells along z."""
    size = (to - start) / cells
    return [f"mesh.r=[{{to={4 * size}, cells=4}}]", f"mesh.z=[{{to={to}, cells={cells}}}]", f"mesh.z_start={start}"]


def difference(computed: np.ndarray, exact: np.ndarray, weight: np.ndarray | float = 1.0) -> float:
    """L1 of the difference over L1 of the exact values, in per cent."""
    return float(100.0 * np.sum(weight * np.abs(computed - exact)) / np.sum(weight * np.abs(exact)))


def profile(name: str, computed: np.ndarray, exact: np.ndarray, weight: np.ndarray | float = 1.0) -> Quantity:
    """The L1 error of a profile."""
    return Quantity(f"L1 error of {name}", "%", 0.0, difference(computed, exact, weight), 100.0)


def lost(run: hydro2d.Results) -> Quantity:
    """Energy that the advection of velocities discarded or clipped, of the energy at the start."""
    conservation = run.summary.conservation
    discarded = sum(conservation.sinks[name].energy_J for name in ("advection", "ke_bound"))
    return Quantity("energy discarded", "%", 0.0, 100.0 * discarded / conservation.start_energy_J, 100.0)


def extrema(time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of the extrema inside a record, by the parabola through three points."""
    turns = np.nonzero((np.diff(values)[1:] * np.diff(values)[:-1]) < 0.0)[0] + 1
    points = []
    for k in turns:
        a, b, _ = np.polyfit(time[k - 1 : k + 2] - time[k], values[k - 1 : k + 2], 2)
        points.append((time[k] - 0.5 * b / a, np.polyval((a, b, values[k]), -0.5 * b / a)))
    return tuple(np.array(points).T)
