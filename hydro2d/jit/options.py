"""Options of numba and LLVM, and the changes to numba's internals that they need.

tests/jit/test_jit.py names the internals that numba does not promise to keep.
"""

from __future__ import annotations

import functools
import os

import llvmlite.binding
import numba
from numba.core import codegen, cpu
from numba.core.options import TargetOptions

numba.config.THREADING_LAYER = "omp"

# OpenMP must not give a loop fewer threads than it asks for: those of a phase wait for one another
os.environ["OMP_DYNAMIC"] = "false"

# rows are views into a dozen arrays: the loops are vectorised only if that many checks that they do not overlap are allowed
llvmlite.binding.set_option("hydro2d", "-vectorize-memory-check-threshold=1024")

#: without NRT numba counts no references to arrays. Nothing here makes or keeps one, and the counts, atomic operations around
#: each call, took a third of the time of a shot with contact
OPTIONS = {"error_model": "numpy", "fastmath": False, "nogil": True, "_nrt": False}


# an option that numba has for its own functions only: no two arrays given to a function overlap. Without it every vector
# loop is preceded by hundreds of comparisons of addresses, a tenth of the time of a cycle
cpu.CPUTargetOptions.noalias = TargetOptions.Mapping("noalias")


compiler_events = numba.core.event
#: events of a compilation: LLVM optimises a function with all that is inlined in it; machine code is made
OPTIMISE, MACHINE_CODE = "hydro2d:optimise", "hydro2d:machine-code"

#: functions that only call kernels: optimising them gains nothing
ONLY_CALLS: set = set()
#: functions that only compiled code calls; they have no machine code of their own
INNER: set = set()


def _compile_once() -> None:
    """Keeps LLVM from optimising kernels again, several times over, in functions that only call them, and from making machine
    code of functions that are part of others."""
    compiling: list = []

    class Compiling(compiler_events.Listener):
        def on_start(self, event):
            compiling.append(event.data["dispatcher"].py_func)

        def on_end(self, event):
            compiling.pop()

    compiler_events.register("numba:compile", Compiling())
    library = codegen.CPUCodeLibrary
    optimise, finalise = library._optimize_final_module, library._finalize_final_module
    executable = cpu.CPUContext.get_executable

    @functools.wraps(optimise)
    def unless_it_only_calls(self):
        if not (compiling and compiling[-1] in ONLY_CALLS):
            with compiler_events.trigger_event(OPTIMISE):
                optimise(self)

    @functools.wraps(finalise)
    def unless_it_is_part_of_others(self):
        if not (compiling and compiling[-1] in INNER):
            with compiler_events.trigger_event(MACHINE_CODE):
                finalise(self)
            return
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    @functools.wraps(executable)
    def none_for_part_of_others(self, library, fndesc, env):
        if not (compiling and compiling[-1] in INNER):
            return executable(self, library, fndesc, env)
        library._ensure_finalized()  # now, while `compiling` still names it
        return [].append  # stands for the function, which Python never calls; one of its own for each

    library._optimize_final_module = unless_it_only_calls
    library._finalize_final_module = unless_it_is_part_of_others
    cpu.CPUContext.get_executable = none_for_part_of_others


_compile_once()


def is_cached(compiled, types: tuple) -> bool:
    """Whether the cache has a compiled function for these types of its arguments."""
    return compiled._cache.has(types)
