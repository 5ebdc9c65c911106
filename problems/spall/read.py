"""Prints the free-surface velocities of runs of these decks: `python -m problems.spall.read RUN [RUN ...]`.

A row has the shot, the failure model, the cells across the target, the highest velocity of the surface, the lowest after it,
the pull-back between them and the rebound after it, whether the run is trusted, and the version of its method. The rows that
the README shows are kept in results/spall.csv.
"""

from __future__ import annotations

import sys
from pathlib import Path

import h5py
import numpy as np

import hydro2d
from problems import kept as results

KEPT = Path(__file__).parent / "results" / "spall.csv"
COLUMNS = ("shot", "failure", "cells", "top_m_s", "lowest_m_s", "pull_back_m_s", "rebound_m_s", "trusted", "method")
#: rise of the velocity that a lowest one must be followed by, m/s: less is a ripple
RISE = 20.0
#: thickness of the target, m
THICKNESS = 4e-3


def pull_back(velocity: np.ndarray) -> tuple[float, float, float]:
    """(highest, lowest after it, highest after that) velocity of a free surface, m/s.

    The lowest is the first from which the velocity rises by RISE. Raises ValueError if there is none: nothing has spalled.

    velocity : float64[n], m/s, over time
    """
    after = velocity[int(velocity.argmax()):]
    lowest = np.minimum.accumulate(after)
    risen = np.flatnonzero(after > lowest + RISE)
    if risen.size == 0:
        raise ValueError("the velocity of the surface does not rise again: nothing has spalled")
    least = float(lowest[risen[0]])
    return float(after[0]), least, float(after[risen[0]:].max())


def of_run(directory: Path) -> tuple:
    """The row of a run, in the order of COLUMNS."""
    deck = hydro2d.Deck.from_file(directory / "deck.toml")
    with h5py.File(directory / "history.h5") as file:
        top, lowest, rebound = pull_back(file["tracer_velocity_z_m_s"][:, 0])
    size = float(np.diff(deck.edges()[1]).min())
    failure = "cracks" if deck.failure.damage == "material" else "plain"
    numbers = top, lowest, top - lowest, rebound - lowest
    return (deck.name, failure, round(THICKNESS / size), *(round(each, 1) for each in numbers),
            *results.standing(hydro2d.open_run(directory).summary))


def kept() -> list[dict[str, str]]:
    """The rows of results/spall.csv."""
    return results.rows(KEPT, COLUMNS)


def table(rows: list[dict[str, str]]) -> list[str]:
    """The rows of the kept file as lines of the README's table, each compared with that of the finest mesh."""
    lines = ["| deck | failure | cells | highest | lowest | pull-back | against 400 cells | rebound |",
             "|---|---|---|---|---|---|---|---|"]
    finest = {(row["shot"], row["failure"]): float(row["pull_back_m_s"]) for row in rows if row["cells"] == "400"}
    for row in rows:
        off = float(row["pull_back_m_s"]) / finest[row["shot"], row["failure"]] - 1.0
        lines.append(f"| `{row['shot']}.toml` | {row['failure']} | {row['cells']} | {row['top_m_s']} | {row['lowest_m_s']} | "
                     f"{row['pull_back_m_s']} | {100 * off:+.1f} % | {row['rebound_m_s']} |")
    return lines


def main(arguments: list[str]) -> int:
    """Prints the rows of the runs as CSV, and reports runs in which nothing has spalled."""
    results.show(COLUMNS, of_run, arguments)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
