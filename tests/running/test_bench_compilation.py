"""The parts of a compilation add up to the whole."""

import numpy as np

from hydro2d import jit
from hydro2d.jit import calls, recording
from hydro2d.running import bench_compilation
from hydro2d.running.bench_compilation import OTHERS, OWN, STAGES, Stages


def of_a_kernel(a):
    for i in range(a.shape[0]):
        a[i] += 1.0


def event(kind, name=None):
    return jit.compiler_events.Event(kind, jit.compiler_events.EventStatus.START, data={"name": f"{name} (1)"})


def test_the_time_of_a_stage_is_without_that_of_those_within_it(monkeypatch):
    clock = iter([0.0, 1.0, 1.0, 4.0, 4.0, 6.0])
    monkeypatch.setattr(bench_compilation.time, "process_time", lambda: next(clock))
    stages = Stages()
    types, optimise = event(bench_compilation.PASS, "nopython_type_inference"), event(jit.OPTIMISE)
    stages.on_start(types)
    stages.on_start(optimise)
    stages.on_end(optimise)
    stages.on_end(types)
    assert stages.seconds["types"] == 3.0
    assert stages.seconds["LLVM's optimisation"] == 3.0


def test_parts_of_a_compilation():
    compiled = calls._compile(of_a_kernel)
    call = recording.Call("hydro2d.of_a_kernel", compiled, (compiled.typeof_pyval(np.zeros(3)),))
    compiled._cache.flush()
    measured = bench_compilation.measured([call])
    assert set(measured["stages"]) == {OTHERS, *STAGES.values(), *OWN.values()}
    assert 0.0 < sum(measured["stages"].values()) <= measured["kernels"]["of_a_kernel"]
    assert measured["stages"]["machine code"] > 0.0 < measured["stages"]["types"]
    shown = bench_compilation.lines(measured)
    assert shown[0].startswith("compilation of the 1 kernels of cth_nose_shape/hemi_5083_1086_quick.toml, one process:")
    assert len(shown) == 3 + 1 + len(measured["stages"])
