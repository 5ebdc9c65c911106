"""The tabular equation of state: its inverse, derivatives, continuity, c^2, its limits, Hugoniots and second order."""

import functools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import eos
from eos import tabular
from eos.dispatch import sound_speed_squared, zero_pressure_density
from hydro2d.materials import library, sesame, tabulate
from hydro2d.materials.sesame import Table

REST = 2700.0


@functools.cache
def made(name="Al_tillotson", number=41, low=0.9, high=2.4, hottest=2e4):
    """(the row of a table of a material, the row of the material, its module)."""
    material = library.load(name)
    module, values, rest = material.eos.module("eos"), material.eos.values, material.reference_density
    table = tabulate.of_material(material, tabulate.points(low * rest, rest, high * rest, number),
                                 tabulate.temperatures(298.0, hottest, number))
    return tabular.row({"reference_density": rest}, sesame.read(sesame.write(table))), module.row(values), module


ROW, MODEL, TILLOTSON = made()
WIDE = made(low=0.05, high=3.0)[0]


def cell_of(share_rho, share_e, par):
    """A state at these shares of the table's densities and energies."""
    nr = int(par[tabular.DENSITIES])
    low, high = par[tabular.DATA], par[tabular.DATA + nr - 1]
    rho = low * (high / low) ** share_rho
    least, most = tabular.energies(rho, par)
    return rho, least + share_e * (most - least)


SHARE = st.floats(1e-6, 1.0 - 1e-6)


@given(x=SHARE, y=SHARE)
@settings(max_examples=300)
def test_c2_is_positive_all_over_the_table(x, y):
    """Or the cell is closed; ROW has no closed cells."""
    for par, may_end in ((ROW, False), (WIDE, True)):
        rho, e = cell_of(x, y, par)
        p, dpdrho, dpde, T = tabular.evaluate(rho, e, par)
        assert may_end or not np.isnan(p)
        if not np.isnan(p):
            assert dpdrho + p * dpde / rho**2 > 0.0
            assert sound_speed_squared(rho, p, dpdrho, dpde, -1e300) > 0.0
            assert T >= 0.0


def test_cells_are_closed_exactly_where_c2_is_not_positive():
    """Against 41 x 41 points in every cell of a coarse table."""
    par = made(number=21, low=0.05, high=3.0)[0]
    nr, nt = int(par[tabular.DENSITIES]), int(par[tabular.TEMPERATURES])
    rho = par[tabular.DATA:][:nr]
    p, e = (par[tabular.DATA + nr + nt + n * nr * nt:][: nr * nt].reshape(nr, nt) for n in (0, 1))
    opened = tabular.open_cells(rho, par[tabular.DATA + nr:][:nt], p, e)
    w, t = np.meshgrid(np.linspace(0, 1, 41), np.linspace(0, 1, 41), indexing="ij")
    for i, j in np.ndindex(opened.shape):
        def slopes(q, i=i, j=j):
            along_w, along_t = (1 - t) * (q[i + 1, j] - q[i, j]) + t * (q[i + 1, j + 1] - q[i, j + 1]), (
                (1 - w) * (q[i, j + 1] - q[i, j]) + w * (q[i + 1, j + 1] - q[i + 1, j]))
            return (1 - t) * ((1 - w) * q[i, j] + w * q[i + 1, j]) + t * ((1 - w) * q[i, j + 1] + w * q[i + 1, j + 1]), \
                along_w / (rho[i + 1] - rho[i]), along_t
        pressure, p_w, p_t = slopes(p)
        _, e_w, e_t = slopes(e)
        square = p_w - p_t / e_t * e_w + pressure * p_t / e_t / (rho[i] + w * (rho[i + 1] - rho[i])) ** 2
        assert opened[i, j] == (square.min() > 0.0) or abs(square.min()) < 1e-3 * abs(square).max()
    assert 0 < opened.sum() < opened.size


@given(x=SHARE, y=SHARE)
@settings(max_examples=200)
def test_the_inverse_is_exact(x, y):
    """Density and energy give back the density and temperature from which they were interpolated."""
    nr, nt = int(ROW[tabular.DENSITIES]), int(ROW[tabular.TEMPERATURES])
    rho, T = ROW[tabular.DATA:][:nr], ROW[tabular.DATA + nr:][:nt]
    p, e = (ROW[tabular.DATA + nr + nt + n * nr * nt:][: nr * nt].reshape(nr, nt) for n in (0, 1))
    density, temperature = rho[0] + x * (rho[-1] - rho[0]), T[0] + y * (T[-1] - T[0])

    def between(q):
        return np.interp(temperature, T, [np.interp(density, rho, q[:, j]) for j in range(nt)])

    state = tabular.evaluate(density, between(e), ROW)
    assert state[0] == pytest.approx(between(p), rel=1e-9, abs=10.0)
    assert state[3] == pytest.approx(temperature, rel=1e-9, abs=1e-6)


