"""Measurements of a rod: lengths to a fraction of a cell, and the regime by its stated rules."""

import json

import numpy as np
import pytest

import hydro2d
from hydro2d.deck import deck
from hydro2d.files import shipped
from hydro2d.measure.regime import (
    DEFORMING,
    ERODED_LENGTH,
    ERODED_MASS,
    ERODING,
    LEFT,
    RIGID,
    RIGID_LENGTH,
    RIGID_RADIUS,
    regime,
)
from hydro2d.solver.simulation import WATCH_EVERY, Simulation
from tests.decks import box, mesh, plate, rod, stop, table
from tests.restarts import restarted
from tests.rules import source


def text(**keys):
    """A deck: a rod of 20.2 mm with these keys, in front of a plate."""
    return (
        mesh(("12 mm", 24), ("-25 mm", "25 mm", 100))
        + table("numerics", advection="ke")
        + rod("3 mm", "20.2 mm", velocity="1 km/s", **keys)
        + plate("24 mm")
        + stop("1 us")
    )


TEXT = text(nose="flat", tip="TIP mm")


@pytest.fixture
def simulation():
    return Simulation(deck.loads(TEXT.replace("TIP", "-0.3")))


def cells(simulation):
    """The rod's volume fractions, without ghosts, and the heights of the cells' centres."""
    return simulation.grid.interior(simulation.state.vof)[0], simulation.grid.zc[simulation.grid.inside[0]]


def test_a_rod_before_impact(simulation):
    diagnostics = simulation.diagnostics()
    assert diagnostics["rod_length_m"] == pytest.approx(20.2e-3, rel=1e-9)
    assert diagnostics["penetration_depth_m"] == 0.0
    assert diagnostics["rod_mass_kg"] == pytest.approx(np.pi * 3e-3**2 * 20.2e-3 * 18160, rel=1e-9)
    ends = 0.2e-3 / 20.2e-3  # the row at the tip is less than half full and not part of the core
    assert diagnostics["rod_core_mass_kg"] == pytest.approx(diagnostics["rod_mass_kg"] * (1 - ends), rel=1e-9)
    assert diagnostics["rod_max_radius_m"] == pytest.approx(3e-3, rel=1e-9)
    assert diagnostics["rod_mean_velocity_m_s"] == pytest.approx(1000.0, rel=2e-3)  # its tip shares a cell with the plate
    assert diagnostics["rod_tail_velocity_m_s"] == pytest.approx(1000.0, rel=1e-9)
    assert diagnostics["regime"] == "rigid"


@pytest.mark.parametrize(("keys", "length"), [
    ({"nose": "ogival", "crh": 3.0}, 20.2e-3),  # its tip is thinner than half a cell
    ({"nose": "hemispherical"}, 20.2e-3),
])
def test_a_rod_has_the_length_of_the_deck(keys, length):
    """And loses none of it while its cells are as at the start; their losses count in proportion."""
    own = Simulation(deck.loads(text(tip="-0.3 mm", **keys)))
    diagnostics = own.diagnostics()
    shown = own.penetrator._length()[0]
    assert (diagnostics["rod_initial_length_m"], diagnostics["rod_length_m"]) == pytest.approx((length, length), rel=1e-12)
    assert length - 1.5e-3 < shown < length - 1e-5
    fraction, z = cells(own)
    fraction[z < -15.4e-3] = 0.0
    left = own.diagnostics()["rod_length_m"]
    assert left / length == pytest.approx(own.penetrator._length()[0] / shown, rel=1e-12)
    assert left == pytest.approx(length * (1.0 - 5e-3 / shown), rel=1e-2)


@pytest.mark.parametrize(("before", "after", "length"), [
    (box("bore", "Al5083", r=["0 mm", "1 mm"], z=["-25 mm", "-18 mm"]), "", 17.7e-3),  # an earlier body takes its place
    ("", box("tail", "W_alloy", r=["0 mm", "3 mm"], z=["-22.5 mm", "-20.5 mm"], join="rod", velocity="1 km/s"), 22.2e-3),
])
def test_a_rod_that_is_not_by_itself_has_the_length_of_its_cells(before, after, length):
    whole = text(nose="flat", tip="-0.3 mm").replace("[[body]]", before + "[[body]]", 1) + after
    shot = Simulation(deck.loads(whole))
    assert shot.penetrator.length == shot.penetrator._length()[0] == pytest.approx(length, rel=1e-9)


