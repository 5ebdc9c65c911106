"""The phases of the step: the same bits for any number of parts of the mesh."""

import functools
import hashlib
import json
import os
import subprocess
import sys

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.kernels import between_phases, lagrangian_step, remap_step
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
