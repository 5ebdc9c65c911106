"""The command `hydro2d fit-strength`: constants of a strength model from measured flow stresses."""

from __future__ import annotations

from pathlib import Path

from hydro2d.base.terminal import say
from hydro2d.cli.base import UsageError, import_matplotlib, quantity


def fit_strength(
    points: Path,
    *,
    model: str,
    material: str,
    fix: list[str] | None = None,
    share: list[str] | None = None,
    group: list[float] | None = None,
    columns: str | None = None,
    stress_unit: str = "Pa",
    temperature: str | None = None,
    rate: str | None = None,
    heated_from: str | None = None,
    table: bool = False,
    beside: list[str] | None = None,
    csv: Path | None = None,
    figure: Path | None = None,
) -> int:
    """Fits the constants of a strength model to measured flow stresses, and reports how well they fit.

    Example: hydro2d fit-strength points.txt --model johnson-cook --material steel_4340 --fix rate_coefficient=0.014

    Parameters
    ----------
    points
        File with a measured point in each line: plastic strain, strain rate in 1/s, temperature in K, flow stress. The first
        line may name the columns.
    model
        johnson-cook, voce, zerilli-armstrong, power-law, steinberg-guinan or preston-tonks-wallace.
    material
        Material of the library, NAME or NAME:VARIANT. It gives the density and specific heat for --heated-from, and those
        constants of the model that are not fitted, if its own law has them too.
    fix
        Keeps a constant fixed, as name=value, with its unit if it has one; can be repeated.
    share
        A constant that all groups have in common; can be repeated. The others are fitted for each group.
    group
        Fits the points of this group, by its number in the column "group"; can be repeated; default: all groups.
    columns
        The columns in order, separated by commas: strain, rate, temperature, stress, group, skip.
    stress_unit
        Unit of the stresses.
    temperature
        Range of temperatures of the fitted points, as LOW:HIGH, such as "150 K:800 K".
    rate
        Range of strain rates of the fitted points, as LOW:HIGH, such as "100 /s:1e4 /s".
    heated_from
        Strain rate, such as "100 /s", from which on plastic work heats the specimen during a test.
    table
        Prints the measured stresses and the differences from them by test and plastic strain.
    beside
        Material of the library, NAME or NAME:VARIANT, whose own law stands in that table as well; can be repeated.
    csv
        Writes every point with the fitted stress and the difference to this file.
    figure
        Draws the measured points and the fit and saves them as this file (.png, .pdf, .svg).
    """
    from hydro2d.analytic import fit_text
    from hydro2d.materials import fitting, library

    data = fitting.read_points(points, columns.split(",") if columns else None,
                               quantity(f"1 {stress_unit}", "Pa", "--stress-unit"))
    data = _chosen(data, group, temperature, rate)
    base = library.load(material)
    law = fitting.law(model)
    given = fitting.from_material(law, base) | {name: quantity(text, law.unit(name), f"--fix {name}")
                                                for name, text in map(_assignment, fix or [])}
    from_rate = quantity(heated_from, "1/s", "--heated-from") if heated_from else None
    heating = fitting.heating_of(base, from_rate) if from_rate else None
    others = {name: fitting.beside(library.load(name), data, from_rate) for name in beside or []}
    fit = fitting.fit(law, data, given, share or [], heating)
    for line in fit_text.lines(fit):
        say(line)
    if table or others:
        for line in ["", *fit_text.table(fit, others)]:
            say(line)
    if csv is not None:
        fit_text.write_csv(fit, csv)
    if figure is not None:
        import_matplotlib()
        from hydro2d.results import figures

        figures.save_figure(fit_text.draw(fit), figure)
    for path in filter(None, (csv, figure)):
        say(f"wrote {path}")
    return 0


def _assignment(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not (name and equals and value):
        raise UsageError(f"--fix {text}: expected name=value")
    return name, value


def _chosen(data, groups: list[float] | None, temperature: str | None, rate: str | None):
    """The points of some groups and within ranges of temperature and rate. Raises UsageError where none are left."""
    import numpy as np

    mask = np.full(len(data), True)
    if groups:
        unknown = sorted(set(groups) - set(data.groups))
        if unknown:
            raise UsageError(f"--group {unknown[0]:g}: the file has the groups {', '.join(f'{g:g}' for g in data.groups)}")
        mask &= np.isin(data.group, groups)
    for name, text, unit, example in (("temperature", temperature, "K", "150 K:800 K"), ("rate", rate, "1/s", "100 /s:1e4 /s")):
        if text is not None:
            if text.count(":") != 1:
                raise UsageError(f'--{name} {text}: expected LOW:HIGH, such as "{example}"')
            low, high = (quantity(end.strip(), unit, f"--{name}") for end in text.split(":"))
            mask &= (getattr(data, name) >= low) & (getattr(data, name) <= high)
    if not mask.any():
        raise UsageError("no points are left to fit")
    return data.chosen(mask)
