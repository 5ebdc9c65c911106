"""Run and study directories from someone else: nothing outside them is read or written, and no command waits for ever."""

import json
import os
import re
import shutil
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path

import h5py
import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.files.locks import LockError, holder, locked
from hydro2d.files.strange import StrangeFile, own, within
from hydro2d.files.whole import replacing
from hydro2d.output import history, snapshot, vtk
from hydro2d.results.export import export
from hydro2d.results.reading import Results
from hydro2d.running.run import run as start
from hydro2d.study.records import study_directory
from tests import fake

SERIES = '<VTKFile><Collection><DataSet timestep="0" file="{}"/></Collection></VTKFile>'
SECRET = "someone's own file\n"


@pytest.fixture
def secret(tmp_path):
    """A file of the user's that no command is asked to touch."""
    file = tmp_path / "home" / "secret"
    file.parent.mkdir()
    file.write_text(SECRET)
    return file


@pytest.mark.parametrize("name", ["../home/secret", "/etc/hostname", "vtk/../../home/secret", "secret", "vtk/a/b.vtp",
                                  "vtk/.x.vtp", "vtk/x.vtm", "vtk/"])
@pytest.mark.parametrize("kind", ["dump", "interfaces"])
def test_a_series_names_only_vtk_files_in_its_folder(finished, secret, tmp_path, kind, name, capsys):
    (finished / vtk.SERIES[kind]).write_text(SERIES.format(name))
    with pytest.raises(vtk.VtkError, match=r"only VTK files in vtk/"):
        vtk.read_series(finished / vtk.SERIES[kind])
    assert call(["export", str(finished), "-o", str(tmp_path / "out" / "deep")]) == 2
    assert secret.read_text() == SECRET
    assert not list((tmp_path / "out").rglob("*secret*"))


@pytest.mark.parametrize("there", ["vtk", "vtk/interfaces_000000.vtp", "interfaces.pvd", "history.csv"])
def test_export_writes_through_no_link(finished, secret, tmp_path, there):
    out = tmp_path / "out"
    link = out / there
    link.parent.mkdir(parents=True)
    target = secret if "." in there else secret.parent
    link.symlink_to(target)
    with pytest.raises(StrangeFile, match="symbolic link") if there == "vtk" else nullcontext():
        export(Results(finished), out)
    assert secret.read_text() == SECRET
    assert os.listdir(secret.parent) == ["secret"]


@pytest.mark.parametrize("there", ["vtk", "vtk/interfaces_000000.vtp", "vtk/dump_000000.vtr", "interfaces.pvd", "series.pvd",
                                   "history.h5", "deck.toml", "summary.json"])
def test_a_run_is_not_read_through_links(finished, tmp_path, there, capsys):
    place, aside = finished / there, tmp_path / "aside"
    shutil.move(place, aside)
    place.symlink_to(aside)
    assert call(["export", str(finished), "-o", str(tmp_path / "out")]) == 2
    assert "is a symbolic link; hydro2d follows none inside a run or a study" in capsys.readouterr().err


def test_export_and_report_follow_no_link_in_their_usual_place(finished, secret):
    for name, command in (("export", "export"), ("report", "report")):
        (finished / name).symlink_to(secret.parent)
        assert call([command, str(finished)]) == 2
    assert os.listdir(secret.parent) == ["secret"]


@pytest.mark.parametrize("name", ["run.lock", "log.txt", "history.h5", "restart.h5", "vtk", "progress.json"])
@pytest.mark.parametrize("options", [{"restart": True}, {"overwrite": True}])
def test_a_run_is_not_continued_through_a_link(finished, secret, name, options):
    target = secret.parent if name == "vtk" else secret
    place = finished / name
    if place.is_dir():
        shutil.rmtree(place)
    place.unlink(missing_ok=True)
    place.symlink_to(target)
    (target / "dump_000000.vtr").touch() if name == "vtk" else None
    with pytest.raises(StrangeFile, match=f"{name} is a symbolic link"):
        start(fake.FakeDeck(), finished, quiet=True, **options)
    assert secret.read_text() == SECRET
    assert name != "vtk" or (target / "dump_000000.vtr").exists()


def test_a_lock_is_no_link(tmp_path, secret):
    lock = tmp_path / "run.lock"
    lock.symlink_to(secret)
    with pytest.raises(StrangeFile), locked(lock):
        pass
    assert secret.read_text() == SECRET
    lock.unlink()
    with locked(lock), pytest.raises(LockError), locked(lock):
        pass


def test_no_link_can_wait_where_a_file_is_written_first(tmp_path, secret):
    with replacing(tmp_path / "file") as one, replacing(tmp_path / "file") as other:
        assert one != other
        for each in (one, other):
            each.write_text("")


