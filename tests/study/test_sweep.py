"""Sweeps on two workers: whatever befalls them, every case ends as in an undisturbed run, or says why not."""

import functools
import json
import os
import random
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import distributed
import psutil
import pytest

import hydro2d
from hydro2d.deck import deck as decks
from hydro2d.running.run import run
from hydro2d.study.plan import cases
from hydro2d.study.run import sweep
from hydro2d.study.run.choice import Choice
from tests.disk import can_mount
from tests.study import made_up, tubes


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """Bits of every long case, run one after the other without dask."""
    folder = tmp_path_factory.mktemp("undisturbed")
    plan = cases.plan(tubes.write(folder), tubes.LONG[1::2])
    for case in plan.cases:
        run(decks.loads(case.text), folder / case.name, quiet=True)
    return {case.name: tubes.bits(folder / case.name) for case in plan.cases}


def statuses(directory):
    return {case.name: case.status for case in hydro2d.open_study(directory).cases}


def holders(directory):
    """Process of every case that runs: of locks whose process lives."""
    found = {}
    for lock in (directory / "cases").glob("*/run.lock"):
        try:
            pid = int(lock.read_text().split()[1])
            os.kill(pid, 0)
        except (FileNotFoundError, ProcessLookupError, IndexError):  # gone, or not written yet
            continue
        found[lock.parent.name] = pid
    return found


def begun(directory):
    """Those that have a restart file."""
    return {name: pid for name, pid in holders(directory).items() if (directory / "cases" / name / "restart.h5").exists()}


def all_equal(directory, undisturbed):
    return {name: tubes.bits(directory / "cases" / name) == found for name, found in undisturbed.items()}


@pytest.mark.thorough
def test_all_cases_are_done_and_stay(tmp_path):
    file, out = tubes.write(tmp_path), tmp_path / "out"
    status, said = tubes.sweep(file, "--workers", 2, "--out", out)
    assert status == 0, said
    assert "4 of 4 done" in said
    assert "Traceback" not in said
    assert set(statuses(out).values()) == {"done"}
    for case in hydro2d.open_study(out).cases:
        assert case.deck["numerics"]["advection"] == case.values["advection"]
        assert case.summary["deck_sha256"] == case.deck_sha256
    assert "ke_0.1: done" in (out / "sweep.log").read_text()
    before = {file: file.stat().st_mtime_ns for file in out.glob("cases/*/summary.json")}
    status, said = tubes.sweep(file, "--workers", 1, "--out", out, "--resume")
    assert status == 0, said
    assert {file: file.stat().st_mtime_ns for file in out.glob("cases/*/summary.json")} == before
    status, said = tubes.sweep(file, "--out", out)
    assert status == 2
    assert said.count("\n") == 1
    assert "--resume continues it" in said


@pytest.mark.thorough
def test_killed_workers_lose_nothing(tmp_path, undisturbed):
    """kill -9 three times at random moments."""
    out, moments = tmp_path / "out", random.Random(os.urandom(8))
    process = tubes.start(tubes.write(tmp_path), "--workers", 2, "--out", out, *tubes.LONG)
    killed = []
    for seen in (holders, begun, begun):  # two of the three have a restart file to continue from
        tubes.wait_for(functools.partial(seen, out))
        time.sleep(moments.uniform(0, 1))
        name, pid = moments.choice(list(tubes.wait_for(functools.partial(seen, out)).items()))
        os.kill(pid, signal.SIGKILL)
        killed.append((name, (out / "cases" / name / "restart.h5").exists()))
    said, _ = process.communicate(timeout=900)
    print("killed:", killed)
    assert process.returncode == 0, said
    assert set(statuses(out).values()) == {"done"}
    assert all_equal(out, undisturbed) == dict.fromkeys(undisturbed, True)
    for name, had_restart_file in killed:
        assert not had_restart_file or "continuing at cycle" in (out / "cases" / name / "log.txt").read_text()
    assert "Restarting worker" in (out / "sweep.log").read_text()


