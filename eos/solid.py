"""The equation of state of a solid that another model stands over: ``solid.evaluate(model, rho, e, par)`` in its functions.

It is any model without internal variables, by its id. The models are chosen when kernels are loaded, so that it is looked up
only when such a function is compiled. Such a function must not be called before `eos.dispatch` is loaded, which calls it.
"""

from __future__ import annotations


def __getattr__(name: str):
    """`dispatch.evaluate_without_memory` as ``evaluate``."""
    if name != "evaluate":
        raise AttributeError(name)
    from eos import dispatch

    return dispatch.evaluate_without_memory
