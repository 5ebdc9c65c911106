"""Tillotson's equation of state: Hugoniots, its regions, their joints, isentropes through all of them."""

from math import exp

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from eos import tillotson
from eos.dispatch import sound_speed_squared
from hydro2d.materials import library

ALUMINIUM = {"reference_density": 2700.0, "a": 0.5, "b": 1.63, "A": 75.2e9, "B": 65e9, "E0": 5e6, "incipient_vaporisation": 3e6,
             "complete_vaporisation": 13.9e6, "alpha": 5.0, "beta": 5.0, "specific_heat": 900.0}
ROW = tillotson.row(ALUMINIUM)

#: pressures (GPa) behind shocks that give material at rest these velocities, m/s: computed from the printed constants,
#: independently of this code
VELOCITIES = 500.0, 1000.0, 2000.0, 4000.0, 6000.0
HUGONIOTS = {
    "Al_tillotson": (8.12, 18.23, 44.19, 117.2, 216.7),
    "Fe_tillotson": (18.60, 42.91, 108.9, 308.7, 594.0),
    "Cu_tillotson": (20.76, 48.08, 123.4, 359.6, 710.0),
}


def shocked(row, u):
    """(density, pressure) behind the shock that gives material at rest the velocity u."""
    rho0 = row[tillotson.RHO0]

    def excess(speed):
        return tillotson.evaluate(rho0 * speed / (speed - u), 0.5 * u * u, row)[0] - rho0 * speed * u

    speed = brentq(excess, 1.2 * u, 30.0 * u + 1e4)
    return rho0 * speed / (speed - u), rho0 * speed * u


@pytest.mark.parametrize(("name", "u", "pressure"), [
    (name, u, p) for name, pressures in HUGONIOTS.items() for u, p in zip(VELOCITIES, pressures, strict=True)])
def test_hugoniot(name, u, pressure):
    row = tillotson.row(library.load(name).eos.values)
    assert shocked(row, u)[1] * 1e-9 == pytest.approx(pressure, rel=1e-3)


def as_written(rho, e, values=ALUMINIUM):
    """p by the equations as Melosh prints them, region by region; valid where the cold curve has not turned."""
    rho0, a, b, A, B, E0 = (values[name] for name in ("reference_density", "a", "b", "A", "B", "E0"))
    begins, ends = values["incipient_vaporisation"], values["complete_vaporisation"]
    x, mu = rho / rho0, rho / rho0 - 1.0
    condensed = (a + b / (e / (E0 * x * x) + 1.0)) * rho * e + A * mu + B * mu * mu
    if x >= 1.0 or e <= begins:
        return condensed
    y = rho0 / rho - 1.0
    solid = b * rho * e / (e / (E0 * x * x) + 1.0) + A * mu * exp(-values["beta"] * y)
    hot = a * rho * e + solid * exp(-values["alpha"] * y * y)
    if e >= ends:
        return hot
    return ((e - begins) * hot + (ends - e) * condensed) / (ends - begins)


@given(x=st.floats(0.49, 4.0), e=st.floats(0.0, 5e7))
def test_the_equations_as_printed(x, e):
    rho = 2700.0 * x
    assert tillotson.evaluate(rho, e, ROW)[0] == pytest.approx(as_written(rho, e), rel=1e-12, abs=1e-2)


@pytest.mark.parametrize("e", [0.0, 2.9e6, 3.1e6, 8e6, 13.8e6, 2e7])
def test_pressure_is_continuous_in_density(e):
    """Even where material begins to expand, and where the cold curve is left."""
    for x in (1.0, 1.0 - 0.45 * 75.2 / 65.0):
        below, above = (tillotson.evaluate(2700.0 * x * (1.0 + s), e, ROW)[0] for s in (-1e-12, 1e-12))
        assert below == pytest.approx(above, rel=1e-9, abs=1.0)


@pytest.mark.parametrize(("u", "last", "through"), [
    (1000.0, 0.98, {"solid"}), (5000.0, 0.6, {"solid", "both"}), (9600.0, 0.49, {"solid", "both", "vapour"})])
def test_isentropes_through_all_regions(u, last, through):
    """From the Hugoniot into expansion: de/drho = p/rho^2 with the pressure as printed, and dp/drho along it is c^2."""
    rho, p = shocked(ROW, u)

    def slope(density, e):
        return [as_written(density, e[0]) / density**2]

    path = solve_ivp(slope, (rho, last * 2700.0), [0.5 * u * u], rtol=1e-10, atol=1e-3, dense_output=True, max_step=20.0)
    regions = set()
    for density in np.linspace(rho, last * 2700.0, 60)[1:-1]:
        e, h = path.sol(density)[0], 1e-4 * density
        regions.add("solid" if density >= 2700.0 or e <= 3e6 else "vapour" if e >= 13.9e6 else "both")
        state = tillotson.evaluate(density, e, ROW)
        above, below = (as_written(density + s, e + s * state[0] / density**2) for s in (h, -h))
        if abs(density - 2700.0) > 2 * h and min(abs(e - 3e6), abs(e - 13.9e6)) > 2e4:
            assert sound_speed_squared(density, state[0], state[1], state[2], -1e300) == pytest.approx(
                (above - below) / (2 * h), rel=1e-4, abs=1e3)
    assert regions == through


def test_temperature_follows_the_isentrope():
    """dT/T = Gamma drho/rho with Gamma = (dp/de)/rho at e_s, and off the isentrope T rises by de/cv."""
    def slope(rho, y):
        p, _, dpde, _ = tillotson.evaluate(rho, y[0], ROW)
        return [p / rho**2, y[1] * dpde / rho**2]

    for ratio in (0.8, 1.3, 2.0):
        path = solve_ivp(slope, (2700.0, 2700.0 * ratio), [0.0, 298.0], rtol=1e-10, atol=1e-8)
        e, T = path.y[:, -1]
        assert tillotson.evaluate(2700.0 * ratio, e, ROW)[3] == pytest.approx(T, rel=1e-4)
        assert tillotson.evaluate(2700.0 * ratio, e + 9e5, ROW)[3] == pytest.approx(T + 1000.0, rel=1e-4)


def test_rest_is_exactly_at_rest():
    p, dpdrho, dpde, T = tillotson.evaluate(2700.0, 0.0, ROW)
    assert p == 0.0
    assert pytest.approx(298.0, abs=1e-6) == T
    assert dpdrho == pytest.approx(75.2e9 / 2700.0)
    assert dpde == pytest.approx(2700.0 * 2.13)


def test_vaporisation_ends_above_its_begin():
    with pytest.raises(ValueError, match="complete_vaporisation = 1e.06 J/kg: must be above incipient_vaporisation = 3e.06"):
        tillotson.row({**ALUMINIUM, "complete_vaporisation": 1e6})
