"""Temperatures along the Hugoniots of metals of the library, their melting lines, and published values.

    python -m problems.verification.hugoniot [--keep]

prints both tables: temperature and melting temperature at given pressures, then published values and those that the equation
of state and the melting line give. `--keep` writes them into `results` as well. Nothing is run: a state follows from the jump
conditions and the equation of state alone, without strength.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from hydro2d.materials import library
from hydro2d.measure import reach
from problems import kept
from strength import melting

FOLDER = Path(__file__).parent
PUBLISHED = FOLDER / "published_temperatures.csv"
#: the metals of the first table: those whose melting line is that of the metal or of its alloy
METALS = ("Al6061_T6", "Al2024_T4", "Al7075_T6", "copper_OFHC", "iron_Armco", "tantalum", "tungsten", "W_alloy", "uranium",
          "lead")
PRESSURES = (20, 50, 100, 150, 200, 250, 300)
#: particle velocities between which a state is sought, m/s
SLOWEST, FASTEST = 1.0, 9e3
#: energy up to which melting at zero pressure is sought, J/kg
HOTTEST = 2e6
#: quantities compared: the words of the table, and the columns in the list of published values
QUANTITIES = {
    "temperature": ("temperature, K", "temperature_K", "temperature_error_K"),
    "melting": ("melting pressure, GPa", "pressure_GPa", "pressure_error_GPa"),
    "melting without pressure": ("melting temperature at 0 GPa, K", "temperature_K", "temperature_error_K"),
}

CURVES = "material", "pressure_GPa", "compression", "temperature_K", "melting_temperature_K"
BESIDE = "material", "quantity", "published", "error", "source", "confidence", "at_GPa", "obtained", "difference_percent"


class Metal:
    """A material of the library: states on its Hugoniot, and its melting line."""

    def __init__(self, name: str):
        self.name, material = name, library.load(name)
        model = material.eos.module("eos")
        self.rest = reach.Material(model.ID, model.row(material.eos.values), np.zeros(0), material.reference_density, 0.0)
        self.line = melting.row({key: number.value for key, number in material.melting.items()})

    def state(self, pressure: float) -> tuple[float, float]:
        """(rho/rho0, T in K) on the Hugoniot at a pressure in Pa."""
        return self.behind(brentq(lambda u: self.behind(u)[2] - pressure, SLOWEST, FASTEST))[:2]

    def behind(self, u: float) -> tuple[float, float, float]:
        """(rho/rho0, T in K, p in Pa) behind a shock with a particle velocity in m/s."""
        rho, e, p = reach.stagnation(self.rest, u)
        return rho / self.rest.rho, self.rest.evaluate(rho, e)[3], p

    def melts_at(self) -> float:
        """The pressure at which the Hugoniot meets the melting line, Pa."""
        def above(u: float) -> float:
            eta, T, _ = self.behind(u)
            return T - melting.temperature(eta, self.line)

        return self.behind(brentq(above, SLOWEST, FASTEST))[2]

    def melts_without_pressure(self) -> float:
        """The temperature at which it melts at zero pressure, K."""
        from eos.dispatch import zero_pressure_density

        def state(e: float) -> tuple[float, float]:
            rho = zero_pressure_density(self.rest.model, self.rest.rho, e, self.rest.internal, self.rest.par)
            return rho / self.rest.rho, self.rest.evaluate(rho, e)[3]

        def above(e: float) -> float:
            eta, T = state(e)
            return T - melting.temperature(eta, self.line)

        return state(brentq(above, 0.0, HOTTEST))[1]


def curves() -> list[dict[str, object]]:
    """Rows of the first table, by CURVES."""
    rows = []
    for metal in map(Metal, METALS):
        for pressure in PRESSURES:
            eta, T = metal.state(1e9 * pressure)
            rows.append(dict(zip(CURVES, (metal.name, pressure, f"{eta:.3f}", f"{T:.0f}",
                                          f"{melting.temperature(eta, metal.line):.0f}"), strict=True)))
    return rows


def beside() -> list[dict[str, object]]:
    """Rows of the second table, by BESIDE: temperatures in K, melting pressures in GPa."""
    columns = ("material", "quantity", "pressure_GPa", "pressure_error_GPa", "temperature_K", "temperature_error_K", "how",
               "source", "confidence")
    rows = []
    for row in kept.rows(PUBLISHED, columns):
        metal, quantity = Metal(row["material"]), row["quantity"]
        words, value, error = QUANTITIES[quantity]
        at = row["pressure_GPa"] if quantity == "temperature" else ""
        if quantity == "melting":
            ours = 1e-9 * metal.melts_at()
        else:
            ours = metal.state(1e9 * float(at))[1] if at else metal.melts_without_pressure()
        rows.append(dict(zip(BESIDE, (
            metal.name, words, row[value], row[error], f"{row['source']} ({row['how']})", row["confidence"], at, f"{ours:.0f}",
            f"{100 * (ours / float(row[value]) - 1):+.0f}"), strict=True)))
    return rows


def curve_table(rows: Sequence[dict]) -> list[str]:
    """The lines of the first table: a line for each metal, temperature over melting temperature at each pressure."""
    cells_of: dict[str, list[str]] = {}
    for row in rows:
        molten = float(row["temperature_K"]) >= float(row["melting_temperature_K"])
        cell = f"{row['temperature_K']} / {row['melting_temperature_K']}"
        cells_of.setdefault(str(row["material"]), []).append(f"**{cell}**" if molten else cell)
    lines = [f"| T / Tm, K | {' | '.join(f'{p} GPa' for p in PRESSURES)} |", "|---" * (len(PRESSURES) + 1) + "|"]
    return [*lines, *(f"| `{name}` | {' | '.join(cells)} |" for name, cells in cells_of.items())]


def beside_table(rows: Sequence[dict]) -> list[str]:
    """The lines of the second table."""
    lines = ["| metal | quantity | published | hydro2d | difference | source |", "|---|---|---|---|---|---|"]
    for row in rows:
        at = f" at {row['at_GPa']} GPa" if row["at_GPa"] else ""
        error = f" ± {row['error']}" if row["error"] else ""
        source = row["source"] + (", recalled" if row["confidence"] == "recalled" else "")
        lines.append(f"| `{row['material']}` | {row['quantity']}{at} | {row['published']}{error} | {row['obtained']} | "
                     f"{row['difference_percent']} % | {source} |")
    return lines


def main(arguments: Sequence[str] | None = None) -> int:
    """Prints the tables, and keeps them."""
    parser = argparse.ArgumentParser(prog="python -m problems.verification.hugoniot", description="Hugoniot temperatures")
    parser.add_argument("--keep", action="store_true", help="write the tables into results as CSV")
    given = parser.parse_args(arguments)
    first, second = curves(), beside()
    print("\n".join([*curve_table(first), "", *beside_table(second)]))
    if given.keep:
        kept.write(FOLDER / "results" / "hugoniot_temperatures.csv", CURVES, first)
        kept.write(FOLDER / "results" / "hugoniot_published.csv", BESIDE, second)
    return 0


if __name__ == "__main__":
    sys.exit(main())
