"""The choices of a deck as the numbers that kernels take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hydro2d.deck import deck as decks
from hydro2d.kernels import mixed, momentum, sliding


@dataclass(frozen=True)
class Method:
    """What `Cycle` needs to know of a deck; see the deck's `numerics`, `sliding`, `failure` and `boundaries`."""

    choice: int
    ke_bound: float
    courant: float
    advective: float
    growth: float
    ramp_cycles: int
    first: float
    dt_min: float
    linear: float
    quadratic: float
    hourglass: float
    tipton: bool
    relaxation: float
    strength_mode: int
    trace: float
    mass_floor: float
    active_region: bool
    order: np.ndarray
    smallest_tension: bool
    max_opening: float
    loose: float
    hard: np.ndarray
    threshold: float
    slip_widths: tuple[float, float] | None
    shear: int
    friction: float
    refresh: int
    factor: np.ndarray
    contact: bool
    group: np.ndarray
    mirrors: tuple[bool, bool, bool, bool]
    opens: tuple[bool, bool, bool, bool]
    transmits: tuple[bool, bool, bool, bool]

    @classmethod
    def from_deck(cls, deck, slots: list[str], widths: tuple[float, float], factor: float) -> Method:
        """Translates the words of a deck; slots are the bodies in their order in the arrays."""
        n, slide, failure, edge = deck.numerics, deck.sliding, deck.failure, deck.boundaries
        order = list(n.interface_order) + [name for name in slots if name not in n.interface_order]
        layer = slide.method == "slip-layer"
        hard = np.array([layer and name in slide.hard for name in slots])
        group = np.array(decks.body_groups(deck), dtype=np.int64)
        kinds = (edge.r_min, edge.r_max, edge.z_min, edge.z_max)
        return cls(
            choice=momentum.CHOICES.index(n.advection),
            ke_bound=n.ke_bound,
            courant=n.courant,
            advective=n.advective_courant,
            growth=n.max_growth,
            ramp_cycles=n.ramp_cycles,
            first=n.initial_dt_factor,
            dt_min=n.dt_min,
            linear=n.viscosity_linear,
            quadratic=n.viscosity_quadratic,
            hourglass=n.hourglass,
            tipton=n.mixed_cell == "tipton",
            relaxation=n.relaxation,
            strength_mode=mixed.STRENGTH_MODES.index(n.mixed_strength),
            trace=n.trace,
            mass_floor=n.mass_floor,
            active_region=n.active_region,
            order=np.array([slots.index(name) for name in order], dtype=np.int64),
            smallest_tension=failure.tension == "min",
            max_opening=failure.max_opening,
            loose=failure.loose,
            hard=hard,
            threshold=slide.threshold,
            slip_widths=widths if layer else None,
            shear=sliding.SHEARS.index(slide.shear),
            friction=slide.friction,
            refresh=slide.refresh,
            factor=np.where(hard | (group == 1), factor, 1.0),
            contact=slide.method == "contact",
            group=group,
            mirrors=tuple(kind in ("wall", "axis") for kind in kinds),
            opens=tuple(kind in ("outflow", "transmit") for kind in kinds),
            transmits=tuple(kind == "transmit" for kind in kinds),
        )
