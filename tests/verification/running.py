"""Runs decks for verification tests and reads profiles along one axis."""

from __future__ import annotations

import functools

import numpy as np

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from problems.verification.cells import crossing as crossing

FOLDER = "problems/verification"
ADVECTION = ("ke", "momentum", "both")


def advection(choice: str) -> str:
    """The override that sets the advection choice."""
    return f'numerics.advection="{choice}"'


def finish(deck, watch=None) -> Simulation:
    """Runs a deck to its end time; `watch(simulation)` is called after every step."""
    simulation = Simulation(deck)
    while simulation.time < deck.stop.time:
        simulation.step()
        if watch is not None:
            watch(simulation)
    return simulation


def to_the_end(simulation: Simulation) -> Simulation:
    """Steps until a condition of the deck ends the run."""
    while simulation.stop_reason() is None:
        simulation.step()
    return simulation


@functools.cache
def run(name: str, *overrides: str) -> Simulation:
    """A shipped verification deck at its end; each combination of overrides, in SI units, runs once. Not to be modified."""
    return finish(decks.load(f"{FOLDER}/{name}.toml", ["numbers=SI", *overrides]))


class Line:
    """Values along the axis on which a plane problem depends, from a column (or row) in the middle of the mesh.

    Arrays without ghosts: centres x [n], vertices xv [n + 1].

    Parameters
    ----------
    simulation : Simulation
    axis : "z" or "r"
    """

    def __init__(self, simulation: Simulation, axis: str = "z"):
        self.simulation, self.axis = simulation, axis
        grid = simulation.grid
        g = grid.g
        centres, edges, n = (grid.zc, grid.z, grid.nz) if axis == "z" else (grid.rc, grid.r, grid.nr)
        self.x, self.xv = centres[g : g + n], edges[g : g + n + 1]
        self.dx = np.diff(self.xv)

    def _inside(self, array: np.ndarray, vertex: bool = False) -> np.ndarray:
        grid = self.simulation.grid
        inner = grid.interior_vertices(array) if vertex else grid.interior(array)
        column = inner.shape[-1 if self.axis == "z" else -2] // 2
        return inner[..., :, column] if self.axis == "z" else inner[..., column, :]

    def body(self, name: str, m: int = 0) -> np.ndarray:
        """A field of the state for body m, such as "rho"."""
        return self._inside(getattr(self.simulation.state, name)[m])

    @property
    def velocity(self) -> np.ndarray:
        """Velocity along the axis, at the vertices."""
        state = self.simulation.state
        return self._inside((state.v if self.axis == "z" else state.u)[0], vertex=True)

    @property
    def pressure(self) -> np.ndarray:
        """Sum of volume fraction times pressure, as the last step left it."""
        state = self.simulation.state
        return self._inside(np.sum(state.vof * state.pm, axis=0))

    @property
    def axial_stress(self) -> np.ndarray:
        """p - s_zz summed by volume fraction, positive in compression."""
        state = self.simulation.state
        return self._inside(np.sum(state.vof * (state.pm - state.szz), axis=0))

    @property
    def filled(self) -> np.ndarray:
        """Share of a cell that is not void."""
        return self._inside(np.sum(self.simulation.state.vof, axis=0))


def between(x: np.ndarray, low: float, high: float, margin: float = 0.15) -> np.ndarray:
    """Mask of the points between low and high, without a margin (a share of the distance) at either end."""
    cut = margin * (high - low)
    inside = (x > low + cut) & (x < high - cut)
    assert inside.sum() >= 3, f"too few points between {low} and {high}"
    return inside


def speed(times, positions) -> float:
    """Slope of position over time by least squares."""
    return float(np.polyfit(times, positions, 1)[0])
