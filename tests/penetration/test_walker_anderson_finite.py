"""Walker-Anderson through plates: the pieces at their ends, thick plates, the ballistic limit and its calibration."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

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


@given(st.floats(0.0, 1.0))
def test_blend_is_the_volume_of_a_truncated_hemisphere(share):
    """pi h^2 (R - h/3) over 2 pi R^3/3, 0 where nothing is left and 1 where the rear surface is not reached."""
    assert finite.blend(share) == pytest.approx(share**2 * (1.0 - share / 3.0) * 1.5, abs=1e-15)
    assert (finite.blend(0.0), finite.blend(1.0), finite.blend(2.0)) == (0.0, 1.0, 1.0)


def test_rear_velocity_between_rest_and_the_interface():
    alpha, radius = plastic_extent(900.0, STEEL)[0], 0.009
    reach = (alpha - 1.0) * radius
    speeds = [rear_velocity(900.0, alpha, share * reach, radius) for share in np.linspace(0.0, 1.2, 25)]
    assert speeds[0] == pytest.approx(900.0, rel=1e-12)
    assert speeds[-4:] == [0.0] * 4
    assert (np.diff(speeds) <= 0.0).all()
    assert rear_velocity(900.0, alpha, (1.0 - 1e-9) * reach, radius) == pytest.approx(0.0, abs=1e-4)


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


def test_a_bulge_moves_with_its_own_velocity():
    """The rear surface of a shot that does not perforate: the integral of its velocity over the track."""
    plate = Plate(1000.0, TUNGSTEN, STEEL, 0.060, 1e9)
    track = plate.solve()
    rates = [plate.further(u, plastic_extent(u, STEEL)[0], [v, u, length, depth, bulge, strain])
             for v, u, length, depth, bulge, strain in track.states.T]
    by_trapezia = np.sum(0.5 * np.diff(track.times)[:, None] * (np.array(rates)[1:] + np.array(rates)[:-1]), axis=0)
    assert by_trapezia == pytest.approx(track.states[4:, -1], rel=0.05)
    assert track.states[4, -1] > 0.0


def test_limit_separates():
    limit = limit_velocity(TUNGSTEN, STEEL, 0.060, 0.5)
    assert shoot(limit, TUNGSTEN, STEEL, 0.060, 0.5).perforated
    assert not shoot(limit - 0.02, TUNGSTEN, STEEL, 0.060, 0.5).perforated


def test_limit_rises_with_thickness_strength_and_failure_strain():
    limits = [limit_velocity(TUNGSTEN, STEEL, thickness, 0.5) for thickness in (0.02, 0.04, 0.06, 0.08)]
    assert limits == sorted(limits)
    assert limit_velocity(TUNGSTEN, replace(STEEL, strength=1.4e9), 0.060, 0.5) > limits[2]
    assert limit_velocity(TUNGSTEN, STEEL, 0.060, 0.8) > limits[2]
    assert limit_velocity(TUNGSTEN, STEEL, 2.0, 0.5) == math.inf


@given(st.floats(1150.0, 3000.0), st.floats(1.01, 1.2))
@settings(max_examples=15)
def test_residual_velocity_rises_and_stays_below_the_impact(velocity, factor):
    slow, fast = (shoot(each, TUNGSTEN, STEEL, 0.060, 0.5) for each in (velocity, factor * velocity))
    assert slow.perforated
    assert 0.0 < slow.residual_velocity < fast.residual_velocity < factor * velocity
    assert slow.residual_length < TUNGSTEN.length


@given(st.floats(0.01, 0.2), st.floats(300.0, 3000.0))
@settings(max_examples=20)
def test_kinetic_energy_of_the_rod_never_grows(thickness, velocity):
    plate = Plate(velocity, TUNGSTEN, STEEL, thickness, 0.5)
    v, u, length = plate.solve().states[:3]
    s = np.array([plate.plastic_zone(*pair) for pair in zip(v, u, strict=True)])
    energy = (length - s) * v * v + s * (v * v + v * u + u * u) / 3.0
    assert energy[-1] <= energy[0]
    assert (np.diff(v) <= 1e-6 * velocity).all()


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


def test_model():
    result = MODEL(1500.0, VALUES)
    assert result["regime"] == "perforated"
    assert result["limit_velocity"] == pytest.approx(1141.4, abs=0.5)
    assert result["strain"] == pytest.approx(0.5, rel=1e-6)
    assert result["depth"] <= 0.060 + result["bulge"]
    assert MODEL(1000.0, VALUES)["residual_velocity"] == 0.0


@pytest.mark.parametrize("name", ["target.thickness", "target.failure_strain", "rod.length"])
def test_wrong_input(name):
    with pytest.raises(InputError, match=name):
        MODEL(1500.0, {**VALUES, name: -1.0})
    with pytest.raises(InputError, match="velocity"):
        MODEL(0.0, VALUES)
