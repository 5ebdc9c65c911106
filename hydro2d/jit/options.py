"""Options of numba and LLVM, and the changes to numba's internals that they need.

tests/jit/test_jit.py names the internals that numba does not promise to keep.
"""

from __future__ import annotations

import copy
import functools
import os
import types as types_of_python

import llvmlite.binding
import numba
from numba.core import codegen, cpu, inline_closurecall, targetconfig, types
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

#: types of numbers, without those of constants
NUMBERS = frozenset((types.Integer, types.Float, types.Boolean))
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


def _repeat_less() -> None:
    """Keeps numba from finding out the same again and again: the types of operators between numbers, whether two sets of flags
    are the same, and copies of what is inlined once. The machine code is the same to the last byte."""
    config, functions = targetconfig.TargetConfig, types.functions.BaseFunction
    equal, call_type = config.__eq__, functions.get_call_type
    known: dict = {}

    @functools.wraps(equal)
    def equal_if_set_equally(self, other):
        return type(self) is type(other) and self._values == other._values or equal(self, other)

    @functools.wraps(call_type)
    def asked_once(self, context, arguments, keywords):
        if keywords or not all(type(each) in NUMBERS for each in arguments):
            return call_type(self, context, arguments, keywords)
        call = self, context, tuple(arguments)
        if call not in known:
            signature = call_type(self, context, arguments, keywords)
            if self._impl_keys[signature.args] is not self.typing_key:  # a function of Python that numba compiles
                return signature
            known[call] = signature
        self._impl_keys[known[call].args] = self.typing_key
        return known[call]

    def inline_function(self, caller_ir, block, i, function, arg_typs=None):
        inlined = self.run_untyped_passes(function)  # made for this place alone
        inline_closurecall.copy = types_of_python.SimpleNamespace(deepcopy=lambda each: each)
        try:
            return self.inline_ir(caller_ir, block, i, inlined, function.__code__.co_freevars, arg_typs=arg_typs)
        finally:
            inline_closurecall.copy = copy

    config.__eq__, functions.get_call_type = equal_if_set_equally, asked_once
    inline_closurecall.InlineWorker.inline_function = inline_function


_repeat_less()


def is_cached(compiled, types: tuple) -> bool:
    """Whether the cache has a compiled function for these types of its arguments."""
    return compiled._cache.has(types)
