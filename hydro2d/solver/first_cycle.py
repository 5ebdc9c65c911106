"""The kernels that a deck calls until its first cycle is over, without calling them."""

from __future__ import annotations

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

    Nothing is computed: calls of kernels are only recorded.
    """
    with jit.recorded() as calls:
        make().step()
    return list(dict.fromkeys(calls))
