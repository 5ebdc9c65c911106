"""What is measured of a rod: lengths to a cell's share, and the regime by its stated rules."""

import numpy as np
import pytest

from hydro2d import deck
from hydro2d.simulation import Simulation

TEXT = """
[mesh]
r = [{ to = "12 mm", cells = 24 }]
z_start = "-25 mm"
z = [{ to = "25 mm", cells = 100 }]
[[body]]
name = "rod"
material = "W_alloy"
shape = "rod"
nose = "flat"
radius = "3 mm"
length = "20.2 mm"
tip = "TIP mm"
velocity = "1 km/s"
[[body]]
name = "plate"
material = "Al5083"
shape = "plate"
z_front = 0.0
thickness = "24 mm"
[stop]
time = "1 us"
"""


@pytest.fixture
def simulation():
    return Simulation(deck.loads(TEXT.replace("TIP", "-0.3")))


def cells(simulation):
    """The rod's volume fractions, without ghosts, and the heights of the cells' centres."""
    return simulation.grid.interior(simulation.state.vof)[0], simulation.grid.zc[simulation.grid.inside[0]]


def test_a_rod_before_impact(simulation):
    found = simulation.diagnostics()
    assert found["rod_length_m"] == pytest.approx(20.2e-3, rel=1e-9)
    assert found["penetration_depth_m"] == 0.0
    assert found["rod_mass_kg"] == pytest.approx(np.pi * 3e-3**2 * 20.2e-3 * 18160, rel=1e-9)
    ends = 0.2e-3 / 20.2e-3  # the row at the tip is filled by less than half and no part of the core
    assert found["rod_core_mass_kg"] == pytest.approx(found["rod_mass_kg"] * (1 - ends), rel=1e-9)
    assert found["rod_max_radius_m"] == pytest.approx(3e-3, rel=1e-9)
    assert found["rod_mean_velocity_m_s"] == pytest.approx(1000.0, rel=2e-3)  # its tip shares a cell with the plate
    assert found["rod_tail_velocity_m_s"] == pytest.approx(1000.0, rel=1e-9)
    assert found["regime"] == "rigid"


def test_depth_counts_the_share_of_the_last_cell(simulation):
    fraction, z = cells(simulation)
    new = (z > 0) & (z < 4e-3)
    fraction[np.ix_(new, np.arange(24) < 6)] = 1.0  # 0.1 mm of the cell below z = 0 are missing: filled
    fraction[(z > -0.5e-3) & (z < 0), :6] = 1.0
    fraction[(z > 4e-3) & (z < 4.5e-3), :6] = 0.25
    assert simulation.diagnostics()["penetration_depth_m"] == pytest.approx(4.125e-3, rel=1e-9)


def test_fragments_behind_the_tail_do_not_count(simulation):
    fraction, z = cells(simulation)
    fraction[(z > -23.5e-3) & (z < -22.9e-3), :4] = 1.0
    assert simulation.diagnostics()["rod_length_m"] == pytest.approx(20.2e-3, rel=1e-9)


def test_regimes(simulation):
    fraction, z = cells(simulation)
    fraction[z < -19.9e-3] = 0.0  # 0.6 mm of the tail are gone: 3 % of length and mass
    assert simulation.diagnostics()["regime"] == "deforming"
    skirt = (z > -15e-3) & (z < -9e-3)
    fraction[np.ix_(skirt, np.arange(24) == 5)] = 0.0  # a gap, and outside of it what was turned back
    fraction[np.ix_(skirt, np.arange(24) == 7)] = 1.0
    found = simulation.diagnostics()
    assert found["rod_core_mass_kg"] < 0.9 * found["rod_mass_kg"]
    assert found["regime"] == "eroding"


def test_what_has_failed_is_debris(simulation):
    """The nose fails over 4 mm: it still counts for the depth and is mass of the rod, not of its core nor its length."""
    before = simulation.diagnostics()
    _, z = cells(simulation)
    damage = simulation.grid.interior(simulation.state.dmg)
    damage[0][z > -4e-3] = 1.0
    found = simulation.diagnostics()
    assert found["rod_length_m"] == pytest.approx(16.5e-3, rel=1e-9)
    assert found["penetration_depth_m"] == before["penetration_depth_m"]
    assert found["rod_failed_mass_kg"] == pytest.approx(np.pi * 3e-3**2 * 3.7e-3 * 18160, rel=1e-9)
    assert found["rod_core_mass_kg"] < found["rod_mass_kg"] - found["rod_failed_mass_kg"] + 1e-12
    assert (found["target_failed_mass_kg"], found["regime"]) == (0.0, "eroding")


def test_what_flies_back_does_not_stop_the_run(simulation):
    """Half of the mass is torn off and flies back as fast as the core goes on: the mean is at rest, the core is not."""
    fraction, z = cells(simulation)
    fraction[(z > -11e-3) & (z < -10e-3)] = 0.0
    v = simulation.grid.interior_vertices(simulation.state.v)[0]
    v[:] = np.where(simulation.grid.z_edges < -10.4e-3, -1000.0, 1000.0)[:, None]
    found = simulation.diagnostics()
    assert abs(found["rod_mean_velocity_m_s"]) < 100.0
    assert found["rod_core_velocity_m_s"] == pytest.approx(1000.0, rel=1e-12)
    assert simulation.penetrator.velocity() == found["rod_core_velocity_m_s"]
    simulation.penetrator._intact = lambda rows, columns=slice(None): 0.0 * fraction[rows, columns]
    assert simulation.penetrator.velocity() == pytest.approx(found["rod_mean_velocity_m_s"])
