"""The tables of the nose-shape study from kept rows, and the pages that show them."""

from dataclasses import replace

import pytest

from hydro2d.base.method_version import METHOD
from problems.cth_nose_shape import findings, pages, rigid_rod
from problems.cth_nose_shape.rigid_rod import Result

SHOTS = ("5083-1086", "5083-1200", "ogive-5083-1227")


def made(shot, depth, scheme="ke", loss=2.0, member=0):
    labels = {"sliding": "contact", "failure": "P", "advection": scheme, "shot": shot, "cells_across": "5.5"}
    return Result(labels, member, depth, loss, None if depth else 90.0, "rigid", None, METHOD)


@pytest.fixture
def schemes():
    return findings.grouped([
        made(SHOTS[0], 44.0), made(SHOTS[0], 46.0, member=1), made(SHOTS[1], 20.0, loss=60.0), made(SHOTS[2], None),
        made(SHOTS[0], 40.0, "momentum"), made(SHOTS[0], 41.0, "momentum", member=1), made(SHOTS[1], 30.0, "momentum", 12.0),
    ])


def test_depths_of_every_way_to_compute(schemes):
    assert findings.depths(schemes, "hemispherical") == [
        "| sliding, failure, advection | 5083, 1086 m/s | 5083, 1200 m/s |", "|---|---|---|",
        "| experiment | 44.8 cm | 20.0 cm |",
        "| contact, P, ke | 45.0 (44.0 to 46.0), 2.0 % | 20.0, 60 % |",
        "| contact, P, momentum | 40.5 (40.0 to 41.0), 2.0 % | 30.0, 12 % |",
    ]
    assert findings.depths(schemes, "ogival")[-1] == "| contact, P, ke | perforated, 2.0 % |"
    doubtful = replace(made(SHOTS[0], 44.0), trusted=False)
    assert findings.depths(findings.grouped([doubtful]), "hemispherical")[-1] == "| contact, P, ke | 44.0†, 2.0 % |"
    assert rigid_rod.notes([doubtful]) == ["", "† 1 run with a fault in the audit, such as too much energy lost."]
    assert findings.depths({}, "ogival") == ["No run of `advection.toml` with ogival rods is kept."]


def test_schemes_are_compared_shot_by_shot(schemes):
    """4 and 5 cm less than 44 and 46; a shot with one pair has no error, and neither has the mean then."""
    one, other = (schemes["contact", "P", scheme][rigid_rod.Shot.named(SHOTS[0])] for scheme in ("momentum", "ke"))
    assert findings.difference(one, other) == pytest.approx((-10.0, 50.0 / 45.0))
    assert findings.compared(schemes, "hemispherical", "advection")[2:] == [
        "| contact, P | momentum | -10.0 ± 1.1 % | +50.0 % | +20.0 % |"]
    assert findings.compared(schemes, "hemispherical", "sliding")[2:] == [], "all rows are of one choice"


def test_scores_of_each_scheme(schemes):
    head, _, *rows = findings.scores(schemes)
    assert head.startswith("| sliding, failure, advection | shots |")
    assert [row.split(" | ")[:3] for row in rows] == [
        ["| contact, P, ke", "3", "4 of 4 (60 to 100 %)"], ["| contact, P, momentum", "2", "2 of 3 (25 to 92 %)"]]


def test_the_figure_has_a_dot_for_every_run(schemes):
    first = findings.draw(schemes).axes[0]
    dots = [line for line in first.lines if line.get_marker() in ("o", "^") and line.get_alpha() == 0.6]
    assert sum(len(line.get_xdata()) for line in dots) == 6


@pytest.mark.parametrize("page", pages.PAGES, ids=lambda page: page.stem)
def test_pages_have_the_tables_of_the_kept_rows(page):
    text = page.read_text(encoding="utf-8")
    assert "<!-- end -->" in text
    assert pages.filled(text) == text, "python -m problems.cth_nose_shape.pages fills them"


def test_every_table_is_on_a_page():
    text = "".join(page.read_text(encoding="utf-8") for page in pages.PAGES)
    assert [name for name in pages.TABLES if f"<!-- {name} -->" not in text] == []


def test_another_table_is_found(tmp_path, monkeypatch, capsys):
    file = tmp_path / "page.md"
    file.write_text("<!-- holes -->\n| old |\n<!-- end -->\n")
    monkeypatch.setattr(pages, "PAGES", (file,))
    assert pages.main(["--check"]) == 1
    assert "| old |" in file.read_text()
    assert pages.main([]) == 0
    assert "| old |" not in file.read_text()
    assert pages.main(["--check"]) == 0
    assert capsys.readouterr().out == "page.md: has other tables\npage.md: filled\n"
