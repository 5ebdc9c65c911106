"""Every file that is read, after everything that can have become of it: what was written, or one line that names the file."""

import os
import pickle
import random
import shutil
import signal

import pytest

from hydro2d.base.errors import Error
from tests.trials.damage import damaged
from tests.trials.readers import DAMAGES, READERS, Reader

SECONDS = 20
#: damaged files of a text in the long trial
SEEDS = 500


@pytest.fixture
def timed():
    """Ends a reader that waits, for example for a pipe."""

    def stop(number, frame):
        raise AssertionError(f"nothing after {SECONDS} s")

    signal.signal(signal.SIGALRM, stop)
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)


@pytest.fixture
def place(request, tmp_path):
    """The folder of a trial, and the path of the file to damage."""

    def make(reader: Reader):
        if reader.texts is None:
            finished = request.getfixturevalue("finished")
            top = reader.file.split("/")[0]
            shutil.copytree(finished / top, tmp_path / top)
        for name, text in (reader.texts or {}).items():
            (tmp_path / name).write_text(text, encoding="utf-8")
        return tmp_path / reader.file

    return make


def judged(reader: Reader, file):
    """What a reader says of a file: its message, or None if it accepts it. AssertionError for a message that helps nobody."""
    try:
        reader.read(file)
    except (Error, OSError) as error:
        said = str(error)
    else:
        return None
    assert file.name in said or file.parent.name in said, said
    assert len(said.splitlines()) <= 20
    return said


@pytest.mark.parametrize("name", READERS)
def test_an_undamaged_file_is_read(name, place):
    reader = READERS[name]
    assert reader.read(place(reader)) is not None


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("name", READERS)
def test_a_damaged_file(name, damage, place, timed):
    reader = READERS[name]
    file = place(reader)
    expected = pickle.dumps(reader.read(file)) if reader.sealed else None
    DAMAGES[damage](file, random.Random(f"{name} {damage}"))
    said = judged(reader, file)
    if said is None and reader.sealed and damage not in reader.may:
        assert pickle.dumps(reader.read(file)) == expected
    if damage == "huge" and name not in ("lock", "compilation"):  # of which only the beginning is read
        assert "at most" in said
    if damage in ("pipe", "device", "loop of links", "link") and reader.kept:
        assert said


@pytest.mark.parametrize("name", READERS)
def test_a_file_that_may_not_be_read(name, place, timed):
    """Not even by root: another user reads it."""
    reader = READERS[name]
    file = place(reader)
    reader.read(file)  # what is imported only now could not be read either
    file.chmod(0)
    if os.geteuid() == 0:
        for folder in file.parents:
            if folder.owner() == "root" and "pytest" not in str(folder) and folder.stat().st_mode & 0o005 == 0o005:
                break
            folder.chmod(0o755)
        os.seteuid(65534)
    try:
        said = judged(reader, file)
    finally:
        if os.getuid() == 0:
            os.seteuid(0)
    assert said or name == "compilation"


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, reader in READERS.items() if reader.texts])
def test_hundreds_of_damaged_texts(name, place, timed, tell):
    """Texts without a checksum, by the damages of `damage`."""
    reader = READERS[name]
    file = place(reader)
    data, refused = file.read_bytes(), 0
    signal.alarm(600)
    for seed in range(SEEDS):
        file.write_bytes(damaged(data, random.Random(f"{name} {seed}"))[1])
        refused += judged(reader, file) is not None
    tell(f"{name}: {SEEDS} damaged files, {refused} refused in words")
