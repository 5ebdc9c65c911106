"""Walker-Anderson: worked numbers, the printed equations themselves, and the limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.penetration import walker_anderson
from hydro2d.penetration.centreline import Centreline, Rod, Target, plastic_extent
from hydro2d.penetration.model import InputError
from hydro2d.penetration.walker_anderson import MODEL, penetrate, resistance, rigid_stress, transition_velocity

TUNGSTEN = Rod(17600.0, 2.0e9, 323e9, 4030.0, 1.237, 0.010, 0.100)
STEEL = Target(7850.0, 1.2e9, 77.5e9, 4500.0, 1.49)
ALUMINIUM = Target(2710.0, 0.35e9, 26e9, 5340.0, 1.40)
VALUES = {
    **{f"rod.{name}": value for name, value in vars(TUNGSTEN).items()},
    **{f"target.{name}": value for name, value in vars(STEEL).items()},
}


@pytest.mark.parametrize(
    ("target", "extents"),
    [(STEEL, (9.322674, 8.946009, 7.799907, 6.594554, 5.631580, 4.400322, 3.706185)),
     (ALUMINIUM, (10.512495, 10.088095, 8.818682, 7.443243, 6.317711, 4.859389, 4.033755))],
)
def test_extent_of_the_plastic_flow(target, extents):
    velocities = (100.0, 250.0, 500.0, 750.0, 1000.0, 1500.0, 2000.0)
    assert [plastic_extent(u, target)[0] for u in velocities] == pytest.approx(extents, abs=1e-6)


@pytest.mark.parametrize(
    ("strength", "velocity", "ratio"),
    [(1.2e9, 1000.0, 0.3741), (1.2e9, 1250.0, 0.6417), (1.2e9, 1500.0, 0.8945), (1.2e9, 1750.0, 1.0984),
     (1.2e9, 2000.0, 1.2506), (1.4e9, 1000.0, 0.3086), (1.4e9, 1250.0, 0.5498), (1.4e9, 1500.0, 0.7943),
     (1.4e9, 1750.0, 1.0024), (1.4e9, 2000.0, 1.1651)],
)
def test_worked_depths(strength, velocity, ratio):
    result = MODEL(velocity, {**VALUES, "target.strength": strength})
    assert result["depth_over_length"] == pytest.approx(ratio, abs=6e-5)
    assert result["depth"] == pytest.approx(0.1 * ratio, abs=6e-6)
    assert result["regime"] == "eroding"


@pytest.mark.parametrize(
    ("velocity", "first", "radius", "duration"),
    [(1000.0, 647.0, 7.175, 156.3), (1250.0, 804.0, 7.950, 155.3), (1500.0, 959.7, 8.8175, 149.7),
     (1750.0, 1114.3, 9.7775, 141.7), (2000.0, 1267.9, 10.830, 132.9)],
)
def test_worked_first_velocity_crater_and_duration(velocity, first, radius, duration):
    result = MODEL(velocity, VALUES)
    assert result["interface_velocity"] == pytest.approx(first, abs=0.06)
    assert result["crater_radius"] == pytest.approx(1e-3 * radius, abs=1e-8)
    assert result["duration"] == pytest.approx(1e-6 * duration, abs=0.06e-6)


def test_erosion_ends_before_the_rod_at_high_velocity():
    """At 2.5 km/s tail and interface meet at P/L = 1.4386; the stub goes on rigid."""
    track = penetrate(2500.0, TUNGSTEN, STEEL)
    assert track.eroding_depth / TUNGSTEN.length == pytest.approx(1.43863, abs=2e-5)
    assert track.regime == "eroding, then rigid"
    assert 1.0 < track.depth / track.eroding_depth < 1.01


@given(st.floats(1.0, 3000.0))
@settings(max_examples=50)
def test_extent_solves_the_printed_equation_and_its_slope_is_right(u):
    alpha, slope = plastic_extent(u, STEEL)
    rho, y, g = STEEL.density, STEEL.strength, STEEL.shear_modulus
    k = rho * (STEEL.sound_speed + STEEL.hugoniot_slope * u) ** 2
    left = (1.0 + rho * u * u / y) * math.sqrt(k - rho * (alpha * u) ** 2)
    right = (1.0 + rho * (alpha * u) ** 2 / (2.0 * g)) * math.sqrt(k - rho * u * u)
    assert left == pytest.approx(right, rel=1e-12)
    step = 1e-3 * u
    difference = (plastic_extent(u + step, STEEL)[0] - plastic_extent(u - step, STEEL)[0]) / (2.0 * step)
    assert slope == pytest.approx(difference, abs=1e-6 * alpha / u)


@given(st.floats(300.0, 2000.0), st.floats(0.2, 0.9))
@settings(max_examples=40)
def test_rates_satisfy_the_printed_equations(v, share):
    """(54) and (55) with the time derivatives of s, alpha and (v - u)/s taken by differences."""
    motion = Centreline(1500.0, TUNGSTEN, STEEL)
    u, length, rho, radius = share * v, 0.08, TUNGSTEN.density, motion.radius
    v_t, u_t, length_t, depth_t = motion.eroding(0.0, np.array([v, u, length, 0.0]))
    assert (length_t, depth_t) == (u - v, u)

    def along(t):
        now, slow = v + v_t * t, u + u_t * t
        s = motion.plastic_zone(now, slow)
        return np.array([s, (now - slow) / s, plastic_extent(slow, STEEL)[0]])

    step = 1e-4 * min(abs(u / u_t), abs(v / v_t))
    s_t, gradient_t, alpha_t = (along(step) - along(-step)) / (2.0 * step)
    s, _, alpha = along(0.0)
    left = (
        rho * v_t * (length - s)
        + u_t * (rho * s + STEEL.density * radius * (alpha - 1.0) / (alpha + 1.0))
        + 0.5 * rho * s * s * gradient_t
        + STEEL.density * alpha_t * 2.0 * radius * u / (alpha + 1.0) ** 2
    )
    right = 0.5 * rho * (v - u) ** 2 - 0.5 * STEEL.density * u * u - 7.0 / 3.0 * STEEL.strength * math.log(alpha)
    scale = rho * v * v + 7.0 / 3.0 * STEEL.strength * math.log(alpha)
    assert left == pytest.approx(right, abs=1e-6 * scale)
    bar = math.sqrt(TUNGSTEN.youngs_modulus / rho)
    decelerated = -TUNGSTEN.strength / (rho * (length - s)) * (1.0 + (v - u + s_t) / bar)
    assert v_t == pytest.approx(decelerated, rel=1e-6)


def tate(velocity: float, rod: Rod, target: Target) -> float:
    """Depth by Tate's three equations with Rt(u) = (7/3) Yt ln(alpha(u)): integrated here over the velocity of the tail.

    dv = -Yp/(rho_p L) dt gives d(ln L) = rho_p (v - u)/Yp dv and dP = -u rho_p L/Yp dv.
    """

    def interface(v):
        low, high = 0.0, v
        for _ in range(60):
            u = 0.5 * (low + high)
            push = 0.5 * rod.density * (v - u) ** 2 + rod.strength
            low, high = (u, high) if push > 0.5 * target.density * u * u + resistance(u, target) else (low, u)
        return low

    critical = math.sqrt(2.0 * (resistance(0.0, target) - rod.strength) / rod.density)
    tail = np.linspace(critical, velocity, 1001)
    u = np.array([interface(v) for v in tail])
    eroded = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(tail) * ((tail - u)[1:] + (tail - u)[:-1]))])
    length = rod.length * np.exp(rod.density / rod.strength * (eroded - eroded[-1]))
    return float(np.sum(0.5 * np.diff(tail) * ((u * length)[1:] + (u * length)[:-1])) * rod.density / rod.strength)


@pytest.mark.parametrize("velocity", [1000.0, 1500.0])
def test_tends_to_tate(velocity):
    """s and Rc to 0, c to infinity: the difference falls with Rc, and is below 1 % where Rc = D/2000."""
    expected = tate(velocity, TUNGSTEN, STEEL)
    misses = []
    for radius in (5e-4, 5e-5, 5e-6):
        stiff = replace(TUNGSTEN, youngs_modulus=323e9 * (5e-3 / radius) ** 2)
        misses.append(abs(penetrate(velocity, stiff, STEEL, radius).depth / expected - 1.0))
    assert misses[0] > 3.0 * misses[1] > 9.0 * misses[2]
    assert misses[-1] < 0.01


def test_resistance_is_that_of_the_limit():
    alpha = plastic_extent(800.0, STEEL)[0]
    assert resistance(800.0, STEEL) == pytest.approx(7.0 / 3.0 * 1.2e9 * math.log(alpha), rel=1e-14)


@given(st.floats(20.0, 1100.0), st.floats(1.01, 1.06))
@settings(max_examples=20)
def test_depth_rises_with_velocity_while_the_rod_is_rigid(velocity, factor):
    strong = replace(TUNGSTEN, strength=3.5e9)
    assert factor * velocity < transition_velocity(strong, ALUMINIUM)
    assert penetrate(factor * velocity, strong, ALUMINIUM).depth > penetrate(velocity, strong, ALUMINIUM).depth


@given(st.floats(20.0, 4000.0), st.sampled_from([STEEL, ALUMINIUM]), st.floats(0.5e9, 4.0e9))
@settings(max_examples=30)
def test_the_rods_kinetic_energy_never_grows(velocity, target, strength):
    rod = replace(TUNGSTEN, strength=strength)
    motion = Centreline(velocity, rod, target)
    v, u, length, depth = motion.solve().states[:4]
    s = np.array([motion.plastic_zone(*pair) for pair in zip(v, u, strict=True)])
    energy = (length - s) * v * v + s * (v * v + v * u + u * u) / 3.0
    assert (np.diff(energy) <= 1e-6 * energy[0]).all()
    assert (np.diff(v) <= 1e-6 * velocity).all()
    assert (np.diff(length) <= 1e-6 * rod.length).all()
    assert (np.diff(depth) >= 0.0).all()


def test_transition():
    """At its own transition velocity the rigid nose carries the rod's strength; weak rods and huge strengths have none."""
    strong = replace(TUNGSTEN, strength=3.0e9)
    velocity = transition_velocity(strong, ALUMINIUM)
    assert rigid_stress(velocity, strong, ALUMINIUM) == pytest.approx(strong.strength, rel=1e-9)
    below, above = (penetrate(factor * velocity, strong, ALUMINIUM).states[2, -1] for factor in (0.8, 1.3))
    assert below > 0.98 * strong.length
    assert above < 0.95 * strong.length
    assert transition_velocity(TUNGSTEN, STEEL) == 0.0
    assert transition_velocity(replace(TUNGSTEN, strength=1e12), ALUMINIUM) is None


