"""Ten problems from handbooks: the kept values are those of the README, and the decks still give them."""

import numpy as np
import pytest

from problems.handbook import compare
from tests.rules import source

FOLDER = source.PROBLEMS / "handbook"
KEPT = compare.obtained()
ROWS = {(row["deck"], row["quantity"]): row for row in compare.expected()}
#: quantities beyond their bounds, and why
BEYOND = {("cole", "pressure at 1 m"): "22 % low: the front is three cells of 6 mm thick in a wave of 140 mm; 16 % on 3 mm"}


def off(key: tuple[str, str], obtained: str) -> float:
    """Difference from what is expected over its bound."""
    row = ROWS[key]
    return abs(float(obtained) / float(row["expected"]) - 1.0) / (0.01 * float(row["bound"]))


def test_the_readme_shows_the_kept_values():
    page = (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()
    assert [line for line in page if line.startswith("| `") and line.count("|") == 8] == compare.table(KEPT)
    assert list(KEPT) == list(ROWS)
    assert {row["trusted"] for row in KEPT.values()} == {"yes"}
    assert {deck for deck, _ in ROWS} == set(compare.READ) == {file.stem for file in FOLDER.glob("*.toml")}


@pytest.mark.parametrize("key", [
    pytest.param(key, marks=[pytest.mark.xfail(strict=True, reason=BEYOND[key])] if key in BEYOND else []) for key in ROWS],
    ids=", ".join)
def test_what_a_handbook_says(key):
    assert off(key, KEPT[key]["obtained"]) <= 1.0


@pytest.mark.slow
@pytest.mark.parametrize("name", compare.READ)
def test_a_deck_gives_what_is_kept(name, tmp_path):
    for row in compare.rows_of(name, tmp_path):
        kept = KEPT[name, row["quantity"]]
        assert float(row["obtained"]) == pytest.approx(float(kept["obtained"]), rel=0.02)
        assert row["trusted"] == kept["trusted"]


def test_a_swing_has_its_mean_and_period():
    time = np.linspace(0.0, 400e-6, 401)
    mean, period = compare.swing(time, 3.0 - 2.0 * np.cos(2.0 * np.pi * time / 190e-6), 200e-6)
    assert (mean, period) == (pytest.approx(3.0), pytest.approx(190e-6, rel=1e-3))
