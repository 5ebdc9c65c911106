"""Spall with cracks that open: a free-surface velocity that does not depend on the mesh, and a total energy that closes."""

import functools

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from problems.spall.read import pull_back

CELLS = {("flyer", 100): 200, ("flyer", 200): 400, ("pulse", 100): 140, ("pulse", 200): 280}
END = {"flyer": "5.5 mm", "pulse": "5.6 mm"}


@functools.cache
def shot(name: str, cells: int, damage: str = "material"):
    """The velocity of the tracer under the surface over time, and the simulation at its end."""
    own = [f"mesh.z=[{{to='{END[name]}', cells={CELLS[name, cells]}}}]", f'failure.damage="{damage}"',
           "failure.record=true"]
    simulation = Simulation(decks.load(f"problems/spall/{name}.toml", own))
    place, last, velocity = 3.94e-3, 0.0, []
    while simulation.time < simulation.deck.stop.time:
        simulation.step()
        column = simulation.state.v[0, :, simulation.grid.g]
        velocity.append(float(np.interp(place, simulation.grid.z, column)))
        place, last = place + velocity[-1] * (simulation.time - last), simulation.time
    return np.array(velocity), simulation


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "within"), [("flyer", 0.04), ("pulse", 0.06)])
def test_the_pull_back_is_the_same_on_two_meshes(name, within):
    """3.6 % apart for the flyer; 400 cells are in problems/spall/results."""
    (top, low, _), (fine_top, fine_low, _) = (pull_back(shot(name, cells)[0]) for cells in (100, 200))
    assert top - low == pytest.approx(fine_top - fine_low, rel=within)


@pytest.mark.parametrize("name", END)
def test_energy_and_mass_close(name):
    balance = shot(name, 100)[1].conservation()
    assert abs(balance["total_energy"]) < 1e-12
    assert max(abs(each) for each in balance["mass"].values()) < 1e-12


def test_a_layer_parts():
    """There is void inside the target, no other cell bears more than the fracture pressure, and the layer is sound."""
    simulation = shot("flyer", 100)[1]
    grid, state = simulation.grid, simulation.state
    filled = grid.interior(state.vof.sum(axis=0))[:, 0]
    inside = np.flatnonzero(filled > 0.5)
    gap = filled[inside[0]:inside[-1]] < 0.5
    assert gap.any()
    damage = grid.interior(state.dmg)[1, inside[-1] - 12:inside[-1], 0]
    assert damage.max() < 1.0
    causes, failed = simulation.field("body_failed_by", "target"), grid.interior(state.dmg)[1] >= 1.0
    assert failed.any()
    assert (causes == np.where(failed & (grid.interior(state.vof)[1] > 0.0), 4, 0)).all()
