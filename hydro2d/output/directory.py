"""The directory of a run: the names of its files, and whether a run may begin in it. `running/run.py` says what is in each."""

from __future__ import annotations

import hashlib
from pathlib import Path

from hydro2d.base.errors import Error
from hydro2d.files.locks import remove
from hydro2d.files.strange import own
from hydro2d.output import snapshot
from hydro2d.output.series import numbered
from hydro2d.output.vtk import FOLDER, SERIES

DECK, SUMMARY, HISTORY, LOG, LOCK = "deck.toml", "summary.json", "history.h5", "log.txt", "run.lock"
PROGRESS = "progress.json"
OWN_FILES = (DECK, SUMMARY, HISTORY, LOG, PROGRESS, snapshot.NAME, snapshot.PREVIOUS, *SERIES.values())

#: file in the directory of a study, see study/records/study_directory.py
STUDY = "study.json"


class RunError(Error):
    """A run that cannot start: the directory is in use, or a restart does not match; the message is for the user."""


def check_free(directory: Path, *, restart: bool, overwrite: bool) -> None:
    """Raises RunError if the options do not allow a run in this directory."""
    if directory.exists() and not directory.is_dir():
        raise RunError(f"{directory} is a file, not a directory")
    if restart and overwrite:
        raise RunError("restart continues a run and overwrite removes it; give one of them")
    if restart and not directory.is_dir():
        raise RunError(f"{directory}: there is no run to continue")
    if overwrite and {name for name in (*OWN_FILES, LOCK) if (directory / name).exists()} == {DECK}:
        raise RunError(f"{directory / DECK} does not belong to a run: its other files are missing; --overwrite "
                       "would replace it")
    if (directory / STUDY).is_file() and not (directory / SUMMARY).exists():
        raise RunError(f"{directory} holds a study; give the run a directory of its own")
    if not (restart or overwrite) and any((directory / name).exists() for name in OWN_FILES):
        raise RunError(f"{directory} already holds a run; --restart continues it, --overwrite removes it")


def check_own(directory: Path) -> None:
    """Raises StrangeFile if a file of a run, or its folder of dumps, is a symbolic link, a pipe or a device."""
    for name in (*OWN_FILES, LOCK, FOLDER):
        own(directory / name)


def clear(directory: Path) -> None:
    """Removes the files of a run from a directory, and nothing else. Raises StrangeFile."""
    check_own(directory)
    for name in OWN_FILES:
        remove(directory / name)
    for kind in SERIES:
        for _, file in numbered(directory, kind):
            remove(file)


def deck_hash(text: str) -> str:
    """SHA-256 of a resolved deck: the same for the same case."""
    return hashlib.sha256(text.encode()).hexdigest()
