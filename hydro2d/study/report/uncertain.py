"""The section of a report on a sample of uncertain inputs: spreads, fractions, Sobol indices, scatter plots and tornadoes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from hydro2d.base.formats import distinct, file_name
from hydro2d.files.strange import own
from hydro2d.results import figures
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.records import sample_table
from hydro2d.study.records.responses import title
from hydro2d.study.records.study_directory import Study
from hydro2d.study.report.pictures import Picture
from hydro2d.study.samples import results, text
from hydro2d.study.samples.results import Samples


@dataclass(frozen=True)
class Table:
    """A table of the page: caption, heads and rows."""

    caption: str
    heads: tuple[str, ...]
    rows: list[tuple[str, ...]]


@dataclass
class Part:
    """The sample of one combination of the axes: heading, tables, notes and pictures."""

    heading: str
    tables: list[Table] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    pictures: list[Picture] = field(default_factory=list)


def parts(study: Study, folder: Path) -> list[Part]:
    """The parts of the section, with their pictures in a folder; none for a study without a sample, or before its first run.

    Raises OSError, FigureError, StudyError for a damaged table.
    """
    if study.sample is None or not own(study.directory / sample_table.FILE).is_file():
        return []
    return [_part(number, samples, folder) for number, samples in enumerate(results.of_study(study), 1)]


def _part(number: int, samples: Samples, folder: Path) -> Part:
    heading = f"{samples.title}: {len(samples)} runs, {int(samples.ended.sum())} done"
    part = Part(heading, [Table("Inputs", ("Input", "Distribution"), [(each.head, each.words) for each in samples.inputs])],
                [f"{message}." for message in (*samples.missed, *samples.doubts)])
    for caption, (heads, rows) in (("Results", text.spreads(samples)), ("Outcomes", text.fractions(samples))):
        if rows:
            part.tables.append(Table(caption, _capital(heads), rows))
    for result, name in zip(samples.usual, file_names(samples.usual), strict=True):
        part.pictures += _pictures(samples, result, folder / f"sample_{number:02d}_{name}", part)
    return part


def file_names(results: Sequence[str]) -> list[str]:
    """Names of results as parts of the names of files: without dots, and none twice ("derived.P/L")."""
    return distinct(file_name(result.replace(".", "_"), 80) for result in results)


def _pictures(samples: Samples, result: str, stem: Path, part: Part) -> Iterator[Picture]:
    """Scatter plots of a result; its indices and its tornado where its surrogate is good enough."""
    word, inputs = title(result), ", ".join(samples.heads)
    file = stem.with_name(f"{stem.name}_inputs.png")
    figures.save_figure(samples.scatter(result), file)
    yield Picture(file, f"{word[0].upper()}{word[1:]} against each input", "Dots: rows of the sample. Lines: the surrogate, "
                  "the other inputs at their medians.", f"{word} against {inputs}.")
    try:
        (heads, rows), words = text.indices(samples, result)
    except StudyError as error:
        part.notes.append(f"{error}.")
        return
    part.tables.append(Table(f"Sobol indices of {words}", _capital(heads), rows))
    file = stem.with_name(f"{stem.name}_tornado.png")
    figures.save_figure(samples.tornado(result), file)
    said = "; ".join(f"{each.input} {each.low:.4g} to {each.high:.4g}" for each in samples.effects(result))
    yield Picture(file, f"Effects on {word}", "Change from 10 to 90 % of the values of each input, the others at their "
                  "medians, by the surrogate; the ends bear the values of the input.", f"In SI units: {said}.")


def _capital(heads: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(head[0].upper() + head[1:] for head in heads)
