"""The decks of spall: the kept results, the table of their page, and how a pull-back is read."""

import numpy as np
import pytest

from problems.spall import read
from tests.rules import source

FOLDER = source.PROBLEMS / "spall"
KEPT = read.kept()
PULL_BACK = {(row["shot"], row["failure"], int(row["cells"])): float(row["pull_back_m_s"]) for row in KEPT}


def test_the_table_of_the_page_is_that_of_the_kept_results():
    page = (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()
    shown = [line for line in page if line.startswith("| `") and line.count("|") == 9]
    assert shown == read.table(KEPT)[2:]
    assert set(PULL_BACK) == {(shot, failure, cells) for shot in ("flyer", "pulse") for failure in ("cracks", "plain")
                              for cells in (100, 200, 400, 800)}


def off(shot, failure, cells):
    """Relative difference of the pull-back from that on 400 cells."""
    return PULL_BACK[shot, failure, cells] / PULL_BACK[shot, failure, 400] - 1.0


def test_statements_of_the_page_on_the_meshes():
    """From 200 cells on the flyer is within 1 %; the pulse is acoustic with cracks, and 4 % less with the plain model."""
    for failure in ("cracks", "plain"):
        assert max(abs(off("flyer", failure, cells)) for cells in (200, 800)) < 0.01
    acoustic = 2.0 * 1.2e9 / (2703.0 * 5240.0)
    assert [PULL_BACK["pulse", "cracks", cells] for cells in (200, 400, 800)] == pytest.approx([acoustic] * 3, rel=0.015)
    assert 0.03 < off("pulse", "cracks", 100) < 0.06
    assert -0.04 < off("pulse", "plain", 100) < -0.03
    assert [PULL_BACK["pulse", "plain", cells] for cells in (200, 400, 800)] == pytest.approx([0.96 * acoustic] * 3, rel=0.005)


@pytest.mark.xfail(reason="wanted: within 1 % of 400 cells, as until 2026-11-26; got: +3.6 % with cracks, +1.9 % without; "
                          "the shock rings, which explains about half", strict=True, raises=AssertionError)
@pytest.mark.parametrize("failure", ["cracks", "plain"])
def test_the_flyer_on_100_cells(failure):
    assert abs(off("flyer", failure, 100)) < 0.01


def test_the_runs_are_trusted_and_of_one_method():
    assert {(row["trusted"], row["method"]) for row in KEPT} == {("yes", "2026-11-29.4")}, "the page says so"


def test_how_a_pull_back_is_read():
    """The first fall that ends in a rise; ripples do not count."""
    velocity = np.array([0.0, 400.0, 300.0, 310.0, 250.0, 260.0, 330.0, 200.0, 500.0 - 120.0])
    assert read.pull_back(velocity) == (400.0, 250.0, 380.0)
    with pytest.raises(ValueError, match="nothing has spalled"):
        read.pull_back(np.array([0.0, 400.0, 300.0, 310.0]))
