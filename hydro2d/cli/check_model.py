"""The command `hydro2d check-model`: runs the checks of hydro2d's own models on a model from outside."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import App, Parameter

WRONG = 2

check_model = App(name="check-model")


@check_model.default
def check(file: Path, *, as_: Annotated[Literal["strength", "eos", "damage"] | None, Parameter(name="--as")] = None) -> int:
    """Runs the checks of hydro2d's own models on a model from outside: form, docstrings, compilation, derivatives, limits.

    Example: hydro2d check-model my_model.py

    Parameters
    ----------
    file
        Python file of the model, or the name of a model in an installed package.
    as_
        Kind of model; default: the kind to which the functions in the file belong.
    """
    from hydro2d.materials import contract, outside

    model = _model(file, as_)
    model.require()
    print(f"{model.file}: the {model.kind.title} {model.name}")
    print(f"  {'passed':<9} constants, functions and their docstrings, compilation")
    try:
        case = contract.case_of(model.kind.part, model.module)
    except contract.Broken as error:
        raise outside.ModelError(f"{file}: {error}") from None
    failed = 0
    for each in contract.CHECKS[model.kind.part]:
        try:
            skipped = each(case)
            print(f"  {'skipped' if skipped else 'passed':<9} {each.__doc__}{f' ({skipped})' if skipped else ''}")
        except Exception as error:
            failed += 1
            what = str(error) if isinstance(error, contract.Broken) else f"{type(error).__name__}: {error}"
            print(f"  {'FAILED':<9} {each.__doc__}\n  {'':<9} {' '.join(what.split())}")
    print(f"{model.name}: {f'{failed} of the checks failed' if failed else 'all checks passed'}")
    return WRONG if failed else 0


def _model(file: Path, part: str | None):
    """The model in a file, or in an installed package."""
    from hydro2d.materials import outside

    if not file.exists():
        for each in [part] if part else outside.KINDS:
            if found := outside.from_package(each, str(file)):
                return found
    return outside.read(file, part)
