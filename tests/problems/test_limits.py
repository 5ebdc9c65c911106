"""Ballistic limits and holes beside the kept runs."""

import math

import pytest

import hydro2d
from hydro2d.penetration import lambert_jonas
from problems import kept
from problems.perforation import limits
from tests.rules import source


def rows(label, cells, limit, velocities):
    """Kept rows of runs on the curve of Recht and Ipson."""
    (one, *_) = kept.rows(limits.HERE / "results/limits_ap_core.csv", ("plate", "velocity"))
    left = [lambert_jonas.residual_velocity(velocity, limit_velocity=limit) for velocity in velocities]
    return [one | {"plate": label, "velocity": f"{velocity} m/s", "cells_across": cells, "perforated": after > 0.0,
                   "residual_velocity_m_s": after, "setup": f"{velocity:06.0f}{10 * cells:03.0f}{len(label):03d}"}
            for velocity, after in zip(velocities, left, strict=True)]


def test_a_limit_is_that_of_the_residual_velocities(tmp_path, monkeypatch):
    """On each mesh and with each input apart, between the runs that were stopped and that went through."""
    found = [*rows("as it stands", 8.5, 500.0, (450.0, 480.0, 520.0, 560.0, 640.0, 700.0)),
             *rows("no damage", 8.5, 550.0, (560.0, 640.0)), *rows("12.5 cells", 12.5, 490.0, (480.0, 520.0, 560.0))]
    (tmp_path / "results").mkdir()
    kept.write(tmp_path / "results/limits_gun.csv", list(found[0]), found)
    monkeypatch.setattr(limits, "HERE", tmp_path)
    first, other, finer = limits.limits("gun")
    assert [each.limit for each in (first, other, finer)] == pytest.approx([500.0, 550.0, 490.0], rel=1e-3)
    assert (first.stopped, first.through, first.runs, first.cells) == (480.0, 520.0, 6, 8.5)
    assert (other.stopped, other.through, other.label) == (None, 560.0, "no damage")
    assert [each.label for each in limits.meshes("gun")] == ["as it stands", "12.5 cells"], "another input is no mesh"


def test_the_shots_have_decks_studies_and_kept_runs():
    for each in limits.measured():
        deck = hydro2d.Deck.from_file(limits.HERE / f"{each.deck}.toml")
        assert f'deck = "{each.deck}.toml"' in (limits.HERE / f"limits_{each.deck}.toml").read_text(encoding="utf-8")
        assert deck.stop.perforation == "tail"
        assert limits.limits(each.deck)[0].limit > 0.0


def test_areas_of_holes_are_those_of_the_formula():
    """The formula stands in the head of the file."""
    for hole in limits.holes():
        limit = 0.5794 * hole.thickness ** 1.4004
        area = 10.3963 * (hole.thickness / 1.778) ** 0.4757 * math.tanh(hole.velocity / limit - 1.0) ** 0.4682
        assert hole.measured == pytest.approx(area, abs=6e-4)
    (shot,) = (each for each in limits.measured() if each.deck == "psaap")
    assert shot.limit == pytest.approx(1e3 * 0.5794 * 2.667**1.4004, abs=6e-3)


def test_the_page_has_the_tables():
    page = (source.PROBLEMS / "perforation/README.md").read_text(encoding="utf-8")
    for line in limits.lines():
        assert line in page, "python -m problems.perforation.limits prints it"
