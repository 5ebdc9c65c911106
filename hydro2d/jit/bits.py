"""The bits of a float64 as an int64, and back, for `elementary` to separate exponents.

Like `barrier`, it writes LLVM's own instructions. Python cannot call the two functions; compiled code can.
"""

from __future__ import annotations

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


@intrinsic
def bits_of(typingctx, x):
    """int64 with the bits of a float64."""
    if x != types.float64:
        return None

    def cast(context, builder, signature, values):
        return builder.bitcast(values[0], ir.IntType(64))

    return types.int64(types.float64), cast


@intrinsic
def from_bits(typingctx, n):
    """float64 with the bits of an int64."""
    if n != types.int64:
        return None

    def cast(context, builder, signature, values):
        return builder.bitcast(values[0], ir.DoubleType())

    return types.float64(types.int64), cast
