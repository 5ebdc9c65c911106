"""The kernels that a deck calls until its first cycle is over, without calling them."""

from __future__ import annotations

import contextlib
import functools
import json
from collections.abc import Callable
from typing import Any

from hydro2d import jit


def kernels(deck) -> str:
    """Name of the set of kernels that a deck needs, from the names of its methods."""
    words = {name: getattr(deck, name).model_dump() for name in ("numerics", "sliding", "failure")}
    chosen = {name: {k: v for k, v in table.items() if isinstance(v, str | bool)} for name, table in words.items()}
    return json.dumps([deck.mesh.geometry, bool(deck.tracer), deck.penetration is not None, chosen], sort_keys=True)


def calls_of_a_cycle(make: Callable[[], Any]) -> list[jit.Call]:
    """The kernels that a simulation calls during set-up and in its first cycle, in order, each once.

    make : makes the simulation

    Nothing is computed: calls of kernels are only recorded. Code that needs their results may therefore fail; every part of
    the cycle then ends quietly.
    """
    with jit.recorded() as calls:
        simulation = make()
        engine = simulation.engine
        for part in (simulation, engine, engine.mesh, engine.contact, engine.books, engine.refusals):
            _go_on_after_failure(part)
        engine.dt = 1e-9
        simulation.step()
    return list(dict.fromkeys(calls))


def _go_on_after_failure(part) -> None:
    """Makes every method of an object return quietly if it fails."""
    for name in dir(type(part)) if part is not None else ():
        method = getattr(type(part), name)
        if not name.startswith("__") and callable(method) and not isinstance(method, type):
            setattr(part, name, _ignoring_errors(getattr(part, name)))


def _ignoring_errors(method):
    @functools.wraps(method)
    def call(*arguments, **named):
        with contextlib.suppress(Exception):
            return method(*arguments, **named)

    return call
