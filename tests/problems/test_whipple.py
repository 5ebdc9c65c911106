"""The decks of Whipple shields: how a run is read, the limit equation, the shots, and the tables of their page."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray

import hydro2d
from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from hydro2d.study.plan import cases
from problems import kept
from problems.whipple import read
from tests.rules import source

FOLDER = source.PROBLEMS / "whipple"
SHOTS, VELOCITIES = read.shots(), kept.rows(read.VELOCITIES, read.COLUMNS)


def planned(study):
    return {case.name: case for case in cases.plan(FOLDER / f"{study}.toml", quiet=True).cases}


def test_the_study_has_the_shots_of_the_table():
    """Each with its own velocity, bumper, gap and wall, and time for debris of half the velocity to arrive, plus 15 us."""
    plan = planned("whipple_shots")
    assert list(plan) == [f"{shot['half']}-{shot['shot']}" for shot in SHOTS]
    for shot in SHOTS:
        deck = decks.loads(plan[f"{shot['half']}-{shot['shot']}"].text, name="shot")
        ball, bumper, wall = deck.body
        assert ball.velocity[1] == pytest.approx(1e3 * float(shot["velocity_km_s"]))
        assert [1e3 * bumper.thickness, 1e3 * (wall.z_front - bumper.thickness), 1e3 * wall.thickness] == pytest.approx(
            [float(shot[name]) for name in ("bumper_mm", "gap_mm", "wall_mm")])
        assert deck.stop.time == pytest.approx(1e-3 * float(shot["gap_mm"]) / (0.5 * ball.velocity[1]) + 15e-6, abs=0.5e-6)


def test_a_hole_leads_from_the_front_to_the_rear():
    wall = np.zeros((6, 5))
    wall[2:4] = 1.0
    assert not read.open_through(wall)
    crater = wall.copy()
    crater[2, 0] = 0.0
    assert not read.open_through(crater)
    crater[3, 0] = 0.4  # a cell that is less than half full is open
    assert read.open_through(crater)
    off_axis = wall.copy()
    off_axis[2, 1], off_axis[3, 2] = 0.0, 0.0  # cells that touch at a corner let nothing through
    assert not read.open_through(off_axis)


def test_the_equation():
    """Values by hand at 3 and 7 km/s; linear between, continuous, and with the powers of the velocity on either side."""
    assert read.limit(7.0, 0.08, 5.08, 0.3175) == pytest.approx(0.4518, abs=5e-4)
    assert read.limit(3.0, 0.08, 5.08, 0.3175) == pytest.approx((0.3975 / (0.6 * 2.8**0.5 * 3 ** (2 / 3))) ** (18 / 19))
    ends = read.limit(3.0, 0.08, 5.08, 0.2), read.limit(7.0, 0.08, 5.08, 0.2)
    assert read.limit(4.0, 0.08, 5.08, 0.2) == pytest.approx(0.75 * ends[0] + 0.25 * ends[1])
    assert read.limit(14.0, 0.08, 5.08, 0.2) / ends[1] == pytest.approx(2 ** (-2 / 3))
    assert read.limit(1.5, 0.08, 5.08, 0.2) / ends[0] == pytest.approx(2 ** (12 / 19))


def test_how_a_run_is_read(monkeypatch, tmp_path):
    deck = decks.load(FOLDER / "shield.toml")
    fraction = np.zeros((1, 1, 4, 3))
    fraction[0, 0, 1:3] = 1.0
    fields = xarray.Dataset({"volume_fraction": (("time", "body", "z", "r"), fraction)},
                            coords={"time": [0.0], "body": ["wall"], "z": np.arange(4.0), "r": np.arange(3.0)})
    run = SimpleNamespace(deck=deck, fields=fields, summary=hydro2d.Summary(
        stop_reason="end time", trustworthy=False, method="2026-11-29", targets={"wall": {"debris": {"mass_kg": 48e-6}}}))
    monkeypatch.setattr(read.hydro2d, "open_run", lambda directory: run)
    row = dict(zip(read.COLUMNS, read.of_run(tmp_path), strict=True))
    assert [row[name] for name in read.COLUMNS[1:]] == ["7.21", "0.84", "50.8", "1.45", 8, "no", "48.00", "no", "2026-11-29"]
    assert read.BALL_MASS == pytest.approx(47.1, abs=0.1)
    assert read.defeated(row)
    assert not read.defeated({**row, "behind_mg": "47.0"})
    run.summary = hydro2d.Summary(stop_reason="interrupted (SIGTERM)")
    with pytest.raises(ValueError, match="the run has not ended"):
        read.of_run(tmp_path)


def test_kept_runs_are_those_of_the_studies():
    plan = planned("whipple_shots")
    assert {row["case"] for row in kept.rows(read.KEPT, read.COLUMNS)} == set(plan)
    assert {row["case"] for row in VELOCITIES} == set(planned("whipple_velocities"))
    assert {row["case"] for row in kept.rows(read.CHOICES, read.COLUMNS)} == set(planned("whipple_choices"))
    for shot in SHOTS:
        for row in shot["computed"]:
            same = ("velocity_km_s", "bumper_mm", "gap_mm", "wall_mm")
            assert [float(row[name]) for name in same] == pytest.approx([float(shot[name]) for name in same])


def test_statements_of_the_page():
    """Behind long gaps the mass tells the outcomes; 23 shots are not trusted, all behind 12.7 mm among them."""
    far = [shot for shot in SHOTS if float(shot["gap_mm"]) > 20.0]
    assert read.right(far, read.lost_a_third) == "20 of 23"
    assert (read.right(SHOTS, read.lost_a_third), read.right(SHOTS, read.predicted)) == ("35 of 53", "34 of 53")
    doubted = [shot for shot in SHOTS if shot["computed"][0]["trusted"] == "no"]
    assert len(doubted) == 23
    assert {shot["shot"] for shot in SHOTS if shot["gap_mm"] == "12.7"} < {shot["shot"] for shot in doubted}
    assert {row["trusted"] for row in VELOCITIES} == {"yes"}
    assert sum(row["trusted"] == "no" for row in kept.rows(read.CHOICES, read.COLUMNS)) == 16
    near = [float(shot["computed"][0]["behind_mg"]) for shot in SHOTS if shot["gap_mm"] == "6.4"]
    assert (min(near), max(near)) == pytest.approx((150.0, 480.0), abs=5.0)


@pytest.mark.thorough
@pytest.mark.xfail(reason="no half-step pressure where void is more than a tenth of a cell, even at 200 GPa; wanted: no cell "
                          "that is too cold, got: -5.6 MJ/kg (README)", strict=True, raises=AssertionError)
def test_no_cell_gets_too_cold_where_debris_closes_on_the_wall():
    """Shot 2018, up to 3.2 us."""
    simulation = Simulation(decks.loads(planned("whipple_shots")["A-2018"].text, name="shot"))
    simulation.run(until=3.2e-6)
    assert [doubt for doubt in simulation.doubts() if "too cold" in doubt] == []


def test_the_tables_of_the_page_are_those_of_the_kept_results(capsys):
    page = (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()
    assert read.main([]) == 0
    for line in filter(None, capsys.readouterr().out.splitlines()):
        assert line in page
