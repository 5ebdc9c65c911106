"""The pictures and films of a report as files: rods at the end of their runs, fitted curves of searches, films of runs."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from hydro2d.base.errors import unknown
from hydro2d.materials import quantities
from hydro2d.output.vtk import VtkError
from hydro2d.results import figures, movies, reading
from hydro2d.results.scales import FigureError
from hydro2d.study.ensemble.contents import Contents
from hydro2d.study.records.record import Record
from hydro2d.study.records.study_directory import INVALID, WAITING
from hydro2d.study.report import rods
from hydro2d.study.search import chance_figure
from hydro2d.study.search.regimes import Transitions

#: patterns of the names of pictures and films, to remove those of earlier reports and versions
NAMES = re.compile(r"(rods|transition|sample|film|depth|histories)_[\w+-]+\.(png|gif|mp4)")
#: largest number of pages of rods; the caption says how many runs are left out
MOST_PAGES = 8
#: dots per inch of films, fewer than in those of `hydro2d movie`
FILM_DPI = 80
KINDS = {".png": "image/png", ".gif": "image/gif", ".mp4": "video/mp4"}


@dataclass(frozen=True)
class Picture:
    """A picture or a film: file, heading, caption, and a text for readers who cannot see it."""

    file: Path
    heading: str
    caption: str
    alt: str

    @property
    def data(self) -> str:
        """The file as a data URL, which needs no network."""
        return f"data:{KINDS[self.file.suffix]};base64," + base64.b64encode(self.file.read_bytes()).decode()

    @property
    def plays(self) -> bool:
        """Whether it is a film that needs a player."""
        return self.file.suffix == ".mp4"


def draw(contents: Contents, folder: Path) -> Iterator[Picture]:
    """Pages of rods, all at one scale."""
    with_rod, others = _first_members(contents)
    shown = rods.pages(with_rod)[:MOST_PAGES]
    scale = [each for part in shown for each in part]
    whole = [record for each in scale for record in (each, *others.get(each.case.name, ()))]
    at_depth = bool(scale) and rods.at_their_depths(whole, contents.belonging)
    where = "at their depths below the target's original surface" if at_depth else "tip beside tip"
    measured = at_depth and any(each.case.name in contents.belonging for each in scale)
    left_out = f" {len(with_rod) - len(scale)} further runs are not drawn." if len(with_rod) > len(scale) else ""
    word = "Rods" if all(each.setup.is_rod for each in scale) else "Projectiles"
    for number, part in enumerate(shown, 1):
        file = folder / f"rods_{number:02d}.png"
        figures.save_figure(rods.draw(part, contents.belonging, whole, others), file)
        caption = (
            f"{word} at the end of their runs, {where}, at one scale; dotted: before impact, the tip at the same place"
            + ("; dashed: the experiment's depth" if measured else "")
            + ("; thin: the other members of the ensemble." if others else ".")
            + (f" Page {number} of {len(shown)}.{left_out}" if len(shown) > 1 else "")
        )
        alt = "Final shapes: " + "; ".join(map(_shape_in_words, part)) + "."
        yield Picture(file, f"{word} {number} of {len(shown)}" if len(shown) > 1 else word, caption, alt)


def _first_members(contents: Contents) -> tuple[list[Record], dict[str, list[Record]]]:
    """The first member with an outline of each ensemble, and the others by the name of the first."""
    groups = [[record for record in each.members if record.rod] for each in contents.ensembles]
    groups = [group for group in groups if group]
    return [group[0] for group in groups], {group[0].case.name: group[1:] for group in groups if group[1:]}


def _shape_in_words(each: Record) -> str:
    length, first = each.value("rod_length_m"), each.value("rod_initial_length_m")
    return f"{each.case.name}, {length / first * 100:.0f} % of its length" if length and first else each.case.name


def is_drawn(combination: Transitions) -> bool:
    """Whether a combination of a search has a picture: the search has a budget, and some shot has an outcome."""
    return combination.estimate is not None and len(combination.estimate.known) > 0


def fitted(contents: Contents, folder: Path) -> Iterator[Picture]:
    """For each combination of a search with a budget, its shots with the fitted curve and its band; v50 in the caption."""
    for number, each in enumerate(contents.transitions, 1):
        if not is_drawn(each):
            continue
        file = folder / f"transition_{number:02d}.png"
        figures.save_figure(chance_figure.draw([each]), file)
        estimate, fast = each.estimate, each.estimate.outcomes[1]
        drawn = "Dots: shots"
        if estimate.limit:
            drawn += ("; left: residual velocities, the fitted curve and the 90 % interval of the ballistic limit; "
                      "right: outcomes")
        if estimate.fit:
            drawn += f"; line: fitted probability of \"{fast}\" with its 90 % band; bar at one half: 90 % interval of v50"
        said = "; ".join(estimate.notes)
        yield Picture(file, f"{each.title}: {estimate.name}", f"{drawn}. {said[0].upper()}{said[1:]}.",
                      f"Outcome of {len(estimate.known)} shots against impact velocity. {said}.")


def check_field(field: str) -> None:
    """Refuses an unknown field before anything is drawn. Raises FigureError."""
    key = field.partition(":")[0]
    if key not in quantities.BY_KEY:
        raise FigureError(f"--movie: {unknown('field', key, quantities.BY_KEY)}")


def films(contents: Contents, field: str, folder: Path, say: Callable[[str], None]) -> Iterator[Picture]:
    """A small film of a field for every run with dumps: MP4 if ffmpeg is installed, else GIF.

    Runs without dumps, and those whose dumps cannot be read, are reported to `say`; cases that have not begun are not. Raises
    FigureError if no film can be made.
    """
    ending, made, problem = ".mp4" if movies.has_ffmpeg() else ".gif", 0, None
    for number, each in enumerate(contents.records, 1):
        if each.case.status in (WAITING, INVALID):
            continue
        try:
            run = reading.Results(each.case.directory)
            if not run.dumps:
                raise FigureError("no dump was written")
            file = folder / f"film_{number:03d}{ending}"
            frames = movies.film([run], file, field, dpi=FILM_DPI)
        except (reading.ResultsError, FigureError, VtkError) as error:
            problem = error
            say(f"warning: {each.case.name} has no film: {error}")
            continue
        made += 1
        caption = f"{field} of {each.case.name}, {frames} dumps."
        yield Picture(file, f"Film: {each.case.name}", caption, f"Film of {field} in section, {frames} frames.")
    if not made:
        raise FigureError(f"--movie {field}: no film could be made: {problem or 'there are no runs'}")
