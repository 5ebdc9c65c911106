"""The grind times of hydro2d on the machines on which they were measured: nanoseconds per cell and cycle.

    hydro2d bench --json bench.json
    python -m problems.grind_times [bench.json ...] [--check]

adds what `hydro2d bench` measured to grind_times.csv and fills the table of docs/explanation/speed.md from that file. The rows
of a case replace older ones of the same machine. Without a file the page is filled alone. With --check nothing is written,
and the status is 1 if the page has another table.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import hydro2d
from problems import kept

HERE = Path(__file__).parent
FILE = HERE / "grind_times.csv"
PAGE = HERE.parent / "docs" / "explanation" / "speed.md"
COLUMNS = ("processor", "cores", "date", "version", "commit", "case", "cells", "threads", "ns_per_cell_cycle", "triad_gb_s")
#: the cases of `hydro2d bench` that the page shows
SHOWN = ("no sliding treatment, ke", "slip layer, ke", "contact, ke", "pure hydrodynamic", "10 thousand cells",
         "400 thousand cells", "1 million cells")
HEADS = ("processor", "cores", "date", "deck", "cells", "1 thread", "all threads")

Row = dict[str, str]


def of_bench(path: Path) -> list[Row]:
    """The rows of a file that `hydro2d bench --json` wrote. Raises StudyError, OSError."""
    try:
        measured = json.loads(path.read_text(encoding="utf-8"))
        about = measured["provenance"]
        machine = {"processor": about["cpu"], "cores": str(about["cpu_count"]), "date": about["written"][:10],
                   "version": about["version"], "commit": (about["git_commit"] or "")[:12]}
        return [machine | {"case": case["name"], "cells": str(case["cells"]), "threads": str(case["threads"]),
                           "ns_per_cell_cycle": f"{case['ns_per_cell_cycle']:.4g}", "triad_gb_s": f"{case['triad_gb_s']:.3g}"}
                for case in measured["cases"]]
    except (ValueError, KeyError, TypeError) as problem:
        raise hydro2d.StudyError(f"{path}: is no file of `hydro2d bench --json`: {problem!r}") from None


def added(old: list[Row], new: list[Row]) -> list[Row]:
    """All rows, those of cases that a machine measured anew replaced."""
    cases = {(row["processor"], row["cores"], row["case"]) for row in new}
    return [*(row for row in old if (row["processor"], row["cores"], row["case"]) not in cases), *new]


def table(rows: list[Row]) -> list[str]:
    """Lines of Markdown: a row for each machine and case, with its time on one thread and on all."""
    lines = [f"| {' | '.join(HEADS)} |", "|---" * len(HEADS) + "|"]
    for (processor, cores, date, case), members in kept.grouped(rows, ("processor", "cores", "date", "case")).items():
        if case not in SHOWN:
            continue
        times = {int(row["threads"]): f"{float(row['ns_per_cell_cycle']):.0f}" for row in members}
        most = max(times)
        of_all = f"{times[most]} ({most})" if most > 1 else ""
        cells = (processor, cores, date, case, members[0]["cells"], times.get(1, ""), of_all)
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def main(arguments: list[str] | None = None) -> int:
    """Adds measurements and fills the page. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, help="files of `hydro2d bench --json`")
    parser.add_argument("--check", action="store_true")
    given = parser.parse_args(arguments)
    try:
        rows = kept.rows(FILE, COLUMNS)
        for path in given.files:
            rows = added(rows, of_bench(path))
        if given.files and not given.check:
            kept.write(FILE, COLUMNS, rows)
        return kept.fill([PAGE], {"grind_times": lambda: table(rows)}, given.check)
    except (hydro2d.Error, OSError) as problem:
        print(problem, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