@given(x=SHARE, y=SHARE)
@settings(max_examples=200)
def test_pressure_and_temperature_are_continuous(x, y):
    """Across the edges of cells as well: a step of 1e-9 changes them by no more than their slopes, everywhere."""
    rho, e = cell_of(x, y, ROW)
    p, dpdrho, dpde, T = tabular.evaluate(rho, e, ROW)
    for density, energy in ((rho * (1 + 1e-9), e), (rho, e + 1e-9 * 1e6)):
        other = tabular.evaluate(density, energy, ROW)
        assert abs(other[0] - p) < 1e-7 * (abs(p) + 75e9)
        assert abs(other[3] - T) < 1e-6 * (T + 300.0)


def test_pressure_is_continuous_along_lines_through_all_cells():
    """Over the smallest step in density and energy at every edge."""
    nr = int(ROW[tabular.DENSITIES])
    for rho in ROW[tabular.DATA:][1: nr - 1]:
        for e in np.linspace(*tabular.energies(rho, ROW), 9)[1:-1]:
            below, above = (tabular.evaluate(density, e, ROW) for density in (np.nextafter(rho, 0.0), rho))
            assert below[0] == pytest.approx(above[0], rel=1e-9, abs=1.0)
            assert below[3] == pytest.approx(above[3], rel=1e-9)


@pytest.mark.parametrize(("rho", "e"), [(0.89 * REST, 0.0), (2.41 * REST, 5e6), (1.2 * REST, -1e6), (REST, 4e7), (np.nan, 0.0),
                                        (REST, np.nan), (0.0, 0.0), (-1.0, 0.0)])
def test_there_is_nothing_beyond_the_table(rho, e):
    assert np.isnan(tabular.evaluate(rho, e, ROW)).all()


def test_the_density_without_pressure_is_found_though_the_search_leaves_the_table():
    """In tension the search first tries a density higher by a quarter, where the energy lies below the cold curve."""
    rho, virgin = 0.97 * REST, np.zeros(0)
    assert np.isnan(tabular.evaluate(1.25 * rho, -2e4, ROW)[0])
    at_rest = zero_pressure_density(tabular.ID, rho, -2e4, virgin, ROW)
    assert at_rest == pytest.approx(zero_pressure_density(TILLOTSON.ID, rho, -2e4, virgin, MODEL), rel=1e-3)
    assert abs(tabular.evaluate(at_rest, -2e4, ROW)[0]) < 1.0


# against the model that was tabulated


def shocked(module, par, u):
    """Pressure behind the shock that gives material at rest the velocity u."""
    def excess(density):
        p = module.evaluate(density, 0.5 * u * u, par)[0]
        return p - REST * u * u / (1.0 - REST / density) if np.isfinite(p) else 1e300  # below the cold curve

    density = brentq(excess, REST * 1.001, REST * 2.35, xtol=1e-9)
    return REST * u * u / (1.0 - REST / density)


@pytest.mark.parametrize("name", ["Al_tillotson", "Al_mie_grueneisen"])
def test_hugoniots_are_those_of_the_model_to_second_order(name):
    """The largest error over 40 velocities falls by a factor of four if the table has twice the points in each direction."""
    def worst(number):
        density = tabulate.points(0.9 * REST, REST, 2.4 * REST, number)
        temperature = tabulate.temperatures(298.0, 2e4, number)
        if name == "Al_tillotson":
            module, values = eos.MODELS["tillotson"], library.load(name).eos.values
        else:
            module, values = eos.MODELS["mie-grueneisen"], {"reference_density": REST, "sound_speed": 5350.0, "grueneisen": 2.0,
                                                            "hugoniot_slope": 1.34, "specific_heat": 900.0}
        par = module.row(values)
        row = tabular.row({"reference_density": REST}, tabulate.table_of("x", module, values, density, temperature))
        return max(abs(shocked(tabular, row, u) / shocked(module, par, u) - 1.0) for u in np.linspace(600.0, 3000.0, 40))

    errors = [worst(number) for number in (21, 41, 81)]
    orders = [np.log2(coarse / fine) for coarse, fine in zip(errors, errors[1:], strict=False)]
    assert errors[-1] < 3e-4, errors
    assert min(orders) > 1.6, (errors, orders)
    assert np.mean(orders) > 1.8, (errors, orders)


