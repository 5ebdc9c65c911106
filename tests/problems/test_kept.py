"""Files of results next to the studies."""

import pytest

from hydro2d.study.records.study_directory import StudyError
from problems import kept


def test_a_file_that_was_written_is_read(tmp_path):
    path = tmp_path / "results.csv"
    cases = [{"law": "a", "depth_cm": 1.5, "case": "a_1"}, {"case": "b, 1", "depth_cm": 2}]
    kept.write(path, ["law", "depth_cm", "case"], cases)
    assert path.read_bytes() == b'law,depth_cm,case\na,1.5,a_1\n,2,"b, 1"\n'
    rows = kept.read(path, ["case", "depth_cm"], lambda row: row, None)
    assert rows == [{"law": "a", "depth_cm": "1.5", "case": "a_1"}, {"law": "", "depth_cm": "2", "case": "b, 1"}]
    assert [kept.labels(row, ["depth_cm"]) for row in rows] == [{"law": "a"}, {}]


def test_a_file_without_a_column_is_none(tmp_path):
    path = tmp_path / "results.csv"
    path.write_text("law,case\na,a_1\n")
    with pytest.raises(StudyError, match=r"no file of results: it has no column depth_cm, time_us"):
        kept.rows(path, ["case", "time_us", "depth_cm"])


def test_members_are_shown_by_their_median_and_range():
    rows = [{"length_mm": text, "u_m_s": text[:2]} for text in ("96.53", "96.74", "96.60", "9.10")]
    assert kept.told(rows[:3], "length_mm") == "96.60 (96.53 to 96.74)"
    assert kept.told(rows[:1], "length_mm") == "96.53"
    assert kept.told([*rows, {"length_mm": "97.1"}], "length_mm") == "96.60 (9.10 to 97.1)"  # sorted as numbers
    assert kept.told(rows[:3], "u_m_s") == "96"


def test_members_are_grouped_by_what_they_share():
    rows = [{"face": face, "depth": depth} for face, depth in (("bare", "1"), ("cover", "2"), ("bare", "3"))]
    assert kept.grouped(rows, ["face"]) == {("bare",): [rows[0], rows[2]], ("cover",): [rows[1]]}
