"""The templates of `hydro2d new`, the command, and the output and pictures of `hydro2d check`."""

import re

import pytest

from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.deck import templates
from hydro2d.solver.simulation import Simulation


def test_there_are_templates():
    assert set(templates.kinds()) >= {"rod", "crater", "taylor", "whipple", "spall", "perforation", "jacketed",
                                       "ceramic"}


@pytest.mark.parametrize("kind", templates.kinds())
def test_a_template_is_written_checked_and_runs(kind, tmp_path, monkeypatch, capsys):
    """Without a warning; two keys describe the mesh; the commands that are printed are those for the file."""
    monkeypatch.chdir(tmp_path)
    assert call(["new", kind]) == 0
    commands = re.findall(r"^ +hydro2d (\w+) (\S+)", capsys.readouterr().out, re.M)
    assert commands == [("check", f"{kind}.toml"), ("run", f"{kind}.toml"), ("view", f"runs/{kind}")]
    assert call(["check", f"{kind}.toml", "--picture", "start.png"]) == 0
    shown = capsys.readouterr().out
    assert "warning" not in shown
    text = (tmp_path / f"{kind}.toml").read_text()
    assert text == templates.text(kind)
    assert len(text.splitlines()) < 90
    assert "cells_across = " in text
    assert 'reach = "' in text
    deck = decks.load(f"{kind}.toml")
    simulation = Simulation(deck)
    for _ in range(5):
        simulation.step()
    assert simulation.faults() == []


def alternatives():
    """What the comments of the templates offer: kind of shot, number of the line, the lines in its place, and overrides.

    A quoted word is another value of the key, with the key in brackets after it; so is a number of cells. A whole assignment
    is a further line, or a value in the table that it names.
    """
    for kind in templates.kinds():
        for number, line in enumerate(templates.text(kind).splitlines()):
            setting, _, comment = line.partition("#")
            key = setting.partition("=")[0].strip()
            values = re.findall(r'(?<!= )("[\w-]+")(?: \(with ([^)]*)\))?', comment)
            values += [(count, "") for count in re.findall(r"\d+(?:\.\d+)?", comment) if key == "cells_across"]
            others = re.findall(r'(\w+) = ("[^"]*") in \[(.*?)\]', comment)
            elsewhere = [f"{table}.{name}={value}" for name, value, table in others]
            yield from ((kind, number, [f"{key} = {value}", more], elsewhere) for value, more in values)
            if not key and (whole := re.search(r'\w+ = "[^"]*"$', comment)):
                yield kind, number, [whole[0]], []


def test_comments_offer_alternatives():
    offered = {(kind, *lines) for kind, _, lines, _ in alternatives()}
    assert offered >= {("rod", 'nose = "ogival"', "crh = 3"), ("rod", 'nose = "flat"', ""), ("rod", 'fine = "7 radii"'),
                       ("ceramic", 'material = "float_glass"', ""), ("cylinder-test", 'material = "octol"', ""),
                       ("rod", "cells_across = 8.5", ""), ("crater", 'damage = "material"', ""),
                       ("perforation", 'r_max = "wall"', ""), ("perforation", "cells_across = 40", "")}
    assert ["materials.aluminium.variant=\"johnson-cook\""] in [overrides for *_, overrides in alternatives()]


@pytest.mark.parametrize(("kind", "number", "instead", "overrides"), list(alternatives()))
def test_what_the_comment_of_a_template_offers_is_accepted(kind, number, instead, overrides):
    lines = templates.text(kind).splitlines()
    lines[number : number + 1] = instead
    assert decks.loads("\n".join(lines), overrides).title


def test_the_list_has_a_line_for_each_kind(capsys):
    assert call(["new", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(templates.kinds())
    assert all(len(line) < 129 and line.endswith((".", "?")) for line in lines)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["wipple"], 'unknown kind "wipple"; did you mean "whipple"?'),
        ([], "give a kind of shot: ceramic"),
        (["rod", "--list"], "--list lists the kinds"),
        (["rod", "--out", "nowhere/rod.toml"], "nowhere: there is no such directory"),
        (["rod", "--out", "there.toml"], "there.toml exists; give another name"),
    ],
)
def test_mistakes_are_reported(arguments, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there.toml").write_text("mine")
    assert call(["new", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert (tmp_path / "there.toml").read_text() == "mine"
    assert sorted(file.name for file in tmp_path.iterdir()) == ["there.toml"]


def test_check_counts_the_cells_across_every_body(capsys):
    for kind, said in {
        "whipple": ["10 cells across the radius of 4.765 mm, 20 cells across the diameter of 9.53 mm",
                    "4.2 cells across the thickness of 2 mm", "8.39 cells across the thickness of 4 mm"],
        "spall": ["120 cells across the radius of 12 mm, 20 cells across the thickness of 2 mm"],
        "taylor": ["8 cells across the radius of 3.81 mm, 53.3 cells across the height of 25.4 mm"],
        "crater": ["85 cells across the thickness of 60 mm, of which 50 mm lie in the mesh"],
    }.items():
        assert call(["check", f"problems/templates/{kind}.toml"]) == 0
        shown = capsys.readouterr().out
        assert [text for text in said if text not in shown] == []


def test_the_picture_has_mesh_tracers_and_gauges():
    from hydro2d.results import start_figure
    from hydro2d.running.check import check

    deck = decks.load("problems/templates/taylor.toml", [
        'gauge=[{ name = "probe", r = "6 mm", z = "1 mm" }, '
        '{ name = "line", r = "7 mm", z = "1 mm", z_end = "9 mm", points = 3 }]'
    ])
    checked = check(deck)
    figure = start_figure.draw(checked.dump, checked.deck)
    axes = figure.axes[0]
    lines = next(each for each in axes.collections if each.get_alpha() == 0.6).get_segments()
    assert len(lines) == checked.grid.nr + 1 + checked.grid.nz + 1
    assert max(line[:, 1].max() for line in lines) == 0.0
    assert [text.get_text() for text in axes.texts] == ["tail", "probe", "line_1", "line_2", "line_3"]
    marks = [(line.get_marker(), *line.get_xydata()[0]) for line in axes.lines if line.get_marker() in ("o", "x")]
    assert marks[:2] == [("o", pytest.approx(25.0), pytest.approx(0.0)), ("x", pytest.approx(1.0), pytest.approx(6.0))]
    assert "mesh, tracers (dots), gauges (crosses)" in axes.get_title()
    fine = check(decks.load("problems/templates/taylor.toml", ["mesh.cells_across=60"]))
    assert "one line of the mesh in " in start_figure.draw(fine.dump, fine.deck).axes[0].get_title()
