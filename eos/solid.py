"""The equation of state of the solid that another model builds on: its functions call ``solid.evaluate(model, rho, e, par)``.

The solid has any model without internal variables, chosen by its id. The models are known only when kernels are loaded, so
that ``evaluate`` is looked up when a function that calls it is compiled. Such a function must not be called before
`eos.dispatch`, which calls it, is loaded.
"""

from __future__ import annotations


def __getattr__(name: str):
    """`dispatch.evaluate_without_memory` as ``evaluate``."""
    if name != "evaluate":
        raise AttributeError(name)
    from eos import dispatch

    return dispatch.evaluate_without_memory
