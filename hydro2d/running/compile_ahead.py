"""Compiles the kernels of a deck without running it: the second process of `compilation.Second`.

    python -m hydro2d.running.compile_ahead < deck.toml
"""

from __future__ import annotations

import sys

from hydro2d.base.terminal import say
from hydro2d.deck import deck as decks
from hydro2d.solver.first_cycle import calls_of_a_cycle


def main() -> None:
    """Compiles from the last kernel to the first, while the process that runs the deck goes from the first to the last.

    Prints the name of each.
    """
    from hydro2d.solver.simulation import Simulation

    deck = decks.loads(sys.stdin.read())
    for call in reversed(calls_of_a_cycle(lambda: Simulation(deck))):
        call.compile()
        say(call.name, flush=True)


if __name__ == "__main__":
    main()
