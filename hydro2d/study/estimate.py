"""What a study amounts to before it runs: its cases, their cells and time."""

from __future__ import annotations

from hydro2d import check
from hydro2d import deck as decks
from hydro2d.deck_errors import DeckError
from hydro2d.progress import duration
from hydro2d.study.cases import Plan, Planned
from hydro2d.study.monitor import lines

HEADS = ("case", "deck", "cells", "cycles", "time")


def show(plan: Plan, workers: int) -> int:
    """Prints the table of the cases and what is wrong with them. Returns 0, or 2 where a case is invalid."""
    found = [_row(case) for case in plan.cases]
    print(f"{plan.name}: {plan.title}\n" if plan.title else f"{plan.name}\n")
    for line in lines([cells for cells, _, _ in found], HEADS):
        print(line)
    total = sum(seconds for _, seconds, _ in found)
    print(f"\n{len(found)} cases, about {duration(total / min(workers, len(found)))} on {workers} workers (a guess)")
    wrong = [(cells[0], message) for cells, _, message in found if message]
    for name, message in wrong:
        print("\n".join(f"{name}: {text}" for text in message.splitlines()))
    return 2 if wrong else 0


def _row(case: Planned) -> tuple[tuple[str, ...], float, str]:
    """Cells of the table, estimated seconds on one thread, and what is wrong."""
    try:
        if not case.text:
            raise DeckError(case.message)
        found = check.check(decks.loads(case.text))
    except DeckError as error:
        return (case.name, case.deck, "-", "-", "invalid"), 0.0, str(error)
    cells = (case.name, case.deck, str(found.grid.cells), str(found.cycles), duration(found.seconds))
    return cells, found.seconds, ""