COMMANDS = {
    "deck.toml": ["report {}", "plot {} -o {}.png"], "summary.json": ["report {}", "export {} -o {}.out"],
    "history.h5": ["plot {} --kind history -o {}.png", "report {}", "view {} --no-open"],
    "series.pvd": ["movie {} -o {}.gif", "view {} --no-open"],
    "interfaces.pvd": ["report {}", "export {} -o {}.out"], "vtk/dump_000000.vtr": ["movie {} -o {}.gif"],
    "view.html": ["view {} --no-open"],
    "vtk/interfaces_000000.vtp": ["export {} -o {}.out"], "failed.json": ["report {}"], "run.lock": ["report {}"],
    "restart.h5": ["run problems/perforation/sphere.toml --restart --out {}"],
    "log.txt": ["run problems/perforation/sphere.toml --restart --out {}"],
    "vtk": ["run problems/perforation/sphere.toml --restart --out {}"],
}


def test_a_pipe_in_a_run_ends_commands_in_words(finished, tmp_path):
    """In a process of its own, which is stopped if it waits."""
    asked = []
    for name, commands in COMMANDS.items():
        place = tmp_path / name.replace("/", "_")
        shutil.copytree(finished, place)
        if (place / name).is_dir():
            shutil.rmtree(place / name)
        (place / name).unlink(missing_ok=True)
        os.mkfifo(place / name)
        asked += [(name, command.format(place, place).split()) for command in commands]
    script = (
        "import contextlib, io, json, sys\n"
        "from hydro2d.cli.main import call\n"
        "for name, command in json.loads(sys.argv[1]):\n"
        "    said = io.StringIO()\n"
        "    with contextlib.redirect_stderr(said):\n"
        "        status = call(command)\n"
        "    text = said.getvalue()\n"
        "    if status != 2 or text.count('\\n') != 1 or ' is a pipe' not in text:\n"
        "        sys.exit(f'{command}: {status}, {text}')\n"
    )
    done = subprocess.run([sys.executable, "-c", script, json.dumps(asked)],
                          capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", ["study.json", "sweep.log", "study.lock"])
def test_a_study_has_no_pipes_and_no_links(tmp_path, secret, name):
    study = tmp_path / "study"
    for make in (os.mkfifo, lambda place: place.symlink_to(secret)):
        study.mkdir()
        make(study / name)
        with pytest.raises(StrangeFile):
            study_directory.make(study)
        shutil.rmtree(study)
    study.mkdir()
    (study / "cases").symlink_to(secret.parent)
    with pytest.raises(StrangeFile):
        study_directory.make(study)


@pytest.mark.parametrize("directory", ["../home", "/etc", "cases/../../home", "cases", "cases/a/b", ""])
def test_cases_of_a_study_are_in_its_folder_of_cases(tmp_path, directory):
    (tmp_path / "study.json").write_text(
        json.dumps({"name": "a", "axes": [], "cases": [{"name": "a", "values": {}, "directory": directory}]}))
    with pytest.raises((study_directory.StudyError, StrangeFile), match=r"must be in cases/|does not name a file"):
        study_directory.read(tmp_path)


def test_the_directory_of_a_case_is_no_link(tmp_path, secret):
    (tmp_path / "study.json").write_text(
        '{"name": "a", "axes": [], "cases": [{"name": "a", "values": {}, "directory": "cases/a"}]}')
    (tmp_path / "cases").mkdir()
    assert study_directory.read(tmp_path).cases[0].directory == tmp_path / "cases" / "a"
    (tmp_path / "cases" / "a").symlink_to(secret.parent)
    with pytest.raises(StrangeFile, match="symbolic link"):
        study_directory.read(tmp_path)


def test_files_that_the_user_names_may_be_links_but_no_pipes(tmp_path, capsys):
    deck = tmp_path / "deck.toml"
    os.mkfifo(tmp_path / "pipe.toml")
    deck.symlink_to(Path("problems/perforation/sphere.toml").resolve())
    assert call(["check", str(deck)]) == 0
    for command in (["check"], ["sweep", "--check"], ["check-model"]):
        assert call([command[0], str(tmp_path / "pipe.toml"), *command[1:]]) == 2
    deck.unlink()
    deck.write_text(f'include = "{tmp_path / "pipe.toml"}"')
    assert call(["check", str(deck)]) == 2
    deck.write_text('include = "/dev/zero"')
    assert call(["check", str(deck)]) == 2


@pytest.mark.parametrize("name", ["/etc/passwd", "../x", "vtk/../../x", "", "\0"])
def test_names_that_lead_elsewhere(tmp_path, name):
    with pytest.raises(StrangeFile):
        within(tmp_path, name)
    assert own(tmp_path / "not there") == tmp_path / "not there"


# ------------------------------------------------------------------------------------------------ contents that lead elsewhere


def _spoiled(finished, change):
    with h5py.File(finished / "history.h5", "r+") as file:
        change(file)
    return finished / "history.h5"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda file: file.update({"a": h5py.ExternalLink("/dev/zero", "/a")}), "is a link"),
        (lambda file: file.update({"a": h5py.SoftLink("/time")}), "is a link"),
        (lambda file: file.create_dataset("a", shape=(8,), dtype="f8", external=[("/dev/zero", 0, 64)]), "another file"),
        (lambda file: file.create_dataset("a", shape=(10**12,), dtype="f8", chunks=(10**6,)), "more than the file can hold"),
        (lambda file: file.update({"crater/inner": file}), "group in a group"),
    ],
)
def test_hdf5_that_leads_elsewhere_or_claims_too_much(finished, change, said):
    with pytest.raises(history.HistoryError, match=said):
        history.read(_spoiled(finished, change))


