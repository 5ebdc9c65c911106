"""The commands `hydro2d plot` and `hydro2d movie`: pictures and films of runs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter, validators

from hydro2d.base.terminal import say
from hydro2d.cli.base import Out, UsageError, import_matplotlib, quantity

#: kinds of pictures whose numbers can be written as a table
TABLES = ("line", "history", "crater")


def plot(
    runs: list[Path],
    *,
    out: Out,
    kind: Literal["section", "history", "line", "xt", "crater", "debris", "cutaway"] = "section",
    field: str = "pressure",
    mirror: str | None = None,
    time: list[str] | None = None,
    window: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    quantity: list[str] | None = None,
    line: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    colours: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    clip: float = 0.0,
    log: bool = False,
    map_: Annotated[str | None, Parameter(name="--map")] = None,
) -> int:
    """Draws runs as sections, histories, values along a line, holes in their targets, debris, or a cut-away.

    The numbers of a line, a history or a hole are written as a table if the file is a .csv.

    Sections are mirrored at the axis or, on a planar mesh, at a wall at r = 0; others are drawn as they are.

    Example: hydro2d plot runs/a runs/b -o both.png --field von_mises --mirror material --time "80 us"

    Example: hydro2d plot runs/a -o waves.png --kind xt --field pressure --clip 1

    Example: hydro2d plot runs/a -o axis.csv --kind line --field pressure --time "20 us" --time "40 us"

    Parameters
    ----------
    runs
        Run directories. Sections of several runs are drawn below one another, histories and craters in the same axes.
    out
        Picture file; its suffix sets the format. With .csv it is a table, for --kind line, history and crater.
    kind
        Kind of picture. line: a field along a line, a curve for each run and time; xt: a field along a line, in colours over
        place and time; crater: the holes in the targets; debris: the debris behind them.
    field
        Field, or that of the upper half, as `hydro2d info` names it; velocity:z for a component, body_temperature:rod for one
        body.
    mirror
        Field of the lower half of a mirrored section; default: the same.
    time
        Time, such as "80 us"; the nearest dump is drawn. Default: the last dump. Can be repeated, for sections side by side.
    window
        Part of the mesh to show, z0,z1,r1, such as "-2 cm,8 cm,2 cm".
    quantity
        Column of the history; can be repeated.
    line
        Line of --kind line and xt, r0,z0,r1,z1, such as "1 mm,-2 cm,1 mm,8 cm"; default: the axis.
    colours
        Range of the field, low,high, in the unit of the colour bar; default: the range of the values shown.
    clip
        Per cent of the cells whose values may lie beyond each end of the range, so that a few do not use up all colours.
    log
        Logarithmic scale of the field; values that are not positive have no colour.
    map_
        Colour map of matplotlib, such as magma; default: viridis, and blue to red for fields with negative values.
    """
    import_matplotlib()
    from hydro2d.results import cutaway, figures, line_figures, tables
    from hydro2d.results.reading import Results
    from hydro2d.results.scales import Scale

    opened, times = [Results(path) for path in runs], _times(time)
    scale, limits = Scale(clip, log, map_), _range(colours)
    _refuse_scale(kind, scale != Scale() or limits is not None, line is not None)
    if out.suffix.lower() == tables.ENDING:
        if kind not in TABLES:
            raise UsageError(f"--kind {kind} has no table; a .csv is for --kind {', '.join(TABLES)}")
        if scale != Scale() or limits is not None:
            raise UsageError("--colours, --clip, --log and --map are for pictures, not for a table")
        tables.save({"line": lambda: tables.line_outs(opened, field, _line(line), times),
                     "history": lambda: tables.histories(opened, quantity or figures.HISTORIES),
                     "crater": lambda: tables.craters(opened)}[kind](), out)
    elif kind == "cutaway":
        if len(opened) != 1 or len(times) != 1 or out.suffix != ".png":
            raise UsageError("--kind cutaway draws one run at one time, as a .png")
        if opened[0].planar:
            raise UsageError(f"{opened[0].directory}: the mesh is planar, so there is no axis to turn a cut-away about")
        cutaway.draw(opened[0].dump_file(times[0]), out, field, _window(window))
    elif kind == "history":
        figures.save_figure(figures.histories(opened, quantity or figures.HISTORIES), out)
    elif kind == "crater":
        figures.save_figure(figures.craters(opened), out)
    elif kind == "debris":
        figures.save_figure(line_figures.debris(opened), out)
    elif kind == "line":
        figures.save_figure(line_figures.line_outs(opened, field, _line(line), times, limits=limits, scale=scale), out)
    elif kind == "xt":
        figures.save_figure(line_figures.space_time(opened, field, _line(line), limits=limits, scale=scale), out)
    else:
        figures.save_figure(figures.sections(opened, field, mirror=mirror, times=times, window=_window(window), limits=limits,
                                      scale=scale), out)
    say(f"wrote {out}")
    return 0


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
                         rate=rate, beside=beside)
    say(f"wrote {out}, {frames} frames")
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
    """Raises UsageError for options that do not apply to a kind of picture."""
    if scaled and kind not in ("section", "line", "xt"):
        raise UsageError(f"--colours, --clip, --log and --map are for --kind section, line and xt, not for {kind}")
    if line and kind not in ("line", "xt"):
        raise UsageError(f"--line is for --kind line and xt, not for {kind}")


def _line(text: str | None):
    """The line of an argument (line_figures.Line), None for the axis."""
    from hydro2d.results.line_figures import Line

    if text is None:
        return None
    parts = [quantity(part.strip(), "m", "--line") for part in text.split(",")]
    if len(parts) != 4 or parts[:2] == parts[2:]:
        raise UsageError(f'--line "{text}": expected two points r0,z0,r1,z1, such as "1 mm,-2 cm,1 mm,8 cm"')
    return Line(*parts)


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
