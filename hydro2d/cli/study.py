"""The commands for studies: many runs from one file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from hydro2d.cli.base import Out, Overrides
from hydro2d.cli.workers import DEFAULT, Workers
from hydro2d.terminal import say, wrapped


def sweep(
    study: Path,
    *,
    out: Out | None = None,
    set_: Overrides = None,
    workers: Workers = DEFAULT,
    only: list[str] | None = None,
    check: bool = False,
    status: bool = False,
    quiet: bool = False,
) -> int:
    """Runs all cases of a study, on this machine or on many.

    Example: hydro2d sweep problems/cth_nose_shape/velocity_advection.toml --workers 4 --out runs/study

    Parameters
    ----------
    study
        Study file (TOML): a base deck, axes to vary, exclusions. With --status, a study directory is accepted too.
    out
        Study directory; default: `out` of the study file, else runs/<name of the study file>.
    set_
        Overrides a value of the deck in all cases, as key=value; can be repeated.
    only
        Runs the cases whose names match this pattern, such as "*ogive*"; can be repeated. The others wait for a later --resume.
    check
        Resolves all decks and prints the cases with their cells and estimated times; runs nothing.
    status
        Prints the table of the study directory; runs nothing.
    quiet
        Prints errors only; sweep.log is still written.
    """
    workers.check()
    if status:
        return _status(study, out)
    from hydro2d.study import cases

    plan = cases.plan(study, set_, search=False, quiet=quiet)
    if check:
        from hydro2d.study import estimate
        from hydro2d.study.choice import Choice

        choice = Choice(plan, only or ())
        return estimate.show(replace(plan, cases=choice.selected), workers.number)
    return run_study(plan, out or plan.out, workers, only=only or (), quiet=quiet)


def run_study(plan, out: Path, workers: Workers, *, only: Sequence[str] = (), quiet: bool) -> int:
    """Runs the cases of a plan and prints what the members of ensembles say together. Returns the exit status."""
    from hydro2d.study import sweep as sweeps
    from hydro2d.study.choice import Choice

    choice = Choice(plan, only)
    status = sweeps.sweep(choice, out, workers.connect(len(choice.selected)), threads=workers.threads, resume=workers.resume,
                          overwrite=workers.overwrite, quiet=quiet)  # fmt: skip
    if plan.ensemble and not quiet:
        say("")
        _show_ensembles(out)
    return status


def transition(
    study: Path,
    *,
    out: Out | None = None,
    set_: Overrides = None,
    workers: Workers = DEFAULT,
    check: bool = False,
    status: bool = False,
    quiet: bool = False,
) -> int:
    """Searches for the impact velocities at which a rod stops being rigid, erodes or perforates; v50 where chance decides.

    Example: hydro2d transition problems/cth_nose_shape/transition_hemi_5083.toml --workers 2 --out runs/transition

    The search is a bisection, or with a budget of runs in the study a sequence that gives v50, its 90 % interval and the width.
    The results are printed beside the criteria, the runs, the experiments and the predictions of the analytic models. The file
    transition.json in the study directory has the same results for programs, and `hydro2d report` shows them. Workers beyond
    the number of combinations of the axes try several velocities of one combination at a time. --resume continues unfinished
    cases where the search still needs them.

    Parameters
    ----------
    study
        Study file (TOML): a base deck, [transition] with the velocities to search, axes for several transitions. With
        --status, a study directory is accepted too.
    out
        Study directory; default: `out` of the study file, else runs/<name of the study file>.
    set_
        Overrides a value of the deck in all cases, as key=value; can be repeated.
    check
        Resolves the decks of all velocities and prints the number of runs needed and their time; runs nothing.
    status
        Prints the cases of the study directory and the transitions found so far; runs nothing.
    quiet
        Prints errors only; sweep.log and transition.json are still written.
    """
    workers.check()
    if status:
        return _status(study, out)
    from hydro2d.study import cases

    plan = cases.plan(study, set_, search=True, quiet=quiet)
    if check:
        from hydro2d.study import estimate

        return estimate.show_search(plan, workers.number)
    from hydro2d.study import transition as transitions

    return transitions.find(
        plan, out or plan.out, workers.connect(len(plan.cases)), threads=workers.threads, resume=workers.resume,
        overwrite=workers.overwrite, quiet=quiet,
    )  # fmt: skip


def _show_ensembles(directory: Path) -> None:
    """Prints what the members of each case of a study say together."""
    from hydro2d.study import contents, ensembles, layout, responses

    found = contents.collect(layout.read(directory))
    for line in ensembles.report(found.ensembles, responses.choose(found.study, found.records).y):
        say(wrapped(line))


def _status(study: Path, out: Path | None) -> int:
    from hydro2d.study import layout, monitor

    found = layout.read(out or (study if study.is_dir() else _directory(study)))
    told = monitor.status(found)
    if found.search is not None:
        from hydro2d.study import regimes

        told += ["", *regimes.lines(found, regimes.of_study(found))]
    for line in told:
        say(wrapped(line))
    if found.ensembles:
        say("")
        _show_ensembles(found.directory)
    return 0


def _directory(study: Path) -> Path:
    """Where a study file's results are."""
    from hydro2d.study import definition

    found, *_ = definition.read(study, [])
    return Path(found.out or f"runs/{study.stem}")
