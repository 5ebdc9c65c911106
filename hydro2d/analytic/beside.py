"""Depths of analytic models for the shot of a deck, printed next to the depth of a run."""

from __future__ import annotations

from hydro2d.analytic import model_deck, models
from hydro2d.base.errors import DeckError
from hydro2d.deck.deck import Deck
from hydro2d.measure.summary import Summary
from hydro2d.penetration.model import InputError

#: models of a rod into a thick target, and their names in the line: two of eroding rods, and one of a rigid rod
SHOWN = {"tate": "Tate", "walker-anderson": "Walker-Anderson", "forrestal": "rigid"}


def case(name: str, shot: model_deck.Shot) -> models.Case:
    """A model with the rod and the target of a deck.

    Raises InputError if the deck and its materials lack an input; it is never taken from the model's example.
    """
    resolved = models.resolve(models.named(name), models.Request(rod=shot.rod, target=shot.target, geometry=shot.values))
    if resolved.borrowed:
        raise InputError(f"the deck and its materials do not give {', '.join(resolved.borrowed)}")
    return resolved


def depths(deck: Deck) -> dict[str, float]:
    """Final depth in m by each model of SHOWN that can be applied; none unless the deck is a rod into one target.

    With a third body, such as a jacket or a cover plate, the models would describe another shot.
    """
    try:
        shot = model_deck.shot(deck)
    except DeckError:
        return {}
    by_model = {}
    for name, shown in SHOWN.items() if len(deck.body) == 2 else ():
        try:
            by_model[shown] = float(case(name, shot).rows([shot.velocity])[0]["depth"])
        except InputError:
            continue
    return by_model


def lines(deck: Deck, summary: Summary) -> list[str]:
    """A line for the end of a run, such as "analytic, at rest     Tate 27.54 cm, Walker-Anderson 35.87 cm, rigid 49.54 cm".

    There is no line if the rod has perforated a target, or if no model can be applied.
    """
    if summary.outcome and summary.outcome.perforated:
        return []
    text = ", ".join(f"{name} {depth * 1e2:.2f} cm" for name, depth in depths(deck).items())
    return [f"{'analytic, at rest':<21} {text}"] if text else []
