"""A run says that kernels are being compiled when they are, once, and not when they come from the cache."""

import os
import subprocess
import sys

import numba
import pytest

from hydro2d import jit
from hydro2d.running.compilation import announced, is_compiled, once


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
    monkeypatch.setattr(jit, "CACHE_FOLDER", str(tmp_path / "cache"))
    done = []
    assert not is_compiled("a")
    once("a", lambda: done.append("a"))
    once("a", lambda: done.append("a"))
    once("b", lambda: done.append("b"))
    assert done == ["a", "b"]
    assert is_compiled("a")


def test_a_compilation_that_fails_is_tried_again(tmp_path, monkeypatch):
    monkeypatch.setattr(jit, "CACHE_FOLDER", str(tmp_path))
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
