"""The command `hydro2d model`: analytic penetration models, one by one and side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from hydro2d.base.terminal import say, wrapped
from hydro2d.cli.base import Overrides, UsageError, import_matplotlib, quantity

#: largest number of rows of --velocity A:B:N
MOST_ROWS = 100_000

#: `hydro2d model NAME --help` shows the page of that model, so --help is an ordinary option here
model = App(name="model", help_flags=[], usage="Usage: hydro2d model [NAME] [OPTIONS]")


@model.default
def evaluate(
    name: str | None = None,
    *,
    rod: str | None = None,
    target: str | None = None,
    velocity: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    set_: Overrides = None,
    deck: Path | None = None,
    strain: float = 0.0,
    csv: Path | None = None,
    figure: Path | None = None,
    json: bool = False,
    help_: Annotated[bool, Parameter(name=["--help", "-h"])] = False,
) -> int:
    """Lists, explains or evaluates the analytic penetration models.

    Example: hydro2d model tate --rod W_alloy --target Al5083 --velocity 1086m/s --set rod.diameter=6.7568mm

    Parameters
    ----------
    name
        Name of the model. Without --velocity and --deck its page is shown: source, validity, inputs, outputs and an example.
    rod
        Rod material from the library, NAME or NAME:VARIANT; default: the material of the model's example.
    target
        Target material, in the same form.
    velocity
        Impact velocity, such as 1086m/s, or a range A:B:N of N velocities, such as 500m/s:2000m/s:200.
    set_
        Sets an input, as key=value, such as rod.diameter=8.12mm; can be repeated.
    deck
        Input deck that gives materials, geometry and, without --velocity, the impact velocity.
    strain
        Equivalent plastic strain at which the strengths of the materials are evaluated; 0 is initial yield.
    csv
        Writes the results to this CSV file.
    figure
        Draws the main output over a range of velocities and saves it as this file (.png, .pdf, .svg).
    json
        Prints JSON: inputs with their sources, units and results.
    help_
        Shows the page of the model, or this text.
    """
    if name is None:
        return _without_name(help_, rod, target, velocity, set_, deck)
    from hydro2d.analytic import experience, model_text, models

    chosen = models.named(name)
    if help_ or (velocity is None and deck is None):
        say(wrapped(model_text.page(chosen)))
        return 0
    request, at = _request([chosen], rod, target, set_, deck, strain)
    velocities = _velocities(velocity) if velocity is not None else [at]
    if figure is not None and len(velocities) < 2:
        raise UsageError("--figure draws a range: give --velocity A:B:N")
    case = models.resolve(chosen, request)
    rows = case.rows(velocities)
    written = _write(case, rows, csv, figure)
    known = experience.of_model(chosen, request.rod, request.target, request.settings, velocities, request.thickness)
    _show(model_text.data(case, rows, known) if json else model_text.report(case, rows, list(map(wrapped, known))))
    if written and not json:
        say("\n" + "\n".join(f"wrote {path}" for path in written))
    return 0


def _without_name(help_: bool, *options) -> int:
    """The list of models, or the help of the command."""
    if help_:
        model.help_print([])
        return 0
    if any(option is not None for option in options):
        raise UsageError("model: the name of a model is missing; `hydro2d model` lists them")
    from hydro2d.analytic import model_text

    say(wrapped(model_text.overview()))
    return 0


def _request(known, rod, target, set_, deck, strain):
    """The user's choices, and the impact velocity of the deck or None."""
    from hydro2d.analytic import model_deck, models
    from hydro2d.materials import library

    shot = model_deck.read(deck) if deck is not None else None
    sides = {
        side: library.load(name) if name is not None else getattr(shot, side, None)
        for side, name in (("rod", rod), ("target", target))
    }
    geometry = shot.values if shot else {}
    request = models.Request(**sides, settings=models.settings(set_ or [], known), geometry=geometry, strain=strain)
    return request, shot.velocity if shot else None


def _velocities(text: str) -> list[float]:
    """One velocity, or N from A to B."""
    parts = text.split(":")
    if len(parts) == 1:
        return [quantity(text, "m/s", "--velocity")]
    if len(parts) != 3 or not parts[2].strip().isdigit():
        raise UsageError(f"--velocity {text}: expected one velocity or a range A:B:N, such as 500m/s:2000m/s:200")
    low, high = (quantity(part, "m/s", "--velocity") for part in parts[:2])
    count = int(parts[2])
    if not (low < high and 2 <= count <= MOST_ROWS):
        raise UsageError(f"--velocity {text}: A must be less than B, and N from 2 to {MOST_ROWS}")
    return [low + (high - low) * n / (count - 1) for n in range(count)]


def _show(output) -> None:
    """Prints text as it is, data as JSON."""
    import json

    say(output if isinstance(output, str) else json.dumps(output, indent=2, allow_nan=False))


def _write(case, rows, csv: Path | None, figure: Path | None) -> list[Path]:
    """Writes the requested files and returns their paths."""
    for path in (csv, figure):
        if path is not None and not path.parent.is_dir():
            raise UsageError(f"{path.parent}: there is no such directory")
    if csv is not None:
        from hydro2d.analytic import model_text

        model_text.write_csv(case.model, rows, csv)
    if figure is not None:
        import_matplotlib()
        from hydro2d.analytic import model_figures
        from hydro2d.results import figures

        figures.save_figure(model_figures.draw(case, rows), figure)
    return [path for path in (csv, figure) if path is not None]


@model.command(help_flags=["--help", "-h"])
def transition(
    *,
    rod: str | None = None,
    target: str | None = None,
    nose: str | None = None,
    runs: Annotated[list[Path] | None, Parameter(consume_multiple=True)] = None,
    set_: Overrides = None,
    deck: Path | None = None,
    strain: float = 0.0,
    json: bool = False,
) -> int:
    """Compares the impact velocities at which a rod stops being rigid: models, experiments, the CTH study, runs.

    Example: hydro2d model transition --rod W_alloy --target Al5083 --nose hemispherical

    Parameters
    ----------
    rod
        Rod material from the library, NAME or NAME:VARIANT.
    target
        Target material, in the same form.
    nose
        Nose shape: hemispherical, ogival, conical or flat; default: the nose in the deck, else hemispherical.
    runs
        Run directories; the fastest run that stayed rigid and the slowest that did not form a bracket.
    set_
        Sets an input of every model that has it, as key=value; can be repeated.
    deck
        Input deck that gives materials and geometry.
    strain
        Equivalent plastic strain at which the strengths of the materials are evaluated; 0 is initial yield.
    json
        Prints JSON.
    """
    from hydro2d.analytic import model_transition
    from hydro2d.analytic.catalogue import NOSE

    request, _ = _request(model_transition.with_transition(), rod, target, set_, deck, strain)
    shape = nose or request.settings.get("nose.shape") or getattr(request.geometry.get("nose.shape"), "value", "hemispherical")
    shape = NOSE[0].check(shape)
    comparison = model_transition.compare(request, shape, runs or ())
    _show(comparison.data() if json else "\n".join(comparison.lines()))
    return 0
