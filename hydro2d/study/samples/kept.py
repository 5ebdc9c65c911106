"""The samples of a study from the rows that it keeps in the folder of its file, without the directories of its runs."""

from __future__ import annotations

from pathlib import Path

from hydro2d.deck import deck as decks
from hydro2d.files.csv_tables import Column, number, whole
from hydro2d.study.plan import sampling
from hydro2d.study.plan.definition import StudyError, read
from hydro2d.study.plan.distributions import Distribution
from hydro2d.study.plan.sample_section import Sample
from hydro2d.study.records import keeping, sample_table
from hydro2d.study.records.keeping import CELLS, MEMBER
from hydro2d.study.samples.results import Samples


def kept_samples(study: str | Path) -> list[Samples]:
    """The samples of a study with ``[sample]`` and ``keep``, from its kept rows: one for each case and number of cells.

    study : the study file, or the path of a shipped one below ``problems``

    ``labels`` of each has the labels on the axes, and ``cells_across``. Rows of other versions of the method and of older
    set-ups are among them: ``columns["method"]`` tells the version of each. Raises StudyError if the study has no sample, keeps
    no rows, or if its rows lack the inputs; DeckError if there is no such file.
    """
    study = decks.find(study)
    definition = read(study, ())[0]
    if definition.sample is None or definition.keep is None:
        raise StudyError(f"{study}: has no {'[sample]' if definition.sample is None else 'keep'}")
    inputs = _inputs(definition.sample, study.parent)
    axes = tuple(axis.name for axis in definition.axis)
    file = study.parent / definition.keep
    more = (Column(name, number, required=False) for name in definition.sample.results)
    columns = (*(Column(name, empty=False) for name in axes), Column(sampling.AXIS, whole, empty=False),
               *map(keeping.input_column, inputs), *more)
    rows = keeping.read(file, columns, (*axes, sampling.AXIS))
    if not rows:
        raise StudyError(f"{file}: has no rows yet")
    groups: dict[tuple[str, ...], list[keeping.Row]] = {}
    for row in sorted(rows, key=lambda row: (int(row[sampling.AXIS]), int(row[MEMBER]))):
        groups.setdefault(tuple(row[name] for name in (*axes, CELLS)), []).append(row)
    return [_samples(definition.title, inputs, dict(zip((*axes, CELLS), labels, strict=True)), members,
                     definition.sample.results) for labels, members in groups.items()]


def _inputs(sample: Sample, folder: Path) -> tuple[Distribution, ...]:
    if sample.table is not None:
        return sampling.read(folder / sample.table).inputs
    try:
        return (*(Distribution.of_input(key, given) for key, given in sample.input.items()), *sampling.together(sample))
    except ValueError as error:
        raise StudyError(f"sample.input: {error}") from None


def _samples(title: str, inputs: tuple[Distribution, ...], labels: dict[str, str], rows: list[keeping.Row],
             wanted: tuple[str, ...]) -> Samples:
    own = (sampling.AXIS, MEMBER, *(each.head for each in inputs), keeping.OF_METHOD)
    table = sample_table.values([{name: row[name] for name in own} | sample_table.of_kept(row, wanted) for row in rows], inputs)
    words = [f"{name} {label}" for name, label in labels.items() if label]
    return Samples(", ".join([title, *words]), inputs, table, wanted=wanted, labels=labels)
