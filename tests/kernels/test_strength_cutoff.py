"""Material that heat has expanded beyond `failure.strength_cutoff` is no solid any more."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation

TEXT = """
[mesh]
geometry = "planar"
r = [{ to = "10 mm", cells = 10 }]
z = [{ to = "10 mm", cells = 10 }]
[boundaries]
r_min = "wall"
r_max = "wall"
z_min = "wall"
z_max = "wall"
[[body]]
name = "block"
material = "Al5083"
shape = "box"
r = [0.0, "10 mm"]
z = [0.0, "10 mm"]
density = "DENSITY kg/m^3"
pressure = "0 Pa"
[failure]
strength_cutoff = CUTOFF
[stop]
time = "1 us"
"""


@pytest.mark.parametrize(("density", "cutoff", "solid"), [(2600, 0.94, True), (2450, 0.94, False), (2450, 0.0, True)])
def test_shear_ends_at_the_cutoff(density, cutoff, solid):
    simulation = Simulation(deck.loads(TEXT.replace("DENSITY", str(density)).replace("CUTOFF", str(cutoff))))
    simulation.state.v[0] += 10.0 * simulation.grid.r / 10e-3  # a shear flow
    simulation.state.v[0, 2], simulation.state.v[0, 12] = 0.0, 0.0
    simulation.step()
    stress = np.abs(simulation.grid.interior(simulation.state.srz)).max()
    assert (stress > 1e3) == solid
    assert solid or stress == 0.0
