"""Tate-Alekseevskii: all regimes against an independent solver and tabulated depths; limits; energy; speed."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hydro2d.penetration import tate
from hydro2d.penetration.model import InputError

#: rods of Scheffler's shots, 97.79 mm of 18 160 kg/m^3, with strengths and resistances of the order that the shots suggest
LENGTH = 0.09779
INTO_5083 = {"rod_density": 18160.0, "rod_strength": 3.4e9, "target_density": 2660.0, "resistance": 1.6e9}
INTO_7039 = {"rod_density": 18160.0, "rod_strength": 4.2e9, "target_density": 2770.0, "resistance": 2.6e9}
WEAK_ROD = {"rod_density": 18160.0, "rod_strength": 2.0e9, "target_density": 2770.0, "resistance": 2.6e9}
FAST = settings(max_examples=40)

density = st.floats(1500.0, 20000.0)
stress = st.floats(3e8, 8e9)
speed = st.floats(100.0, 4000.0)


def depth(velocity, **pair) -> float:
    """P/L."""
    return float(tate.penetrate(velocity, rod_length=LENGTH, **pair).depth[-1]) / LENGTH


def root_of_bernoulli(v, rod_density, rod_strength, target_density, resistance) -> float:
    """u from eq. (28) by a solver that uses no closed form."""
    from scipy.optimize import brentq

    def excess(u):
        return 0.5 * rod_density * (v - u) ** 2 + rod_strength - 0.5 * target_density * u**2 - resistance

    return brentq(excess, 0.0, v, xtol=1e-12)


def by_time(velocity, *, rod_density, rod_strength, target_density, resistance):
    """P/L, l/L and the time of erosion from eqs. (28), (30) and (31), integrated over the time; then eq. (36)."""
    from scipy.integrate import solve_ivp

    pair = (rod_density, rod_strength, target_density, resistance)
    slowest = math.sqrt(2.0 * max((resistance - rod_strength) / rod_density, (rod_strength - resistance) / target_density))

    def rates(t, state):
        v, length = max(state[0], slowest * (1.0 + 1e-10)), state[1]  # trial steps go beyond the end
        u = root_of_bernoulli(v, *pair)
        return -rod_strength / (rod_density * length), u - v, u

    def stops(t, state):
        return state[0] - slowest * (1.0 + 1e-9)

    stops.terminal = True
    solution = solve_ivp(rates, (0.0, 1.0), [velocity, LENGTH, 0.0], method="DOP853", rtol=1e-10, atol=1e-13, events=stops)
    _, length, reached = solution.y[:, -1]
    if rod_strength > resistance:
        reached += length * rod_density / target_density * math.log(rod_strength / resistance)
    return reached / LENGTH, length / LENGTH, float(solution.t[-1])


@pytest.mark.parametrize(
    ("pair", "velocity"),
    [(INTO_5083, 1200.0), (INTO_5083, 1800.0), (INTO_7039, 1100.0), (INTO_7039, 2000.0), (WEAK_ROD, 500.0), (WEAK_ROD, 1500.0),
     ({**WEAK_ROD, "rod_density": 2770.0}, 2000.0), ({**INTO_5083, "rod_density": 2660.0 * (1 + 1e-9)}, 1500.0),
     ({**INTO_5083, "rod_density": 2000.0}, 1500.0)],
)
def test_quadrature_agrees_with_integration_over_time(pair, velocity):
    reached, left, duration = by_time(velocity, **pair)
    track = tate.penetrate(velocity, rod_length=LENGTH, **pair)
    end = max(tate.Pair(**pair).transition_velocity, tate.Pair(**pair).critical_velocity)
    eroding = track.velocity >= end
    assert track.depth[-1] / LENGTH == pytest.approx(reached, rel=1e-7)
    assert track.length[-1] / LENGTH == pytest.approx(left, rel=1e-6)
    assert track.time[eroding][-1] == pytest.approx(duration, rel=1e-6)


@pytest.mark.parametrize(
    ("pair", "velocity", "expected"),
    [
        (INTO_5083, 900.0, 3.514609901060219),
        (INTO_5083, 1086.0, 4.664834112943603),
        (INTO_5083, 1200.0, 5.356212473482502),
        (INTO_5083, 1296.0, 5.760759445157386),
        (INTO_5083, 1500.0, 6.068481148749919),
        (INTO_5083, 2000.0, 5.113066549462787),
        (INTO_5083, 3000.0, 3.2484979188721437),
        (INTO_7039, 1000.0, 2.7995630861443006),
        (INTO_7039, 1165.0, 3.5137577755221305),
        (INTO_7039, 1296.0, 3.9022777120600693),
        (INTO_7039, 2000.0, 4.073637047829905),
        (WEAK_ROD, 1165.0, 1.4902082980691629),
        (WEAK_ROD, 2000.0, 2.246238155432744),
        (WEAK_ROD, 5000.0, 2.5168514775038946),
    ],
)
def test_tabulated_depths(pair, velocity, expected):
    """Depths computed elsewhere, with an independent solver."""
    assert depth(velocity, **pair) == pytest.approx(expected, rel=1e-9)


def test_tabulated_track():
    """1500 m/s into 5083: velocity of the interface, length left, and time of erosion, computed elsewhere."""
    track = tate.penetrate(1500.0, rod_length=LENGTH, **INTO_5083)
    assert track.penetration_velocity[0] == pytest.approx(1288.233153008868, rel=1e-12)
    assert track.length[-1] / LENGTH == pytest.approx(0.8081841086548637, rel=1e-8)
    eroding = track.velocity >= tate.Pair(**INTO_5083).transition_velocity
    assert track.time[eroding][-1] == pytest.approx(153.5988056418421e-6, rel=1e-8)


def test_critical_and_transition_velocities():
    assert tate.Pair(**INTO_5083).transition_velocity == pytest.approx(1163.35, abs=0.01)
    assert tate.Pair(**INTO_7039).transition_velocity == pytest.approx(1074.82, abs=0.01)
    assert tate.Pair(**WEAK_ROD).critical_velocity == pytest.approx(257.06, abs=0.01)
    assert tate.Pair(**WEAK_ROD).transition_velocity == 0.0
    assert tate.Pair(**INTO_5083).critical_velocity == 0.0
    assert tate.critical_velocity(rod_density=18160.0, rod_strength=2e9, resistance=2.6e9) == pytest.approx(257.06, abs=0.01)


@given(density, stress, density, stress, speed)
@FAST
def test_the_interface_balances_the_stresses_in_every_regime(rho_p, Yp, rho_t, Rt, velocity):
    pair = tate.Pair(rho_p, Yp, rho_t, Rt)
    u, regime = pair.penetration_velocity(velocity), pair.regime(velocity)
    rod, target = 0.5 * rho_p * (velocity - u) ** 2 + Yp, 0.5 * rho_t * u * u + Rt
    if regime == tate.RIGID:
        assert u == velocity
        assert Yp >= target * (1.0 - 1e-12), "the rod withstands what acts on it"
    elif regime == tate.NO_PENETRATION:
        assert u == 0.0
        assert Rt >= rod * (1.0 - 1e-12), "the target withstands what acts on it"
    else:
        assert 0.0 < u < velocity
        assert rod == pytest.approx(target, rel=1e-9)


@given(density, stress, density, stress)
@FAST
def test_nothing_jumps_where_the_regime_changes(rho_p, Yp, rho_t, Rt):
    """Depth, velocity of the interface and length on both sides of the critical or the transition velocity."""
    assume(abs(Yp - Rt) > 0.01 * Rt)
    pair = tate.Pair(rho_p, Yp, rho_t, Rt)
    change = max(pair.critical_velocity, pair.transition_velocity)
    below, above = (tate.penetrate(change * factor, rod_length=LENGTH, **vars(pair)) for factor in (1.0 - 1e-8, 1.0 + 1e-8))
    assert below.regime != above.regime
    assert above.depth[-1] == pytest.approx(below.depth[-1], rel=1e-6, abs=1e-6 * LENGTH)
    assert above.length[-1] == pytest.approx(below.length[-1], rel=1e-6)
    steep = 1e-3 * change  # u(v) rises from 0 with a finite slope
    assert above.penetration_velocity[0] == pytest.approx(below.penetration_velocity[0], abs=steep)


@given(density, stress, density, stress, speed)
@FAST
def test_the_rod_only_slows_and_shortens_and_its_energy_never_grows(rho_p, Yp, rho_t, Rt, velocity):
    track = tate.penetrate(velocity, rod_length=LENGTH, rod_density=rho_p, rod_strength=Yp, target_density=rho_t, resistance=Rt)
    for falling in (track.velocity, track.length, -track.time, -track.depth, 0.5 * rho_p * track.length * track.velocity**2):
        assert np.all(np.diff(falling) <= 1e-9 * np.abs(falling).max())
    assert Rt * track.depth[-1] <= 0.5 * rho_p * LENGTH * velocity**2 * (1.0 + 1e-9), "work on the target, of the rod's energy"


@given(density, stress, density, st.floats(500.0, 4000.0))
@FAST
def test_equal_strength_and_resistance(rho_p, Y, rho_t, velocity):
    """No critical and no transition velocity: u/(v - u) is the hydrodynamic ratio, less the rod that remains at rest."""
    track = tate.penetrate(velocity, rod_length=LENGTH, rod_density=rho_p, rod_strength=Y, target_density=rho_t, resistance=Y)
    limit = math.sqrt(rho_p / rho_t)
    assert track.regime == tate.ERODING
    assert track.depth[-1] == pytest.approx(limit * (LENGTH - track.length[-1]), rel=1e-9)


def test_the_model_on_its_inputs():
    values = {"rod.density": 18160.0, "rod.length": LENGTH, "rod.strength": 2.0e9, "target.density": 2660.0}
    result = tate.MODEL(1086.0, {**values, "target.resistance": 1.6e9})
    assert result["depth_over_length"] == pytest.approx(3.0106895283278328, rel=1e-9)
    assert result["regime"] == "eroding, then rigid"
    formed = tate.MODEL(1086.0, {**values, "target.strength": 276e6, "target.youngs_modulus": 70.3e9})
    assert formed["resistance"] == pytest.approx(1.55835e9, rel=1e-5)
    with pytest.raises(InputError, match="target.strength, target.youngs_modulus"):
        tate.MODEL(1086.0, values)


def test_transition_of_the_model():
    """1.7 times a static yield stress of 1.87 GPa, and the solenoidal resistance of 5083: within the bracket of the shots."""
    values = {"rod.density": 18160.0, "rod.length": LENGTH, "rod.strength": 1.87e9, "target.density": 2660.0,
              "target.strength": 276e6, "target.youngs_modulus": 70.3e9}
    static = tate.MODEL.transition(**tate.MODEL.collect(values))
    dynamic = tate.MODEL.transition(**tate.MODEL.collect({**values, "rod.dynamic_factor": 0.7}))
    assert static == pytest.approx(484.1, abs=0.1)
    assert dynamic == pytest.approx(1104.0, abs=0.5)
    assert tate.MODEL.transition(**tate.MODEL.collect({**values, "target.resistance": 5e9})) == 0.0


@pytest.mark.parametrize("bad", [{"rod_strength": -1.0}, {"resistance": 0.0}, {"target_density": math.nan}])
def test_impossible_values_are_refused(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        tate.penetrate(1000.0, rod_length=LENGTH, **{**INTO_5083, **bad})
    with pytest.raises(InputError, match="velocity"):
        tate.penetrate(-1.0, rod_length=LENGTH, **INTO_5083)
