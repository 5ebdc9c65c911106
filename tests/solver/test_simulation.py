"""Values that a simulation reports after a cycle, compared with numpy."""

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.measure.audit import totals
from hydro2d.running.team import at_most
from hydro2d.solver.simulation import WATCH_EVERY, Simulation
from tests.decks import box, entry, mesh, plate, rod, stop
from tests.restarts import restarted

TEXT = (
    mesh(("9 mm", 18), ("-12 mm", "12 mm", 48))
    + rod("3 mm", "10 mm", tip="-0.1 mm", velocity="60 m/s")
    + plate("10 mm")
    + entry("tracer", name="nose", r="1 mm", z="-1 mm")
    + stop("50 us", speed_below="55 m/s")
)


@pytest.fixture(scope="module")
def moving():
    simulation = Simulation(deck.loads(TEXT))
    for _ in range(30):
        simulation.step()
    return simulation


def test_totals(moving):
    state, grid = moving.state, moving.grid
    mass = grid.interior(state.vof * state.rho * grid.volume)
    vertex_mass, u, v = (grid.interior_vertices(field) for field in (state.mass, state.u, state.v))
    sums = totals(state)
    np.testing.assert_allclose(sums.mass, mass.sum(axis=(1, 2)), rtol=1e-13)
    assert sums.internal == pytest.approx(np.sum(mass * grid.interior(state.e)), rel=1e-12)
    assert sums.momentum == pytest.approx(np.sum(vertex_mass * v), rel=1e-12)
    assert sums.kinetic == pytest.approx(0.5 * np.sum(vertex_mass * (u**2 + v**2)), rel=1e-12)


@pytest.mark.parametrize("m", [0, 1])
def test_mean_velocity(moving, m):
    grid, state = moving.grid, moving.state
    v = grid.interior_vertices(state.v[0])
    inner, outer = (share[grid.inside[1]] for share in (grid.cm_in, grid.cm_out))
    mean = inner * (v[:-1, :-1] + v[1:, :-1]) + outer * (v[:-1, 1:] + v[1:, 1:])
    mass = grid.interior(state.vof[m] * state.rho[m] * grid.volume)
    assert moving.mean_velocity(m) == pytest.approx(np.sum(mass * mean) / np.sum(mass), rel=1e-12)
    np.testing.assert_allclose(moving.body_sums(m)[0], mass.sum(axis=1), rtol=1e-13, atol=1e-300)


def test_velocity_at_points(moving):
    """Linear fields are found exactly, and points outside the mesh have the velocity of its edge."""
    grid, state = moving.grid, moving.state
    z, r = np.meshgrid(grid.z, grid.r, indexing="ij")
    kept = state.u.copy(), state.v.copy()
    state.u[0], state.v[0] = 3.0 * r, 1.0 + 2.0 * z
    points = np.array([[0.0, 0.0], [1.23e-3, -4.56e-3], [9e-3, 12e-3], [20e-3, 50e-3]])
    inside = np.minimum(points, [9e-3, 12e-3])
    expected = np.column_stack([3.0 * inside[:, 0], 1.0 + 2.0 * inside[:, 1]])
    np.testing.assert_allclose(moving.velocity_at(points), expected, rtol=1e-12, atol=1e-15)
    state.u[...], state.v[...] = kept


def test_tracers_take_the_midpoint_rule(moving):
    start = moving.stations.tracers.copy()
    half = start + 0.5 * moving.dt * moving.velocity_at(start)
    expected = start + moving.dt * moving.velocity_at(half)
    moving.stations.record(moving.engine.given)
    np.testing.assert_array_equal(moving.stations.tracers, expected)


def test_a_run_stops_at_the_same_cycle_after_a_restart():
    def run_on(simulation):
        while (reason := simulation.stop_reason()) is None:
            simulation.step()
        return simulation.cycle, reason

    whole = Simulation(deck.loads(TEXT))
    expected = run_on(whole)
    assert expected[1].startswith("speed of rod below")
    assert expected[0] > WATCH_EVERY
    assert expected[0] % WATCH_EVERY == 0
    for at in (7, WATCH_EVERY, expected[0] - 1):
        first = Simulation(deck.loads(TEXT))
        while first.cycle < at:
            first.stop_reason()
            first.step()
        assert run_on(restarted(first)) == expected


