"""The uniform collapse against printed values and against the equations of motion."""

import numpy as np
import pytest

from problems.verification.exact.collapse import Collapse

#: at t = 0.1, j: density, pressure, energy; as ExactPack's tests have them
PRINTED = [(1, 1.1111111111, 0.7946414688, 1.0727659829), (2, 1.2345679012, 0.9471825959, 1.1508268541),
           (3, 1.3717421125, 1.1290058539, 1.2345679012)]  # fmt: skip


@pytest.mark.parametrize(("j", "rho", "p", "e"), PRINTED)
def test_printed_states(j, rho, p, e):
    assert Collapse(j).at(0.1) == pytest.approx((rho, p, e), rel=1e-9)
    assert Collapse(j).velocity(0.26666666667, 0.1) == pytest.approx(-0.2962962963, rel=1e-9)


def test_what_is_untouched():
    """The path of the first sound from the surface, by integration."""
    found = Collapse(e0=0.05)
    radius, time, steps = 1.0, 0.0, 100000
    for _ in range(steps):
        middle = time + 0.25 / steps
        _, _, e = found.at(middle)
        c = np.sqrt(5.0 / 3.0 * 2.0 / 3.0 * e)
        radius += 0.5 / steps * (float(found.velocity(radius, middle)) - c)
        time += 0.5 / steps
    assert found.untouched(1.0, 0.5) == pytest.approx(radius, rel=1e-4)
