"""Compiles the kernels of a deck without running it: the second process of `compilation.Second`.

    python -m hydro2d.running.compile_ahead < deck.toml
"""

from __future__ import annotations

import contextlib
import functools
import sys

from hydro2d import jit
from hydro2d.deck import deck as decks
from hydro2d.running.compilation import EVENT, Compilation
from hydro2d.terminal import say


def calls_of_a_cycle(deck) -> list[jit.Call]:
    """The kernels that a simulation of a deck calls during set-up and in its first cycle, in order, each once.

    Nothing is computed: calls of kernels are only recorded. Code that needs their results may therefore fail, and every part of
    the cycle ends quietly where it fails.
    """
    from hydro2d.solver.simulation import Simulation

    with jit.recorded() as calls:
        simulation = Simulation(deck)
        for part in (simulation, simulation.engine, simulation.engine.mesh, simulation.engine.contact):
            _go_on_after_failure(part)
        simulation.engine.dt = 1e-9
        simulation.step()
    return list(dict.fromkeys(calls))


def _go_on_after_failure(part) -> None:
    """Makes every method of an object return quietly where it fails."""
    for name in dir(type(part)) if part is not None else ():
        method = getattr(type(part), name)
        if not name.startswith("__") and callable(method) and not isinstance(method, type):
            setattr(part, name, _quiet(getattr(part, name)))


def _quiet(method):
    @functools.wraps(method)
    def call(*arguments, **named):
        with contextlib.suppress(Exception):
            return method(*arguments, **named)

    return call


def main() -> None:
    """Compiles from the last kernel to the first, while the process that runs the deck goes from the first to the last.

    Prints after each how many kernels there are, without those that the cache had, and how many it has compiled.
    """
    calls = calls_of_a_cycle(decks.loads(sys.stdin.read()))
    compiled = Compilation(lambda text: None, lambda: None)
    jit.compiler_events.register(EVENT, compiled)
    whole = len(calls)
    say(f"{whole} 0", flush=True)
    for call in reversed(calls):
        before = compiled.kernels
        call.compile()
        whole -= compiled.kernels == before
        say(f"{whole} {compiled.kernels}", flush=True)


if __name__ == "__main__":
    main()
