"""Files of compiled code: they are read back as they were written, and nothing else is executed."""

import errno
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numba
import pytest

from hydro2d.files import locks
from hydro2d.jit import cache, options, store
from tests import error_output
from tests.disk import Disk, can_mount

OPTIONS = options.OPTIONS


def add(x):
    return x + 7.0


def multiply(x):
    return x * 7.0


def made(function, *folders: Path):
    """A compiled function that is kept in the folders."""
    compiled = numba.njit(**OPTIONS)(function)
    compiled._cache = store.Kept(function, *folders)
    return compiled


def hits(compiled) -> int:
    """Number of times that it came from a file."""
    return sum(compiled.stats.cache_hits.values())


@pytest.fixture
def said(capsys):
    """Messages on the error output, as if there had been none before."""
    cache.say_once.cache_clear()
    return lambda: error_output.lines(capsys.readouterr().err)


@pytest.fixture
def kept(tmp_path):
    """The file of `add`, in a folder of its own."""
    assert made(add, tmp_path / "code")(1.0) == 8.0
    (file,) = (tmp_path / "code").iterdir()
    return file


def test_compiled_code_comes_back(kept, said):
    again = made(add, kept.parent)
    assert again._cache.has((numba.float64,))
    assert not again._cache.has((numba.int64,))
    assert (again(1.0), hits(again)) == (8.0, 1)
    assert (again(1), hits(again)) == (8.0, 1)
    assert len(list(kept.parent.iterdir())) == 2
    again._cache.flush()
    assert list(kept.parent.iterdir()) == []
    assert said() == []


def test_the_file_has_no_path_in_it(kept):
    """It is for any machine, and contains no name of one."""
    assert str(cache.ROOT).encode() not in kept.read_bytes()


def test_the_first_folder_is_read_and_not_written(kept, tmp_path, said):
    own = tmp_path / "own"
    compiled = made(add, kept.parent, own)
    assert (compiled(1.0), hits(compiled)) == (8.0, 1)
    assert not own.exists()
    assert compiled(1) == 8.0
    assert [len(list(folder.iterdir())) for folder in (kept.parent, own)] == [1, 1]


class Planted:
    """An object that runs a program when it is unpickled."""

    def __init__(self, trace: Path):
        self.trace = trace

    def __reduce__(self):
        return os.mkdir, (str(self.trace),)


def other(data: bytes, file: Path) -> bytes:
    """The file of another function."""
    assert made(multiply, file.parent / "other")(1.0) == 7.0
    (found,) = (file.parent / "other").iterdir()
    return found.read_bytes()


def planted(data: bytes, file: Path) -> bytes:
    return pickle.dumps(Planted(file.parent / "trace"))


def headed(data: bytes, file: Path) -> bytes:
    return data.partition(b"\n")[0] + b"\n" + planted(data, file)


def no_pickle(data: bytes, file: Path) -> bytes:
    """A pickle with a correct checksum."""
    return b"%s %s\n" % (store.FORM, store._checksum(file, b"none")) + b"none"


