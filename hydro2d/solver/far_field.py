"""The undisturbed state of bodies beyond transmitting edges, on which waves go out: what the deck has placed at the edge."""

from __future__ import annotations

import numpy as np

from hydro2d.deck import deck as decks
from hydro2d.deck.layout import layout
from hydro2d.mesh.boundary_conditions import BoundaryConditions
from hydro2d.mesh.edges.base import DASHPOTS
from hydro2d.mesh.fields import CUT, FAR_P, FAR_U, FAR_V
from hydro2d.mesh.grid import Grid
from hydro2d.solver import insertion

#: thickness of the strip in which a body counts as lying at an edge, in cells
STRIP = 1e-6


def place(deck, state, table, boundaries: BoundaryConditions) -> None:
    """Sets `State.far`: velocity and pressure of every body that an edge cuts, at each place along the edge.

    Where such a body does not lie at the edge at the start, it has the state of the nearest place where it does: a body that
    moves along an edge keeps its own. An edge cuts a body that lies at it at the start. On a mesh that travels, the outer edge
    cuts the bodies that reach it anywhere, and an edge along z those that do not fly with the mesh; each has one state there.

    deck, table : resolved;  state : State, whose `far` is written
    """
    grid = state.grid
    for edge, kind in enumerate(boundaries.edges):
        if kind.traction() == DASHPOTS:
            cells, strip = _beside(deck, grid, edge)
            first = insertion.initial_state(deck, cells, table, np.arange(len(table)))
            there = insertion.insert(deck, strip, table) > 0.0
            lines = {name: _from_the_edge(first[name], edge) for name in ("vof", "rho", "e", "u_cell", "v_cell")}
            for m, body in enumerate(table.names):
                if there[m].any() and not (edge >= 2 and _flies_along(deck, body)):
                    own = {name: values[:, m] for name, values in lines.items()}
                    _fill(state.far[:, edge, m, grid.g:], own, (grid.nz, grid.nr)[edge >= 2], table, m, _overhang(cells, edge))


def _beside(deck, grid, edge: int) -> tuple[Grid, Grid]:
    """The two lines of cells next to an edge, and a strip at the edge; of all that the deck has placed if the mesh travels."""
    r, z = grid.r_edges, grid.z_edges
    if deck.mesh.follow is not None:
        ends = [end for body in layout(deck).bodies for end in body.outline.extent("z")]
        z = np.array([min(z[0], *ends), max(z[-1], *ends)])
    across = r if edge < 2 else z
    lines = across[-3:] if edge % 2 else across[:3]
    width = STRIP * (lines[1] - lines[0])
    strip = np.array([lines[-1] - width, lines[-1]] if edge % 2 else [lines[0], lines[0] + width])
    if deck.mesh.follow is not None and edge >= 2:
        strip = lines
    return (Grid(lines, z, grid.geometry), Grid(strip, z, grid.geometry)) if edge < 2 else (
        Grid(r, lines, grid.geometry), Grid(r, strip, grid.geometry))


def _from_the_edge(values: np.ndarray, edge: int) -> np.ndarray:
    """Values in the lines of cells next to an edge as [line from the edge, m, place along it], from [m, j, i]."""
    lines = np.moveaxis(values, 2 if edge < 2 else 1, 0)
    return lines[::-1] if edge % 2 else lines


def _overhang(cells: Grid, edge: int) -> float:
    """How far the edge lies beyond the middle of the cell next to it, over the distance to the middle of the second one."""
    sizes = np.diff(cells.r_edges if edge < 2 else cells.z_edges)
    own, next_one = sizes[::-1] if edge % 2 and len(sizes) > 1 else (*sizes, np.inf)[:2]
    return float(own / (own + next_one))


def _flies_along(deck, body: str) -> bool:
    """Whether a body flies with the body that the mesh follows."""
    follow = deck.mesh.follow
    return follow is not None and decks.body(deck, body).velocity == decks.body(deck, follow).velocity


def _fill(far: np.ndarray, lines: dict[str, np.ndarray], places: int, table, m: int, overhang: float) -> None:
    """Writes the state of body m beyond an edge into far [4, place].

    lines : its state in the cells next to the edge, [line from the edge, place]. The pressure is that at the edge, on the
    straight line through those of two cells: under a force, as in water with a weight, it differs from that in the first one.
    """
    known = np.flatnonzero(lines["vof"][0] > 0.0)
    pressures: dict[tuple[float, float], float] = {}

    def pressure(line: int, at: int) -> float:
        state = float(lines["rho"][line, at]), float(lines["e"][line, at])
        if state not in pressures:
            pressures[state] = table.evaluate(m, *state)[0]
        return pressures[state]

    own = np.array([pressure(0, at) for at in known])
    if len(lines["vof"]) > 1:
        both = lines["vof"][1, known] > 0.0
        own += overhang * np.array([own[n] - pressure(1, at) if both[n] else 0.0 for n, at in enumerate(known)])
    everywhere = np.arange(places)
    for row, values in ((FAR_U, lines["u_cell"][0, known]), (FAR_V, lines["v_cell"][0, known]), (FAR_P, own)):
        far[row, :places] = np.interp(everywhere, known, values)
    far[CUT, :places] = 1.0
