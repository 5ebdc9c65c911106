"""The uniform collapse against printed values and against the equations of motion."""

import numpy as np
import pytest

from problems.verification.exact.collapse import Collapse

#: at t = 0.1, j: density, pressure, energy; from ExactPack's tests
PRINTED = [(1, 1.1111111111, 0.7946414688, 1.0727659829), (2, 1.2345679012, 0.9471825959, 1.1508268541),
           (3, 1.3717421125, 1.1290058539, 1.2345679012)]


@pytest.mark.parametrize(("j", "rho", "p", "e"), PRINTED)
def test_printed_states(j, rho, p, e):
    assert Collapse(j).at(0.1) == pytest.approx((rho, p, e), rel=1e-9)
    assert Collapse(j).velocity(0.26666666667, 0.1) == pytest.approx(-0.2962962963, rel=1e-9)


@pytest.mark.parametrize("j", [2, 3])
def test_the_untouched_radius(j):
    """The path of the first sound from the surface, by integration; the collapse takes 2 ms."""
    collapse = Collapse(j, e0=5e4, end=2e-3)
    radius, time, steps = 1.0, 0.0, 20000
    step = 1e-3 / steps
    for _ in range(steps):
        middle = time + 0.5 * step
        c = np.sqrt(5.0 / 3.0 * 2.0 / 3.0 * collapse.at(middle)[2])
        radius += step * (float(collapse.velocity(radius, middle)) - c)
        time += step
    assert collapse.untouched(1.0, 1e-3) == pytest.approx(radius, rel=1e-3)
