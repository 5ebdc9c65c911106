"""The cases of a study: all combinations of its axes without the exclusions, each with its resolved deck.

A search for a transition has one further axis, the last: all velocities that it may try. So has a sample: its rows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from hydro2d.base.errors import DeckError
from hydro2d.base.formats import distinct
from hydro2d.deck import deck as decks
from hydro2d.deck import key_messages
from hydro2d.files import toml
from hydro2d.files.key_lines import Sources
from hydro2d.running.progress import counted
from hydro2d.study.plan import exclusions, members, ranges, sampling, velocities
from hydro2d.study.plan.definition import DECK, Axis, Overrides, StudyError, of_tables, read
from hydro2d.study.plan.planned import Option, Plan, Planned, label, short
from hydro2d.study.plan.sample_rows import SampleRows
from hydro2d.study.plan.scaling import AS_IT_IS, Size
from hydro2d.study.plan.study_file import StudyFile, keys_of, place_of, share


def plan(path: Path, overrides: Overrides | None = None, *, search: bool | None = None, quiet: bool = False,
         size: Size = AS_IT_IS) -> Plan:
    """Reads a study file and resolves all decks.

    search : whether the study must be a search; None: it may be either
    quiet : prints nothing while the decks of many cases are read
    size : members and cells that replace those of the file

    Raises StudyError for mistakes in the study itself.
    """
    path = Path(path)
    return _Planner(StudyFile(path, *read(path, overrides or []), size)).plan(search, quiet)


def plan_of(tables: dict, name: str, overrides: Overrides = ()) -> Plan:
    """A sweep from nested dicts and lists, as a study file would give them, with all decks resolved. Raises StudyError."""
    return _Planner(StudyFile(Path(name), *of_tables(tables, name, overrides))).plan(False, True)


class _Planner:
    """Assembles the plan of a study file, to which mistakes are added until it is refused."""

    def __init__(self, study: StudyFile):
        self.study, self.definition = study, study.definition
        self.sample = SampleRows(study) if study.definition.sample else None

    def plan(self, search: bool | None, quiet: bool) -> Plan:
        study = self.study
        self._of_the_kind(search)
        axes = [self._choices(n, axis) for n, axis in enumerate(self.definition.axis)]
        self._distinct_axes()
        self._free_of_axes(axes)
        speeds = self._labels()
        sample = self.sample.read() if self.sample else None
        study.refuse()
        self._number([*axes, speeds or [""], sample.rows if sample else [""]])
        combinations = exclusions.combinations(study, axes)
        bare = [self._case(combination) for combination in combinations]
        files = self._files(bare)
        self._known_keys(files)
        study.refuse()
        described = [{"name": axis.name, "key": axis.key, "values": [choice.label for choice in choices]}
                     for axis, choices in zip(self.definition.axis, axes, strict=True)]
        interval = self._velocities(speeds, bare, files) if speeds else None
        if interval is not None:
            combinations = self._at_velocities(combinations, interval)
            described.append({"name": velocities.AXIS, "key": interval.key, "values": list(interval.labels)})
        if sample is not None:
            combinations = self.sample.at_points(combinations, bare, files)
            described.append({"name": sampling.AXIS, "key": None, "values": [str(n) for n in range(1, len(sample.rows) + 1)]})
        names = distinct(["_".join(choice.short for choice in combination) for combination in combinations])
        planned = [self._repeated(name, *self._case(each), files)
                   for name, each in zip(names, counted(combinations, "decks read", quiet), strict=True)]
        if sample is not None:
            self.sample.check(planned)
        study.refuse()
        cases = [case for group in planned for case in group]
        if interval is not None:
            self._check_impacts(cases, interval)
        return Plan(
            name=study.path.stem, title=self.definition.title, text=study.text,
            out=Path(self.definition.out or f"runs/{study.path.stem}"), axes=described, cases=cases, search=interval,
            ensemble=study.ensemble, keep=study.folder / keep if (keep := self.definition.keep) else None, sample=sample,
        )

    def _of_the_kind(self, search: bool | None) -> None:
        """Raises StudyError for a search instead of a sweep, a sweep instead of a search, or a study of parts."""
        if self.definition.part:
            self.study.say(("part",), f"part: the study is made of others; run it with `hydro2d sweep {self.study.path}`")
        if search is False and self.definition.transition is not None:
            command = f"run it with `hydro2d transition {self.study.path}`; `hydro2d sweep` only runs the cases of [[axis]]"
            self.study.say(("transition",), f"transition: the study is a search in velocity; {command}")
        if search is True and self.definition.transition is None:
            example = 'a table with the velocities to search, from = "900 m/s" and to = "1500 m/s"'
            self.study.say((), f"transition: is missing: {example}")
        self.study.refuse()

    # ------------------------------------------------------------------------------------------------ axes

    def _choices(self, number: int, axis: Axis) -> list[Option]:
        if axis.variants is not None:
            return [Option(name, short(name), settings) for name, settings in axis.variants.items()]
        values = axis.values
        if axis.range is not None:
            try:
                values = ranges.values(axis.range)
            except ValueError as error:
                self.study.say(("axis", number, "range"), f"axis[{number}].range: {error}")
                return []
        labels = [label(value) for value in values]
        for twice in sorted({each for each in labels if labels.count(each) > 1}):
            self.study.say(("axis", number, "values"), f'axis "{axis.name}" contains the value {twice} twice')
        shorts = distinct([short(each) for each in labels])
        return [Option(each, slug, {axis.key: value}) for each, slug, value in zip(labels, shorts, values, strict=True)]

    def _distinct_axes(self) -> None:
        """Checks that no two axes have the same name, or set the same key or a part of it."""
        names = [axis.name for axis in self.definition.axis]
        keys: dict[tuple, str] = {}
        for number, axis in enumerate(self.definition.axis):
            if axis.name in names[:number]:
                self.study.say(("axis", number), f'axis[{number}].name: there is already an axis "{axis.name}"')
            for key in sorted(keys_of(axis)):
                parts = tuple(toml.key_parts(key))
                for other, owner in keys.items():
                    if owner != axis.name and share(parts, other):
                        shared = ".".join(min(other, parts, key=len))
                        self.study.say(("axis", number), f'axes "{owner}" and "{axis.name}" both set {shared}')
                keys[parts] = axis.name

    def _number(self, axes: list[list[Option]]) -> None:
        ensemble = self.study.ensemble
        count, of = math.prod(len(choices) for choices in axes), "the axes make"
        if self.definition.sample:
            of = "the axes and the sample make"
        if ensemble:
            count, of = count * ensemble.repeats, f"{of.removesuffix(' make')} and {ensemble.repeats} repeats make"
        if count > ranges.MOST:
            raise StudyError(f"{self.study.path}: {of} {count} cases; at most {ranges.MOST} are allowed")

    def _free_of_axes(self, axes: list[list[Option]]) -> None:
        """Checks that no axis sets a key that the members of an ensemble change."""
        for number, (axis, choices) in enumerate(zip(self.definition.axis, axes, strict=True)):
            for choice in choices:
                clash = members.conflict(self.study.changes, choice.settings)
                if clash:
                    also = f'{self.study.changer} changes it by "{clash[0]}"; leave out one of them'
                    self.study.say(("axis", number), f'axis "{axis.name}" sets {clash[1]}, and {also}')
                    break

    # ------------------------------------------------------------------------------------------------ velocities of a search

    def _labels(self) -> list[str]:
        """Velocities of a search, the slowest first; empty for a sweep."""
        if self.definition.transition is None:
            return []
        for number, axis in enumerate(self.definition.axis):
            if axis.name == velocities.AXIS:
                reserved = f'"{velocities.AXIS}" is the name of the axis that [transition] adds'
                self.study.say(("axis", number), f"axis[{number}].name: {reserved}")
        try:
            return list(velocities.labels(self.definition.transition))
        except ValueError as error:
            self.study.say(("transition",), f"transition: {error}")
            return []

    def _velocities(self, labels: list[str], cases: list[tuple], files: dict[str, Path]) -> velocities.Velocities:
        """The velocities and their key, which no axis may set."""
        key = self.definition.transition.key
        try:
            key = key or velocities.key((files[base], overrides) for _, base, overrides in cases)
        except ValueError as error:
            self.study.say(("transition",), f"transition: {error}")
        self.study.refuse()
        parts = tuple(toml.key_parts(key))
        for number, axis in enumerate(self.definition.axis):
            for own in keys_of(axis):
                if share(parts, tuple(toml.key_parts(own))):
                    self.study.say(("axis", number), f'axis "{axis.name}" sets {own}, and the search varies {key}')
        self.study.refuse()
        given = self.definition.transition
        return velocities.Velocities.of_study(key, given, tuple(labels))

    def _at_velocities(self, combinations: list[tuple], interval: velocities.Velocities) -> list[tuple]:
        """Every combination at every velocity."""
        choices = [Option(label, short(label), {interval.key: label}) for label in interval.labels]
        return [(*combination, choice) for combination in combinations for choice in choices]

    # ------------------------------------------------------------------------------------------------ the velocity of impact

    def _check_impacts(self, cases: list[Planned], interval: velocities.Velocities) -> None:
        """Raises StudyError if the velocity of the search is not the impact velocity."""
        for case in cases[:: len(interval.labels)]:
            fault = velocities.fault(decks.loads(case.text), interval.key, interval.labels[0]) if case.text else None
            if fault and not self.study.wrong:
                self.study.say(("transition", "key"), f"transition.key: {fault}")
        self.study.refuse()

    # ------------------------------------------------------------------------------------------------ cases

    def _case(self, combination: tuple[Option, ...]) -> tuple[dict[str, str], str, list[str]]:
        """Labels by axis, base deck, overrides of one combination."""
        settings = dict(self.definition.set)
        for choice in combination:
            settings |= choice.settings
        base = settings.pop(DECK, self.definition.deck)
        if not isinstance(base, str):
            wrong = "is missing" if base is None else f"expected a file name, is {base!r}"
            raise StudyError(f"{self.study.path}: deck: {wrong}")
        last = velocities.AXIS if self.definition.transition else sampling.AXIS
        names = [*(axis.name for axis in self.definition.axis), last]
        labels = {name: choice.label for name, choice in zip(names, combination, strict=False)}
        placed = {key: toml.placed_value(key, value, self.study.folder) for key, value in settings.items()}
        return labels, base, [toml.assigned(key, value) for key, value in placed.items()]

    def _files(self, cases: list[tuple]) -> dict[str, Path]:
        """The file of every base deck."""
        files = {}
        for base in dict.fromkeys(base for _, base, _ in cases):
            beside = self.study.folder / base
            try:
                files[base] = beside if beside.is_file() else decks.find(base)
            except DeckError as error:
                self.study.say((DECK,), str(error))
        return files

    def _known_keys(self, files: dict[str, Path]) -> None:
        """Checks that at least one base deck has each key. A base deck without it makes its own cases invalid."""
        tables = []
        for file in files.values():
            try:
                tables.append(toml.read(file, Sources()))
            except DeckError as error:
                self.study.wrong.append(str(error))
        if self.sample:
            self.sample.known_keys(tables)
        for place, key in self._keys():
            if problem := key_messages.no_such_key(tables, key):
                self.study.say(place, problem)

    def _keys(self) -> Iterator[tuple[tuple, str]]:
        """Every deck key that the study sets, and its place in the study file."""
        if self.definition.transition and self.definition.transition.key:
            yield ("transition", "key"), self.definition.transition.key
        given = self.study.data.get("set", {})
        yield from ((place_of(("set",), key, given), key) for key in self.definition.set if key != DECK)
        for number, axis in enumerate(self.definition.axis):
            if axis.key:
                yield ("axis", number, "key"), axis.key
            for name, settings in (axis.variants or {}).items():
                table = self.study.data["axis"][number]["variants"][name]
                place = ("axis", number, "variants", name)
                yield from ((place_of(place, key, table), key) for key in settings if key != DECK)

    def _repeated(self, name: str, labels: dict, base: str, overrides: list[str], files: dict[str, Path]) -> list[Planned]:
        """A case, or its members if there is an ensemble; of a wrong deck only the first, so that it is reported once."""
        deck, message = _read(files[base], overrides)
        if deck and self.study.size.cells:
            try:
                overrides = [*overrides, *self.study.size.overrides(deck)]
                deck, message = _read(files[base], overrides)
            except DeckError as error:
                deck, message = None, str(error)
        case = Planned(name, labels, base, overrides, deck.to_toml() if deck else "", message)
        ensemble = self.study.ensemble
        if ensemble is None:
            return [self._by_chance(case, deck, files[base])]
        group = [replace(case, name=members.name(name, number), of=name or self.study.path.stem, member=number,
                         changed=members.amounts(ensemble, number)) for number in range(ensemble.repeats)]
        if deck is None:
            return group[:1]
        try:
            return [group[0], *(_changed(each, deck, files[base]) for each in group[1:])]
        except DeckError as error:
            self.study.say(("ensemble", "by"), f"ensemble.by: {base}: {error}")
            return []

    def _by_chance(self, case: Planned, deck: decks.Deck | None, file: Path) -> Planned:
        """A case with the changes of its row, if the sample has any."""
        if deck is None or not self.study.changes:
            return case
        row = int(case.values[sampling.AXIS])
        try:
            return _changed(replace(case, changed=members.amounts_of_row(self.definition.sample, row)), deck, file)
        except DeckError as error:
            self.study.say(("sample", "by"), f"sample.by: {case.deck}: {error}")
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