def test_a_restart_file_claims_no_more_than_it_holds(finished):
    with h5py.File(finished / "restart.h5", "r+") as file:
        file["arrays"].create_dataset("huge", shape=(10**11,), dtype="f8", chunks=(10**6,))
    with pytest.raises(snapshot.SnapshotError, match="more than the file can hold"):
        snapshot.read(finished / "restart.h5")


def unsealed(file):
    """The contents of a VTK file or a series without the comment with its checksum, as someone else would write it."""
    return re.sub(rb"<!-- sha256 [0-9a-f]{64} -->\n", b"", file.read_bytes())


LAUGHS = '<!DOCTYPE a [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]>'


def test_xml_has_no_entities(finished):
    series, dump = finished / "series.pvd", finished / "vtk" / "dump_000000.vtr"
    series.write_bytes(unsealed(series).replace(b"<VTKFile", LAUGHS.encode() + b"<VTKFile"))
    with pytest.raises(vtk.VtkError, match="declarations"):
        vtk.read_series(series)
    dump.write_bytes(unsealed(dump).replace(b"<VTKFile", LAUGHS.encode() + b"<VTKFile"))
    with pytest.raises(vtk.VtkError, match="declarations"):
        vtk.read_grid(dump)


def test_a_dump_describes_no_more_than_it_holds(finished):
    dump = finished / "vtk" / "dump_000000.vtr"
    assert vtk.read_grid(dump).shape == (55, 12)
    dump.write_bytes(unsealed(dump).replace(b'Extent="0 12 0 55 0 0"', b'Extent="0 99999 0 99999 0 0"'))
    for read in (vtk.read_grid, vtk.pyvista_grid):
        with pytest.raises(vtk.VtkError, match="describes 10000000000 values"):
            read(dump)


def test_names_with_commas_in_csv(tmp_path):
    import csv

    columns = {"time": np.array([0.0, 1.0]), 'tracer_a,b "c"_r_m': np.array([2.0, 3.0]), "tracer_Ω_r_m": np.array([4.0, 5.0])}
    history.write_csv(columns, tmp_path / "history.csv")
    with open(tmp_path / "history.csv", newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head == ["time [s]", 'tracer_a,b "c"_r_m [m]', "tracer_Ω_r_m [m]"]
    assert [[float(word) for word in row] for row in rows] == [[0.0, 2.0, 4.0], [1.0, 3.0, 5.0]]


@pytest.mark.parametrize("text", [
    "[" * 100_000, '{"a": ' * 100_000, '{"time_s": 1, "cycles": 2, "ns_per_cell_cycle": 3, "cells": ' + "9" * 4000 + "}",
    '{"time_s": 1e999}'])
def test_json_that_is_too_deep_or_too_large(finished, text, tmp_path, capsys):
    (finished / "summary.json").write_text(text)
    assert call(["plot", str(finished), "-o", str(tmp_path / "a.png")]) == (2 if "a" in text or text.startswith("[") else 0)
    assert call(["report", str(finished)]) == 0
    assert "Traceback" not in capsys.readouterr().err


def test_a_deck_in_a_run_that_is_too_deep(finished, capsys):
    (finished / "deck.toml").write_text("a = " + "[" * 100_000)
    assert call(["export", str(finished)]) == 2
    assert call(["report", str(finished)]) == 0
    assert "deck.toml cannot be read" in capsys.readouterr().out


@pytest.mark.parametrize(("text", "held"), [("there " + "9" * 10_000, True), ("x" * 10**6, False)])
def test_a_lock_is_read_to_no_great_length(tmp_path, text, held):
    lock = tmp_path / "run.lock"
    lock.write_text(text)
    assert len(str(holder(lock))) < 1100
    with pytest.raises(LockError) if held else nullcontext(), locked(lock):
        pass


@pytest.mark.parametrize(("place", "number"), [(0, 0), (0, 2**32 - 1), (0, 2**31 - 1), (1, 0), (1, 2**32 - 1), (3, 2**31 - 1)])
def test_a_dump_whose_blocks_would_end_the_process(finished, place, number):
    dump = finished / "vtk" / "dump_000000.vtr"
    data = bytearray(dump.read_bytes())
    at = data.index(b"_", data.index(b"<AppendedData")) + 1 + 4 * place
    data[at : at + 4] = number.to_bytes(4, "little")
    dump.write_bytes(bytes(data))
    with pytest.raises(vtk.VtkError, match="blocks"):
        vtk.read_grid(dump)
