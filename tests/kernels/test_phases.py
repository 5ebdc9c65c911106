"""The phases of the step: the same bits for all parts of the mesh, in any order in which they reach the next barrier."""

import functools
import hashlib
import json
import os
import subprocess
import sys
import threading

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.kernels import between_phases, lagrangian_step, remap_step
from hydro2d.mesh import state
from hydro2d.solver.simulation import Simulation
from tests.kernels.test_compiled_equals_source import CASES, CONTACT, text_of
from tests.rules.source import ROOT

#: a rod that begins deep in the plate, on a fixed mesh: contact nodes in most rows
DEEP = text_of("both", CONTACT, tip="5 mm", follows=False)
DECKS = {**{name: text_of(*case) for name, case in CASES.items()}, "both, contact": text_of("both", CONTACT),
         "both, deep contact": DEEP, "ke, following": text_of("ke", {"method": "none"}, follows=True)}
#: two divisions into parts, and contact for most of them
CYCLES = 20
PHASES = [(module, name) for module in (lagrangian_step, remap_step, between_phases) for name, value in vars(module).items()
          if isinstance(value, jit.Phase)]


def bits(case: str, *parts: int) -> str:
    """A hash of the contents of a restart file after some cycles, with these numbers of parts in turn."""
    simulation = Simulation(deck.loads(DECKS[case]))
    counted = jit.parts_at_once
    try:
        for cycle in range(CYCLES):
            jit.parts_at_once = functools.partial(int, parts[cycle % len(parts)])
            simulation.step()
            assert len(simulation.engine.rows) == parts[cycle % len(parts)] + 1
    finally:
        jit.parts_at_once = counted
    digest, g = hashlib.sha256(), simulation.grid
    for name, array in sorted(simulation.restart_arrays().items()):
        cells = array.ndim >= 2 and array.shape[-2:] in (g.shape, g.vertex_shape)
        digest.update(name.encode() + np.ascontiguousarray(array[..., g.g:-g.g, g.g:-g.g] if cells else array).tobytes())
    return digest.hexdigest() + json.dumps(simulation.restart_scalars(), sort_keys=True, default=str)


def bits_as_python(case: str) -> str:
    """`bits` of phases that run as Python, with one part."""
    jit.profiling(True, each_kernel=True)
    try:
        return bits(case, 1)
    finally:
        jit.profiling(False)


@pytest.mark.thorough
@pytest.mark.parametrize("case", DECKS)
def test_phases_do_what_their_source_says_with_any_number_of_parts(case):
    code = ("from tests.kernels.test_phases import bits, bits_as_python\n"
            f"case = {case!r}\n"
            "print(bits_as_python(case) == bits(case, 1) == bits(case, 2) == bits(case, 3) == bits(case, 3, 1, 2))")
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, env={**os.environ, "NUMBA_NUM_THREADS": "3"},
                          capture_output=True, text=True, timeout=600)
    assert done.stdout == "True\n", done.stderr


class Turns:
    """Runs the parts of phases, as Python, one after another from barrier to barrier, in a chosen order.

    order : int -> list of int, the order of so many parts
    """

    def __init__(self, monkeypatch, order):
        self.order, self.own = order, threading.local()
        self.stopped = threading.Semaphore(0)  # released by a part that waits or has finished
        for module, name in PHASES:
            monkeypatch.setattr(module, name, functools.partial(self, getattr(module, name)))

    def _wait(self):
        self.own.waits.append(True)
        self.stopped.release()
        self.own.may_go_on.acquire()

    def __call__(self, phase, handle):
        number, failed = len(handle.parts) - 1, []
        turns, waits = [threading.Semaphore(0) for _ in range(number)], [[] for _ in range(number)]

        def work(place):
            self.own.may_go_on, self.own.waits = turns[place], waits[place]
            turns[place].acquire()
            try:
                phase.as_python(handle, place, self._wait)
            except BaseException as error:
                failed.append(error)
            self.stopped.release()

        threads = [threading.Thread(target=work, args=(place,), daemon=True) for place in range(number)]
        for thread in threads:
            thread.start()
        barriers = 0
        while True:
            for place in self.order(number):
                turns[place].release()
                self.stopped.acquire()
                assert not failed, failed
            barriers += 1
            if {len(each) for each in waits} != {barriers}:
                break
        for thread in threads:
            thread.join()
        assert {len(each) for each in waits} == {barriers - 1}, "a part has not come to a barrier"


ORDERS = {"upward": range, "downward": lambda number: range(number)[::-1], "at random": np.random.default_rng(0).permutation}


@pytest.mark.thorough
@pytest.mark.parametrize("case", DECKS)
@pytest.mark.parametrize("order", ORDERS)
def test_parts_run_in_any_order_between_barriers(monkeypatch, case, order):
    """A barrier lies between a part's reads and writes of another one's data and that part's own."""
    alone = bits_as_python(case)
    monkeypatch.setattr(state, "max_threads", lambda: 4)  # scratch memory for as many parts
    Turns(monkeypatch, ORDERS[order])
    assert bits(case, 4) == alone
