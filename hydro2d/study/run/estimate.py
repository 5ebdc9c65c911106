"""An estimate of a study before it runs: its cases, their cells and time."""

from __future__ import annotations

from collections.abc import Sequence

from hydro2d.base.errors import DeckError
from hydro2d.base.formats import one_line
from hydro2d.base.terminal import duration, say, wrapped
from hydro2d.deck import deck as decks
from hydro2d.running import check
from hydro2d.running.progress import counted
from hydro2d.study.plan.planned import Plan, Planned
from hydro2d.study.run.monitor import lines

DECK, HEADS = "deck", ("case", "cells", "cycles", "time")


def show(plan: Plan, workers: int) -> int:
    """Prints the table of the cases and their mistakes. Returns 0, or 2 if a case is invalid."""
    estimates = _table(plan, plan.cases)
    total = sum(seconds for _, seconds, _ in estimates)
    for note in plan.notes:
        say(wrapped(note))
    say(f"\n{len(estimates)} cases, about {duration(total / min(workers, len(estimates)))} on {workers} workers (a guess)")
    return _wrong(estimates)


def show_search(plan: Plan, workers: int) -> int:
    """Prints the estimate of a search: the two ends of every combination, and the number of runs needed."""
    count = len(plan.search.labels)
    estimates = _table(plan, [case for number, case in enumerate(plan.cases) if number % count in (0, count - 1)])
    combinations, budget = len(plan.cases) // count, plan.search.budget
    most = budget.runs if budget else min(2 + 2 * (count - 2).bit_length(), count)
    seconds = sum(seconds for _, seconds, _ in estimates) / 2 * most / min(workers, combinations)
    of_axes = f"{combinations} combinations of the axes, " if combinations > 1 else ""
    tried = f"{count} velocities {plan.search.tolerance:g} m/s apart"
    if budget:
        tried = f"velocities from {plan.search.labels[0]} to {plan.search.labels[-1]}, {budget.round} at a time"
    say("\n" + wrapped(f"{of_axes}{tried} by {plan.search.key}"))
    about = "" if budget else "about "
    say(wrapped(f"at most {about}{most} runs{' each' if of_axes else ''}, {duration(seconds)} on {workers} workers (a guess)"))
    return _wrong(estimates)


def _table(plan: Plan, cases: Sequence[Planned]) -> list[tuple[tuple[str, ...], float, str]]:
    """Prints the title and the table of cases. Returns the result of `_row` for each."""
    estimates = [_row(case) for case in counted(cases, "cases estimated")]
    say(wrapped(f"{plan.name}: {one_line(plan.title)}" if plan.title else plan.name))
    rows, bases = [HEADS, *(cells for cells, _, _ in estimates)], [case.deck for case in cases]
    if len(set(bases)) > 1:
        rows = [(name, base, *rest) for (name, *rest), base in zip(rows, [DECK, *bases], strict=True)]
    else:
        say(f"{DECK}: {bases[0]}")
    say("")
    for line in lines(rows[1:], rows[0], DECK):
        say(line)
    return estimates


def _wrong(estimates: Sequence[tuple[tuple[str, ...], float, str]]) -> int:
    """Prints the mistakes of cases. Returns the exit status."""
    wrong = [(cells[0], message) for cells, _, message in estimates if message]
    for name, message in wrong:
        say("\n".join(f"{name}: {text}" for text in message.splitlines()))
    return 2 if wrong else 0


def _row(case: Planned) -> tuple[tuple[str, ...], float, str]:
    """Cells of the table, estimated seconds on one thread, and mistakes."""
    try:
        if not case.text:
            raise DeckError(case.message)
        checked = check.check(decks.loads(case.text))
    except DeckError as error:
        return (case.name, "-", "-", "invalid"), 0.0, str(error)
    cells = (case.name, str(checked.grid.cells), str(checked.cycles), duration(checked.seconds))
    return cells, checked.seconds, ""
