"""`hydro2d bench`: time per cell and cycle, phase by phase, compared with a triad measured in the same run.

A triad update moves 24 bytes (two reads, one write of a double). The bandwidth of a shared machine drifts. It is therefore
measured before and after every case, and the case is compared with the better of both. Every time is the least of five batches,
since other work on the machine can only lengthen one. Cases run on the whole mesh, with the active region off, so a cell costs
as much as in the middle of a shot. `--shot` measures a deck as it is instead, with all its outputs, and where its time goes.
"""

from __future__ import annotations

import functools
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil

from hydro2d import jit
from hydro2d.base import moving
from hydro2d.base.interrupt import Interrupt
from hydro2d.base.terminal import duration, say, several
from hydro2d.deck import deck as decks
from hydro2d.files.whole import write_json
from hydro2d.jit.compilation import announced
from hydro2d.kernels.triad import triad
from hydro2d.output import snapshot
from hydro2d.output.directory import LOG
from hydro2d.running import bench_compilation, provenance, reporting, run
from hydro2d.solver.simulation import Simulation

DECK = bench_compilation.DECK
TRIAD_SHAPE = (2000, 4000)
BYTES_PER_UPDATE = 24
#: batches, of which the fastest counts
BATCHES = 5
#: a case takes a multiple of this number of cycles: slip zones are updated every few, and the order of sweeps alternates
CYCLES = 10
#: warm-up cycles on the mesh of the deck; largest number of measured cell-cycles, and of measured cycles per warm-up cycle
WARM_CYCLES, TIMED_WORK, TIMED_OVER_WARM = 60, 16e6, 2
WHOLE_SHOT = "whole shot"
#: cycles of a shot between the states in which its cycles are taken apart, and before the first one
STAGE, FIRST = 2000, 10
#: phases that are all for mixed cells, or for contact; what others do for them counts as time of the cells
GROUPS = {"deform_mixed": "mixed cells", "find_contact": "contact"}
CELLS, PYTHON = "cells", "Python between"

SHOT = """
include = "cth_nose_shape/hemi_5083_1086_layer.toml"
[numerics]
active_region = false
"""
FLUIDS = """
[sliding]
method = "none"
[[body]]
name = "rod"
material = "W_fluid"
[[body]]
name = "plate"
material = "Al_fluid"
[materials.W_fluid]
based_on = "W_alloy"
strength.model = "hydrodynamic"
[materials.Al_fluid]
based_on = "Al5083"
strength.model = "hydrodynamic"
"""
PURE = """
[mesh]
r = [{ to = "16 mm", cells = 128 }]
z = [{ to = "128 mm", cells = 1024 }]
[boundaries]
r_max = "wall"
z_max = "wall"
[[body]]
name = "plate"
material = "Al5083"
shape = "plate"
z_front = 0.0
thickness = "128 mm"
velocity = "400 m/s"
[numerics]
active_region = false
[stop]
time = "1 ms"
"""
MESH = """
[mesh]
r = [{{ to = "16.891 mm", cells = {near} }}, {{ to = "87.7 mm", ratio = {ratio!r} }}]
z = [{{ to = 0.0, cells = {behind} }}, {{ to = "546 mm", cells = {ahead} }}]
"""
LAYER = """
[[body]]
name = "{name}"
material = "Al5083"
shape = "plate"
z_front = "{front!r} m"
thickness = "{thickness!r} m"
"""


def layered(layers: int) -> str:
    """The shot with a plate of this many layers. Each is a body of the same material; only the number of bodies differs."""
    thickness = 0.5334 / layers
    names = ["plate", *(f"plate {n}" for n in range(2, layers + 1))]
    return SHOT + "".join(LAYER.format(name=name, front=n * thickness, thickness=thickness) for n, name in enumerate(names))


