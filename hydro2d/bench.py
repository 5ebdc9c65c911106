"""`hydro2d bench`: time per cell and cycle, phase by phase, beside a triad measured in the same run.

A triad update moves 24 bytes (two reads, one write of a double). Times are those of the whole mesh: the active region is
off, so that every cell that is not void costs what it costs in the middle of a shot.
"""

from __future__ import annotations

import json as json_format
import statistics
import time
from pathlib import Path

import numpy as np

from hydro2d import deck as decks
from hydro2d import jit, provenance
from hydro2d.kernels.triad import triad
from hydro2d.simulation import Simulation

DECK = "problems/cth_nose_shape/hemi_5083_1086.toml"
WARM_CYCLES, TIMED_CYCLES = 60, 60
TRIAD_SHAPE, TRIAD_REPEATS = (2000, 4000), 9
BYTES_PER_UPDATE = 24

#: name of a case -> overrides of the deck
CASES = {
    "slip layer, ke": (),
    "slip layer, momentum": ('numerics.advection="momentum"',),
    "slip layer, both": ('numerics.advection="both"',),
    "no sliding treatment, ke": ('sliding.method="none"',),
}


def triad_bandwidth() -> float:
    """Median bandwidth of the triad with the present number of threads, GB/s."""
    a, b, c = (np.full(TRIAD_SHAPE, value) for value in (0.0, 1.0, 2.0))
    seconds = []
    for _ in range(TRIAD_REPEATS):
        start = time.perf_counter()
        triad(0, TRIAD_SHAPE[0], 3.0, b, c, a)
        seconds.append(time.perf_counter() - start)
    return BYTES_PER_UPDATE * a.size / statistics.median(seconds[1:]) / 1e9


def measure(overrides: tuple[str, ...], bandwidth: float) -> dict:
    """One case with the present number of threads: ns per cell and cycle, in all and by phase (kernel)."""
    simulation = Simulation(decks.load(DECK, ("numerics.active_region=false", *overrides)))
    for _ in range(WARM_CYCLES):
        simulation.step()
    jit.profiling(True)
    start = time.perf_counter()
    for _ in range(TIMED_CYCLES):
        simulation.step()
    seconds = time.perf_counter() - start
    phases = {name: spent for name, (spent, _) in jit.timings.items()}
    jit.profiling(False)
    phases["between kernels"] = seconds - sum(phases.values())
    cells = simulation.grid.cells
    to_ns = 1e9 / (cells * TIMED_CYCLES)
    return {
        "threads": jit.threads(),
        "cells": cells,
        "ns_per_cell_cycle": seconds * to_ns,
        "triad_updates_per_cell_cycle": seconds * to_ns * bandwidth / BYTES_PER_UPDATE,
        "phases": {name: spent * to_ns for name, spent in sorted(phases.items(), key=lambda item: -item[1])},
    }


def main(json: Path | None = None) -> int:
    """Runs every case on one thread and on all, prints a table, and writes it as JSON where a file is named."""
    about = provenance.collect(jit.max_threads())
    result = {"provenance": about, "triad_gb_s": {}, "cases": []}
    for threads in sorted({1, jit.max_threads()}):
        jit.set_threads(threads)
        bandwidth = triad_bandwidth()
        result["triad_gb_s"][str(threads)] = bandwidth
        print(f"\n{threads} thread(s): triad {bandwidth:.1f} GB/s")
        for name, overrides in CASES.items():
            case = {"name": name, **measure(overrides, bandwidth)}
            result["cases"].append(case)
            print(f"  {name:28s} {case['ns_per_cell_cycle']:7.1f} ns per cell and cycle, "
                  f"{case['triad_updates_per_cell_cycle']:6.1f} triad updates ({case['cells']} cells)")
            if name == next(iter(CASES)):
                for phase, spent in case["phases"].items():
                    print(f"      {phase:26s} {spent:7.1f} ns  {100 * spent / case['ns_per_cell_cycle']:5.1f} %")
    if json is not None:
        Path(json).write_text(json_format.dumps(result, indent=1))
        print(f"wrote {json}")
    return 0