@pytest.mark.thorough
@pytest.mark.parametrize(("number", "expected"), [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_an_interrupted_sweep_continues(tmp_path, undisturbed, number, expected):
    out, file = tmp_path / "out", tubes.write(tmp_path)
    process = tubes.start(file, "--workers", 2, "--out", out, *tubes.LONG, start_new_session=True)
    tubes.wait_for(lambda: holders(out))
    time.sleep(random.uniform(0, 1))
    os.killpg(process.pid, number) if number == signal.SIGINT else process.send_signal(number)
    said, _ = process.communicate(timeout=300)
    assert process.returncode == expected, said
    assert "--resume continues" in said
    assert "Traceback" not in said
    assert set(statuses(out).values()) <= {"done", "interrupted", "waiting"}
    assert "interrupted" in statuses(out).values()
    assert not list(out.rglob("*.lock"))
    status, said = tubes.sweep(file, "--workers", 2, "--out", out, "--resume", *tubes.LONG)
    assert status == 0, said
    assert all_equal(out, undisturbed) == dict.fromkeys(undisturbed, True)


@pytest.mark.thorough
def test_a_worker_that_is_told_to_go_writes_a_restart_file_first(tmp_path, undisturbed):
    out = tmp_path / "out"
    never = [*tubes.LONG, "--set", "output.restart_interval=1000"]
    process = tubes.start(tubes.write(tmp_path), "--workers", 1, "--out", out, *never)
    name, pid = next(iter(tubes.wait_for(lambda: holders(out)).items()))
    log = out / "cases" / name / "log.txt"
    tubes.wait_for(lambda: log.exists() and "cycle 0" in log.read_text())
    time.sleep(0.3)
    os.kill(pid, signal.SIGTERM)
    said, _ = process.communicate(timeout=900)
    assert process.returncode == 0, said
    assert "continuing at cycle" in log.read_text()
    assert all_equal(out, undisturbed)[name]


@pytest.mark.thorough
@pytest.mark.parametrize("seconds", [0.0, 0.5, 1.0])
def test_a_worker_that_dies_as_it_begins(tmp_path, seconds):
    """Before it has said anything, or while the others are told what to do at their end."""
    file, out = tubes.write(tmp_path), tmp_path / "out"
    process = tubes.start(file, "--workers", 2, "--out", out)

    def workers():
        found = psutil.Process(process.pid).children()
        return [child.pid for child in found if any("spawn_main" in word for word in child.cmdline())]

    first = tubes.wait_for(workers)[0]
    time.sleep(seconds)
    os.kill(first, signal.SIGKILL)
    said, _ = process.communicate(timeout=900)
    assert process.returncode == 0, said
    assert "Traceback" not in said
    assert set(statuses(out).values()) == {"done"}


@pytest.mark.thorough
def test_what_fails_does_not_sink_the_rest(tmp_path):
    """A case that always kills its worker, one that raises, a full disk, no directory, a wrong and an unphysical deck."""
    text = tubes.STUDY.replace("[0.1, 0.2]", "[0.1, 0.2, 0.3, '2 mm']")
    file, out = tubes.write(tmp_path, text), tmp_path / "out"
    planned = {"ke_0.1": "kill", "ke_0.2": "raise", "momentum_0.1": "full", "momentum_0.3": "unphysical"}
    environment = {"HYDRO2D_SABOTAGE": json.dumps(planned), "DASK_DISTRIBUTED__WORKER__PRELOAD": "tests.study.sabotage"}
    (out / "cases").mkdir(parents=True)
    (out / "cases" / "momentum_0.2").touch()
    with pytest.MonkeyPatch.context() as patch:
        for name, value in environment.items():
            patch.setenv(name, value)
        status, said = tubes.sweep(file, "--workers", 2, "--out", out)
    assert status == 3, said
    found = {case.name: case for case in hydro2d.open_study(out).cases}
    expected = {
        "ke_0.1": "failed", "ke_0.2": "failed", "ke_0.3": "done", "ke_2mm": "invalid",
        "momentum_0.1": "failed", "momentum_0.2": "failed", "momentum_0.3": "unphysical", "momentum_2mm": "invalid",
    }
    assert {name: case.status for name, case in found.items()} == expected
    assert "its worker died 4 times" in found["ke_0.1"].message
    assert found["ke_0.2"].message == "ZeroDivisionError: a fault that nobody foresaw"
    assert found["momentum_0.1"].message.startswith("the disk is full: ")
    assert "is a file, not a directory" in found["momentum_0.2"].message
    assert "a state that cannot be" in found["momentum_0.3"].message
    assert "body[1].pressure" in found["ke_2mm"].message
    failed = json.loads((out / "cases" / "ke_0.2" / "failed.json").read_text())
    assert set(failed) == {"sha256", "reason", "kind", "host", "time"}
    for name, case in found.items():
        if case.status != "done":
            assert f"{name}: {case.status}: {case.message.splitlines()[0]}" in said
    (out / "cases" / "momentum_0.2").unlink()
    status, said = tubes.sweep(file, "--workers", 2, "--out", out, "--resume")
    assert status == 3, said  # the wrong decks are still wrong, and the unphysical state is a result
    expected |= dict.fromkeys(("ke_0.1", "ke_0.2", "momentum_0.1", "momentum_0.2"), "done")
    assert statuses(out) == expected
    assert not list(out.rglob("failed.json"))


@pytest.mark.thorough
def test_memory_that_ends_in_a_worker(tmp_path):
    """A case that may take 100 MiB more, and one whose worker is killed each time, as by a system without memory."""
    text = tubes.STUDY.replace("[set]", "[set]\nstop.cycles = 3\nmesh.z.0.cells = 40000")
    file, out = tubes.write(tmp_path, text), tmp_path / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HYDRO2D_SABOTAGE", json.dumps({"ke_0.1": 100, "momentum_0.2": "kill"}))
        patch.setenv("DASK_DISTRIBUTED__WORKER__PRELOAD", "tests.study.sabotage")
        status, said = tubes.sweep(file, "--workers", 1, "--out", out)
    assert status == 3, said
    assert "Traceback" not in said
    assert statuses(out) == {"ke_0.1": "failed", "ke_0.2": "done", "momentum_0.1": "done", "momentum_0.2": "failed"}
    assert "\nke_0.1: failed: not enough memory: " in said
    assert "\nmomentum_0.2: failed: its worker died 4 times (killed, out of memory, or a crash)" in said
    status, said = tubes.sweep(file, "--workers", 1, "--out", out, "--resume")
    assert (status, set(statuses(out).values())) == (0, {"done"}), said


class _Silent(made_up.Client):
    """A client of this machine all of whose workers have ended for good."""

    def __init__(self):
        super().__init__(lambda velocity, deck: {}, workers=0)
        self.cluster = distributed.LocalCluster()

    def submit(self, *arguments, key, pure):
        return SimpleNamespace(key=key, add_done_callback=lambda function: None)


def test_a_sweep_without_workers_ends(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(distributed, "LocalCluster", type("LocalCluster", (), {}))
    monkeypatch.setattr(sweep, "LONELY", 0.5)
    plan = cases.plan(tubes.write(tmp_path), quiet=True)
    assert sweep.sweep(Choice(plan), tmp_path / "out", _Silent().connect()) == 3
    said = capsys.readouterr().out
    assert "ke_0.1: failed: no worker is left" in said
    assert "--resume continues" in said
    assert sorted(statuses(tmp_path / "out").values()) == ["failed", "waiting", "waiting", "waiting"]


@pytest.mark.thorough
def test_some_cases_run_and_the_others_later(tmp_path):
    file, out = tubes.write(tmp_path), tmp_path / "out"
    status, said = tubes.sweep(file, "--check", "--only", "ke_*")
    assert (status, "2 cases, about" in said, "momentum" in said) == (0, True, False)
    status, said = tubes.sweep(file, "--out", out, "--only", "ke_*", "--workers", 1)
    assert (status, "tubes: 2 of 4 cases" in said, "2 of 2 done (2 others not run), in" in said) == (0, True, True)
    assert statuses(out) == {"ke_0.1": "done", "ke_0.2": "done", "momentum_0.1": "waiting", "momentum_0.2": "waiting"}
    status, said = tubes.sweep(file, "--out", out, "--only", "*_0.3")
    assert (status, "--only *_0.3: matches no case" in said) == (2, True)
    status, said = tubes.sweep(file, "--out", out, "--only", "*_0.1", "--resume", "--workers", 1)
    assert (status, statuses(out)["momentum_0.1"], statuses(out)["momentum_0.2"]) == (0, "done", "waiting")
    before = (out / "cases" / "ke_0.1" / "summary.json").stat().st_mtime_ns
    status, said = tubes.sweep(file, "--out", out, "--only", "ke_0.2", "--only", "momentum*", "--overwrite", "--workers", 1)
    assert (status, set(statuses(out).values())) == (0, {"done"})
    assert (out / "cases" / "ke_0.1" / "summary.json").stat().st_mtime_ns == before


@pytest.mark.thorough
@pytest.mark.skipif(not can_mount(), reason="no small file system can be mounted here")
def test_a_disk_that_fills_up(tmp_path, undisturbed):
    """All cases on a file system that is too small: one clear message each; with more room the sweep continues."""
    file, out = tubes.write(tmp_path), tmp_path / "disk" / "out"
    out.parent.mkdir()
    command = [sys.executable, "-m", "hydro2d", "sweep", file, "--workers", "2", "--out", out, *tubes.LONG]
    first, again = (" ".join(f"'{word}'" for word in words) for words in (command, [*command, "--resume"]))
    script = f"""
        mount -t tmpfs -o size=400k none {out.parent} || exit 99
        {first} > {tmp_path}/first.txt 2>&1
        echo $? >> {tmp_path}/first.txt
        mount -o remount,size=100m {out.parent} || exit 98
        {again} > {tmp_path}/again.txt 2>&1
        status=$?
        cp -r {out} {tmp_path}/saved
        exit $status
    """
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tubes.ROOT), os.environ.get("PYTHONPATH", "")])}
    done = subprocess.run(["unshare", "--mount", "--map-root-user", "sh", "-c", script], env=environment, check=False)
    said = (tmp_path / "first.txt").read_text()
    assert said.endswith("\n3\n"), said
    assert "failed: the disk is full: " in said
    assert "Traceback" not in said
    assert done.returncode == 0, (tmp_path / "again.txt").read_text()
    assert all_equal(tmp_path / "saved", undisturbed) == dict.fromkeys(undisturbed, True)
