"""A cycle takes no memory that grows with the mesh, neither for arrays of numpy nor inside of kernels."""

import tracemalloc

import numpy as np
import pytest
from numba.core.errors import NumbaError
from numba.core.runtime import _nrt_python, rtsys

from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.measure.penetrator import WATCH_EVERY
from hydro2d.solver.simulation import Simulation
from tests.decks import entry, mesh, plate, rod, stop, table

#: bytes: views and numbers of Python, the same on every mesh
SLACK = 512
#: cycles before memory is measured, and during: both orders of the sweeps, with and without new slip zones
WARM, LOOKED_AT = 6, 10


def started(columns: int, rows: int, *, active: bool, advection: str, sliding: str) -> Simulation:
    simulation = Simulation(deck.loads(
        mesh(("12 mm", columns), ("-12 mm", "24 mm", rows))
        + rod("3 mm", "10 mm", tip="-0.1 mm", velocity="1000 m/s")
        + plate("20 mm")
        + table("numerics", ramp_cycles=0, active_region=active, advection=advection)
        + table("sliding", method=sliding, hard=["rod"])
        + entry("tracer", name="tip", r=0.0, z="-1 mm")
        + stop("1 us")
    ))
    for _ in range(WARM):
        simulation.step()
    return simulation


def peaks(simulation: Simulation) -> list[int]:
    """The largest memory of each of a few cycles beyond that before the cycle, bytes.

    Cycles in which depths are measured, with columns as long as the mesh, are left out, and the first ones under observation:
    there, numbers that are kept from cycle to cycle count as new if Python had none in reserve.
    """
    bytes_held = []
    tracemalloc.start()
    try:
        for _ in range(WARM):
            simulation.step()
        for _ in range(LOOKED_AT):
            before, _ = tracemalloc.get_traced_memory()
            tracemalloc.reset_peak()
            simulation.step()
            if simulation.cycle % WATCH_EVERY:
                bytes_held.append(tracemalloc.get_traced_memory()[1] - before)
    finally:
        tracemalloc.stop()
    return bytes_held


every_choice = pytest.mark.parametrize(
    "options",
    [
        {"active": True, "advection": "ke", "sliding": "slip-layer"},
        {"active": False, "advection": "both", "sliding": "slip-layer"},
        {"active": True, "advection": "momentum", "sliding": "none"},
        {"active": False, "advection": "both", "sliding": "contact"},
    ],
    ids=lambda options: ", ".join(map(str, options.values())),
)


@every_choice
def test_numpy(options):
    small, wide, high = (max(peaks(started(*size, **options))) for size in ((12, 36), (96, 36), (12, 1500)))
    assert max(wide, high) <= small + SLACK, f"{small} bytes on 12 x 36 cells, {wide} on 96 x 36, {high} on 12 x 1500"


@every_choice
def test_kernels(monkeypatch, options):
    """Kernels neither allocate nor count references to their arrays."""
    simulation = started(24, 72, **options)
    monkeypatch.setattr(simulation, "refuse_nonsense", lambda: None)  # its sums are not kernels of a cycle
    counting = _nrt_python.memsys_stats_enabled()
    _nrt_python.memsys_enable_stats()
    try:
        before = rtsys.get_allocation_stats()
        for _ in range(LOOKED_AT):
            simulation.step()
        after = rtsys.get_allocation_stats()
    finally:
        if not counting:
            _nrt_python.memsys_disable_stats()
    assert after == before


@pytest.mark.parametrize("compiled", [jit.point, jit.not_inlined, jit.serial, jit.kernel])
def test_a_kernel_that_would_allocate_does_not_compile(compiled):
    def first_of(n, a):
        for j in jit.prange(n):
            a[j] = np.zeros(3)[0]

    with pytest.raises(NumbaError, match="built-in function zeros"):
        compiled(first_of)(3, np.ones(3))
