"""A run reports the compilation of kernels when it happens, once, and not when they come from the cache."""

import os
import subprocess
import sys
import threading
import time
from types import SimpleNamespace

import numba
import pytest

from hydro2d import jit
from hydro2d.base.terminal import duration
from hydro2d.deck import deck as decks
from hydro2d.files.locks import turn
from hydro2d.jit import cache, compilation, phases, recording
from hydro2d.jit.compilation import Second, announced, expect, is_compiled, once, progress_of
from hydro2d.kernels import lagrangian_step, remap_step
from hydro2d.mesh import sums
from hydro2d.running import compile_all
from hydro2d.solver.first_cycle import calls_of_a_cycle
from hydro2d.solver.simulation import Simulation
from tests.cli.test_main import DECK
from tests.disk import can_mount


class Shown:
    """A place that stores its lines."""

    def __init__(self):
        self.moved, self.rested = [], []

    def move(self, text, share):
        self.moved.append((text, share))

    def rest(self, text):
        self.rested.append(text)


@pytest.fixture
def place(monkeypatch):
    """A place whose line moves twenty times a second."""
    monkeypatch.setattr(compilation, "BEAT", 0.05)
    return Shown()


def first_call(name):
    """The report of the first call of a kernel."""
    return compilation.events.trigger_event(jit.FIRST_CALL, data={"kernel": name})


def test_one_line_moves_while_a_kernel_is_waited_for(place):
    """Nothing is compiled here: another process does it. The wait counts all the same."""
    with announced(place) as compiled:
        compiled.expect(["a", "b", "c"])
        with first_call("a"):
            time.sleep(0.3)
        assert place.moved[0] == ("compiling kernels: 0 of 3, 0 s", 0.0)
        assert len(place.moved) >= 3
        assert place.rested == ["compiled kernels: 1 of 3, 0 s"]
        assert compiled.happened
        assert 0.3 < compiled.seconds < 3.0
        time.sleep(0.2)  # cycles: the line does not change, and their time does not count
        assert compiled.seconds < 0.2 + 0.3 + 0.1
        compiled.done("b")  # the second process has
        with first_call("b"):
            time.sleep(0.1)
        assert place.moved[-1] == ("compiling kernels: 2 of 3, 0 s", 2 / 3)
        assert compiled.closing_lines() == [f"compiled 2 kernels in {duration(compiled.seconds, tenths=True)}"]
        assert compiled.closing_lines() == []  # it is reported once
    with first_call("c"):  # outside: no report
        time.sleep(0.1)
    assert len(place.rested) == 2


def test_unexpected_compilations_are_counted(place):
    inner = numba.njit(lambda x: x + 1)
    outer = numba.njit(lambda x: inner(x) * 2)
    with announced(place) as compiled:
        compiled.expect(["a"])
        with first_call("b"):
            assert outer(1.0) == 4.0
            time.sleep(0.1)
        assert compiled.state == (1, 2)
        assert compiled.happened
        compiled.expect(None)
        assert compiled.progress_line().startswith("compiling kernels: 1 so far, ")


def test_silence_where_kernels_come_from_the_cache(place):
    with announced(place) as compiled:
        for name in "abcdefgh":
            with first_call(name):
                time.sleep(0.01)
        assert compiled.closing_lines() == []
        assert not compiled.happened
        compiled.happened = True  # one that took a second to load, on a busy machine
        assert compiled.closing_lines() == []
    assert (place.moved, place.rested) == ([], [])


def test_the_line_of_a_simulation_is_silent_within_a_run(place, monkeypatch):
    """A program that makes a Simulation gets a line; `hydro2d.run` has its own."""
    monkeypatch.setattr(compilation, "_listening", [])
    monkeypatch.setattr(compilation.moving, "place", lambda: place)
    monkeypatch.setattr(compilation, "is_compiled", lambda key: False)
    call = SimpleNamespace(name="a", is_compiled=lambda: False)
    expect("a key", lambda: [call])
    (by_default,) = compilation._listening
    try:
        with first_call("a"):
            time.sleep(0.2)
        assert place.moved[0][0] == "compiling kernels: 0 of 1, 0 s"
        before, own = len(place.moved), Shown()
        with announced(own):
            expect("a key", lambda: [call])
            with first_call("a"):
                time.sleep(0.2)
        assert own.moved[0][0] == "compiling kernels: 0 of 1, 0 s"
        assert len(place.moved) == before
    finally:
        by_default.stop()


