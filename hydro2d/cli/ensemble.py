"""Ensembles on the command line: `hydro2d run --repeats`, `hydro2d run --member`, and `hydro2d converge`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from hydro2d.cli.base import UsageError

#: largest number of members of an ensemble
MOST = 1000


def _whole(least: int, most: int):
    """A converter to a whole number within bounds."""
    def convert(_type, tokens) -> int:
        text = tokens[0].value
        if not text.isdecimal() or not least <= int(text) <= most:
            raise UsageError(f"{tokens[0].keyword} {text}: must be a whole number from {least} to {most}")
        return int(text)

    return Parameter(converter=convert)


Repeats = Annotated[int, _whole(2, MOST)]
Member = Annotated[int, _whole(0, MOST - 1)]
Seed = Annotated[int, _whole(0, 2**32)]
By = Annotated[list[str] | None, Parameter(negative="")]


@dataclass(frozen=True)
class Chosen:
    """The options of `hydro2d run` for ensembles, as given."""

    repeats: int | None
    member: int | None
    by: list[str] | None
    seed: int | None
    workers: int | None

    def check(self) -> None:
        """Raises UsageError for options that exclude or need each other."""
        if self.repeats is not None and self.member is not None:
            raise UsageError("--repeats runs all members of an ensemble and --member one of them: give one of them")
        if self.repeats is None and self.workers is not None:
            raise UsageError("--workers needs --repeats; a single run takes --threads")
        for name, given in (("--by", self.by), ("--seed", self.seed)):
            if given is not None and self.repeats is None and self.member is None:
                raise UsageError(f"{name} needs --repeats or --member")

    def table(self, repeats: int) -> dict:
        """As [ensemble] of a study file."""
        given = {"by": self.by, "seed": self.seed}
        return {"repeats": repeats, **{name: value for name, value in given.items() if value is not None}}

    def overrides(self, deck: Path, overrides: list[str]) -> list[str]:
        """The overrides that make the chosen member, after those of the user. Raises StudyError, DeckError."""
        from hydro2d.deck import deck as decks
        from hydro2d.study import definition, members

        tables = {"deck": str(deck), "ensemble": self.table(2)}
        found, *_ = definition.of_tables(tables, f"--member {self.member}", ())
        changed = members.amounts(found.ensemble, self.member)
        return [*overrides, *members.overrides(decks.load(deck, overrides), changed)]


def run_all(chosen: Chosen, deck: Path, overrides: list[str], out: Path | None, *, threads: int, restart: bool, overwrite: bool,
            quiet: bool) -> int:  # fmt: skip
    """Runs all members of an ensemble of a deck as a study, and prints what they say together."""
    from hydro2d.cli.study import run_study
    from hydro2d.deck import deck as decks
    from hydro2d.study import cases

    file = decks.find(deck)
    tables = {"title": f"{file.stem}, {chosen.repeats} members", "deck": str(file.resolve()),
              "ensemble": chosen.table(chosen.repeats)}  # fmt: skip
    plan = cases.plan_of(tables, file.stem, overrides)
    return run_study(plan, out or Path(f"runs/{file.stem}_ensemble"), workers=chosen.workers, threads=threads, resume=restart,
                     overwrite=overwrite, quiet=quiet)  # fmt: skip
