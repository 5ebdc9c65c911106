"""The decks of explosives: the kept results, the table of their page, and Gurney's formulas."""

import pytest

from problems.explosives import read
from tests.rules import source

FOLDER = source.PROBLEMS / "explosives"
KEPT = read.kept()


def test_the_table_of_the_page_is_that_of_the_kept_results():
    page = (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()
    shown = [line for line in page if line.startswith("| `") and line.count("|") == 7]
    assert shown == read.table(KEPT)[2:]
    assert len(shown) == 14


def test_every_run_of_a_deck_was_kept():
    assert {(row["deck"], row["explosive"]) for row in KEPT} == {
        *(("cylinder", name) for name in read.CYLINDER), *((deck, name) for deck in ("plate_push", "sandwich")
                                                          for name in ("TNT", "comp_B")), ("against_a_wall", "TNT")}


def off(quantity, *explosives):
    """Differences from the expected values, of some explosives or of all."""
    return [float(row["obtained"]) / float(row["expected"]) - 1.0 for row in KEPT
            if row["quantity"] == quantity and row["explosive"] in (explosives or read.GURNEY)]


def test_statements_of_the_page_on_the_differences():
    """Gurney within 5 %, the wall's pressure within half a per cent."""
    finals = off("final velocity")
    assert len(finals) == 7
    assert max(map(abs, finals)) < 0.05
    assert abs(*off("pressure at the wall")) < 5e-3


SLOWER = pytest.mark.xfail(reason="wanted: 4.5 % at most, as until 2026-11-29; got: 4.6 %", strict=True, raises=AssertionError)


@pytest.mark.parametrize(("explosive", "distance"), [
    pytest.param(explosive, distance, marks=[SLOWER] if (explosive, distance) == ("TNT", 19) else [])
    for explosive in read.CYLINDER for distance in (6, 19)])
def test_walls_of_cylinders_are_slow(explosive, distance):
    """By 2 to 4.5 %; the reason is not known."""
    (slow,) = off(f"wall velocity at {distance} mm", explosive)
    assert -0.045 < slow < -0.02


@pytest.mark.parametrize(("form", "ratio", "expected"), [
    ("cylinder", 2.565, 1542.0 / 2700.0), ("sandwich", 2.565, 1585.9 / 2700.0), ("open", 0.0, 3.0**0.5)])
def test_gurneys_formulas(form, ratio, expected):
    """Composition B in 4340 by his cylinder and sandwich, at 2700 m/s; without metal the free face of an open-faced charge."""
    assert read.gurney(form, ratio) == pytest.approx(expected, rel=1e-3)
