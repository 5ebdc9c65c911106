"""A draw: the change that makes each run of a search a different sample of chance, and nothing else.

It makes the default changes of the members of an ensemble, as far as the deck allows them (explanation/how-sure).
"""

from __future__ import annotations

from hydro2d.deck import deck as decks
from hydro2d.study.plan import members
from hydro2d.study.plan.definition import Ensemble

#: deck keys that a draw changes, by the column that has them in the table of shots
KEYS = {"first_step_factor": members.KNOBS["first step"].key, "z_start_m": members.KNOBS["mesh offset"].key}


def overrides(text: str, seed: int, number: int) -> list[str]:
    """The changes of a draw in a deck, as ``key=value``.

    text : resolved deck;  seed : of the search;  number : of the draw, from 1

    The same seed and number give the same draw of a deck, on any machine.
    """
    deck = decks.loads(text)
    ensemble = Ensemble(repeats=2, by=members.allowed(deck), seed=seed)
    return members.overrides(deck, members.amounts(ensemble, number))
