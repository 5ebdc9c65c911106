"""Several targets, one behind the other: which they are, and measurements of the rod behind each and of its hole."""


import h5py
import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.measure.penetrator import WATCH_EVERY, Passage
from hydro2d.output import history
from hydro2d.results import figures
from hydro2d.results.reading import Results
from hydro2d.running.run import run
from hydro2d.solver.simulation import Simulation
from tests.decks import body, contact, mesh, plate, stop, table
from tests.restarts import restarted

TEXT = (
    mesh(("12 mm", 12), ("-13 mm", "31 mm", 44))
    + body("ball", "steel_4340", "sphere", centre="-6 mm", radius="5 mm", velocity="1500 m/s")
    + plate("4 mm", name="rear", material="Al6061_T6", z_front="12 mm")
    + plate("3 mm", name="front", material="Al6061_T6")
    + contact("ball")
    + stop("30 us", perforation=True)
    + table("output", history_interval="0.05 us", vtk_interval="10 us")
)
#: as above, but flying to -z
BACK = ['body.ball.centre="6 mm"', 'body.ball.velocity="-1500 m/s"', 'body.rear.z_front="-16 mm"',
        'body.front.z_front="-3 mm"', 'mesh.z_start="-31 mm"', 'mesh.z.0.to="13 mm"']
RING = '[[body]]\nname = "ring"\nmaterial = "Al6061_T6"\nshape = "box"\nr = ["10 mm", "12 mm"]\nz = ["5 mm", "8 mm"]\n'
BEHIND = '[[body]]\nname = "behind"\nmaterial = "Al6061_T6"\nshape = "plate"\nz_front = "-13 mm"\nthickness = "1 mm"\n'
NAMED = '[penetration]\nrod = "ball"\n'


def penetration(text: str, *options: str):
    return decks.loads(text, list(options)).penetration


@pytest.mark.parametrize("options", [(), BACK], ids=["to +z", "to -z"])
def test_plates_in_the_way_are_targets_in_the_order_of_the_flight(options):
    targets = penetration(TEXT, *options)
    assert (targets.rod, targets.target, targets.targets, targets.surface) == ("ball", "front", ("front", "rear"), 0.0)


def test_rings_and_plates_behind_the_rod_are_none():
    assert penetration(TEXT + RING + BEHIND).targets == ("front", "rear")


def test_a_resolved_deck_says_the_same_again():
    first = decks.loads(TEXT)
    assert decks.loads(first.to_toml()).penetration == first.penetration


@pytest.mark.parametrize(
    ("keys", "targets"),
    [('target = "rear"', ("rear",)), ('targets = ["front", "rear"]', ("front", "rear")),
     ('target = "front"\ntargets = ["front", "rear"]', ("front", "rear"))],
)
def test_named_targets(keys, targets):
    section = penetration(TEXT + NAMED + keys)
    assert (section.target, section.targets) == (targets[0], targets)


@pytest.mark.parametrize(
    ("keys", "said"),
    [('targets = ["rear", "front"]', '"ball" reaches "front" before "rear"; name them in that order'),
     ('targets = ["front", "back"]', 'unknown body "back"'),
     ('targets = ["front", "ball"]', '"ball" is the projectile'),
     ('targets = ["front", "front"]', "targets names a body twice"),
     ('target = "rear"\ntargets = ["front", "rear"]', 'target is "rear" and the first of targets is "front"'),
     ("", "target or targets is missing")],
)
def test_targets_that_cannot_be(keys, said):
    with pytest.raises(DeckError) as refused:
        penetration(TEXT + NAMED + keys)
    assert said in str(refused.value)


@pytest.fixture(scope="module")
def shot(tmp_path_factory):
    directory = tmp_path_factory.mktemp("targets") / "run"
    run(decks.loads(TEXT), directory, quiet=True)
    return Results(directory)


def test_the_rod_behind_each_target(shot):
    front, rear = shot.summary["targets"]["front"], shot.summary["targets"]["rear"]
    assert shot.summary["stop_reason"] == "perforation of rear"
    assert 1500.0 > front["exit_velocity_m_s"] > rear["exit_velocity_m_s"] > 1000.0
    assert front["exit_mass_kg"] == pytest.approx(shot.summary["rod_mass_kg"], rel=0.02)
    assert 10e-3 > front["exit_length_m"] > rear["exit_length_m"] > 5e-3
    times, depths = shot.history["time"], shot.history["penetration_depth_m"]
    for behind, rear_face in ((front, 3e-3), (rear, 16e-3)):
        seen = int(np.argmin(np.abs(times - behind["exit_time_s"])))
        assert times[seen] == pytest.approx(behind["exit_time_s"], rel=1e-12)
        assert depths[seen - WATCH_EVERY] < rear_face + 4.966e-3 <= depths[seen]  # its radius on this mesh; every cycle is kept
    assert shot.summary["exit_time_s"] == rear["exit_time_s"]
    assert shot.summary["rod_residual_velocity_m_s"] == pytest.approx(rear["exit_velocity_m_s"], rel=1e-3)


