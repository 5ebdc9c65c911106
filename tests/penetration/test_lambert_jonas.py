"""Lambert-Jonas: the curve, its special cases, and the fit."""

import math

import numpy as np
import pytest

from hydro2d.penetration import lambert_jonas as lj
from hydro2d.penetration.model import InputError


@pytest.mark.parametrize(("a", "p", "V50"), [(0.93, 2.7, 900.0), (1.0, 2.0, 1250.0), (0.8, 5.0, 400.0), (0.97, 1.4, 700.0)])
def test_fit_finds_the_constants_of_exact_shots(a, p, V50):
    """Shots that perforated, and one below the limit that did not."""
    velocities = V50 * np.array([0.98, 1.01, 1.03, 1.06, 1.1, 1.2, 1.4, 1.7])
    left = [lj.residual_velocity(v, limit_velocity=V50, a=a, p=p) for v in velocities]
    fitted = lj.fit(velocities, left)
    assert (fitted.a, fitted.p, fitted.limit_velocity) == pytest.approx((a, p, V50), rel=1e-5)
    assert fitted.shots == 8
    fixed = lj.fit(velocities, left, p=p)
    assert (fixed.a, fixed.limit_velocity) == pytest.approx((a, V50), rel=1e-6)
    assert fixed.p == p


def test_fit_of_scattered_shots_is_a_minimum():
    rng = np.random.default_rng(4)
    velocities = np.linspace(920.0, 1700.0, 15)
    exact = np.array([lj.residual_velocity(v, limit_velocity=900.0, a=0.93, p=2.7) for v in velocities])
    left = exact + rng.normal(0.0, 8.0, 15)
    fitted = lj.fit(velocities, left)

    def squares(a, p, V50):
        values = {"limit_velocity": V50, "a": a, "p": p}
        return sum((lj.residual_velocity(v, **values) - r) ** 2 for v, r in zip(velocities, left, strict=True))

    best = squares(fitted.a, fitted.p, fitted.limit_velocity)
    assert fitted.standard_error == pytest.approx(math.sqrt(best / 12.0), rel=1e-9)
    assert best <= squares(0.93, 2.7, 900.0)
    for nudge in (0.999, 1.001):
        assert squares(fitted.a * nudge, fitted.p, fitted.limit_velocity) > best
        assert squares(fitted.a, fitted.p * nudge, fitted.limit_velocity) > best
        assert squares(fitted.a, fitted.p, fitted.limit_velocity * nudge) > best
    assert abs(fitted.limit_velocity - 900.0) < 20.0


@pytest.mark.parametrize(
    ("velocities", "left", "message"),
    [
        ([900.0, 1000.0], [100.0, 300.0], "3 constants needs perforations at 3"),
        ([900.0, 1000.0, 1100.0], [0.0, 0.0, 300.0], "perforations"),
        ([900.0, 1000.0, 1100.0], [100.0, 300.0], "as many residual"),
        ([900.0, 1000.0, 1100.0], [100.0, 300.0, 1200.0], "from 0 up to it"),
        ([900.0, 1000.0, 1100.0], [100.0, -3.0, 500.0], "from 0 up to it"),
        ([900.0, math.nan, 1100.0], [100.0, 300.0, 500.0], "positive velocity"),
    ],
)
def test_shots_that_no_fit_can_take_are_refused(velocities, left, message):
    with pytest.raises(InputError, match=message):
        lj.fit(velocities, left)


def test_impossible_values_are_refused():
    with pytest.raises(InputError, match="p = 0"):
        lj.residual_velocity(1000.0, limit_velocity=900.0, p=0.0)
    with pytest.raises(InputError, match="plate.limit_velocity"):
        lj.MODEL(1000.0, {"plate.limit_velocity": -1.0})
