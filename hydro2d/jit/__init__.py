"""Every numba option of the code, in one place, and the functions that compiled code computes with.

``@point``   a scalar function of physics, inlined by the compiler into the loops that call it
``@apart``   a function that kernels call for what is rare
``@rowwise`` one row of one phase, a piece of kernels
``@kernel``  loops over the mesh, threaded over rows by one outermost ``prange``
``@serial``  loops over a short list, one thread

What numba is told is in `options`, where compiled code is kept in `cache`, the decorators are in `calls`, exp, log and x^y for
several cells at once in `elementary`, and what is known of the calls of kernels in `recording`. Other files import from here.
"""

from hydro2d.jit.cache import add_model, all_folder, module_of
from hydro2d.jit.calls import (
    apart,
    by_id,
    kernel,
    max_threads,
    modules,
    plus,
    point,
    prange,
    returns,
    rows_by_id,
    rowwise,
    serial,
    set_threads,
    threads,
)
from hydro2d.jit.elementary import exp, log, power
from hydro2d.jit.options import compiler_events, host_cpu
from hydro2d.jit.recording import Call, profiling, recorded, timings

__all__ = [
    "Call", "add_model", "all_folder", "apart", "by_id", "compiler_events", "host_cpu", "kernel", "max_threads", "module_of",
    "exp", "log", "modules", "plus", "point", "power", "prange", "profiling", "recorded", "returns", "rows_by_id", "rowwise",
    "serial", "set_threads", "threads", "timings",
]  # fmt: skip
