"""What the phases of a step take: arrays and numbers by name, a few structures instead of dozens of arguments.

The arrays are those of `State`, `Grid` and `Method`; the names say which. A phase reads a structure and hands its arrays on to
kernels: nothing is ever stored through one.
"""

from collections import namedtuple
from typing import NamedTuple

import numpy as np

from hydro2d.mesh import fields

#: fields that no phase reads by themselves: they are rows of q
_ROWS_OF_Q = {field.symbol for field in fields.BODY} - {"dmg"}
#: work of the slip layer that only its own kernels know, and what is looked at between steps
_ELSEWHERE = {"distance", "row_moving", "moving", "cause"}

#: the fields and the velocities, by the symbols of the field table
Fields = namedtuple("Fields", [*(field.symbol for field in fields.FIELDS if field.symbol not in _ROWS_OF_Q | _ELSEWHERE), "q",
                               "velocity", "velocity0"])
#: what phases leave for one another, by the symbols of the table of work, and the first of the ranges of columns
Work = namedtuple("Work", [*(work.symbol for work in fields.WORK if work.symbol not in _ELSEWHERE), "body_range", "active_range"])
#: what contact needs beside, by the symbols of its table of work; without contact empty arrays
ContactWork = namedtuple("ContactWork", [work.symbol for work in fields.CONTACT_WORK])


class Geometry(NamedTuple):
    """The mesh: edges, sizes and volumes as in `Grid`, and the rows and columns of its cells and edges."""

    nr: int
    nz: int
    r: np.ndarray
    z: np.ndarray
    dr: np.ndarray
    dz: np.ndarray
    metrics: np.ndarray
    volume: np.ndarray
    #: rows j0, j1 and columns i0, i1 of the cells of the mesh
    mesh_box: np.ndarray


class Edges(NamedTuple):
    """What stands at the edges of the mesh.

    mirrors : for the four edges, in the order of `boundary_conditions.EDGES`, whether ghosts are images
    constrained, velocity : columns (2) and rows (2) of vertices whose normal velocity is given, -1 for none; what it is, m/s
    void_only : rows (2) and columns (2) of edges through which nothing but void comes in, -1 for the others
    transmitting : columns (2) and rows (2) of the transmitting edges, -1 for the others
    """

    mirrors: tuple
    constrained: np.ndarray
    velocity: np.ndarray
    void_only: np.ndarray
    transmitting: np.ndarray


class Bodies(NamedTuple):
    """The bodies: their groups, what they are made of, what they carry, and how it is remapped."""

    group: np.ndarray
    models: np.ndarray
    materials: np.ndarray
    carried: np.ndarray
    rules: np.ndarray
    #: hard bodies of a slip layer, the order of interfaces; the same with the bodies of one group first
    hard: np.ndarray
    order: np.ndarray
    hard_first: np.ndarray
    soft_first: np.ndarray


class Choices(NamedTuple):
    """The numbers of `Method` that phases need, under the names that they have there."""

    advection: int
    ke_bound: float
    courant: float
    advective_courant: float
    viscosity_linear: float
    viscosity_quadratic: float
    hourglass: float
    tipton: bool
    relaxation: float
    mixed_strength: int
    by_what_is_solid: bool
    cutoff: float
    smallest_tension: bool
    max_opening: float
    threshold: float
    shear: int
    friction: float
    slip_layer: bool
    #: m/s, the largest speed of a vertex; kg/m^3, below it a vertex is hardly filled; bound of an extension's squares
    speed_limit: float
    underfilled_density: float
    most_squares: float


class Ties(NamedTuple):
    """What contact keeps of every contact node, in slots (`solver.contact.Slots`)."""

    strength: np.ndarray
    masters: np.ndarray
    where: np.ndarray
    weights: np.ndarray
    nodes: np.ndarray
    starts: np.ndarray
    entries: np.ndarray
    portions: np.ndarray
    impulses: np.ndarray
    gain: np.ndarray
    taken: np.ndarray
    rubbing: np.ndarray
