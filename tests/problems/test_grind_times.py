"""The table of grind times: from what `hydro2d bench --json` writes to the page."""

import json

import pytest

import hydro2d
from problems import grind_times, kept


def bench(path, processor="EPYC", name="contact, ke", times=(100.4, 60.2)):
    """A file as `hydro2d bench --json` writes it."""
    about = {"cpu": processor, "cpu_count": 2, "written": "2026-11-28T10:00:00", "version": "0.3", "git_commit": "a" * 40}
    cases = [{"name": name, "cells": 131325, "threads": number, "ns_per_cell_cycle": ns, "triad_gb_s": 12.3}
             for number, ns in enumerate(times, 1)]
    path.write_text(json.dumps({"provenance": about, "cases": cases}))
    return path


def test_a_measurement_becomes_a_row_of_the_page(tmp_path):
    rows = grind_times.of_bench(bench(tmp_path / "x.json"))
    assert grind_times.table(rows)[2:] == ["| EPYC | 2 | 2026-11-28 | contact, ke | 131325 | 100 | 60 (2) |"]
    assert grind_times.table(grind_times.of_bench(bench(tmp_path / "x.json", times=(100.4,))))[2].endswith("| 100 |  |")
    assert len(grind_times.table(grind_times.of_bench(bench(tmp_path / "x.json", name="4 materials")))) == 2


def test_a_machine_that_is_measured_anew_replaces_its_rows(tmp_path):
    old = grind_times.of_bench(bench(tmp_path / "x.json"))
    other = grind_times.of_bench(bench(tmp_path / "x.json", processor="Xeon"))
    new = grind_times.of_bench(bench(tmp_path / "x.json", times=(90.0, 50.0)))
    assert grind_times.added(grind_times.added(old, other), new) == [*other, *new]


def test_files_are_written_and_checked(tmp_path, monkeypatch):
    page, file = tmp_path / "page.md", tmp_path / "rows.csv"
    page.write_text("a\n<!-- grind_times -->\n<!-- end -->\n")
    kept.write(file, grind_times.COLUMNS, [])
    monkeypatch.setattr(grind_times, "PAGE", page)
    monkeypatch.setattr(grind_times, "FILE", file)
    measured = str(bench(tmp_path / "x.json"))
    assert grind_times.main([measured, "--check"]) == 1
    assert "EPYC" not in page.read_text()
    assert grind_times.main([measured]) == 0
    assert "| EPYC | 2 |" in page.read_text()
    assert len(file.read_text().splitlines()) == 3
    assert grind_times.main(["--check"]) == 0


def test_another_file_is_refused(tmp_path, capsys):
    (tmp_path / "x.json").write_text('{"cases": []}')
    with pytest.raises(hydro2d.StudyError, match="is no file of `hydro2d bench --json`"):
        grind_times.of_bench(tmp_path / "x.json")
    assert grind_times.main([str(tmp_path / "x.json")]) == 2
    assert "no file of" in capsys.readouterr().err


def test_the_page_has_the_rows_that_are_kept():
    assert grind_times.main(["--check"]) == 0
