"""Errors of problems with exact solutions on three meshes: runs those not yet run, and prints a table for each.

    python -m problems.verification.table RUNS [PROBLEM ...] [--keep]

RUNS is the folder of the runs. `--keep` writes numbers and curves into `results`; without RUNS the tables show the numbers kept
there. Costs are seconds of one core.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from pathlib import Path

import hydro2d
from problems import kept
from problems.verification.accuracy import BY_NAME, FOLDER, PROBLEMS, Problem

RESULTS = FOLDER / "results"
NUMBERS, CURVES = RESULTS / "accuracy.csv", RESULTS / "accuracy_curves.csv"
COLUMNS = ("problem", "variant", "cells", "quantity", "unit", "exact", "found", "error_percent", "status", "time_s", "seconds",
           "cycles", "method")
CURVE_COLUMNS = ("problem", "cells", "x", "y")
#: the file in the directory of a run that records its seconds on one core
COST = "cost.json"
#: the most points kept of a curve
MOST = 120
#: no order is given if all errors are smaller than this, per cent
LEAST = 0.5


def directory(runs: Path, problem: Problem, variant: str, cells: int) -> Path:
    """The directory of a run."""
    return runs / f"{problem.name}_{variant}_{cells}"


def run(runs: Path, problem: Problem, variant: str, cells: int) -> None:
    """Runs a case unless it has been run, on one core, with everything compiled before the clock starts."""
    place = directory(runs, problem, variant, cells)
    if (place / COST).exists():
        return
    deck = hydro2d.Deck.from_file((FOLDER / problem.deck).resolve(), problem.overrides(variant, cells))
    hydro2d.Simulation(deck).step()
    begun = time.process_time()
    try:
        hydro2d.run(deck, place, threads=1, overwrite=True, quiet=True, columns=problem.columns)
    except hydro2d.UnphysicalState as error:
        print(error, file=sys.stderr)
    (place / COST).write_text(json.dumps({"seconds": round(time.process_time() - begun, 2)}))


def rows_of(runs: Path, problem: Problem, variant: str, cells: int) -> list[dict[str, object]]:
    """The rows of a run: one for each quantity that it has, or one without a quantity if it became unphysical."""
    place = directory(runs, problem, variant, cells)
    results = hydro2d.open_run(place)
    facts = results.summary
    status = facts.status if facts.status != "done" else "trusted" if facts.trustworthy else "not trusted"
    common = {"problem": problem.name, "variant": variant, "cells": cells, "status": status, "time_s": f"{facts.time_s:.6g}",
              "seconds": json.loads((place / COST).read_text())["seconds"], "cycles": facts.cycles,
              "method": facts.method}
    if facts.status != "done":
        return [common]
    return [common | {"quantity": each.name, "unit": each.unit, "exact": f"{each.exact:.7g}", "found": f"{each.found:.7g}",
                      "error_percent": f"{each.error:.4g}"} for each in problem.measure(results, cells)
            if math.isfinite(each.found)]


def curve_of(runs: Path, problem: Problem, cells: int) -> list[dict[str, object]]:
    """The rows of the curve of a run of the first variant."""
    x, y = problem.curve(hydro2d.open_run(directory(runs, problem, next(iter(problem.variants)), cells)))
    every = math.ceil(len(x) / MOST)
    return [{"problem": problem.name, "cells": cells, "x": f"{a:.4g}", "y": f"{b:.4g}"}
            for a, b in zip(x[::every], y[::every], strict=True)]


def order(cells: list[int], errors: list[float]) -> str:
    """Observed order from the coarsest to the finest mesh; empty where the errors do not define one."""
    small = min(map(abs, errors), default=0.0) < 0.01 or max(map(abs, errors)) < LEAST
    if len(cells) < 2 or small or errors[0] * errors[-1] < 0.0:
        return ""
    return f"{math.log(abs(errors[0] / errors[-1])) / math.log(cells[-1] / cells[0]):.1f}"


def shown(error: str) -> str:
    """An error in per cent with two digits or, if it is small, two places."""
    value = float(error)
    if abs(value) < 0.005:
        return "0.00"
    return f"{value:+.1f}" if abs(value) >= 1.0 else f"{value:+.2f}"


def table(problem: Problem, rows: list[dict[str, str]]) -> list[str]:
    """Lines of Markdown: for each variant a row for each quantity, with errors by mesh and order, and one with the cost."""
    meshes = [str(cells) for cells in problem.cells]
    several = len(problem.variants) > 1
    lines = [f"| cells {problem.resolution} |{' advection |' if several else ''} exact | {' | '.join(meshes)} | order |",
             "|---" * (3 + several + len(meshes)) + "|"]
    for variant in problem.variants:
        mine = [row for row in rows if row["problem"] == problem.name and row["variant"] == variant]
        label = f" `{variant}` |" if several else ""
        by_mesh = {cells: [row for row in mine if row["cells"] == cells] for cells in meshes}
        ended = {cells: by_cells[0]["status"] for cells, by_cells in by_mesh.items() if by_cells}
        for name in dict.fromkeys(row["quantity"] for row in mine if row["quantity"]):
            by_cells = {row["cells"]: row for row in mine if row["quantity"] == name}
            first = next(iter(by_cells.values()))
            unit = f" {first['unit']}" if first["unit"] else ""
            exact = "0" if float(first["exact"]) == 0.0 else f"{float(first['exact']):.5g}{unit}"
            cells = " | ".join(f"{shown(by_cells[each]['error_percent'])} %" if each in by_cells else "" for each in meshes)
            there = [each for each in meshes if each in by_cells]
            rate = order([int(each) for each in there], [float(by_cells[each]["error_percent"]) for each in there])
            lines.append(f"| {name} |{label} {exact} | {cells} | {rate} |")
        cost = " | ".join(f"{float(by_mesh[each][0]['seconds']):.3g} s" + _verdict(by_mesh[each][0]) if each in ended else ""
                          for each in meshes)
        lines.append(f"| *cost* |{label} | {cost} | |")
    return lines


def _verdict(row: dict[str, str]) -> str:
    if row["status"] == "trusted":
        return ""
    return f", **{row['status']}**" + (f" at {float(row['time_s']):.3g} s" if row["status"] == "unphysical" else "")


def main(arguments: list[str] | None = None) -> int:
    """Runs, prints the tables and keeps the numbers. Returns 2 if a run cannot begin."""
    parser = argparse.ArgumentParser(prog="python -m problems.verification.table", description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="?", type=Path, help="the folder of the runs; default: the numbers that are kept")
    parser.add_argument("problems", nargs="*", choices=[[], *BY_NAME], metavar="PROBLEM", help="default: all")
    parser.add_argument("--keep", action="store_true", help="write numbers and curves into results")
    given = parser.parse_args(arguments)
    chosen = [BY_NAME[name] for name in given.problems] or list(PROBLEMS)
    rows = kept.rows(NUMBERS, COLUMNS) if NUMBERS.exists() else []
    curves = kept.rows(CURVES, CURVE_COLUMNS) if CURVES.exists() else []
    if given.runs:
        for problem in chosen:
            try:
                for variant in problem.variants:
                    for cells in problem.cells:
                        run(given.runs, problem, variant, cells)
            except hydro2d.Error as error:
                print(f"{problem.name}: {error}", file=sys.stderr)
                return 2
            fresh = [{name: str(value) for name, value in row.items()} for variant in problem.variants
                     for cells in problem.cells for row in rows_of(given.runs, problem, variant, cells)]
            rows = [row for row in rows if row["problem"] != problem.name] + [dict.fromkeys(COLUMNS, "") | row for row in fresh]
            curves = [row for row in curves if row["problem"] != problem.name]
            curves += [row for cells in problem.cells for row in curve_of(given.runs, problem, cells)]
    if given.keep:
        place = {name: number for number, name in enumerate(BY_NAME)}
        kept.write(NUMBERS, COLUMNS, sorted(rows, key=lambda row: place[row["problem"]]))
        kept.write(CURVES, CURVE_COLUMNS, sorted(curves, key=lambda row: place[row["problem"]]))
    for problem in chosen:
        if any(row["problem"] == problem.name for row in rows):
            print("\n".join([f"### {problem.title}", "", *table(problem, rows), ""]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
