"""The command `hydro2d`. Large modules are imported where they are used, so that --help answers at once."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path
from typing import Annotated

import cyclopts
from cyclopts import App, Parameter

from hydro2d.base.errors import Error
from hydro2d.base.interrupt import STATUS, Interrupt, ended_by, lose_output, open_closed_streams, raise_between_imports, signals
from hydro2d.base.terminal import flowing, flush, say, wrapped
from hydro2d.base.version import __version__
from hydro2d.cli.base import Count, Out, Overrides, UsageError, import_matplotlib, refuse_environment, refuse_old_names
from hydro2d.cli.check_model import check_model
from hydro2d.cli.compile import compile_kernels
from hydro2d.cli.curve import curve
from hydro2d.cli.diverge import diverge
from hydro2d.cli.ensemble import By, Chosen, Member, Repeats, Seed, converge, run_all
from hydro2d.cli.fit_strength import fit_strength
from hydro2d.cli.model import model
from hydro2d.cli.new import new
from hydro2d.cli.pictures import movie, plot
from hydro2d.cli.report import report
from hydro2d.cli.status import status
from hydro2d.cli.study import sweep, transition
from hydro2d.cli.tabulate import tabulate
from hydro2d.cli.view import view
from hydro2d.files.locks import LostPlaceError

WRONG_INPUT, REFUSED = 2, 4
#: what the system says of a library for which there is no memory
NO_ROOM = "failed to map segment from shared object"
#: what Python says if there is no room for the stack of a thread
NO_THREAD = "can't start new thread"

app = App(
    name="hydro2d",
    version=__version__,
    help="A two-dimensional axisymmetric Eulerian hydrocode for impact: rods, balls and plates.",
    help_format="plaintext",
    # "[1]" is the name of a directory; an option is negated only where that does something, as --no-open
    default_parameter=Parameter(json_list=False, json_dict=False, negative_bool="", negative_iterable=""),
    suppress_keyboard_interrupt=False,  # `call` knows by which signal a command ends
    help_epilogue="Exit status: 0 success; 2 wrong deck or arguments; 3 unphysical state or failed cases; 4 refused by the "
    "machine (disk, memory, permissions); 129, 130, 141, 143 ended by SIGHUP, SIGINT, a closed pipe, SIGTERM.",
)

app.command(check_model)
app.command(compile_kernels, name="compile")
app.command(converge)
app.command(curve)
app.command(diverge)
app.command(fit_strength)
app.command(model)
app.command(movie)
app.command(new)
app.command(plot)
app.command(report)
app.command(status)
app.command(sweep)
app.command(tabulate)
app.command(transition)
app.command(view)


def _set_threads(threads: int | None) -> None:
    """Sets the number of threads. Best called before numba is imported, because numba reads the largest number once."""
    if threads is None:
        return
    if "numba" not in sys.modules:
        os.environ["NUMBA_NUM_THREADS"] = str(threads)
        return
    from hydro2d.jit import max_threads, set_threads

    if threads > max_threads():
        raise UsageError(f"--threads {threads}: this process can use at most {max_threads()}")
    set_threads(threads)


def _load(deck: Path, overrides: list[str] | None):
    from hydro2d.deck import deck as decks

    return decks.load(deck, overrides or [])


def _theory(deck, summary) -> list[str]:
    """Lines with the results of analytic models for a finished run."""
    from hydro2d.analytic import beside

    return beside.lines(deck, summary)


@app.command
def run(
    deck: Path,
    *,
    out: Out | None = None,
    set_: Overrides = None,
    threads: Count | None = None,
    restart: bool = False,
    overwrite: bool = False,
    quiet: bool = False,
    repeats: Repeats | None = None,
    member: Member | None = None,
    by: By = None,
    seed: Seed | None = None,
    workers: Count | None = None,
) -> int:
    """Runs a deck, or an ensemble of it that shows the scatter of the result.

    Example: hydro2d run problems/cth_nose_shape/hemi_5083_1086.toml --out runs/a --set mesh.r.0.cells=40 --threads 4

    Example: hydro2d run problems/cth_nose_shape/hemi_5083_1086_quick.toml --repeats 8

    Parameters
    ----------
    deck
        Input deck (TOML).
    out
        Run directory; default: output.directory of the deck, else runs/<name of the deck>.
    set_
        Overrides a value of the deck, as key=value; can be repeated.
    threads
        Largest number of threads; default: all cores. A run uses fewer where that is faster, for example on a small mesh or a
        busy machine, and compiles kernels with a second process unless it is 1. The results do not depend on it.
    restart
        Continues the run in the directory from its restart file; the results are bitwise identical.
    overwrite
        Replaces the run in the directory.
    quiet
        Prints nothing, except one line on the error output if the run ends as unphysical. log.txt is still written.
    repeats
        Runs an ensemble of this many members, which differ in what should not matter, as a study. Its directory is --out, else
        runs/<name of the deck>_ensemble. Its workers are processes; --threads applies to each, by default 1.
    member
        Runs only this member of the ensemble, numbered from 0, as a single run. Member 0 is the unchanged deck.
    by
        Differences between members: "mesh offset", "flank offset" or "first step"; can be repeated; default: mesh offset and
        first step.
    seed
        Seed of the sequence of changes; default: 0.
    workers
        Number of worker processes of --repeats; default: cores / threads.
    """
    chosen = Chosen(repeats, member, by, seed, workers)
    chosen.check()
    if restart and overwrite:
        raise UsageError("--restart continues a run and --overwrite removes it: give one of them")
    if repeats is not None:
        return run_all(chosen, deck, set_ or [], out, threads=threads or 1, restart=restart, overwrite=overwrite, quiet=quiet)
    _set_threads(threads)
    interrupt = Interrupt()
    with signals(interrupt):  # from here on, during all imports
        from hydro2d.running import run as runs

        resolved = _load(deck, set_ if member is None else chosen.overrides(deck, set_ or []))
        ended = runs.run(resolved, out, restart=restart, overwrite=overwrite, quiet=quiet, interrupt=interrupt, theory=_theory)
    status = runs.exit_status(ended)
    if quiet and status == runs.UNPHYSICAL:
        return _report(f"{out or resolved.output.directory}: unphysical: {ended['stop_reason']}", status)
    return status


@app.command
def check(
    deck: Path, *, set_: Overrides = None, threads: Count | None = None, picture: Path | None = None,
) -> int:
    """Validates a deck and summarises it: mesh, masses, cells across every body, cost and memory.

    Example: hydro2d check problems/cth_nose_shape/hemi_5083_1086.toml --picture start.png

    Parameters
    ----------
    deck
        Input deck (TOML).
    set_
        Overrides a value of the deck, as key=value; can be repeated.
    threads
        Number of threads for the time estimate; default: all cores.
    picture
        Draws the bodies, the mesh, tracers and gauges, and saves the picture as this file (.png, .pdf, .svg).
    """
    from hydro2d.running import check as checks

    checked = checks.check(_load(deck, set_))
    for line in checked.lines(threads or os.cpu_count() or 1):
        say(wrapped(line))
    if picture is not None:
        import_matplotlib()
        from hydro2d.results import figures, start_figure

        figures.save_figure(start_figure.draw(checked.dump, checked.deck), picture)
        say(f"wrote     {picture}")
    return 0


@app.command
def info(name: str | None = None) -> int:
    """Explains a material, a model, a field or a deck key; without a name, lists all names.

    Example: hydro2d info johnson-cook

    Parameters
    ----------
    name
        For example W_alloy, mie-grueneisen, pressure, numerics.courant.
    """
    from hydro2d.cli import info as pages

    say(wrapped(pages.page(name) if name else pages.overview()))
    return 0


@app.command
def export(
    run: Path,
    *,
    out: Out | None = None,
    fields: Annotated[list[str] | None, Parameter(consume_multiple=True)] = None,
    trust: bool = False,
) -> int:
    """Writes a VTK series that ParaView opens with one click, and the history as CSV.

    Example: hydro2d export runs/a --fields pressure velocity -o for_paraview

    Parameters
    ----------
    run
        Run directory. If it has no dumps, the state in its restart file is written, with all fields.
    out
        Directory to write to; default: `export` in the run directory.
    fields
        Fields to write, as `hydro2d info` names them; default: all fields of the dumps.
    trust
        Runs the code of outside models that the deck of the run carries; a run without dumps needs it. Use it only for a run
        whose origin you know.
    """
    from hydro2d.files.strange import own
    from hydro2d.results.export import export as write
    from hydro2d.results.reading import Results

    for path in write(Results(run, trust=trust), out or own(run / "export"), fields or ("all",)):
        say(f"wrote {path}")
    return 0


@app.command
def bench(deck: Path | None = None, *, json: Path | None = None, shot: bool = False, compilation: bool = False,
          threads: Count | None = None) -> int:
    """Measures the time per cell and cycle, phase by phase, and the memory bandwidth (a triad) in the same run.

    Example: hydro2d bench --json bench.json

    Parameters
    ----------
    deck
        The deck of --shot; default: the README's first shot.
    json
        Also writes the numbers to this JSON file.
    shot
        Runs a deck to its end instead, with all its outputs, on one thread and on all, and prints where the time goes.
    compilation
        Also compiles all kernels of the README's first shot anew, and reports the time of each kernel and each stage.
    threads
        Number of threads; default: all cores.
    """
    _set_threads(threads)
    from hydro2d.running import bench as benches

    if deck is not None and not shot:
        raise UsageError(f"{deck}: a deck is measured with --shot; without it, omit the deck")
    return benches.main(json, shot=(deck or Path(benches.DECK)) if shot else None, compilation=compilation)


@app.command
def schema() -> int:
    """Prints the JSON schema of decks, for editors.

    Example: hydro2d schema > deck.schema.json
    """
    import json

    from hydro2d.deck import deck as decks

    say(json.dumps(decks.schema(), indent=2))
    return 0


def _let_flow(commands: App) -> None:
    """Makes each paragraph of the help of commands, and of commands below them, one line."""
    for name in commands:
        if not name.startswith("-"):
            function = commands[name].default_command
            function.__doc__ = flowing(function.__doc__ or "")
            _let_flow(commands[name])


_let_flow(app)


def main(arguments: list[str] | None = None) -> None:
    """Runs the command line and exits with its status."""
    open_closed_streams()
    raise_between_imports()
    sys.exit(call(sys.argv[1:] if arguments is None else arguments))


def call(arguments: list[str]) -> int:
    """Runs the command line and returns its status; an error that the user can correct is reported as one message."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without UTF-8 gets question marks, not a traceback
    try:
        refuse_environment()
        refuse_old_names(arguments)
        status = app(arguments, exit_on_error=False, print_error=False, result_action="return_value")
        flush()
        return status if isinstance(status, int) else 0
    except cyclopts.CycloptsError as error:
        return _report(error, WRONG_INPUT)
    except KeyboardInterrupt:
        return STATUS[ended_by()]
    except BrokenPipeError:
        lose_output()
        return STATUS["SIGPIPE"]
    except LostPlaceError as error:
        return _report(error, REFUSED)
    except (UsageError, Error) as error:
        return _report(error, WRONG_INPUT)
    except MemoryError as error:
        return _report(f"not enough memory{f': {error}' if str(error) else ''}", REFUSED)
    except (NotADirectoryError, FileExistsError) as error:
        return _report(_no_directory(error), WRONG_INPUT)
    except RuntimeError as error:
        if NO_THREAD not in str(error):
            raise
        return _report(f"{NO_THREAD}: too little memory, or too many threads; allow more with `ulimit -v` or `-u`", REFUSED)
    except (ImportError, OSError) as error:
        if library := _without_room(error):
            return _report(f"not enough memory to load {library}; allow more with `ulimit -v`", REFUSED)
        if isinstance(error, ImportError):
            raise
        where = f": {error.filename}" if error.filename is not None else ""
        remedy = "; allow more with `ulimit -n`" if error.errno == errno.EMFILE else ""
        return _report(f"{error.strerror or error}{where}{remedy}", REFUSED)


def _without_room(error: BaseException | None) -> str:
    """The library for which there was no memory, with what the system says of it; empty for an error of another kind.

    Packages replace the exception of the system by one of their own, which is all that they print.
    """
    said = ""
    while error is not None:
        said, error = str(error) if NO_ROOM in str(error) else said, error.__cause__ or error.__context__
    return said


def _no_directory(error: OSError) -> str:
    """The message for a path in which a file stands where a directory is needed."""
    path = Path(os.fsdecode(error.filename or ""))
    file = next((each for each in (path, *path.parents) if each.is_file()), None)
    within = f", so {path} cannot exist" if file != path else ""
    return f"{file} is a file, not a directory{within}" if file else f"{error.strerror}: {path}"


def _report(error: object, status: int) -> int:
    say(f"hydro2d: {error}", file=sys.stderr)
    return status
