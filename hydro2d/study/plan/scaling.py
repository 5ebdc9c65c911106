"""The size of a study: members of each case, and cells across the radius of the projectile."""

from __future__ import annotations

from dataclasses import dataclass

from hydro2d.deck.deck import Deck
from hydro2d.files import toml
from hydro2d.study.plan import meshes
from hydro2d.study.plan.definition import Definition, Ensemble, StudyError


@dataclass(frozen=True)
class Size:
    """Replacements of the numbers of a study file; None leaves them.

    members : members of each case; 1 leaves the first, whose deck is that of the case
    cells : cells across the radius of the projectile of every deck
    """

    members: int | None = None
    cells: float | None = None

    def ensemble(self, definition: Definition) -> Ensemble | None:
        """How the members are made; without [ensemble] in the study, by its defaults."""
        given = definition.ensemble
        if self.members is not None and definition.sample is not None and definition.sample.by:
            raise StudyError("members: sample.by makes changes already, other ones in every row; leave out one of them")
        if self.members is None or (given is None and self.members == 1):
            return given
        return (given or Ensemble(repeats=2)).model_copy(update={"repeats": self.members})

    def overrides(self, deck: Deck) -> list[str]:
        """Overrides that set these cells in a deck. Raises DeckError."""
        if self.cells is None:
            return []
        return [toml.assigned(key, value) for key, value in meshes.settings(deck, self.cells).items()]


#: the study as its file has it
AS_IT_IS = Size()
