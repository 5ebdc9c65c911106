"""The command `hydro2d check-model`: checks a model or a table from outside as hydro2d checks its own models."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import App, Parameter

from hydro2d.base.errors import DeckError
from hydro2d.base.terminal import say
from hydro2d.cli.base import UsageError, quantity
from hydro2d.files.whole import read_text

#: exit status of a check that fails; temperature at rest of a table, K
WRONG, ROOM = 2, 298.0

check_model = App(name="check-model")


@check_model.default
def check(file: Path, *, as_: Annotated[Literal["strength", "eos", "damage"] | None, Parameter(name="--as")] = None,
          temperature: str | None = None) -> int:
    """Checks a model from outside as hydro2d checks its own: form, docstrings, compilation, derivatives, limits.

    Example: hydro2d check-model my_model.py

    Example: hydro2d check-model aluminium.301 --temperature "298 K"

    Parameters
    ----------
    file
        Python file of the model, the name of a model in an installed package, or a table of the SESAME type 301.
    as_
        Kind of model; default: the kind to which the functions in the file belong.
    temperature
        Temperature at rest of a table; default: 298 K. The density at rest is the greatest with zero pressure there.
    """
    from hydro2d.materials import contract, outside, sesame

    text = read_text(file, DeckError) if file.is_file() else ""
    if sesame.is_table(text):
        return _check_table(file, text, quantity(temperature, "K", "--temperature") if temperature else ROOM)
    if temperature:
        raise UsageError(f"--temperature is for tables, and {file} is not one")
    model = _model(file, as_)
    model.require()
    say(f"{model.file}: the {model.kind.title} {model.name}")
    say(f"  {'passed':<9} constants, functions and their docstrings, compilation")
    try:
        case = contract.case_of(model.kind.part, model.module)
    except contract.Broken as error:
        raise outside.ModelError(f"{file}: {error}") from None
    return _run(case)


def _check_table(file: Path, text: str, T: float) -> int:
    """Reads a table, prints what a deck must give with it, and runs the checks of equations of state on it."""
    from eos import tabular
    from hydro2d.cli.tabulate import lines
    from hydro2d.materials import contract, sesame

    try:
        table = sesame.read(text)
        if not table.temperature[0] <= T < table.temperature[-1]:
            raise sesame.TableError(f"{T:g} K is not within its temperatures, {table.temperature[0]:g} to "
                                    f"{table.temperature[-1]:g} K")
        rest = [rho for rho in tabular.densities_without_pressure(table, T) if rho > 0.0]
        if not rest:
            raise sesame.TableError(f"no density has zero pressure at {T:g} K; a gas is at rest at 0 K")
        said = lines(table, rest[-1], T)
    except ValueError as error:
        raise DeckError(f"{file}: {error}") from None
    say(f"{file}: a table of {table.density.size} densities and {table.temperature.size} temperatures")
    for line in said:
        say(line)
    return _run(contract.case_of_table(table, rest[-1], T))


def _run(case) -> int:
    """Runs the checks of a case, prints their results, and returns the exit status."""
    import numpy as np

    from hydro2d.materials import contract

    failed = 0
    for each in contract.CHECKS[case.kind.part]:
        try:
            with np.errstate(all="ignore"):  # a number that is not finite is reported by the check
                skipped = each(case)
            say(f"  {'skipped' if skipped else 'passed':<9} {each.__doc__}{f' ({skipped})' if skipped else ''}")
        except (Exception, SystemExit) as error:
            failed += 1
            what = str(error) if isinstance(error, contract.Broken) else f"{type(error).__name__}: {error}"
            say(f"  {'FAILED':<9} {each.__doc__}\n  {'':<9} {' '.join(what.split())}")
    say(f"{case.module.NAME}: {f'{failed} of the checks failed' if failed else 'all checks passed'}")
    return WRONG if failed else 0


def _model(file: Path, part: str | None):
    """The model in a file or in an installed package."""
    from hydro2d.materials import outside

    if not file.exists():
        for each in [part] if part else outside.KINDS:
            if model := outside.from_package(each, str(file)):
                return model
    return outside.read(file, part)
