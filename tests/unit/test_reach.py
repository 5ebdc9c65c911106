"""What energy a body can reach: against Hugoniots and isentropes in closed form, and gases beside metals held to it."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.errors import UnphysicalState
from hydro2d.running.run import exit_status, run
from hydro2d.solver.simulation import Simulation

SHOT = """
[mesh]
geometry = "planar"
r = [{ to = "1 mm", cells = 4 }]
z_start = "-4 mm"
z = [{ to = "8 mm", size = "0.25 mm" }]
[boundaries]
r_max = "wall"
[[body]]
name = "flyer"
shape = "box"
z = ["-3.9 mm", "-0.9 mm"]
material = "Al5083"
velocity = "1 km/s"
[[body]]
name = "plate"
shape = "plate"
z_front = "0.1 mm"
thickness = "6 mm"
material = "Al5083"
[[body]]
name = "air"
shape = "box"
z = ["-0.9 mm", "0.1 mm"]
pressure = "0.1 MPa"
material = "air"
[materials.air]
eos = { model = "ideal-gas", adiabatic_index = 1.4, reference_density = "1.2 kg/m^3" }
[stop]
time = "3 us"
"""


def reach(*options):
    return Simulation(decks.loads(SHOT, options))._reach


def test_a_gas_is_shocked_and_then_compressed_along_its_isentrope():
    """The shock that stops an ideal gas, U = (g + 1)/4 v + sqrt(((g + 1)/4 v)^2 + c^2), then e ~ p^((g - 1)/g)."""
    found, gamma, rho, p0 = reach(), 1.4, 1.2, 1e5
    v, c2 = found.speed, gamma * p0 / rho
    assert v == pytest.approx(1000.0, rel=0.01)
    shock = (gamma + 1) / 4 * v + np.sqrt(((gamma + 1) / 4 * v) ** 2 + c2)
    p = p0 + rho * shock * v
    e = p0 / rho / (gamma - 1) + 0.5 * v**2 + p0 * v / (rho * shock)
    assert found.highest[2] == pytest.approx(e * (found.pressure / p) ** ((gamma - 1) / gamma), rel=5e-3)
    assert found.lowest[2] == pytest.approx(0.0, abs=1e-6)
    assert found.gas.tolist() == [False, False, True]


def test_a_solid_stops_on_its_hugoniot():
    """p = rho0 (c0 + s v) v and e = v^2/2, with the constants of 5083 in the library."""
    found = reach()
    v = found.speed
    assert found.pressure == pytest.approx(2670.0 * (5340.0 + 1.34 * v) * v, rel=0.02)
    assert found.highest[0] == pytest.approx(0.5 * v**2, rel=1e-6)
    assert -4e5 < found.lowest[0] < -2e5  # the heat that it has at room temperature


@pytest.mark.parametrize(("option", "speed"), [
    ("body.flyer.velocity=[0.0, 0.0]", 0.0), ("body.plate.velocity=[0.0, -500.0]", 1500.0),
    ('body.flyer.flow={ pattern = "spherical", speed = -300.0 }', 2600.0)])
def test_the_closing_speed_is_that_of_the_deck(option, speed):
    assert reach(option).speed == pytest.approx(speed, abs=5.0)


def test_where_two_bodies_meet_the_softer_one_sets_the_pressure():
    tungsten = ["body.flyer.material=W_alloy", "boundaries.r_max=outflow", "boundaries.r_min=outflow"]
    assert reach(*tungsten).pressure == pytest.approx(reach().pressure, rel=5e-3)
    assert reach(*tungsten, "boundaries.z_max=wall").pressure > 4.0 * reach().pressure


@pytest.mark.parametrize("body", [0, 2])
def test_a_body_beyond_its_reach_is_a_fault(body):
    """Far too little to show in the energy of the shot."""
    simulation = Simulation(decks.loads(SHOT))
    s, found = simulation.state, simulation._reach
    assert simulation.faults() == []
    for energy in (3.0 * found.highest[body], 2.5 * found.lowest[body] - 0.1 * found.highest[body]):
        kept = s.e[body].copy()
        s.e[body][s.vof[body] > 0] = energy
        assert any(f'body "{simulation.table.names[body]}" has ' in fault for fault in simulation.faults())
        s.e[body] = kept


def test_a_gas_that_is_too_hot_in_one_cell_is_a_fault():
    """In a cell that it fills by a hundredth; a solid may be hotter in a cell, where it is sheared."""
    simulation = Simulation(decks.loads(SHOT))
    s, highest = simulation.state, simulation._reach.highest
    j, i = np.argwhere(s.vof[2] == 1.0)[5]
    s.e[2, j, i] = 3.0 * highest[2]
    (fault,) = (fault for fault in simulation.faults() if "add up" not in fault)
    assert fault.startswith('the gas "air" has ')
    assert fault.endswith("not computed well enough")
    s.e[2, j, i] = -0.1 * highest[2]
    assert any('the gas "air"' in fault for fault in simulation.faults())
    s.e[2, j, i], s.e[0, 10, 3] = 2e5, 3.0 * highest[0]
    assert not any("gas" in fault or "as a whole" in fault for fault in simulation.faults())


def test_a_film_of_air_that_is_crushed_is_not_called_done(tmp_path):
    """Once 2.3e8 J/kg, 320 000 K, and trusted: the heat of the viscosity and the pressure of the metal went into the air."""
    summary = run(decks.loads(SHOT), tmp_path / "run", quiet=True)
    assert exit_status(summary) == 3
    assert not summary["trustworthy"]
    assert 'body "air" has ' in summary["stop_reason"]
    assert "Leave the space empty" in summary["stop_reason"]


def test_a_gas_beside_a_moving_metal_has_the_heat_of_its_shock():
    """Air before a flyer at 1 km/s, not yet crushed: some 7e5 J/kg behind the shock, where metal and air share cells."""
    simulation = Simulation(decks.loads(SHOT))
    while simulation.time < 0.45e-6:
        simulation.step()
    s = simulation.state
    mixed = (s.vof[2] > 0.01) & (s.vof[0] > 0.01)
    assert mixed.any()
    assert 3e5 < s.e[2][mixed].max() < 1.5e6
    assert simulation.faults() == []


def test_refusing_a_gas_may_be_put_off_but_not_trusted():
    simulation = Simulation(decks.loads(SHOT, ["numerics.clip_limit=0.5"]))
    with pytest.raises(UnphysicalState):
        Simulation(decks.loads(SHOT)).run()
    simulation.run("1.5 us")
    assert simulation.faults()
