"""A study of parts: studies that are run in turn, each in a directory of its own, with one summary of their cost."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import cached_property
from pathlib import Path

from hydro2d.base.errors import DeckError
from hydro2d.base.formats import distinct
from hydro2d.base.terminal import say, wrapped
from hydro2d.deck import deck as decks
from hydro2d.running import check
from hydro2d.running.progress import counted
from hydro2d.study.plan import cases
from hydro2d.study.plan.definition import Definition, Overrides, Part, StudyError, read
from hydro2d.study.plan.planned import Plan, Planned
from hydro2d.study.plan.scaling import Size
from hydro2d.study.records import keeping
from hydro2d.study.run.choice import Choice, matching
from hydro2d.study.run.monitor import lines
from hydro2d.study.search.transition import choice_of

HEADS = ("part", "runs", "up to date", "stale", "to run", "core hours", "MB")


@dataclass(frozen=True)
class Chosen:
    """A part with the cases that it has to run. ``name`` is that of its directory."""

    part: Part
    name: str
    plan: Plan
    again: bool

    @cached_property
    def choice(self) -> Choice:
        if self.plan.search:
            return choice_of(self.plan, self.again)
        return Choice(self.plan, self.part.only, self.part.skip, self.again)

    @cached_property
    def states(self) -> tuple[int, int, int]:
        """Runs of the part; those that are up to date and are not made again, and stale ones."""
        choice = self.choice
        if self.plan.search:
            budget = self.plan.search.budget
            if budget is None:
                return len(self.plan.cases), 0, 0
            fresh = 0 if self.again else sum(min(len(shots), budget.runs) for shots in choice.fresh_shots)
            return len(choice.groups) * budget.runs, fresh, 0
        names = [*choice.fresh, *(case.name for case in choice.selected)]
        keeper = choice.keeper
        return len(names), len(choice.fresh), keeper.stale(names) if keeper else 0


def is_of_parts(path: Path) -> bool:
    """Whether a study file is made of others. Raises StudyError."""
    return bool(read(Path(path), ())[0].part)


def plans(path: Path, overrides: Overrides, size: Size, only: Sequence[str] = (), *, again: bool = False,
          quiet: bool = False) -> list[Chosen]:
    """The parts of a study, with all decks resolved.

    overrides : of all decks, over those of [set];  size : replaces members and cells of all parts
    only : patterns of the names of parts;  again : whether to choose cases that are up to date

    Raises StudyError.
    """
    path = Path(path)
    definition, *_ = read(path, overrides)
    chosen = [(part, name) for part, name in zip(definition.part, _names(definition), strict=True)
              if not only or any(fnmatchcase(name, pattern) for pattern in only)]
    if not chosen:
        raise StudyError(f"only {' '.join(only)}: matches no part; parts: {', '.join(_names(definition))}")
    parts = []
    for part, name in chosen:
        of_part = Size(size.members or part.members, size.cells or part.cells)
        plan = cases.plan(path.parent / part.study, definition.set, quiet=quiet, size=of_part)
        if plan.search:  # a search has the combinations that are left; a sweep leaves its other cases for later
            plan = replace(plan, cases=matching(plan, part.only, part.skip))
        parts.append(Chosen(part, name, plan, again))
    return parts


def _names(definition: Definition) -> list[str]:
    given = [part.name or Path(part.study).stem + (f"_{part.cells:g}" if part.cells else "") for part in definition.part]
    return distinct(given)


def show(parts: Sequence[Chosen], workers: int) -> int:
    """Prints the cost of each part and of all together. Returns 0, or 2 if a case is invalid."""
    rows, wrong, hours, size, left = [], [], 0.0, 0.0, 0
    for each in parts:
        runs, fresh, stale = each.states
        seconds, space, problems = _cost(each)
        wrong += problems
        to_run = runs - fresh
        part_hours, part_size = to_run * seconds / 3600, to_run * space / 1e6
        hours, size, left = hours + part_hours, size + part_size, left + to_run
        rows.append((each.name, str(runs), str(fresh), str(stale), str(to_run), f"{part_hours:.1f}", f"{part_size:.0f}"))
    sums = (str(sum(int(row[column]) for row in rows)) for column in (1, 2, 3, 4))
    rows.append(("all", *sums, f"{hours:.1f}", f"{size:.0f}"))
    for line in lines(rows, HEADS):
        say(line)
    for each in parts:
        if each.part.about:
            say(wrapped(f"{each.name}: {each.part.about}"))
    say(wrapped(f"{left} runs, about {hours / workers:.1f} hours on {workers} workers (a guess), at most {size:.0f} MB"))
    for line in wrong:
        say(line)
    return 2 if wrong else 0


def _cost(each: Chosen) -> tuple[float, float, list[str]]:
    """Mean seconds on one thread and bytes of a run, and the mistakes of cases, from the first member of each case."""
    selected = each.plan.cases if each.plan.search else each.choice.selected
    first = {case.of or case.name: case for case in reversed(selected)}
    checks, wrong = [], []
    for case in counted(list(first.values()), f"cases of {each.name} estimated"):
        try:
            checks.append(_checked(case))
        except DeckError as error:
            wrong.append(f"{each.name}, {case.name}: {error}")
    mean = [sum(values) / len(checks) for values in zip(*((one.seconds, one.disk) for one in checks), strict=True)]
    return *(mean or (0.0, 0.0)), wrong


def _checked(case: Planned) -> check.Check:
    if not case.text:
        raise DeckError(case.message)
    return check.check(decks.loads(case.text))


def mixed(parts: Sequence[Chosen]) -> Iterator[str]:
    """Notes on kept rows that are not all of this method."""
    for path in dict.fromkeys(each.plan.keep for each in parts if each.plan.keep):
        if sentence := keeping.method_note(row[keeping.OF_METHOD] for row in keeping.read(path)):
            yield f"{path.name}: {sentence}"
