"""Prints the depths behind tiles in runs of these decks: `python -m problems.ceramics.read RUN [RUN ...]`.

A row has the cells across the radius of the rod, the ceramic and the thickness of its tile, the largest depth from the face of
the tile and that in the steel behind it. The rows that the README shows are kept in results/ceramics.csv, one for each member
of a case. The median of the rows of the same mesh whose tile is of steel is the reference.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median

import numpy as np

import hydro2d
from problems import kept as results

KEPT = Path(__file__).parent / "results" / "ceramics.csv"
COLUMNS = ("cells", "ceramic", "density_kg_m3", "thickness_mm", "depth_mm", "in_steel_mm", "trusted", "method")
#: density of the backing, kg/m^3
STEEL = 7850.0


def ended(directory: Path) -> hydro2d.Results:
    """The results of a run. Raises ValueError if it has not ended."""
    run = hydro2d.open_run(directory)
    if not run.summary:
        raise ValueError("the run has not ended")
    return run


def of_run(directory: Path) -> tuple:
    """The row of a run, in the order of COLUMNS; the depth in the steel is 0 where the rod ends in the tile."""
    run = ended(directory)
    rod, tile = map(run.deck.body_named, ("rod", "tile"))
    cells = 0.5 * rod.diameter / float(np.diff(run.deck.edges()[1]).min())
    thickness = (tile.z[1] - tile.z[0]) * 1e3
    depth = float(run.history["penetration_depth_m"].max()) * 1e3
    density = run.deck.materials[tile.material].eos.values["reference_density"]
    behind = max(depth - thickness, 0.0)
    return (round(cells, 1), tile.material, round(density), round(thickness, 3), round(depth, 2), round(behind, 2),
            *results.standing(run.summary))


def efficiency(saved: float, density: float, thickness: float) -> float:
    """Differential mass efficiency of a tile: mass of the steel that it saves over its own, per area.

    saved : depth in steel alone less that in the steel behind the tile, in the unit of thickness; density : kg/m^3.
    Yaziv, Rosenberg & Partom, 9th Int. Symp. Ballistics (1986), recalled.
    """
    return STEEL * saved / (density * thickness)


def kept() -> list[dict[str, str]]:
    """The rows of results/ceramics.csv."""
    return results.rows(KEPT, COLUMNS)


def cases(rows: list[dict[str, str]]) -> dict[tuple[str, ...], list[dict[str, str]]]:
    """The members of every case, by cells across the radius of the rod, ceramic and thickness of the tile, mm."""
    return results.grouped(rows, ("cells", "ceramic", "thickness_mm"))


def references(rows: list[dict[str, str]]) -> dict[str, float]:
    """Median depth in steel alone, mm, by cells across the radius of the rod."""
    return {cells: median(float(row["depth_mm"]) for row in members)
            for (cells, ceramic, _), members in cases(rows).items() if ceramic == "steel"}


def table(rows: list[dict[str, str]]) -> list[str]:
    """The rows of the kept file as lines of the README's table."""
    lines = ["| cells | tile | thickness | members | depth, mm | of it in steel, mm | saved | differential mass efficiency |",
             "|---|---|---|---|---|---|---|---|"]
    alone = references(rows)
    for (cells, ceramic, thickness), members in cases(rows).items():
        shown = f"| {cells} | `{ceramic}` | {float(thickness):g} mm | {len(members)} | {results.told(members, 'depth_mm')} | "
        if ceramic == "steel":
            lines.append(f"{shown}{results.told(members, 'depth_mm')} | | |")
            continue
        behind = median(float(row["in_steel_mm"]) for row in members)
        saved, least = alone[cells] - behind, "at least " if behind == 0.0 else ""
        gained = efficiency(saved, float(members[0]["density_kg_m3"]), float(thickness))
        lines.append(f"{shown}{results.told(members, 'in_steel_mm')} | {saved:.1f} mm | {least}{gained:.2f} |")
    return lines


def main(arguments: list[str]) -> int:
    """Prints the rows of the runs as CSV, and reports runs that have not ended."""
    results.show(COLUMNS, of_run, arguments)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
