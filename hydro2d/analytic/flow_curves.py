"""Flow stress against plastic strain as tables and figures."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hydro2d.base.formats import cell, in_legend
from hydro2d.files.whole import replacing
from hydro2d.materials import curves
from hydro2d.materials.material import Material


@dataclass(frozen=True)
class Curve:
    """A material at one rate (1/s): its flow stress (Pa) and temperature (K) at plastic strains.

    start : temperature at zero strain, K; None: that of the material at rest
    """

    material: Material
    rate: float
    isothermal: bool
    strains: tuple[float, ...]
    stress: np.ndarray
    temperature: np.ndarray
    start: float | None = None

    @classmethod
    def of(cls, material: Material, rate: float, strains: Sequence[float], isothermal: bool = False,
           start: float | None = None) -> Curve:
        """Raises DeckError for a material without strength, or without the data for its heating."""
        stress, temperature = curves.flow_stress(material, rate, strains, isothermal=isothermal, temperature=start)
        return cls(material, rate, isothermal, tuple(strains), stress, temperature, start)

    def at(self, strains: Sequence[float]) -> Curve:
        """This curve at other strains."""
        return Curve.of(self.material, self.rate, strains, self.isothermal, self.start)

    @property
    def name(self) -> str:
        return f"{self.material.name} ({self.material.strength.name})"


def lines(all_curves: Sequence[Curve]) -> list[str]:
    """A table in MPa: a row for each material and rate, a column for each strain."""
    rows = [("material", "rate [1/s]", *(f"{strain:g}" for strain in all_curves[0].strains))]
    rows += [(each.name, f"{each.rate:g}", *(f"{stress / 1e6:.0f}" for stress in each.stress)) for each in all_curves]
    widths = [max(len(row[n]) for row in rows) for n in range(len(rows[0]))]
    how = "at a constant temperature" if all_curves[0].isothermal else "heated by its plastic work"
    start = all_curves[0].start
    how += "" if start is None else f", from {start:g} K on"
    heading = f"flow stress [MPa] at zero pressure against plastic strain, {how}"
    table = ("  ".join(cell.ljust(w) if n == 0 else cell.rjust(w) for n, (cell, w) in enumerate(zip(row, widths, strict=True)))
             for row in rows)
    return [heading, "", *table]


def write_csv(all_curves: Sequence[Curve], path: Path) -> None:
    """Writes one row for each material, rate and strain, with all digits."""
    with replacing(path) as temporary, open(temporary, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["material", "model", "rate [1/s]", "plastic strain", "flow stress [Pa]", "temperature [K]"])
        for each in all_curves:
            for strain, stress, T in zip(each.strains, each.stress, each.temperature, strict=True):
                row = [cell(each.material.name), each.material.strength.name, each.rate, strain, float(stress), float(T)]
                writer.writerow(row)


def draw(all_curves: Sequence[Curve]):
    """A matplotlib Figure: a colour for each material, a line style for each rate."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from hydro2d.analytic.model_figures import COLOURS

    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    names = list(dict.fromkeys(each.name for each in all_curves))
    rates = sorted({each.rate for each in all_curves})
    for each in all_curves:
        colour = COLOURS[names.index(each.name) % len(COLOURS)]
        dash = ("-", "--", ":", "-.")[rates.index(each.rate) % 4]
        axes.plot(each.strains, each.stress / 1e6, dash, color=colour, label=in_legend(f"{each.name}, {each.rate:g} /s"))
    axes.set_xlabel("plastic strain")
    axes.set_ylabel("flow stress [MPa]")
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    return figure
