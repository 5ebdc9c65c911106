"""Meshes with scatter: which results are extrapolated, which are not and why, and how the mesh of a deck is refined."""

import dataclasses
import json

import numpy as np
import pytest

import hydro2d
from hydro2d.base.errors import DeckError
from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.deck import identity
from hydro2d.study.ensemble import convergence, extrapolation
from hydro2d.study.ensemble.contents import collect
from hydro2d.study.plan import members, meshes
from hydro2d.study.records import study_directory
from tests.study import fake

SHOT = "problems/cth_nose_shape/hemi_5083_1086_quick.toml"
CELLS = (5.5, 8.5, 12.5)


def limit(means, scatter, count=4, seed=0, cells=CELLS):
    """The limit of made-up members."""
    chance = np.random.default_rng(seed)
    samples = [mean + scatter * chance.standard_normal(count) for mean in means]
    return extrapolation.limit(list(map(extrapolation.level, cells, samples)), samples)


@pytest.mark.parametrize(("order", "factor"), [(1.0, 10.0), (2.0, 60.0)])
def test_the_interval_covers_the_true_value(order, factor):
    """45 + factor / cells^order with scatter: a 90 % interval covers 45 in at least 32 of 40 repeats, and is not too wide."""
    estimates = [limit([45.0 + factor * cells**-order for cells in CELLS], 0.02, seed=seed) for seed in range(40)]
    given = [each for each in estimates if each.value is not None]
    assert len(given) >= 36
    assert sum(each.low <= 45.0 <= each.high for each in given) >= 0.8 * len(given)
    assert np.median([each.order for each in given]) == pytest.approx(order, rel=0.2)
    assert np.median([each.high - each.low for each in given]) < abs(factor * CELLS[-1] ** -order)


def test_without_scatter_it_is_richardson():
    estimate = limit([45.0 + 10.0 / cells for cells in (4, 8, 16)], 0.0, cells=(4, 8, 16))
    assert (estimate.value, estimate.order) == pytest.approx((45.0, 1.0), abs=0.01)


@pytest.mark.parametrize(("means", "scatter", "said"), [
    ((45, 47, 44), 0.02, "up and down"), ((45, 46, 47.5), 0.02, "does not fall as fast"),
    ((42, 45, 45.2), 0.02, "coarsest mesh does not belong"),
    ((45, 45, 45), 1.0, "chance"),
])
def test_where_it_does_not_it_says_why(means, scatter, said):
    estimates = [limit(means, scatter, seed=seed) for seed in range(10)]
    assert all(each.value is None for each in estimates)
    assert sum(said in each.words for each in estimates) >= 6


def test_two_meshes_show_no_order():
    assert "three meshes" in limit((45, 46), 0.1, cells=CELLS[:2]).words


@pytest.mark.parametrize("file", [SHOT, "problems/classic/long_rod.toml", "problems/cth_nose_shape/hemi_5083_1086_layer.toml"])
def test_a_mesh_is_refined_by_one_factor(file):
    """Exactly so many cells across the rod; the ends of the mesh move by less than a cell; cells grow as fast over a length."""
    before = decks.load(file)
    _, radius = identity.with_radius(before)
    after = decks.load(file, meshes.settings(before, 11.5))
    assert identity.cells_to(after, radius) == pytest.approx(11.5, abs=1e-9)
    factor = 11.5 / identity.cells_to(before, radius)
    for old, new in zip(decks.edges(before), decks.edges(after), strict=True):
        assert len(new) - 1 == pytest.approx(factor * (len(old) - 1), rel=0.03)
        assert abs(new[-1] - old[-1]) < 1.01 * np.diff(old)[-1]
        assert np.diff(new)[-1] == pytest.approx(np.diff(old)[-1] / factor, rel=0.1)


@pytest.mark.parametrize("order", [0.3, 1.0, 1.99])
def test_grid_convergence_of_three_meshes(order):
    """Of the finest three, whatever the ratios of their cells; the index is Celik's with his factor of 1.25."""
    values = {cells: 40.0 - 3.0 * cells**-order for cells in (17, 8.5, 12.5)}
    found = hydro2d.grid_convergence(values | {2.0: 55.0})
    assert (found.order, found.value, found.words) == (pytest.approx(order), pytest.approx(40.0), "")
    assert found.index == pytest.approx(1.25 * 3.0 * 17.0**-order / values[17])
    assert str(found) == f"{100 * found.index:.2g} %, order {order:.2g}"


@pytest.mark.parametrize(("order", "told"), [(7.0, 7.0), (40.0, 20.0)])
def test_a_large_order_is_taken_as_that_of_a_smooth_solution(order, told):
    values = {cells: 40.0 - 3.0 * (cells / 2.0) ** -order for cells in (2, 3, 4)}
    found = hydro2d.grid_convergence(values)
    step = (values[4] - values[3]) / ((4 / 3) ** 2 - 1)
    assert (found.order, found.value) == (pytest.approx(told), pytest.approx(values[4] + step))
    assert found.index == pytest.approx(1.25 * abs(step) / values[4])
    assert str(found).endswith(f"order {told:.2g} (taken as 2)")


