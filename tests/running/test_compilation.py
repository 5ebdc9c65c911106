"""A run says that kernels are being compiled when they are, once, and not when they come from the cache."""

import errno
import os
import shutil
import subprocess
import sys
import threading
import time
from types import SimpleNamespace

import numba
import pytest

from hydro2d import jit
from hydro2d.deck import deck as decks
from hydro2d.files import turn
from hydro2d.jit import cache, options, recording
from hydro2d.kernels import column_ranges, lagrangian_step, remap_step
from hydro2d.running.compilation import Second, announced, is_compiled, once
from hydro2d.running.compile_ahead import calls_of_a_cycle
from hydro2d.solver.simulation import Simulation
from tests.cli.test_main import DECK


def test_what_is_compiled_is_said():
    inner = numba.njit(lambda x: x + 1)
    outer = numba.njit(lambda x: inner(x) * 2)
    said = []
    with announced(said.append) as compiled:
        assert said == []
        assert outer(1.0) == 4.0
        assert len(said) == 1
        assert said[0].startswith("compiling")
        compiled.report()
        assert said[1].startswith("compiled 1 kernel in ")
        outer(2.0)
    assert len(said) == 2
    numba.njit(lambda x: x)(1.0)  # outside: nobody listens
    assert len(said) == 2


def test_silence_where_nothing_is_compiled():
    compiled, said = numba.njit(lambda x: x + 3), []
    compiled(1.0)
    with announced(said.append):
        compiled(2.0)
    assert said == []


def test_kernels_are_compiled_once(tmp_path, monkeypatch):
    monkeypatch.setattr(jit, "all_folder", lambda: str(tmp_path / "cache"))
    done = []
    assert not is_compiled("a")
    once("a", lambda: done.append("a"))
    once("a", lambda: done.append("a"))
    once("b", lambda: done.append("b"))
    assert done == ["a", "b"]
    assert is_compiled("a")


def test_a_compilation_that_fails_is_tried_again(tmp_path, monkeypatch):
    monkeypatch.setattr(jit, "all_folder", lambda: str(tmp_path))
    with pytest.raises(ZeroDivisionError):
        once("a", lambda: 1 / 0)
    assert not is_compiled("a")
    done = []
    once("a", lambda: done.append("a"))
    assert done == ["a"]


def test_of_two_processes_one_compiles(tmp_path):
    """The second waits for the first, and finds its work done."""
    code = (
        "import sys, time; from hydro2d.running import compilation\n"
        "def slow(): time.sleep(0.5); open(sys.argv[1], 'a').write('x')\n"
        "compilation.once('a', slow)"
    )
    place = {**os.environ, "HYDRO2D_CACHE_DIR": str(tmp_path / "cache")}
    both = [subprocess.Popen([sys.executable, "-c", code, str(tmp_path / "said")], env=place) for _ in range(2)]
    assert [child.wait(120) for child in both] == [0, 0]
    assert (tmp_path / "said").read_text() == "x"


DECKS = ["cth_nose_shape/hemi_5083_1086_quick", "cth_nose_shape/hemi_5083_1086_layer", "sliding/block_level"]


@pytest.mark.parametrize("name", DECKS)
def test_the_second_process_knows_the_kernels_of_a_cycle(name):
    """It computes nothing, and finds all the same what a simulation calls until its first cycle is over."""
    deck = decks.load(f"problems/{name}.toml")
    found = {call.name for call in calls_of_a_cycle(deck)}
    called = set()

    def look(frame, event, _):
        if event == "call" and frame.f_code.co_filename == recording.__file__ and frame.f_code.co_name == "call":
            called.add(frame.f_locals["name"])

    sys.setprofile(look)
    try:
        Simulation(deck).step()
    finally:
        sys.setprofile(None)
    assert {f"{remap_step.__name__}.carry_momentum", f"{column_ranges.__name__}.widen_ranges"} < called
    assert (f"{lagrangian_step.__name__}.find_contact" in called) == (deck.sliding.method == "contact")
    assert called <= found


def test_a_call_that_was_written_down_is_compiled_for_its_types():
    deck = decks.load("problems/sliding/block_level.toml")
    call = next(call for call in calls_of_a_cycle(deck) if call.name.endswith("find_active_ranges"))
    call.compile()
    assert call.types in [tuple(types) for types in call.compiled.signatures]


def test_a_second_process_that_fails_is_said_to():
    """Its deck is none; what goes on here is not disturbed."""
    said = []
    with announced(said.append, SimpleNamespace(to_toml=lambda: "no deck at all")):
        assert numba.njit(lambda x: x + 5)(1.0) == 6.0
        time.sleep(5.0)
    assert said[-1].startswith("the second process for compilation failed with exit status 1")


def test_a_second_process_is_ended(monkeypatch):
    second = Second(decks.load("problems/sliding/block_level.toml"))
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 1}, raising=False)
    assert second.stop() is None  # it was never begun
    second.start()
    assert second.stop() is None


def test_turns_are_taken(tmp_path):
    """Four threads count to a hundred together, each with a pause between reading and writing."""
    count = tmp_path / "count"
    count.write_text("0")

    def work():
        for _ in range(25):
            with turn(tmp_path / "folder" / "lock"):
                before = int(count.read_text())
                time.sleep(1e-4)
                count.write_text(str(before + 1))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert count.read_text() == "100"


def _can_mount():
    probe = ["unshare", "--mount", "--map-root-user", "mount", "-t", "tmpfs", "none", "/mnt"]
    return shutil.which("unshare") is not None and subprocess.run(probe, capture_output=True, check=False).returncode == 0


@pytest.mark.skipif(not _can_mount(), reason="no file system can be mounted here")
def test_a_cache_that_cannot_be_written_is_read(tmp_path):
    """One of a site, on a file system that is mounted read-only."""
    (tmp_path / "shot.toml").write_text(DECK)
    command = [sys.executable, "-m", "hydro2d", "run", str(tmp_path / "shot.toml"), "--quiet", "--set", "stop.cycles=3",
               "--threads", "1", "--out"]  # fmt: skip
    subprocess.run([*command, str(tmp_path / "warm")], check=True)
    folder = cache._cache_root()
    script = f"mount --bind {folder} {folder} && mount -o remount,bind,ro {folder} && ! touch {folder}/x 2>/dev/null && "
    words = " ".join(f"'{word}'" for word in [*command, str(tmp_path / "out")])
    done = subprocess.run(["unshare", "--mount", "--map-root-user", "sh", "-c", script + words], capture_output=True, text=True,
                          check=False)  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")


def test_what_cannot_be_kept_is_compiled_all_the_same(tmp_path, monkeypatch, capsys):
    """Here no file of the cache can be made."""

    def refused(*_arguments, **_options):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    function = numba.njit(cache=True)(probe)
    with monkeypatch.context() as full:
        full.setattr(options, "turn", refused)
        assert function(1.0) == 8.0
    assert "cannot be written: what is compiled is not kept" in capsys.readouterr().err
    with monkeypatch.context() as full:
        full.setattr(os, "open", refused)
        with turn(tmp_path / "a.lock"):
            pass
    assert not (tmp_path / "a.lock").exists()


def probe(x):
    return x + 7.0
