"""Shared by all commands: wrong arguments, and quantities in arguments."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Overrides = Annotated[list[str] | None, Parameter(name="--set")]

#: the option that names the output of a command, a file or a folder
Out = Annotated[Path, Parameter(name=["--out", "-o"])]


class UsageError(Exception):
    """Wrong arguments, or arguments that exclude each other; the message is for the user."""


#: more threads make no machine faster, and thousands of them cause a crash
MOST = 1024


def _count(_type, tokens) -> int:
    """A whole number of threads or workers."""
    text = tokens[0].value
    if not text.isdecimal() or not 1 <= int(text) <= MOST:
        raise UsageError(f"{tokens[0].keyword} {text}: must be a whole number from 1 to {MOST}")
    return int(text)


Count = Annotated[int, Parameter(converter=_count)]

#: largest number of members of an ensemble, and of cells across a projectile
MOST_MEMBERS, FINEST = 1000, 1000.0


def whole(least: int, most: int) -> Parameter:
    """A converter to a whole number within bounds."""
    def convert(_type, tokens) -> int:
        text = tokens[0].value
        if not text.isdecimal() or not least <= int(text) <= most:
            raise UsageError(f"{tokens[0].keyword} {text}: must be a whole number from {least} to {most}")
        return int(text)

    return Parameter(converter=convert)


def refuse_old_names(arguments: list[str]) -> None:
    """Raises UsageError for the old name of --out in some commands."""
    for word in arguments[: arguments.index("--")] if "--" in arguments else arguments:
        if word.split("=")[0] == "--output":
            raise UsageError("--output is now --out in every command, or -o for short")


def quantity(text: str, unit: str, option: str) -> float:
    """The SI value of an argument. Raises UsageError, also for a number without its unit."""
    from hydro2d.base import units

    try:
        return units.of_argument(text, unit)
    except ValueError as error:
        raise UsageError(f"{option}: {error}") from None


def refuse_environment() -> None:
    """Refuses a value of an environment variable that stops a package that hydro2d stands on. Raises UsageError."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "0")
    if not epoch.strip().isdigit():
        raise UsageError(f'SOURCE_DATE_EPOCH = "{epoch}" is no number of seconds: unset it, or give it one')


def import_matplotlib() -> None:
    """Imports matplotlib without the `matplotlibrc` of the current directory, which may name programs to run as ffmpeg."""
    here = os.open(".", os.O_RDONLY) if hasattr(os, "fchdir") else os.getcwd()  # a directory may have been removed
    os.chdir(Path(__file__).parent)
    try:
        import_module("matplotlib")
    except ValueError as error:  # of a setting in the environment
        backend = os.environ.get("MPLBACKEND")
        raise UsageError(f'MPLBACKEND = "{backend}" is not a backend of matplotlib: unset it') from error
    finally:
        os.chdir(here)
        if isinstance(here, int):
            os.close(here)

