"""problems/sliding/drag.py on histories with a known force."""

import json
import math

import numpy as np
import pytest

from hydro2d.analytic import model_deck
from hydro2d.deck import deck
from hydro2d.output import directory as run_directory
from hydro2d.output.history import History
from hydro2d.penetration import forrestal, inputs
from problems.sliding.drag import main, measure, windows

DECK = "problems/cth_nose_shape/hemi_5083_1086_quick.toml"
SPEED, RADIUS = 1086.0, 3.3784e-3


def wrote(directory, time, speed, depth):
    """A run directory, not ended, with the shot's deck and a history."""
    directory.mkdir()
    (directory / run_directory.DECK).write_text(deck.load(DECK).to_toml(), encoding="utf-8")
    history = History(directory / run_directory.HISTORY)
    for row in zip(time, speed, depth, strict=True):
        history.append(dict(zip(("time", "rod_mean_velocity_m_s", "penetration_depth_m"), map(float, row), strict=True)))
    history.write()
    return directory


@pytest.fixture
def steady(tmp_path):
    """A rod that loses 1.5 m/s in every microsecond, with a row for each until 43 us."""
    time = np.arange(44) * 1e-6
    return wrote(tmp_path / "steady", time, SPEED - 1.5e6 * time, SPEED * time - 0.75e6 * time**2)


def test_constant_force(steady):
    measured = measure(steady)
    mass = model_deck.read(steady / run_directory.DECK).values["rod.mass"].value
    assert [row["time"] for row in measured["rows"]] == pytest.approx([5e-6, 15e-6, 25e-6, 35e-6])
    assert [row["speed"] for row in measured["rows"]] == pytest.approx([SPEED - 1.5e6 * t for t in (5e-6, 15e-6, 25e-6, 35e-6)])
    assert [row["force"] for row in measured["rows"]] == pytest.approx([mass * 1.5e6 / (math.pi * RADIUS**2)] * 4)
    assert measured["mean"] == pytest.approx(measured["rows"][0]["force"])
    assert not measured["ended"]


def test_rigid_rod_of_the_model(tmp_path):
    """A rod under the force of forrestal has that resistance in every window, and the model's depth in the end."""
    shot = model_deck.shot(deck.load(DECK))
    mass = shot.values["rod.mass"].value
    nose = forrestal.Nose(inputs.nose("hemispherical", 2.0 * RADIUS))
    target = forrestal.Target(4.82065 * 276e6, 1.12389 * 2660.0)
    depth, duration = forrestal.deep(SPEED, mass, nose, target)
    rate = math.atan(SPEED * math.sqrt(0.5 * target.dynamic / target.static)) / duration
    time = np.linspace(0.0, duration, 1000)
    speed = math.sqrt(2.0 * target.static / target.dynamic) * np.tan(rate * (duration - time))
    travelled = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time))])
    measured = measure(wrote(tmp_path / "rigid", time, speed, travelled))
    assert [row["force"] for row in measured["rows"]] == pytest.approx([row["cavity"] for row in measured["rows"]], rel=1e-3)
    assert measured["depth"] == pytest.approx(measured["cavity_depth"], rel=1e-4)
    assert measured["cavity_depth"] == pytest.approx(depth, rel=1e-4)


def test_the_shot_asks_for_2_31_gpa(steady):
    """Half the square of 1086 m/s times the mass, over the section, along the measured 44.8 cm."""
    assert measure(steady)["measured_mean"] == pytest.approx(2.31e9, rel=2e-3)


def test_windows_leave_out_what_is_short():
    time = np.arange(0.0, 24.5e-6, 1e-6)
    assert [at.time for at in windows(time, time, time, 10e-6)] == pytest.approx([5e-6, 15e-6])
    assert windows(time[:3], time[:3], time[:3], 10e-6) == []


def test_command(steady, tmp_path, capsys):
    assert main([str(steady), "--window", "20"]) == 0
    out = capsys.readouterr().out
    assert "**steady**, 1086 m/s, not ended" in out
    assert "| 10 | 1.08 | 1071.0 | 2.63 | 3.05 | 0.86 |" in out
    assert main([str(steady), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["rows"] == measure(steady)["rows"]
    assert main([str(tmp_path)]) == 2
    assert "is not a run directory" in capsys.readouterr().err