@pytest.mark.parametrize(("values", "index", "said"), [
    ({1: 1.0, 2: 2.0, 4: 1.5}, None, "up and down from mesh to mesh"), ({1: 1.0, 2: 1.1, 4: 1.3}, None, "the change grows"),
    ({1: 1.0, 2: 2.0, 4: 3.0}, None, "the change grows"), ({1: 1.0, 2: 1.0, 4: 1.0}, 0.0, "0 %, since the meshes"),
    ({1: 1.0, 2: 1.1, 4: 1.1}, 0.0, "have the same value"),
])
def test_values_without_an_order_of_convergence(values, index, said):
    found = hydro2d.grid_convergence(values)
    assert (found.order, found.index) == (None, index)
    assert said in str(found)
    with pytest.raises(ValueError, match="three meshes or more"):
        hydro2d.grid_convergence({1: values[1], 2: values[2]})


def test_a_deck_without_a_radius_has_no_cells_across():
    with pytest.raises(DeckError, match="no body of the deck has a radius"):
        meshes.settings(decks.load("problems/classic/taylor_bar.toml"), 8)


def study(folder, regimes=("rigid",) * 3, scatter=0.001):
    """Three meshes with four members each; the depth approaches 30 cm with the size of the cells."""
    place = fake.write_study(folder / "study", {"cells": {f"{cells:g}": () for cells in CELLS}}, repeats=4)
    for cells, regime in zip(CELLS, regimes, strict=True):
        for member in range(4):
            file = place / "cases" / members.name(f"{cells:g}", member) / "summary.json"
            depth = 0.30 + 0.1 / cells + scatter * 0.1 * (member - 1.5)
            fake.edit_json(file, penetration_depth_m=depth, regime=regime)
    return place


def test_scatter_and_change_are_distinguished(tmp_path):
    place = study(tmp_path)
    depth, _ = convergence.sequences(collect(study_directory.load(place)))
    assert [each.cells for each in depth.levels] == [5.5, 8.5, 12.5]
    assert depth.levels[0].mean == pytest.approx(30.0 + 10.0 / 5.5)
    assert depth.levels[0].scatter == pytest.approx(0.01 * np.std([-1.5, -0.5, 0.5, 1.5], ddof=1))
    assert depth.limit.low < 30.0 < depth.limit.high
    convergence.write(place, [depth])
    written = json.loads((place / "convergence.json").read_text())["responses"][0]
    assert written["extrapolated"]["value"] == pytest.approx(0.30, abs=2e-3)
    assert written["grid_convergence_index"] == pytest.approx(1.25 * (10.0 / 12.5) / (30.0 + 10.0 / 12.5))
    said = "\n".join(depth.lines())
    assert "extrapolated: 3" in said
    assert "from their means: 3.2 %, order 1" in said


def test_a_mean_of_several_ends_is_not_extrapolated(tmp_path):
    sequences = convergence.sequences(collect(study_directory.load(study(tmp_path, ("rigid", "rigid", "eroding")))))[0]
    assert sequences.limit.value is sequences.index is None
    assert "end in 2 ways (eroding, rigid)" in sequences.limit.words


def test_meshes_without_a_value_are_one_line(tmp_path):
    sequences = convergence.sequences(collect(study_directory.load(study(tmp_path, ("rigid", "rigid", "eroding")))))[0]
    title, _, said = dataclasses.replace(sequences, levels=[], regimes=[]).lines()
    assert title == sequences.response.title
    assert "does not extrapolate" in said


@pytest.mark.parametrize(("options", "said"), [
    (["--cells", "5.5"], "2 to 20 different numbers"), (["--cells", "5,5"], "different"),
    (["--cells", "a"], "expected numbers"), (["--cells", "5,inf"], "from 0.5 to 1000"),
    (["--cells", "3,4", "--repeats", "0"], "from 2 to 1000"),
    (["--cells", "3,4", "--set", "mesh.r=[{first='1 mm',ratio=1.1,to='80 mm'}]"], "not all of one size"),
])
def test_wrong_options_are_one_message(options, said, capsys, tmp_path):
    assert call(["converge", SHOT, "--out", str(tmp_path / "out"), *options]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


def test_check_names_the_members_on_every_mesh(capsys):
    assert call(["converge", SHOT, "--cells", "3.5,4.5", "--repeats", "2", "--check"]) == 0
    said = capsys.readouterr().out
    assert all(f"\n{name} " in said for name in ("3.5", "3.5_m1", "4.5", "4.5_m1"))
