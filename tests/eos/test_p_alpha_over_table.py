"""P-alpha over a table: the search for the crush curve at its ends, continuity, c^2, second order, and the table's limits."""

import functools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from eos import cracked, dispatch, mie_grueneisen, p_alpha, tabular
from eos.layout import RHO0, SOLID_AT
from hydro2d.base.errors import DeckError, UnphysicalState
from hydro2d.deck import deck as decks
from hydro2d.materials import library, sesame, tabulate
from hydro2d.solver.simulation import Simulation

REST, VIRGIN = 2700.0, 1.275
SOLID = {"sound_speed": 5350.0, "hugoniot_slope": 1.34, "grueneisen": 2.0, "specific_heat": 890.0}
POROUS = {"reference_density": REST / VIRGIN, "solid_density": REST, "elastic_sound_speed": 4110.0, "elastic_pressure": 0.08e9,
          "crush_pressure": 0.7e9}
MODEL = p_alpha.row({**SOLID, **POROUS}, mie_grueneisen)
assert dispatch.WITH_MEMORY


@functools.cache
def table(number, low=0.9, high=1.6, hottest=1e4):
    return tabulate.table_of("aluminium", mie_grueneisen, {**SOLID, "reference_density": REST},
                             tabulate.points(low * REST, REST, high * REST, number),
                             tabulate.temperatures(298.0, hottest, number))


def over(number, *span):
    return p_alpha.row(POROUS, tabular, table(number, *span))


ROW, NARROW = over(41), over(41, 0.99, 1.05)
EDGES = ROW[SOLID_AT:][tabular.DATA:][:int(ROW[SOLID_AT + tabular.DENSITIES])]


def after(par, rho, e, distention=VIRGIN):
    """The distention after a step to a density and an energy."""
    internal = np.array([distention])
    p_alpha.update(par[RHO0], rho, e, *np.zeros(7), par, internal)
    return internal[0]


def evaluate(par, rho, e, distention):
    return p_alpha.evaluate(rho, e, np.array([distention]), par)


def has(par, rho_s, e):
    """Whether the table of the solid has a state."""
    return not np.isnan(tabular.evaluate(rho_s, e, par[SOLID_AT:])[0])


def test_the_row_ends_in_that_of_the_table():
    own = tabular.row({"reference_density": REST}, table(41))
    assert (ROW[SOLID_AT:] == own).all()
    assert ROW[:SOLID_AT].tolist() == pytest.approx([*MODEL[:2], tabular.ID, *MODEL[3:SOLID_AT]], rel=0.02)


@pytest.mark.parametrize(("par", "dense_too"), [(ROW, False), (NARROW, True)], ids=["wide", "narrow"])
def test_the_crush_curve_is_found_though_the_search_begins_beyond_the_table(par, dense_too):
    """Wherever the model's solid is in the table, so is the porous material; the ends of the bracket often are not."""
    thin = dense = 0
    for rho in np.linspace(0.95 * par[RHO0], 1.5 * REST, 80):
        for e in (0.0, *np.geomspace(10.0, 5e6, 40)):
            exact = after(MODEL, rho, e)
            if not has(par, p_alpha.solid_density(rho, exact, MODEL)[0], e):
                continue
            distention = after(par, rho, e)
            assert not np.isnan(evaluate(par, rho, e, distention)[0]), (rho, e, exact, distention)
            assert distention == pytest.approx(exact, abs=2e-3)
            if 1.0 < distention < VIRGIN:
                thin += not has(par, rho, e)
                dense += not has(par, p_alpha.solid_density(rho, VIRGIN, par)[0], e)
    assert thin > 20
    assert (dense > 20) == dense_too


@pytest.mark.parametrize("e", [0.0, 1e5])
def test_material_that_has_been_crushed_is_on_the_crush_curve(e):
    for rho in np.linspace(2150.0, 2650.0, 11):
        left = after(ROW, rho, e)
        p, alpha = evaluate(ROW, rho, e, left)[0], p_alpha.solid_density(rho, left, ROW)[0] / rho
        if left < VIRGIN:
            assert alpha == pytest.approx(1.0 + (ROW[p_alpha.DISTENTION] - 1.0) * ((0.7e9 - p) / 0.62e9) ** 2, abs=1e-9)


def test_a_crush_curve_that_the_table_does_not_reach_leaves_the_material_beyond_it():
    """All states of the table lie below the curve: the material is not clipped to the last of them."""
    short = over(41, 0.9, 1.004)
    for rho in (2550.0, 2600.0, 2650.0):
        assert p_alpha.solid_density(rho, after(MODEL, rho, 0.0), MODEL)[0] > 1.004 * REST
        assert p_alpha.excess(rho, 0.0, 1.0, short)[0] < 0.0
        assert after(short, rho, 0.0) == VIRGIN
        assert np.isnan(evaluate(short, rho, 0.0, VIRGIN)[0])


SHARE = st.floats(1e-6, 1.0 - 1e-6)


