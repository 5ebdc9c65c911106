"""What no run may do, whatever its audit says: clips and sinks have names, so the totals close over nonsense as well.

A state is refused where the energy does not add up, a body as a whole is hotter or colder than it can become, a gas is so
anywhere, the kinetic energy has outgrown all that was put in, or a clip has taken a sizeable share of it (explanation/sanity).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hydro2d.solver.audit import CLIPS, Audit, Totals, totals
from hydro2d.solver.reach import Reach

#: relative change of mass, momentum or energy that no sink explains, from which the audit does not close
CLOSES = 1e-6
#: share of the energy that a clip may take, and that a total may be beyond what is possible, in a run to be trusted
TRUSTED = 0.02
#: cells with less of a gas than this share of them are not looked at one by one
SLIVER = 0.01
#: what to do about a gas that is too hot
GAS_REMEDY = ". Leave the space empty: a gas in one cell with a solid is not computed well enough"


def faults(state, audit: Audit, names, reach: Reach, share: float = TRUSTED) -> list[str]:
    """What is wrong with a state, a sentence for each fault with its place where it has one; empty where nothing is.

    Parameters
    ----------
    state : State
    audit : Audit
    names : of the bodies
    reach : bounds of their energies
    share : of the energy of the start and of what came in since, beyond which a clip or a total is a fault; a body may have
        1 + share/TRUSTED times the energy that it can reach
    """
    now, start = totals(state), audit.start
    came = -sum(min(audit.sinks[name].energy, 0.0) for name in ("inflow", "walls", "transmitted"))
    energy = max(abs(start.energy), start.kinetic) + came
    if not energy > 0.0:
        return []
    found = []
    for kind, error in audit.unexplained(now, energy).items():
        if not abs(error) <= CLOSES:
            found.append(f"the {kind} does not add up: {error:.2g} of it is explained by nothing in the audit")
    for m, internal in enumerate(now.internal_of):
        if not internal >= -share * energy:
            found.append(f'body "{names[m]}" as a whole has {internal / energy:.2g} times the energy of the start as internal '
                         f"energy{_least_energy(state, m)}")
        found += _beyond_reach(state, m, names[m], now, came, reach, share)
    if not now.kinetic <= (1.0 + share) * energy:
        found.append(f"the kinetic energy is {now.kinetic / energy:.3g} times the energy that was ever put in"
                     f"{_fastest(state, names)}")
    for name in CLIPS:
        taken = audit.sinks[name].energy
        if not abs(taken) <= share * energy:
            found.append(f"{taken / energy:.2g} of the energy went to {name} ({CLIPS[name]}), more than {share:g} of it")
    gained = -audit.sinks["advection"].energy
    if not gained <= share * energy:
        found.append(f"the remap of velocities has gained {gained / energy:.2g} of the energy, more than {share:g} of it")
    return found


def _beyond_reach(state, m: int, name: str, now: Totals, came: float, reach: Reach, share: float) -> Iterator[str]:
    """What is wrong with the energy of body m, as a whole and, of a gas, in a cell; came : energy that edges brought."""
    if not now.mass[m] > 0.0:
        return
    span = (1.0 + share / TRUSTED) * (reach.highest[m] - reach.lowest[m])
    low = reach.lowest[m] - share * (reach.highest[m] - reach.lowest[m])
    high = reach.lowest[m] + span + came / now.mass[m]
    mean = now.internal_of[m] / now.mass[m]
    if not low <= mean <= high:
        yield f'body "{name}" has {mean:.3g} J/kg as a whole; {_why(reach, m)}'
    elif reach.gas[m]:
        grid = state.grid
        e, there = grid.interior(state.e)[m], grid.interior(state.vof)[m] >= SLIVER
        beyond = np.where(there, np.maximum(e - high, low - e), -np.inf)
        j, i = np.unravel_index(np.argmax(beyond), beyond.shape)
        if not beyond[j, i] <= 0.0:
            yield f'the gas "{name}" has {e[j, i]:.3g} J/kg in the cell {_place(grid, j, i)}; {_why(reach, m)}'


def _why(reach: Reach, m: int) -> str:
    return (f"it can reach {reach.lowest[m]:.3g} to {reach.highest[m]:.3g} J/kg, stopped from {reach.speed:.4g} m/s and "
            f"compressed to {reach.pressure:.3g} Pa{GAS_REMEDY if reach.gas[m] else ''}")


def _least_energy(state, m: int) -> str:
    """The cell in which a body has the least internal energy."""
    grid = state.grid
    density = grid.interior(state.vof[m] * state.rho[m] * state.e[m])
    j, i = np.unravel_index(np.argmin(density), density.shape)
    e = state.e[m, j + grid.g, i + grid.g]
    return f", least of all {e:.3g} J/kg in the cell {_place(grid, j, i)}"


def _fastest(state, names) -> str:
    """The cell below the fastest vertex, and what fills most of it."""
    grid = state.grid
    square = grid.interior_vertices((state.u**2 + state.v**2).max(axis=0))[:-1, :-1]
    j, i = np.unravel_index(np.argmax(square), square.shape)
    m = int(np.argmax(state.vof[:, j + grid.g, i + grid.g]))
    return f', fastest of all {square[j, i] ** 0.5:.3g} m/s of "{names[m]}" at the cell {_place(grid, j, i)}'


def _place(grid, j: int, i: int) -> str:
    return f"(r, z) = ({grid.rc[i + grid.g]:.6g}, {grid.zc[j + grid.g]:.6g}) m"