def test_depth_counts_the_share_of_the_last_cell(simulation):
    fraction, z = cells(simulation)
    new = (z > 0) & (z < 4e-3)
    fraction[np.ix_(new, np.arange(24) < 6)] = 1.0  # 0.1 mm of the cell below z = 0 are missing: filled
    fraction[(z > -0.5e-3) & (z < 0), :6] = 1.0
    fraction[(z > 4e-3) & (z < 4.5e-3), :6] = 0.25
    assert simulation.diagnostics()["penetration_depth_m"] == pytest.approx(4.125e-3, rel=1e-9)


def test_the_depth_of_a_rod_that_rebounds_is_the_largest(simulation):
    """It was 4 mm deep and is at 1 mm again, by steps of a cell: both are reported, also after a restart."""
    sim = simulation
    fraction, z = cells(sim)
    fraction[(z > -0.5e-3) & (z < 4e-3), :6] = 1.0
    sim.penetrator.watch()
    fraction[z > 1e-3] = 0.0
    first = sim.diagnostics()
    assert (first["penetration_depth_m"], first["nose_depth_m"]) == pytest.approx((4e-3, 1e-3), rel=1e-9)
    assert first["penetration_over_length"] == pytest.approx(4.0 / 20.2, rel=1e-9)
    assert (sim.penetrator.nose(), sim.penetrator.perforates()) == (first["nose_depth_m"], False)
    again = Simulation(sim.deck)
    again.penetrator.resume(json.loads(json.dumps(sim.penetrator.saved())))
    assert again.diagnostics()["penetration_depth_m"] == first["penetration_depth_m"]
    fraction[z > -5e-3] = 0.0
    sim.penetrator.watch()
    assert (sim.diagnostics()["penetration_depth_m"], sim.diagnostics()["nose_depth_m"]) == (first["penetration_depth_m"], 0.0)


def test_fragments_behind_the_tail_do_not_count(simulation):
    fraction, z = cells(simulation)
    fraction[(z > -23.5e-3) & (z < -22.9e-3), :4] = 1.0
    assert simulation.diagnostics()["rod_length_m"] == pytest.approx(20.2e-3, rel=1e-9)


@pytest.mark.parametrize(("length", "radius", "core", "expected"), [
    (1.0, 1.0, 1.0, RIGID), (0.951, 1.099, 0.901, RIGID), (1.0, 1.101, 1.0, DEFORMING), (0.949, 1.0, 1.0, DEFORMING),
    (0.667, 1.5, 0.901, DEFORMING), (0.666, 1.0, 1.0, ERODING), (0.22, 1.3, 1.0, ERODING), (1.0, 1.0, 0.899, ERODING),
    (0.0, 0.0, 0.0, ERODING),
])
def test_the_rule_of_the_regimes(length, radius, core, expected):
    assert regime(length, radius, core) == expected


def test_the_rule_is_among_the_words():
    """The page that explains the words has the numbers of the rule."""
    page = " ".join((source.ROOT / "docs/reference/words.md").read_text(encoding="utf-8").split())
    numbers = (f"{100 * RIGID_LENGTH:g} %", f"{1 + RIGID_RADIUS:g} times", f"{100 * ERODED_MASS:g} %",
               "more than a third of its length")
    assert [number for number in numbers if number not in page] == []
    assert hydro2d.LEAST_KEPT_LENGTH == 1.0 - ERODED_LENGTH == pytest.approx(2.0 / 3.0, abs=1e-15)


def test_regimes(simulation):
    fraction, z = cells(simulation)
    fraction[z < -19.9e-3] = 0.0  # 0.6 mm of the tail are gone: 3 % of length and mass
    assert simulation.diagnostics()["regime"] == "rigid"
    fraction[z < -19.1e-3] = 0.0  # 1.6 mm: 8 %
    assert simulation.diagnostics()["regime"] == "deforming"
    skirt = (z > -15e-3) & (z < -9e-3)
    fraction[np.ix_(skirt, np.arange(24) == 5)] = 0.0  # a gap, and outside of it material that was turned back
    fraction[np.ix_(skirt, np.arange(24) == 7)] = 1.0
    diagnostics = simulation.diagnostics()
    assert diagnostics["rod_core_mass_kg"] < 0.9 * diagnostics["rod_mass_kg"]
    assert diagnostics["regime"] == "eroding"


