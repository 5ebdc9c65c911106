"""Which runs belong together in a figure, and how they are told apart: by colour and by marker, so that both alone do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from hydro2d.study.differences import compare
from hydro2d.study.layout import Axis
from hydro2d.study.record import Record

#: colours that colour-blind readers tell apart (Okabe and Ito), the darker ones; markers and dashes for print
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#a14d7f", "#3a3a3a", "#b8860b")
MARKERS = ("o", "s", "^", "D", "v", "P", "<", "X", ">", "h")
DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (6, 1.5, 1.5, 1.5)))
#: sections of a deck that make no other physics or numerics
ASIDE = ("title", "output", "experiment", "tracer", "gauge", "stop", "penetration")
#: the most keys that make a name for a series of runs
MOST_KEYS = 3


@dataclass(frozen=True)
class Style:
    """How a series of runs is drawn."""

    colour: str
    marker: str
    dash: str | tuple


@dataclass(frozen=True)
class Series:
    """Runs that differ in the impact velocity alone."""

    label: str
    style: Style
    records: tuple[Record, ...]


def style(number: int) -> Style:
    """The style of the n-th series: no two of the first thirty are the same, nor two neighbours in black and white."""
    return Style(COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)], DASHES[number % len(DASHES)])


def grouped(records: Sequence[Record], axes: Sequence[Axis]) -> list[Series]:
    """The series of runs of one setup, in the order of the study."""
    if axes:
        kept = [axis for axis in axes if _tells_apart(axis, records)]
        labels = [", ".join(axis.said(record.case.values.get(axis.name, "")) for axis in kept) for record in records]
    else:
        labels = _labels_from_decks(records)
    found: dict[str, list[Record]] = {}
    for label, record in zip(labels, records, strict=True):
        found.setdefault(label, []).append(record)
    return [Series(label or "hydro2d", style(n), tuple(each)) for n, (label, each) in enumerate(found.items())]


def is_velocity(axis: Axis) -> bool:
    """Whether an axis is the velocity of a body."""
    return axis.key is not None and axis.key.startswith("body.") and axis.key.endswith(".velocity")


def _tells_apart(axis: Axis, records: Sequence[Record]) -> bool:
    """Whether an axis says more than the velocity: not that itself, not constant, no variant for each velocity."""
    pairs = {(record.velocity, record.case.values.get(axis.name)) for record in records}
    velocities, labels = ({pair[side] for pair in pairs} for side in (0, 1))
    if is_velocity(axis) or len(labels) == 1:
        return False
    return not (axis.key is None and len(pairs) == len(velocities) == len(labels))


def _labels_from_decks(records: Sequence[Record]) -> list[str]:
    """The keys in which the decks of a setup differ, with their values; the run's name where these are many."""
    varying = compare({record.case.name: record.deck for record in records}).varying
    keys = [key for key in varying if key.split(".")[0] not in ASIDE and not key.endswith(".velocity")]
    if len({key.rsplit(".", 1)[-1] for key in keys}) > MOST_KEYS:
        return [record.case.name for record in records]
    return [", ".join(dict.fromkeys(_words(key, varying[key], record.case.name) for key in keys)) for record in records]


def _words(key: str, values: dict[str, tuple[str, ...]], name: str) -> str:
    value = next((value for value, names in values.items() if name in names), "not set")
    return f"{key.rsplit('.', 1)[-1].replace('_', ' ')} {value}"
