"""A barrier for the threads of one parallel loop, so that one loop can run a whole phase of the step.

Starting a parallel loop costs two or three microseconds, a barrier a tenth of one. It works only for loops in which every turn
has a thread of its own, all at the same time (`calls.parts_at_once` ensures this).
"""

from __future__ import annotations

import platform

import llvmlite.ir as ir
from numba.core import cgutils, types
from numba.extending import intrinsic

#: words of a gate, and the places of its two numbers, which lie in different cache lines
WORDS, ARRIVED, OPENED = 32, 0, 16
#: after this many looks a thread lets others run before it looks again
PATIENCE = 20000
#: the function of the system that lets other threads run
LET_OTHERS = "SwitchToThread" if platform.system() == "Windows" else "sched_yield"
#: whether the processor has an instruction for waiting loops
PAUSES = platform.machine() in ("x86_64", "AMD64")


@intrinsic
def meet(context, gate, number, rounds):
    """Waits until `number` threads have called it with the same gate, int64[WORDS]. Returns whether they have.

    rounds : how often it lets others run before it gives up; 0: it never gives up
    """

    def code(context, builder, signature, arguments):
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        word, one = ir.IntType(64), ir.Constant(ir.IntType(64), 1)
        arrived = builder.gep(data, [ir.Constant(word, ARRIVED)])
        opened = builder.gep(data, [ir.Constant(word, OPENED)])
        before = builder.load_atomic(opened, "acquire", 8)
        met = cgutils.alloca_once_value(builder, ir.Constant(ir.IntType(1), 1))
        others = builder.atomic_rmw("add", arrived, one, "acq_rel")
        with builder.if_else(builder.icmp_signed("==", builder.add(others, one), arguments[1])) as (last, not_last):
            with last:
                builder.store_atomic(ir.Constant(word, 0), arrived, "release", 8)
                builder.atomic_rmw("add", opened, one, "acq_rel")
            with not_last:
                looked, yielded = (cgutils.alloca_once_value(builder, ir.Constant(word, 0)) for _ in range(2))
                look, tired, done = (builder.append_basic_block(name) for name in ("look", "tired", "done"))
                builder.branch(look)
                builder.position_at_end(look)
                if PAUSES:
                    pause = ir.FunctionType(ir.VoidType(), [])
                    builder.call(cgutils.get_or_insert_function(builder.module, pause, "llvm.x86.sse2.pause"), [])
                count = builder.add(builder.load(looked), one)
                builder.store(count, looked)
                waits = builder.icmp_signed("==", builder.load_atomic(opened, "acquire", 8), before)
                more = builder.append_basic_block("more")
                builder.cbranch(waits, more, done)
                builder.position_at_end(more)
                builder.cbranch(builder.icmp_signed("<", count, ir.Constant(word, PATIENCE)), look, tired)
                builder.position_at_end(tired)
                builder.store(ir.Constant(word, PATIENCE // 2), looked)
                turns = builder.add(builder.load(yielded), one)
                builder.store(turns, yielded)
                let_others = ir.FunctionType(ir.IntType(32), [])
                builder.call(cgutils.get_or_insert_function(builder.module, let_others, LET_OTHERS), [])
                stop = builder.and_(builder.icmp_signed(">", arguments[2], ir.Constant(word, 0)),
                                    builder.icmp_signed(">", turns, arguments[2]))
                give_up = builder.append_basic_block("give_up")
                builder.cbranch(stop, give_up, look)
                builder.position_at_end(give_up)
                builder.store(ir.Constant(ir.IntType(1), 0), met)
                builder.branch(done)
                builder.position_at_end(done)
        return builder.load(met)

    return types.boolean(gate, types.int64, types.int64), code
