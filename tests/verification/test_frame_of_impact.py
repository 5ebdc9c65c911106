"""One impact in four frames, on meshes placed differently: the rod, the plate or both move, and the mesh may follow the rod.

A rod of tungsten alloy, 10 mm thick and 30 mm long, hits 5083 aluminium at 1 km/s. The answers must agree; their differences in
the worst frame are stated with them (explanation/following-mesh).
"""

import functools

import numpy as np
import pytest

from hydro2d.deck import deck as decks
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
    )  # fmt: skip
    return Simulation(decks.loads(text, list(options)))


@functools.cache
def outcome(velocity: float, shift: float, *options: str) -> tuple[float, float, float]:
    """Depth in m, speed lost in m/s, and largest plastic strain of the rod, 25 us after the impact."""
    simulation = impact(velocity, shift, *options)
    simulation.run()
    bodies = simulation.of_bodies()["rod"]
    frame = velocity - 1000.0
    lost = 1000.0 - (bodies["velocity_m_s"] - frame)
    depth = bodies["z_max_m"] - frame * simulation.time - (1000.0 - lost) * (simulation.time - 25e-6)
    return depth, lost, simulation.diagnostics()["rod_max_plastic_strain"]


FOLLOWS = ('mesh.follow="rod"',)


@pytest.mark.thorough
@pytest.mark.parametrize(("velocity", "options"), [(1000.0, FOLLOWS), (0.0, ())], ids=["mesh follows", "plate moves"])
@pytest.mark.parametrize("shift", SHIFTS)
def test_a_rod_at_rest_in_its_mesh(velocity, options, shift):
    """Depth within 0.18 %, loss of speed within 1.4 %; the largest plastic strain, that of a cell, within 21 %."""
    depth, lost, strain = outcome(velocity, shift, *options)
    assert depth == pytest.approx(23.60e-3, rel=0.003)
    assert lost == pytest.approx(82.5, rel=0.02)
    assert strain == pytest.approx(0.050, rel=0.22)


@pytest.mark.thorough
@pytest.mark.parametrize("velocity", [1000.0, 500.0], ids=["rod moves", "both move"])
@pytest.mark.parametrize("shift", SHIFTS)
def test_a_rod_that_crosses_a_mesh(velocity, shift):
    """Wanted are 0.3 % of the depth and 2 % of the loss of speed; up to 0.7 and 5.1 % are missing."""
    depth, lost, strain = outcome(velocity, shift)
    assert depth == pytest.approx(23.60e-3, rel=0.01)
    assert lost == pytest.approx(82.5, rel=0.06)
    assert 0.04 < strain < 0.07


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
