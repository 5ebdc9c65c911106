"""The command `hydro2d`. Large modules are imported where they are used, so that --help answers at once."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path
from typing import Annotated, Literal

import cyclopts
from cyclopts import App, Parameter, validators

from hydro2d import __version__
from hydro2d.cli.base import Count, Out, Overrides, Trust, UsageError, import_matplotlib, quantity, refuse_old_names
from hydro2d.cli.check_model import check_model
from hydro2d.cli.curve import curve
from hydro2d.cli.diverge import diverge
from hydro2d.cli.ensemble import By, Chosen, Member, Repeats, Seed, converge, run_all
from hydro2d.cli.fit_strength import fit_strength
from hydro2d.cli.model import model
from hydro2d.cli.new import new
from hydro2d.cli.report import report
from hydro2d.cli.status import status
from hydro2d.cli.study import sweep, transition
from hydro2d.cli.tabulate import tabulate
from hydro2d.cli.view import view
from hydro2d.interrupt import STATUS, Interrupt, ended_by, lose_output, raise_between_imports, signals
from hydro2d.terminal import say

WRONG_INPUT, REFUSED = 2, 4

app = App(
    name="hydro2d",
    version=__version__,
    help="A two-dimensional axisymmetric Eulerian hydrocode for impact: rods, balls and plates.",
    help_format="plaintext",
    suppress_keyboard_interrupt=False,  # `call` knows by which signal a command ends
    help_epilogue="Exit status: 0 success; 2 wrong deck or arguments; 3 unphysical state or failed cases; 4 refused by the "
    "machine (disk, memory, permissions); 129, 130, 141, 143 ended by SIGHUP, SIGINT, a closed pipe, SIGTERM.",
)

app.command(check_model)
app.command(converge)
app.command(curve)
app.command(diverge)
app.command(fit_strength)
app.command(model)
app.command(new)
app.command(report)
app.command(status)
app.command(sweep)
app.command(tabulate)
app.command(transition)
app.command(view)


#: modules, and their exceptions that tell the user what to correct
USER_ERRORS = (
    ("errors", "DeckError"), ("files", "LockError"), ("strange", "StrangeFile"), ("penetration.model", "InputError"),
    ("output.snapshot", "SnapshotError"), ("output.history", "HistoryError"), ("output.vtk", "VtkError"),
    ("mesh.quantities", "FieldError"), ("running.run", "RunError"), ("results.reading", "ResultsError"),
    ("results.scales", "FigureError"), ("results.viewer.fields", "ViewError"),
    ("results.terminal_charts", "ChartError"),
    ("study.definition", "StudyError"),
)


def _user_errors() -> tuple[type[Exception], ...]:
    """Exceptions that are reported as one message, without a traceback."""
    found: list[type[Exception]] = [UsageError]
    for module, name in USER_ERRORS:
        loaded = sys.modules.get(f"hydro2d.{module}")
        if loaded is not None:
            found.append(getattr(loaded, name))
    return tuple(found)


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
    """Runs a deck, or an ensemble of it that shows how sure the result is.

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
        busy machine. The results do not depend on the number of threads.
    restart
        Continues the run in the directory from its restart file; the results are bitwise the same.
    overwrite
        Replaces the run that is in the directory.
    quiet
        Prints nothing, unless the run ends as unphysical: then one line on the error output. log.txt is still written.
    repeats
        Runs an ensemble of so many members, which differ in what should not matter, as a study: its directory is --out, else
        runs/<name of the deck>_ensemble, its workers are processes, and --threads is that of each, by default 1.
    member
        Runs this one member of the ensemble, numbered from 0, as a single run. Member 0 is the deck as it stands.
    by
        What the members differ in: "mesh offset", "flank offset" or "first step"; can be repeated; default: mesh offset and
        first step.
    seed
        Which sequence of changes; default: 0.
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
    with signals(interrupt):  # from here on, through all that is imported
        from hydro2d.running import run as runs

        resolved = _load(deck, set_ if member is None else chosen.overrides(deck, set_ or []))
        found = runs.run(resolved, out, restart=restart, overwrite=overwrite, quiet=quiet, interrupt=interrupt)
    status = runs.exit_status(found)
    if quiet and status == runs.UNPHYSICAL:
        return _told(f"{out or resolved.output.directory}: unphysical: {found['stop_reason']}", status)
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
        Number of threads for the estimate of the time; default: all cores.
    picture
        Draws the bodies, the mesh, tracers and gauges, and saves the picture as this file (.png, .pdf, .svg).
    """
    from hydro2d.running import check as checks

    found = checks.check(_load(deck, set_))
    for line in found.lines(threads or os.cpu_count() or 1):
        say(line)
    if picture is not None:
        import_matplotlib()
        from hydro2d.results import figures, start_figure

        figures.save(start_figure.draw(found.dump, found.deck), picture)
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

    say(pages.page(name) if name else pages.overview())
    return 0


def _times(texts: list[str] | None) -> list[float | None]:
    return [quantity(text, "s", "--time") for text in texts] if texts else [None]


def _window(text: str | None) -> tuple[float, float, float] | None:
    if text is None:
        return None
    parts = text.split(",")
    if len(parts) != 3:
        raise UsageError(f'--window "{text}": expected three lengths z0,z1,r1, such as "-2 cm,8 cm,2 cm"')
    z0, z1, r1 = (quantity(part.strip(), "m", "--window") for part in parts)
    if not (z0 < z1 and r1 > 0):
        raise UsageError(f'--window "{text}": z0 must be less than z1, and r1 positive')
    return z0, z1, r1


def _refuse_scale(kind: str, scaled: bool, line: bool) -> None:
    """Raises UsageError for options that a kind of picture has no use for."""
    if scaled and kind not in ("section", "line", "xt"):
        raise UsageError(f"--colours, --clip, --log and --map are for --kind section, line and xt, not for {kind}")
    if line and kind not in ("line", "xt"):
        raise UsageError(f"--line is for --kind line and xt, not for {kind}")


def _line(text: str | None):
    """The line of an argument (lines.Line), None for the axis."""
    from hydro2d.results.lines import Line

    if text is None:
        return None
    parts = [quantity(part.strip(), "m", "--line") for part in text.split(",")]
    if len(parts) != 4 or parts[:2] == parts[2:]:
        raise UsageError(f'--line "{text}": expected two points r0,z0,r1,z1, such as "1 mm,-2 cm,1 mm,8 cm"')
    return Line(*parts)


@app.command
def plot(
    runs: list[Path],
    *,
    out: Out,
    kind: Literal["section", "history", "line", "xt", "crater", "debris", "cutaway"] = "section",
    field: str = "pressure",
    mirror: str | None = None,
    time: Annotated[list[str] | None, Parameter(negative="")] = None,
    window: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    quantity: Annotated[list[str] | None, Parameter(negative="")] = None,
    line: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    colours: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    clip: float = 0.0,
    log: Annotated[bool, Parameter(negative="")] = False,
    map_: Annotated[str | None, Parameter(name="--map")] = None,
) -> int:
    """Draws runs as sections, histories, values along a line, holes in their targets, debris, or a cut-away.

    Sections are mirrored at the axis, and on a planar mesh at a wall that stands at r = 0; others are drawn as they are.

    Example: hydro2d plot runs/a runs/b -o both.png --field von_mises --mirror material --time "80 us"

    Example: hydro2d plot runs/a -o waves.png --kind xt --field pressure --clip 1

    Parameters
    ----------
    runs
        Run directories. Sections of several runs are drawn below one another, histories and craters in the same axes.
    out
        Picture file; its suffix sets the format.
    kind
        What to draw. line: a field along a line, a curve for each run and time; xt: a field along a line, in colours over place
        and time; crater: the holes in the targets; debris: what flies behind them.
    field
        Field, or that of the upper half, as `hydro2d info` names it; velocity:z for a component, body_temperature:rod for one
        body.
    mirror
        Field of the lower half of a mirrored section; default: the same.
    time
        Time, such as "80 us", whose nearest dump is drawn; default: the last dump. Can be repeated, for sections side by side.
    window
        Part of the mesh to show, z0,z1,r1, such as "-2 cm,8 cm,2 cm".
    quantity
        Column of the history; can be repeated.
    line
        Line of --kind line and xt, r0,z0,r1,z1, such as "1 mm,-2 cm,1 mm,8 cm"; default: the axis.
    colours
        Range of the field, low,high, in the unit of the colour bar; default: that of what is shown.
    clip
        Per cent of the cells whose values may lie beyond each end of the range, so that a few do not take all colours.
    log
        Logarithmic scale of the field; what is not positive has no colour.
    map_
        Colour map of matplotlib, such as magma; default: viridis, and blue to red for fields with negative values.
    """
    import_matplotlib()
    from hydro2d.results import figures, lines
    from hydro2d.results.reading import Results
    from hydro2d.results.scales import Scale

    opened, times = [Results(path) for path in runs], _times(time)
    scale, limits = Scale(clip, log, map_), _range(colours)
    _refuse_scale(kind, scale != Scale() or limits is not None, line is not None)
    if kind == "cutaway":
        if len(opened) != 1 or len(times) != 1 or out.suffix != ".png":
            raise UsageError("--kind cutaway draws one run at one time, as a .png")
        if opened[0].planar:
            raise UsageError(f"{opened[0].directory}: the mesh is planar, so there is no axis to turn a cut-away about")
        figures.cutaway(opened[0].dump_file(times[0]), out, field, _window(window))
    elif kind == "history":
        figures.save(figures.histories(opened, quantity or figures.HISTORIES), out)
    elif kind == "crater":
        figures.save(figures.craters(opened), out)
    elif kind == "debris":
        figures.save(lines.debris(opened), out)
    elif kind == "line":
        figures.save(lines.line_outs(opened, field, _line(line), times, limits=limits, scale=scale), out)
    elif kind == "xt":
        figures.save(lines.space_time(opened, field, _line(line), limits=limits, scale=scale), out)
    else:
        figures.save(figures.sections(opened, field, mirror=mirror, times=times, window=_window(window), limits=limits,
                                      scale=scale), out)  # fmt: skip
    say(f"wrote {out}")
    return 0


@app.command
def movie(
    runs: list[Path],
    *,
    out: Out,
    field: str = "pressure",
    mirror: str | None = None,
    window: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    follow: str | None = None,
    colours: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    rate: Annotated[float, Parameter(validator=validators.Number(gt=0, lte=120))] = 10.0,
    beside: bool = False,
) -> int:
    """Makes a film from the dumps of runs, with one colour range for all frames.

    Example: hydro2d movie runs/a runs/b -o both.mp4 --field von_mises --mirror material --follow rod --window "-8 cm,2 cm,2 cm"

    Parameters
    ----------
    runs
        Run directories; several are shown below one another.
    out
        Film file: .gif, or .mp4 where ffmpeg is installed.
    field
        Field, or that of the upper half, as `hydro2d info` names it; velocity:z for a component, body_temperature:rod for one
        body.
    mirror
        Field of the lower half of a mirrored section; default: the same.
    window
        Part of the mesh to show, z0,z1,r1, such as "-2 cm,8 cm,2 cm".
    follow
        Body that the window follows; z0 and z1 are then measured from its leading end.
    colours
        Colour range of the field, low,high, in the unit of the colour bar; default: the range of all frames.
    rate
        Frames per second.
    beside
        Shows several runs side by side.
    """
    import_matplotlib()
    from hydro2d.results import movies
    from hydro2d.results.reading import Results

    opened = [Results(path) for path in runs]
    frames = movies.film(opened, out, field, mirror=mirror, window=_window(window), follow=follow, limits=_range(colours),
                         rate=rate, beside=beside)  # fmt: skip
    say(f"wrote {out}, {frames} frames")
    return 0


def _range(text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    try:
        low, high = (float(part) for part in text.split(","))
    except ValueError:
        raise UsageError(f'--colours "{text}": expected two numbers low,high, such as "0,2.5"') from None
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise UsageError(f'--colours "{text}": low must be less than high')
    return low, high


@app.command
def export(
    run: Path,
    *,
    out: Out | None = None,
    fields: Annotated[list[str] | None, Parameter(negative="", consume_multiple=True)] = None,
    trust: Trust = False,
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
        Runs the code of models from outside that the deck of the run carries; a run without dumps needs it. Only for a run
        whose origin you know.
    """
    from hydro2d.results.export import export as write
    from hydro2d.results.reading import Results
    from hydro2d.strange import own

    for path in write(Results(run, trust=trust), out or own(run / "export"), fields or ("all",)):
        say(f"wrote {path}")
    return 0


