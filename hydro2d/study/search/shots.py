"""The runs of a search for a transition whose outcome is partly chance: the shots of a study, and the next ones to run.

Every shot is one case: a velocity that `sequence.next_speed` chooses, and a draw. Shots of a combination of the axes are
numbered from 1 in the order in which they are chosen, and keep number, velocity and draw when a search is continued.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from hydro2d.base.formats import distinct
from hydro2d.base.method_version import METHOD
from hydro2d.deck import deck as decks
from hydro2d.files import toml
from hydro2d.study.outcomes.registry import BY_NAME
from hydro2d.study.plan import draws, velocities
from hydro2d.study.plan.planned import Plan, Planned, short
from hydro2d.study.records import study_directory
from hydro2d.study.records.keeping import MEMBER, OF_METHOD
from hydro2d.study.records.study_directory import ENDED, WAITING, Case
from hydro2d.study.search import ballistic, regimes, sequence, v50
from hydro2d.study.search.bisection import MOST_FAILED
from hydro2d.study.search.searching import Searching


@dataclass
class Combination:
    """A combination of the axes: the cases at the two ends of the interval, its part of names, and its shots in their order."""

    ends: tuple[Planned, Planned]
    prefix: str
    shots: list[Planned] = field(default_factory=list)

    @property
    def valid(self) -> bool:
        """Whether its deck is right."""
        return bool(self.ends[0].text)

    @property
    def cases(self) -> list[Planned]:
        """Its cases; if its deck is wrong, one that says why."""
        return self.shots if self.valid else [self.ends[0]]


def _without_speed(values: dict[str, str]) -> str:
    """The part of names of cases that the axes but the velocity make."""
    return "_".join(short(value) for axis, value in values.items() if axis != velocities.AXIS)


class Shots(Searching):
    """The cases of a search with a budget."""

    def __init__(self, plan: Plan, again: bool = False):
        super().__init__(plan, again)
        self.search = plan.search
        pairs = list(zip(plan.cases[::2], plan.cases[1::2], strict=True))
        names = distinct([_without_speed(low.values) for low, _ in pairs])
        self.groups = [Combination(ends, f"{name}_" if name else "") for ends, name in zip(pairs, names, strict=True)]
        self.interval = tuple(velocities.speed(label) for label in plan.search.labels)
        self.backwards = plan.search.labels[0].startswith("-")

    # ------------------------------------------------------------------------------------------------ cases of the study

    def compared(self, directory: Path) -> Plan:
        """The shots of the study in the directory, as this search makes them."""
        return self.begin(directory)

    def begin(self, directory: Path) -> Plan:
        """The shots that were made or begun, and the first one of every combination."""
        before = study_directory.read(directory).cases if (directory / study_directory.STUDY).exists() else ()
        for group in self.groups:
            self._adopt(group, [case for case in before if self._belongs(case, group)])
            if group.valid and not group.shots:
                self._add(group, self.interval[0])
        return self._planned()

    def _belongs(self, case: Case, group: Combination) -> bool:
        return {**group.ends[0].values, velocities.AXIS: ""} == {**case.values, velocities.AXIS: ""}

    def _adopt(self, group: Combination, before: Sequence[Case]) -> None:
        """Takes the shots of an earlier search, up to the last one that was begun."""
        group.shots.clear()
        begun = [n for n, case in enumerate(before) if case.status != WAITING]
        for case in before[: begun[-1] + 1] if begun and group.valid else ():
            self._add(group, velocities.speed(case.values[velocities.AXIS]))
            if group.shots[-1].name != case.name:  # of a bisection, or of other axes
                group.shots.pop()
                return

    def _add(self, group: Combination, speed: float) -> Planned:
        """A further shot at a velocity."""
        shot = self._shot(group, len(group.shots) + 1, f"{'-' if self.backwards else ''}{speed:.6g} m/s")
        group.shots.append(shot)
        return shot

    def _shot(self, group: Combination, number: int, label: str) -> Planned:
        """The shot of this number, at a velocity."""
        end = group.ends[0]
        given = [f"{self.search.key}={toml.inline(label)}", *draws.overrides(end.text, self.search.budget.seed, number)]
        return Planned(
            name=f"{group.prefix}{number:03d}_{short(label)}", values={**end.values, velocities.AXIS: label}, deck=end.deck,
            overrides=[*end.overrides, *given], text=decks.loads(end.text, given).to_toml(), message="", member=number,
        )

    @cached_property
    def complete(self) -> bool:
        """Whether every combination has the rows of all its shots."""
        return not self.anew and min(map(len, self.fresh_shots)) >= self.search.budget.runs

    def kept(self) -> str:
        if self.keeper is None:
            return ""
        runs = [min(len(shots), self.search.budget.runs) for shots in self.fresh_shots]
        return f"{self.keeper.path}: {sum(runs)} of {len(runs) * self.search.budget.runs} runs up to date"

    @cached_property
    def fresh_shots(self) -> list[set[str]]:
        """The shots of every combination that are up to date as the search begins."""
        return [self._kept_of(group) for group in self.groups]

    def _kept_of(self, group: Combination) -> set[str]:
        """The names of those shots of a combination whose rows are up to date."""
        if self.keeper is None:
            return set()
        others = {**group.ends[0].values, velocities.AXIS: ""}
        rows = [row for row in self.keeper.rows if {**{name: row[name] for name in others}, velocities.AXIS: ""} == others]
        shots = [self._shot(group, int(row[MEMBER]), row[velocities.AXIS]) for row in rows if row[OF_METHOD] == METHOD]
        return self.keeper.fresh_of(shots)

    def _planned(self) -> Plan:
        """The plan with the shots so far."""
        kept = [case for group in self.groups for case in group.cases]
        used = sorted({case.values[velocities.AXIS] for case in kept}, key=velocities.speed)
        *others, axis = self.plan.axes
        self.plan = replace(self.plan, cases=kept, axes=[*others, axis | {"values": used}])
        return self.plan

    def enlarged(self, names: Sequence[str]) -> Plan:
        return self._planned()

    # ------------------------------------------------------------------------------------------------ the search

    def heading(self, study: study_directory.Study) -> str:
        budget, number = self.search.budget, len(self.groups)
        combined = f" for each of {number} combinations of the axes" if number > 1 else ""
        return (
            f"{study.name}: from {self.search.labels[0]} to {self.search.labels[-1]}, {budget.runs} runs in rounds of "
            f"{budget.round}{combined}, seed {budget.seed}, in {study.directory}"
        )

    def _next(self, cases: Sequence[Case], under_way: Collection[str]) -> str | None:
        """The next shot of the combination with the fewest shots under way."""
        by_name = {case.name: case for case in cases}
        groups = sorted(self.groups, key=lambda group: sum(shot.name in under_way for shot in group.shots))
        return next((name for group in groups if (name := self._next_of(group, by_name, under_way))), None)

    def _next_of(self, group: Combination, cases: dict[str, Case], under_way: Collection[str]) -> str | None:
        """The next shot of a combination, if one can be chosen before others end."""
        if not group.valid or self._given_up(group, cases, under_way):
            return None
        for shot in group.shots:
            if shot.name not in self.given and (shot.name not in cases or cases[shot.name].status not in ENDED):
                return shot.name
        size = self.search.budget.round
        begin = sequence.begin_of_round(len(group.shots), size)
        before = group.shots[:begin]
        if len(group.shots) >= self.search.budget.runs or not all(self._ended(shot, cases, under_way) for shot in before):
            return None
        outcomes = self._outcomes(before, cases)
        if sequence.alike(outcomes, size):
            return None
        speeds = [velocities.speed(shot.values[velocities.AXIS]) for shot in group.shots]
        seed, left = self.search.budget.seed, self._residuals(before, cases)
        return self._add(group, sequence.next_speed(speeds, outcomes, self.interval, size, seed, left)).name

    def _residuals(self, shots: Sequence[Planned], cases: dict[str, Case]) -> list[float | None] | None:
        """The residual velocity behind each shot's target, m/s, as `sequence.next_speed` takes it; None for other outcomes."""
        if not BY_NAME[self.search.of].is_ballistic:
            return None
        if not shots:
            return []
        judged = regimes.judged([self.record(cases[shot.name]) for shot in shots], self.search)
        return ballistic.residuals(judged).reindex(range(len(shots))).replace(math.nan, None).tolist()

    def _ended(self, shot: Planned, cases: dict[str, Case], under_way: Collection[str]) -> bool:
        """Whether a shot has ended in any way."""
        case = cases.get(shot.name)
        return case is not None and shot.name not in under_way and (case.status in ENDED or shot.name in self.given)

    def _outcomes(self, shots: Sequence[Planned], cases: dict[str, Case]) -> list[bool | None]:
        """Whether each shot has the outcome of fast ones; None if it has no outcome."""
        fast = BY_NAME[self.search.of].order[-1]
        outcomes = [self.outcome(cases[shot.name]) for shot in shots]
        return [None if each is None else each == fast for each in outcomes]

    def _given_up(self, group: Combination, cases: dict[str, Case], under_way: Collection[str]) -> bool:
        ended = [shot for shot in group.shots if self._ended(shot, cases, under_way)]
        return sum(self.outcome(cases[shot.name]) is None for shot in ended) >= MOST_FAILED

    def further(self, cases: Sequence[Case], busy: Collection[str]) -> int:
        """Number of shots that the budget still allows."""
        by_name = {case.name: case for case in cases}
        going_on = [group for group in self.groups if group.valid and not self._given_up(group, by_name, busy)]
        return sum(self.search.budget.runs - len(group.shots) for group in going_on)

    def news(self, cases: Sequence[Case], name: str) -> str:
        """The estimate of the combination so far."""
        group = next(group for group in self.groups if any(shot.name == name for shot in group.shots))
        names = {shot.name for shot in group.shots}
        shots = regimes.judged([self.record(case) for case in cases if case.name in names], self.search)
        words = regimes.label(group.ends[0].values)
        estimate = v50.estimate(self.search, BY_NAME[self.search.of], shots)
        return f"  {words + ': ' if words else ''}{estimate.name}: {estimate.in_short}"
