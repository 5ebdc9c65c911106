"""Where and when two runs diverge: growth times, the first cell, refusals. The runs are made up, with known growth."""

import csv
import shutil

import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.output import vtk
from hydro2d.output.history import History
from hydro2d.results.reading import Results
from hydro2d.study.report import divergence
from tests.study import fake

#: growth time in s, first difference in m, and times of dumps
GROWTH, FIRST = 4e-6, 1e-9
TIMES = np.linspace(0.0, 60e-6, 13)
R, Z = np.linspace(0.0, 4e-3, 5), np.linspace(-3e-3, 3e-3, 7)
NAMES = ("Volume Fraction for rod", "Volume Fraction for plate", "Pressure [Pa]", "Velocity [m/s]")


def write_run(directory, grown=False, cells=4, late=0.0, wide=0.0):
    """A run whose depth and whose pressure in cell (2, 3) differ, if `grown`, by a difference that grows exponentially."""
    fake.write_run(directory, rows=2)
    history = History(directory / "history.h5")
    for time in np.linspace(0.0, 60e-6, 601):
        apart = FIRST * np.exp(time / GROWTH) * grown
        history.append({"time": time, "cycle": 1, "penetration_depth_m": 1000.0 * time + apart,
                        "rod_length_m": 0.1, "rod_tail_velocity_m_s": 1000.0, "regime": "rigid"})
    history.write()
    entries = []
    for number, time in enumerate(TIMES + late):
        share = np.ones((6, cells))
        pressure = np.full((6, cells), 1e9)
        pressure[2, cells - 1] += 1e3 * np.exp(time / GROWTH) * grown
        fields = (share, np.zeros_like(share), pressure, np.zeros((6, cells, 3)))
        file = f"vtk/dump_{number:06d}.vtr"
        vtk.write_grid(directory / file, R[: cells + 1], Z + wide, zip(NAMES, fields, strict=True), float(time))
        entries.append((float(time), file))
    vtk.write_series(directory / vtk.SERIES["dump"], entries)
    return directory


@pytest.fixture
def runs(tmp_path):
    return write_run(tmp_path / "a"), write_run(tmp_path / "b", grown=True)


def curve(runs, name):
    curves = divergence.compare(*map(Results, runs))
    return next(each for each in curves.curves if each.name == name)


def test_the_growth_time_of_a_depth(runs):
    measured = curve(runs, "penetration_depth_m").growth(1e-2)
    assert measured.time == pytest.approx(GROWTH, rel=0.02)
    assert measured.error < 0.05 * GROWTH


def test_the_growth_time_of_a_field_and_the_cell(runs):
    measured = curve(runs, "pressure")
    assert measured.growth(0.9).time == pytest.approx(GROWTH, rel=0.02)
    assert {(place.row, place.column, place.body) for place in measured.places[1:]} == {(2, 3, "rod")}
    assert (measured.places[-1].z, measured.places[-1].r) == pytest.approx((-0.5e-3, 3.5e-3))


def test_the_time_at_which_a_size_is_exceeded(runs):
    """The depth ends at 0.06 m: the difference is 1 % of its largest value, 6.33 cm, after GROWTH ln(0.01 scale / FIRST)."""
    measured = curve(runs, "penetration_depth_m")
    expected = GROWTH * np.log(0.01 * measured.scale / FIRST)
    assert measured.time[measured.first_beyond(0.01)] == pytest.approx(expected, abs=1e-7)
    assert measured.first_beyond(0.9) is None


def test_equal_quantities_have_no_growth(runs):
    measured = curve(runs, "rod_length_m")
    assert (measured.growth(0.01), measured.first_beyond(1e-12)) == (None, None)


@pytest.mark.parametrize("difference", [lambda t: 1e-3 + 0.0 * t, lambda t: np.where(t > 2e-5, 8e-3, 2e-5), lambda t: 80.0 * t])
def test_a_level_a_jump_and_a_straight_line_are_no_exponential_growth(difference):
    time = np.linspace(1e-6, 1e-4, 200)
    assert divergence.Curve("x", "history", 1.0, time, difference(time)).growth(0.01) is None
    assert divergence.Curve("x", "history", 1.0, time, 1e-5 * np.exp(time / 1e-5)).growth(0.01).time == pytest.approx(1e-5)


