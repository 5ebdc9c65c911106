"""The choices of a deck for its cycles: its sections about the method, and what kernels take in place of words."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hydro2d.base.method_sections import Failure, Numerics, Sliding
from hydro2d.deck import deck as decks
from hydro2d.kernels import mixed_strength, momentum, sliding
from hydro2d.mesh.boundary_conditions import BoundaryConditions


@dataclass(frozen=True)
class Method:
    """The choices of a deck that `Cycle` needs.

    numerics, sliding, failure : the sections of the deck, for their numbers;  group : int64[m], body group;  hard_bodies :
    bool[m], hard in a slip layer;  interface_order : int64[m], bodies in the order in which interfaces are drawn;
    slip_widths : m, of the boundary and of the slip layer, (0, 0) without a slip layer;  yield_factor : float64[m]
    """

    numerics: Numerics
    sliding: Sliding
    failure: Failure
    group: np.ndarray
    hard_bodies: np.ndarray
    interface_order: np.ndarray
    slip_widths: tuple[float, float]
    yield_factor: np.ndarray
    boundaries: BoundaryConditions

    @property
    def slip_layer(self) -> bool:
        """Whether there is a slip layer."""
        return self.sliding.method == "slip-layer"

    @property
    def advection(self) -> int:
        """Index of the advection."""
        return momentum.ADVECTIONS.index(self.numerics.advection)

    @property
    def both(self) -> bool:
        """Whether the advection keeps kinetic energy and momentum."""
        return self.advection == momentum.BOTH

    @property
    def tipton(self) -> bool:
        """Whether mixed cells relax their pressures."""
        return self.numerics.mixed_cell == "tipton"

    @property
    def strength_mode(self) -> int:
        """Index of the rule for the strength of a mixed cell."""
        return mixed_strength.STRENGTH_MODES.index(self.numerics.mixed_strength)

    @property
    def by_what_is_solid(self) -> bool:
        """Whether the strength of a mixed cell is the mean over the volume of the materials, not over that of the cell."""
        return self.strength_mode == mixed_strength.SOLID

    @property
    def smallest_tension(self) -> bool:
        """Whether the weakest body decides where a cell fractures."""
        return self.failure.tension == "min"

    @property
    def shear(self) -> int:
        """Index of the slip layer's treatment of shear."""
        return sliding.SHEARS.index(self.sliding.shear)

    @classmethod
    def from_deck(cls, deck, slots: list[str], widths: tuple[float, float], factor: float) -> Method:
        """The choices of a deck; slots are the bodies in their order in the arrays."""
        order = list(deck.numerics.interface_order) + [name for name in slots if name not in deck.numerics.interface_order]
        layer = deck.sliding.method == "slip-layer"
        hard = np.array([layer and name in deck.sliding.hard for name in slots])
        group = np.array(decks.body_groups(deck), dtype=np.int64)
        return cls(
            numerics=deck.numerics,
            sliding=deck.sliding,
            failure=deck.failure,
            group=group,
            hard_bodies=hard,
            interface_order=np.array([slots.index(name) for name in order], dtype=np.int64),
            slip_widths=widths if layer else (0.0, 0.0),
            yield_factor=np.where(hard | (group == 1), factor, 1.0) * decks.strength_factors(deck),
            boundaries=BoundaryConditions.of(deck.boundaries.model_dump()),
        )
