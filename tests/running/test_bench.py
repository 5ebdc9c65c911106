"""The benchmark measures what it claims; its numbers depend on the machine, their relations do not."""

import json

import pytest

from hydro2d import jit
from hydro2d.cli.main import call
from hydro2d.deck import deck
from hydro2d.running import bench


def by_name(name):
    return next(case for case in bench.CASES if case.name == name)


@pytest.fixture
def quick(monkeypatch):
    monkeypatch.setattr(bench, "TRIAD_SHAPE", (20, 400))


@pytest.mark.parametrize("case", bench.CASES, ids=lambda case: case.name)
def test_decks(case):
    """Every deck loads; the numbers of cells and of materials are those in the names."""
    loaded = case.deck()
    assert loaded.numerics.active_region is False
    r, z = deck.edges(loaded)
    cells = (len(r) - 1) * (len(z) - 1)
    number, unit = case.name.split()[0], case.name.split()[1]
    if case.name.endswith("cells"):
        assert cells == pytest.approx(float(number) * {"thousand": 1e3, "million": 1e6}[unit], rel=0.03)
    else:
        assert cells == pytest.approx(131325, rel=0.003)
    if case.name.endswith("materials"):
        assert len(deck.slots(loaded)) == int(number)
    if case.name == "pure hydrodynamic":
        assert not any(loaded.materials[body.material].has_strength for body in loaded.body)
    assert case.warm % bench.CYCLES == bench.timed_cycles(case, cells) % bench.CYCLES == 0


def test_one_case(quick):
    said = []
    result = bench.collect([by_name("10 thousand cells")], threads=[1], cycles=2, say=said.append)
    (case,) = result["cases"]
    assert case["threads"] == 1
    assert case["triad_updates_per_cell_cycle"] == pytest.approx(case["ns_per_cell_cycle"] * case["triad_gb_s"] / 24)
    assert sum(case["phases"].values()) == pytest.approx(case["ns_per_cell_cycle"])
    assert {"close_cells", "Python between"} <= case["phases"].keys()
    assert list(result["triad_gb_s"]) == ["1"]
    assert json.loads(json.dumps(result))["provenance"]["packages"]["numba"] in "\n".join(said)
    assert not jit.timings


@pytest.mark.parametrize("threads", [1, pytest.param(2, marks=pytest.mark.thorough)])
def test_whole_shot(quick, threads):
    """The phases add up to the whole, and the groups."""
    if threads > jit.max_threads():
        pytest.skip("one thread only")
    shot = deck.load(bench.DECK, ["stop.cycles=30", "output.vtk_interval=500 ns", "output.history_interval=50 ns"])
    said = []
    result = bench.collect([], threads=[threads], shot=shot, say=said.append)
    (case,) = result["cases"]
    assert case["name"] == "whole shot, hemi_5083_1086_quick"
    assert (case["cells"], case["cycles"], case["stop_reason"]) == (5372, 30, "number of cycles")
    assert case["wall_s"] == pytest.approx(case["ns_per_cell_cycle"] * 1e-9 * 5372 * 30)
    assert sum(case["phases"].values()) == pytest.approx(case["ns_per_cell_cycle"])
    assert case["peak_memory_bytes"] > 5e7
    beside = {"outputs", "compilation", "set up", "stop checks and the end", "Python between"}
    assert case["groups_s"].keys() == beside | {"cells", "mixed cells", "contact"}
    assert sum(case["groups_s"].values()) == pytest.approx(case["wall_s"])
    assert {"cells: close_cells", "mixed cells: deform_mixed", "contact: find_contact"} | beside <= case["phases"].keys()
    assert min(case["groups_s"][name] for name in ("cells", "mixed cells", "contact", "outputs")) > 0.0
    assert case["groups_s"]["cells"] > case["groups_s"]["contact"]
    assert "set up " in "\n".join(said)
    assert not jit.timings


def test_the_fastest_batch_counts(monkeypatch):
    clock = iter([0.0, 5.0, 5.0, 8.0, 10.0, 11.0, 20.0, 24.0, 30.0, 32.0])
    monkeypatch.setattr(bench.time, "perf_counter", lambda: next(clock))
    assert bench._least(lambda: None) == 1.0


def test_a_deck_without_shot_is_refused(capsys):
    assert call(["bench", "rod.toml"]) == 2
    assert capsys.readouterr().err == "hydro2d: rod.toml: a deck is measured with --shot; without it, omit the deck\n"
