"""Every command with a full disk, a disk error or its end at each of its writes, and every two commands at once.

A documented status and one line; nothing half written; the command started again ends, with the results of an undisturbed one.
"""

import csv
import io
import json
import os
import random
import re
import shutil

import pytest

from hydro2d.base.errors import Error
from hydro2d.files.whole import read_json
from hydro2d.jit import store
from hydro2d.output import history, snapshot
from hydro2d.running.run import COSTS
from tests.trials import forks
from tests.trials.forks import COMMANDS, FAULTS, FULL, KILLED, ONCE, Fault

#: entries of a summary, and columns of kept rows, that are other ones every time
OWN = ("wall_s", *COSTS, "ns_per_cell_cycle", "provenance", "sha256")
OWN_COLUMNS = ("wall_s", "commit", "date")
#: what a command needs that comes first
NEEDS = {"report": ("sweep",), "report of a sample": ("sample",), "view": ("run",), "export": ("run",), "status": ("sweep",)}
#: when a page was made
MADE = re.compile(rb"\d{4}-\d\d-\d\d \d\d:\d\d UTC")
STUDIES = ("sweep", "sample", "search")
#: files that no result is in
ASIDE = re.compile(r"\.lock$|^(log\.txt|sweep\.log|restart\.previous\.h5|progress\.json)$|^\..*")


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with forks.server(tmp_path_factory.mktemp("said")) as server:
        yield server


@pytest.fixture(scope="module")
def undisturbed(server, tmp_path_factory):
    """For each command a folder in which it can begin, what it writes, and the results."""
    known = {}

    def of(name):
        if name not in known:
            folder = tmp_path_factory.mktemp("begin")
            forks.write(folder)
            for needed in NEEDS.get(name, ()):
                assert server.run(folder, *COMMANDS[needed]).status == 0
            ended = shutil.copytree(folder, tmp_path_factory.mktemp("end") / "end")
            done = server.run(ended, *COMMANDS[name])
            assert done.status == 0, done.said
            known[name] = folder, done.writes, results(ended)
        return known[name]

    return of


def results(folder):
    """The contents of all files of a folder that have results, without what is another one every time."""
    files = (file for file in sorted(folder.rglob("*")) if file.is_file() and not ASIDE.search(file.name))
    return {file.relative_to(folder).as_posix(): contents(file) for file in files}


def contents(file):
    """Raises Error or ValueError if the file is half written."""
    if file.suffix == ".json":
        return json.dumps({key: value for key, value in read_json(file, Error).items() if key not in OWN})
    if file.name == "history.h5":
        return {name: column.tobytes() for name, column in history.read(file).items()}
    if file.name == "restart.h5":
        saved = snapshot.read(file)
        return saved.arrays["e"].tobytes(), saved.scalars
    if file.name == "kept.csv":
        rows = csv.DictReader(io.StringIO(file.read_text()), strict=True)
        return [{name: text for name, text in row.items() if name not in OWN_COLUMNS} for row in rows]
    if file.suffix == store.ENDING:
        head, _, code = file.read_bytes().partition(b"\n")
        if head.split()[1] != store._checksum(file, code):
            raise ValueError(f"{file} is damaged")
        return ""
    return MADE.sub(b"", file.read_bytes())


def place(name):
    """The directory that a command works in."""
    command = COMMANDS[name]
    return "code" if name == "compile" else command[3] if "--out" in command else command[1]


def again(server, folder, name):
    """Starts a command again as a user would: it continues what it has begun."""
    out, further = folder / place(name), []
    if name in STUDIES and (out / "study.json").exists():
        further = ["--resume"]
    elif name == "run" and out.exists():
        saved = any((out / file).exists() for file in (snapshot.NAME, snapshot.PREVIOUS))
        further = ["--restart"] if saved else ["--overwrite"]
    return server.run(folder, *COMMANDS[name], *further)


def refused_in_a_line(done):
    """Whether a command has said in one line on its own why it was refused, with no temporary name."""
    lines = [line for line in done.said.splitlines() if line.startswith("hydro2d: ")]
    return len(lines) == 1 and ".tmp" not in lines[0] and done.said.rstrip().endswith(lines[0])


