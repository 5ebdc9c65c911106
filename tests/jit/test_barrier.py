"""The barrier at which the threads of a phase wait for one another, and the fallback where they cannot."""

import os
import subprocess
import sys
import time

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.jit import GATE, prange, threaded, wait
from hydro2d.solver.simulation import Simulation
from tests.regression.test_bitwise import SHOT
from tests.rules.source import ROOT

#: how often threads meet
TIMES = 500


@threaded
def meet_often(gate, parts, times, written, missed):
    """Every thread writes, meets the others, counts the writes of theirs that it does not see, and meets them again."""
    for place in prange(parts.shape[0] - 1):
        for k in range(times):
            written[place] = k + 1
            wait(gate, parts)
            for other in range(parts.shape[0] - 1):
                missed[place] += 0 if written[other] == k + 1 else 1
            wait(gate, parts)


def met(number: int) -> tuple[int, list[int], list[int]]:
    """(writes that one of so many threads did not see of another, the contents of a gate after it, what all have written)"""
    gate, written, missed = np.zeros(GATE, dtype=np.int64), np.zeros(number, dtype=np.int64), np.zeros(number, dtype=np.int64)
    meet_often(gate, np.arange(number + 1), TIMES, written, missed)
    return int(missed.sum()), sorted(set(gate.tolist())), written.tolist()


def in_process(code: str, **environment: str) -> str:
    """Output of a process of its own that runs the code."""
    code = f"import tests.jit.{__name__.rsplit('.', 1)[-1]} as here\n{code}"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, env={**os.environ, **environment}, capture_output=True,
                          text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.thorough
@pytest.mark.parametrize("number", [2, 3])
def test_threads_meet_and_see_what_the_others_have_written(number):
    printed = in_process(f"print(here.met({number}))", NUMBA_NUM_THREADS=str(number))
    assert printed == repr((0, [0, 2 * TIMES], [TIMES] * number))


def test_one_part_does_not_wait():
    assert met(1) == (0, [0], [TIMES])


def parts_and_bits(cycles: int = 12) -> tuple[int, int, str, float]:
    """(parts that a phase can have, those that it had, sums of the results, seconds in which the first was found out)"""
    start = time.perf_counter()
    jit.parts_at_once()
    waited = time.perf_counter() - start
    simulation = Simulation(deck.loads(SHOT, ["numerics.active_region=false"]))
    for _ in range(cycles):
        simulation.step()
    inside = simulation.grid.interior(simulation.state.q)
    return jit.parts_at_once(), len(simulation.engine.rows) - 1, f"{inside.sum().hex()} {np.abs(inside).sum().hex()}", waited


@pytest.mark.thorough
def test_threads_that_openmp_does_not_give_are_not_waited_for():
    """A loop then runs its turns one after another: the first would wait for ever."""
    code = "print(*here.parts_and_bits(), sep='|')"
    free = in_process(code, NUMBA_NUM_THREADS="2").split("|")
    bound = in_process(code, NUMBA_NUM_THREADS="2", OMP_THREAD_LIMIT="1").split("|")
    assert free[:2] == ["2", "2"]
    assert bound[:2] == ["1", "1"]
    assert bound[2] == free[2]
    assert float(bound[3]) < 5.0
