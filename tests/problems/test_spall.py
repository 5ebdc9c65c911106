"""The decks of spall: what was kept of their runs, the table that their page shows, and how a pull-back is read."""

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
                              for cells in (100, 200, 400)}


def off(shot, failure):
    """By how much the pull-backs on 100 and 200 cells differ from that on 400."""
    finest = PULL_BACK[shot, failure, 400]
    return max(abs(PULL_BACK[shot, failure, cells] / finest - 1.0) for cells in (100, 200))


@pytest.mark.parametrize("shot", ["flyer", "pulse"])
def test_with_cracks_the_pull_back_does_not_depend_on_the_mesh(shot):
    assert off(shot, "cracks") < 0.03


def test_how_a_pull_back_is_read():
    """The first fall that ends in a rise; ripples count nothing."""
    velocity = np.array([0.0, 400.0, 300.0, 310.0, 250.0, 260.0, 330.0, 200.0, 500.0 - 120.0])
    assert read.pull_back(velocity) == (400.0, 250.0, 380.0)
    with pytest.raises(ValueError, match="nothing has spalled"):
        read.pull_back(np.array([0.0, 400.0, 300.0, 310.0]))
