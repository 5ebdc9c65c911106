"""Commands that are stopped at any moment, have no room to write or no reader: one line, a documented status, and a state from
which a run continues to the same bits."""

import hashlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hydro2d.output import snapshot
from tests.cli.test_main import DECK
from tests.trials.conftest import FEW
from tests.trials.test_texts import STUDY

ROOT = Path(__file__).parents[2]
#: result of a signal to a command: hydro2d's status, or the signal itself before hydro2d has started
STATUS = {signal.SIGHUP: 129, signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -9}
STOPPING = (signal.SIGHUP, signal.SIGINT, signal.SIGTERM)
CYCLES = ["--set", "stop.cycles=400", "--set", "output.restart_interval='0.05 s'", "--set", "output.vtk_interval='1 us'"]


def begun(arguments, **options):
    """A command as a process of its own; its output on stderr can be read."""
    command = [sys.executable, "-m", "hydro2d", *arguments]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **options)


def ended(process, expected, limit=120):
    """Its status, which must be one of those expected, with no more than a line or two on stderr."""
    said = process.communicate(timeout=limit)[1]
    if "init_import_site" in said:  # Python itself had not started yet
        return process.returncode
    assert process.returncode in expected, (process.returncode, said)
    assert process.returncode == -signal.SIGINT or "Traceback" not in said, said
    return process.returncode


def state(directory):
    """A hash of all arrays of the restart file."""
    arrays = snapshot.read(directory / snapshot.NAME).arrays
    return hashlib.sha256(b"".join(name.encode() + arrays[name].tobytes() for name in sorted(arrays))).hexdigest()


def leftovers(directory):
    """Files that are half written, and not among those that are complete."""
    return [file for file in directory.rglob(".*") if file.is_file() and file.suffix == ".tmp"]


@pytest.fixture(scope="module")
def shot(tmp_path_factory):
    """A deck, its final state, and the seconds that it takes."""
    folder = tmp_path_factory.mktemp("shot")
    (folder / "shot.toml").write_text(DECK)
    arguments = ["run", str(folder / "shot.toml"), *CYCLES, "--quiet", "--threads", "1"]
    ended(begun([*arguments, "--out", str(folder / "warm")]), (0,))  # compiles
    start = time.monotonic()
    ended(begun([*arguments, "--out", str(folder / "whole")]), (0,))
    return arguments, state(folder / "whole"), time.monotonic() - start


def stopped_runs(seeds, shot, folder):
    """Stops a run up to three times, then lets it end; returns how often it was stopped."""
    arguments, whole, seconds = shot
    count = 0
    for seed in seeds:
        chance, out = random.Random(seed), folder / f"run{seed}"
        for _ in range(chance.choice((1, 1, 2, 3))):
            how = chance.choice((*STOPPING, signal.SIGKILL))
            further = ["--restart"] if (out / snapshot.NAME).exists() else ["--overwrite"]
            process = begun([*arguments, "--out", str(out), *further])
            time.sleep(seconds * chance.uniform(0.0, 1.1))
            process.send_signal(how)
            status = ended(process, (0, STATUS[how], -how))
            count += status != 0
            assert how == signal.SIGKILL or status == -how or not leftovers(out)
            if status == STATUS[how] and how != signal.SIGKILL and out.exists() and (out / "summary.json").exists():
                assert json.loads((out / "summary.json").read_text())["status"] == "interrupted"
        further = ["--restart"] if (out / snapshot.NAME).exists() else ["--overwrite"]
        ended(begun([*arguments, "--out", str(out), *further]), (0,))
        assert state(out) == whole, f"seed {seed}: other bits"
        assert not leftovers(out)
        shutil.rmtree(out)
    return count


@pytest.mark.thorough
def test_stopped_runs_go_on_to_the_same_bits(shot, tmp_path):
    assert stopped_runs(range(4), shot, tmp_path) > 0


@pytest.mark.slow
def test_a_hundred_stopped_runs(shot, tmp_path, tell):
    count = stopped_runs(range(100), shot, tmp_path)
    tell(f"100 runs stopped {count} times, 0 with other bits")
    assert count > 50


