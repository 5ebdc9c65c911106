"""State of a run: what is reported of one that is under way, has ended, or was abandoned, and when it will end."""

import re

import numpy as np
import pytest

import hydro2d
from hydro2d.cli import status
from hydro2d.cli.main import call
from hydro2d.files.locks import locked
from hydro2d.files.whole import write_json
from hydro2d.output import ending
from hydro2d.results import standing, terminal_charts
from hydro2d.results.reading import Results
from tests.results import made_run


@pytest.fixture
def under_way(tmp_path):
    """A run of 80 us in the middle, without a summary."""
    run = made_run.write(tmp_path / "run", dumps=3, ended=False)
    deck = [line for line in (run / "deck.toml").read_text().splitlines() if not line.startswith("#")]
    (run / "deck.toml").write_text("\n".join([*deck, "[stop]", "time = 80e-6", "perforation = true"]) + "\n")
    write_json(run / "progress.json", {"time_s": 40e-6, "cycles": 1000, "fraction": 0.5, "left_s": 90.0, "wall_s": 100.0,
                                       "penetration_depth_m": 0.04, "host": "here", "process": 1})
    return run


def said(run, capsys):
    assert call(["status", str(run)]) == 0
    return dict(line.split(None, 1) for line in capsys.readouterr().out.splitlines())


def test_a_run_under_way(under_way, capsys):
    with locked(under_way / "run.lock"):
        shown = said(under_way, capsys)
    assert shown["run"] == "A made shot"
    assert shown["state"].startswith("running: process ")
    assert shown["time"] == "40.000 us, cycle 1000, 1 min 40 s of computing"
    assert shown["end"] == "should stop at 80.000 us (end time), 1 min 30 s from now, unless the rod perforates first"
    assert shown["depth"] == "40.00 mm, in the experiment 30.00 mm"
    assert shown["rod"] == "rigid, 26.00 mm long"
    assert shown["dumps"] == "3, the last at 40.000 us"


def test_a_run_that_is_continued_is_where_it_is_now(under_way, capsys):
    write_json(under_way / "summary.json", {"time_s": 20e-6, "status": "interrupted", "stop_reason": "SIGINT"})
    with locked(under_way / "run.lock"):
        assert said(under_way, capsys)["time"].startswith("40.000 us")
    shown = said(under_way, capsys)
    assert shown["state"] == "interrupted: SIGINT"
    assert shown["time"].startswith("20.000 us")
    assert "end" not in shown


def test_a_projectile_that_has_gone_through_has_no_depth(under_way, capsys):
    (under_way / "progress.json").unlink()
    summary = {"time_s": 70e-6, "status": "done", "stop_reason": "perforation of plate", "penetration_depth_m": 0.05,
               "exit_time_s": 60e-6}
    write_json(under_way / "summary.json", summary | {"targets": {"plate": {"exit_time_s": 60e-6}}})
    shown = said(under_way, capsys)
    assert shown["through"] == "plate; nose 50.00 mm beyond its front face"
    assert "depth" not in shown
    write_json(under_way / "summary.json", summary | {"nose_depth_m": 0.03, "targets": {"plate": {"exit_time_s": 60e-6}}})
    assert said(under_way, capsys)["through"] == "plate; nose 30.00 mm beyond its front face"
    write_json(under_way / "summary.json", summary | {"exit_time_s": None, "targets": {"plate": {"exit_time_s": None}}})
    assert said(under_way, capsys)["depth"].startswith("50.00 mm")


def test_a_run_that_was_cut_short_has_a_depth_so_far(under_way, capsys):
    (under_way / "progress.json").unlink()
    summary = {"time_s": 70e-6, "status": "done", "stop_reason": "end time", "penetration_depth_m": 0.05,
               "rod_core_velocity_m_s": 763.2, "outcome": {"final": False}}
    write_json(under_way / "summary.json", summary)
    shown = said(under_way, capsys)
    assert (shown["state"], shown["depth"][:15]) == ("done: end time, still moving at 763 m/s", "50.00 mm so far")
    assert "end time, still moving at 763 m/s at 70.00 µs, depth 50.0 mm so far" in repr(Results(under_way))
    write_json(under_way / "summary.json", summary | {"outcome": {"final": True}})
    shown = said(under_way, capsys)
    assert (shown["state"], shown["depth"][:10]) == ("done: end time", "50.00 mm, ")


def test_a_run_that_was_left(under_way, capsys):
    shown = said(under_way, capsys)
    assert shown["state"].startswith("waiting: ")
    assert shown["end"] == "should stop at 80.000 us (end time), unless the rod perforates first"  # no process is computing


