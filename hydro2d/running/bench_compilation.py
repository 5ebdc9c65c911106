"""Time of the compilation for a first run, kernel by kernel and stage by stage: `hydro2d bench --compilation`.

    python -m hydro2d.running.bench_compilation < deck.toml

compiles the kernels of a deck in one process, and prints seconds of processor time as JSON.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence

from hydro2d import jit
from hydro2d.base import children
from hydro2d.base.errors import Error
from hydro2d.base.terminal import say
from hydro2d.deck import deck as decks
from hydro2d.files.shipped import problems_folder
from hydro2d.solver.first_cycle import calls_of_a_cycle

#: the first shot of the README
DECK = "cth_nose_shape/hemi_5083_1086_quick.toml"
#: numba's passes with their own names in the table; the others read and prepare functions
STAGES = {"nopython_type_inference": "types", "inline_inlinables": "rows put into kernels",
          "native_lowering": "lowering to LLVM"}
OTHERS = "reading functions"
#: names of our own events there
OWN = {jit.OPTIMISE: "LLVM's optimisation", jit.MACHINE_CODE: "machine code"}
PASS = "numba:run_pass"
#: names in the table are cut to this length
WIDTH = 38


class Stages(jit.compiler_events.Listener):
    """Adds up the processor time of the stages of compilation, each without nested ones.

    Attributes
    ----------
    seconds : processor time by the name of a stage
    """

    def __init__(self):
        self.seconds = dict.fromkeys((OTHERS, *STAGES.values(), *OWN.values()), 0.0)
        self._open: list[tuple[str, float]] = []

    def _stop(self) -> None:
        """Adds the time of the running stage up to now."""
        if self._open:
            stage, since = self._open[-1]
            now = time.process_time()
            self.seconds[stage] += now - since
            self._open[-1] = stage, now

    def on_start(self, event) -> None:
        """Called when a stage begins, perhaps within another one."""
        self._stop()
        stage = OWN.get(event.kind) or STAGES.get(event.data["name"].split()[0], OTHERS)
        self._open.append((stage, time.process_time()))

    def on_end(self, event) -> None:
        """Called when it ends and the enclosing one continues."""
        self._stop()
        self._open.pop()
        if self._open:
            self._open[-1] = self._open[-1][0], time.process_time()


def measured(calls: Sequence[jit.Call]) -> dict[str, dict[str, float]]:
    """Compiles kernels one after another; returns seconds of processor time by kernel (``kernels``) and stage (``stages``)."""
    stages, kernels, events = Stages(), {}, jit.compiler_events
    for kind in (PASS, *OWN):
        events.register(kind, stages)
    try:
        for call in calls:
            start = time.process_time()
            call.compile()
            kernels[call.name.removeprefix("hydro2d.")] = time.process_time() - start
    finally:
        for kind in (PASS, *OWN):
            events.unregister(kind, stages)
    return {"kernels": kernels, "stages": stages.seconds}


def in_an_empty_cache() -> dict[str, dict[str, float]]:
    """`measured` for the README's first shot, in a process with an empty cache. Raises Error if that fails."""
    deck = decks.load(problems_folder() / DECK)
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(children.python(__name__), input=deck.to_toml(), encoding="utf-8", stdout=subprocess.PIPE,
                              env={**os.environ, "HYDRO2D_CACHE_DIR": folder}, check=False)
    if done.returncode:
        raise Error(f"the process that compiles ended with status {done.returncode}")
    return json.loads(done.stdout)


def lines(times: dict[str, dict[str, float]]) -> list[str]:
    """The printed table."""
    whole = sum(times["kernels"].values())
    shown = [f"compilation of the {len(times['kernels'])} kernels of {DECK}, one process: {whole:.1f} s of processor time"]
    for title, seconds in (("by stage", times["stages"]), ("by kernel", times["kernels"])):
        shown.append(f"  {title}")
        shown += [f"      {name[-WIDTH:]:{WIDTH}s} {spent:7.2f} s  {100 * spent / whole:5.1f} %"
                  for name, spent in sorted(seconds.items(), key=lambda item: -item[1])]
    return shown


def main() -> None:
    """Compiles the kernels of the deck on the standard input, and prints the times as JSON."""
    from hydro2d.solver.simulation import Simulation

    deck = decks.loads(sys.stdin.read())
    say(json.dumps(measured(calls_of_a_cycle(lambda: Simulation(deck)))))


if __name__ == "__main__":
    main()
