"""What no run may do, whatever its audit says: clips and sinks have names, so the totals close over nonsense as well.

A state is refused where the energy does not add up, a body as a whole has lost more internal energy than there ever was, the
kinetic energy has outgrown all that was put in, or a clip has taken a sizeable share of it (explanation/sanity).
"""

from __future__ import annotations

import numpy as np

from hydro2d.solver.audit import CLIPS, REMEDIES, Audit, totals

#: relative change of mass, momentum or energy that no sink explains, from which the audit does not close
CLOSES = 1e-6
#: share of the energy that a clip may take, and that a total may be beyond what is possible, in a run to be trusted
TRUSTED = 0.02


def faults(state, audit: Audit, names, share: float = TRUSTED) -> list[str]:
    """What is wrong with a state, a sentence for each fault with its place where it has one; empty where nothing is.

    Parameters
    ----------
    state : State
    audit : Audit
    names : of the bodies
    share : of the energy of the start and of what came in since, beyond which a clip or a total is a fault
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
    if not now.kinetic <= (1.0 + share) * energy:
        found.append(f"the kinetic energy is {now.kinetic / energy:.3g} times the energy that was ever put in"
                     f"{_fastest(state, names)}")
    for name in CLIPS:
        taken = audit.sinks[name].energy
        if not abs(taken) <= share * energy:
            remedy = f"; {REMEDIES[name]}" if name in REMEDIES else ""
            found.append(f"{taken / energy:.2g} of the energy went to {name} ({CLIPS[name]}), more than {share:g} of it"
                         f"{remedy}")
    gained = -audit.sinks["advection"].energy
    if not gained <= share * energy:
        found.append(f"the remap of velocities has gained {gained / energy:.2g} of the energy, more than {share:g} of it")
    return found


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
