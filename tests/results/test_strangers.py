"""Runs of someone else: with any names and any contents of files, they are read, or refused in one line."""

import copy
import html.parser
import io
import json
import re
import tomllib

import numpy as np
import pandas
import pytest

from hydro2d.base.errors import Error
from hydro2d.base.formats import in_toml
from hydro2d.cli.main import call
from hydro2d.files import toml
from hydro2d.files.checksums import verified_text
from hydro2d.files.whole import read_json, write_json
from hydro2d.materials import quantities
from hydro2d.output import datasets, history, vtk
from hydro2d.results import standing
from hydro2d.results.reading import Results
from hydro2d.results.viewer import page
from hydro2d.running.run import run
from hydro2d.study.records import study_directory
from hydro2d.study.records.table import to_csv
from hydro2d.study.run import monitor
from tests import fake
from tests.cli.test_main import DECK
from tests.locks import held
from tests.names import ASCII, NAMES, OF_BODIES, PLACED, UNICODE

WRONG = ("<b>x</b>", 3, -1e300, True, [], [3], [[]], {}, {"a": "b"}, None)
SHARE = quantities.BY_KEY["volume_fraction"]


def places(tables, depth=3, path=()):
    """The paths of all values in nested tables and lists."""
    items = tables.items() if isinstance(tables, dict) else enumerate(tables) if isinstance(tables, list) else ()
    for key, value in items:
        yield (*path, key)
        if len(path) < depth - 1:
            yield from places(value, depth, (*path, key))


def replaced(tables, path, value):
    changed = place = copy.deepcopy(tables)
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return changed


class Tags(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.found = set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.add((tag, *attrs))


def looked_at(directory):
    """Everything shown of a run except its fields."""
    try:
        results = Results(directory)
        repr(results)
        tags = Tags(results._repr_html_()).found
        results.measured_position, results.planar, results.bodies, results.stop, results.direction  # noqa: B018
    except Error:
        return
    assert tags <= {("table",), ("caption",), ("tr",), ("th",), ("td",)}
    (case,) = study_directory.gather([directory]).cases
    standing.lines(results, case.status, case.message, case.progress)
    monitor.row(case)
    monitor.left([case], 1)


@pytest.mark.thorough
@pytest.mark.parametrize("running", [False, True])
def test_any_value_in_the_deck_of_a_stranger(finished, running):
    """That of a run that has ended, and of one that is under way."""
    if running:
        (finished / "summary.json").unlink()
    tables = tomllib.loads(verified_text(finished / "deck.toml", Error))
    for path in places(tables):
        for value in WRONG:
            if value is not None:
                (finished / "deck.toml").write_text(toml.dumps(replaced(tables, path, value)))
                looked_at(finished)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["progress.json", "summary.json"])
def test_any_value_in_what_a_stranger_says_of_the_run(finished, name):
    summary = {"time_s": 1e-6, "cycles": 3, "fraction": 0.5, "left_s": 3.0, "wall_s": 2.0, "penetration_depth_m": 0.1,
               "rod_tail_velocity_m_s": 3.0, "host": "a", "process": 3}
    tables = summary if name == "progress.json" else read_json(finished / "summary.json", Error)
    with held(finished / "run.lock"):
        for path in places(tables):
            for value in WRONG:
                (finished / name).write_text(json.dumps(replaced(tables, path, value)))
                looked_at(finished)
        for key in summary:  # and with any of them missing
            write_json(finished / name, {other: value for other, value in tables.items() if other != key})
            looked_at(finished)


@pytest.mark.parametrize("name", NAMES)
def test_a_name_in_html(finished, name):
    tables = tomllib.loads(verified_text(finished / "deck.toml", Error))
    tables["penetration"]["rod"] = tables["title"] = tables["body"][0]["name"] = name
    (finished / "deck.toml").write_text(toml.dumps(tables))
    assert Results(finished).projectile == name
    looked_at(finished)


def test_names_in_dumps(tmp_path):
    """All of them in one file, which every reader understands."""
    values = np.arange(6.0).reshape(2, 3)
    fields = [(SHARE.name(name), values + number) for number, name in enumerate(OF_BODIES)]
    edges = np.linspace(0, 3, 4), np.linspace(0, 2, 3)
    file = tmp_path / "vtk" / "dump_000000.vtr"
    file.parent.mkdir()
    vtk.write_grid(file, *edges, fields, 1e-6)
    stored = vtk.read_grid(file)
    assert stored.bodies == list(OF_BODIES)
    for name, value in fields:
        assert np.array_equal(stored.fields[name], value), name
    grid = vtk.pyvista_grid(file)
    assert set(grid.cell_data) == {name for name, _ in fields}
    assert set(vtk.pyvista_of(*edges, fields, 1e-6).cell_data) == {name for name, _ in fields}
    assert set(datasets.of_dumps([(1e-6, file)]).data_vars)


