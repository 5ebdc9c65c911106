"""Numbers of small decks with all models after some cycles. A fault in any kernel or scalar function of a cycle moves them.

They say that something has changed, not whether it is right: exact problems and properties do. Where a change is meant, the
version of the method (tests/solver/test_method.py) and these numbers change with it.
"""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.kernels.test_compiled_equals_source import CONTACT, LAYER, text_of

CYCLES = 8
#: round-off on other processors, after so few cycles
SAME = 1e-9
DECKS = {"contact": text_of("both", CONTACT, tip="5 mm", follows=False), "slip layer": text_of("both", LAYER),
         "following": text_of("ke", CONTACT)}


def numbers(simulation: Simulation) -> list[float]:
    """Time, and sums of the magnitudes of all that a run continues from: rows of q, fractions, velocities, centroids."""
    state = simulation.state
    arrays = (*state.q, state.vof, state.u, state.v, *state.centroid)
    return [simulation.time, *(float(np.abs(array).sum()) for array in arrays)]


NUMBERS = {
    "contact": [2.9927543013e-07, 6852779.3247, 7193843.6485, 28825493458, 39613723881, 25404722203, 6.7629249141, 0,
        1660509468, 2772967497.7, 2143575866.5, 566.94289337, 219.70496182, 11374.402803, 180688.97758, 5.9363528107,
        9.1497834812],
    "slip layer": [3.1351395431e-07, 7143486.6292, 4955071.0169, 20854088603, 47336525857, 14681191236, 3.6062392521, 0,
        916112805.74, 1518213192, 809372336.03, 555.27709636, 275.36809337, 1366.6552073, 103494.65044, 3.7132990585,
        8.8535846526],
    "following": [2.9753445926e-07, 7354666.9679, 3660985.2514, 13114520985, 23777890407, 15089206620, 4.2138199389,
        2.3801312746, 287.09392876, 11361.325311, 172602.78474, 4.6596888672, 9.7596092486],
}


@pytest.mark.parametrize("name", DECKS)
def test_numbers_of_small_decks(name):
    simulation = Simulation(deck.loads(DECKS[name]))
    for _ in range(CYCLES):
        simulation.step()
    assert numbers(simulation) == pytest.approx(NUMBERS[name], rel=SAME)
