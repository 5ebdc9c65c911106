"""The verdict on a run against its error: wrong runs are not trusted, and right ones are.

A run that is wrongly judged is an expected failure with its reason. It fails here when it is judged rightly, or when its error
moves to the other side of its bound (`verdicts`, and `verdict_draw` for the thorough ones).
"""

from pathlib import Path

import pytest

from tests.verification.verdict_draw import DRAWN, NOTED
from tests.verification.verdicts import ROWS, judged, table_of

PAGE = Path(__file__).parents[2] / "docs/explanation/sanity.md"


THOROUGH = [pytest.param(row, marks=pytest.mark.thorough) for row in [*DRAWN, *NOTED]]


@pytest.mark.parametrize("row", [*ROWS, *THOROUGH], ids=lambda row: f"{row.family}: {row.name}")
def test_the_verdict_and_the_error(row):
    error, said = judged(row)
    assert (error <= row.bound) == row.right, f"an error of {error:.3g}, where {row.bound:g} is the bound"
    assert (not said) == row.trusted, said
    if row.missed:
        pytest.xfail(row.missed)


@pytest.mark.parametrize("rows", [ROWS, DRAWN], ids=["first", "drawn"])
def test_the_page_has_the_table(rows):
    assert table_of(rows) in PAGE.read_text(encoding="utf-8")


def test_rows_have_names_of_their_own():
    rows = [*ROWS, *DRAWN, *NOTED]
    assert len({(row.family, row.name) for row in rows}) == len(rows)
