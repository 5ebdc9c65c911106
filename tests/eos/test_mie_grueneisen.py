"""Mie-Grueneisen: the underlying Hugoniot, its guard, its tension branch and its temperature."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import eos
from eos import mie_grueneisen

TUNGSTEN_ALLOY = {
    "reference_density": 18160.0,
    "sound_speed": 4030.0,
    "hugoniot_slope": 1.237,
    "grueneisen": 1.67,
    "specific_heat": 143.0,
}
AL5083 = {
    "reference_density": 2660.0,
    "sound_speed": 5340.0,
    "hugoniot_slope": 1.40,
    "grueneisen": 1.97,
    "specific_heat": 922.1,
    "reference_temperature": 300.0,
}
MATERIALS = {"tungsten alloy": TUNGSTEN_ALLOY, "aluminium 5083": AL5083}
WATER = {"reference_density": 1000.0, "sound_speed": 1480.0, "hugoniot_slope": 2.56, "hugoniot_slope_2": -1.986,
         "hugoniot_slope_3": 0.2268, "grueneisen": 0.5, "specific_heat": 4180.0}


@pytest.fixture(params=list(MATERIALS))
def material(request):
    """(parameters, row)"""
    return MATERIALS[request.param], mie_grueneisen.row(MATERIALS[request.param])


def hugoniot(values, up):
    """(rho, p, e) behind a shock of particle speed ``up`` from Us = c0 + s up and the jump conditions."""
    speed = values["sound_speed"] + values["hugoniot_slope"] * up
    rho0 = values["reference_density"]
    return rho0 * speed / (speed - up), rho0 * speed * up, 0.5 * up * up


@pytest.mark.parametrize("up", [1e-3, 1.0, 250.0, 1000.0, 4000.0])
def test_hugoniot_states_are_exact(material, up):
    values, row = material
    rho, p, e = hugoniot(values, up)
    assert mie_grueneisen.evaluate(rho, e, row)[0] == pytest.approx(p, rel=max(1e-13, 3e-12 / up))


def test_rest_is_exactly_without_pressure(material):
    values, row = material
    p, dpdrho, dpde, T = mie_grueneisen.evaluate(values["reference_density"], 0.0, row)
    assert p == 0.0
    assert dpdrho == pytest.approx(values["sound_speed"] ** 2, rel=1e-15)
    assert T == values.get("reference_temperature", 298.0)


def test_expansion_is_linear_and_joins_smoothly(material):
    values, row = material
    rho0, c0, gamma = values["reference_density"], values["sound_speed"], values["grueneisen"]
    p, dpdrho, dpde, T = mie_grueneisen.evaluate(0.9 * rho0, 2e4, row)
    assert p == pytest.approx(-0.1 * rho0 * c0**2 + gamma * 0.9 * rho0 * 2e4, rel=1e-12)
    assert dpdrho == pytest.approx(c0**2 + gamma * 2e4, rel=1e-15)
    assert dpde == pytest.approx(gamma * 0.9 * rho0, rel=1e-15)
    above = mie_grueneisen.evaluate(rho0 * (1 + 1e-9), 0.0, row)
    below = mie_grueneisen.evaluate(rho0 * (1 - 1e-9), 0.0, row)
    assert above[1] == pytest.approx(below[1], rel=1e-8)
    hot = [mie_grueneisen.evaluate(rho0 * (1 + side), 1e6, row)[0] for side in (1e-9, -1e-9)]
    assert hot[0] == pytest.approx(hot[1], rel=1e-6)


def test_guard_goes_on_along_the_tangent(material):
    values, row = material
    guard = 0.95 / values["hugoniot_slope"]
    rho0 = values["reference_density"]
    assert row[mie_grueneisen.GUARD] == pytest.approx(guard, rel=1e-12)
    inside, edge, beyond = (rho0 / (1.0 - eta) for eta in (guard - 1e-9, guard, guard + 0.05))
    p, dpdrho, _, _ = mie_grueneisen.evaluate(edge, 0.0, row)
    assert p == pytest.approx(mie_grueneisen.evaluate(inside, 0.0, row)[0], rel=1e-6)
    slope = dpdrho * edge**2 / rho0
    assert mie_grueneisen.evaluate(beyond, 0.0, row)[0] == pytest.approx(p + 0.05 * slope, rel=1e-12)


@pytest.mark.parametrize(("s", "gamma"), [(0.0, 2.0), (0.5, 2.2), (1.0, 2.2), (0.0, 0.0), (2.5, 1.0)])
def test_pressure_rises_for_any_hugoniot(s, gamma):
    """If Gamma0 is large compared with s, the reference curve falls before s eta = 0.95: the guard comes earlier."""
    row = mie_grueneisen.row({**AL5083, "hugoniot_slope": s, "grueneisen": gamma})
    p = [mie_grueneisen.evaluate(rho, 0.0, row)[0] for rho in 2660.0 * np.geomspace(1.0, 50.0, 2000)]
    assert (np.diff(p) > 0.0).all()


def test_temperature_on_the_hugoniot(material):
    """Against cv dT = cv Gamma0 T deta + de_H - p_H deta/rho0, integrated numerically along the Hugoniot."""
    values, row = material
    rho0, c0, s = values["reference_density"], values["sound_speed"], values["hugoniot_slope"]

    def slope(eta, T):
        p = rho0 * c0**2 * eta / (1 - s * eta) ** 2
        dp = rho0 * c0**2 * (1 + s * eta) / (1 - s * eta) ** 3
        return values["grueneisen"] * T + (eta * dp - p) / (2 * rho0 * values["specific_heat"])

    eta = np.array([0.05, 0.15, 0.3])
    path = solve_ivp(slope, (0, 0.3), [values.get("reference_temperature", 298.0)], t_eval=eta, rtol=1e-10, atol=1e-8)
    for compression, expected in zip(eta, path.y[0], strict=True):
        e = 0.5 * (c0 * compression / (1 - s * compression)) ** 2
        T = mie_grueneisen.evaluate(rho0 / (1 - compression), e, row)[3]
        assert T == pytest.approx(expected, rel=1e-4)


def test_release_cools_along_the_isentrope(material):
    """From a shocked state through rho0 into expansion: T falls as exp(Gamma0 eta), then as rho^Gamma0."""
    values, row = material
    rho0, gamma = values["reference_density"], values["grueneisen"]
    rho, p, e = hugoniot(values, 1500.0)
    start, end = 1 - rho0 / rho, -0.05

    def slope(eta, energy):
        return mie_grueneisen.evaluate(rho0 / (1 - eta), energy[0], row)[0] / rho0

    release = solve_ivp(slope, (start, end), [e], rtol=1e-10, atol=1e-6)
    hot = mie_grueneisen.evaluate(rho, e, row)[3]
    cold = mie_grueneisen.evaluate(rho0 / (1 - end), release.y[0, -1], row)[3]
    assert cold / hot == pytest.approx(np.exp(-gamma * start) * (1 - end) ** -gamma, rel=1e-4)


def test_table_has_a_node_at_rest_and_clamps_outside(material):
    values, row = material
    step = 1.0 / row[mie_grueneisen.INVERSE_STEP]
    assert row[mie_grueneisen.ORIGIN] == int(row[mie_grueneisen.ORIGIN])
    assert step * row[mie_grueneisen.ORIGIN] == pytest.approx(0.6)
    assert mie_grueneisen.cold_temperature(-0.6 - 0.5 * step, row) == row[mie_grueneisen.TABLE]
    assert mie_grueneisen.cold_temperature(-1e9, row) == row[mie_grueneisen.TABLE]
    assert mie_grueneisen.cold_temperature(-np.inf, row) == row[mie_grueneisen.TABLE]
    assert mie_grueneisen.cold_temperature(0.999, row) == row[eos.ROW - 1]


def test_nan_stays_nan(material):
    values, row = material
    assert np.isnan(mie_grueneisen.evaluate(np.nan, 0.0, row)[0])
    assert np.isnan(mie_grueneisen.evaluate(2e4, np.nan, row)[0])


# ------------------------------------------------------------------------------------------------ a curved Hugoniot


def curved(values, up: float) -> float:
    """Us by bisection of Us = c0 + s up + s2 (up/Us) up + s3 (up/Us)^2 up, as Steinberg writes it; m/s."""
    s, s2, s3 = (values.get(f"hugoniot_slope{end}", 0.0) for end in ("", "_2", "_3"))
    low, high = max(up, values["sound_speed"]), 20.0 * (values["sound_speed"] + up)
    for _ in range(200):
        middle = 0.5 * (low + high)
        ratio = up / middle
        more = values["sound_speed"] + s * up + s2 * ratio * up + s3 * ratio**2 * up > middle
        low, high = (middle, high) if more else (low, middle)
    return middle


@pytest.mark.parametrize("up", [1.0, 250.0, 1000.0, 4000.0, 8000.0])
def test_states_on_a_curved_hugoniot_are_exact(up):
    """Steinberg's cubic for water: 3489 m/s at a particle velocity of 1 km/s; a straight line of slope 2.56 has 4040."""
    speed, row = curved(WATER, up), mie_grueneisen.row(WATER)
    if up == 1000.0:
        assert speed == pytest.approx(3489.0, abs=1.0)
    rho = 1000.0 * speed / (speed - up)
    assert mie_grueneisen.evaluate(rho, 0.5 * up**2, row)[0] == pytest.approx(1000.0 * speed * up, rel=1e-11)


