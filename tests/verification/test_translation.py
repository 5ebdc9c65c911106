"""A body that flies through void does not change."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.decks import body, mesh, rod, stop, table

ROD = (
    mesh([{"to": "6 mm", "cells": 12}, {"cells": 4, "ratio": 1.1}], ("-13 mm", "32 mm", "0.5 mm"))
    + rod("3.3 mm", "10 mm", tip="-1.2 mm", velocity="1000 m/s")
    + stop("28 us")
)
BLOCK = (
    mesh(("12 mm", 24), ("24 mm", 48), geometry="planar")
    + table("boundaries", r_min="outflow")
    + body("block", "W_alloy", "polygon", points=[["2 mm", "3 mm"], ["5 mm", "1.5 mm"], ["6.2 mm", "7 mm"], ["3 mm", "6 mm"]],
           velocity=[250.0, 1000.0])
    + stop("14 us")
)
SLIP = 'sliding.method="slip-layer"', 'sliding.yield_factor="radius"'
#: density, bulk sound speed and modulus of the alloy
RHO, SOUND = 18160.0, 4030.0
MODULUS = RHO * SOUND**2


def flown(text: str, *options: str) -> Simulation:
    simulation = Simulation(deck.loads(text, options))
    while simulation.stop_reason() is None:
        simulation.step()
    return simulation


def unchanged(simulation: Simulation, u: float, v: float, strain: float) -> None:
    """Velocity and stress are unchanged, except for the effect of a change of volume by `strain`; every balance closes."""
    s = simulation.state
    present, massive = s.vof > 0, s.mass > 0
    assert np.abs(s.p[present.any(axis=0)]).max() < strain * MODULUS
    assert np.abs(s.q[2:5][:, present]).max() < strain * MODULUS
    assert np.abs(s.q[5:7]).max() == 0.0
    assert np.abs(s.v[massive] - v).max() < strain * SOUND
    assert np.abs(s.u[massive] - u).max() < strain * SOUND
    balance = simulation.conservation()
    assert max(abs(x) for x in balance["mass"].values()) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12
    assert abs(balance["total_energy"]) < 1e-12
    for name, sink in balance["sinks"].items():
        assert abs(sink["energy_J"]) < 1e-9 * balance["start_energy_J"], name


ROUND_OFF = "numerics.cutoff=1e-12", 1e-12  # stress below 0.3 Pa, drift below 4e-9 m/s in 1000 m/s
FULL_CELLS = "numerics.cutoff=1e-8", 1e-9  # cells that lack less than the cutoff are filled, and ring


@pytest.mark.parametrize("advection", ["ke", "momentum", "both"])
@pytest.mark.parametrize("options", [(), (*SLIP, 'sliding.hard=["rod"]')], ids=["sticking", "slip-layer"])
@pytest.mark.parametrize(("cutoff", "strain"), [ROUND_OFF, FULL_CELLS], ids=["tiny cutoff", "default cutoff"])
def test_rod_flies_over_three_lengths(advection, options, cutoff, strain):
    simulation = flown(ROD, cutoff, f'numerics.advection="{advection}"', *options)
    unchanged(simulation, 0.0, 1000.0, strain)


@pytest.mark.parametrize("advection", ["ke", "momentum", "both"])
@pytest.mark.parametrize("options", [(), (*SLIP, 'sliding.hard=["block"]', "sliding.yield_factor=1.5")],
                         ids=["sticking", "slip-layer"])
@pytest.mark.parametrize(("cutoff", "strain"), [ROUND_OFF, FULL_CELLS], ids=["tiny cutoff", "default cutoff"])
def test_block_flies_obliquely(advection, options, cutoff, strain):
    simulation = flown(BLOCK, cutoff, f'numerics.advection="{advection}"', *options)
    unchanged(simulation, 250.0, 1000.0, strain)


def test_rod_keeps_its_shape():
    """Nose and tail are in place."""
    mesh = 'mesh.r=[{to="6 mm",cells=12}]'
    simulation = flown(ROD, mesh)
    tip = simulation.time * 1000.0 - 1.2e-3
    goal = Simulation(deck.loads(ROD, [f"body.rod.tip={tip}", mesh]))
    differs = goal.grid.interior(np.abs(simulation.state.vof[0] - goal.state.vof[0]))
    assert differs[:, 0].sum() < 0.02  # the axis: positions of tip and tail, in cells
    volume = goal.grid.interior(goal.grid.volume)
    surface = 3.3e-3 * 6.7e-3 + 3.3e-3**2 + 0.5 * 3.3e-3**2  # flank, nose and tail, per radian
    assert np.sum(differs * volume) < 0.15 * 0.5e-3 * surface  # in cells over the surface: it is 0.08, with lines alone 0.34
