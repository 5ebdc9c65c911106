"""A draw: what makes one run at a velocity another sample of chance than the next, and nothing else.

The first time step of each draw is shorter by a factor of its own, by up to a thousandth. That changes nothing but rounding,
and what rounding decides.
"""

from __future__ import annotations

import tomllib

import numpy as np

#: deck key that a draw changes; largest relative change
KEY, LARGEST = "numerics.initial_dt_factor", 1e-3


def overrides(text: str, seed: int, number: int) -> list[str]:
    """What a draw changes in a deck, as ``key=value``.

    text : resolved deck;  seed : of the search;  number : of the draw, from 1

    The same seed and number give the same draw of a deck, on any machine.
    """
    section, name = KEY.split(".")
    before = tomllib.loads(text)[section][name]
    return [f"{KEY}={before * (1.0 - LARGEST * np.random.default_rng([seed, number]).random())!r}"]
