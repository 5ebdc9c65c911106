"""Failing outputs: a file that cannot be written is named, and the others are still written."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hydro2d.base.errors import Error


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turns any error of an output into an OSError that names the file; hydro2d's own errors pass unchanged."""
    try:
        yield
    except Error:
        raise
    except OSError as error:
        if error.errno is None:
            raise _unwritten(path, error) from error
        error.filename = str(path) if error.filename is None else error.filename
        raise
    except Exception as error:
        raise _unwritten(path, error) from error


def _unwritten(path: Path, error: Exception) -> OSError:
    return OSError(f"{path} could not be written: {type(error).__name__}: {' '.join(str(error).split())}")


class Attempts:
    """Outputs that are all tried, even after an error.

    first : an error that occurred before them
    """

    def __init__(self, first: Exception | None = None):
        self._errors = [] if first is None else [first]

    @contextmanager
    def writing(self, path: Path) -> Iterator[None]:
        """Keeps the error of an output until the end."""
        try:
            with writing(path):
                yield
        except (OSError, Error) as error:
            self._errors.append(error)

    @property
    def failures(self) -> str:
        """The files that could not be written, and why; empty if there are none."""
        return "; ".join(dict.fromkeys(map(said, self._errors)))

    def conclude(self) -> None:
        """Raises the kept errors: a single one unchanged, several as an OSError that names all files."""
        if len(set(map(said, self._errors))) > 1:
            raise OSError(self.failures) from self._errors[0]
        if self._errors:
            raise self._errors[0]


def said(error: Exception) -> str:
    """The message of an error, with the file but without the number of a system error."""
    if isinstance(error, MemoryError):
        return f"not enough memory{f': {error}' if str(error) else ''}"
    named = isinstance(error, OSError) and error.filename is not None
    return f"{error.filename}: {error.strerror}" if named else str(error)
