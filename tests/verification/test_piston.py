"""A piston: with a constant table it equals an edge with a velocity, and a ramp sends out the isentrope of a simple wave."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.verification.running import Line, advection

GAS = """
numbers = "SI"
[mesh]
geometry = "planar"
r = [{ to = 0.04, cells = 4 }]
z = [{ to = 1.0, cells = 100 }]
[boundaries]
r_max = "wall"
z_max = "wall"
z_min = "piston"
z_min_piston = [[0.0, 0.2], [1.0, 0.2]]
[[body]]
name = "gas"
material = "gas"
shape = "plate"
z_front = 0.0
thickness = 1.0
pressure = 1.0
[materials.gas.eos]
model = "ideal-gas"
reference_density = 1.0
adiabatic_index = 1.4
[stop]
time = 0.5
"""


def test_a_constant_table_is_a_constant_velocity_to_the_last_bit():
    piston = Simulation(decks.loads(GAS))
    constant = ['boundaries={r_max="wall", z_max="wall", z_min="velocity", z_min_velocity=0.2}']
    edge = Simulation(decks.loads(GAS, constant))
    for _ in range(150):
        piston.step()
        edge.step()
    np.testing.assert_array_equal(piston.grid.interior(piston.state.q), edge.grid.interior(edge.state.q))
    np.testing.assert_array_equal(piston.state.v, edge.state.v)
    own, other = piston.audit.sinks["piston"], edge.audit.sinks["walls"]
    assert own.energy == other.energy != 0.0
    assert own.momentum + piston.audit.sinks["walls"].momentum == pytest.approx(other.momentum, rel=1e-12)


@pytest.mark.parametrize("edge", ["z_min", "z_max"])
def test_a_simple_wave(edge):
    """Gas set in motion by a slow ramp of velocity has u = 2 (c - c0)/(gamma - 1), on the way out; energy closes."""
    sign = 1.0 if edge == "z_min" else -1.0
    other = {"z_min": "z_max", "z_max": "z_min"}[edge]
    ramp = f'boundaries={{r_max="wall", {other}="wall", {edge}="piston", {edge}_piston=[[0.0, 0.0], [0.4, {0.2 * sign}]]}}'
    simulation = Simulation(decks.loads(GAS, [ramp, advection("both")]))
    while simulation.time < 0.4:
        simulation.step()
    line = Line(simulation)
    velocity = 0.5 * (line.velocity[1:] + line.velocity[:-1])
    sound = np.sqrt(1.4 * 0.4 * line.body("e", 0))
    moves = (np.abs(velocity) > 0.02) & (np.abs(velocity) < 0.18)
    assert moves.sum() > 20
    np.testing.assert_allclose(sign * velocity[moves], 5.0 * (sound[moves] - np.sqrt(1.4)), atol=2e-3)
    balance = simulation.conservation()
    assert abs(balance["total_energy"]) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12
    assert balance["sinks"]["piston"]["energy_J"] < 0.0
