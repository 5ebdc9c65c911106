"""However a command ends, it ends in one line, with a documented status, and with its state saved if there is one."""

import errno
import json
import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest

from hydro2d.cli import main
from hydro2d.cli.main import call
from hydro2d.output import snapshot, vtk
from hydro2d.running import run as runs
from tests.cli.test_main import DECK

ROOT = Path(__file__).parents[2]
SLOW = textwrap.dedent("""
    import sys, time, types
    from tests import fake
    class Slow(fake.Simulation):
        def step(self):
            time.sleep(0.01)
            super().step()
    sys.modules["hydro2d.solver.simulation"] = types.SimpleNamespace(Simulation=Slow, UnphysicalState=fake.UnphysicalState)
    from hydro2d.running import progress
    progress.LINE_SECONDS = 0.02
    from hydro2d.cli.main import main
    main(sys.argv[1:])
""")


@pytest.fixture
def deck(tmp_path):
    file = tmp_path / "shot.toml"
    file.write_text(DECK)
    return str(file)


def child(deck, out, **options):
    return subprocess.Popen([sys.executable, "-c", SLOW, "run", deck, "--out", str(out)], cwd=ROOT, **options)


def heard():
    """In a child: SIGHUP ends the process again, even if the tests were started with nohup."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def test_a_reader_that_goes_away_interrupts_the_run(deck, tmp_path):
    """As with `| head -3`."""
    out = tmp_path / "out"
    process = child(deck, out, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    for _ in range(3):
        process.stdout.readline()
    process.stdout.close()
    assert process.wait(60) == 141
    assert process.stderr.read() == b""
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["status"], summary["stop_reason"]) == ("interrupted", "interrupted (SIGPIPE)")
    assert snapshot.read(out / "restart.h5").scalars["cycle"] == summary["cycles"]


def test_hang_up_is_not_heard_under_nohup(deck, tmp_path):
    out = tmp_path / "out"
    process = child(deck, out, stdout=subprocess.DEVNULL, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    wait_for(out / "vtk" / "dump_000001.vtr")
    process.send_signal(signal.SIGHUP)
    time.sleep(0.3)
    assert process.poll() is None
    process.terminate()
    assert process.wait(60) == 143


def wait_for(file: Path) -> None:
    until = time.monotonic() + 60
    while not file.exists() and time.monotonic() < until:
        time.sleep(0.02)


@pytest.mark.parametrize("seconds", [0.2, 0.4, 0.7, 1.1])
def test_no_interrupt_is_swallowed_while_a_run_starts(deck, tmp_path, seconds):
    process = child(deck, tmp_path / "out", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(seconds)
    process.send_signal(signal.SIGINT)
    assert process.wait(30) in (130, -signal.SIGINT)  # the latter before hydro2d runs


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_waits_for_the_end_of_an_import(tmp_path, number):
    """A half-imported module makes VTK crash and pydantic raise another exception."""
    slow = "import time\nprint('begun', flush=True)\ntime.sleep(1)\nprint('whole', flush=True)\n"
    (tmp_path / "slow_module.py").write_text(slow)
    script = """
from hydro2d.base import interrupt
interrupt.raise_between_imports()
try:
    import slow_module, time
    time.sleep(60)
except KeyboardInterrupt:
    print(interrupt.ended_by())
"""
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"}
    process = subprocess.Popen([sys.executable, "-c", script], env=environment, stdout=subprocess.PIPE, text=True,
                               preexec_fn=heard)
    assert process.stdout.readline() == "begun\n"
    process.send_signal(number)
    assert process.communicate(timeout=30)[0] == f"whole\n{number.name}\n"


def test_a_second_signal_does_not_wait_for_the_end_of_an_import(tmp_path):
    """The imports of a report take seconds."""
    (tmp_path / "slow_module.py").write_text("import time\nprint('begun', flush=True)\ntime.sleep(20)\n")
    script = "from hydro2d.base import interrupt\ninterrupt.raise_between_imports()\nimport slow_module\n"
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"}
    process = subprocess.Popen([sys.executable, "-c", script], env=environment, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    process.send_signal(signal.SIGINT)
    time.sleep(0.3)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    assert process.wait(10) == 130


def test_tests_in_the_background_of_a_script_hear_interrupts():
    """The shell lets them ignore SIGINT."""
    test = f"{__file__}::test_a_signal_waits_for_the_end_of_an_import[{signal.SIGINT:d}]"
    subprocess.run([sys.executable, "-m", "pytest", "-p", "no:cacheprovider", test], cwd=ROOT, check=True, capture_output=True,
                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))


@pytest.mark.parametrize("lost", [
    "class Slow:\n    def __del__(self): wait()\nSlow()",
    "import weakref\nclass Slow: pass\nslow = Slow()\nref = weakref.ref(slow, lambda _: wait())\ndel slow",
    "import ctypes\nctypes.CFUNCTYPE(None)(wait)()"])
def test_a_signal_is_not_lost_where_python_has_nobody_to_raise_it_to(lost):
    script = f"""
import time
from hydro2d.base import interrupt
interrupt.raise_between_imports()
def wait():
    print('going', flush=True)
    time.sleep(1)
try:
    exec({lost!r})
    time.sleep(60)
except KeyboardInterrupt:
    print(interrupt.ended_by())
