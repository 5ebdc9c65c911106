"""Material that heat has expanded beyond `failure.strength_cutoff` is no longer solid."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.decks import box, mesh, stop, table, walls


@pytest.mark.parametrize(("density", "cutoff", "solid"), [(2600, 0.94, True), (2450, 0.94, False), (2450, 0.0, True)])
def test_shear_ends_at_the_cutoff(density, cutoff, solid):
    simulation = Simulation(deck.loads(
        mesh(("10 mm", 10), ("10 mm", 10), geometry="planar")
        + walls("r_min", "r_max", "z_min", "z_max")
        + box("block", "Al5083", r=[0.0, "10 mm"], z=[0.0, "10 mm"], density=f"{density} kg/m^3", pressure="0 Pa")
        + table("failure", strength_cutoff=cutoff)
        + stop("1 us")
    ))
    simulation.state.v[0] += 10.0 * simulation.grid.r / 10e-3  # a shear flow
    simulation.state.v[0, 2], simulation.state.v[0, 12] = 0.0, 0.0
    simulation.step()
    stress = np.abs(simulation.grid.interior(simulation.state.srz)).max()
    assert (stress > 1e3) == solid
    assert solid or stress == 0.0
