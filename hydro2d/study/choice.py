"""Which cases a study has and which of them run next: here all, in their order; `transition` has the other choice."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from fnmatch import fnmatchcase
from itertools import islice
from pathlib import Path

from hydro2d.errors import unknown
from hydro2d.study.cases import Plan, Planned
from hydro2d.study.definition import StudyError
from hydro2d.study.layout import ENDED, Case, Study


def _matching(plan: Plan, patterns: Sequence[str]) -> list[Planned]:
    """The cases whose names match one of the patterns, with ``*`` and ``?`` as wildcards; all cases without patterns.

    Raises StudyError for a pattern that no name matches.
    """
    names = [case.name for case in plan.cases]
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in names):
            raise StudyError(f"--only {pattern}: matches no case; {unknown('case', pattern, names)}")
    return [case for case in plan.cases if not patterns or any(fnmatchcase(case.name, pattern) for pattern in patterns)]


class Choice:
    """All cases of a plan, one after another, or those whose names match a pattern; the others wait for another sweep.

    Dask is given no more cases at a time than there are workers. It would assign more to the workers at once, and when a worker
    dies, it blames every case that waits there.
    """

    def __init__(self, plan: Plan, only: Sequence[str] = ()):
        self.plan = plan
        self.given: set[str] = set()
        self.selected = _matching(plan, only)
        self.left_out = {case.name for case in plan.cases} - {case.name for case in self.selected}

    def compared(self, directory: Path) -> Plan:
        """The cases that are compared with those of the directory."""
        return self.plan

    def begin(self, directory: Path) -> Plan:
        """The cases that the study has at the start; nothing runs yet."""
        return self.plan

    def heading(self, study: Study) -> str:
        """The first line."""
        some = f"{len(self.selected)} of " if self.left_out else ""
        return f"{study.name}: {some}{len(study.cases)} cases in {study.directory}"

    def wanted(self, cases: Sequence[Case], busy: Collection[str], room: int) -> list[str]:
        """Names of cases to run now, at most `room`, besides those in `busy`. They need not be in the study yet."""
        passed = self.given | self.left_out
        left = (case.name for case in cases if case.status not in ENDED and case.name not in passed)
        names = list(islice(left, room))
        self.given |= set(names)
        return names

    def enlarged(self, names: Sequence[str]) -> Plan:
        """The study with further cases of the plan."""
        return self.plan

    def further(self, cases: Sequence[Case], busy: Collection[str]) -> int:
        """Approximate number of cases that will be added to the study."""
        return 0

    def news(self, cases: Sequence[Case], name: str) -> str:
        """What a case that has ended means for the whole study; may be empty."""
        return ""