def test_the_printed_drawn_and_written_results(runs, tmp_path, capsys):
    files = [tmp_path / "apart.png", tmp_path / "apart.csv"]
    assert call(["diverge", *map(str, runs), "--size", "0.001", "-o", str(files[0]), "--csv", str(files[1])]) == 0
    shown = capsys.readouterr().out
    assert "the fields first differ by more than 0.001 in the dump of" in shown
    assert "pressure, in rod at z = -0.5 mm, r = 3.5 mm (cell 2, 3)" in shown
    assert files[0].read_bytes()[:4] == b"\x89PNG"
    with open(files[1], newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["quantity"] for row in rows} >= {"penetration_depth_m", "pressure"}
    assert {row["cell_body"] for row in rows if row["kind"] == "field"} == {"rod"}


def test_keys_in_which_the_decks_differ_are_reported(tmp_path, capsys):
    one = write_run(tmp_path / "a")
    other = shutil.copytree(one, tmp_path / "b")
    text = fake.deck_text("body.rod.velocity=1086.0 m/s", "numerics.initial_dt_factor=0.0999999999")
    (other / "deck.toml").write_text(text)
    assert call(["diverge", str(one), str(other)]) == 0
    shown = capsys.readouterr().out
    assert "numerics.initial_dt_factor: 0.1 and 0.0999999999" in shown
    assert "no field differs by more than 0.01 of its largest value" in shown


def test_dumps_at_slightly_other_times_are_compared_with_a_note(tmp_path, capsys):
    one, other = write_run(tmp_path / "a", grown=True), write_run(tmp_path / "b", grown=True, late=2e-7)
    assert call(["diverge", str(one), str(other), "--size", "0.001"]) == 0
    assert "the times of the dumps differ, which alone makes up to" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"cells": 3}, "one mesh has 6 x 4 cells, the other 6 x 3"),
        ({"wide": 2e-4}, "the meshes are 0.2 cells apart"),
        ({"late": 2.4e-6}, "no dumps of the same time"),
    ],
)
def test_fields_that_cannot_be_compared_are_reported(tmp_path, capsys, change, said):
    one, other = write_run(tmp_path / "a"), write_run(tmp_path / "b", **change)
    assert call(["diverge", str(one), str(other)]) == 0
    assert f"the fields are not compared: {said}" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--size", "0"], "--size 0: must lie between 0 and 1"),
        (["--size", "nan"], "--size nan: must lie between 0 and 1"),
        (["--field", "presure"], '--field: unknown field "presure"; did you mean "pressure"'),
        (["--field", "temperature"], "the dumps have no temperature; output.fields of the deck sets which fields are written"),
        (["--field", "stress_tt"], "; up to version 0.3, stress_tt was the name of deviator_tt"),
        (["-o", "x.gif"], "x.gif is a film"),
    ],
)
def test_bad_arguments_get_one_message(runs, capsys, arguments, said):
    assert call(["diverge", *map(str, runs), *arguments]) == 2
    shown = capsys.readouterr().err
    assert said in shown
    assert shown.count("\n") == 1


def test_one_run_given_twice_or_none_is_refused(runs, capsys, tmp_path):
    assert call(["diverge", str(runs[0]), str(runs[0])]) == 2
    assert "give two runs; this one was given twice" in capsys.readouterr().err
    assert call(["diverge", str(runs[0]), str(tmp_path / "nothing")]) == 2
    assert "is not a run directory" in capsys.readouterr().err


def test_another_shot_is_refused(tmp_path, capsys):
    one = write_run(tmp_path / "a")
    other = shutil.copytree(one, tmp_path / "b")
    (other / "deck.toml").write_text((one / "deck.toml").read_text().replace('name = "plate"', 'name = "wall"'))
    assert call(["diverge", str(one), str(other)]) == 2
    assert "are not of one shot: only one has body.plate, body.wall" in capsys.readouterr().err
