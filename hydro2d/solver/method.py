"""The choices of a deck as the numbers that kernels take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hydro2d.deck import deck as decks
from hydro2d.kernels import mixed_strength, momentum, sliding
from hydro2d.mesh.boundary_conditions import BoundaryConditions


@dataclass(frozen=True)
class Method:
    """The choices of a deck that `Cycle` needs; see the deck's `numerics`, `sliding`, `failure` and `boundaries`."""

    advection: int
    ke_bound: float
    courant: float
    shock_courant: float
    advective_courant: float
    max_growth: float
    ramp_cycles: int
    initial_dt_factor: float
    dt_min: float
    viscosity_linear: float
    viscosity_quadratic: float
    hourglass: float
    steepness: float
    tipton: bool
    relaxation: float
    mixed_strength: int
    cutoff: float
    mass_floor: float
    active_region: bool
    interface_order: np.ndarray
    smallest_tension: bool
    max_opening: float
    strength_cutoff: float
    hard: np.ndarray
    threshold: float
    slip_widths: tuple[float, float] | None
    shear: int
    friction: float
    refresh: int
    yield_factor: np.ndarray
    group: np.ndarray
    boundaries: BoundaryConditions

    @property
    def by_what_is_solid(self) -> bool:
        """Whether the strength of a mixed cell is the mean over the volume of the materials, not over that of the cell."""
        return self.mixed_strength == mixed_strength.SOLID

    @property
    def both(self) -> bool:
        """Whether the advection keeps kinetic energy and momentum."""
        return self.advection == momentum.BOTH

    @classmethod
    def from_deck(cls, deck, slots: list[str], widths: tuple[float, float], factor: float) -> Method:
        """Translates the words of a deck; slots are the bodies in their order in the arrays."""
        n, slide, failure = deck.numerics, deck.sliding, deck.failure
        order = list(n.interface_order) + [name for name in slots if name not in n.interface_order]
        layer = slide.method == "slip-layer"
        hard = np.array([layer and name in slide.hard for name in slots])
        group = np.array(decks.body_groups(deck), dtype=np.int64)
        return cls(
            advection=momentum.ADVECTIONS.index(n.advection),
            ke_bound=n.ke_bound,
            courant=n.courant,
            shock_courant=n.shock_courant,
            advective_courant=n.advective_courant,
            max_growth=n.max_growth,
            ramp_cycles=n.ramp_cycles,
            initial_dt_factor=n.initial_dt_factor,
            dt_min=n.dt_min,
            viscosity_linear=n.viscosity_linear,
            viscosity_quadratic=n.viscosity_quadratic,
            hourglass=n.hourglass,
            steepness=n.steepness,
            tipton=n.mixed_cell == "tipton",
            relaxation=n.relaxation,
            mixed_strength=mixed_strength.STRENGTH_MODES.index(n.mixed_strength),
            cutoff=n.cutoff,
            mass_floor=n.mass_floor,
            active_region=n.active_region,
            interface_order=np.array([slots.index(name) for name in order], dtype=np.int64),
            smallest_tension=failure.tension == "min",
            max_opening=failure.max_opening,
            strength_cutoff=failure.strength_cutoff,
            hard=hard,
            threshold=slide.threshold,
            slip_widths=widths if layer else None,
            shear=sliding.SHEARS.index(slide.shear),
            friction=slide.friction,
            refresh=slide.refresh,
            yield_factor=np.where(hard | (group == 1), factor, 1.0) * decks.strength_factors(deck),
            group=group,
            boundaries=BoundaryConditions.of(deck.boundaries.model_dump()),
        )
