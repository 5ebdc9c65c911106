"""The command `hydro2d curve`: flow stress against plastic strain."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from hydro2d.base.terminal import say
from hydro2d.cli.base import UsageError, import_matplotlib, quantity

#: default strains of the table, and default rates
STRAINS, RATES = (0.0, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 1.5), ("1e3 /s", "1e4 /s", "1e5 /s")


def curve(
    materials: list[str],
    *,
    rate: Annotated[list[str] | None, Parameter(allow_leading_hyphen=True)] = None,
    strain: list[float] | None = None,
    temperature: str | None = None,
    isothermal: bool = False,
    csv: Path | None = None,
    figure: Path | None = None,
) -> int:
    """Prints flow stress against plastic strain at constant strain rates, with heating by plastic work.

    Example: hydro2d curve W_alloy W_sintered --rate "1e4 /s" --figure flow_stress.png

    Parameters
    ----------
    materials
        Materials of the library: NAME or NAME:VARIANT.
    rate
        Plastic strain rate, such as "1e4 /s"; can be repeated; default: 1e3, 1e4 and 1e5 /s.
    strain
        Plastic strain of a row of the table; can be repeated; default: eight strains from 0 to 1.5.
    temperature
        Initial temperature, such as "600 K"; default: that of the material at rest.
    isothermal
        Keeps the material at its initial temperature.
    csv
        Writes the table, with the temperatures, to this CSV file.
    figure
        Draws the curves up to the largest strain and saves them as this file (.png, .pdf, .svg).
    """
    from hydro2d.materials import library

    rates = [quantity(text, "1/s", "--rate") for text in rate or RATES]
    strains = sorted(strain or STRAINS)
    if min(rates) < 0.0 or strains[0] < 0.0:
        raise UsageError("--rate and --strain must not be negative")
    start = None if temperature is None else quantity(temperature, "K", "--temperature")
    if start is not None and start <= 0.0:
        raise UsageError(f"--temperature must be above 0 K, is {start:g} K")
    from hydro2d.analytic import flow_curves

    curves = [flow_curves.Curve.of(material, each, strains, isothermal, start) for material in map(library.load, materials)
              for each in rates]
    for line in flow_curves.lines(curves):
        say(line)
    if csv is not None:
        flow_curves.write_csv(curves, csv)
    if figure is not None:
        import_matplotlib()
        from hydro2d.results import figures

        fine = [strains[-1] * n / 100 for n in range(101)] if strains[-1] > 0.0 else strains
        figures.save_figure(flow_curves.draw([each.at(fine) for each in curves]), figure)
    for path in filter(None, (csv, figure)):
        say(f"wrote {path}")
    return 0
