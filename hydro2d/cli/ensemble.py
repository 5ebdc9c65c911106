"""Ensembles on the command line: `hydro2d run --repeats`, `hydro2d run --member` and `hydro2d converge`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

from hydro2d.base.terminal import say
from hydro2d.cli.base import FINEST, MOST_MEMBERS, Out, Overrides, UsageError, whole
from hydro2d.cli.workers import DEFAULT, Workers

#: largest number of meshes in a sequence
MOST_MESHES = 20

Repeats = Annotated[int, whole(2, MOST_MEMBERS)]
Member = Annotated[int, whole(0, MOST_MEMBERS - 1)]
Seed = Annotated[int, whole(0, 2**32)]
By = list[str] | None


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
        """The options as [ensemble] of a study file."""
        given = {"by": self.by, "seed": self.seed}
        return {"repeats": repeats, **{name: value for name, value in given.items() if value is not None}}

    def overrides(self, deck: Path, overrides: list[str]) -> list[str]:
        """The overrides that make the chosen member, after those of the user. Raises StudyError, DeckError."""
        from hydro2d.deck import deck as decks
        from hydro2d.study.plan import definition, members

        tables = {"deck": str(deck), "ensemble": self.table(2)}
        study, *_ = definition.of_tables(tables, f"--member {self.member}", ())
        changed = members.amounts(study.ensemble, self.member)
        return [*overrides, *members.overrides(decks.load(deck, overrides), changed)]


def run_all(chosen: Chosen, deck: Path, overrides: list[str], out: Path | None, *, threads: int, restart: bool, overwrite: bool,
            quiet: bool) -> int:
    """Runs all members of an ensemble of a deck as a study, and prints their joint result."""
    from hydro2d.cli.study import run_study
    from hydro2d.deck import deck as decks
    from hydro2d.study.plan import cases

    file = decks.find(deck)
    tables = {"title": f"{file.stem}, {chosen.repeats} members", "deck": str(file.resolve()),
              "ensemble": chosen.table(chosen.repeats)}
    plan = replace(cases.plan_of(tables, file.stem, overrides), again="--restart")
    workers = Workers(workers=chosen.workers, threads=threads, resume=restart, overwrite=overwrite)
    return run_study(plan, out or Path(f"runs/{file.stem}_ensemble"), workers, quiet=quiet)


def _meshes(text: str) -> list[float]:
    """Numbers of cells of --cells, from the coarsest to the finest."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        raise UsageError(f"--cells {text}: expected numbers with commas between them, such as 5.5,8.5,12.5") from None
    if not all(0.5 <= cells <= FINEST for cells in numbers):
        raise UsageError(f"--cells {text}: each must be from 0.5 to {FINEST:g} cells across the radius of the projectile")
    if not 2 <= len({f"{cells:g}" for cells in numbers}) == len(numbers) <= MOST_MESHES:
        raise UsageError(f"--cells {text}: give 2 to {MOST_MESHES} different numbers; three or more can show an order")
    return sorted(numbers)


def converge(
    deck: Path,
    *,
    cells: str,
    repeats: Repeats = 4,
    by: By = None,
    seed: Seed | None = None,
    y: list[str] | None = None,
    out: Out | None = None,
    set_: Overrides = None,
    workers: Workers = DEFAULT,
    check: bool = False,
    quiet: bool = False,
) -> int:
    """Runs an ensemble of a deck on several meshes, and separates the effect of the mesh from scatter.

    Example: hydro2d converge problems/cth_nose_shape/hemi_5083_1086.toml --cells 5.5,8.5,12.5 --repeats 4

    Where the sequence of meshes allows it, the value extrapolated to cells of zero size is given with a 90 % interval;
    otherwise the reason is. The file convergence.json in the study directory has the same results for programs, and
    `hydro2d report` draws them.

    Parameters
    ----------
    deck
        Input deck (TOML) with a projectile that has a radius.
    cells
        Numbers of cells across the radius of the projectile, such as 5.5,8.5,12.5. One factor scales all cells of the mesh.
    repeats
        Number of members on each mesh.
    by
        Differences between members: "mesh offset", "flank offset" or "first step"; can be repeated; default: mesh offset and
        first step. Offsets are fractions of a cell of each mesh.
    seed
        Seed of the sequence of changes; default: 0.
    y
        A number in summary.json; can be repeated; default: depth, final over initial length, and the residual velocity where
        something perforates.
    out
        Study directory; default: runs/<name of the deck>_converge.
    set_
        Overrides a value of the deck, as key=value; can be repeated.
    check
        Prints the cells and the estimated time of every member; runs nothing.
    quiet
        Prints errors only; sweep.log and convergence.json are still written.
    """
    from hydro2d.cli import study
    from hydro2d.study.ensemble import convergence

    workers.check()
    chosen = Chosen(repeats, None, by, seed, None)
    plan = convergence.plan(deck, _meshes(cells), chosen.table(repeats), set_ or [])
    if check:
        from hydro2d.study.run import estimate

        return estimate.show(plan, workers.number)
    place = out or Path(f"runs/{plan.name}_converge")
    status = study.run_study(plan, place, workers, quiet=quiet)
    _conclude(place, y or (), quiet)
    return status


def _conclude(directory: Path, y, quiet: bool) -> None:
    """Writes and prints the results of all meshes."""
    from hydro2d.study.ensemble import contents, convergence
    from hydro2d.study.records import study_directory

    sequences = convergence.sequences(contents.collect(study_directory.read(directory)), y)
    convergence.write(directory, sequences)
    for line in [line for each in sequences for line in ("", *each.lines())] if not quiet else []:
        say(line)