def others(finished, folder):
    """Commands other than `run`, each into a folder of its own."""
    (folder / "shot.toml").write_text(DECK)
    (folder / "study.toml").write_text(STUDY)
    run = str(finished / "run")
    return {
        "plot": ["plot", run, "--out", str(folder / "picture.png")],
        "export": ["export", run, "--out", str(folder / "export")],
        "report": ["report", run, "--out", str(folder / "report")],
        "check": ["check", str(folder / "shot.toml")],
        "info": ["info"],
        "model": ["model", "tate", "--velocity", "500m/s:2km/s:50", "--csv", f"{folder}/t.csv", "--figure", f"{folder}/t.pdf"],
        "sweep": ["sweep", str(folder / "study.toml"), *FEW, "--out", str(folder / "study"), "--workers", "1", "--overwrite"],
    }


def stopped_commands(seeds, finished, folder):
    """Stops a command at a moment of its first seconds; returns how many were stopped."""
    count, known = 0, others(finished, folder)
    for seed in seeds:
        chance = random.Random(seed)
        name, how = chance.choice(list(known)), chance.choice(STOPPING)
        process = begun(known[name])
        time.sleep(chance.uniform(0.0, 8.0 if name == "sweep" else 2.0))
        process.send_signal(how)
        count += ended(process, (0, STATUS[how], -how)) != 0
        assert process.returncode == -how or not leftovers(folder), name
    return count


@pytest.mark.thorough
def test_stopped_commands(finished, tmp_path):
    assert stopped_commands(range(8), finished, tmp_path) > 0


@pytest.mark.slow
def test_two_hundred_stopped_commands(finished, tmp_path, tell):
    count = stopped_commands(range(200), finished, tmp_path)
    tell(f"200 commands, {count} of them stopped, 0 failures")
    assert count > 50


def limited(most):
    """Limits the size of every file of the process, which acts like a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))


def without_room(seeds, shot, finished, folder):
    """Commands that write, with hardly any room; returns how many reported it."""
    count, known = 0, others(finished, folder)
    known["run"] = [*shot[0], "--out", str(folder / "run"), "--overwrite"]
    for seed in seeds:
        chance = random.Random(seed)
        name, most = chance.choice(list(known)), chance.choice((0, 10, 1000, 10_000, 50_000, 200_000))
        process = begun(known[name], preexec_fn=limited(most), env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
        count += ended(process, (0, 3, 4) if name == "sweep" else (0, 4)) != 0
        assert not leftovers(folder), name
    return count


@pytest.mark.thorough
def test_without_room(shot, finished, tmp_path):
    assert without_room(range(8), shot, finished, tmp_path) > 0


@pytest.mark.slow
def test_two_hundred_without_room(shot, finished, tmp_path, tell):
    count = without_room(range(200), shot, finished, tmp_path)
    tell(f"200 commands without room, {count} said so, 0 failures")
    assert count > 50


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["plot", "export", "report", "check", "info", "model", "sweep"])
def test_a_reader_that_is_gone(finished, tmp_path, name):
    arguments = others(finished, tmp_path)[name]
    command = [sys.executable, "-m", "hydro2d", *arguments]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.close()
    assert process.wait(120) in (0, 141)
    assert b"Traceback" not in process.stderr.read()


@pytest.mark.thorough
@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&- >&- 2>&-"])
def test_closed_streams(finished, tmp_path, closed):
    """As when a program starts hydro2d without them: output is lost, and nothing else."""
    run = [*shot_arguments(tmp_path), "--out", str(tmp_path / "out")]
    for arguments in (run, ["status", str(finished / "run")], ["--version"]):
        command = " ".join(f"'{word}'" for word in (sys.executable, "-m", "hydro2d", *arguments))
        assert subprocess.run(["bash", "-c", f"{command} {closed}"], cwd=ROOT, capture_output=True, check=False).returncode == 0
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["status"] == "done"


def shot_arguments(folder):
    (folder / "shot.toml").write_text(DECK)
    return ["run", str(folder / "shot.toml"), "--set", "stop.cycles=3", "--threads", "1"]


@pytest.mark.thorough
def test_an_output_that_is_full(finished, tmp_path):
    for arguments in ([*shot_arguments(tmp_path), "--out", str(tmp_path / "out")], ["status", str(finished / "run")]):
        with open("/dev/full", "w") as full:
            done = subprocess.run([sys.executable, "-m", "hydro2d", *arguments], cwd=ROOT, stdout=full, stderr=subprocess.PIPE,
                                  text=True, check=False)
        assert done.returncode == 4
        assert done.stderr == "hydro2d: No space left on device: the standard output\n"