def test_failed_material_is_debris(simulation):
    """The nose fails over 4 mm: it still counts for the depth and the mass of the rod, not for its core or its length."""
    before = simulation.diagnostics()
    _, z = cells(simulation)
    damage = simulation.grid.interior(simulation.state.dmg)
    damage[0][z > -4e-3] = 1.0
    diagnostics = simulation.diagnostics()
    assert diagnostics["rod_length_m"] == pytest.approx(16.5e-3, rel=1e-9)
    assert diagnostics["penetration_depth_m"] == before["penetration_depth_m"]
    assert diagnostics["rod_failed_mass_kg"] == pytest.approx(np.pi * 3e-3**2 * 3.7e-3 * 18160, rel=1e-9)
    assert diagnostics["rod_core_mass_kg"] < diagnostics["rod_mass_kg"] - diagnostics["rod_failed_mass_kg"] + 1e-12
    assert (diagnostics["target_failed_mass_kg"], diagnostics["regime"]) == (0.0, "eroding")


def test_material_that_flies_back_does_not_stop_the_run(simulation):
    """Half of the mass is torn off and flies back as fast as the core moves forward: the mean is at rest, the core is not."""
    fraction, z = cells(simulation)
    fraction[(z > -11e-3) & (z < -10e-3)] = 0.0
    v = simulation.grid.interior_vertices(simulation.state.v)[0]
    v[:] = np.where(simulation.grid.z_edges < -10.4e-3, -1000.0, 1000.0)[:, None]
    diagnostics = simulation.diagnostics()
    assert abs(diagnostics["rod_mean_velocity_m_s"]) < 100.0
    assert diagnostics["rod_core_velocity_m_s"] == pytest.approx(1000.0, rel=1e-12)
    assert simulation.penetrator.velocity() == diagnostics["rod_core_velocity_m_s"]
    simulation.penetrator._intact = lambda rows, columns=slice(None): 0.0 * fraction[rows, columns]
    assert simulation.penetrator.velocity() == pytest.approx(505.0, rel=0.01)  # momentum of the rest over the whole mass


def test_debris_that_flies_back_from_a_stub_is_no_part_of_its_length(simulation):
    """The front 8 mm of the rod have stopped; what is behind flies back. A rod that rebounds as a whole keeps its length."""
    whole, z = simulation.diagnostics()["rod_length_m"], simulation.grid.z_edges
    v = simulation.grid.interior_vertices(simulation.state.v)[0]
    v[:] = np.where(z < -8.01e-3, -300.0, -20.0)[:, None]
    assert simulation.diagnostics()["rod_length_m"] == pytest.approx(8e-3, abs=np.diff(z).max())
    for speed, rear in ((-300.0, -300.0), (300.0, 400.0), (1000.0, 20.0)):
        v[:] = np.where(z < -8.01e-3, rear, speed)[:, None]
        assert simulation.diagnostics()["rod_length_m"] == whole


def test_debris_against_the_flank_is_not_of_the_core(simulation):
    """Debris with more mass than the core flies back along half of it: the core keeps the rod's velocity and its mass."""
    before = simulation.diagnostics()
    fraction, z = cells(simulation)
    v = simulation.grid.interior_vertices(simulation.state.v)[0]
    beside = (z > -20e-3) & (z < -6e-3)
    fraction[np.ix_(beside, np.arange(24) >= 6)] = 1.0
    simulation.grid.interior(simulation.state.rho)[0][beside] = 18160.0
    v[np.ix_((simulation.grid.z_edges > -21e-3) & (simulation.grid.z_edges < -5e-3), np.arange(25) > 6)] = -400.0
    diagnostics = simulation.diagnostics()
    assert diagnostics["rod_mean_velocity_m_s"] < 0.0
    assert diagnostics["rod_core_velocity_m_s"] == pytest.approx(1000.0, rel=0.01)
    assert diagnostics["rod_core_mass_kg"] == pytest.approx(before["rod_core_mass_kg"], rel=1e-9)
    assert simulation.penetrator.speed() == diagnostics["rod_core_velocity_m_s"]


