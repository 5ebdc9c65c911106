"""Limits that no run may exceed, even if its audit closes: clips and sinks have names, so the totals of nonsense close too.

A state is refused if the energy does not add up, a body as a whole is hotter or colder than it can become, the kinetic energy
exceeds all the energy that was put in, or a clip has taken a sizeable share of it. It is not trusted if a body is hotter or
colder in some cell than it can become there (explanation/sanity).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hydro2d.measure.audit import CLIPS, REMEDIES, Audit, Totals, totals
from hydro2d.measure.doubt import Doubt
from hydro2d.measure.reach import MOST_STRAIN, Reach, drift

#: relative change of mass, momentum or energy that no sink explains, from which the audit does not close
CLOSES = 1e-6
#: share of the energy that a clip may take, and by which a total may exceed the possible, in a run to be trusted
TRUSTED = 0.02
#: least energy in addition to that of the motion as a whole, as a share of it
FLIGHT = 0.01
#: shares of the energy of the shot and of the mass of a body: cells with less than both beyond their bounds decide nothing
NOTED_ENERGY, NOTED_MASS = 1e-3, 1e-2
#: cells of which a body fills less than this share are not checked individually
SLIVER = 0.01
#: multiple of the share of a clip that the remap of velocities may discard before that is a fault
DISCARDS = 5.0
#: a body with less than this share of its mass left, the rest having left through an edge, is not checked as a whole
LEFT = 0.1
#: advice on a gas that is too hot
GAS_REMEDY = ". Leave the space empty: a gas in one cell with a solid is not computed well enough"


def faults(state, audit: Audit, names, reach: Reach, share: float = TRUSTED) -> list[str]:
    """Faults of a state, a sentence for each, with its place if it has one; empty if there are none.

    Parameters
    ----------
    state : State
    audit : Audit
    names : of the bodies
    reach : bounds of their energies
    share : of the energy at the start and of that added since, beyond which a clip or a total is a fault; a body may have
        1 + share/TRUSTED times the energy that it can reach
    """
    now, start = totals(state), audit.start
    came = audit.came
    energy, whole = _energy(audit, reach)
    sentences = []
    for kind, error in audit.unexplained(now).items():
        if not abs(error) <= CLOSES:
            sentences.append(f"the {kind} does not add up: {error:.2g} of it is not explained by the audit")
    for m, internal in enumerate(now.internal_of):
        first = min(start.internal_of[m] / max(start.mass[m], 1e-300), 0.0)  # a body that comes in may be colder than e = 0
        if not internal - first * now.mass[m] >= -share * energy:
            sentences.append(f'body "{names[m]}" as a whole has {internal / energy:.2g} times the energy of the start as '
                             f"internal energy{_least_energy(state, m)}")
        if now.mass[m] > LEFT * start.mass[m]:
            sentences += _mean_beyond_reach(m, names[m], state, now, came, reach, share)
    if not now.kinetic - whole <= (1.0 + share) * energy:
        sentences.append(f"the kinetic energy is {(now.kinetic - whole) / energy:.3g} times all the energy put in"
                         f"{_fastest(state, names)}")
    for name in CLIPS:
        removed = audit.sinks[name].energy
        if not abs(removed) <= share * energy:
            sentence = (f"{name} has removed {100 * removed / energy:.2g} % of the energy ({CLIPS[name]}; "
                        f"limit {100 * share:g} %)")
            sentences.append(sentence + (f"; {REMEDIES[name]}" if name in REMEDIES else ""))
    lost = audit.sinks["advection"].energy
    if not -lost <= share * energy:
        sentences.append(f"the remap of velocities has gained {-lost / energy:.2g} of the energy, more than {share:g} of it")
    if not lost <= DISCARDS * share * energy:
        sentences.append(_discarded(lost / energy, DISCARDS * share))
    return sentences


def discards(audit: Audit, reach: Reach) -> Iterator[Doubt]:
    """A doubt if the remap of velocities has discarded more of the energy than a trusted run may lose.

    audit : of the run so far;  reach : bounds of the energies
    """
    share = audit.sinks["advection"].energy / _energy(audit, reach)[0]
    if share > TRUSTED:
        yield Doubt("advection", _discarded(share, TRUSTED))


def _discarded(share: float, limit: float) -> str:
    return (f"the remap of velocities has discarded {share:.2g} of the energy, more than {limit:g} of it; "
            'numerics.advection = "both" keeps it as heat')


def _energy(audit: Audit, reach: Reach) -> tuple[float, float]:
    """Reference energy of shares: at the start without that of the flight as a whole, plus incoming; that of the flight."""
    start = audit.start
    whole = 0.0 if reach.stands else drift(start)  # which depends on the frame
    return max(abs(start.energy - whole), start.kinetic - whole, FLIGHT * whole, audit.noise) + audit.came, whole


def _mean_beyond_reach(m: int, name: str, state, now: Totals, came: float, reach: Reach, share: float) -> Iterator[str]:
    """The fault of the energy of body m as a whole, if any; came : energy that edges brought."""
    span = reach.highest[m] - reach.lowest[m]
    low, high = reach.lowest[m] - share * span, reach.lowest[m] + (1.0 + share / TRUSTED) * span + came / now.mass[m]
    mean = now.internal_of[m] / now.mass[m]
    if low <= mean <= high:
        return
    strain = _mean_strain(state, m)
    if not low <= mean <= high + reach.worked[m] * strain:
        yield (f'body "{name}" has {mean:.3g} J/kg as a whole; it can reach {reach.lowest[m]:.3g} to {reach.highest[m]:.3g} '
               f"J/kg, {_from(reach, m)}, and its mean plastic strain of {strain:.3g} adds {reach.worked[m] * strain:.3g} J/kg")


def _mean_strain(state, m: int) -> float:
    """Mean plastic strain of a body by mass, of no more than MOST_STRAIN in a cell."""
    mass = state.grid.interior(state.vof[m] * state.rho[m] * state.grid.volume)
    return float(np.sum(mass * np.minimum(state.grid.interior(state.ep[m]), MOST_STRAIN)) / np.sum(mass))


def _from(reach: Reach, m: int) -> str:
    return (f"stopped from {reach.speed:.4g} m/s and compressed to {reach.pressure:.3g} Pa"
            f"{GAS_REMEDY if reach.gas[m] else ''}")


def doubts(state, table, time: float, reach: Reach, given: np.ndarray, audit: Audit) -> Iterator[Doubt]:
    """A doubt for each body that is hotter or colder in a cell than it can become, a note if little of it is.

    Parameters
    ----------
    state : State
    table : MaterialTable
    time : since the start, s
    reach : bounds of the energies
    given : the most energy that sources and the work of edges have given to a cell of each body, J/kg, float64[m]
    audit : of the run so far
    """
    from hydro2d.kernels.thermodynamics import worst_energies  # no model can be added after this import

    grid, worst = state.grid, np.zeros((2, 5))
    for m, name in enumerate(table.names):
        high = reach.cell_highest[m] + reach.friction_heating[m] * time + given[m]
        worst_energies(grid.g, grid.nz, grid.nr, m, SLIVER, reach.cell_lowest[m], high, reach.plastic[m], MOST_STRAIN,
                       reach.shear[m], reach.warm[m], reach.chill[m], table.eos_model[m], table.memory[m], table.eos_par[m],
                       grid.volume, state.vof, state.q, worst)
        for what, (beyond, j, i, energy, mass) in zip(("hot", "cold"), worst.tolist(), strict=True):
            if beyond > 0.0:
                j, i = int(j) - grid.g, int(i) - grid.g
                e, strain = grid.interior(state.e)[m, j, i], grid.interior(state.ep)[m, j, i]
                most = high + reach.plastic[m] * min(strain, MOST_STRAIN)
                yield Doubt(f"{name} {what}", (
                    f'body "{name}" is too {what} with {e:.3g} J/kg in the cell {_place(grid, j, i)}, in which it can reach '
                    f"{reach.cell_lowest[m]:.3g} to {most:.3g} J/kg and no temperature of zero, {_from(reach, m)}"),
                    _harmless(energy / _energy(audit, reach)[0], mass / max(audit.start.mass[m], 1e-300)))


def _harmless(energy: float, mass: float) -> str:
    """Why cells beyond their bounds decide nothing, from their shares of the energy of the shot and of the mass of a body;
    empty if they may."""
    few = energy <= NOTED_ENERGY and mass <= NOTED_MASS
    return f"such cells have {100 * mass:.2g} % of its mass, and {energy:.1g} of the energy of the shot too much" if few else ""


def _least_energy(state, m: int) -> str:
    """The cell in which a body has the least internal energy."""
    grid = state.grid
    density = grid.interior(state.vof[m] * state.rho[m] * state.e[m])
    j, i = np.unravel_index(np.argmin(density), density.shape)
    e = state.e[m, j + grid.g, i + grid.g]
    return f", lowest at {e:.3g} J/kg in the cell {_place(grid, j, i)}"


def _fastest(state, names) -> str:
    """The cell below the fastest vertex, and the body that fills most of it."""
    grid = state.grid
    square = grid.interior_vertices((state.u**2 + state.v**2).max(axis=0))[:-1, :-1]
    j, i = np.unravel_index(np.argmax(square), square.shape)
    m = int(np.argmax(state.vof[:, j + grid.g, i + grid.g]))
    return f', highest speed {square[j, i] ** 0.5:.3g} m/s of "{names[m]}" at the cell {_place(grid, j, i)}'


def _place(grid, j: int, i: int) -> str:
    return f"(r, z) = ({grid.rc[i + grid.g]:.6g}, {grid.zc[j + grid.g]:.6g}) m"
