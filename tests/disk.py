"""A disk that is full from some write on, for tests of the files that remain."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
from pathlib import Path

from hydro2d.files import whole
from hydro2d.output import snapshot


class Disk:
    """Counts the files that are flushed to disk, and is full from one of them on, or for that one only."""

    def __init__(self, monkeypatch):
        self.count, self.full, self.once = 0, 0, False
        self.sync = whole.sync
        for module in (whole, snapshot):
            monkeypatch.setattr(module, "sync", self)

    def __call__(self, path: Path) -> None:
        self.count += 1
        if self.full and (self.count == self.full if self.once else self.count >= self.full):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        self.sync(path)

    def begin(self, full: int = 0, once: bool = False) -> None:
        """Starts the count again. full : number of the first file without space, 0 for none;  once : for that file only"""
        self.count, self.full, self.once = 0, full, once


def can_mount() -> bool:
    """Whether a small file system can be mounted here."""
    probe = ["unshare", "--mount", "--map-root-user", "mount", "-t", "tmpfs", "none", "/mnt"]
    return shutil.which("unshare") is not None and subprocess.run(probe, capture_output=True, check=False).returncode == 0