def test_a_run_does_not_end_while_the_tail_feeds_the_head():
    """The mean of the core is at rest, its tail is not; a tail that only oscillates does not keep the run going."""
    simulation = shot("stop.speed_below=10.0")
    v, z = simulation.grid.interior_vertices(simulation.state.v)[0], simulation.grid.z_edges
    for tail, reason in ((355.0, None), (0.9 * simulation.penetrator._ringing, "speed of rod below 10 m/s")):
        v[...] = np.where(z < -15e-3, tail, 0.0)[:, None]
        v[...] -= simulation.penetrator.velocity()
        assert abs(simulation.penetrator.velocity()) < 10.0
        assert simulation.stop_reason() == reason
    assert 5.0 < simulation.penetrator._ringing < 100.0


def ball(*options):
    text = (shipped.problems_folder() / "perforation" / "sphere.toml").read_text()
    text = text.replace("cells = 25", "cells = 9").replace("cells_across = 12.5", "cells_across = 4.5")
    stands = ['mesh.follow="none"', 'mesh.z_start="-12 mm"', 'mesh.z=[{ cells = 44, size = "1.1 mm" }]',
              'stop.perforation="tail"', 'stop.time="60 us"']
    return Simulation(deck.loads(text.replace("1500 m/s", "5.8 km/s"), [*stands, *options]))


@pytest.mark.parametrize(
    ("options", "reason"), [([], "perforation of plate"), (["stop.perforation=false"], "ball left the mesh")],
    ids=["perforation", "speed"])
def test_a_ball_that_breaks_up_has_perforated_and_left(options, reason):
    """It goes through in pieces and flies out of the mesh: no speed of the remains can end the run."""
    sim = ball(*options)
    while sim.stop_reason() is None:
        sim.step()
    diagnostics = sim.diagnostics()
    assert sim.stop_reason() == reason
    assert sim.of_targets()["plate"]["exit_velocity_m_s"] > 3500.0
    assert diagnostics["rod_residual_velocity_m_s"] > 3500.0
    assert diagnostics["rod_residual_mass_kg"] > 0.5 * sim.penetrator.mass
    assert diagnostics["penetration_depth_m"] > 6e-3
    assert (diagnostics["regime"] == LEFT) is (reason == "ball left the mesh")


def test_a_rod_that_earlier_bodies_cover_has_no_speed():
    """Where bodies overlap the earlier one counts: nothing remains of a rod inside a block that comes first."""
    text = TEXT.replace("TIP", "-0.3").replace('[[body]]\nname = "rod"', '[[body]]\nname = "block"\nmaterial = "Al5083"\n'
                        'shape = "box"\nz = ["-25 mm", "0 mm"]\n[[body]]\nname = "rod"')
    sim = Simulation(deck.loads(text, ["stop.speed_below=1.0"]))
    assert sim.diagnostics()["rod_mean_velocity_m_s"] is None
    assert (sim.penetrator.speed(), sim.stop_reason()) == (None, None)


def test_a_body_that_is_gone_has_no_speed():
    """Without [penetration]: a block flies out of an empty mesh; the 1e-6 of it left behind does not end the run as slow."""
    text = TEXT[:TEXT.index('[[body]]\nname = "plate"')] + '[stop]\nbody = "rod"\nspeed_below = "5 m/s"\ntime = "100 us"\n'
    sim = Simulation(deck.loads(text.replace("TIP", "20"), ["mesh.r.0.cells=12", "mesh.z.0.cells=40"]))
    while sim.stop_reason() is None:
        sim.step()
    assert sim.stop_reason() == "rod left the mesh"
    assert sim.time < 60e-6


#: thin air behind a thin plate, and coarse cells: the rod is out of the mesh in a few hundred cycles
SHORT = ["mesh.r.0.cells=12", "mesh.z.0.cells=36", "mesh.z.0.to=11e-3", "body.plate.thickness=2e-3", "body.rod.tip=-0.3e-3",
         "body.rod.length=12e-3", "mesh.z_start=-13e-3"]
