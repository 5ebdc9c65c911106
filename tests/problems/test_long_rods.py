"""Tungsten rods into steel: Odermatt's fit, how the depth builds up, the kept results and the pages that quote them."""

import csv
import re

import numpy as np
import pytest

from hydro2d.study.plan import cases
from problems.long_rods import depths
from tests.rules import source

FOLDER = source.PROBLEMS / "long_rods"
KEPT = {file.stem: file for file in sorted((FOLDER / "results").glob("*.csv")) if not file.stem.startswith("histories")}


@pytest.mark.parametrize(("slenderness", "ratios"), [
    (10, (0.58, 0.79, 0.88, 0.97, 1.11, 1.23)), (20, (0.46, 0.63, 0.70, 0.77, 0.89, 0.98)),
    (30, (0.43, 0.59, 0.66, 0.725, 0.83, 0.92))])
def test_odermatts_fit(slenderness, ratios):
    """Against numbers worked out by hand for a Brinell hardness of 270 and densities of 17.6 and 7.85 g/cm^3."""
    computed = [depths.odermatt(1e3 * v, slenderness, 270.0, 17600.0, 7850.0) for v in (1.2, 1.4, 1.5, 1.6, 1.8, 2.0)]
    assert computed == pytest.approx(ratios, abs=0.006)


def history(length, u, v, steps=400):
    """A rod that is worn at v - u to 5 mm and then stops within the depth of another 3 mm; 5 mm thick."""
    duration = (length - 5e-3) / (v - u)
    time = np.linspace(0.0, 1.5 * duration, steps)
    worn = np.minimum(time, duration)
    end = 3e-3 * np.clip((time - duration) / (0.4 * duration), 0.0, 1.0)
    depth = u * worn + end
    depth[time > 1.45 * duration] -= 1e-4
    return {"time": time, "penetration_depth_m": depth, "rod_length_m": length - (v - u) * worn,
            "rod_tail_velocity_m_s": np.where(time < duration, v, 0.0)}


def test_where_the_depth_comes_from():
    parts = depths.measured(history(50e-3, 600.0, 1400.0), 5e-3)
    assert parts["slope"] == pytest.approx(600.0 / 800.0, rel=1e-3)
    assert (parts["u"], parts["v"]) == (pytest.approx(600.0, rel=1e-3), 1400.0)
    assert parts["depth"] == pytest.approx(0.75 * 45e-3 + 3e-3, rel=1e-6), "the largest depth, not the last"
    assert parts["end"] == pytest.approx((0.75 * 15.0 + 3.0) / 5.0, abs=0.05)
    assert parts["left"] == pytest.approx(5e-3)


def test_a_rod_that_is_hardly_worn_has_no_steady_part():
    parts = depths.measured(history(20e-3, 100.0, 900.0), 5e-3)
    assert np.isnan(parts["slope"])
    assert np.isnan(parts["u"])


@pytest.mark.parametrize("name", KEPT)
def test_kept_results_are_cases_of_their_study(name):
    planned = {case.name: case.values for case in cases.plan(FOLDER / f"{name}.toml", quiet=True).cases}
    results = depths.read(KEPT[name])
    assert len({result.name for result in results}) == len(results) > 0
    for result in results:
        labels = planned[result.name.split("/")[0]]
        assert {axis: result.labels[axis] for axis in labels} == labels