def judged(done, what, name, whole, folder):
    """What is wrong with a command after a fault; empty if nothing is."""
    said = done.said
    if what == KILLED:
        return "" if done.status == -9 else f"not killed: {done.status}"
    if "Traceback" in said:
        return "a traceback"
    if done.status not in (0, 3, 4):
        return f"status {done.status}"
    if done.status == 4 and not refused_in_a_line(done):
        return "no line of its own"
    error = os.strerror(FAULTS[what])
    told = error in said or "the disk is full: " in said
    if done.status and not told:
        return "the error is not named"
    if done.status == 4 and not re.search(rf"(?<!hydro2d): {error}|{error}: \S", said):
        return "the place is not named"
    if done.status == 0 and not told and results(folder) != whole:
        return "nothing was said, and results are missing"
    if left := [file.name for file in folder.rglob(".*") if file.name.endswith(".tmp")]:
        return f"left behind: {left}"
    return ""


def tried(server, undisturbed, folder, name, at, what):
    """One trial: what is wrong; empty if nothing is."""
    begin, writes, whole = undisturbed(name)
    shutil.copytree(begin, folder)
    done = server.run(folder, *COMMANDS[name], fault=Fault(at, what))
    if wrong := judged(done, what, name, whole, folder):
        return f"{wrong}\n{done.said}"
    try:
        found = results(folder)
    except (Error, ValueError, csv.Error) as error:
        return f"half written: {error}"
    if name not in ("run", *STUDIES):
        half = [file for file, text in found.items() if whole.get(file) != text]
        if half:
            return f"half written: {half}"
    next_time = again(server, folder, name)
    if next_time.status:
        return f"not again: {next_time.status}\n{next_time.said}"
    now = results(folder)
    if now != whole:
        other = [file for file in {*now, *whole} if now.get(file) != whole.get(file)]
        return f"other results: {other}"
    shutil.rmtree(folder)
    return ""


def sampled(writes, seed, most_in_cases):
    """Numbers of the writes of a command: all, but only some of those of runs, which have trials of their own."""
    within = [n for n, text in enumerate(writes, 1) if re.search(r"/cases/.*/|^\w+ run/(?!export|\.?view)", text)]
    some = set(random.Random(seed).sample(within, min(most_in_cases, len(within))))
    return [n for n in range(1, len(writes) + 1) if n in some or n not in within]


def trials(server, undisturbed, folder, name, seed=0, most=12):
    """Every fault at every write, but at most so many writes of runs; returns the number of trials."""
    _, writes, _ = undisturbed(name)
    cases = [(at, what) for at in sampled(writes, seed, most) for what in FAULTS]
    wrong = [tried(server, undisturbed, folder / f"{at}{what}", name, at, what) for at, what in cases]
    fell = [f"{name}, {what} at {at} of {len(writes)} ({writes[at - 1]}): {each}"
            for (at, what), each in zip(cases, wrong, strict=True) if each]
    assert not fell, f"{len(fell)} of {len(cases)}:\n" + "\n".join(fell)
    return len(cases)


@pytest.mark.parametrize(("name", "written", "what"), [
    ("sweep", "open study/.study.json", KILLED), ("sweep", "fsync rows/.kept.csv", FULL), ("run", "write run/run.lock", FULL),
    ("view", "fsync run/.view.html", ONCE), ("export", "rename run/export/history.csv", KILLED),
    ("compile", "fsync code/.test_store.add", KILLED),
])
def test_a_fault_at_some_writes(server, undisturbed, tmp_path, name, written, what):
    at = next(n for n, text in enumerate(undisturbed(name)[1], 1) if text.startswith(written))
    assert tried(server, undisturbed, tmp_path / "place", name, at, what) == ""


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in COMMANDS if name != "status"])
def test_a_fault_at_each_write(server, undisturbed, tmp_path, name, tell):
    tell(f"{name}: {trials(server, undisturbed, tmp_path, name)} faults, 0 fell")