@app.command
def bench(*, json: Path | None = None, shot: bool = False, threads: Count | None = None) -> int:
    """Measures the time per cell and cycle, phase by phase, and the memory bandwidth (a triad) in the same run.

    Example: hydro2d bench --json bench.json

    Parameters
    ----------
    json
        Also writes the numbers to this JSON file.
    shot
        Also runs the shot at 1086 m/s to rest, with all its outputs, on one thread and on all; this takes minutes.
    threads
        Number of threads; default: all cores.
    """
    _set_threads(threads)
    from hydro2d.running import bench as benches

    return benches.main(json, shot=shot)


@app.command
def schema() -> int:
    """Prints the JSON schema of decks, for editors.

    Example: hydro2d schema > deck.schema.json
    """
    import json

    from hydro2d.deck import deck as decks

    say(json.dumps(decks.schema(), indent=2))
    return 0


def main(arguments: list[str] | None = None) -> None:
    """Runs the command line and exits with its status."""
    raise_between_imports()
    sys.exit(call(sys.argv[1:] if arguments is None else arguments))


def call(arguments: list[str]) -> int:
    """Runs the command line and returns its status; an error that the user can correct is reported as one message."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without UTF-8 gets question marks, not a traceback
    try:
        refuse_old_names(arguments)
        status = app(arguments, exit_on_error=False, print_error=False, result_action="return_value")
        sys.stdout.flush()
        return status if isinstance(status, int) else 0
    except cyclopts.CycloptsError as error:
        return _told(error, WRONG_INPUT)
    except KeyboardInterrupt:
        return STATUS[ended_by()]
    except BrokenPipeError:
        lose_output()
        return STATUS["SIGPIPE"]
    except _user_errors() as error:
        return _told(error, WRONG_INPUT)
    except MemoryError as error:
        return _told(f"not enough memory{f': {error}' if str(error) else ''}", REFUSED)
    except (NotADirectoryError, FileExistsError) as error:
        return _told(_no_directory(error), WRONG_INPUT)
    except OSError as error:
        where = f": {error.filename}" if error.filename is not None else ""
        return _told(f"{error.strerror or error}{where}", REFUSED)


def _no_directory(error: OSError) -> str:
    """Says which part of a path is a file where a directory is needed."""
    path = Path(os.fsdecode(error.filename or ""))
    file = next((each for each in (path, *path.parents) if each.is_file()), None)
    within = f", so {path} cannot exist" if file != path else ""
    return f"{file} is a file, not a directory{within}" if file else f"{error.strerror}: {path}"


def _told(error: object, status: int) -> int:
    say(f"hydro2d: {error}", file=sys.stderr)
    return status