@pytest.mark.parametrize("name", KEPT)
def test_kept_results_are_written_as_they_were_read(name, tmp_path):
    depths.keep(depths.read(KEPT[name]), tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_text() == KEPT[name].read_text()


def test_the_tables_of_the_pages_are_those_of_the_kept_results(capsys):
    assert depths.main(["--pages", "--check"]) == 0, capsys.readouterr().out
    shown = {found for page in depths.PAGES for found in re.findall(r"<!-- (\S+) -->", page.read_text(encoding="utf-8"))}
    assert shown - {"end"} == set(depths.TABLES)
    assert set(KEPT) == set(depths.STUDIES)


RATIO = {(each.slenderness, each.velocity): each.ratio for each in depths.of_study("velocities")}
CHANGE = {(each.others, each.velocity): each.ratio / RATIO[20, each.velocity] - 1.0 for each in depths.of_study("choices")}


def off(results):
    """Differences of depths from Odermatt's fit."""
    return [each.ratio / depths.odermatt(each.velocity, each.slenderness, depths.brinell(each), *depths.DENSITIES) - 1.0
            for each in results]


def test_statements_of_the_page_on_velocity_and_length():
    """In the fit the length takes 20 % at every velocity; in the runs a third from slow rods, and little from fast ones."""
    results = depths.of_study("velocities")
    assert max(map(abs, off([each for each in results if each.slenderness == 10 and each.velocity >= 1500.0]))) < 0.075
    assert max(map(abs, off([each for each in results if each.slenderness == 20 and 1500.0 <= each.velocity < 1700.0]))) < 0.075
    assert off([each for each in results if each.velocity == 1200.0]) == pytest.approx([-0.12, -0.24, -0.34], abs=0.005)
    assert off([each for each in results if each.velocity == 2000.0]) == pytest.approx([-0.01, 0.17, 0.22], abs=0.005)
    lost = [1.0 - RATIO[20, each] / RATIO[10, each] for each in (1000.0, 1200.0, 1500.0, 1800.0, 2000.0)]
    assert lost == pytest.approx([0.34, 0.31, 0.21, 0.08, 0.06], abs=0.006)


def test_statements_of_the_page_on_the_head_of_the_rod():
    """A head that softens or fails goes deeper; contact, tension and a mesh that stands hardly matter."""
    changes = {"melts at 1723 K": (0.21, 0.08), "law of Y925": (0.13, 0.11), "law of a sintered alloy": (0.09, 0.09),
               "Steinberg-Guinan": (-0.15, -0.16), "fails at a strain of 1.5": (0.15, 0.07), "damage": (0.04, 0.0),
               "no sliding": (0.03, 0.05), "no tensile failure": (0.0, 0.0), "mesh that stands": (0.01, 0.0)}
    for choice, (slow, fast) in changes.items():
        assert (CHANGE[choice, 1200.0], CHANGE[choice, 1500.0]) == pytest.approx((slow, fast), abs=0.006), choice
    assert max(off(each for each in depths.of_study("choices") if each.velocity == 1200.0)) == pytest.approx(-0.08, abs=0.006)


def test_statements_of_the_page_on_the_steel():
    by_steel = {}
    for each, other in zip(depths.of_study("hardness"), off(depths.of_study("hardness")), strict=True):
        by_steel.setdefault(each.labels["steel"], []).append(other)
    ends = {steel: (min(each), max(each)) for steel, each in by_steel.items()}
    assert ends["fit Rc 38"] == pytest.approx((0.07, 0.09), abs=0.006)
    assert ends["fit Rc 32"] == pytest.approx((0.15, 0.15), abs=0.006)
    assert ends["BHN 230"] == pytest.approx((0.10, 0.17), abs=0.006)
    assert (ends["BHN 350"][0], ends["BHN 270"][1]) == pytest.approx((0.05, 0.12), abs=0.006)


def test_statements_of_the_page_on_the_mesh_and_chance():
    """L/D = 10 has nearly converged on 6.5 cells, L/D = 20 has not; members differ by 0.3 %."""
    ratio = {(each.cells, each.slenderness, each.velocity): each.ratio for each in depths.of_study("meshes")}
    gained = {(length, velocity): [ratio[12.5, length, velocity] / ratio[cells, length, velocity] - 1.0 for cells in (6.5, 8.5)]
              for length in (10, 20) for velocity in (1200.0, 1500.0)}
    assert [gained[10, 1200.0][0], gained[10, 1500.0][0]] == pytest.approx([0.03, 0.01], abs=0.005)
    assert [gained[20, 1200.0], gained[20, 1500.0]] == [pytest.approx([0.12, 0.06], abs=0.005),
                                                       pytest.approx([0.09, 0.04], abs=0.005)]
    lost = [1.0 - ratio[cells, 20, each] / ratio[cells, 10, each] for cells in (12.5, 6.5) for each in (1200.0, 1500.0)]
    assert lost == pytest.approx([0.25, 0.14, 0.31, 0.21], abs=0.006)
    members = {}
    for each in depths.of_study("chance"):
        members.setdefault(each.velocity, []).append(each.ratio)
    assert {len(each) for each in members.values()} == {4}
    assert all(max(each) / min(each) - 1.0 < 0.0033 for each in members.values())


def test_the_histories_are_those_of_kept_cases():
    known = {result.name for file in KEPT.values() for result in depths.read(file)}
    for file in (FOLDER / "results").glob("histories*.csv"):
        with open(file, encoding="utf-8", newline="") as text:
            rows = list(csv.DictReader(text))
        assert {row["case"] for row in rows} <= known
        assert tuple(rows[0]) == depths.HISTORY


def test_a_file_of_something_else_is_refused(capsys):
    assert depths.main([str(source.PROBLEMS / "perforation" / "weldox_460e.csv")]) == 2
    assert "no file of results: it has no column case" in capsys.readouterr().err


def test_the_figures(tmp_path, capsys):
    picture = tmp_path / "p.png"
    assert depths.main([str(KEPT["velocities"]), "--figure", str(picture)]) == 0
    assert picture.read_bytes()[:4] == b"\x89PNG"
    parts = tmp_path / "parts.png"
    histories = str(FOLDER / "results" / "histories.csv")
    assert depths.main([histories, "--parts", str(parts), "--cases", "10_1.5km-s", "20_1.5km-s"]) == 0
    assert parts.read_bytes()[:4] == b"\x89PNG"
    assert depths.main([histories, "--parts", str(parts), "--cases", "10_1.6km-s"]) == 2
    assert "has no case 10_1.6km-s" in capsys.readouterr().err
