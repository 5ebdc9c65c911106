"""`hydro2d transition`: the runs of a search for the velocities at which the regime of a rod changes, and their results."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path

from hydro2d.base.terminal import say, wrapped
from hydro2d.study.outcomes.registry import BY_NAME
from hydro2d.study.plan import velocities
from hydro2d.study.plan.planned import Plan, Planned
from hydro2d.study.records import study_directory
from hydro2d.study.records.study_directory import DONE, ENDED, INTERRUPTED, UNPHYSICAL, Case
from hydro2d.study.run import sweep
from hydro2d.study.search import chance_figure, regimes
from hydro2d.study.search.bisection import Search
from hydro2d.study.search.searching import Searching
from hydro2d.study.search.shots import Shots


class Bisection(Searching):
    """The cases that a search needs: one search for each combination of the axes, all of them in turn.

    A combination is a sequence of neighbouring cases of the plan that differ only in velocity, the slowest first.
    """

    def __init__(self, plan: Plan, again: bool = False):
        super().__init__(plan, again)
        count = len(plan.search.labels)
        self.groups = [plan.cases[first : first + count] for first in range(0, len(plan.cases), count)]
        self.chosen: set[str] = set()
        self.begun: set[str] = set()

    # ------------------------------------------------------------------------------------------------ cases of the study

    def compared(self, directory: Path) -> Plan:
        """The cases that have been begun, and the ends of every combination."""
        cases = study_directory.of_plan(self.plan, directory).cases
        return self._only({case.name for case in cases if case.directory.exists()})

    def begin(self, directory: Path) -> Plan:
        """The cases that have already ended, and the ends. Other begun cases are added when the search needs them."""
        before = study_directory.of_plan(self.plan, directory).cases
        self.begun = {case.name for case in before if case.status == INTERRUPTED}
        self.chosen = {case.name for case in before if case.status in (DONE, UNPHYSICAL)}
        return self._only(self.chosen)

    def enlarged(self, names: Sequence[str]) -> Plan:
        self.chosen |= set(names)
        return self._only(self.chosen)

    def _only(self, names: Collection[str]) -> Plan:
        """The plan with these cases and the ends, by combination and velocity, and only their velocities on the axis."""
        ends = {case.name for group in self.groups for case in (group[0], group[-1])}
        kept = [case for case in self.plan.cases if case.name in ends or case.name in names]
        used = {case.values[velocities.AXIS] for case in kept}
        *others, axis = self.plan.axes
        axes = [*others, axis | {"values": [label for label in axis["values"] if label in used]}]
        return replace(self.plan, cases=kept, axes=axes)

    # ------------------------------------------------------------------------------------------------ the search

    def heading(self, study: study_directory.Study) -> str:
        search, number = self.plan.search, len(self.groups)
        combined = f", {number} combinations of the axes" if number > 1 else ""
        return (
            f"{study.name}: from {search.labels[0]} to {search.labels[-1]}, to {search.tolerance:g} m/s"
            f"{combined}, in {study.directory}"
        )

    def _next(self, cases: Sequence[Case], under_way: Collection[str]) -> str | None:
        """The next case of the combination with the fewest cases under way."""
        by_name = {case.name: case for case in cases}
        for group in sorted(self.groups, key=lambda group: sum(case.name in under_way for case in group)):
            busy = {position for position, case in enumerate(group) if case.name in under_way}
            position = self._search(group, by_name, under_way).next(busy)
            if position is not None:
                return group[position].name
        return None

    def _search(self, group: Sequence[Planned], cases: dict[str, Case], busy: Collection[str]) -> Search:
        """The state of the search of a combination."""
        begun = {n for n, case in enumerate(group) if case.name in self.begun}
        search = Search(len(group), begun=begun, order=BY_NAME[self.plan.search.of].order)
        for position, planned in enumerate(group):
            case = cases.get(planned.name)
            if case is None or planned.name in busy:
                continue
            regime = self.outcome(case)
            if regime is not None:
                search.found[position] = regime
            elif case.status in ENDED or case.name in self.given:
                search.failed.add(position)
        return search

    def further(self, cases: Sequence[Case], busy: Collection[str]) -> int:
        by_name = {case.name: case for case in cases}
        return sum(self._search(group, by_name, busy).further() for group in self.groups)

    def news(self, cases: Sequence[Case], name: str) -> str:
        """The transitions of the combination found so far."""
        group = next(group for group in self.groups if any(case.name == name for case in group))
        names = {case.name for case in group}
        outcomes = {velocities.speed(case.values[velocities.AXIS]): regime for case in cases
                 if case.name in names and (regime := self.outcome(case))}
        label = regimes.label(group[0].values)
        return "  " + (f"{label}: " if label else "") + "; ".join(regimes.so_far(outcomes, self.plan.search.of))


def choice_of(plan: Plan, again: bool = False) -> Shots | Bisection:
    """The search of a plan; again : it is repeated even if all its rows are kept."""
    return Shots(plan, again) if plan.search.budget else Bisection(plan, again)


def find(plan: Plan, directory: Path, connect: AbstractContextManager, *, threads: int = 1, resume: bool = False,
         overwrite: bool = False, quiet: bool = False) -> int:
    """Searches, writes transition.json and prints the transitions. Returns the exit status. Arguments as for sweep.sweep.

    A search with a budget also writes transition.csv and transition.png.

    Raises StudyError, LockError (another sweep uses the directory).
    """
    choice = choice_of(plan, again=overwrite and not resume)
    status = sweep.sweep(choice, directory, connect, threads=threads, resume=resume, overwrite=overwrite, quiet=quiet)
    if choice.complete:
        return status
    study = study_directory.read(directory)
    combinations = regimes.of_study(study, [choice.record(case) for case in study.cases])
    if not quiet:
        say(wrapped("\n".join(("", *regimes.lines(study, combinations)))))
    regimes.write(study, combinations)
    if study.search.budget:
        for file in chance_figure.write(study, combinations):
            if not quiet:
                say(f"wrote {file}")
    return status
