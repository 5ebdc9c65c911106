"""The provenance of a result: version, commit, packages, threads, processor, command line."""

from __future__ import annotations

import os
import platform
import socket
import subprocess
import sys
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path

from hydro2d.base.formats import in_shell
from hydro2d.base.version import __version__

PACKAGES = (
    "numpy", "numba", "llvmlite", "h5py", "vtk", "pyvista", "matplotlib", "pydantic", "pint", "cyclopts", "rich",
)


def _git(*arguments: str) -> str | None:
    """Output of a git command in the folder of the sources; None if there is no git or no repository."""
    try:
        done = subprocess.run(
            ["git", "-C", str(Path(__file__).resolve().parent), *arguments],
            capture_output=True, encoding="utf-8", errors="replace", timeout=10, check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def git_commit() -> tuple[str, bool] | None:
    """Commit hash, and whether tracked files differ from it; None for a copy outside a repository."""
    if _git("ls-files", "--error-unmatch", Path(__file__).name) is None:
        return None  # the repository around an installed copy is not hydro2d's
    commit, changes = _git("rev-parse", "HEAD"), _git("status", "--porcelain", "--untracked-files=no")
    return None if commit is None else (commit, bool(changes))


def processor() -> str:
    """Model name of the CPU."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def package_versions() -> dict[str, str]:
    """Installed versions of the packages that can change a result or a file."""
    versions = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            versions[name] = "not installed"
    return versions


def command() -> str:
    """The command line, as a user would type it."""
    program = Path(sys.argv[0])
    words = ["python", "-m", program.parent.name] if program.name == "__main__.py" else [program.name]
    return in_shell(*words, *sys.argv[1:])


def collect(threads: int) -> dict:
    """The whole provenance as values for JSON; `threads` is the number of threads of the kernels."""
    git = git_commit()
    return {
        "version": __version__,
        "git_commit": git[0] if git else None,
        "git_dirty": git[1] if git else None,
        "packages": package_versions(),
        "threads": threads,
        "cpu": processor(),
        "cpu_count": os.cpu_count(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "host": socket.gethostname(),
        "command": command(),
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
    }
