"""The series of runs in a figure. Colour and marker each distinguish them, so either is sufficient."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from hydro2d.study.records.differences import compare
from hydro2d.study.records.record import Record
from hydro2d.study.records.responses import Choice, Variable, is_velocity
from hydro2d.study.records.study_directory import Axis

#: colours that colour-blind readers can distinguish (after Okabe and Ito) on light and dark; markers and dashes for print
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#b0538a", "#7d7d7d", "#b8860b")
MARKERS = ("circle", "square", "triangle-up", "diamond", "triangle-down", "cross", "pentagon", "x", "star", "hexagram")
DASHES = ("solid", "dash", "dot", "dashdot")
#: sections of a deck that change neither physics nor numerics
ASIDE = ("title", "output", "experiment", "tracer", "gauge", "stop", "penetration")
#: largest number of keys in the name of a series of runs
MOST_KEYS = 3


@dataclass(frozen=True)
class Style:
    """The style of a series of runs."""

    colour: str
    marker: str
    dash: str


@dataclass(frozen=True)
class Series:
    """Runs that differ only in the quantity on the x axis, unless other series were requested."""

    label: str
    style: Style
    records: tuple[Record, ...]

    @property
    def repeated(self) -> bool:
        """Whether its runs are members of ensembles."""
        return any(record.case.member for record in self.records)


def style(number: int) -> Style:
    """The style of the n-th series: the first thirty all differ, and neighbours also differ in black and white."""
    return Style(COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)], DASHES[number % len(DASHES)])


def grouped(records: Sequence[Record], axes: Sequence[Axis], choice: Choice) -> list[Series]:
    """The series of runs of one panel, in the order of the study."""
    if choice.by is not None:
        labels = [", ".join(_said(variable, record) for variable in choice.by) for record in records]
    elif axes:
        kept = [axis for axis in axes if _tells_apart(axis, records, choice.x)]
        labels = [", ".join(axis.said(record.case.values.get(axis.name, "")) for axis in kept) for record in records]
    else:
        labels = _labels_from_decks(records)
    groups: dict[str, list[Record]] = {}
    for label, record in zip(labels, records, strict=True):
        groups.setdefault(label, []).append(record)
    return [Series(label or "hydro2d", style(n), tuple(each)) for n, (label, each) in enumerate(groups.items())]


def _said(variable: Variable, record: Record) -> str:
    """The value of a variable for a run, in words that can be read alone."""
    value = variable.value(record)
    if value is None:
        return f"no {variable.name}"
    return value if isinstance(value, str) else f"{variable.title.split(' [')[0].removesuffix(' (SI)')} {value:g}"


def _tells_apart(axis: Axis, records: Sequence[Record], x: Variable) -> bool:
    """Whether an axis adds to the x axis: it is not that axis, not constant, and not a variant for each of its values."""
    if axis.name == x.name or (x.impact and is_velocity(axis)) or axis.is_of_points:
        return False
    pairs = {(x.value(record), record.case.values.get(axis.name)) for record in records}
    values, labels = ({pair[side] for pair in pairs} for side in (0, 1))
    return len(labels) > 1 and not (axis.key is None and len(pairs) == len(values) == len(labels))


def _labels_from_decks(records: Sequence[Record]) -> list[str]:
    """The keys in which the decks of a setup differ, with their values; the name of the run if there are many.

    The members of an ensemble have the label of the first of them, since their differences do not matter.
    """
    decks: dict[str, dict] = {}
    for record in records:
        decks.setdefault(record.case.group, record.deck)
    varying = compare(decks).varying
    keys = [key for key in varying if key.split(".")[0] not in ASIDE and not key.endswith(".velocity")]
    if len({key.rsplit(".", 1)[-1] for key in keys}) > MOST_KEYS:
        return [record.case.group for record in records]
    return [", ".join(dict.fromkeys(_words(key, varying[key], record.case.group) for key in keys)) for record in records]


def _words(key: str, values: dict[str, tuple[str, ...]], name: str) -> str:
    value = next((value for value, names in values.items() if name in names), "not set")
    return f"{key.rsplit('.', 1)[-1].replace('_', ' ')} {value}"
