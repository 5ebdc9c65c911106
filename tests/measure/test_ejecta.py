"""Ejecta in front of a target: of pieces whose mass and velocity are known, and of a shot whose momentum adds up."""

import math

import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.decks import box, entry, mesh, plate, stop, table
from tests.restarts import restarted

#: a ball before a plate, a chip of the plate that flies back, and one that flies on; all along +z
TEXT = (
    mesh(("20 mm", 40), ("-20 mm", "20 mm", 80))
    + entry("body", name="ball", material="W_alloy", shape="sphere", centre="-6.3 mm", radius="5 mm", velocity="800 m/s")
    + plate("15 mm")
    + box("chip", "Al5083", join="plate", r=["12 mm", "14 mm"], z=["-8 mm", "-7 mm"], velocity="-300 m/s")
    + box("other", "Al5083", join="plate", r=["12 mm", "14 mm"], z=["-12 mm", "-11 mm"], velocity="100 m/s")
    + stop("10 us")
)
#: the same along -z
BACK = ['body.ball.centre="6.3 mm"', 'body.ball.velocity="-800 m/s"', 'body.plate.z_front="-15 mm"',
        'body.chip.z=["7 mm", "8 mm"]', 'body.chip.velocity="300 m/s"', 'body.other.z=["11 mm", "12 mm"]',
        'body.other.velocity="-100 m/s"']
CHIP = 2660.0 * math.pi * (0.014**2 - 0.012**2) * 0.001


@pytest.mark.parametrize("options", [[], BACK], ids=["to +z", "to -z"])
def test_what_flies_back(options):
    """The chip counts; the ball that still comes, the chip that flies on and the plate do not."""
    ejecta = Simulation(decks.loads(TEXT, options)).of_targets()["plate"]["ejecta"]
    assert dict(ejecta) == {"mass_kg": pytest.approx(CHIP, rel=1e-9), "momentum_N_s": pytest.approx(300.0 * CHIP, rel=1e-9),
                      "velocity_m_s": pytest.approx(300.0, rel=1e-9), "momentum_multiplication": None}


def test_velocities_are_relative_to_a_target_that_flies():
    """Everything 500 m/s faster: the same ejecta."""
    faster = ['body.ball.velocity="1300 m/s"', 'body.plate.velocity="500 m/s"', 'body.chip.velocity="200 m/s"',
              'body.other.velocity="600 m/s"']
    ejecta = Simulation(decks.loads(TEXT, faster)).ejecta()
    assert (ejecta["mass_kg"], ejecta["momentum_N_s"]) == (pytest.approx(CHIP), pytest.approx(300.0 * CHIP))


@pytest.mark.parametrize("options", [[], BACK], ids=["to +z", "to -z"])
def test_a_ball_that_rebounds_gives_its_momentum_twice(options):
    sim = Simulation(decks.loads(TEXT, [*options, "body.chip=", "body.other="]))
    assert dict(sim.ejecta()) == {"mass_kg": 0.0, "momentum_N_s": 0.0, "velocity_m_s": None, "momentum_multiplication": None}
    sim.penetrator._deepest = 1e-3
    assert sim.ejecta()["momentum_multiplication"] == 1.0
    sim.state.v *= -1.0
    back = sim.ejecta()
    assert back["mass_kg"] == pytest.approx(sim.penetrator.mass, rel=1e-12)
    assert back["momentum_multiplication"] == pytest.approx(2.0, rel=1e-6)


@pytest.mark.parametrize("options", [[], BACK], ids=["to +z", "to -z"])
def test_a_ball_that_rebounds_without_a_dent_has_struck(options):
    """Its nose was never seen below the face, and the multiplication stayed null."""
    sim = Simulation(decks.loads(TEXT, [*options, "body.chip=", "body.other="]))
    sim.state.v *= 0.6
    assert sim.ejecta()["momentum_multiplication"] is None
    sim.state.v *= -0.5
    assert sim.ejecta()["momentum_multiplication"] == pytest.approx(1.3, rel=1e-6)


def test_no_multiplication_without_all_of_the_momentum():
    """With debris behind the target that has a hundredth of the projectile's momentum, or a hole."""
    sim = Simulation(decks.loads(TEXT))
    sim.penetrator._deepest = 1e-3
    known = sim.ejecta()["momentum_multiplication"]
    assert known == pytest.approx(1.0 + 300.0 * CHIP / (800.0 * sim.penetrator.mass), rel=1e-4)
    sim.grid.interior(sim.state.vof)[1, 40:, :4] = 0.0
    assert sim.ejecta()["momentum_multiplication"] is None
    piece = box("piece", "W_alloy", r=["5 mm", "8 mm"], z=["16 mm", "18 mm"], velocity="100 m/s")
    sim = Simulation(decks.loads(TEXT + piece))
    sim.penetrator._deepest = 1e-3
    assert sim.ejecta()["momentum_multiplication"] is None


@pytest.mark.parametrize("options", [[], BACK], ids=["to +z", "to -z"])
@pytest.mark.parametrize("velocity", [(0, -3000), (3000, -300)], ids=["axially", "radially"])
def test_what_has_left_the_mesh_counts(options, velocity):
    """The chip leaves through the edge before the plate, or through the one in r; half of the way by a continued run."""
    radial, axial = velocity
    sign = -1 if options else 1
    flight = [f'body.chip.velocity=["{radial} m/s", "{sign * axial} m/s"]', f'body.ball.velocity="{sign} m/s"', "body.other="]
    sim = Simulation(decks.loads(TEXT, [*options, *flight]))
    sim.run(until=lambda sim: sim.audit.sinks["outflow"].mass[1] > 0.3 * CHIP / (2.0 * math.pi))
    sim = restarted(sim)
    sim.run(until=8e-6)
    assert sim.audit.sinks["outflow"].mass[1] * 2.0 * math.pi == pytest.approx(CHIP, rel=1e-3)
    ejecta = sim.ejecta()
    assert ejecta["mass_kg"] == pytest.approx(CHIP, rel=1e-3)
    assert ejecta["momentum_N_s"] == pytest.approx(-axial * CHIP, rel=5e-3)


def test_a_formula_may_use_them():
    sim = Simulation(decks.loads(TEXT + '[derived]\nback_m_s = "ejecta_momentum_N_s / ejecta_mass_kg"\n'))
    sim.run(until=0.0)
    assert sim.history["back_m_s"][0] == pytest.approx(300.0)


@pytest.mark.thorough
def test_the_momentum_of_a_shot_adds_up():
    """What the target and the rest of the projectile have is the momentum of the projectile times the multiplication."""
    text = (
        mesh(("12 mm", 48), ("-16 mm", "12 mm", 112))
        + entry("body", name="ball", material="Al6061_T6", shape="sphere", centre="-1 mm", radius="1 mm", velocity="4 km/s")
        + plate("12 mm", material="Al6061_T6:spall")
        + table("failure", tensile="material")
        + stop("2.5 us")
    )
    sim = Simulation(decks.loads(text))
    sim.run()
    found = sim.of_targets()["plate"]["ejecta"]
    start, total = sim.penetrator.impact_momentum, sum(body["momentum_N_s"] for body in sim.of_bodies().values())
    assert found["mass_kg"] > sim.penetrator.mass
    assert found["momentum_multiplication"] > 1.05
    assert (total + found["momentum_N_s"]) / start == pytest.approx(found["momentum_multiplication"], rel=2e-3)
