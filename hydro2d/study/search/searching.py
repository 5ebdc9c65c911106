"""Common part of the searches of `hydro2d transition`: record and outcome of a case, and the next cases for idle workers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Sequence
from functools import cached_property

from hydro2d.study.plan.planned import Plan
from hydro2d.study.records import record
from hydro2d.study.records.study_directory import DONE, Case
from hydro2d.study.run.choice import Choice
from hydro2d.study.search import regimes


class Searching(Choice, ABC):
    """A choice of cases that depends on the outcomes of earlier ones."""

    def __init__(self, plan: Plan, again: bool = False):
        super().__init__(plan, again=True)  # a search needs the runs themselves, even those with rows
        self.anew = again
        self.records: dict[str, record.Record] = {}

    @cached_property
    def complete(self) -> bool:
        """False: the number of runs of a bisection is not known beforehand."""
        return False

    def kept(self) -> str:
        return ""

    def record(self, case: Case) -> record.Record:
        """The record of a case; a finished case is read only once."""
        if case.status != DONE:
            return record.read(case)
        if case.name not in self.records:
            self.records[case.name] = record.read(case)
        return self.records[case.name]

    def outcome(self, case: Case) -> str | None:
        """The regime of a case, or another outcome that the search distinguishes; None if it has none."""
        if case.status != DONE:
            return None
        return regimes.judge(self.record(case), self.plan.search.of, self.plan.search.depth).word

    def wanted(self, cases: Sequence[Case], busy: Collection[str], room: int) -> list[str]:
        """As many cases as there are idle workers."""
        names: list[str] = []
        while len(names) < room and (name := self._next(cases, {*busy, *names})) is not None:
            names.append(name)
            self.given.add(name)
        return names

    @abstractmethod
    def _next(self, cases: Sequence[Case], under_way: Collection[str]) -> str | None:
        """The next case to run, if one can be chosen before others end."""
