"""Cells made by hand: the arrays of a mesh, as kernels take them, without a simulation."""

from __future__ import annotations

import inspect

import numpy as np

from hydro2d.mesh import fields
from hydro2d.mesh.grid import GHOSTS, Grid
from hydro2d.mesh.state import State


class Cells:
    """A mesh of square cells of 1 m, planar if not told otherwise; its first cell is (2, 2), as ghosts come before it.

    All of it is the active box, in one part, and every body may be in every cell.
    """

    def __init__(self, nr: int = 4, nz: int = 4, bodies: int = 1, group=None, geometry: str = "planar"):
        self.grid = Grid(np.arange(nr + 1.0), np.arange(nz + 1.0), geometry)
        self.state = State(self.grid, bodies, group)
        first, past_r, past_z = GHOSTS, GHOSTS + nr, GHOSTS + nz
        self.mesh_box = np.array([first, past_z, first, past_r])
        self.state.body_ranges[...] = self.state.group_ranges[...] = self.state.occupied[...] = first, past_r
        none = np.full(4, -1)
        self.known = {"part": 0, "parts": np.array([first, past_z]), "i0": first, "i1": past_r, "j0": first, "j1": past_z,
                      "g": GHOSTS, "nr": nr, "nz": nz, "b": 0, "mesh_box": self.mesh_box, "constrained": none, "pushing": none,
                      "transmitting": none, "along_compression": False, "steepness": 2.0,
                      "gases": np.zeros(bodies, dtype=bool),
                      "carried": fields.carried_rows([range(1, self.state.q.shape[0])] * bodies)}  # fmt: skip

    def __getattr__(self, name: str):
        return getattr(self.__dict__["state"], name)

    def call(self, function, **given):
        """Calls a kernel: what is not given is what the state or the mesh has by the name of the parameter."""
        taken = inspect.signature(getattr(function, "py_func", function)).parameters
        assert set(given) <= set(taken), set(given) - set(taken)
        found = {**self.known, **given}
        return function(*(found[name] if name in found else getattr(self.state, name, None) if hasattr(self.state, name)
                          else getattr(self.grid, name) for name in taken))  # fmt: skip