def test_kernels_are_listed_until_the_cache_has_them(place, tmp_path, monkeypatch):
    monkeypatch.setattr(jit, "all_folder", lambda: str(tmp_path / "cache"))
    asked, ready = [], []

    def calls():
        asked.append(1)
        return [SimpleNamespace(name="a", is_compiled=lambda: bool(ready))]

    with announced(place) as compiled:
        expect("key", calls)
        expect("key", calls)
        assert compiled.state == (0, 1)
        ready.append(1)
        expect("key", calls)
        expect("key", calls)
    assert len(asked) == 3
    assert not is_compiled("key")  # `once` compiles more than a first cycle does

    def fails():
        raise ZeroDivisionError

    with announced(place) as compiled:
        expect("another", fails)
        assert compiled.state == (0, None)


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
    """The second waits for the first, and finds the work done."""
    code = (
        "import sys, time; from hydro2d.jit import compilation\n"
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
    """It computes nothing, and still finds everything that a simulation calls until its first cycle is over."""
    deck = decks.load(f"problems/{name}.toml")
    names = {call.name for call in calls_of_a_cycle(lambda: Simulation(deck))}
    called = set()

    def look(frame, event, _):
        place = frame.f_code.co_filename, frame.f_code.co_name
        if event == "call" and place == (recording.__file__, "call"):
            called.add(frame.f_locals["name"])
        if event == "call" and place == (phases.__file__, "__call__"):
            called.add(frame.f_locals["self"].full_name)

    sys.setprofile(look)
    try:
        Simulation(deck).step()
    finally:
        sys.setprofile(None)
    assert {remap_step.carry_momentum.full_name, f"{sums.__name__}.body_totals"} < called
    assert (lagrangian_step.find_contact.full_name in called) == (deck.sliding.method == "contact")
    assert called <= names


def test_the_decks_that_are_shipped_compiled_call_every_kernel_of_these():
    """With the same types of arguments: a run from a wheel with the compiled code compiles nothing."""
    def calls(name):
        deck = decks.load(f"problems/{name}.toml")
        return {(call.name, call.types) for call in calls_of_a_cycle(lambda: Simulation(deck))}

    shipped = set().union(*map(calls, compile_all.DECKS))
    assert len(shipped) > 25
    others = [*DECKS, "cth_nose_shape/hemi_5083_1086", "verification/sod_z", "verification/noh_planar", "classic/flyer_spall",
              "explosives/sandwich", "classic/taylor_bar", "perforation/sphere"]
    for name in others:
        assert calls(name) <= shipped, name


def test_a_call_that_was_written_down_is_compiled_for_its_types():
    deck = decks.load("problems/sliding/block_level.toml")
    call = next(call for call in calls_of_a_cycle(lambda: Simulation(deck)) if call.name.endswith("find_bodies"))
    call.compile()
    assert call.is_compiled()
    assert not recording.Call("other", call.compiled, call.types[:-1]).is_compiled()
    assert call.types in [tuple(types) for types in call.compiled.signatures]


def test_a_second_process_that_fails_is_said_to(place, monkeypatch):
    """It has no valid deck; this process is not disturbed."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 1}, raising=False)
    with announced(place, SimpleNamespace(to_toml=lambda: "no deck at all")) as compiled:
        compiled.expect(["a", "b"])
        assert compiled._second._process.wait(120) == 1
        assert compiled.closing_lines() == ["the second process for compilation failed with exit status 1; only time was lost"]


def test_a_second_process_is_started_for_several_kernels_and_ended(place, monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 1}, raising=False)
    with announced(place, decks.load("problems/sliding/block_level.toml")) as compiled:
        compiled.expect(["a"])
        assert compiled._second._process is None
        compiled.expect(["b"])
        process = compiled._second._process
        assert process.poll() is None
    assert process.poll() is not None


def test_the_second_process_tells_what_it_has_compiled(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 1}, raising=False)
    monkeypatch.setattr(compilation.children, "python", lambda module: [sys.executable, "-c", "print('a'); print('b')"])
    lines, second = [], Second(SimpleNamespace(to_toml=lambda: ""))
    second.start(lines.append)
    second._process.wait(60)
    for _ in range(100):
        if len(lines) == 2:
            break
        time.sleep(0.05)
    assert lines == ["a", "b"]
    assert second.stop() is None


def test_the_process_that_compiles_for_all_tells_the_others(place, tmp_path, monkeypatch):
    """A sweep reads it; afterwards there is nothing to read."""
    monkeypatch.setattr(jit, "all_folder", lambda: str(tmp_path / "cache"))
    lines = []

    def compiles():
        with first_call("a"):
            time.sleep(0.3)
            lines.append(progress_of("key"))

    once("key", compiles)
    assert lines == ["compiling kernels: 0 so far, 0 s"]
    assert progress_of("key") == ""


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


@pytest.mark.thorough
@pytest.mark.skipif(not can_mount(), reason="no file system can be mounted here")
def test_a_cache_that_cannot_be_written_is_read(tmp_path):
    """One of a site, on a file system that is mounted read-only."""
    (tmp_path / "shot.toml").write_text(DECK)
    command = [sys.executable, "-m", "hydro2d", "run", str(tmp_path / "shot.toml"), "--quiet", "--set", "stop.cycles=3",
               "--threads", "1", "--out"]
    subprocess.run([*command, str(tmp_path / "warm")], check=True)
    folder = cache.root()
    script = f"mount --bind {folder} {folder} && mount -o remount,bind,ro {folder} && ! touch {folder}/x 2>/dev/null && "
    words = " ".join(f"'{word}'" for word in [*command, str(tmp_path / "out")])
    done = subprocess.run(["unshare", "--mount", "--map-root-user", "sh", "-c", script + words], capture_output=True, text=True,
                          check=False)
    assert (done.returncode, done.stderr) == (0, "")
