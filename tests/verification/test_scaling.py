"""Without rates and rate effects there is no length scale: a shot 2^n times as large has the same bits, at later times."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, contact, mesh, stop, table

METALS = "".join(
    table(f"materials.{name}", based_on=base,
          strength={"model": "elastic-plastic", "yield_stress": strength, "shear_modulus": shear})
    for name, base, strength, shear in (("hard", "W_alloy", 1.5e9, 136e9), ("soft", "Al5083", 0.3e9, 26e9)))
KINDS = {
    "bonded": table("numerics", advection="momentum"),
    "both": table("numerics", advection="both", mixed_strength="solid"),
    "slip-layer": table("sliding", method="slip-layer", hard=["ball"], shear="shear", friction=0.1),
    "contact": contact("ball", friction=0.1),
}


def shot(power: int, kind: str, cycles: int = 60) -> Simulation:
    """A ball that hits a plate with a foil behind it, everything 2^power times as long."""
    size = 2.0**power
    text = (
        mesh([{"to": 0.012 * size, "cells": 12}], [{"to": 0.024 * size, "cells": 24}])
        + table("boundaries", z_max="transmit")
        + body("ball", "hard", "sphere", centre=0.0081 * size, radius=0.0037 * size, velocity=1200.0)
        + box("plate", "soft", r=[0.0, 0.0102 * size], z=[0.0121 * size, 0.0163 * size])
        + box("foil", "soft", r=[0.0, 0.0102 * size], z=[0.0171 * size, 0.0174 * size], velocity=200.0)
        + stop(1.0, cycles=cycles)
        + METALS + KINDS[kind]
    )
    simulation = Simulation(deck.loads(text))
    while simulation.stop_reason() is None:
        simulation.step()
    return simulation


@pytest.mark.thorough
@pytest.mark.parametrize("kind", KINDS)
def test_lengths_times_a_power_of_two(kind):
    one = shot(0, kind)
    assert one.state.vof[:, 2:-2, 2:-2].min() == 0.0
    assert np.abs(one.state.v).max() > 1000.0
    for power in (*range(-10, 0), *range(1, 11)):
        other = shot(power, kind)
        assert other.time == one.time * 2.0**power
        for name in ("vof", "q", "centroid", "u", "v", "pm"):
            np.testing.assert_array_equal(getattr(other.state, name), getattr(one.state, name), err_msg=f"{name}, 2^{power}")
