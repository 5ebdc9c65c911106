"""Measurements of a shot do not depend on the frame: all bodies faster by V, roles exchanged, a mesh that follows."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.decks import body, entry, mesh, plate, rod, stop, table

#: keys of velocities in the mesh's frame, which change by V; keys of energies, which follow no such rule
VELOCITIES = ("interface_velocity_m_s", "rod_mean_velocity_m_s", "rod_core_velocity_m_s", "rod_nose_velocity_m_s",
              "rod_tail_velocity_m_s", "rod_residual_velocity_m_s", "exit_velocity_m_s", "ejected_velocity_m_s")
ENERGIES = ("rod_initial_kinetic_energy_J", "rod_kinetic_energy_J")


def shot(projectile: float, target: float, *, thickness: str = "20 mm", ball: bool = False, follow: bool = False) -> Simulation:
    """A rod of 20 mm, or a ball, and a plate, with axial velocities in m/s, on a mesh large enough for either."""
    following = {"follow": "rod"} if follow else {}
    flying = {"velocity": f"{projectile} m/s"}
    first = (body("rod", "W_alloy", "sphere", centre="-3 mm", radius="3 mm", **flying) if ball
             else rod("3 mm", "20 mm", nose="flat", tip=0.0, **flying))
    return Simulation(deck.loads(
        mesh(("12 mm", 12), ("-60 mm", "60 mm", "1 mm"), **following) + first + plate(thickness, velocity=f"{target} m/s")
        + table("penetration", rod="rod", target="plate") + entry("tracer", name="a", r="1 mm", z="5 mm") + stop("14 us")))


def outputs(sim: Simulation) -> dict[str, float | None]:
    """Numbers of the summary about the rod and the hole."""
    numbers = sim.diagnostics() | {f"hole {key}": value for key, value in sim.of_targets()["plate"].crater}
    numbers |= {f"debris {key}": value for key, value in sim.of_targets()["plate"].debris}
    return {key: value for key, value in numbers.items() if isinstance(value, (int, float)) or value is None}


def state_of(sim: Simulation, other: Simulation, by: float) -> None:
    """Gives a simulation at its start the state of another one, with velocities increased by so much."""
    s, o = sim.state, other.state
    for name in ("vof", "q", "centroid"):
        getattr(s, name)[...] = getattr(o, name)
    s.u[...], s.v[...] = o.u, o.v + by


@pytest.mark.parametrize("ball", [False, True], ids=["rod", "ball"])
@pytest.mark.parametrize("by", [-1000.0, 300.0, 2500.0])
def test_the_same_state_measured_in_another_frame(by, ball):
    """Measurements of one state, once as it is and once with V added, at the place to which V takes the target."""
    at_rest, moving = shot(900.0, 0.0, ball=ball), shot(900.0 + by, by, ball=ball)
    while at_rest.time < 4e-6:
        at_rest.step()
    way = round(by * at_rest.time / 1e-3)  # whole cells, so that only the place of the state changes
    moving.engine.time = way * 1e-3 / by
    state_of(moving, at_rest, by)
    for array in (moving.state.vof, moving.state.q, moving.state.centroid, moving.state.u, moving.state.v):
        array[...] = np.roll(array, way, axis=-2)
    one, other = outputs(at_rest), outputs(moving)
    assert one["penetration_depth_m"] > 1.5e-3
    for key, value in one.items():
        name = key.removeprefix("hole ")
        if name in ENERGIES:
            continue
        if value is None:
            assert other[key] is None, key
            continue
        expected = value + by if name in VELOCITIES else value
        assert other[key] == pytest.approx(expected, rel=1e-6, abs=1e-9 if name not in VELOCITIES else 1e-6), key
    assert moving.diagnostics()["regime"] == at_rest.diagnostics()["regime"]


@pytest.fixture(scope="module")
def standing():
    """A plate at rest, after 14 us."""
    sim = shot(1000.0, 0.0)
    sim.run()
    return outputs(sim)


@pytest.mark.parametrize("projectile", [500.0, 0.0, -400.0])
def test_roles_are_exchanged(standing, projectile):
    """Within 3 % of the results with the plate at rest: bodies cross the mesh in another way."""
    sim = shot(projectile, projectile - 1000.0)
    sim.run()
    numbers = outputs(sim)
    for key in ("penetration_depth_m", "rod_length_m", "hole depth_m", "hole volume_per_energy_m3_J"):
        assert numbers[key] == pytest.approx(standing[key], rel=0.03), key
    assert numbers["rod_core_velocity_m_s"] == pytest.approx(standing["rod_core_velocity_m_s"] + projectile - 1000.0, abs=20.0)
    assert not sim.penetrator.perforates()


@pytest.mark.parametrize("projectile", [500.0, 1000.0, 1800.0])
def test_a_mesh_that_follows_the_rod_measures_the_same(standing, projectile):
    """On a plate at rest, on one that moves towards the rod, and on one that flies ahead of it."""
    sim = shot(projectile, projectile - 1000.0, follow=True)
    sim.run()
    numbers = outputs(sim)
    for key in ("penetration_depth_m", "rod_length_m", "hole depth_m", "hole volume_per_energy_m3_J"):
        assert numbers[key] == pytest.approx(standing[key], rel=0.03), key
    assert numbers["rod_core_velocity_m_s"] == pytest.approx(standing["rod_core_velocity_m_s"] + projectile - 1000.0, abs=20.0)


@pytest.mark.parametrize("projectile", [1500.0, 0.0])
def test_a_thin_plate_is_perforated_by_whoever_moves(projectile):
    sim = shot(projectile, projectile - 1500.0, thickness="4 mm")
    sim.run()
    assert sim.penetrator.passages()[0]["exit_time_s"] == pytest.approx(6.5e-6, rel=0.15)
    assert outputs(sim)["debris velocity_m_s"] == pytest.approx(1300.0, rel=0.1)


def test_a_shot_in_which_only_the_plate_flies_is_not_over_at_once():
    sim = shot(0.0, -1000.0)
    assert not sim.penetrator.perforates()
    assert sim.penetrator.nose() == 0.0


def test_plates_that_catch_a_ball_up_are_its_targets_in_the_order_in_which_they_come():
    loaded = deck.loads(
        mesh(("12 mm", 12), ("-60 mm", "60 mm", "1 mm"))
        + body("ball", "W_alloy", "sphere", centre="30 mm", radius="3 mm", velocity="100 m/s")
        + plate("4 mm", name="second", z_front="0 mm", velocity="1000 m/s")
        + plate("4 mm", name="first", z_front="12 mm", velocity="1000 m/s")
        + stop("14 us"))
    assert loaded.penetration.targets == ("first", "second")