CONTENTS = {
    "empty": lambda data, file: b"",
    "one byte": lambda data, file: data[:1],
    "the head alone": lambda data, file: data.partition(b"\n")[0],
    "the head and its line's end": lambda data, file: data.partition(b"\n")[0] + b"\n",
    "half": lambda data, file: data[: len(data) // 2],
    "without the last byte": lambda data, file: data[:-1],
    "with a byte more": lambda data, file: data + b"\0",
    "zeros": lambda data, file: bytes(len(data)),
    "garbage": lambda data, file: bytes(range(256)) * 40,
    "a bit of the code": lambda data, file: data[:-100] + bytes([data[-100] ^ 1]) + data[-99:],
    "a bit of the checksum": lambda data, file: data[:20] + bytes([data[20] ^ 1]) + data[21:],
    "a bit of the form": lambda data, file: bytes([data[0] ^ 1]) + data[1:],
    "numba's own index": lambda data, file: pickle.dumps(numba.__version__) + pickle.dumps((1, {})),
    "text": lambda data, file: b"x = 1\n",
    "of another function": other,
    "a planted pickle": planted,
    "a planted pickle under the head": headed,
    "no pickle": no_pickle,
}


@pytest.mark.parametrize("damage", CONTENTS.values(), ids=CONTENTS)
def test_a_damaged_file_is_compiled_anew_and_named(damage, kept, said):
    kept.write_bytes(damage(kept.read_bytes(), kept))
    compiled = made(add, kept.parent)
    assert (compiled(1.0), hits(compiled)) == (8.0, 0)
    (line,) = said()
    assert line.startswith(f"hydro2d: {kept} is damaged (")
    assert not (kept.parent / "trace").exists()
    again = made(add, kept.parent)
    assert (again(1.0), hits(again)) == (8.0, 1)
    assert said() == []


def link(file: Path) -> None:
    file.unlink()
    file.symlink_to(file)


def gone(file: Path) -> None:
    file.unlink()
    file.symlink_to(file.with_name("nowhere"))


PLACES = {"a folder": lambda file: (file.unlink(), file.mkdir()), "a pipe": lambda file: (file.unlink(), os.mkfifo(file)),
          "a link to itself": link, "a link to nothing": gone}


@pytest.mark.parametrize("damage", PLACES.values(), ids=PLACES)
def test_a_path_that_is_no_file_does_not_end_a_run(damage, kept, said):
    damage(kept)
    compiled = made(add, kept.parent)
    assert (compiled(1.0), hits(compiled)) == (8.0, 0)
    assert len(said()) == (0 if damage is gone else 1 + (not kept.is_file()))


def test_a_file_in_the_place_of_the_folder(tmp_path, said):
    (tmp_path / "code").write_text("")
    assert made(add, tmp_path / "code")(1.0) == 8.0
    (line,) = said()
    assert "cannot be written" in line


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EIO])
def test_a_place_that_fails_in_the_middle_of_a_write_is_said_once(number, tmp_path, said, monkeypatch):
    """The run goes on, and no half-written file is left."""
    whole = Path.write_bytes

    def half(path, data):
        whole(path, data[: len(data) // 2])
        raise OSError(number, os.strerror(number), str(path))

    with monkeypatch.context() as full:
        full.setattr(Path, "write_bytes", half)
        assert made(add, tmp_path / "code")(1.0) == 8.0
        assert made(multiply, tmp_path / "code")(1.0) == 7.0
    (line,) = said()
    assert f"cannot be written ({os.strerror(number)}): what is compiled is not kept" in line
    assert list((tmp_path / "code").iterdir()) == []
    assert made(add, tmp_path / "code")(1.0) == 8.0
    assert len(list((tmp_path / "code").iterdir())) == 1


def test_a_disk_that_is_full_for_one_file(tmp_path, said, monkeypatch):
    Disk(monkeypatch).begin(full=3, once=True)  # a file and its folder are flushed, then the second file
    folder = tmp_path / "code"
    assert [made(add, folder)(1.0), made(multiply, folder)(1.0), made(add, folder)(1)] == [8.0, 7.0, 8.0]
    assert len(list(folder.iterdir())) == 2
    assert len(said()) == 1


#: a program with two kernels; it prints their results
PROGRAM = """
from hydro2d import jit
import numpy as np

@jit.serial
def twice(a):
    for i in range(a.shape[0]):
        a[i] *= 2.0

@jit.serial
def thrice(a):
    for i in range(a.shape[0]):
        a[i] *= 3.0

a = np.ones(3)
twice(a)
thrice(a)
print(a[0])
"""


def program(folder: Path, *before: str, root: str = "") -> tuple[str, list[str]]:
    """Its output, and the lines of its error output. before : words of the command before Python"""
    (folder / "program.py").write_text(PROGRAM)
    own = {"HYDRO2D_CACHE_DIR": root or str(folder / "cache"), "PYTHONPATH": str(cache.ROOT)}
    done = subprocess.run([*before, sys.executable, str(folder / "program.py")], env={**os.environ, **own}, text=True,
                          capture_output=True, check=True)
    return done.stdout.strip(), done.stderr.splitlines()


@pytest.mark.thorough
def test_every_file_of_a_cache_can_be_spoiled(tmp_path):
    """The locks as well as the code; no leftover ends a run."""
    assert program(tmp_path) == ("6.0", [])
    files = [file for file in (tmp_path / "cache").glob("*/*") if file.is_file()]
    assert {file.suffix for file in files} == {".code", ".lock"}
    for file in files:
        file.write_bytes(b"garbage")
    printed, lines = program(tmp_path)
    assert (printed, len(lines)) == ("6.0", 2)
    assert program(tmp_path) == ("6.0", [])
    for file in files:
        if file.suffix == ".lock":
            file.unlink()
            file.mkdir()
    assert program(tmp_path) == ("6.0", [])


@pytest.mark.thorough
@pytest.mark.skipif(not can_mount(), reason="no file system can be mounted here")
@pytest.mark.parametrize("size", ["4k", "8k,nr_inodes=3", "16k"])
def test_a_file_system_that_is_full(size, tmp_path):
    """It has room for nothing, for folders only, or for one function and half of the next."""
    (tmp_path / "disk").mkdir()
    script = f'mount -t tmpfs -o size={size} none "$0" && exec "$@"'
    before = ["unshare", "--mount", "--map-root-user", "sh", "-c", script, str(tmp_path / "disk")]
    printed, lines = program(tmp_path, *before, root=str(tmp_path / "disk" / "cache"))
    assert printed == "6.0"
    (line,) = lines
    assert "cannot be written (No space left on device): what is compiled is not kept" in line


def test_a_turn_is_nobodys_where_no_file_can_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    with locks.turn(tmp_path / "file" / "a.lock"):
        pass
