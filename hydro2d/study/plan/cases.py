"""The cases of a study: all combinations of its axes without the exclusions, each with its resolved deck.

A search for a transition has one further axis, the last: all velocities that it may try. So has a sample: its rows.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from hydro2d.base.errors import DeckError, unknown
from hydro2d.deck import deck as decks
from hydro2d.deck import key_messages
from hydro2d.files import toml
from hydro2d.files.key_lines import Sources
from hydro2d.output.directory import deck_hash
from hydro2d.running.progress import counted
from hydro2d.study.plan import members, ranges, relating, sampling, velocities
from hydro2d.study.plan.definition import DECK, Axis, Definition, Ensemble, Overrides, StudyError, of_tables, read
from hydro2d.study.plan.distributions import Distribution
from hydro2d.study.plan.scaling import AS_IT_IS, Size

#: longest part of the name of a case that comes from one axis
LONGEST = 40
_NUMBER = re.compile(r"[-+]?\d[\d.]*(e[-+]?\d+)?")


@dataclass(frozen=True)
class Option:
    """One value or variant of an axis: its label, its part of the name of a case, and the keys that it sets.

    A key whose value is None is removed.
    """

    label: str
    short: str
    settings: dict[str, Any]


@dataclass(frozen=True)
class Planned:
    """A case before it runs. `text` is its resolved deck, or empty if the deck is wrong, and `message` then says why.

    of, member, changed : in an ensemble the case that it repeats, its number, and the changes, by name
    """

    name: str
    values: dict[str, str]
    deck: str
    overrides: list[str]
    text: str
    message: str
    of: str = ""
    member: int = 0
    changed: dict[str, float] = field(default_factory=dict)

    @property
    def sha256(self) -> str | None:
        return deck_hash(self.text) if self.text else None


@dataclass(frozen=True)
class Plan:
    """A study before it runs, with the decks of all cases resolved. ``again`` is the option that continues it.

    sample : the points of a sample, whose rows are the last axis
    """

    name: str
    title: str
    out: Path
    text: str
    axes: list[dict]
    cases: list[Planned]
    search: velocities.Velocities | None = None
    ensemble: Ensemble | None = None
    again: str = "--resume"
    keep: Path | None = None
    sample: sampling.Points | None = None

    @property
    def notes(self) -> tuple[str, ...]:
        """Remarks for the user, before the runs."""
        return self.sample.notes if self.sample else ()


def plan(path: Path, overrides: Overrides | None = None, *, search: bool | None = None, quiet: bool = False,
         size: Size = AS_IT_IS) -> Plan:  # fmt: skip
    """Reads a study file and resolves all decks.

    search : whether the study must be a search; None: it may be either
    quiet : prints nothing while the decks of many cases are read
    size : members and cells that replace those of the file

    Raises StudyError for mistakes in the study itself.
    """
    path = Path(path)
    return _Planner(path, *read(path, overrides or []), size).plan(search, quiet)


def plan_of(tables: dict, name: str, overrides: Overrides = ()) -> Plan:
    """A sweep from nested dicts and lists, as a study file would give them, with all decks resolved. Raises StudyError."""
    return _Planner(Path(name), *of_tables(tables, name, overrides)).plan(False, True)


def _share(one: tuple[str, ...], other: tuple[str, ...]) -> bool:
    """Whether two keys are the same, or one is a part of the other."""
    return one[: len(other)] == other[: len(one)]


def _label(value) -> str:
    """A value as a study file has it."""
    return value if isinstance(value, str) else toml.inline(value)


class _Planner:
    """Assembles a plan; `wrong` collects the mistakes, one line each."""

    def __init__(self, path: Path, definition: Definition, text: str, data: dict, sources: Sources, size: Size = AS_IT_IS):
        self.path, self.definition, self.text, self.data, self.sources = path, definition, text, data, sources
        self.size, self.ensemble = size, size.ensemble(definition)
        self.wrong: list[str] = []

    def plan(self, search: bool | None, quiet: bool) -> Plan:
        self._of_the_kind(search)
        axes = [self._choices(n, axis) for n, axis in enumerate(self.definition.axis)]
        self._distinct_axes()
        self._free_of_axes(axes)
        speeds = self._labels()
        sample = self._points()
        self._raise()
        self._number([*axes, speeds or [""], sample.rows if sample else [""]])
        combinations = self._without_excluded(axes)
        self._raise()
        bare = [self._case(combination) for combination in combinations]
        files = self._files(bare)
        self._known_keys(files, sample)
        self._raise()
        described = [{"name": axis.name, "key": axis.key, "values": [choice.label for choice in choices]}
                     for axis, choices in zip(self.definition.axis, axes, strict=True)]  # fmt: skip
        interval = self._velocities(speeds, bare, files) if speeds else None
        if interval is not None:
            combinations = self._at_velocities(combinations, interval)
            described.append({"name": velocities.AXIS, "key": interval.key, "values": list(interval.labels)})
        if sample is not None:
            combinations = self._at_points(combinations, bare, files, sample)
            self._raise()
            described.append({"name": sampling.AXIS, "key": None, "values": [str(n) for n in range(1, len(sample.rows) + 1)]})
        names = distinct(["_".join(choice.short for choice in combination) for combination in combinations])
        planned = [self._repeated(name, *self._case(each), files)
                   for name, each in zip(names, counted(combinations, "decks read", quiet), strict=True)]
        self.wrong = list(dict.fromkeys(self.wrong))
        if sample is not None:
            self._check_rows(planned, sample)
        self._raise()
        cases = [case for group in planned for case in group]
        if interval is not None:
            self._check_impacts(cases, interval)
        return Plan(
            name=self.path.stem, title=self.definition.title, text=self.text,
            out=Path(self.definition.out or f"runs/{self.path.stem}"), axes=described, cases=cases, search=interval,
            ensemble=self.ensemble, keep=self.path.parent / keep if (keep := self.definition.keep) else None, sample=sample,
        )  # fmt: skip

    def _of_the_kind(self, search: bool | None) -> None:
        """Raises StudyError for a search instead of a sweep, a sweep instead of a search, or a study of parts."""
        if self.definition.part:
            self._say(("part",), f"part: the study is made of others; run it with `hydro2d sweep {self.path}`")
        if search is False and self.definition.transition is not None:
            command = f"run it with `hydro2d transition {self.path}`; `hydro2d sweep` only runs the cases of [[axis]]"
            self._say(("transition",), f"transition: the study is a search in velocity; {command}")
        if search is True and self.definition.transition is None:
            self._say((), 'transition: is missing: a table with the velocities to search, from = "900 m/s" and to = "1500 m/s"')
        self._raise()

    def _say(self, key: tuple, message: str) -> None:
        self.wrong.append(f"{self.sources.where(key, self.data)}: {message}")

    def _raise(self) -> None:
        if self.wrong:
            raise StudyError("\n".join(self.wrong))

    # ------------------------------------------------------------------------------------------------ axes

    def _choices(self, number: int, axis: Axis) -> list[Option]:
        if axis.variants is not None:
            return [Option(name, short(name), settings) for name, settings in axis.variants.items()]
        values = axis.values
        if axis.range is not None:
            try:
                values = ranges.values(axis.range)
            except ValueError as error:
                self._say(("axis", number, "range"), f"axis[{number}].range: {error}")
                return []
        labels = [_label(value) for value in values]
        for twice in sorted({label for label in labels if labels.count(label) > 1}):
            self._say(("axis", number, "values"), f'axis "{axis.name}" contains the value {twice} twice')
        shorts = distinct([short(label) for label in labels])
        return [Option(label, slug, {axis.key: value}) for label, slug, value in zip(labels, shorts, values, strict=True)]

    def _distinct_axes(self) -> None:
        """Checks that no two axes have the same name, or set the same key or a part of it."""
        names = [axis.name for axis in self.definition.axis]
        keys: dict[tuple, str] = {}
        for number, axis in enumerate(self.definition.axis):
            if axis.name in names[:number]:
                self._say(("axis", number), f'axis[{number}].name: there is already an axis "{axis.name}"')
            own = {axis.key} if axis.key else {key for settings in axis.variants.values() for key in settings}
            for key in sorted(own):
                parts = tuple(toml.key_parts(key))
                for other, owner in keys.items():
                    if owner != axis.name and _share(parts, other):
                        shared = ".".join(min(other, parts, key=len))
                        self._say(("axis", number), f'axes "{owner}" and "{axis.name}" both set {shared}')
                keys[parts] = axis.name

    def _number(self, axes: list[list[Option]]) -> None:
        ensemble = self.ensemble
        count, of = math.prod(len(choices) for choices in axes), "the axes make"
        if self.definition.sample:
            of = "the axes and the sample make"
        if ensemble:
            count, of = count * ensemble.repeats, f"{of.removesuffix(' make')} and {ensemble.repeats} repeats make"
        if count > ranges.MOST:
            raise StudyError(f"{self.path}: {of} {count} cases; at most {ranges.MOST} are allowed")

    @property
    def _changes(self) -> tuple[str, ...]:
        """The changes that should not matter, of an ensemble or of the rows of a sample."""
        changing = self.ensemble or self.definition.sample
        return (changing and changing.by) or ()

    @property
    def _changer(self) -> str:
        return "the ensemble" if self.ensemble else "sample.by"

    def _free_of_axes(self, axes: list[list[Option]]) -> None:
        """Checks that no axis sets a key that the members of an ensemble change."""
        for number, (axis, choices) in enumerate(zip(self.definition.axis, axes, strict=True)):
            for choice in choices:
                clash = members.conflict(self._changes, choice.settings)
                if clash:
                    self._say(("axis", number), f'axis "{axis.name}" sets {clash[1]}, and {self._changer} changes it by '
                                                f'"{clash[0]}"; leave out one of them')  # fmt: skip
                    break

    # ------------------------------------------------------------------------------------------------ velocities of a search

    def _labels(self) -> list[str]:
        """Velocities of a search, the slowest first; empty for a sweep."""
        if self.definition.transition is None:
            return []
        for number, axis in enumerate(self.definition.axis):
            if axis.name == velocities.AXIS:
                self._say(("axis", number), (f'axis[{number}].name: "{velocities.AXIS}" '
                                             "is the name of the axis that [transition] adds"))
        try:
            return list(velocities.labels(self.definition.transition))
        except ValueError as error:
            self._say(("transition",), f"transition: {error}")
            return []

    def _velocities(self, labels: list[str], cases: list[tuple], files: dict[str, Path]) -> velocities.Velocities:
        """The velocities and their key, which no axis may set."""
        key = self.definition.transition.key
        try:
            key = key or velocities.key((files[base], overrides) for _, base, overrides in cases)
        except ValueError as error:
            self._say(("transition",), f"transition: {error}")
        self._raise()
        parts = tuple(toml.key_parts(key))
        for number, axis in enumerate(self.definition.axis):
            for own in {axis.key} if axis.key else {name for settings in axis.variants.values() for name in settings}:
                if _share(parts, tuple(toml.key_parts(own))):
                    self._say(("axis", number), f'axis "{axis.name}" sets {own}, and the search varies {key}')
        self._raise()
        given = self.definition.transition
        return velocities.Velocities.of_study(key, given, tuple(labels))

    def _at_velocities(self, combinations: list[tuple], interval: velocities.Velocities) -> list[tuple]:
        """Every combination at every velocity."""
        choices = [Option(label, short(label), {interval.key: label}) for label in interval.labels]
        return [(*combination, choice) for combination in combinations for choice in choices]

    # ------------------------------------------------------------------------------------------------ rows of a sample

    def _points(self) -> sampling.Points | None:
        """The points of the sample; None without one, or if its section or its table is wrong, which `wrong` then says."""
        given, inputs = self.definition.sample, []
        if given is None:
            return None
        for key, entry in given.input.items():
            try:
                inputs.append(Distribution.of_input(key, entry))
            except ValueError as error:
                self._say(self._place_of(key), f"{_spelled_input(key)}: {error}")
        self._distinct_inputs(given.input)
        if self.wrong:
            return None
        try:
            sample = sampling.points(given, inputs, self.path.parent)
        except StudyError as error:
            self.wrong.append(str(error))
            return None
        if given.table is not None:
            self._distinct_inputs([each.key for each in sample.inputs])
        return sample

    def _place_of(self, key: str) -> tuple:
        """Place of an input of the sample in the study file; that of the table for one of its columns."""
        if self.definition.sample.table is not None:
            return ("sample", "table")
        return _place(("sample", "input"), key, self.data.get("sample", {}).get("input", {}))

    def _distinct_inputs(self, keys: Iterable[str]) -> None:
        """Checks that each uncertain key is set by nothing else: by another one, an axis, or the members of an ensemble."""
        others: dict[tuple, str] = {}
        for number, axis in enumerate(self.definition.axis):
            if axis.name == sampling.AXIS:
                self._say(("axis", number), (f'axis[{number}].name: "{sampling.AXIS}" '
                                             "is the name of the axis that [sample] adds"))
            own = {axis.key} if axis.key else {key for settings in axis.variants.values() for key in settings}
            others |= {tuple(toml.key_parts(key)): f'the axis "{axis.name}"' for key in own}
        for key in keys:
            parts = tuple(toml.key_parts(key))
            for other, owner in others.items():
                if _share(parts, other):
                    shared = ".".join(min(parts, other, key=len))
                    self._say(self._place_of(key), f"sample: {key}: {owner} sets {shared} as well")
            others[parts] = f"the sample ({key})"
            if clash := members.conflict(self._changes, [key]):
                self._say(self._place_of(key), (f'sample: {key}: {self._changer} changes {clash[1]} by "{clash[0]}"; '
                                                "leave out one"))

    def _at_points(self, combinations: list[tuple], bare: list[tuple], files: dict[str, Path],
                   sample: sampling.Points) -> list[tuple]:  # fmt: skip
        """Every combination at every point; `bare` are the cases of the combinations."""
        at_points = []
        for combination, (_, base, overrides) in zip(combinations, bare, strict=True):
            try:
                tables = self._written(files[base], overrides, sample) if sample.relative else {}
                settings = [sample.settings(number, tables) for number in range(len(sample.rows))]
            except (DeckError, ValueError) as error:
                self._say(("sample", "input"), f"sample.input: {base}: {error}")
                continue
            rows = [Option(str(row), sampling.NAME.format(row), own) for row, own in enumerate(settings, 1)]
            at_points += [(*combination, row) for row in rows]
        return at_points

    @staticmethod
    def _written(file: Path, overrides: list[str], sample: sampling.Points) -> Mapping[str, Any]:
        """The tables of a deck with every value to which an input of the sample relates."""
        return relating.completed(decks.written(file, overrides), sample.inputs, lambda: decks.load(file, overrides))

    def _check_rows(self, planned: list[list[Planned]], sample: sampling.Points) -> None:
        """Refuses a sample with rows that make a deck invalid: each mistake once, by its first row, whatever its numbers."""
        said: dict[tuple, dict[int, str]] = {}
        for case in (group[0] for group in planned if group and not group[0].text):
            row = int(case.values[sampling.AXIS])
            for line in case.message.splitlines():
                of, message = self._row_in_words(row, line, sample, case.overrides)
                said.setdefault((of, _NUMBER.sub("", line)), {}).setdefault(row, message)
        for rows in said.values():
            first, *others = rows.values()
            self.wrong.append(first + _alike(len(others)))

    def _row_in_words(self, row: int, line: str, sample: sampling.Points, overrides: list[str]) -> tuple[str, str]:
        """The input that a message of a deck is about, or "", and the message: file, row and column, then what is wrong."""
        settings = dict(map(toml.assignment, overrides))
        said = {f"--set {toml.assigned(each.key, settings[each.key])}: ": each for each in sample.inputs}
        start, of = next(((start, each) for start, each in said.items() if line.startswith(start)), ("", None))
        wrong, key = line.removeprefix(start), of.key if of else ""
        if sample.table:
            file = self.path.parent / self.definition.sample.table
            return key, f"{sampling.place(file, row, of.head)}: {wrong}" if of else f"{file}: row {row}: {wrong}"
        if of is None:
            return key, f"{self.sources.where(('sample',), self.data)}: sample: row {row}: {wrong}"
        where = self.sources.where(self._place_of(key), self.data)
        return key, f"{where}: {_spelled_input(key)}: row {row} has {settings[key]}: {wrong}"

    # ------------------------------------------------------------------------------------------------ the velocity of impact

    def _check_impacts(self, cases: list[Planned], interval: velocities.Velocities) -> None:
        """Raises StudyError if the velocity of the search is not the impact velocity."""
        for case in cases[:: len(interval.labels)]:
            fault = velocities.fault(decks.loads(case.text), interval.key, interval.labels[0]) if case.text else None
            if fault and not self.wrong:
                self._say(("transition", "key"), f"transition.key: {fault}")
        self._raise()

    # ------------------------------------------------------------------------------------------------ cases

    def _without_excluded(self, axes: list[list[Option]]) -> list[tuple[Option, ...]]:
        names = [axis.name for axis in self.definition.axis]
        rules = [self._rule(n, entry, dict(zip(names, axes, strict=True))) for n, entry in enumerate(self.definition.exclude)]
        kept = []
        for combination in itertools.product(*axes):
            labels = {name: choice.label for name, choice in zip(names, combination, strict=True)}
            if not any(rule and all(labels[name] in some for name, some in rule.items()) for rule in rules):
                kept.append(combination)
        if not (kept or self.wrong):
            raise StudyError(f"{self.path}: the exclusions leave no case")
        return kept

    def _rule(self, number: int, entry: dict, axes: dict[str, list[Option]]) -> dict[str, list[str]]:
        """The values of an exclusion by axis. Each must exist, so that the exclusion matches something."""
        if not entry:
            self._say(("exclude", number), f"exclude[{number}]: is empty, which would exclude every case")
        rule = {}
        for name, value in entry.items():
            if name not in axes:
                self._say(("exclude", number), f"exclude[{number}]: {unknown('axis', name, axes)}")
                continue
            labels = [choice.label for choice in axes[name]]
            several = isinstance(value, list) and toml.inline(value) not in labels
            rule[name] = [_label(each) for each in (value if several else [value])]
            for label in set(rule[name]) - set(labels):
                what = f"exclude[{number}].{name}: matches nothing; {unknown('value', label, labels)}"
                self._say(("exclude", number), what)
        return {} if self.wrong else rule

    def _case(self, combination: tuple[Option, ...]) -> tuple[dict[str, str], str, list[str]]:
        """Labels by axis, base deck, overrides of one combination."""
        settings = dict(self.definition.set)
        for choice in combination:
            settings |= choice.settings
        base = settings.pop(DECK, self.definition.deck)
        if not isinstance(base, str):
            raise StudyError(f"{self.path}: deck: " + ("is missing" if base is None else f"expected a file name, is {base!r}"))
        last = velocities.AXIS if self.definition.transition else sampling.AXIS
        names = [*(axis.name for axis in self.definition.axis), last]
        labels = {name: choice.label for name, choice in zip(names, combination, strict=False)}
        placed = {key: toml.placed_value(key, value, self.path.parent) for key, value in settings.items()}
        return labels, base, [toml.assigned(key, value) for key, value in placed.items()]

    def _files(self, cases: list[tuple]) -> dict[str, Path]:
        """The file of every base deck."""
        files = {}
        for base in dict.fromkeys(base for _, base, _ in cases):
            beside = self.path.parent / base
            try:
                files[base] = beside if beside.is_file() else decks.find(base)
            except DeckError as error:
                self._say((DECK,), str(error))
        return files

    def _known_keys(self, files: dict[str, Path], sample: sampling.Points | None) -> None:
        """Checks that at least one base deck has each key. A base deck without it makes its own cases invalid."""
        tables = []
        for file in files.values():
            try:
                tables.append(toml.read(file, Sources()))
            except DeckError as error:
                self.wrong.append(str(error))
        for place, key in self._keys():
            problems = [key_messages.key_problem(table, key) for table in tables]
            if problems and all(problems):
                self._say(place, f"no deck has the key {key}: {problems[0]}")
        for column in sample.inputs if sample and sample.table else ():
            problems = [key_messages.key_problem(table, column.key) for table in tables]
            if problems and all(problems):
                file = self.path.parent / self.definition.sample.table
                self.wrong.append(f'{file}: column "{column.head}": no deck has the key {column.key}: {problems[0]}')

    def _keys(self):
        """Every deck key of the study, and its place in the study file."""
        if self.definition.sample:
            yield from ((self._place_of(key), key) for key in self.definition.sample.input)
        if self.definition.transition and self.definition.transition.key:
            yield ("transition", "key"), self.definition.transition.key
        yield from ((_place(("set",), key, self.data.get("set", {})), key) for key in self.definition.set if key != DECK)
        for number, axis in enumerate(self.definition.axis):
            if axis.key:
                yield ("axis", number, "key"), axis.key
            for name, settings in (axis.variants or {}).items():
                table = self.data["axis"][number]["variants"][name]
                place = ("axis", number, "variants", name)
                yield from ((_place(place, key, table), key) for key in settings if key != DECK)

    def _repeated(self, name: str, labels: dict, base: str, overrides: list[str], files: dict[str, Path]) -> list[Planned]:
        """A case, or its members if there is an ensemble; of a wrong deck only the first, so that it is reported once."""
        deck, message = _read(files[base], overrides)
        if deck and self.size.cells:
            try:
                overrides = [*overrides, *self.size.overrides(deck)]
                deck, message = _read(files[base], overrides)
            except DeckError as error:
                deck, message = None, str(error)
        case = Planned(name, labels, base, overrides, deck.to_toml() if deck else "", message)
        ensemble = self.ensemble
        if ensemble is None:
            return [self._by_chance(case, deck, files[base])]
        group = [replace(case, name=members.name(name, number), of=name or self.path.stem, member=number,
                         changed=members.amounts(ensemble, number)) for number in range(ensemble.repeats)]  # fmt: skip
        if deck is None:
            return group[:1]
        try:
            return [group[0], *(_changed(each, deck, files[base]) for each in group[1:])]
        except DeckError as error:
            self._say(("ensemble", "by"), f"ensemble.by: {base}: {error}")
            return []

    def _by_chance(self, case: Planned, deck: decks.Deck | None, file: Path) -> Planned:
        """A case with the changes of its row, if the sample has any."""
        if deck is None or not self._changes:
            return case
        row = int(case.values[sampling.AXIS])
        try:
            return _changed(replace(case, changed=members.amounts_of_row(self.definition.sample, row)), deck, file)
        except DeckError as error:
            self._say(("sample", "by"), f"sample.by: {case.deck}: {error}")
            return case


def _read(file: Path, overrides: list[str]) -> tuple[decks.Deck | None, str]:
    """A deck, or None and the reason."""
    try:
        return decks.load(file, overrides), ""
    except DeckError as error:
        return None, str(error)


def _changed(case: Planned, deck: decks.Deck, file: Path) -> Planned:
    """A member with its own deck; ``deck`` is that of its case, which must allow the changes, else DeckError."""
    overrides = [*case.overrides, *members.overrides(deck, case.changed)]
    changed, message = _read(file, overrides)
    return replace(case, overrides=overrides, text=changed.to_toml() if changed else "", message=message)


def _alike(others: int) -> str:
    """The end of a message about a row, if others have the same mistake."""
    return f"; {others} more {'row is' if others == 1 else 'rows are'} wrong in the same way" if others else ""


def _spelled_input(key: str) -> str:
    """An input of a sample in messages."""
    return f'sample.input."{key}"'


def _place(table: tuple, key: str, given: dict) -> tuple:
    """Place of a deck key in the study file, where it is quoted or a table of tables."""
    return (*table, key) if key in given else (*table, *toml.key_parts(key))


def short(label: str) -> str:
    """A label as part of a directory name: "1086 m/s" is 1086m-s."""
    text = re.sub(r"[^A-Za-z0-9.+-]+", "-", label.replace(" ", "").replace("_", "-")).strip("-.")
    return text[:LONGEST] or "value"


def distinct(names: list[str]) -> list[str]:
    """The names, with -2, -3 and so on added to repeated ones."""
    unique: dict[str, None] = {}
    for name in names:
        number, given = 2, name
        while given in unique:
            given, number = f"{name}-{number}", number + 1
        unique[given] = None
    return list(unique)
