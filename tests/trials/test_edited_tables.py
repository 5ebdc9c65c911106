"""Tables of a study as a person, a spreadsheet or git changes them: read, corrected from the runs, or refused in one line."""

import contextlib
import csv
import functools
import io
import json
import math
import random
import re
import shutil

import pytest

import hydro2d
from hydro2d.cli.main import call
from hydro2d.study.report import panels, pictures
from hydro2d.study.run import cluster
from hydro2d.study.samples import results
from tests.study import made_up
from tests.study.test_sample_table import STUDY, outcome, swept
from tests.trials import spoil

TEXT = STUDY.replace("[sample]", 'keep = "kept.csv"\n[sample]', 1).replace("n = 14", "n = 2") + """
[sample.input."body.rod.material"]
choice = ["W_alloy", "W_sintered"]
[[axis]]
name = "friction"
key = "sliding.friction"
values = ["0.0", "0.1"]
"""
VELOCITY, MATERIAL = "body.rod.velocity [m/s]", "body.rod.material"
#: the line of the changed row
LINE = 4


def cells(change):
    """An edit of the table as lists of cells, the heads first."""

    def edit(text):
        lines = list(csv.reader(io.StringIO(text)))
        out = io.StringIO()
        csv.writer(out, lineterminator="\n").writerows(change(lines) or lines)
        return out.getvalue()

    return edit


def entry(head, value):
    """An edit of one cell; ``value`` : the new text, or a function of the old one."""

    def change(lines):
        column = lines[0].index(head)
        old = lines[LINE - 1][column]
        lines[LINE - 1][column] = value(old) if callable(value) else value

    return cells(change)


def head(old, new):
    return cells(lambda lines: [[new if name == old else name for name in lines[0]], *lines[1:]])


def without(head):
    def change(lines):
        column = lines[0].index(head)
        return [[*line[:column], *line[column + 1 :]] for line in lines]

    return cells(change)


def at(line, change):
    """An edit of one line as text."""

    def edit(text):
        lines = text.splitlines()
        lines[line - 1 : line] = change(lines[line - 1])
        return "\n".join(lines) + "\n"

    return edit


def twice(lines):
    lines[:] = [[*line, line[lines[0].index("depth_m")]] for line in lines]


def deeper(text):
    """The line again with another depth."""
    return entry("depth_m", "0.5")(text).splitlines()[LINE - 1]


def conflict(text):
    ours, theirs = text.splitlines()[LINE - 1], deeper(text)
    return at(LINE, lambda line: ["<<<<<<< HEAD", ours, "=======", theirs, ">>>>>>> branch"])(text)


def commas(text):
    """Semicolons between cells and commas in numbers, as a German spreadsheet writes them."""
    return re.sub(r"(?<=\d)\.(?=\d)", ",", text.replace(",", ";"))


