"""Cells made by hand: the arrays of a mesh, as kernels take them, without a simulation."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from hydro2d.jit import by_name
from hydro2d.mesh import fields
from hydro2d.mesh.grid import GHOSTS, Grid
from hydro2d.mesh.state import State


def handle(**values) -> SimpleNamespace:
    """The values that a function of kernels takes by name."""
    return SimpleNamespace(**values)


def handles(function, values: dict) -> list[SimpleNamespace]:
    """The last arguments of a call of a function: a handle of these values, if it takes one."""
    return [handle(**values)] if by_name.takes_handle(function) else []


def lines(*normal: int, along=(-1, -1, -1, -1)) -> np.ndarray:
    """Columns (2) and rows (2) of edges with a prescribed normal velocity, then of those that also prescribe it along them."""
    return np.array([*(normal or (-1, -1, -1, -1)), *along])


def source(function):
    """A compiled function as Python runs it."""
    return by_name.source(function) if by_name.takes_handle(function) else getattr(function, "compiled", function).py_func


class Cells:
    """A mesh of square cells of 1 m, planar by default; its first cell is (2, 2), after the ghosts.

    All of it is the active box, in one part, and every body may be in every cell. Sweeps go along r.
    """

    def __init__(self, nr: int = 4, nz: int = 4, bodies: int = 1, group=None, geometry: str = "planar"):
        self.grid = Grid(np.arange(nr + 1.0), np.arange(nz + 1.0), geometry)
        self.state = State(self.grid, bodies, group)
        first, past_r, past_z = GHOSTS, GHOSTS + nr, GHOSTS + nz
        self.mesh_box = np.array([first, past_z, first, past_r])
        self.state.body_ranges[...] = self.state.group_ranges[...] = self.state.occupied[...] = first, past_r
        none = np.full(4, -1)
        self.known = {"part": 0, "parts": np.array([first, past_z]), "i0": first, "i1": past_r, "j0": first, "j1": past_z,
                      "g": GHOSTS, "nr": nr, "nz": nz, "b": 0, "mesh_box": self.mesh_box, "constrained": lines(),
                      "pushing": none, "loaded": none, "edge_pressure": np.zeros(4), "dj": 0, "di": 1, "steepness": 2.0,
                      "sound_floor": 1.0,
                      "gases": np.zeros(bodies, dtype=bool),
                      "carried": fields.carried_rows([range(1, self.state.q.shape[0])] * bodies)}

    def __getattr__(self, name: str):
        return getattr(self.__dict__["state"], name)

    def call(self, function, as_python: bool = False, **given):
        """Calls a function of kernels: arguments not given are those of the state or the mesh with that name."""
        own, names = by_name.own_parameters(function), by_name.takes(function)
        assert set(given) <= set(names), set(given) - set(names)
        known = {**self.known, **given}
        values = {name: known[name] if name in known else getattr(self.state, name, None) if hasattr(self.state, name)
                  else getattr(self.grid, name) for name in names}
        return (source(function) if as_python else function)(*(values[name] for name in own), *handles(function, values))
