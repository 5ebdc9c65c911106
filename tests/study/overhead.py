"""Cost of a sweep beyond its cases: `python -m tests.study.overhead [CASES] [WORKERS]`.

The cases' own time is the sum of the times that run_case took in the workers. A case's first call in a process also loads
its kernels from the cache; this counts as the case's. The sweep is timed as a command, from start to exit.
"""

from __future__ import annotations

import re
import sys
import tempfile
import time
from pathlib import Path

from hydro2d.study.records.study_directory import load
from tests.study import tubes

STUDY = """
title = "Many tubes"
deck = "tube.toml"
[set]
stop.time = 0.2
output.vtk_interval = 0.05
[[axis]]
name = "pressure"
key = "body.low.pressure"
range = {{ from = 0.1, to = 0.3, count = {cases} }}
"""


def measure(cases: int, workers: int) -> tuple[float, float]:
    """Wall time of the sweep and the cases' own time, s."""
    with tempfile.TemporaryDirectory() as folder:
        file, out = tubes.write(Path(folder), STUDY.format(cases=cases)), Path(folder) / "out"
        started = time.perf_counter()
        status, said = tubes.sweep(file, "--workers", workers, "--out", out)
        wall = time.perf_counter() - started
        if status:
            raise SystemExit(said)
        text = (out / "sweep.log").read_text()
        own = float(re.search(r"the cases took ([\d.]+) s", text).group(1))
        simulated = sum(case.summary["wall_s"] for case in load(out).cases)
    print(f"{cases} cases on {workers} workers: {wall:.1f} s, the cases' own time {own:.1f} s (cycles alone {simulated:.1f} s)")
    print(f"{own / workers:.1f} s for each worker, {100 * (wall * workers / own - 1):.1f} % over")
    return wall, own


if __name__ == "__main__":
    measure(*map(int, sys.argv[1:] or (100, 2)))