@dataclass(frozen=True)
class Case:
    """A deck as text, its overrides, and the number of cycles before the measurement."""

    name: str
    text: str = SHOT
    overrides: tuple[str, ...] = ()
    warm: int = WARM_CYCLES

    def deck(self) -> decks.Deck:
        return decks.loads(self.text, self.overrides, name=self.name)


def refined(name: str, factor: float) -> Case:
    """The shot with about factor^2 times as many cells, as whole cells allow, measured at about the same simulated time."""
    near, behind, ahead = (round(cells * factor) for cells in (40, 252, 1293))
    mesh = MESH.format(near=near, behind=behind, ahead=ahead, ratio=1.05 ** (1 / factor))
    return Case(name, SHOT + mesh, warm=CYCLES * round(WARM_CYCLES * factor / CYCLES))


CASES = (
    Case("slip layer, ke"),
    Case("slip layer, momentum", overrides=('numerics.advection="momentum"',)),
    Case("slip layer, both", overrides=('numerics.advection="both"',)),
    Case("contact, ke", overrides=('sliding.method="contact"', "sliding.yield_factor=1.5625")),
    Case("no sliding treatment, ke", overrides=('sliding.method="none"',)),
    Case("pure hydrodynamic", SHOT + FLUIDS),
    Case("single material", PURE),
    refined("10 thousand cells", 0.276),
    refined("35 thousand cells", 0.516),
    refined("130 thousand cells", 1.0),
    refined("400 thousand cells", 1.745),
    refined("1 million cells", 2.76),
    Case("2 materials", layered(1)),
    Case("3 materials", layered(2)),
    Case("4 materials", layered(3)),
)


class Bandwidth:
    """The bandwidth of the triad, measured at intervals.

    Attributes
    ----------
    seen : list of all measurements with the current number of threads, GB/s
    """

    def __init__(self):
        self.seen: list[float] = []

    def __call__(self) -> float:
        """Largest bandwidth of a few triads with the current number of threads, GB/s."""
        a, b, c = (np.full(TRIAD_SHAPE, value) for value in (0.0, 1.0, 2.0))
        triad(0, TRIAD_SHAPE[0], 3.0, b, c, a)
        seconds = _least(lambda: triad(0, TRIAD_SHAPE[0], 3.0, b, c, a))
        self.seen.append(BYTES_PER_UPDATE * a.size / seconds / 1e9)
        return self.seen[-1]


def timed_cycles(case: Case, cells: int) -> int:
    """Number of cycles of a batch, a multiple of CYCLES."""
    most = TIMED_OVER_WARM * case.warm
    return CYCLES * max(1, round(min(TIMED_WORK / cells, most) / BATCHES / CYCLES))


def _least(work: Callable[[], object]) -> float:
    """Seconds of the fastest of BATCHES calls."""
    return min(_seconds(work) for _ in range(BATCHES))


def _seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def _advance(simulation: Simulation, cycles: int) -> None:
    """Cycles as a run does them, by compiled code."""
    while cycles > 0:
        cycles -= simulation.advance(cycles=cycles)


def _phases(simulation: Simulation, cycles: int) -> dict[str, float]:
    """Seconds of cycles that Python goes through, by phase: those of the fastest of BATCHES batches."""
    batches = []
    for _ in range(BATCHES):
        jit.profiling(True)
        for _ in range(cycles):
            simulation.step()
        batches.append({name: spent for name, (spent, _) in jit.timings.items()})
        jit.profiling(False)
    return min(batches, key=lambda spent: sum(spent.values()))


def measure(case: Case, bandwidth: Bandwidth, cycles: int | None = None) -> dict:
    """One case with the current number of threads: ns per cell and cycle, in total and by phase.

    The total is that of cycles by compiled code; phases are timed in cycles that Python goes through, after these.

    cycles : number of cycles of a batch, after as many unmeasured ones; default: set by the case and its cells
    """
    simulation = Simulation(case.deck())
    cells = simulation.grid.cells
    _advance(simulation, cycles or case.warm)
    batch = cycles or timed_cycles(case, cells)
    before = bandwidth()
    seconds = _least(lambda: _advance(simulation, batch))
    phases = _phases(simulation, batch)
    return _case(case.name, cells, batch, seconds, phases | {PYTHON: seconds - sum(phases.values())}, max(before, bandwidth()))