"""
    command = [sys.executable, "-c", script]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "going\n"
    process.send_signal(signal.SIGTERM)
    assert process.communicate(timeout=30) == ("SIGTERM\n", "")


def test_the_status_of_a_command_is_that_of_its_signal(deck):
    """The library behind the command line has its own status for KeyboardInterrupt."""
    script = "from hydro2d.cli import main; import time; main._load = lambda *_: time.sleep(60); print(flush=True); main.main()"
    command = [sys.executable, "-c", script, "check", deck]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=heard)
    process.stdout.readline()
    time.sleep(1.0)
    process.send_signal(signal.SIGHUP)
    assert process.communicate(timeout=30) == ("", "")
    assert process.returncode == 129


def test_a_second_interrupt_does_not_wait_for_the_cycle(deck, tmp_path):
    """The first asks the run to end after its cycle, which here never does; the second ends it."""
    endless = SLOW.replace("time.sleep(0.01)", "print('stepping', flush=True); time.sleep(60)")
    command = [sys.executable, "-c", endless, "run", deck, "--out", str(tmp_path / "out")]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    for line in process.stdout:
        if line == "stepping\n":
            break
    process.send_signal(signal.SIGINT)
    time.sleep(0.5)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    assert process.wait(10) == 130


@pytest.mark.parametrize("where", ["write_grid", "write_lines"])
def test_a_full_disk_is_one_line_and_the_state_is_saved(simulation, deck, tmp_path, monkeypatch, capsys, where):
    calls = []

    def full(path, *_):
        calls.append(path)
        if len(calls) == 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))

    monkeypatch.setattr(vtk, where, full)
    out = tmp_path / "out"
    assert call(["run", deck, "--out", str(out), "--quiet"]) == 4
    assert capsys.readouterr().err == f"hydro2d: No space left on device: {calls[2]}\n"
    assert snapshot.read(out / "restart.h5").scalars["cycle"] > 0
    assert not list(out.glob("**/.*"))
    assert not (out / runs.SUMMARY).exists()


def test_a_disk_that_stays_full_leaves_the_restart_file_before(simulation, deck, tmp_path, monkeypatch, capsys):
    out = tmp_path / "out"
    simulation.fail_at = 150
    assert call(["run", deck, "--out", str(out), "--quiet"]) == 3
    before = snapshot.read(out / "restart.h5").scalars["cycle"]
    monkeypatch.setattr(snapshot, "write", refuse)
    assert call(["run", deck, "--out", str(out), "--restart", "--quiet"]) == 4
    assert "No space left" in capsys.readouterr().err
    assert snapshot.read(out / "restart.h5").scalars["cycle"] == before == 100


def refuse(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_too_little_memory_is_one_line_and_the_state_is_saved(simulation, deck, tmp_path, monkeypatch, capsys):
    """At the first cycle there is nothing to save yet; later the last state in memory is, also over an earlier restart file."""
    out, step, last = tmp_path / "out", simulation.step, [0]

    def short(self):
        if self.cycle >= last[0]:
            raise MemoryError("Unable to allocate 8 EiB")
        step(self)

    monkeypatch.setattr(simulation, "step", short)
    for last[0], options in ((0, []), (150, ["--overwrite"]), (199, ["--restart"])):
        assert call(["run", deck, "--out", str(out), "--quiet", *options]) == 4
        assert capsys.readouterr().err == "hydro2d: not enough memory: Unable to allocate 8 EiB\n"
        if last[0]:
            assert snapshot.read(out / "restart.h5").scalars["cycle"] == 100
        assert not list(out.glob("**/.*"))
        assert not (out / runs.SUMMARY).exists()


@pytest.mark.parametrize(("out", "status"), [("/proc/none", 4), ("{deck}/out", 2)])
def test_paths_that_cannot_be_are_one_line(simulation, deck, capsys, out, status):
    assert call(["run", deck, "--out", out.format(deck=deck), "--quiet"]) == status
    error = capsys.readouterr().err
    assert error.startswith("hydro2d: ")
    assert error.count("\n") == 1


@pytest.mark.parametrize(("error", "said"), [
    (ImportError("libvtkIOXML.so: failed to map segment from shared object"),
     "not enough memory to load libvtkIOXML.so: failed to map segment from shared object; allow more with `ulimit -v`"),
    (RuntimeError("can't start new thread"),
     "can't start new thread: too little memory, or too many threads; allow more with `ulimit -v` or `-u`"),
    (OSError(errno.EMFILE, "Too many open files", "history.h5"),
     "Too many open files: history.h5; allow more with `ulimit -n`")])
def test_a_limit_of_the_machine_is_one_line_with_the_remedy(deck, monkeypatch, capsys, error, said):
    def refuse(*_):
        raise error

    monkeypatch.setattr(main, "_load", refuse)
    assert main.call(["check", deck]) == 4
    assert capsys.readouterr().err == f"hydro2d: {said}\n"


def test_a_package_that_hides_for_lack_of_memory_is_one_line_with_the_remedy(deck, monkeypatch, capsys):
    """llvmlite says instead that its library may not exist."""
    def refuse(*_):
        try:
            raise OSError(f"libllvmlite.so: {main.NO_ROOM}")
        except OSError:
            raise OSError("Could not find/load shared object file") from None

    monkeypatch.setattr(main, "_load", refuse)
    assert main.call(["check", deck]) == 4
    assert capsys.readouterr().err == (f"hydro2d: not enough memory to load libllvmlite.so: {main.NO_ROOM}; allow more with "
                                       "`ulimit -v`\n")


def test_a_terminal_without_unicode(deck):
    """The title of a deck may contain anything; question marks replace what the terminal cannot show."""
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0", "LC_ALL": "C"}
    command = [sys.executable, "-m", "hydro2d", "check", deck, "--set", 'title="Größe Ω"']
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert b"Gr??" in done.stdout or b"Gr?" in done.stdout


def test_a_listing_cut_short_says_nothing(tmp_path):
    command = f"{sys.executable} -m hydro2d info | head -1; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", command], cwd=ROOT, capture_output=True)
    assert done.returncode in (0, 141)  # 0 where all of it fitted into the pipe
    assert done.stderr == b""