#: commands that write into or read from what another one of them uses at the same time
CROWD = {
    **COMMANDS, "plot": ["plot", "run", "--out", "picture.png"], "report of a run": ["report", "run"],
    "status of a run": ["status", "run"], "search in its place": [*COMMANDS["search"][:3], *COMMANDS["sweep"][3:]],
    "sweep of one case": ["sweep", "study.toml", "--out", "one", "--only", "900m-s", "--workers", "1"],
    "sweep of the other": ["sweep", "study.toml", "--out", "other", "--only", "1100m-s", "--workers", "1"],
}
PAIRS = [("run", "run"), ("run", "view"), ("run", "export"), ("run", "report of a run"), ("run", "status of a run"),
         ("run", "plot"), ("view", "view"), ("export", "export"), ("compile", "compile"), ("report", "report"),
         ("sweep", "sweep"), ("sweep", "report"), ("sweep", "status"), ("sweep", "search in its place"), ("search", "search"),
         ("search", "sweep"), ("sample", "sample"), ("sample", "report of a sample"),
         ("sweep of one case", "sweep of the other")]
#: how often each pair is tried, with another seed each time
TIMES = 10
#: options with which a command that writes begins again in the directory of the other one
ANEW = {"run": ["--overwrite"], **dict.fromkeys((*STUDIES, "search in its place"), ["--resume"])}


def two_at_once(server, undisturbed, folder, pair, seed):
    """What is wrong after two commands at once, on what one of them has made before or on nothing; empty if nothing is."""
    chance, first = random.Random(seed), pair[0] if pair[0] in COMMANDS else "sweep"
    begin, _, whole = undisturbed(first)
    shutil.copytree(begin, folder)
    before = pair[0] in COMMANDS and chance.random() < 0.5
    if before:
        assert server.run(folder, *COMMANDS[first]).status == 0
    commands = [[*CROWD[name], *(ANEW.get(name, []) if before else [])] for name in pair]
    ended = server.together(folder, *commands, delays=[chance.choice((0.0, chance.uniform(0.0, 0.3))) for _ in pair])
    for name, done in zip(pair, ended, strict=True):
        if "Traceback" in done.said or done.status not in (0, 2, 3, 4):
            return f"{name}: status {done.status}\n{done.said}"
        if done.status in (2, 4) and not refused_in_a_line(done):
            return f"{name}: no line of its own\n{done.said}"
    if all(done.status for done in ended):
        return "neither has ended\n" + "".join(done.said for done in ended)
    if left := [file.name for file in folder.rglob(".*") if file.name.endswith(".tmp")]:
        return f"left behind: {left}"
    now = results(folder)  # none is half written
    if "search in its place" in pair:  # a directory is that of the first to come
        return ""
    if pair[0] not in COMMANDS:
        return "" if now["rows/kept.csv"] == whole["rows/kept.csv"] else "a row is lost"
    next_time = again(server, folder, first)
    if next_time.status:
        return f"not again: {next_time.status}\n{next_time.said}"
    now, places = results(folder), ("rows", place(first))
    other = [file for file in whole if file.partition("/")[0] in places and now.get(file) != whole[file]]
    return f"other results: {other}" if other else ""


def test_two_sweeps_at_once(server, undisturbed, tmp_path):
    assert two_at_once(server, undisturbed, tmp_path / "both", ("sweep", "sweep"), 0) == ""


@pytest.mark.slow
@pytest.mark.parametrize("pair", PAIRS, ids=" and ".join)
def test_two_commands_at_once(server, undisturbed, tmp_path, pair, tell):
    wrong = [two_at_once(server, undisturbed, tmp_path / str(seed), pair, seed) for seed in range(TIMES)]
    fell = [f"seed {seed}: {each}" for seed, each in enumerate(wrong) if each]
    assert not fell, f"{len(fell)} of {TIMES}:\n" + "\n".join(fell)
    tell(f"{' and '.join(pair)}: {TIMES} times at once, 0 fell")
