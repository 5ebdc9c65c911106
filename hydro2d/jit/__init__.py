"""All numba options of the code, and the decorators and functions for compiled code.

``@point``       a scalar function of physics, inlined by the compiler into the loops that call it
``@late_bound``  a scalar function that calls functions chosen when kernels are loaded
``@not_inlined`` a function that kernels call for rare cases
``@rowwise``     one row of one phase, a piece of kernels
``@kernel``      loops over the rows of one part of the mesh
``@cell_rows``, ``@vertex_rows``  the work of a kernel in one row of cells or vertices, applied to all rows of its part
``@threaded``    loops over the mesh outside of the step, threaded over rows by one outermost ``prange``
``@serial``      loops over a short list, one thread
``@control``     the same for what stands between phases: it may set numbers of the handle

A `Phase` of the step is a list of kernels, one after another, for all parts at the same time.

numba's options are in `options`, the processor that code is compiled for in `target`, the place of compiled code in `cache`
and its format in `store`, the decorators in `calls`, arguments by name in `by_name`, exp, log, x^y and erf for several
cells at once in `elementary`, phases in `phases`, what goes through many of them in `tape`, the names of their arrays in
`handle`, and the record of kernel calls in `recording`. Other files import from here.
"""

from hydro2d.jit import store, target
from hydro2d.jit.cache import add_model, all_folder, module_of
from hydro2d.jit.calls import (
    GATE,
    by_id,
    cell_rows,
    control,
    kernel,
    late_bound,
    max_threads,
    modules,
    not_inlined,
    parts_at_once,
    plus,
    point,
    prange,
    returns,
    rows_by_id,
    rowwise,
    serial,
    set_threads,
    threaded,
    threads,
    vertex_rows,
    wait,
)
from hydro2d.jit.elementary import erf, exp, log, power
from hydro2d.jit.handle import Handle, declare, declared
from hydro2d.jit.options import MACHINE_CODE, OPTIMISE, compiler_events
from hydro2d.jit.phases import TYPES as PHASE_TYPES
from hydro2d.jit.phases import WAIT, Phase, alone, given, unless, when
from hydro2d.jit.recording import FIRST_CALL, Call, is_recording, profiling, recorded, timings
from hydro2d.jit.tape import Conductor, Tape

__all__ = [
    "Call", "Conductor", "FIRST_CALL", "GATE", "Handle", "MACHINE_CODE", "OPTIMISE", "PHASE_TYPES", "Phase", "Tape", "WAIT",
    "add_model", "all_folder", "alone", "by_id", "cell_rows", "compiler_events", "control", "declare", "declared", "erf", "exp",
    "given", "is_recording", "kernel", "late_bound", "log", "max_threads", "module_of", "modules", "not_inlined",
    "parts_at_once", "plus", "point", "power", "prange", "profiling", "recorded", "returns", "rows_by_id", "rowwise",
    "serial", "set_threads", "store", "target", "threaded", "threads", "timings", "unless", "vertex_rows", "wait", "when",
]
