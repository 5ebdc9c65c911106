"""Output on decks and studies fits a terminal of 80 columns, and is not broken where there is no terminal."""

import pytest

from hydro2d.cli.main import call
from hydro2d.study.run.monitor import lines
from tests.rules import source
from tests.running.test_progress import recorded
from tests.study import fake

COLUMNS = 80
#: with rows of every kind: a mesh that follows, a tie, walls, bodies that the mesh cuts off, warnings, long titles
DECKS = ["cth_nose_shape/hemi_5083_1086", "sliding/impact_head_on", "perforation/sphere", "classic/flyer_spall",
         "cth_nose_shape/hemi_5083_1296_strain_failure"]
STUDIES = [("sweep", "cth_nose_shape/rigid_rod_failure"), ("sweep", "classic/methods"), ("sweep", "validation/eroding_rods"),
           ("transition", "cth_nose_shape/transition_hemi_5083")]
PLAN = ("--check", "--overwrite")  # every case, whether or not its kept row is up to date


def shipped(name):
    return str(source.PROBLEMS / f"{name}.toml")


def printed(capsys, *arguments):
    assert call(list(arguments)) == 0
    return capsys.readouterr().out.splitlines()


@pytest.mark.parametrize("name", DECKS)
def test_a_deck_is_printed_in_so_many_columns(name, capsys, monkeypatch):
    """Lines break at words, under their text, and nothing is lost."""
    monkeypatch.delenv("COLUMNS", raising=False)
    whole = printed(capsys, "check", shipped(name), "--threads", "2")
    assert max(map(len, whole)) > COLUMNS
    monkeypatch.setenv("COLUMNS", str(COLUMNS))
    narrow = printed(capsys, "check", shipped(name), "--threads", "2")
    assert max(map(len, narrow)) <= COLUMNS
    assert " ".join(narrow).split() == " ".join(whole).split()
    begin = narrow.index("")  # below the title
    assert all(line.startswith(" " * 10) or any(each.startswith(line) for each in whole) for line in narrow[begin:])


@pytest.mark.parametrize("command", [["new", "--list"], ["info"], ["info", "W_alloy"], ["info", "johnson-cook"], ["model"],
                                     ["info", "numerics.advection"]])
def test_explanations_go_on_below_their_column(command, capsys, monkeypatch):
    """Nothing is lost; a text that begins far to the right continues below the beginning of its line."""
    monkeypatch.delenv("COLUMNS", raising=False)
    whole = printed(capsys, *command)
    assert max(map(len, whole)) > COLUMNS
    monkeypatch.setenv("COLUMNS", str(COLUMNS))
    narrow = printed(capsys, *command)
    assert max(map(len, narrow)) <= COLUMNS
    assert " ".join(narrow).split() == " ".join(whole).split()
    if command == ["new", "--list"]:
        begin = next(line for line in whole if line.startswith("ceramic")).index("A long rod")
        assert {line[:begin].strip() for line in narrow} == {"", *(line[:begin].strip() for line in whole)}


@pytest.mark.thorough
@pytest.mark.parametrize(("command", "name"), STUDIES)
def test_every_case_of_a_study_has_one_line(command, name, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(COLUMNS))
    output = printed(capsys, command, shipped(name), *PLAN, "--workers", "2")
    assert max(map(len, output)) <= COLUMNS
    begin, end = output.index("") + 1, len(output) - output[::-1].index("") - 1
    heads, *rows = output[begin:end]
    place = heads.index("cells")
    assert rows
    assert all(row[:place].endswith("  ") and row[place].isdigit() and row.endswith(" s") for row in rows)


def test_the_deck_of_all_cases_is_printed_once(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    output = printed(capsys, "transition", shipped("cth_nose_shape/transition_hemi_5083"), *PLAN)
    assert [line for line in output if "hemi_5083_1086_quick.toml" in line] == ["deck: hemi_5083_1086_quick.toml"]
    output = printed(capsys, "sweep", shipped("long_rods/velocities"), *PLAN)
    assert output[2].split() == ["case", "deck", "cells", "cycles", "time"]


def test_the_status_of_a_study_fits(capsys, monkeypatch, tmp_path):
    study = fake.write_study(tmp_path / "study", {"velocity": fake.velocities(1086)}, title="A title that goes on " * 6)
    monkeypatch.setenv("COLUMNS", str(COLUMNS))
    output = printed(capsys, "sweep", str(study), "--status")
    assert max(map(len, output)) <= COLUMNS
    assert "1 of 1 done" in output


def test_a_name_that_is_too_long_has_a_line_of_its_own(monkeypatch):
    rows = [("a-case-with-a-very-long-name", "15705", "2 min 33 s"), ("short", "15705", "9 s")]
    monkeypatch.setenv("COLUMNS", "30")
    assert lines(rows, ("case", "cells", "time")) == [
        "case         cells  time",
        "a-case-with-a-very-long-name",
        "             15705  2 min 33 s",
        "short        15705  9 s",
    ]
    monkeypatch.delenv("COLUMNS")
    assert lines(rows, ("case", "cells", "time"))[1] == "a-case-with-a-very-long-name  15705  2 min 33 s"


def test_a_table_that_is_too_wide_without_its_names_has_a_line_for_each_cell(monkeypatch):
    rows = [("one", "2 of 2, still moving", "rigid 2 of 2 (43 to 100 %)"), ("two", "1 of 2", "")]
    monkeypatch.setenv("COLUMNS", "50")
    assert lines(rows, ("case", "ended", "regimes")) == [
        "one",
        "  ended    2 of 2, still moving",
        "  regimes  rigid 2 of 2 (43 to 100 %)",
        "two",
        "  ended    1 of 2",
        "  regimes",
    ]


def test_the_terminal_says_how_wide_it_is():
    output = recorded(f"from hydro2d.cli.main import main; main(['check', {shipped(DECKS[0])!r}])", COLUMNS)
    assert any(line.startswith("cost ") for line in output)
    assert max(map(len, output)) <= COLUMNS