def test_a_run_without_anything_yet(under_way, capsys):
    for name in ("history.h5", "series.pvd", "progress.json"):
        (under_way / name).unlink()
    shown = said(under_way, capsys)
    assert shown["dumps"] == "none"
    assert not {"time", "depth", "rod"} & set(shown)


def test_a_folder_that_is_no_run_is_reported(tmp_path, capsys):
    assert call(["status", str(tmp_path)]) == 2
    assert "is not a run directory" in capsys.readouterr().err


def columns(speed, rows=40):
    time = np.linspace(0.0, 100e-6, rows)
    return {"time": time, "cycle": np.arange(rows) * 50, "rod_core_velocity_m_s": speed(time),
            "body_ball_velocity_m_s": 0.5 * speed(time)}


def test_a_constant_deceleration_is_foreseen():
    slowing = columns(lambda time: 1000.0 - 2e6 * time)
    end = list(ending.ends({"time": 1e-3, "speed_below": 10.0, "body": "rod", "cycles": 3900}, slowing))
    assert [(each.reason, round(each.time * 1e6, 3)) for each in end] == [
        ("end time", 1000.0), ("3900 cycles", 200.0), ("speed below 10 m/s at its present deceleration", 495.0),
    ]
    backwards = columns(lambda time: -(1000.0 - 2e6 * time))
    (end,) = ending.ends({"rebound": True, "body": "rod"}, backwards)
    assert (end.reason, end.time) == ("rebound at its present deceleration", pytest.approx(500e-6))
    del slowing["rod_core_velocity_m_s"]
    (end,) = ending.ends({"speed_below": 10.0, "body": "ball"}, slowing)
    assert end.time == pytest.approx(490e-6)


@pytest.mark.parametrize("slope", [0.0, 1e6, -1e-3, np.nan])
def test_a_body_that_does_not_slow_is_not_foreseen_to_stop(slope):
    assert list(ending.ends({"speed_below": 10.0, "body": "rod"}, columns(lambda time: 1000.0 + slope * time))) == []


def test_too_few_rows_say_nothing():
    few = {name: values[:4] for name, values in columns(lambda time: 1000.0 - 1e7 * time).items()}
    assert list(ending.ends({"speed_below": 10.0, "cycles": 100}, few)) == []


def test_a_real_run_agrees_with_what_it_says(finished):
    """A fake run that has ended: its time is that of its summary."""
    run = hydro2d.open_run(finished)
    lines = standing.lines(run, "done", "", {})
    assert any("the stop time was reached" in line for line in lines)
    assert any(f"cycle {run.summary['cycles']}" in line for line in lines)


def test_histories_are_drawn(under_way, capsys):
    assert call(["status", str(under_way), "--plot", "--quantity", "rod_length_m", "--quantity", "time"]) == 0
    length, time = capsys.readouterr().out.splitlines()[-2:]
    assert re.fullmatch(r"projectile length [▁▂▃▄▅▆▇█]{20} 26 to [\d.]+ mm, 0 to 40 µs", length)
    assert re.search(r"▁▁?▂.*▇██? 0 to 40 µs", time)


def test_depth_and_tail_are_drawn_of_a_shot_and_the_first_body_of_others(under_way):
    run = hydro2d.open_run(under_way)
    assert terminal_charts.chosen(run) == ["penetration_depth_m", "rod_tail_velocity_m_s"]
    run._history = run._history[0], {"time": np.zeros(2), "body_rod_velocity_m_s": np.zeros(2)}
    assert terminal_charts.chosen(run) == ["body_rod_velocity_m_s"]


def test_a_column_that_there_is_not(under_way, capsys):
    assert call(["status", str(under_way), "--quantity", "rod_lenght_m"]) == 2
    assert 'did you mean "rod_length_m"' in capsys.readouterr().err


def test_a_run_is_watched_until_it_has_ended(under_way, monkeypatch, capsys):
    """It looks again after two seconds, and reports how the run ended."""
    waits = []

    def sleep(seconds):
        waits.append(seconds)
        if len(waits) == 2:
            lock.__exit__(None, None, None)
            write_json(under_way / "summary.json", {"time_s": 80e-6, "status": "done", "stop_reason": "end time"})
            (under_way / "progress.json").unlink()

    monkeypatch.setattr(status.time, "sleep", sleep)
    lock = locked(under_way / "run.lock")
    lock.__enter__()
    assert call(["status", str(under_way), "--watch"]) == 0
    said = capsys.readouterr().out
    assert waits == [2.0, 2.0]
    assert said.count("running: process") == 2
    assert "done: end time" in said