#: edits that change no value
HARMLESS = {
    "a byte order mark": lambda text: "\ufeff" + text,
    "CRLF": lambda text: text.replace("\n", "\r\n"),
    "CR": lambda text: text.replace("\n", "\r"),
    "quotes": lambda text: "\n".join(",".join(f'"{cell}"' for cell in line.split(",")) for line in text.splitlines()),
    "no line feed at the end": lambda text: text.rstrip("\n"),
    "empty lines at the end": lambda text: text + "\n\n",
    "an empty line": at(LINE, lambda line: ["", line]),
    "lines of commas at the end": cells(lambda lines: [*lines, [""] * len(lines[0])]),
    "columns without an entry at the end": cells(lambda lines: [[*line, "", ""] for line in lines]),
    "spaces around cells": cells(lambda lines: [[f" {cell} " for cell in line] for line in lines]),
    "TRUE in capitals": entry("trustworthy", "TRUE"),
    "other digits of a number": entry("depth_m", lambda old: f"{float(old):.9e}"),
    "columns in another order": cells(lambda lines: [line[::-1] for line in lines]),
    "rows in another order": cells(lambda lines: [lines[0], *lines[:0:-1]]),
}
#: edits that no reader believes, with a part of the message
REFUSED = {
    "a head without its unit": (head(VELOCITY, "body.rod.velocity"), '"body.rod.velocity": has no unit'),
    "a head with another unit": (head(VELOCITY, "body.rod.velocity [km/s]"), "body.rod.velocity [km/s]"),
    "a head misspelt": (head("depth_m", "dept_m"), "dept_m"),
    "a head emptied": (head("depth_m", ""), "has no"),
    "a column without a head": (cells(lambda lines: [[*line, "x" if n else ""] for n, line in enumerate(lines)]),
                                '"x" is in a column without a head'),
    "a column twice": (cells(twice), '"depth_m": is there twice'),
    "no row column": (without("row"), 'has no column "row"'),
    "no input column": (without(MATERIAL), f'has no column "{MATERIAL}"'),
    "no status column": (without("status"), 'has no column "status"'),
    "no line of heads": (at(1, lambda line: []), ":1: has no column"),
    "a row too short": (at(LINE, lambda line: [line.rsplit(",", 1)[0]]), f":{LINE}: has"),
    "a row too long": (at(LINE, lambda line: [line + ",7"]), f":{LINE}: has"),
    "semicolons": (lambda text: text.replace(",", ";"), "separated by semicolons"),
    "semicolons and decimal commas": (commas, "separated by semicolons"),
    "tabs": (lambda text: text.replace(",", "\t"), "separated by tabs"),
    "a quote that does not end": (at(LINE, lambda line: ['"' + line]), ": is not a table with commas"),
    "a decimal comma": (entry("depth_m", "0,3"), 'column "depth_m": "0,3" is not a number; write a point'),
    "thousands": (entry(VELOCITY, "1,100.5"), '"1,100.5" is not a number; write a point'),
    "thousands with a space": (entry(VELOCITY, "1 100.5"), '"1 100.5" is not a number'),
    "an underscore": (entry("depth_m", "1_0"), '"1_0" is not a number'),
    "nan": (entry("depth_m", "nan"), f':{LINE}: column "depth_m": "nan" is not a number'),
    "inf": (entry("depth_m", "inf"), '"inf" is not a number'),
    "too large for a number": (entry("depth_m", "1e999"), '"1e999" is not a finite number'),
    "#DIV/0!": (entry("depth_m", "#DIV/0!"), '"#DIV/0!" is not a number'),
    "a date for a number": (entry("depth_m", "1. Mar"), '"1. Mar" is not a number'),
    "a word for a number": (entry(VELOCITY, "fast"), f'column "{VELOCITY}": "fast" is not a number'),
    "a unit in a cell": (entry(VELOCITY, "1100 m/s"), '"1100 m/s" is not a number'),
    "other digits than ours": (entry("depth_m", "٣"), "is not a number"),
    "a word for the row": (entry("row", "second"), 'column "row": "second" is not a whole number'),
    "a fraction for the row": (entry("row", "2.5"), 'column "row": "2.5" is not a whole number'),
    "a row below zero": (entry("row", "-1"), 'column "row"'),
    "an emptied row number": (entry("row", ""), 'column "row": is empty'),
    "an unknown status": (entry("status", "<b>x</b>"), 'column "status": unknown word "<b>x</b>"'),
    "an emptied status": (entry("status", ""), 'column "status": is empty'),
    "an unknown regime": (entry("regime", "Rigid"), 'column "regime": unknown word "Rigid"'),
    "a word for true": (entry("trustworthy", "WAHR"), 'column "trustworthy": unknown word'),
    "a line feed in a cell": (entry("depth_m", "0.3\n1"), "is not a number"),
    "git's marks": (conflict, f":{LINE}: has a mark of git"),
    "a line again with another depth": (lambda text: text + deeper(text) + "\n", "same run"),
    "a material that the study does not have": (entry(MATERIAL, "wolfram"), f'column "{MATERIAL}": unknown word "wolfram"'),
    "an empty file": (lambda text: "", ":1: has no column"),
    "not text": (lambda text: "\udcff" + text, "is not UTF-8 text"),
}
#: edits of kept.csv alone
REFUSED_KEPT = {
    "the label of another run": (entry("friction", lambda old: "0.1" if old == "0.0" else "0.0"), "for the same run; remove"),
    "no depth column": (without("depth_m"), 'has no column "depth_m"'),
    "a hash as a number": (entry("setup", "2.75E+11"), 'column "setup": "2.75E+11" is not a hash'),
    "a version as a date": (entry("method", "11/28/2026"), 'column "method": "11/28/2026" is not a version'),
    "a date of another form": (entry("date", "28.11.2026"), 'column "date"'),
}
#: edits that make a row a plausible one of a run that did not happen, which the run and the set-up correct
PLAUSIBLE = {
    "a number changed": entry("depth_m", "0.5"),
    "a number emptied": entry("depth_m", ""),
    "a regime changed": entry("regime", lambda old: "rigid" if old == "eroding" else "eroding"),
    "a state changed": entry("status", "unphysical"),
    "FALSE in capitals": entry("trustworthy", "FALSE"),
}
#: the same, of entries that say which run it is
OF_ANOTHER = {
    "an input changed": entry(VELOCITY, "1111.5"),
    "a material renamed": entry(MATERIAL, lambda old: "W_alloy" if old == "W_sintered" else "W_sintered"),
    "a label changed": entry("friction", "0.2"),
    "another row number": entry("row", "7"),
}
#: edits of kept.csv that only the study makes wrong, and those that a sweep corrects
CORRECTED = ("a head with another unit", "no input column", "a material that the study does not have")
OF_THE_SAMPLE = (*CORRECTED, "no row column", "thousands", "thousands with a space", "a word for a number", "a unit in a cell",
                 "a word for the row", "a fraction for the row", "a row below zero", "an emptied row number",
                 "a head without its unit")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A study with kept rows and all of its runs, and what it says."""
    folder = tmp_path_factory.mktemp("made")
    swept(folder, lambda velocity, deck: outcome(velocity, deck) | {"trustworthy": True}, TEXT)
    return folder, truth(folder)


@pytest.fixture
def folder(made, tmp_path, monkeypatch):
    """A copy of the study; its report draws nothing, and a run would be made up."""
    place = tmp_path / "study"
    shutil.copytree(made[0], place)
    client = made_up.Client(lambda velocity, deck: pytest.fail("a run was made again"))
    monkeypatch.setattr(cluster, "local", lambda *_, **__: client.connect())
    monkeypatch.setattr(panels, "draw", lambda *_: ())
    monkeypatch.setattr(pictures, "draw", lambda *_: ())
    monkeypatch.setattr(results.Samples, "usual", [])
    return place


def truth(folder):
    """What the readers of Python say, as plain data."""
    return [*of_samples(folder), *of_kept(folder)]


def of_samples(folder):
    study = hydro2d.open_study(folder / "out")
    return [plain(study.samples({"friction": label})) for label in ("0.0", "0.1")]


def of_kept(folder):
    runs = hydro2d.runs(folder / "kept.csv").sort_values(["friction", "row"])
    by_run = runs[["friction", "row", VELOCITY, MATERIAL, "status", "regime", "trustworthy", "depth_m"]].to_csv(index=False)
    return [by_run, *sorted((plain(each) for each in hydro2d.kept_samples(folder / "search.toml")), key=str)]


def plain(samples):
    names = ("row", VELOCITY, MATERIAL, "body.rod.strength_factor", "status", "regime", "perforated", "trustworthy")
    depths = [f"{depth:.6g}" for depth in samples.values("depth_m")]
    return samples.labels, [samples.table[name].astype(str).tolist() for name in names if name in samples.table], depths


def write(file, edit):
    file.write_bytes(edit(file.read_text()).encode(errors="surrogateescape"))


def commands(folder, *names):
    """The commands that read the tables; each returns its status and what it says in one line if that is not 0."""
    out = str(folder / "out")
    every = {
        "status": ["sweep", out, "--status"], "report": ["report", out], "check": ["sweep", f"{folder}/search.toml", "--check"],
        "sweep": ["sweep", f"{folder}/search.toml", "--resume", "--out", out],
    }
    for name in names:
        status, said = spoil.judge(every[name], (0, 2))
        assert said.count("\n") == (status != 0), said
        yield status, said


def refused(folder, file, said, names, readers):
    """Every command and reader refuses the file in one line with its path and ``said``."""
    for status, words in commands(folder, *names):
        assert (status, f"{file}:" in words, said in words) == (2, True, True), words
    for read in readers:
        with pytest.raises(hydro2d.StudyError) as error:
            read()
        assert "\n" not in str(error.value)
        assert str(error.value).startswith(f"{file}:")
        assert said in str(error.value)


@pytest.mark.parametrize("name", HARMLESS)
def test_what_a_spreadsheet_does_to_every_table_is_read(name, made, folder):
    for file in ("out/samples.csv", "kept.csv"):
        write(folder / file, HARMLESS[name])
    assert truth(folder) == made[1]
    assert hydro2d.open_study(folder / "out").table()["depth_m"].notna().all()
    assert [status for status, _ in commands(folder, "status", "report", "check", "sweep")] == [0] * 4
    assert truth(folder) == made[1]


@pytest.mark.thorough
@pytest.mark.parametrize("name", REFUSED)
def test_samples_that_no_sweep_wrote_are_refused(name, made, folder):
    edit, said = REFUSED[name]
    write(folder / "out" / "samples.csv", edit)
    study = hydro2d.open_study(folder / "out")
    refused(folder, folder / "out" / "samples.csv", said, ("status", "report"), [lambda: study.samples({"friction": "0.1"})])
    assert [status for status, _ in commands(folder, "sweep", "status")] == [0, 0], "a sweep writes the table anew"
    assert truth(folder) == made[1]


@pytest.mark.thorough
@pytest.mark.parametrize("name", REFUSED | REFUSED_KEPT)
def test_kept_rows_that_no_sweep_wrote_are_refused(name, made, folder):
    """Columns of the sample mean nothing to `runs`, which knows no study. A sweep knows inputs from the set-up."""
    edit, said = (REFUSED | REFUSED_KEPT)[name]
    file = folder / "kept.csv"
    write(file, edit)
    before = file.read_bytes()
    readers = [lambda: hydro2d.kept_samples(folder / "search.toml"), lambda: hydro2d.runs(file)]
    refused(folder, file, said, () if name in CORRECTED else ("check", "sweep"), readers[: 1 if name in OF_THE_SAMPLE else 2])
    assert file.read_bytes() == before, "the file is as it was"
    if name in CORRECTED:
        assert [status for status, _ in commands(folder, "check", "sweep")] == [0, 0]
        assert truth(folder) == made[1]


@pytest.mark.parametrize("name", PLAUSIBLE)
def test_a_run_beside_its_row_decides(name, made, folder, capsys):
    write(folder / "out" / "samples.csv", PLAUSIBLE[name])
    study = hydro2d.open_study(folder / "out")
    samples = [study.samples({"friction": label}) for label in ("0.0", "0.1")]
    assert [plain(each) for each in samples] == made[1][:2]
    (said,) = (doubt for each in samples for doubt in each.doubts)
    assert re.search(rf"samples\.csv:{LINE}: column .* is ignored: the run has ", said)
    assert [status for status, _ in commands(folder, "status", "report")] == [0, 0]
    write(folder / "kept.csv", PLAUSIBLE[name])
    assert call(["sweep", f"{folder}/search.toml", "--resume", "--out", f"{folder}/out"]) == 0
    assert re.search(rf"kept\.csv:{LINE}: column .* is corrected: its run has ", capsys.readouterr().out)
    assert truth(folder) == made[1]


@pytest.mark.parametrize("name", OF_ANOTHER)
def test_a_row_of_another_run_is_refused_or_corrected_from_its_set_up(name, made, folder, capsys):
    """A sweep knows the run of a row by its set-up, also without the runs."""
    write(folder / "out" / "samples.csv", OF_ANOTHER[name])
    study = hydro2d.open_study(folder / "out")
    refused(folder, folder / "out" / "samples.csv", f"samples.csv:{LINE}: ", ("status", "report"),
            [lambda: study.samples({"friction": "0.1"})])
    shutil.rmtree(folder / "out")
    write(folder / "kept.csv", OF_ANOTHER[name])
    assert call(["sweep", f"{folder}/search.toml", "--out", f"{folder}/out"]) == 0
    assert re.search(rf"kept\.csv:{LINE}: column .* is corrected: its set-up has ", capsys.readouterr().out)
    assert of_kept(folder) == made[1][2:]


def test_a_row_that_is_gone_and_one_that_is_wrong_come_from_the_runs(made, folder, capsys):
    write(folder / "kept.csv", lambda text: at(LINE, lambda line: [deeper(text)])(text).rstrip("\n").rsplit("\n", 1)[0] + "\n")
    assert call(["sweep", f"{folder}/search.toml", "--resume", "--out", f"{folder}/out"]) == 0
    assert f'kept.csv:{LINE}: column "depth_m": "0.5" is corrected: its run has "' in capsys.readouterr().out
    assert truth(folder) == made[1]


def test_a_line_twice_is_read_once(made, folder):
    write(folder / "kept.csv", at(LINE, lambda line: [line, line]))
    assert truth(folder) == made[1]


def test_two_depths_of_one_set_up_are_refused(folder):
    write(folder / "kept.csv", lambda text: text + entry("friction", "0.3")(at(LINE, lambda line: [deeper(text)])(text))
          .splitlines()[LINE - 1])
    refused(folder, folder / "kept.csv", "for the same set-up; remove the line that is wrong", ("check", "sweep"),
            [lambda: hydro2d.runs(folder / "kept.csv")])


def places(value, place=()):
    """The places of all values in plain data."""
    yield place
    for key in value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ():
        yield from places(value[key], (*place, key))


#: in place of a value of study.json; the first: nothing
ODD = (None, 0, -1, 7, 1e400, math.nan, "", "x", [], {}, [1], {"a": 1}, True, ["a", "a"], "1" * 5000)


def edited(folder, seeds):
    """Reads the study with one odd value in study.json for each seed; returns how many were refused."""
    file, refused = folder / "out" / "study.json", 0
    whole = json.loads(file.read_text())
    whole.pop("sha256")
    for seed in seeds:
        chance, data = random.Random(seed), json.loads(json.dumps(whole))
        *path, last = chance.choice(list(places(data))[1:])
        within = functools.reduce(lambda value, key: value[key], path, data)
        if chance.random() < 0.1:
            del within[last]
        else:
            within[last] = chance.choice(ODD)
        file.write_text(json.dumps(data))
        refused += [status for status, _ in commands(folder, "status")] == [2]
        with contextlib.suppress(hydro2d.StudyError):
            hydro2d.open_study(folder / "out").samples({"friction": "0.1"}).doubts  # noqa: B018
    return refused


def test_values_of_study_json_that_no_sweep_writes(folder):
    assert 10 < edited(folder, range(40)) < 40


@pytest.mark.slow
def test_two_thousand_values_of_study_json(folder, tell):
    refused = edited(folder, range(2000))
    tell(f"2000 values of study.json, {refused} refused in words, 0 failures")
    assert refused > 500
