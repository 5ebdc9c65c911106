"""Runs the decks of this folder and compares what they give with results/expected.csv, which was written before the first run.

    python -m problems.handbook.compare RUNS [DECK ...]

RUNS is the folder of the runs; runs that are there are not made again. Prints a row for each quantity, as the README has them.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np

import hydro2d
from problems import kept

FOLDER = Path(__file__).parent
EXPECTED, OBTAINED = FOLDER / "results" / "expected.csv", FOLDER / "results" / "obtained.csv"
COLUMNS = ("deck", "quantity", "obtained", "trusted", "method")
#: density of water, kg/m^3, and speed of the wedge, m/s
WATER, SLAM = 998.2, 100.0
#: decks that were changed after their first run; the README says how
CHANGED = ("bubble", "water_hammer", "slam")
History = dict[str, Any]


def expected() -> list[dict[str, str]]:
    """Rows of the file of what is expected, without its comment."""
    return kept.rows(EXPECTED, ("deck", "quantity", "unit", "expected", "bound", "source"))


def obtained() -> dict[tuple[str, str], dict[str, str]]:
    """The kept rows by deck and quantity."""
    return {(row["deck"], row["quantity"]): row for row in kept.rows(OBTAINED, COLUMNS)}


def swing(time: np.ndarray, moved: np.ndarray, guess: float) -> tuple[float, float]:
    """Mean and period of a displacement that swings: least squares of a mean, a cosine and a sine; guess : of the period."""

    def fitted(period: float) -> tuple[float, np.ndarray]:
        phase = 2.0 * np.pi * time / period
        columns = np.column_stack([np.ones_like(time), np.cos(phase), np.sin(phase)])
        found, *_ = np.linalg.lstsq(columns, moved, rcond=None)
        return float(((columns @ found - moved) ** 2).sum()), found

    period = min(np.linspace(0.8 * guess, 1.2 * guess, 2001), key=lambda each: fitted(each)[0])
    return float(fitted(period)[1][0]), float(period)


def bubble(h: History) -> Iterator[tuple[str, float]]:
    """The extrapolated end of the radius, whose power 5/2 falls linearly at last (Rayleigh): from .5 to .25 mm."""
    radius = np.cbrt(3.0 * h["cavity"])
    late = (radius < 0.5e-3) & (radius > 0.25e-3)
    slope, start = np.polyfit(h["time"][late], radius[late] ** 2.5, 1)
    yield "time of collapse", -1e6 * start / slope


def water_hammer(h: History) -> Iterator[tuple[str, float]]:
    """The front is where half of the pressure is; speed from 100 to 300 mm; pressure from 40 us behind it, at 100 mm."""
    pressure, time = h["gauge_pressure_Pa"], h["time"]
    arrived = [time[int(np.argmax(column > 1.15e6))] for column in pressure.T]
    yield "speed of the front", 0.2 / (arrived[5] - arrived[1])
    yield "pressure", 1e-6 * float(pressure[time > arrived[1] + 40e-6, 1].mean())


def bird(h: History) -> Iterator[tuple[str, float]]:
    """Means over 10 to 20 us and over 0.4 to 0.8 ms."""
    pressure, time = 1e-6 * h["gauge_pressure_Pa"][:, 0], h["time"]
    yield "pressure at first", float(pressure[(time > 10e-6) & (time < 20e-6)].mean())
    yield "pressure in steady flow", float(pressure[(time > 0.4e-3) & (time < 0.8e-3)].mean())


def tube(h: History) -> Iterator[tuple[str, float]]:
    moved = 1e6 * (h["tracer_r_m"][:, 0] - h["tracer_r_m"][0, 0])
    yield "period", 1e6 * swing(h["time"], moved, 57.83e-6)[1]
    yield "largest displacement", float(moved.max())


def cole(h: History) -> Iterator[tuple[str, float]]:
    """The median of three directions."""
    peaks = 1e-6 * h["gauge_pressure_Pa"].max(axis=0)
    yield "pressure at 0.6 m", float(np.median(peaks[0::2]))
    yield "pressure at 1 m", float(np.median(peaks[1::2]))


def reflected(h: History) -> Iterator[tuple[str, float]]:
    """Above the pressure of the air; on the axis, and on the ground."""
    peaks = 1e-6 * (h["gauge_pressure_Pa"].max(axis=0) - 101325.0)
    yield "incident pressure", float(peaks[5])
    yield "reflected pressure", float(peaks[0])


def plate(h: History) -> Iterator[tuple[str, float]]:
    mean, period = swing(h["time"], 1e6 * (h["tracer_z_m"][0, 0] - h["tracer_z_m"][:, 0]), 197.6e-6)
    yield "period", 1e6 * period
    yield "mean displacement of the middle", mean


def gun(h: History) -> Iterator[tuple[str, float]]:
    yield "velocity of the projectile", float(np.interp(0.5e-3, h["time"], h["body_projectile_velocity_m_s"]))


def bumper(h: History) -> Iterator[tuple[str, float]]:
    yield "diameter of the hole", 1e3 * h["targets"]["bumper"].crater.hole_diameter_m


def slam(h: History) -> Iterator[tuple[str, float]]:
    """From the momentum of the half of the wedge between 0.15 and 0.3 ms, and the largest pressure in the water then."""
    time = h["time"]
    during = (time > 0.15e-3) & (time < 0.3e-3)
    slope, _ = np.polyfit(time[during] ** 2, h["body_wedge_momentum_N_s"][during], 1)
    yield "force coefficient", float(4.0 * slope / (WATER * SLAM**3))
    yield "pressure coefficient", float(np.median(h["largest"][during]) / (0.5 * WATER * SLAM**2))


#: what reads a run, by the deck
READ: dict[str, Callable[[History], Iterator[tuple[str, float]]]] = {
    each.__name__: each for each in (bubble, water_hammer, bird, tube, cole, reflected, plate, gun, bumper, slam)}


def cavity(simulation: hydro2d.Simulation) -> float:
    """Volume of the void of the mesh per radian, m^3."""
    grid = simulation.grid
    return float((grid.volume * (1.0 - simulation.state.vof.sum(axis=0)))[grid.inside].sum())


def largest(simulation: hydro2d.Simulation) -> float:
    """The largest pressure in cells full of the second body, Pa."""
    full = simulation.array("vof")[1] > 0.999
    return float(simulation.array("p")[full].max())


#: further columns of a history
OF_HISTORY = {"bubble": {"cavity": cavity}, "slam": {"largest": largest}}


def rows_of(name: str, runs: Path) -> list[dict[str, str]]:
    """The rows of a deck, which is run unless it has been."""
    place = runs / name
    if not (place / "summary.json").exists():
        hydro2d.run(FOLDER / f"{name}.toml", place, threads=1, overwrite=True, quiet=True, columns=OF_HISTORY.get(name))
    results = hydro2d.open_run(place)
    trusted = "yes" if results.summary.trustworthy else "no"
    with h5py.File(place / "history.h5") as file:
        history = {key: entry[:] for key, entry in file.items() if isinstance(entry, h5py.Dataset) and entry.ndim}
    found = dict(READ[name](history | {"targets": results.summary.targets}))
    rows = [row for row in expected() if row["deck"] == name]
    assert [row["quantity"] for row in rows] == list(found), name
    return [{"deck": name, "quantity": quantity, "obtained": f"{value:.4g}", "trusted": trusted,
             "method": results.summary.method} for quantity, value in found.items()]


def line(row: dict[str, str], found: dict[str, str]) -> str:
    """A row of the table of the README."""
    value, target, unit = float(found["obtained"]), float(row["expected"]), f" {row['unit']}" if row["unit"] else ""
    return (f"| `{row['deck']}.toml` | {row['quantity']} | {row['expected']}{unit} | {found['obtained']}{unit} | "
            f"{100.0 * (value / target - 1.0):+.1f} % | {row['bound']} % | {found['trusted']} |")


def table(found: dict[tuple[str, str], dict[str, str]]) -> list[str]:
    """Lines of the table of the README for these rows, by deck and quantity."""
    return [line(row, found[key]) for row in expected() if (key := (row["deck"], row["quantity"])) in found]


def main(arguments: list[str]) -> int:
    runs, names = Path(arguments[0]), arguments[1:] or list(READ)
    rows = [row for name in names for row in rows_of(name, runs)]
    if names == list(READ):
        kept.write(OBTAINED, COLUMNS, rows)
    print("\n".join(table({(row["deck"], row["quantity"]): row for row in rows})))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
