"""One impact in four frames, on meshes placed differently: the rod, the plate or both move, and the mesh may follow the rod.

A rod of tungsten alloy, 10 mm thick and 30 mm long, hits 5083 aluminium at 1 km/s. The answers must agree
(explanation/following-mesh).
"""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.mesh.fields import EP
from hydro2d.solver.simulation import Simulation
from tests.decks import contact, mesh, plate, rod, stop, table

CELL = 10e-3 / 11.0
SHIFTS = (0.0, 0.25, 0.5, 0.75)


def impact(velocity: float, shift: float, *options: str) -> Simulation:
    """The impact with a rod of this velocity (m/s); the mesh is shifted by a part of a cell."""
    behind, ahead = 72 if velocity < 1000.0 else 40, 42
    text = (
        mesh([{"cells": 14, "across": "rod", "cells_across": 5.5}, {"to": 60e-3, "ratio": 1.12}],
             [{"to": (ahead - shift) * CELL, "cells": ahead + behind}, {"to": 80e-3, "ratio": 1.12}],
             z_start=-(behind + shift) * CELL)
        + rod(5e-3, 30e-3, tip=0.0, velocity=velocity)
        + plate(78e-3, velocity=velocity - 1000.0)
        + table("failure", damage="none")
        + contact("rod")
        + stop("25 us")
    )
    return Simulation(decks.loads(text, list(options)))


def nose_strain(simulation: Simulation) -> float:
    """Mean plastic strain of the rod within 5 mm of its tip, by volume."""
    grid, state = simulation.grid, simulation.state
    share, strain, volume = (grid.interior(x) for x in (state.vof[0], state.q[EP, 0], grid.volume))
    z = grid.zc[grid.inside[0]]
    near = z > z[np.flatnonzero(share[:, 0] > 0.5).max()] - 5e-3
    return np.average(strain[near], weights=(share * volume)[near])


def outcome(velocity: float, shift: float, *options: str) -> tuple[float, float, float]:
    """Depth in m, speed lost in m/s, and the mean plastic strain of the nose, 25 us after the impact."""
    simulation = impact(velocity, shift, *options)
    simulation.run()
    bodies = simulation.of_bodies()["rod"]
    frame = velocity - 1000.0
    lost = 1000.0 - (bodies["velocity_m_s"] - frame)
    depth = bodies["z_max_m"] - frame * simulation.time - (1000.0 - lost) * (simulation.time - 25e-6)
    return depth, lost, nose_strain(simulation)


FRAMES = [
    pytest.param(1000.0, ('mesh.follow="rod"',), id="mesh follows"),
    pytest.param(0.0, (), id="plate moves"),
    pytest.param(1000.0, (), id="rod moves"),
    pytest.param(500.0, (), id="both move"),
]


@pytest.mark.thorough
@pytest.mark.parametrize(("velocity", "options"), FRAMES)
@pytest.mark.parametrize("shift", SHIFTS)
def test_an_impact_is_the_same_in_every_frame(velocity, options, shift):
    """Depth within 0.22 %, loss of speed within 1.8 %, mean strain of the nose within 13 %, whatever moves and on every mesh.

    On twice as fine a mesh they are 23.79 mm, 78.6 m/s and 0.022, on four times as fine a one 23.81 mm and 78.5 m/s.
    """
    depth, lost, strain = outcome(velocity, shift, *options)
    assert depth == pytest.approx(23.64e-3, rel=0.003)
    assert lost == pytest.approx(82.1, rel=0.02)
    assert strain == pytest.approx(0.029, rel=0.14)


def test_a_plate_is_not_touched_before_the_nose_is_there():
    """A mesh line in the plate's face: for 0.2 us it has only void next to it, except where the cap of the nose has met it."""
    simulation = impact(1000.0, 0.0)
    grid, state = simulation.grid, simulation.state
    row = int(np.argmin(np.abs(grid.z_edges)))  # the first row of the plate
    while simulation.time < 0.2e-6:
        simulation.step()
    cap = np.sqrt(2.0 * 5e-3 * 1000.0 * simulation.time)
    beyond = grid.r_edges[:-1] > cap + CELL
    rod_there, plate_there = (grid.interior(state.vof[m])[row] for m in (0, 1))
    assert beyond[:6].sum() >= 3
    assert not rod_there[beyond].any()
    assert np.abs(1.0 - plate_there[beyond][:4]).max() < 1e-3