def test_names_in_histories(tmp_path):
    columns = [f"{kind}_{name}_{key}" for kind, key in (("body", "mass_kg"), ("tracer", "r_m")) for name in OF_BODIES]
    from hydro2d.output.station_arrays import KEYS

    columns += [f"tracer_{name}_{key}" for name in OF_BODIES for key in KEYS if key != "r_m"]
    written = history.History(tmp_path / "history.h5")
    for time in (0.0, 1.0):
        written.append({"time": time, **{name: time + number for number, name in enumerate(columns)}})
    written.write()
    stored = history.read(tmp_path / "history.h5")
    assert set(stored) == {"time", *columns}
    assert {name: values[0] for name, values in stored.items() if name != "time"} == {
        name: float(number) for number, name in enumerate(columns)}
    history.write_csv(stored, tmp_path / "history.csv")
    table = pandas.read_csv(tmp_path / "history.csv")
    assert [re.sub(r" \[[^\[]*\]$", "", head) for head in table] == list(stored)
    assert len(history.dataset(stored).data_vars) == len(columns)


@pytest.mark.parametrize("write", [
    lambda name: to_csv(pandas.DataFrame([{name: name}])),
    lambda name: to_csv(pandas.DataFrame([{"a": 1, name: "x"}])),
])
def test_no_cell_is_a_formula(write):
    for name in PLACED:
        rows = pandas.read_csv(io.StringIO(write(name)), dtype=str, keep_default_na=False)
        for cell in (*rows.columns, *rows.iloc[0]):
            assert not cell.startswith(("=", "+", "-", "@")), name
            assert cell.removeprefix("'") in (name, name.removeprefix("'"), "a", "1", "x")


def test_heads_of_a_history_are_no_formulas(tmp_path):
    columns = {"time": np.zeros(2), "=1+1": np.ones(2), "@x": np.ones(2)}
    history.write_csv(columns, tmp_path / "history.csv")
    assert (tmp_path / "history.csv").read_text().startswith("time [s],'=1+1 [1],'@x [1]\n")


def test_names_in_decks_studies_and_summaries(tmp_path):
    tables = {"body": [{"name": name} for name in NAMES], **{name: {name: name} for name in NAMES if name != "body"}}
    assert tomllib.loads(toml.dumps(tables)) == tables
    write_json(tmp_path / "summary.json", tables)
    assert read_json(tmp_path / "summary.json", Error) == tables
    for name in NAMES:
        assert tomllib.loads(f"{in_toml(name)} = {toml.inline(name)}") == {name: name}


def test_a_run_with_such_names(tmp_path):
    """From the deck to the restart, with all characters in the name of the projectile and of a tracer."""
    name = json.dumps(f"={ASCII}{UNICODE[:60]}", ensure_ascii=False)
    text = DECK.replace('name = "rod"', f"name = {name}").replace('name = "nose"', f"name = {name}")
    (tmp_path / "shot.toml").write_text(f'{text}\n[penetration]\nrod = {name}\ntarget = "plate"\n', encoding="utf-8")
    deck, out = str(tmp_path / "shot.toml"), str(tmp_path / "out")
    for command in (["check", deck], ["run", deck, "--out", out, "--quiet", "--set", "stop.cycles=3"], ["status", out],
                    ["plot", out, "--out", f"{tmp_path}/a.png"], ["export", out, "--out", f"{tmp_path}/export"],
                    ["report", out, "--out", f"{tmp_path}/report"], ["view", out, "--no-open", "--out", f"{tmp_path}/a.html"],
                    ["run", deck, "--out", out, "--quiet", "--restart", "--set", "stop.cycles=5"]):
        assert call(command) == 0, command
    looked_at(tmp_path / "out")


def test_names_in_the_page_of_the_viewer(simulation, tmp_path, monkeypatch):
    hostile = "<img src=x onerror=alert(1)></script>"
    monkeypatch.setattr(fake, "ROD", hostile)
    run(fake.FakeDeck(), tmp_path / "shot", quiet=True)
    shown = page.view([Results(tmp_path / "shot")], ("all",), 8).html
    assert hostile not in shown
    assert "<img src=x" not in shown
