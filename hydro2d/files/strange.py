"""Refuses links, pipes and devices in place of files, in a run or a study that comes from someone else."""

from __future__ import annotations

import os
import stat
from pathlib import Path, PurePosixPath
from typing import TextIO

from hydro2d.base.errors import Error

#: flags of `os.open`; Windows has neither, nor pipes among files
NONBLOCK, NOFOLLOW = getattr(os, "O_NONBLOCK", 0), getattr(os, "O_NOFOLLOW", 0)


class StrangeFile(Error):
    """A pipe or a device in place of a file, or a symbolic link inside a run or a study; the message is for the user."""


def own(path: Path, *, links: bool = False) -> Path:
    """The path, if it is a regular file or a folder, or if nothing is there.

    A pipe that someone else has put into a run or a study can make a command wait forever, and a symbolic link can make it
    write and read elsewhere. `links` allows symbolic links, for files that the user names.

    Raises StrangeFile.
    """
    try:
        mode = os.stat(path, follow_symlinks=links).st_mode
    except (FileNotFoundError, NotADirectoryError):
        return path
    if stat.S_ISLNK(mode):
        raise StrangeFile(f"{path} is a symbolic link; hydro2d follows none inside a run or a study")
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise StrangeFile(f"{path} is a pipe, a socket or a device, not a file")
    return path


def within(folder: Path, name: str) -> Path:
    """A file that a run or a study names by a relative path, which must stay inside the folder. Raises StrangeFile."""
    parts = PurePosixPath(name).parts
    if not parts or parts[0] == "/" or ".." in parts or "\0" in name:
        raise StrangeFile(f"{name!r} does not name a file in {folder}")
    for number in range(1, len(parts) + 1):
        own(folder.joinpath(*parts[:number]))
    return folder / name


def own_folder(path: Path) -> Path:
    """Makes a folder of a run or a study if there is none. Raises StrangeFile if a symbolic link is there."""
    own(path).mkdir(parents=True, exist_ok=True)
    return path


def opened(path: Path, mode: str = "r", *, encoding: str = "utf-8", errors: str = "strict", links: bool = False) -> TextIO:
    """Opens a text file, as `open` does, unless it is a pipe, a device or a symbolic link; `links` as in `own`.

    Raises StrangeFile.
    """

    def opener(name: str, flags: int) -> int:
        return os.open(name, flags | NONBLOCK | (0 if links else NOFOLLOW), 0o666)

    return open(own(Path(path), links=links), mode, encoding=encoding, errors=errors, opener=opener)