def density_at(rho_s, distention):
    """The density of porous material whose solid has a density."""
    return brentq(lambda rho: p_alpha.solid_density(rho, distention, ROW)[0] - rho_s, 0.1 * REST, 3.0 * REST, xtol=1e-12)


def state(x, y, z):
    """Density, energy and distention of material whose solid lies at these shares of the table's densities and energies."""
    distention = 1.0 + z * (VIRGIN - 1.0)
    low, high = (density_at(edge, distention) for edge in (EDGES[0] * (1 + 1e-9), EDGES[-1] * (1 - 1e-9)))
    rho = low + x * (high - low)
    least, most = tabular.energies(p_alpha.solid_density(rho, distention, ROW)[0], ROW[SOLID_AT:])
    return rho, least + y * (most - least), distention


@given(x=SHARE, y=SHARE, z=SHARE)
@settings(max_examples=300)
def test_c2_is_positive_wherever_the_pressure_is(x, y, z):
    """c^2 = h^2 c_s^2 + (1 - h^2)(p_s/rho_s)(1 + dp/de|s/rho_s), and in tension while the solid's term outweighs the rest."""
    rho, e, distention = state(x, y, z)
    p, dpdrho, dpde, T = evaluate(ROW, rho, e, distention)
    assert not np.isnan(p)
    assert T >= 0.0
    square = dpdrho + p * dpde / rho**2
    rho_s, share = p_alpha.solid_density(rho, distention, ROW)
    p_s, by_rho, by_e, _ = tabular.evaluate(rho_s, e, ROW[SOLID_AT:])
    own = by_rho + p_s * by_e / rho_s**2
    assert square == pytest.approx(share * own + (1.0 - share) * p_s / rho_s * (1.0 + by_e / rho_s), rel=1e-9, abs=1.0)
    assert square > 0.0 or p < -1e9


@given(x=SHARE, y=SHARE, z=SHARE)
@settings(max_examples=200)
def test_pressure_and_temperature_are_continuous(x, y, z):
    rho, e, distention = state(x, y, z)
    p, _, _, T = evaluate(ROW, rho, e, distention)
    near = (rho * (1 + 1e-9), e, distention), (rho, e + 1e-3, distention), (rho, e, distention - 1e-10)
    for density, energy, pores in near:
        other = evaluate(ROW, density, energy, pores)
        if not np.isnan(other[0]):
            assert abs(other[0] - p) < 1e-7 * (abs(p) + 75e9)
            assert abs(other[3] - T) < 1e-6 * (T + 300.0)


@given(x=st.floats(0.0, 1.0), e=st.floats(0.0, 5e5))
@settings(max_examples=200)
def test_pressure_is_continuous_while_pores_are_crushed(x, e):
    """Even where the solid passes a point of its table, and where a crush begins or ends."""
    rho = ROW[RHO0] * (1.0 + 0.3 * x)
    p, other = (evaluate(ROW, density, e, after(ROW, density, e))[0] for density in (rho, rho * (1 + 1e-9)))
    assert abs(other - p) < 1e-7 * (abs(p) + 75e9)


# against the model that was tabulated


def compacted(par, velocity):
    """(pressure, density) behind precursor and shock before a piston, by the jump conditions."""
    first, rho0 = par[p_alpha.P_ELASTIC], par[RHO0]

    def heat(rho):
        return 0.5 * first * (1.0 / rho0 - 1.0 / rho)

    rho1 = brentq(lambda rho: evaluate(par, rho, heat(rho), VIRGIN)[0] - first, rho0, 1.02 * rho0, xtol=1e-12)
    jump = velocity - np.sqrt(first * (1.0 / rho0 - 1.0 / rho1))

    def behind(p):
        rho = 1.0 / (1.0 / rho1 - jump**2 / (p - first))
        return rho, heat(rho1) + 0.5 * (p + first) * (1.0 / rho1 - 1.0 / rho)

    def excess(p):
        rho, e = behind(p)
        pressure = evaluate(par, rho, e, after(par, rho, e))[0]
        return 1e300 if np.isnan(pressure) else pressure - p

    least = first + 1.001 * rho1 * jump**2
    p = brentq(excess, least, 50.0 * least + 1e10, xtol=1.0)
    return p, behind(p)[0]


def test_the_crushing_wave_is_that_of_the_model_to_second_order():
    """The largest error in pressure and density, with pores closed in part and in full; the page's numbers."""
    velocities = np.linspace(120.0, 1000.0, 23)
    exact = [compacted(MODEL, u) for u in velocities]
    errors = [max(abs(a / b - 1.0) for u, pair in zip(velocities, exact, strict=True)
                  for a, b in zip(compacted(over(number), u), pair, strict=True)) for number in (11, 21, 41)]
    orders = [np.log2(coarse / fine) for coarse, fine in zip(errors, errors[1:], strict=False)]
    assert errors == pytest.approx([17e-4, 4.5e-4, 1e-4], rel=0.06)
    assert min(orders) > 1.6, (errors, orders)
    assert np.mean(orders) > 1.8, (errors, orders)