def test_transition_of_a_long_rod_is_tates_with_the_limits_resistance():
    strong = replace(TUNGSTEN, strength=3.0e9, length=1e5)
    velocity = transition_velocity(strong, ALUMINIUM)
    expected = math.sqrt(2.0 * (3.0e9 - resistance(velocity, ALUMINIUM)) / ALUMINIUM.density)
    assert velocity == pytest.approx(expected, rel=1e-4)


def test_slow_impacts_and_short_rods_come_to_an_end():
    assert penetrate(1.0, TUNGSTEN, STEEL).depth < 1e-6
    assert penetrate(1500.0, replace(TUNGSTEN, length=0.001), STEEL).regime == "consumed"


@pytest.mark.parametrize(
    ("changes", "message"),
    [({"rod.strength": -1.0}, r"rod\.strength"), ({"target.strength": 0.0}, r"target\.strength"),
     ({"crater.radius": 0.0}, r"crater\.radius"), ({"target.strength": 200e9}, r"target\.shear_modulus"),
     ({"target.hugoniot_slope": 0.1, "target.sound_speed": 100.0}, "faster than a shock")],
)
def test_wrong_input(changes, message):
    with pytest.raises(InputError, match=message):
        MODEL(1500.0, {**VALUES, **changes})


def test_an_unfinished_motion_is_reported(monkeypatch):
    monkeypatch.setattr("hydro2d.penetration.centreline.LONGEST", 1e-3)
    with pytest.raises(InputError, match="do not come to an end"):
        walker_anderson.penetrate(1500.0, TUNGSTEN, STEEL)
