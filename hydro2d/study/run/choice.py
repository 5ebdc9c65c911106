"""The cases of a study and which of them run next: here all, in their order; `transition` has the other choice."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from fnmatch import fnmatchcase
from functools import cached_property
from itertools import islice
from pathlib import Path

from hydro2d.base.errors import unknown
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.planned import Plan, Planned
from hydro2d.study.records import sample_table
from hydro2d.study.records.keeping import Keeper
from hydro2d.study.records.study_directory import ENDED, Case, Study


def matching(plan: Plan, only: Sequence[str], skip: Sequence[str]) -> list[Planned]:
    """The cases whose names match one of the patterns `only`, or all without patterns, and none of `skip`.

    ``*`` and ``?`` are wildcards. Raises StudyError for a pattern that no name matches.
    """
    names = [case.name for case in plan.cases]
    for option, patterns in (("--only", only), ("skip", skip)):
        for pattern in patterns:
            if not any(fnmatchcase(name, pattern) for name in names):
                raise StudyError(f"{option} {pattern}: matches no case; {unknown('case', pattern, names)}")
    return [case for case in plan.cases if (not only or any(fnmatchcase(case.name, pattern) for pattern in only))
            and not any(fnmatchcase(case.name, pattern) for pattern in skip)]


class Choice:
    """All cases of a plan, one after another, or those whose names match a pattern; the others wait for another sweep.

    Cases that are up to date in the rows that the study keeps are not run.

    Dask is given no more cases at a time than there are workers. It would assign more to the workers at once, and if a worker
    dies, it blames every case waiting there.
    """

    def __init__(self, plan: Plan, only: Sequence[str] = (), skip: Sequence[str] = (), again: bool = False):
        self.plan = plan
        self.given: set[str] = set()
        chosen = matching(plan, only, skip)
        self.keeper = Keeper(plan) if plan.keep else None
        self.fresh = self.keeper.fresh(case.name for case in chosen) if self.keeper and not again else set()
        self.selected = [case for case in chosen if case.name not in self.fresh]
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

    @cached_property
    def complete(self) -> bool:
        """Whether, at the start, the rows that the study keeps already have all its results."""
        return not self.selected

    def kept(self) -> str:
        """The number of cases up to date in the rows that the study keeps, in words; empty if it keeps none."""
        return "" if self.keeper is None else self.keeper.in_words([*self.fresh, *(case.name for case in self.selected)])

    def keep(self, cases: Iterable[Case]) -> list[str]:
        """Adds the ended ones to the rows that the study keeps. Returns and raises what `Keeper.add` does."""
        return [] if self.keeper is None else self.keeper.add(cases, self.plan.cases)

    def tabulate(self, study: Study, cases: Sequence[Case]) -> None:
        """Writes the table of a sample into the directory of its study; nothing for other studies. Raises OSError."""
        if self.plan.sample is not None:
            kept = self.keeper.rows_of(self.fresh) if self.keeper else {}
            axes = [axis.name for axis in study.axes[:-1]]
            sample_table.write(study.directory, self.plan.sample, axes, cases, kept)

    def wanted(self, cases: Sequence[Case], busy: Collection[str], room: int) -> list[str]:
        """Names of cases to run now, at most `room`, in addition to those in `busy`. They need not be in the study yet."""
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
        """News from an ended case for the whole study; may be empty."""
        return ""