class _Shot(run.Run):
    """A run that keeps its state every STAGE cycles.

    Attributes
    ----------
    stages : copies of the state
    """

    def __init__(self, deck, directory: Path, report, compiled):
        super().__init__(deck, directory, restart=False, report=report, compiled=compiled)
        self.stages: list[snapshot.Snapshot] = []

    def _step(self) -> None:
        super()._step()
        if self.stepped >= FIRST + STAGE * len(self.stages):
            self.stages.append(self._snapshot())


def measure_shot(deck: decks.Deck, bandwidth: Bandwidth) -> dict:
    """A shot to its end, with all its outputs, in a temporary directory; then its cycles are taken apart, stage by stage."""
    before = bandwidth()
    with (tempfile.TemporaryDirectory() as folder, reporting.reporter(Path(folder) / LOG, quiet=True) as report,
          announced(moving.place()) as compiled):
        shot = _Shot(deck, Path(folder), report, compiled)
        summary = shot.execute(Interrupt())
    wall = summary["wall_s"]
    phases = {name: share * summary["cycles_s"] for name, share in shares(deck, shot.stages).items()}
    phases |= {name: summary[f"{name.replace(' ', '_')}_s"] for name in ("outputs", "compilation", "set up")}
    phases["stop checks and the end"] = wall - sum(phases.values())
    groups: dict[str, float] = {}
    for name, seconds in phases.items():
        group = name.split(": ")[0]
        groups[group] = groups.get(group, 0.0) + seconds
    case = _case(f"{WHOLE_SHOT}, {deck.name}", summary["cells"], summary["cycles"], wall, phases, max(before, bandwidth()))
    return case | {"stop_reason": summary["stop_reason"], "wall_s": wall, "groups_s": groups,
                   "peak_memory_bytes": _peak_memory()}


def shares(deck: decks.Deck, stages: list[snapshot.Snapshot]) -> dict[str, float]:
    """Shares of the time of cycles: by "group: phase", and of what is in no phase; the means over stages."""
    spent = {PYTHON: 0.0}
    for stage in stages:
        simulation = Simulation(deck)
        simulation.load_restart_arrays(stage.arrays)
        simulation.load_restart_scalars(stage.scalars)
        _advance(simulation, CYCLES)
        spent[PYTHON] += _least(functools.partial(_advance, simulation, CYCLES))
        for name, seconds in _phases(simulation, CYCLES).items():
            key = f"{GROUPS.get(name, CELLS)}: {name}"
            spent[key] = spent.get(key, 0.0) + seconds
            spent[PYTHON] -= seconds
    return {name: seconds / sum(spent.values()) for name, seconds in spent.items()}


def _peak_memory() -> int:
    """Largest resident memory of the process so far, bytes; on Windows that of its working set."""
    try:
        import resource
    except ImportError:
        return getattr(psutil.Process().memory_info(), "peak_wset", 0)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def _case(name: str, cells: int, cycles: int, seconds: float, phases: dict[str, float], bandwidth: float) -> dict:
    """An entry of `cases`."""
    ns = 1e9 / (cells * cycles)
    return {
        "name": name,
        "threads": jit.threads(),
        "cells": cells,
        "cycles": cycles,
        "triad_gb_s": bandwidth,
        "ns_per_cell_cycle": seconds * ns,
        "triad_updates_per_cell_cycle": seconds * ns * bandwidth / BYTES_PER_UPDATE,
        "phases": {phase: spent * ns for phase, spent in sorted(phases.items(), key=lambda item: -item[1])},
    }