def test_the_temperature_is_as_consistent_as_the_table_is_fine():
    """For a model with a consistent temperature: slopes within a cell are those of its corners, so the order is one."""
    def worst(number):
        density, temperature = tabulate.points(0.9 * REST, REST, 2.4 * REST, number), tabulate.temperatures(298.0, 2e4, number)
        values = {"reference_density": REST, "sound_speed": 5350.0, "grueneisen": 2.0, "hugoniot_slope": 1.34,
                  "specific_heat": 900.0}
        row = tabular.row({"reference_density": REST}, tabulate.table_of(
            "x", eos.MODELS["mie-grueneisen"], values, density, temperature))
        errors = []
        for rho in REST * np.linspace(0.93, 1.9, 41):
            for e in (5e5, 2e6):
                p, _, dpde, T = tabular.evaluate(rho, e, row)
                if np.isfinite(p):
                    d = 1e-6
                    by_rho = (tabular.evaluate(rho * (1 + d), e, row)[3] - T) / (d * rho)
                    by_e = (tabular.evaluate(rho, e + d * e, row)[3] - T) / (d * e)
                    terms = T * dpde / rho**2, p * by_e / rho**2
                    errors.append(abs(by_rho - terms[0] + terms[1]) / (abs(terms[0]) + abs(terms[1])))
        return np.mean(errors)

    coarse, middle, fine = worst(21), worst(81), worst(161)
    assert fine < 1e-2
    assert coarse > 2.5 * middle > 3.5 * fine, (coarse, middle, fine)


# errors of a row


def plain(**changes):
    """A table of a linear solid, with 4 densities and 3 temperatures, and changes."""
    rho, T = np.array([900.0, 1000.0, 1100.0, 1200.0]), np.array([0.0, 298.0, 1000.0])
    p = 1e6 * (rho[:, None] - 1000.0) + 1e5 * (T[None, :] - 298.0)
    e = 1e3 * T[None, :] + 0.0 * rho[:, None]
    return Table(**{"density": rho, "temperature": T, "pressure": p, "energy": e, **changes})


@pytest.mark.parametrize(("values", "changes", "words"), [
    ({"reference_density": 1201.0}, {}, "reference_density = 1201 kg/m.3 is not within the table, 900 to 1200"),
    ({"reference_density": 1000.0, "reference_temperature": 2e3}, {}, "reference_temperature = 2000 K is not within"),
    ({"reference_density": 1001.0}, {}, "at reference_density = 1001 kg/m.3 and 298 K the table has a pressure of 1e.06 Pa; it "
                                        "is zero at 1000 kg/m.3"),
    ({"reference_density": 1000.0}, {"pressure": -plain().pressure}, "c.2 is not positive at rest"),
    ({"reference_density": 1000.0}, {"pressure": plain().pressure + 1e12}, "it is zero at no density there"),
])
def test_a_row_that_has_not_the_state_at_rest_is_refused(values, changes, words):
    with pytest.raises(ValueError, match=words):
        tabular.row(values, plain(**changes))


def test_a_density_and_a_temperature_between_the_points_change_nothing_elsewhere():
    """Making the state at rest a point does not change the interpolation."""
    table = plain(energy=plain().energy + 0.3 * plain().density[:, None] * plain().temperature)
    split = tabular.row({"reference_density": 1000.0, "reference_temperature": 298.0}, table)
    other = tabular.row({"reference_density": 1020.0, "reference_temperature": 98.0}, table)
    assert (split[tabular.DENSITIES], other[tabular.DENSITIES], other[tabular.TEMPERATURES]) == (4, 5, 4)
    shift = (1e3 + 0.3 * 1000.0) * 298.0 - (1e3 + 0.3 * 1020.0) * 98.0
    for rho, e in ((950.0, 1e5), (1019.0, -5e4), (1150.0, 3e5)):
        assert tabular.evaluate(rho, e, split) == pytest.approx(tabular.evaluate(rho, e + shift, other), rel=1e-9)


def test_a_gas_is_at_rest_at_the_temperature_without_pressure():
    values = {"reference_density": 1.2, "adiabatic_index": 1.4}
    gas = eos.MODELS["ideal-gas"]
    table = tabulate.table_of("air", gas, values, tabulate.points(0.1, 1.2, 12.0, 31), tabulate.temperatures(0.0, 2e3, 21))
    row = tabular.row({"reference_density": 1.2, "reference_temperature": 0.0}, table)
    for rho, e in ((0.5, 2e5), (3.0, 1e6)):
        assert tabular.evaluate(rho, e, row) == pytest.approx(gas.evaluate(rho, e, gas.row(values)), rel=1e-9)