def test_the_hole_in_each_target(shot):
    front, rear = (shot.summary["targets"][name]["crater"] for name in ("front", "rear"))
    assert shot.summary["crater"] == front
    assert 10e-3 < front["exit_diameter_m"] < 16e-3
    assert 10e-3 < rear["entrance_diameter_m"] < 20e-3
    assert rear["exit_diameter_m"] < rear["entrance_diameter_m"]  # the lip is still on the ball
    assert list(shot.craters) == ["front", "rear"]
    assert [0.0 <= z[0] and z[-1] < 11e-3 or z[0] > 9e-3 for z, _ in shot.craters.values()] == [True, True]
    assert shot.crater[0] is not None
    assert "through rear at" in (shot.directory / "log.txt").read_text()


def test_the_last_hole_once_the_ball_is_clear_of_it(tmp_path):
    on = ["stop.perforation=false", 'mesh.z.0.to="45 mm"', "mesh.z.0.cells=58"]
    rear = run(decks.loads(TEXT, on), tmp_path / "run", quiet=True)["targets"]["rear"]["crater"]
    assert 10e-3 < rear["exit_diameter_m"] < 16e-3
    assert 10e-3 < rear["entrance_diameter_m"] < 20e-3


def test_the_picture_has_both(shot):
    (axes,) = figures.craters([shot]).axes
    holes = [line for line in axes.lines if len(line.get_xdata()) > 2]
    assert len(holes) == 2
    assert holes[0].get_color() == holes[1].get_color()
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [shot.label]


def test_histories_of_before_have_one_hole(shot, tmp_path):
    path = tmp_path / "history.h5"
    path.write_bytes((shot.directory / "history.h5").read_bytes())
    with h5py.File(path, "r+") as file:
        del file["crater_rear"]
        for name in ("target", "number"):
            del file["crater"].attrs[name]
    assert list(history.read_craters(path)) == ["target"]
    assert set(history.read(path)) == set(shot.history)


def test_a_restart_keeps_what_was_passed():
    sim = Simulation(decks.loads(TEXT))
    while not sim.penetrator.passed:
        sim.step()
    first, second = sim.penetrator.passages()
    assert None not in dict(first).values()
    assert second == Passage()
    assert sim.stop_reason() is None
    assert restarted(sim).penetrator.passages() == [first, second]


def test_a_mirrored_shot_does_the_same(tmp_path, shot):
    """Its exits differ by 6e-6: round-off decides in cells with crumbs of a body, by up to 250 m/s there."""
    run(decks.loads(TEXT, [*BACK, "output.history_interval=1e-6"]), tmp_path / "run", quiet=True)
    results = Results(tmp_path / "run").summary["targets"]
    for name, one in shot.summary["targets"].items():
        assert results[name]["exit_velocity_m_s"] == pytest.approx(-one["exit_velocity_m_s"], rel=1e-5)


def test_the_models_take_one_target(tmp_path, capsys):
    deck = tmp_path / "two.toml"
    deck.write_text(TEXT.replace('shape = "sphere"\ncentre = "-6 mm"', 'shape = "rod"\ntip = "-1 mm"\nlength = "20 mm"')
                    .replace('z_start = "-13 mm"', 'z_start = "-25 mm"'))
    assert call(["model", "forrestal", "--deck", str(deck)]) == 2
    assert "the models allow one target" in capsys.readouterr().err


def test_a_run_to_the_end_of_the_tail():
    """The ball goes on until all of it is beyond the rear, and its velocity falls on the way."""
    early, late = (Simulation(decks.loads(TEXT, [option, 'penetration.rod="ball"', 'penetration.target="front"']))
                   for option in ("stop.perforation=true", 'stop.perforation="tail"'))
    for sim in (early, late):
        while (reason := sim.stop_reason()) is None:
            sim.step()
        assert reason == "perforation of front"
    assert late.time > early.time + 1e-6
    tail = late.penetrator._length()[1]
    assert 3e-3 <= tail < 5e-3
    assert late.diagnostics()["rod_residual_velocity_m_s"] < early.diagnostics()["rod_residual_velocity_m_s"]
