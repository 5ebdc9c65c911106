"""Printed, logged and drawn output: text from someone else's files controls no terminal, no table and no page."""

import ast
import io
import json

import pytest

from hydro2d.base.formats import in_plotly, one_line, shown
from hydro2d.base.terminal import duration, say
from hydro2d.cli.main import call
from hydro2d.results import figures
from hydro2d.results.reading import Results
from hydro2d.running.run import run as start
from hydro2d.study.run import monitor
from tests import fake
from tests.rules import source

#: sets the title of a terminal, clears it, reverses the direction of writing, and forges a line
NASTY = "a\x1b]0;owned\x07\x1b[2J \u202eb\u2066 \x9b31m [red]c[/red] \r\nd"
SPELLED = r"a\x1b]0;owned\x07\x1b[2J \u202eb\u2066 \x9b31m [red]c[/red] \r"


@pytest.mark.parametrize(("seconds", "shown", "measured"), [
    (0.4, "0 s", "0.4 s"), (9.94, "10 s", "9.9 s"), (9.96, "10 s", "10 s"), (77.2, "1 min 17 s", "1 min 17 s"),
    (388.8, "6 min 29 s", "6 min 29 s"), (3599.6, "1 h 00 min", "1 h 00 min"), (7384.0, "2 h 03 min", "2 h 03 min"),
])
def test_a_time_has_one_form(seconds, shown, measured):
    assert duration(seconds) == shown
    assert duration(seconds, tenths=True) == measured


def test_terminal_control_characters_are_spelled():
    assert shown(NASTY) == SPELLED + "\nd"
    assert one_line(NASTY) == SPELLED + r"\nd"
    for text in ("µ × 10⁻³ Größe 鋼", "two\nlines\tand a tab", ""):
        assert shown(text) == text
    assert shown("\udcff\u2028\u200f") == r"?\u2028\u200f"
    file = io.StringIO()
    say(NASTY, file=file)
    assert file.getvalue() == SPELLED + "\nd\n"


def test_titles_in_log_and_terminal(simulation, tmp_path, capsys):
    deck = fake.FakeDeck()
    deck.title = NASTY
    deck.to_toml = lambda: fake.FakeDeck().to_toml()
    start(deck, tmp_path / "shot")
    out, log = capsys.readouterr().out, (tmp_path / "shot" / "log.txt").read_text()
    for text in (out, log):
        assert SPELLED + r"\nd" in text
        assert not {each for each in text if not each.isprintable()} - {"\n"}


@pytest.mark.parametrize("title", [NASTY])
def test_titles_and_messages_of_commands(title, tmp_path, capsys):
    deck = tmp_path / "deck.toml"
    deck.write_text(f"include = 'perforation/sphere.toml'\ntitle = {json.dumps(title)}\n")
    assert call(["check", str(deck)]) == 0
    assert SPELLED in capsys.readouterr().out
    deck.write_text(f"include = 'perforation/sphere.toml'\n{json.dumps(title)} = 1\n")
    assert call(["check", str(deck)]) == 2
    assert r"\x1b]0;owned" in capsys.readouterr().err
    assert call(["check", str(tmp_path / "\x1b[2J.toml")]) == 2
    assert "\x1b" not in capsys.readouterr().err


def test_messages_about_runs(finished, tmp_path, capsys):
    summary = json.loads((finished / "summary.json").read_text())
    (finished / "summary.json").write_text(json.dumps(summary | {"stop_reason": NASTY, "faults": [NASTY], "title": NASTY}))
    (finished / "series.pvd").write_text(f"<VTKFile>{NASTY}")
    for command in (["report", str(finished)], ["plot", str(finished), "-o", str(tmp_path / "a.png")]):
        call(command)
        said = capsys.readouterr()
        assert not {each for each in said.out + said.err if not each.isprintable()} - {"\n"}
    page = (finished / "report" / "report.html").read_text()
    assert "\u202e" not in page
    assert "\x1b" not in page


def test_tables_on_a_terminal_take_names_as_they_are():
    from rich.console import Console

    file = io.StringIO()
    Console(file=file, force_terminal=True, width=200).print(monitor.grid([(NASTY, "[bold]done[/bold]", "", "", "", "")]))
    assert SPELLED in file.getvalue()
    assert "[bold]done[/bold]" in file.getvalue()


def test_lines_of_a_study(tmp_path):
    from hydro2d.study.records.study_directory import Study

    log = io.StringIO()
    board = monitor.Board(Study(tmp_path, NASTY, "a", (), ()), log, quiet=True)
    board.line("\x1b[2J")
    assert log.getvalue().endswith("  \\x1b[2J\n")
    assert monitor.status(board.study)[0] == one_line(f"a: {NASTY}")


def test_names_in_figures_are_no_formulas(finished, tmp_path):
    run = Results(finished)
    run.__class__ = type("Named", (Results,), {"label": r"a $\frac{1$ b"})
    for figure in (figures.sections([run], "pressure"), figures.histories([run])):
        figures.save_figure(figure, tmp_path / "a.png")
    assert figures.verbatim("a$b") == r"a\$b"


def test_names_in_charts_are_no_markup():
    assert in_plotly('<a href="x">\u202e&') == '&lt;a href="x"&gt;\\u202e&amp;'


def test_only_one_function_prints():
    """`say`."""
    names = [name for name, file in source.modules().items() if name.startswith("hydro2d")
             for node in ast.walk(source.tree(file)) if isinstance(node, ast.Name) and node.id == "print"]
    assert sorted(names) == ["hydro2d.base.terminal"]
