"""Whether the residual velocity at the end of a run is final."""

import json

import pytest

from hydro2d.measure.penetrator import Passage, Projectile
from hydro2d.output.history import Columns
from hydro2d.running.progress import result
from hydro2d.running.residual_velocity import CHANGE, OVER, VELOCITY, change
from hydro2d.running.run import run
from tests.rules import source

RADIUS = 5e-3


def rows(*known):
    """A history of times in us and residual velocities in m/s."""
    columns = Columns()
    for time, velocity in known:
        columns.append({"time": time * 1e-6, VELOCITY: velocity})
    return columns


def found(columns, velocity, time, exits=None):
    measured = Projectile(**{VELOCITY: velocity, "rod_initial_radius_m": RADIUS})
    said = change(columns, exits or [Passage()], measured, time * 1e-6)
    return said[CHANGE], said[OVER]


def test_the_change_is_that_over_the_last_radius_of_flight():
    """1000 m/s and 5 mm: the last 5 us. Before that, the body was not through."""
    history = rows((0, None), (10, 1020.0), (14, 1004.0), (15, 1003.0), (16, 1002.0), (20, 1000.0))
    assert found(history, 1000.0, 20) == pytest.approx((-3.0, 5e-6))


def test_the_change_since_perforation_is_reported_if_that_is_less():
    """The exit may lie between two rows, or nothing else may be known."""
    exits = [Passage(exit_time_s=17.5e-6, exit_velocity_m_s=1002.0)]
    assert found(rows((10, None), (18, 1001.5), (20, 1000.0)), 1000.0, 20, exits) == pytest.approx((-2.0, 2.5e-6))
    assert found(rows((10, None), (20, 1000.0)), 1000.0, 20, exits) == pytest.approx((-2.0, 2.5e-6))


def test_without_a_residual_velocity_or_a_time_before_there_is_no_change():
    assert found(rows((0, None)), None, 0) == (None, None)
    assert found(Columns(), 1000.0, 20) == (None, None)
    assert found(rows((10, None), (20, 1000.0)), 1000.0, 20) == (None, None)
    assert found(rows((10, 0.0), (20, 0.0)), 0.0, 20) == pytest.approx((0.0, 10e-6))  # it does not move: nothing else is known


@pytest.mark.thorough
@pytest.mark.parametrize(("time", "said"), [("12 us", True), ("60 us", False)])
def test_the_closing_lines_say_that_a_ball_behind_its_plate_still_slows(time, said, tmp_path):
    """The cap that it pushes ahead slows it for some microseconds; later it flies free."""
    from hydro2d.deck import deck as decks

    deck = decks.load(source.PROBLEMS / "perforation" / "sphere.toml", [f"stop.time={time}", "stop.perforation=false"])
    summary = run(deck, tmp_path / "ball", quiet=True)
    line = next(line for line in result(summary) if line.startswith("residual ball"))
    assert ("; still changing, by -" in line) == said
    kept = json.loads((tmp_path / "ball" / "summary.json").read_text())["projectile"]
    assert (abs(kept[CHANGE]) > 1e-3 * kept["residual_velocity_m_s"]) == said
