"""The command `hydro2d`. Everything heavy is imported where it is used, so that --help answers at once."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

import cyclopts
from cyclopts import App, Parameter

from . import __version__

WRONG_INPUT = 2

app = App(
    name="hydro2d",
    version=__version__,
    help="A two-dimensional axisymmetric Eulerian hydrocode for rod-into-plate impact.",
    help_format="plaintext",
    help_epilogue="Exit status: 0 done, 2 deck or arguments wrong, 3 unphysical state, 130/143 interrupted.",
)

Overrides = Annotated[list[str] | None, Parameter(name="--set", negative="")]


class UsageError(Exception):
    """Arguments that do not go together; the message is for the user."""


def _user_errors() -> tuple[type[Exception], ...]:
    """What is the user's to mend: told in one message, without a traceback."""
    found: list[type[Exception]] = [UsageError]
    for module, name in (
        ("deck_errors", "DeckError"), ("run", "RunError"), ("snapshot", "SnapshotError"), ("history", "HistoryError"),
        ("vtk", "VtkError"), ("figures", "FigureError"), ("results", "ResultsError"),
    ):  # fmt: skip
        loaded = sys.modules.get(f"hydro2d.{module}")
        if loaded is not None:
            found.append(getattr(loaded, name))
    return tuple(found)


def _set_threads(threads: int | None) -> None:
    """Fixes the number of threads before numba is imported, which reads it once."""
    if threads is None:
        return
    if threads < 1:
        raise UsageError(f"--threads {threads}: at least 1 is needed")
    os.environ["NUMBA_NUM_THREADS"] = str(threads)


def _load(deck: Path, overrides: list[str] | None):
    from . import deck as decks

    return decks.load(deck, overrides or [])


@app.command
def run(
    deck: Path,
    *,
    out: Path | None = None,
    set_: Overrides = None,
    threads: int | None = None,
    restart: bool = False,
    overwrite: bool = False,
    quiet: bool = False,
) -> int:
    """Runs a deck.

    Example: hydro2d run problems/scheffler/hemi_1086.toml --out runs/a --set mesh.r.0.cells=40 --threads 4

    Parameters
    ----------
    deck
        The input deck, TOML.
    out
        Directory of the run; default: what the deck says, else runs/<name of the deck>.
    set_
        Replaces a value of the deck, key=value; may be given several times.
    threads
        Number of threads; default: all cores. The results do not depend on it.
    restart
        Continues the run of the directory from its restart file, to the same bits.
    overwrite
        Removes a run that is in the directory.
    quiet
        Prints nothing; log.txt is written.
    """
    if restart and overwrite:
        raise UsageError("--restart continues a run and --overwrite removes it: give one of them")
    _set_threads(threads)
    from . import run as runs

    resolved = _load(deck, set_)
    return runs.exit_status(runs.run(resolved, out, restart=restart, overwrite=overwrite, quiet=quiet))


@app.command
def schema() -> int:
    """Prints the JSON schema of decks, for editors.

    Example: hydro2d schema > deck.schema.json
    """
    import json

    from . import deck as decks

    print(json.dumps(decks.schema(), indent=2))
    return 0


def main(arguments: list[str] | None = None) -> None:
    """Runs the command line and exits with its status."""
    sys.exit(call(sys.argv[1:] if arguments is None else arguments))


def call(arguments: list[str]) -> int:
    """Runs the command line and returns its status."""
    try:
        status = app(arguments, exit_on_error=False, print_error=False, result_action="return_value")
    except cyclopts.CycloptsError as error:
        print(f"hydro2d: {error}", file=sys.stderr)
        return WRONG_INPUT
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        return 0
    except _user_errors() as error:
        print(f"hydro2d: {error}", file=sys.stderr)
        return WRONG_INPUT
    return status if isinstance(status, int) else 0
