"""The first 90 us of a shot on three meshes: how a run is read, and the table of the page."""

import numpy as np
import pytest

from problems.cth_nose_shape import first_90us
from tests.rules import source

PAGE = source.ROOT / "docs/explanation/rigid-rod.md"


def test_stresses_are_means_over_the_rods_own_section():
    """Cells count by the volume of the rod in them, between 5 and 10 mm behind the tip, and nowhere else."""
    r_edges, z_edges = np.array([0.0, 1e-3, 2e-3]), np.linspace(0.0, 20e-3, 21)
    fraction = np.zeros((20, 2))
    fraction[:15, 0], fraction[:15, 1] = 1.0, 0.5
    axial, lateral = np.full((20, 2), 9e9), np.full((20, 2), 9e9)
    axial[5:10] = 1e9, 3e9
    lateral[5:10] = 0.5e9, 0.0
    found = first_90us.section(r_edges, z_edges, fraction, axial, lateral)
    assert found == pytest.approx(((1.0 * 1e9 + 1.5 * 3e9) / 2.5, 1.0 * 0.5e9 / 2.5))
    with pytest.raises(ValueError, match="no rod on the axis"):
        first_90us.section(r_edges, z_edges, 0.0 * fraction, axial, lateral)


def test_members_are_told_by_their_median_and_ends():
    rows = [{"length_mm": each} for each in ("96.53", "96.74", "96.60")]
    assert first_90us.told(rows, "length_mm") == "96.60 (96.53 to 96.74)"
    assert first_90us.told(rows[:1], "length_mm") == "96.53"


def test_the_table_of_the_page_is_that_of_the_kept_results():
    rows = first_90us.table(first_90us.kept())
    assert len(rows) == 2 + 4 * 3
    page = PAGE.read_text(encoding="utf-8").splitlines()
    assert [line for line in page if line in rows] == rows


def test_what_the_page_says_of_the_meshes():
    """Where the law has no rate the meshes agree; with the rate members differ by more than these meshes do."""
    kept = first_90us.kept()

    def lengths(rod, cells):
        return [float(row["length_mm"]) for row in kept if (row["rod"], row["cells"]) == (rod, cells)]

    for rod in ("undeformable", "plastic", "no-rate"):
        medians = [float(np.median(lengths(rod, cells))) for cells in ("8.5", "12.5", "16.5")]
        assert np.ptp(medians) < 0.1
    assert np.ptp(lengths("sintered", "12.5")) > 0.3