def lines(case: dict) -> list[str]:
    """The printed lines of a case."""
    shown = [f"  {case['name']:26s} {case['ns_per_cell_cycle']:7.1f} ns per cell and cycle, "
             f"{case['triad_updates_per_cell_cycle']:6.1f} triad updates at {case['triad_gb_s']:.1f} GB/s  "
             f"({case['cells']} cells, {case['cycles']} cycles)"]
    if "wall_s" in case:
        memory = case["peak_memory_bytes"] / 2**20
        shown.append(f"      {case['stop_reason']} after {duration(case['wall_s'])}, peak memory {memory:.0f} MiB")
        parts = ", ".join(f"{name} {seconds:.3g} s" for name, seconds in case["groups_s"].items())
        shown.append(f"      {parts}")
    return shown


def phase_lines(case: dict) -> list[str]:
    """Time by phase."""
    total = case["ns_per_cell_cycle"]
    return [f"      {phase:26s} {ns:7.2f} ns  {100 * ns / total:5.1f} %" for phase, ns in case["phases"].items()]


def header(about: dict) -> list[str]:
    """Machine and versions."""
    packages = about["packages"]
    commit = (about["git_commit"] or "no repository")[:10] + (", modified" if about["git_dirty"] else "")
    return [
        f"hydro2d {about['version']} ({commit}), {about['written']}",
        f"{about['cpu']}, {several(about['cpu_count'], 'core')}, {several(about['threads'], 'thread')} at most, "
        f"{about['system']}, {about['host']}",
        ", ".join(f"{name} {packages[name]}" for name in ("python", "numpy", "numba", "llvmlite")),
    ]


def collect(cases: Iterable[Case] = CASES, *, threads: Iterable[int] | None = None, cycles: int | None = None,
            shot: decks.Deck | None = None, say: Callable[[str], None] = say) -> dict:
    """Measures cases on one thread and on all, and returns what `--json` writes.

    cases, threads : the cases, and the numbers of threads for each
    cycles : see `measure`
    shot : a deck that is run to its end before the cases
    say : receives the lines of the report
    """
    about = provenance.collect(jit.max_threads())
    result = {"provenance": about, "triad_gb_s": {}, "cases": []}
    for line in header(about):
        say(line)
    if shot:
        say(f"{shot.name} is run to its end, which may take minutes, on one thread and on all")
    started_with = jit.threads()
    try:
        for number in sorted({1, jit.max_threads()}) if threads is None else threads:
            jit.set_threads(number)
            say(f"\n{several(number, 'thread')}")
            bandwidth, first = Bandwidth(), True
            if shot:
                _tell(measure_shot(shot, bandwidth), result, say, phases=True)
            for case in cases:
                _tell(measure(case, bandwidth, cycles), result, say, phases=first)
                first = False
            if seen := bandwidth.seen:
                result["triad_gb_s"][str(number)] = max(seen)
                say(f"  triad {max(seen):.1f} GB/s, at least {min(seen):.1f}")
    finally:
        jit.set_threads(started_with)
    return result


def _tell(case: dict, result: dict, say: Callable[[str], None], *, phases: bool) -> None:
    result["cases"].append(case)
    for line in lines(case) + (phase_lines(case) if phases else []):
        say(line)


def main(json: Path | None = None, *, shot: Path | None = None, compilation: bool = False) -> int:
    """Runs every case on one thread and on all, prints a table, and writes it as JSON if a file is named.

    shot : a deck that is measured instead of the cases
    compilation : whether the compilation of kernels is also measured, first

    Raises DeckError.
    """
    deck = decks.load(shot) if shot else None
    measured = {"compilation": bench_compilation.in_an_empty_cache()} if compilation else {}
    for line in bench_compilation.lines(measured["compilation"]) if measured else ():
        say(line)
    with announced(moving.place()):
        result = collect(() if deck else CASES, shot=deck) | measured
    if json is not None:
        write_json(json, result)
        say(f"wrote {json}")
    return 0
