"""Prints results of runs of these decks and the expected values: `python -m problems.explosives.read RUN [RUN ...]`.

A row has the deck, the explosive, the quantity, the expected value, its source, and the value obtained. The rows that the
README shows are kept in results/explosives.csv.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import h5py
import numpy as np

import hydro2d
from problems import kept as results

KEPT = Path(__file__).parent / "results" / "explosives.csv"
COLUMNS = ("deck", "explosive", "quantity", "unit", "expected", "source", "obtained", "method")

#: wall velocity at 6 and 19 mm, km/s
CYLINDER = {"TNT": (1.21, 1.42), "comp_B": (1.44, 1.63), "PBX9404": (1.61, 1.80)}
#: time at which the shock from the wall is well under way, s
ARRIVED = 7.8e-6
#: Gurney's velocity sqrt(2 E), km/s
GURNEY = {"TNT": 2.37, "comp_B": 2.70, "PBX9404": 2.90}
HANDBOOK = "Dobratz & Crawford, UCRL-52997 (1985) [recalled]"
FORMULA = "Gurney's formula, sqrt(2 E) of the same handbook [recalled]"
#: pressure over P_CJ at a rigid wall hit by TNT in its Chapman-Jouguet state
REFLECTED = 2.266


def gurney(form: str, ratio: float) -> float:
    """Velocity of the metal over sqrt(2 E), by the ratio of its mass to that of the explosive.

    form : "cylinder", "sandwich" (the half of a symmetric one) or "open" (an open-faced sandwich)
    """
    if form == "open":
        return (((1.0 + 2.0 * ratio) ** 3 + 1.0) / (6.0 * (1.0 + ratio)) + ratio) ** -0.5
    return (ratio + {"cylinder": 1.0 / 2.0, "sandwich": 1.0 / 3.0}[form]) ** -0.5


def _mass_ratio(file) -> float:
    """Mass of the metal over that of the explosive at the start."""
    metal = next(name for name in ("tube", "plate") if f"body_{name}_mass_kg" in file)
    return float(file[f"body_{metal}_mass_kg"][0] / file["body_charge_mass_kg"][0])


def of_run(directory: Path) -> list[tuple]:
    """The rows of a run, in the order of COLUMNS; velocities in km/s."""
    deck = hydro2d.Deck.from_file(directory / "deck.toml")
    explosive, method = deck.materials[deck.body[0].material].name, hydro2d.open_run(directory).summary.method
    rows: list[tuple] = []
    if deck.name == "against_a_wall":
        with h5py.File(directory / "history.h5") as file:
            pressure = float(np.mean(file["gauge_pressure_Pa"][:, 0][file["time"][:] > ARRIVED])) * 1e-9
        cj = deck.materials["charge"].eos.values["cj_pressure"] * 1e-9
        return [(deck.name, "TNT", "pressure at the wall", "GPa", round(REFLECTED * cj, 2), "shock relations",
                 round(pressure, 2), method)]
    with h5py.File(directory / "history.h5") as file:
        ratio = _mass_ratio(file)
        if deck.name == "cylinder":
            moved = file["tracer_r_m"][:, 0] - file["tracer_r_m"][0, 0]
            speed = file["tracer_velocity_r_m_s"][:, 0] * 1e-3
            for distance, expected in zip((6, 19), CYLINDER[explosive], strict=True):
                rows.append((deck.name, explosive, f"wall velocity at {distance} mm", "km/s", expected, HANDBOOK,
                             round(float(np.interp(distance * 1e-3, moved, speed)), 3), method))
            form, final = "cylinder", float(speed.max())
        else:
            final = float(file["body_plate_velocity_m_s"][-1]) * 1e-3
            form = "sandwich" if deck.boundaries.z_min == "wall" else "open"
        expected = round(GURNEY[explosive] * gurney(form, ratio), 3)
        rows.append((deck.name, explosive, "final velocity", "km/s", expected, FORMULA, round(final, 3), method))
    return rows


def table(rows: list[dict[str, str]]) -> list[str]:
    """The rows of the kept file as lines of the README's table."""
    lines = ["| deck | explosive | quantity | expected | obtained | difference |", "|---|---|---|---|---|---|"]
    for row in rows:
        off = float(row["obtained"]) / float(row["expected"]) - 1.0
        lines.append(f"| `{row['deck']}.toml` | {row['explosive']} | {row['quantity']} | {row['expected']} {row['unit']} | "
                     f"{row['obtained']} {row['unit']} | {100 * off:+.1f} % |")
    return lines


def kept() -> list[dict[str, str]]:
    """The rows of results/explosives.csv."""
    return results.rows(KEPT, COLUMNS)


def main(arguments: list[str]) -> int:
    """Prints the rows of the runs as CSV."""
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(COLUMNS)
    for each in arguments:
        writer.writerows(of_run(Path(each)))
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
