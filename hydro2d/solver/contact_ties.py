"""Contact within a step: what `Cycle` does in addition to its own phases where two body groups meet (explanation/sliding)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hydro2d.kernels import lagrangian_step
from hydro2d.kernels.contact import extension
from hydro2d.measure.audit import Audit


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


class NoContact:
    """One group of bodies, without a second one to meet.

    ties : empty slots, for phases without contact nodes
    """

    def __init__(self):
        self.ties = slots()

    def find(self, parts, given) -> None:
        """Finds where the groups meet; parts : int64[n + 1], rows;  given : Given."""

    def account(self, audit: Audit) -> None:
        """Enters into the audit the transfers of contact between groups and walls in the step."""


class Contact(NoContact):
    """Two groups of bodies of a state that touch, press and slide; it keeps the slots of their contact nodes."""

    def __init__(self, state):
        super().__init__()
        self.state = state

    def find(self, parts, given) -> None:
        """Sets up the contact: face apertures, normals, slave nodes; volume rate and viscosity of contact-interface cells.

        Beyond the active box bodies that touch have no pressure to exchange yet.
        """
        if (needed := int(self.state.first_slot[parts[-1] + 1])) > len(self.ties.strength):
            self.ties = slots(2 * needed)
        given.run(lagrangian_step.find_contact)

    def account(self, audit: Audit) -> None:
        """Enters into the audit the transfers of contact between groups and walls in the step."""
        pushed, *heats, walls = self.state.transfer_sum.tolist()
        audit.add("walls", momentum=walls)
        audit.transfer("contact", momentum=pushed, energy=heats[0])
        audit.transfer("friction", energy=heats[1])
        audit.transfer("under-filled nodes", energy=heats[2])