@pytest.mark.parametrize("change", [{}, {"hugoniot_slope_3": 0.0}, {"hugoniot_slope_2": -3.0}, {"hugoniot_slope_2": 1.0}])
def test_derivatives_of_a_curved_hugoniot(change):
    row = mie_grueneisen.row({**WATER, **change})
    for rho in np.linspace(1005.0, 1000.0 / (1.0 - row[mie_grueneisen.GUARD]) * 1.2, 25):
        for e in (0.0, 1e6):
            _, dpdrho, dpde, _ = mie_grueneisen.evaluate(rho, e, row)
            step = 1e-5 * rho
            if abs(1.0 - 1000.0 / rho - row[mie_grueneisen.GUARD]) < 1e-3:
                continue  # the slope has a corner there
            up, down = (mie_grueneisen.evaluate(rho + way, e, row)[0] for way in (step, -step))
            assert dpdrho == pytest.approx((up - down) / (2 * step), rel=1e-5)
            assert dpdrho > 0.0
            heated, cold = (mie_grueneisen.evaluate(rho, energy, row)[0] for energy in (e + 1e3, e))
            assert dpde == pytest.approx((heated - cold) / 1e3, rel=1e-5)


def test_temperature_along_the_isentrope_of_a_curved_hugoniot():
    """T = T0 exp(Gamma0 eta) on the isentrope through the state at rest, which is integrated numerically."""
    row = mie_grueneisen.row(WATER)

    def slope(eta, energy):
        return mie_grueneisen.evaluate(1000.0 / (1.0 - eta), energy[0], row)[0] / 1000.0

    path = solve_ivp(slope, (0.0, 0.45), [0.0], t_eval=[0.1, 0.3, 0.45], rtol=1e-10, atol=1e-6)
    for eta, e in zip(path.t, path.y[0], strict=True):
        T = mie_grueneisen.evaluate(1000.0 / (1.0 - eta), e, row)[3]
        assert pytest.approx(298.0 * np.exp(0.5 * eta), rel=1e-4) == T


def test_a_third_slope_needs_the_second():
    with pytest.raises(ValueError, match=r"hugoniot_slope_3 = 0.2268 without hugoniot_slope_2: a cubic Hugoniot needs both"):
        mie_grueneisen.row({name: value for name, value in WATER.items() if name != "hugoniot_slope_2"})