BACKWARD = ["mesh.r.0.cells=12", "mesh.z.0.cells=36", "mesh.z_start=-11e-3", "mesh.z.0.to=13e-3", "body.plate.z_front=-2e-3",
            "body.plate.thickness=2e-3", "body.rod.tip=0.3e-3", "body.rod.direction=-1", "body.rod.velocity=-1e3",
            "body.rod.length=12e-3"]


def shot(*options):
    return Simulation(deck.loads(TEXT.replace("TIP", "-0.3"), ["stop.time=100e-6", *options]))


@pytest.mark.parametrize("options", [SHORT, BACKWARD], ids=["to +z", "to -z"])
def test_a_rod_that_leaves_the_mesh(options):
    """Its velocity and mass are those at the moment when the nose reached the edge, and so is its depth."""
    sim = shot(*options)
    before, masses = {}, []
    while not sim.penetrator.left:
        sim.step()
        assert sim.time < 30e-6
        if sim.penetrator.exit is None:
            before = sim.diagnostics()
            masses.append(before["rod_core_mass_kg"])
    diagnostics = sim.diagnostics()
    assert diagnostics["regime"] == LEFT
    assert before["regime"] != LEFT
    assert diagnostics["penetration_depth_m"] == pytest.approx(11e-3, abs=0.4e-3)
    assert diagnostics["rod_residual_velocity_m_s"] == pytest.approx(before["rod_core_velocity_m_s"], rel=0.01)
    shortly = masses[-40:]  # the row of its tail is core in one cycle and debris in the next
    assert 0.99 * min(shortly) < diagnostics["rod_residual_mass_kg"] < 1.01 * max(shortly)
    assert diagnostics["rod_mass_kg"] < 0.99 * sim.penetrator.mass
    names = ("regime", "penetration_depth_m", "rod_residual_velocity_m_s", "rod_residual_mass_kg")
    while sim.penetrator._length()[0] > 0.0:
        sim.step()
    assert sim.penetrator.gone
    assert {name: sim.diagnostics()[name] for name in names} == {name: diagnostics[name] for name in names}


def test_a_rod_that_has_perforated_flies_on():
    sim = shot(*SHORT)
    while not sim.penetrator.perforates():
        assert sim.diagnostics()["rod_residual_mass_kg"] is None
        sim.step()
    diagnostics = sim.diagnostics()
    assert diagnostics["rod_residual_velocity_m_s"] == diagnostics["rod_core_velocity_m_s"] > 500.0
    assert diagnostics["rod_residual_mass_kg"] == diagnostics["rod_core_mass_kg"]
    assert diagnostics["rod_residual_length_m"] == diagnostics["rod_length_m"]
    assert diagnostics["regime"] != LEFT
    assert diagnostics["exit_time_s"] is None or diagnostics["exit_time_s"] == sim.time
    while sim.cycle % WATCH_EVERY:
        sim.step()
    when = sim.diagnostics()["exit_time_s"]
    assert sim.time - WATCH_EVERY * sim.dt * 1.5 < when <= sim.time
    saved = json.loads(json.dumps(sim.penetrator.saved()))
    sim.penetrator.resume(saved)
    for _ in range(WATCH_EVERY):
        sim.step()
    assert sim.diagnostics()["exit_time_s"] == when


@pytest.mark.parametrize(
    ("options", "reason"),
    [(["stop.speed_below=1.0"], "rod left the mesh"), (["stop.rebound=true"], "rod left the mesh"),
     (["stop.perforation=true", "body.plate.thickness=9e-3", "body.rod.velocity=2e3", "numerics.clip_limit=0.05"],
      "rod left the mesh"), ([], None)],
)
def test_a_run_that_watches_its_rod_ends_when_that_is_gone(options, reason):
    sim = shot(*SHORT, *options)
    while sim.stop_reason() is None and not (reason is None and sim.penetrator.gone and sim.cycle % WATCH_EVERY == 0):
        sim.step()
    assert sim.penetrator.gone
    assert sim.stop_reason() == reason


