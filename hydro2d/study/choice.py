"""Which cases a study has and which of them run next: all of them at once; `transition` has the other answer."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from hydro2d.study.cases import Plan
from hydro2d.study.layout import ENDED, Case, Study


class Choice:
    """All cases of a plan, at once."""

    def __init__(self, plan: Plan):
        self.plan = plan
        self._given = False

    def compared(self, directory: Path) -> Plan:
        """The cases that are held against those of the directory."""
        return self.plan

    def begin(self, directory: Path) -> Plan:
        """The cases that the study has at the start; nothing runs yet."""
        return self.plan

    def heading(self, study: Study) -> str:
        """The first line."""
        return f"{study.name}: {len(study.cases)} cases in {study.directory}"

    def wanted(self, cases: Sequence[Case], busy: Collection[str], workers: int) -> list[str]:
        """Names of cases to run now, which need not be in the study yet; those of `busy` have been given to dask."""
        names = [] if self._given else [case.name for case in cases if case.status not in ENDED]
        self._given = True
        return names

    def enlarged(self, names: Sequence[str]) -> Plan:
        """The study with further cases of the plan."""
        return self.plan

    def further(self, cases: Sequence[Case], busy: Collection[str]) -> int:
        """About how many cases will come into the study."""
        return 0

    def news(self, cases: Sequence[Case], name: str) -> str:
        """What a case that has ended says of the whole; may be empty."""
        return ""
