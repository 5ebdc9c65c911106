"""The rows of a sample in the plan of a study: its points, checked against the axes, the ensemble and the decks."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.deck import key_messages
from hydro2d.files import toml
from hydro2d.study.plan import members, relating, sampling
from hydro2d.study.plan.distributions import Distribution, label
from hydro2d.study.plan.planned import Option, Planned
from hydro2d.study.plan.study_file import StudyFile, keys_of, place_of, share

_NUMBER = re.compile(r"[-+]?\d[\d.]*(e[-+]?\d+)?")


class SampleRows:
    """The rows of the sample of a study.

    study : the study file, which has a sample, and to which mistakes are added
    points : its points, once they are read
    """

    points: sampling.Points

    def __init__(self, study: StudyFile):
        self.study, self.given = study, study.definition.sample

    @property
    def file(self) -> Path:
        """The table of the points."""
        return self.study.folder / self.given.table

    def read(self) -> sampling.Points:
        """Reads or makes the points. Raises StudyError with all mistakes of the study so far."""
        given, inputs = self.given, []
        for key, entry in given.input.items():
            try:
                inputs.append(Distribution.of_input(key, entry))
            except ValueError as error:
                self.study.say(self.place_of(key), f"{_spelled_input(key)}: {error}")
        inputs += sampling.together(given)
        self._distinct_inputs([*given.input, *itertools.chain(*(each.keys for each in given.joint))])
        self.study.refuse()
        self.points = sampling.points(given, inputs, self.study.folder)
        if given.table is not None:
            self._distinct_inputs([each.key for each in self.points.inputs])
        self.study.refuse()
        return self.points

    def place_of(self, key: str) -> tuple:
        """Place of an input of the sample in the study file; that of the table for one of its columns."""
        if self.given.table is not None:
            return ("sample", "table")
        if (joint := next((number for number, each in enumerate(self.given.joint) if key in each.keys), None)) is not None:
            return ("sample", "joint", joint, "keys")
        return place_of(("sample", "input"), key, self.study.data.get("sample", {}).get("input", {}))

    def _distinct_inputs(self, keys: Iterable[str]) -> None:
        """Checks that each uncertain key is set by nothing else: by another one, an axis, or the members of an ensemble."""
        others: dict[tuple, str] = {}
        for number, axis in enumerate(self.study.definition.axis):
            if axis.name == sampling.AXIS:
                reserved = f'"{sampling.AXIS}" is the name of the axis that [sample] adds'
                self.study.say(("axis", number), f"axis[{number}].name: {reserved}")
            others |= {tuple(toml.key_parts(key)): f'the axis "{axis.name}"' for key in keys_of(axis)}
        for key in keys:
            parts = tuple(toml.key_parts(key))
            for other, owner in others.items():
                if share(parts, other):
                    shared = ".".join(min(parts, other, key=len))
                    self.study.say(self.place_of(key), f"sample: {key}: {owner} sets {shared} as well")
            others[parts] = f"the sample ({key})"
            if clash := members.conflict(self.study.changes, [key]):
                also = f'{self.study.changer} changes {clash[1]} by "{clash[0]}"; leave out one'
                self.study.say(self.place_of(key), f"sample: {key}: {also}")

    def at_points(self, combinations: list[tuple], bare: list[tuple], files: dict[str, Path]) -> list[tuple]:
        """Every combination at every point; ``bare`` are the cases of the combinations. Raises StudyError."""
        at_points = []
        for combination, (_, base, overrides) in zip(combinations, bare, strict=True):
            try:
                tables = self._written(files[base], overrides) if self.points.relative else {}
                settings = [self.points.settings(number, tables) for number in range(len(self.points.rows))]
            except (DeckError, ValueError) as error:
                self.study.say(("sample", "input"), f"sample.input: {base}: {error}")
                continue
            rows = [Option(str(row), sampling.NAME.format(row), own) for row, own in enumerate(settings, 1)]
            at_points += [(*combination, row) for row in rows]
        self.study.refuse()
        return at_points

    def _written(self, file: Path, overrides: list[str]) -> Mapping[str, Any]:
        """The tables of a deck with every value to which an input relates."""
        return relating.completed(decks.written(file, overrides), self.points.inputs, lambda: decks.load(file, overrides))

    def check(self, planned: list[list[Planned]]) -> None:
        """Finds rows that make a deck invalid: each mistake is said once, by its first row, whatever its numbers.

        planned : the members of each case
        """
        said: dict[tuple, dict[int, str]] = {}
        for case in (group[0] for group in planned if group and not group[0].text):
            row = int(case.values[sampling.AXIS])
            for line in case.message.splitlines():
                of, message = self._in_words(row, line, case.overrides)
                said.setdefault((of, _NUMBER.sub("", line)), {}).setdefault(row, message)
        for rows in said.values():
            first, *others = rows.values()
            self.study.wrong.append(first + _alike(len(others)))

    def _in_words(self, row: int, line: str, overrides: list[str]) -> tuple[str, str]:
        """The input that a message of a deck is about, or "", and the message: file, row and column, then what is wrong."""
        settings = dict(map(toml.assignment, overrides))
        said = {f"--set {toml.assigned(each.key, settings[each.key])}: ": each for each in self.points.inputs}
        start, of = next(((start, each) for start, each in said.items() if line.startswith(start)), ("", None))
        wrong, key = line.removeprefix(start), of.key if of else ""
        if self.given.table:
            return key, f"{sampling.place(self.file, row, of.head)}: {wrong}" if of else f"{self.file}: row {row}: {wrong}"
        if of is None:
            return key, f"{self.study.where(('sample',))}: sample: row {row}: {wrong}"
        where = self.study.where(self.place_of(key))
        name = f"sample.joint: {key}" if of.joint else _spelled_input(key)
        return key, f"{where}: {name}: row {row} has {label(settings[key])}: {wrong}"

    def known_keys(self, tables: list[dict]) -> None:
        """Finds inputs whose keys no deck has; ``tables`` are those of the decks."""
        for each in self.points.inputs:
            if problem := key_messages.no_such_key(tables, each.key):
                if self.given.table:
                    self.study.wrong.append(f'{self.file}: column "{each.head}": {problem}')
                else:
                    self.study.say(self.place_of(each.key), problem)


def _alike(others: int) -> str:
    """The end of a message about a row, if others have the same mistake."""
    return f"; {others} more {'row is' if others == 1 else 'rows are'} wrong in the same way" if others else ""


def _spelled_input(key: str) -> str:
    """An input of a sample in messages."""
    return f'sample.input."{key}"'
