"""The memory of a contact: data of its nodes in slots, as many as are needed (explanation/sliding)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hydro2d.kernels.contact import extension


class Ties(NamedTuple):
    """Data of contact for every contact node, in slots: the nodes of row j have those from first_slot[j] on.

    How firmly nodes are tied, to how many masters, to which and with what weights (`find_extensions`); then the data for
    `resolve_contact` to solve for the impulses of the ties. Nothing in the arrays outlasts a step.
    """

    strength: np.ndarray
    masters: np.ndarray
    where: np.ndarray
    weights: np.ndarray
    nodes: np.ndarray
    starts: np.ndarray
    entries: np.ndarray
    portions: np.ndarray
    firsts: np.ndarray
    sharing: np.ndarray
    lines: np.ndarray
    columns: np.ndarray
    elements: np.ndarray
    matrix: np.ndarray
    impulses: np.ndarray
    search: np.ndarray
    passed_impulse: np.ndarray
    friction_impulse: np.ndarray


#: ties that can share a vertex with one: both groups' in the square in which the squares of their masters overlap
NEIGHBOURS = 2 * (2 * extension.SPAN - 1) ** 2


def slots(number: int = 0) -> Ties:
    """Ties with slots for a number of contact nodes."""
    ties = 2 * number
    entries, elements = ties * (extension.MASTERS + 2), ties * min(ties, NEIGHBOURS)
    return Ties(
        strength=np.zeros((number, 2)),
        masters=np.zeros((number, 2), dtype=np.int64),
        where=np.zeros((number, 2, extension.MASTERS + 1), dtype=np.int64),
        weights=np.zeros((number, 2, extension.MASTERS + 1)),
        nodes=np.zeros((4, ties), dtype=np.int64),
        starts=np.zeros(ties + 1, dtype=np.int64),
        entries=np.zeros((4, entries), dtype=np.int64),
        portions=np.zeros((entries, 4)),
        firsts=np.zeros(entries + 1, dtype=np.int64),
        sharing=np.zeros((2, entries), dtype=np.int64),
        lines=np.zeros(ties + 1, dtype=np.int64),
        columns=np.zeros(elements, dtype=np.int64),
        elements=np.zeros(ties, dtype=np.int64),
        matrix=np.zeros((elements, 2)),
        impulses=np.zeros((ties, 8)),
        search=np.zeros((ties, 2)),
        passed_impulse=np.zeros((2, number, 2)),
        friction_impulse=np.zeros((3, number)),
    )


#: Courant number above which the squares of an extension's weights are not bounded further
LONGEST = 0.5


def most_squares(table, courant: float) -> float:
    """Largest sum of the squares of an extension's weights that the time step allows (explanation/sliding, equation 7).

    A cell with the modulus K of the stiffest body that pushes a slave whose masters have the density rho of the lightest but
    for gases swings with omega^2 = (K/rho) sum N^2/h^2; omega dt <= 2 with dt = courant h/c of the fastest. No less than at the
    Courant number LONGEST: nodes whose gradients are reduced further are less stable, not more.
    """
    courant = min(courant, LONGEST)
    speeds = table.sound_speeds()
    lightest = table.rho0[~table.gases()].min()
    return float(max(4.0 * lightest * speeds.max() ** 2 / ((table.rho0 * speeds**2).max() * courant**2), 1.0))


class Contact:
    """The slots of the contact nodes of a state, of which there are more when more are needed; none with one group.

    Attributes
    ----------
    ties : Ties
    """

    def __init__(self, state):
        self.state, self.ties = state, slots()

    def make_room(self, handle) -> None:
        """Doubles the slots that are needed now, and gives them to a handle."""
        self.ties = slots(2 * int(self.state.first_slot[handle.parts[-1] + 1]))
        handle.update(**self.ties._asdict())