def test_at_rest_the_sound_speed_is_the_given_one_and_the_solid_that_of_the_table():
    p, dpdrho, _, T = evaluate(ROW, ROW[RHO0], 0.0, VIRGIN)
    assert (p, T) == (0.0, 298.0)
    assert np.sqrt(dpdrho) == pytest.approx(4110.0, rel=1e-12)
    for rho, e in ((2800.0, 1e5), (2600.0, 1e5), (3400.0, 1e6)):
        assert evaluate(ROW, rho, e, 1.0) == tabular.evaluate(rho, e, ROW[SOLID_AT:])


def test_h_is_of_first_order():
    """From the slope of the table above the density at rest; the page's number."""
    default = [p_alpha.row(POROUS, tabular, tabulate.table_of(
        "aluminium", mie_grueneisen, {**SOLID, "reference_density": REST},
        tabulate.points(0.8 * REST, REST, 3.0 * REST, number), tabulate.temperatures(298.0, 2e4, 11))) for number in (76, 151)]
    coarse, fine = ((1.0 + (VIRGIN - 1.0) * par[p_alpha.SLOPE]) / (4110.0 / 5350.0) - 1.0 for par in default)
    assert fine == pytest.approx(-0.003, rel=0.05)
    assert coarse / fine == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize(("change", "high", "words"), [
    ({}, 1.001, "elastic_pressure = 8e.07 is not reached in the table of the solid"),
    ({"solid_density": 2690.0}, 1.6, "reference_density = 2690 kg/m.3 and 298 K the table has a pressure of"),
    ({"reference_temperature": 2e4}, 1.6, "reference_temperature = 20000 K is not within the table"),
    ({"sound_speed": 5350.0}, 1.6, 'unknown parameter "sound_speed"'),
])
def test_a_row_that_the_table_does_not_allow(change, high, words):
    with pytest.raises(ValueError, match=words):
        p_alpha.row({**POROUS, **change}, tabular, table(41, 0.9, high))


# decks


def deck(**changes):
    """The compaction of a block whose solid comes from a table."""
    eos = {"model": "p-alpha", "solid": "tabular", "table_data": sesame.write(table(41)), "table_from": "al.301", **POROUS}
    given = {"body.block.material": "foam", "materials.foam": {"eos": eos}, "mesh.z": [{"to": "4 mm", "cells": 80}],
             "body.block.thickness": "3.9 mm", "stop.time": "0.7 us", "numbers": "SI", **changes}
    with open("problems/verification/porous_compaction.toml", encoding="utf-8") as file:
        return decks.loads(file.read(), given)


def test_the_resolved_deck_carries_the_table_of_the_solid():
    loaded = deck()
    again = decks.loads(loaded.to_toml(), name=loaded.name)
    model = again.materials["foam"].eos
    assert (model.solid, model.table_from, model.title) == ("tabular", "al.301", "p-alpha over tabular (al.301)")
    assert again.to_toml() == loaded.to_toml()
    assert again.materials["foam"].tables()[0]["file"] == "al.301"
    assert library.resolve(again).virgin(0) == pytest.approx([VIRGIN], rel=1e-12)


def test_a_run_that_leaves_the_table_says_where_and_which_state_of_the_solid():
    simulation = Simulation(deck(**{"body.block.velocity": "-6 km/s"}))
    with pytest.raises(UnphysicalState) as error:
        simulation.run()
    said = str(error.value)
    assert "cell (r, z) = (" in said
    assert 'body "block"' in said
    assert "pressure nan Pa" in said
    assert "material foam: its solid has " in said
    assert "kg/m^3; al.301 has densities of 2430 to 4320 kg/m^3 and temperatures of 0 to 10000 K" in said
    density = float(said.split(" kg/m^3, energy")[0].split()[-1])
    of_solid = float(said.split("its solid has ")[1].split()[0])
    assert density * (1 - 1e-5) <= of_solid <= VIRGIN * density
    if of_solid < EDGES[-1]:
        assert f"; at {of_solid:.6g} kg/m^3 energies of " in said


def test_a_body_that_begins_beyond_the_table_is_refused():
    with pytest.raises(DeckError, match="cannot begin with a density of 4000 kg/m.3 .*: its solid has 3915.49 kg/m.3; al.301"):
        Simulation(deck(**{"body.block.density": "4000 kg/m^3"}))


def test_the_solid_of_cracked_material_has_the_density_without_the_cracks():
    row = cracked.row(tabular.ID, tabular.row({"reference_density": REST}, table(41)))
    assert cracked.density_of_solid(2500.0, np.array([2e-5, 0.0]), row) == pytest.approx(2500.0 / 0.95, rel=1e-14)
    assert p_alpha.density_of_solid(2200.0, np.array([1.2]), ROW) == p_alpha.solid_density(2200.0, 1.2, ROW)[0]