def test_a_rod_that_perforates_ends_the_run():
    """At 2 km/s the rod passes 3 mm of aluminium, and its radius further, before the run's 50 us."""
    text = TEXT.replace('"10 mm"\n[[tracer]]', '"3 mm"\n[[tracer]]').replace("60 m/s", "2 km/s")
    simulation = Simulation(deck.loads(text, ["stop.perforation=true"]))
    while (reason := simulation.stop_reason()) is None:
        simulation.step()
    assert reason == "perforation of plate"
    between_looks = WATCH_EVERY * simulation.dt * 2000.0
    assert 6e-3 <= simulation.diagnostics()["penetration_depth_m"] < 6e-3 + between_looks


TWO = (
    mesh(("4 mm", 8), ("-12 mm", "12 mm", 48))
    + box("first", "Al5083", r=[0.0, "2 mm"], z=["-8 mm", "-2 mm"], velocity="300 m/s")
    + box("second", "Al5083", r=[0.0, "2 mm"], z=["-1 mm", "3 mm"])
)


def until_it_ends(simulation: Simulation) -> tuple[str, int]:
    while not (reason := simulation.stop_reason()):
        simulation.step()
    return reason, simulation.cycle


def test_a_run_waits_until_a_body_at_rest_has_moved():
    """It is hit after 3.3 us; from then on it keeps its velocity."""
    simulation = Simulation(deck.loads(TWO + stop("20 us", body="second", speed_below="5 m/s")))
    assert until_it_ends(simulation)[0] == "end time"
    assert simulation.mean_velocity(1) > 100.0
    simulation = Simulation(deck.loads(TWO + stop("40 us", body="first", speed_below="200 m/s")))
    reason, cycle = until_it_ends(simulation)
    assert reason == "speed of first below 200 m/s"
    assert cycle > 0


def test_a_body_that_is_pushed_from_rest_does_not_rebound_by_that():
    text = TWO.replace("300 m/s", "-300 m/s").replace("-8 mm", "4 mm").replace("-2 mm", "10 mm")
    simulation = Simulation(deck.loads(text + stop("15 us", body="second", rebound=True)))
    assert until_it_ends(simulation)[0] == "end time"
    assert simulation.mean_velocity(1) < -100.0


def test_a_run_that_goes_on_with_another_body_takes_its_direction():
    toward = TWO.replace('z = ["-1 mm", "3 mm"]', 'z = ["-1 mm", "3 mm"]\nvelocity = "-300 m/s"')
    first = Simulation(deck.loads(toward + stop("20 us", body="first", rebound=True)))
    while first.cycle < 10:
        assert first.stop_reason() is None
        first.step()
    kept = first.restart_scalars(), first.restart_arrays()
    for body in ("first", "second"):
        again = Simulation(deck.loads(toward + stop("20 us", body=body, rebound=True)))
        again.load_restart_arrays(kept[1])
        again.load_restart_scalars(kept[0])
        assert again.stop_reason() is None
        assert again.restart_scalars()["stops"]["Rebound"] == {"body": body, "sign": 1.0 if body == "first" else -1.0}


@pytest.mark.skipif(jit.max_threads() < 2, reason="this process has one thread")
def test_a_run_may_go_on_with_fewer_threads(monkeypatch):
    """With more parts than threads, one part would wait for ever for another that has no thread."""
    simulation, seen, play = Simulation(deck.loads(TEXT)), [], jit.Tape.play

    def watched(tape, handle, first):
        seen.append((len(handle.parts) - 1, jit.threads()))
        assert seen[-1][0] <= jit.threads()
        play(tape, handle, first)

    monkeypatch.setattr(jit.Tape, "play", watched)
    with at_most(2):
        simulation.advance(cycles=4)
        simulation.advance(cycles=4)
    with at_most(1):
        simulation.advance(cycles=4)
    with at_most(2):
        simulation.advance(cycles=4)
    assert (2, 2) in seen
    assert (1, 1) in seen
