"""The processor that code is compiled for: the one at hand, or one named by HYDRO2D_TARGET.

All processors that have the features of a named target get the same code, which can be shipped and gives the same bits on each
of them. The code for the processor at hand is a few per cent faster. `shipped` has the default.
"""

from __future__ import annotations

import os
import platform
import sys
from typing import NamedTuple

import llvmlite
import llvmlite.binding
import numba
from numba.core import registry

from hydro2d.base.errors import TargetError
from hydro2d.base.terminal import say


class Target(NamedTuple):
    """A processor by LLVM's name, and the features that its code uses beyond those of the oldest of its kind."""

    name: str
    features: tuple[str, ...] = ()

    @property
    def flags(self) -> str:
        """The features in LLVM's notation."""
        return ",".join(f"+{feature}" for feature in self.features)

    def missing(self) -> list[str]:
        """The features that this processor does not have."""
        here = llvmlite.binding.get_host_cpu_features()
        return [feature for feature in self.features if not here.get(feature)]


#: the processor at hand
NATIVE = "native"
#: named targets by the kind of machine (`platform.machine`). x86 processors have had x86-64-v3 since 2013 (Intel) and
#: 2015 (AMD); NEON belongs to every aarch64
_X86 = Target("x86-64-v3", (
    "cx16", "sahf", "popcnt", "sse3", "sse4.1", "sse4.2", "ssse3",
    "avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "xsave",
))
NAMED = {"x86_64": _X86, "AMD64": _X86, "aarch64": Target("generic", ("neon",)), "arm64": Target("generic", ("neon",))}

#: numba's options that change the code; those for reports do not
OPTIONS = (
    "OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX", "BOUNDSCHECK", "DEBUGINFO_DEFAULT", "EXTEND_VARIABLE_LIFETIMES",
    "ENABLE_PROFILING", "USING_SVML", "LLVM_REFPRUNE_PASS", "LLVM_REFPRUNE_FLAGS", "DEBUG_NRT", "PARFOR_MAX_TUPLE_SIZE",
    "DEBUG_ARRAY_OPT", "DEBUG_ARRAY_OPT_RUNTIME", "USE_LLVMLITE_MEMORY_MANAGER",
)


def named() -> Target | None:
    """The named target of this kind of machine; None if there is none."""
    return NAMED.get(platform.machine())


def asked_for() -> Target | None:
    """The target that HYDRO2D_TARGET asks for; None: numba's own choice, the processor at hand or that of NUMBA_CPU_NAME.

    Raises TargetError.
    """
    asked, target = os.environ.get("HYDRO2D_TARGET"), named()
    if not asked or asked == NATIVE:
        return None
    if target is None or asked != target.name:
        known = " or ".join([NATIVE, *([target.name] if target else [])])
        raise TargetError(f"HYDRO2D_TARGET={asked}: must be {known} on this machine ({platform.machine()})")
    if lacking := target.missing():
        raise TargetError(f"HYDRO2D_TARGET={asked}: this processor has no {', '.join(lacking)}")
    return target


def is_numbas_choice() -> bool:
    """Whether NUMBA_CPU_NAME or NUMBA_CPU_FEATURES asks for a processor."""
    return numba.config.CPU_NAME is not None or numba.config.CPU_FEATURES is not None


def fix(target: Target | None) -> None:
    """Sets numba's target, or leaves numba's own choice.

    numba reads it once, when its first function is declared. In a program that has declared one before, the target stays as it
    was then, and a line says so.
    """
    global SYSTEM, PROCESSOR, FEATURES
    config = numba.config
    before = config.CPU_NAME, config.CPU_FEATURES
    if target is not None:
        config.CPU_NAME, config.CPU_FEATURES = target.name, target.flags
    actual = registry.cpu_target.target_context.codegen().magic_tuple()
    if target is not None and actual[2] != target.flags:
        config.CPU_NAME, config.CPU_FEATURES = before
        actual = registry.cpu_target.target_context.codegen().magic_tuple()
        say(f"hydro2d: code is compiled for {actual[1]}, not for {target.name}: numba was used before hydro2d was imported",
            file=sys.stderr, flush=True)
    SYSTEM, PROCESSOR, FEATURES = actual


#: the target of compiled code, as LLVM names it, once it is fixed
SYSTEM = PROCESSOR = FEATURES = ""


def description() -> dict[str, str]:
    """All that the code of a function depends on in addition to its sources, by name."""
    return {**versions(), "system": SYSTEM, "processor": PROCESSOR, "features": FEATURES}


def versions() -> dict[str, str]:
    """The compiler and its options, which are known before the target is fixed."""
    options = {f"numba.config.{option}": repr(getattr(numba.config, option, None)) for option in OPTIONS}
    options["numba.config.OPT.is_opt_max"] = repr(getattr(numba.config.OPT, "is_opt_max", False))  # "max" is a 3 as well
    return {"numba": numba.__version__, "llvmlite": llvmlite.__version__, "Python": sys.implementation.cache_tag,
            **options}
