"""The figures of a report as files, each with a caption and with words for those who cannot see it."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from hydro2d.results import figures
from hydro2d.study import drawing, experiments, record, rods, series, theory
from hydro2d.study.contents import Contents
from hydro2d.study.record import Record, Setup

#: names of pictures, for those that an earlier report has left
NAMES = re.compile(r"(depth|histories|rods)_[\w-]+\.png")
#: pages of rods beyond which the rest is left out, and said to be
MOST_PAGES = 8
#: share by which the models' lines reach beyond the velocities of runs and experiments
BEYOND = 0.05


@dataclass(frozen=True)
class Picture:
    """A figure of the report: its file, its heading, what it shows, and the same for those who cannot see it."""

    file: Path
    heading: str
    caption: str
    alt: str
    notes: tuple[str, ...] = ()

    @property
    def data(self) -> str:
        """The file as an address that needs no network."""
        return "data:image/png;base64," + base64.b64encode(self.file.read_bytes()).decode()


def draw(contents: Contents, folder: Path) -> Iterator[Picture]:
    """Draws every figure into a file."""
    names: list[str] = []
    for setup, members in contents.groups.items():
        name = re.sub(r"[^\w-]+", "-", f"{setup.rod}_{setup.target}_{setup.nose}")
        names.append(name)
        name += f"_{names.count(name)}" if names.count(name) > 1 else ""
        yield _depths(contents, setup, members, folder / f"depth_{name}.png")
        if any(each.history for each in members):
            yield _histories(contents, setup, members, folder / f"histories_{name}.png")
    yield from _rods(contents, folder)


def _depth(record: Record) -> str:
    """The depth of a run in words."""
    return "perforated" if record.perforated else f"{'at least ' * record.left}{record.depth * 100:.1f} cm"


def _depths(contents: Contents, setup: Setup, members: Sequence[Record], file: Path) -> Picture:
    done = [each for each in members if each.done and each.depth is not None]
    shots = contents.measurements[setup]
    speeds = [each.velocity for each in members] + [shot.velocity for shot in shots]
    beyond = BEYOND * ((max(speeds) - min(speeds)) or max(speeds))
    curves = theory.curves(members[0].shot, max(min(speeds) - beyond, 1.0), max(speeds) + beyond)
    figures.save(drawing.depths(setup, series.grouped(done, contents.study.axes), shots, curves), file)
    depths = [f"{each.case.name} {_depth(each)}" for each in done[:12]]
    measured = [f"{shot.velocity:.0f} m/s {'at least ' if shot.qualifier == experiments.AT_LEAST else ''}"
                f"{shot.depth * 100:.1f} cm" for shot in shots]  # fmt: skip
    alt = (
        f"Depth against impact velocity, {setup.words}. Runs: {'; '.join(depths) or 'none done'}"
        f"{f' and {len(done) - 12} more' if len(done) > 12 else ''}. Experiments: {'; '.join(measured) or 'none known'}."
    )
    models = ", ".join(curve.title for curve in curves if curve.drawable)
    caption = (
        f"Depth against impact velocity: {setup.words}. Hollow: runs that are done ({len(done)} of {len(members)}); filled: "
        f"experiments; thick line: the target's rear; grey lines: {models or 'no model could be evaluated'}"
        + (f", with the deck of {members[0].case.name}." if models else ".")
    )
    notes = [f"{curve.title}: {curve.note}." for curve in curves if curve.note]
    return Picture(file, f"Depth: {setup.rod} into {setup.target}, {setup.nose} nose", caption, alt, tuple(notes))


def _histories(contents: Contents, setup: Setup, members: Sequence[Record], file: Path) -> Picture:
    drawn = [each for each in members if each.history]
    figures.save(drawing.histories(series.grouped(drawn, contents.study.axes)), file)
    ends = [each.history["time"][-1] * 1e6 for each in drawn]
    what = f"depth, tail velocity and rod length against time, {len(drawn)} runs of {setup.words}"
    alt = f"Three panels: {what}. The runs end between {min(ends):.0f} and {max(ends):.0f} µs."
    told = "one line style a run" if len(drawn) <= drawing.MOST_LINES else "one line style a series of runs"
    caption = f"{what[0].upper()}{what[1:]}; {told}, at most {record.POINTS} points of each history."
    return Picture(file, f"Histories: {setup.rod} into {setup.target}, {setup.nose} nose", caption, alt)


def _rods(contents: Contents, folder: Path) -> Iterator[Picture]:
    """Pages of rods; all of them share one scale."""
    with_rod = [each for each in contents.records if each.rod]
    shown = rods.pages(with_rod)[:MOST_PAGES]
    scale = [each for part in shown for each in part]
    at_depth = bool(scale) and rods.at_their_depths(scale, contents.belonging)
    where = "at their depths below the target's original surface" if at_depth else "tip beside tip"
    measured = at_depth and any(each.case.name in contents.belonging for each in scale)
    left_out = f" {len(with_rod) - len(scale)} further runs are not drawn." if len(with_rod) > len(scale) else ""
    for number, part in enumerate(shown, 1):
        file = folder / f"rods_{number:02d}.png"
        figures.save(rods.draw(part, contents.belonging, scale), file)
        caption = (
            f"Rods at the end of their runs, {where}, at one scale; dotted: the rod before impact, its tip at the same place"
            + ("; dashed: the experiment's depth." if measured else ".")
            + (f" Page {number} of {len(shown)}.{left_out}" if len(shown) > 1 else "")
        )
        alt = "Final rod shapes: " + "; ".join(map(_shape_in_words, part)) + "."
        yield Picture(file, f"Rods {number} of {len(shown)}" if len(shown) > 1 else "Rods", caption, alt)


def _shape_in_words(each: Record) -> str:
    length, first = each.value("rod_length_m"), each.value("rod_initial_length_m")
    return f"{each.case.name}, {length / first * 100:.0f} % of its length" if length and first else each.case.name
