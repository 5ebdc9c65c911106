"""The benchmark measures what it claims; its numbers depend on the machine, their relations do not."""

import json

import pytest

from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.running import bench

SMALL = ("mesh.r=[{to=\"16.891 mm\", cells=10}]", 'mesh.z=[{to="0 mm", cells=40}, {to="540 mm", cells=100}]')


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
    assert {"close_cells", "between kernels"} <= case["phases"].keys()
    assert list(result["triad_gb_s"]) == ["1"]
    assert json.loads(json.dumps(result))["provenance"]["packages"]["numba"] in "\n".join(said)
    assert not jit.timings


def test_whole_shot(quick):
    options = (*SMALL, "stop.cycles=12", "output.vtk_interval=100 ns", "output.history_interval=10 ns")
    result = bench.collect([], threads=[1], shot=True, shot_overrides=options, say=lambda line: None)
    (case,) = result["cases"]
    assert case["name"] == "whole shot"
    assert (case["cells"], case["cycles"], case["stop_reason"]) == (1400, 11, "number of cycles")
    assert case["wall_s"] == pytest.approx(case["ns_per_cell_cycle"] * 1e-9 * 1400 * 11)
    assert case["peak_memory_bytes"] > 5e7
    assert {"history", "fields", "stop checks"} <= case["shares_beside_cycles"].keys()
    assert sum(case["shares_beside_cycles"].values()) < 1.0