def test_a_core_that_the_target_carries_along_has_not_perforated():
    """Its nose is 6 mm beyond the rear of a plate of 4 mm: it is through if it flies on, and no longer once both fly alike."""
    sim = Simulation(deck.loads(TEXT.replace("TIP", "10"), ["body.plate.thickness=4e-3"]))
    rod_there = sim.grid.interior(sim.state.vof)[0].any(axis=0).nonzero()[0].max() + 1 + sim.grid.g
    sim.state.v[...] = 0.0
    sim.state.v[:, :, : rod_there + 1] = 300.0
    sim.engine.number, sim.engine.dt = WATCH_EVERY, 1e-9
    sim.penetrator.watch()
    assert len(sim.penetrator.passed) == 1
    assert sim.penetrator.perforates()
    assert sim.diagnostics()["rod_residual_velocity_m_s"] == pytest.approx(300.0)
    assert sim.diagnostics()["exit_time_s"] is not None
    sim.state.v[...] = 30.0
    sim.state.v[:, :, :3] = 35.0  # on the axis alone: on the whole, the core is a little faster than the plate
    sim.penetrator.watch()
    assert sim.penetrator.passed == []
    assert not sim.penetrator.perforates()
    assert sim.diagnostics()["rod_residual_velocity_m_s"] is None
    assert sim.diagnostics()["exit_time_s"] is None


def test_debris_does_not_leave_for_the_rod(simulation):
    """Mass of the rod that flows out while its core is inside, or reaches an edge that it moves away from, does not count."""
    sim, sink = simulation, simulation.audit.sinks["outflow"]
    fraction, z = cells(sim)
    sink.mass[0] += 0.3 * sim.penetrator.mass
    sim.state.v[...], sim.engine.dt = 1000.0, 1e-9
    sim.penetrator.watch()
    assert (sim.penetrator.exit, sim.diagnostics()["regime"]) == (None, "rigid")
    fraction[-4:, :6] = 1.0  # a fragment flies out before the rod
    sim.penetrator.watch()
    assert sim.penetrator.exit is None
    fraction[z < -20e-3, :6] = 1.0  # the tail reaches the edge behind it, and moves away from it
    sim.penetrator.watch()
    assert sim.penetrator.exit is None
    fraction[z > -1e-3, :6] = 1.0  # the nose reaches the edge ahead of it
    sim.penetrator.watch()
    assert sim.penetrator.exit is not None
    assert sim.diagnostics()["regime"] != LEFT
    sink.mass[0] += 0.02 * sim.penetrator.mass / (2 * np.pi)
    assert sim.diagnostics()["regime"] == LEFT


def test_a_mesh_that_travels_faster_than_the_rod_leaves_it_behind(simulation):
    fraction, z = cells(simulation)
    fraction[z < -20e-3, :6] = 1.0
    simulation.state.v[...], simulation.engine.dt = 1000.0, 1e-9
    for speed, reached in ((900.0, False), (1100.0, True)):
        simulation.engine.given.set(mesh_speed=speed)
        simulation.penetrator.watch()
        assert (simulation.penetrator.exit is not None) is reached


def test_the_edge_behind_the_rod_of_a_mesh_that_follows_it_is_no_way_out():
    """Debris that fills the hole behind an eroding rod is connected with the rest of it; ahead, the edge counts."""
    following = ("mesh.follow=rod", "boundaries.z_max=transmit")
    assert [vertex for vertex, _ in shot().penetrator._open] == [0, 100]
    assert [vertex for vertex, _ in shot(*following).penetrator._open] == [100]
    assert [vertex for vertex, _ in shot(*following, "mesh.follow=none").penetrator._open] == [0, 100]


def test_a_wall_is_no_way_out():
    sim = shot("boundaries.z_max=wall", "body.plate.thickness=24e-3")
    fraction, _ = cells(sim)
    fraction[-30:, :6] = 1.0
    sim.state.v[...], sim.engine.dt = 1000.0, 1e-9
    sim.penetrator.watch()
    assert sim.penetrator.exit is None


def test_a_restart_remembers_the_exit():
    sim = shot(*SHORT)
    while not sim.penetrator.left:
        sim.step()
    again = restarted(sim)
    assert again.diagnostics() == sim.diagnostics()
    assert again.restart_scalars() == sim.restart_scalars()
