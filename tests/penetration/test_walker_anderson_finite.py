"""Walker-Anderson through plates: the pieces at their ends, thick plates, the ballistic limit and its calibration."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hydro2d.penetration import walker_anderson_finite as finite
from hydro2d.penetration.centreline import Rod, Target, plastic_extent
from hydro2d.penetration.model import InputError
from hydro2d.penetration.walker_anderson import penetrate
from hydro2d.penetration.walker_anderson_finite import MODEL, Plate, calibrate, limit_velocity, rear_velocity, shoot

TUNGSTEN = Rod(17600.0, 2.0e9, 323e9, 4030.0, 1.237, 0.010, 0.100)
STEEL = Target(7850.0, 1.2e9, 77.5e9, 4500.0, 1.49)
VALUES = {
    **{f"rod.{name}": value for name, value in vars(TUNGSTEN).items()},
    **{f"target.{name}": value for name, value in vars(STEEL).items()},
    "target.thickness": 0.060,
    "target.failure_strain": 0.5,
}


@pytest.mark.parametrize("velocity", [700.0, 1500.0, 2500.0])
def test_a_thick_plate_is_a_semi_infinite_target(velocity):
    shot, deep = shoot(velocity, TUNGSTEN, STEEL, 1.0, 0.5), penetrate(velocity, TUNGSTEN, STEEL)
    assert shot.depth == pytest.approx(deep.depth, rel=1e-6)
    assert shot.duration == pytest.approx(float(deep.times[-1]), rel=1e-6)
    assert shot.residual_length == pytest.approx(float(deep.states[2, -1]), rel=1e-6)
    assert (shot.perforated, shot.residual_velocity, shot.bulge, shot.strain) == (False, 0.0, 0.0, 0.0)
    assert shot.regime == deep.regime


def test_rear_velocity_is_the_deep_one_to_the_power_of_the_blend():
    """u [(36/4^2 - 1)/(36 - 1)]^beta for alpha = 6 and h = 3 Rc, x = 3/5, beta = 0.54 - 0.108."""
    expected = 500.0 * (1.25 / 35.0) ** 0.432
    assert rear_velocity(500.0, 6.0, 0.03, 0.01) == pytest.approx(expected, rel=1e-12)


def test_strain_rate_as_printed():
    assert finite.strain_rate(600.0, 0.01, 0.01) == pytest.approx(4.0 / 3.0 * 0.25 * 600.0 / 0.02, rel=1e-14)


def test_resistance_goes_from_the_deep_one_to_nothing():
    plate = Plate(1500.0, TUNGSTEN, STEEL, 0.05, 0.5)
    alpha = plastic_extent(900.0, STEEL)[0]
    deep = 0.5 * STEEL.density * 900.0**2 + 7.0 / 3.0 * STEEL.strength * math.log(alpha)

    def resisting(ahead):
        return plate.resisting(900.0, alpha, [1500.0, 900.0, 0.1, 0.05 - ahead, 0.0, 0.0])

    assert resisting((alpha - 1.0) * plate.radius) == pytest.approx(deep, rel=1e-12)
    assert resisting(0.0) == pytest.approx(0.0, abs=1e-3)
    values = [resisting(share * alpha * plate.radius) for share in np.linspace(0.0, 1.0, 20)]
    assert (np.diff(values) >= -1e-6 * deep).all()


def test_limit_separates():
    limit = limit_velocity(TUNGSTEN, STEEL, 0.060, 0.5)
    assert shoot(limit, TUNGSTEN, STEEL, 0.060, 0.5).perforated
    assert not shoot(limit - 0.02, TUNGSTEN, STEEL, 0.060, 0.5).perforated


def test_calibration_gives_the_limit_back():
    strain = calibrate(1250.0, TUNGSTEN, STEEL, 0.060)
    assert limit_velocity(TUNGSTEN, STEEL, 0.060, strain) == pytest.approx(1250.0, abs=0.02)
    with pytest.raises(InputError, match="failure_strain"):
        calibrate(300.0, TUNGSTEN, STEEL, 0.5)


def test_one_calibrated_plate_predicts_the_other_of_the_review():
    """29.0 mm stops at 1241 and is the limit at 1250 m/s; 49.5 mm has 1700 m/s. The rod, 5 by 50 mm, is an assumption."""
    rod, armour = Rod(17300.0, 2.0e9, 323e9, 4030.0, 1.237, 0.005, 0.050), replace(STEEL, strength=1.4e9)
    strain = calibrate(1250.0, rod, armour, 0.0290)
    assert strain == pytest.approx(0.702, abs=0.002)
    assert not shoot(1241.0, rod, armour, 0.0290, strain).perforated
    assert limit_velocity(rod, armour, 0.0495, strain) == pytest.approx(1706.2, abs=1.0)


@pytest.mark.parametrize("name", ["target.thickness", "target.failure_strain", "rod.length"])
def test_wrong_input(name):
    with pytest.raises(InputError, match=name):
        MODEL(1500.0, {**VALUES, name: -1.0})
    with pytest.raises(InputError, match="velocity"):
        MODEL(0.0, VALUES)
