"""Films of a soft body in a slot of a hard one that moves, like those in the folds of a swollen rod.

Nodes of such a film have no cell of their body nearby. Their extension used to have weights of 2.75 and -2.25, and grew four
times in every step.
"""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, contact, material, mesh, stop, walls

CELL = 0.5  # mm
SPEED = 1000.0



def slotted_rod(thick: float, at: float, faster: float, around: float | None) -> Simulation:
    """A rod with a ring-shaped slot of two and a half cells, and a film of `thick` cells in the middle of it.

    at is a shift by a share of a cell, faster the velocity of the film relative to the rod, around that of a tube in which the
    rod moves, None without one.
    """
    slot, root, rim = np.array([20.0 + at, 22.5 + at]) * CELL, 4 * CELL, 8.3 * CELL
    middle, half = slot.mean(), 0.5 * thick * CELL
    low, high, foot, end = *slot, 8 * CELL, 34 * CELL
    outline = [(0, foot), (rim, foot), (rim, low), (root, low), (root, high), (rim, high), (rim, end), (0, end)]
    tube = "" if around is None else box("tube", "Al5083", r=[f"{rim} mm", "8 mm"], z=[0.0, "30 mm"], velocity=around)
    return Simulation(decks.loads(
        mesh(("8 mm", f"{CELL} mm"), ("30 mm", f"{CELL} mm"))
        + walls("r_max")
        + material("metal", "W_alloy",
                   strength={"model": "elastic-plastic", "shear_modulus": "145 GPa", "yield_stress": "2 GPa"})
        + body("rod", "metal", "polygon", points=[[f"{r} mm", f"{z} mm"] for r, z in outline], velocity=SPEED)
        + box("film", "Al5083", r=[f"{root} mm", f"{rim} mm"], z=[f"{middle - half} mm", f"{middle + half} mm"],
              velocity=SPEED + faster)
        + tube
        + contact("rod")
        + stop("1 s")
    ))


@pytest.mark.parametrize("thick", [0.01, 0.03, 0.1, 0.3])
@pytest.mark.parametrize(("faster", "around"), [(0.0, None), (100.0, None), (0.0, 800.0), (300.0, 0.0)],
                         ids=["at rest", "meets a side", "in a slow tube", "in a tube at rest"])
def test_a_film_in_a_fold_is_stable(thick, faster, around):
    """In 500 cycles nothing is much faster than the rod and its film, and the energy is kept (at worst 3e-13)."""
    simulation = slotted_rod(thick, 0.37, faster, around)
    fastest = 0.0
    for _ in range(500):
        simulation.step()
        fastest = max(fastest, float(np.abs(simulation.state.velocity).max()))
    assert fastest < 1.5 * (SPEED + faster)
    assert abs(simulation.conservation()["total_energy"]) < 1e-12
