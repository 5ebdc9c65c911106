"""Cells solved together: each has the answer of `plastic_increment`, wherever it is and whichever cells are with it."""

import inspect
import math

import numpy as np
import pytest

from hydro2d.materials import library
from hydro2d.mesh.fields import LANE_ROWS, LANES
from hydro2d.mesh.grid import Grid
from hydro2d.mesh.state import State
from strength import STRENGTH_MODELS, lanes
from strength.dispatch import WEAKENS
from strength.radial_return import next_trial, plastic_increment, return_together
from tests.contract.test_models import STRENGTH_CASES

#: input of a cell, in the order of the arguments of `plastic_increment`
BROUGHT = (lanes.TRIAL, lanes.STRAIN, lanes.HEAT, lanes.PRESSURE, lanes.DENSITY)
RANDOM = np.random.default_rng(7)


def materials():
    """Every strength of the library but fluids, variants included: model, parameters and density."""
    for name in library.names():
        for variant in (None, *library.load(name).variants):
            material = library.load(name, variant)
            module = STRENGTH_MODELS[material.strength.name]
            if module.NAME != "hydrodynamic" and module.ID not in WEAKENS:  # they are solved cell by cell
                yield pytest.param(module, material.strength, material.eos.values["reference_density"],
                                   id=name if variant is None else f"{name}-{variant}")


def states(module, par, density, number):
    """trial, strain, temperature, pressure, density and shear modulus of cells, some of them melted or unstrained."""
    strain = np.where(RANDOM.random(number) < 0.1, 0.0, 10.0 ** RANDOM.uniform(-20.0, 1.5, number))
    T = np.where(RANDOM.random(number) < 0.1, 5000.0, RANDOM.uniform(0.0, 1500.0, number))
    p, rho = RANDOM.uniform(-2e9, 3e10, number), density * RANDOM.uniform(0.94, 1.4, number)
    G = np.array([module.shear_modulus(*state, par) for state in zip(p, rho, T, strict=True)])
    flow = np.array([module.flow_stress(ep, 0.0, t, a, b, par) for ep, t, a, b in zip(strain, T, p, rho, strict=True)])
    trial = np.maximum(flow, 1e7) * (1.0 + RANDOM.choice([-1.0, 1.0, 1.0], number) * 10.0 ** RANDOM.uniform(-9.0, 0.0, number))
    return trial, strain, T, p, rho, G


def together(model, par, dt, factor, trial, strain, T, p, rho, G):
    """(dep, flow stress) of `return_together`, for up to LANES cells; the rest are copies of the last."""
    number = -(-trial.size // lanes.WIDTH) * lanes.WIDTH
    lane = np.full(LANE_ROWS * LANES, math.nan)
    for place, values in zip((*BROUGHT, lanes.STIFFNESS), (trial, strain, T, p, rho, 3.0 * G), strict=True):
        lane[place:place + number] = np.pad(values, (0, number - values.size), mode="edge")
    return_together(model, number, dt, factor, par, lane)
    return lane[lanes.INCREMENT:][:trial.size].copy(), lane[lanes.STRESS:][:trial.size].copy()


def alone(model, par, dt, factor, *cells):
    """(dep, flow stress) of `plastic_increment`, cell by cell."""
    answers = [plastic_increment(model, trial, ep, dt, T, p, rho, G, factor, par, 0.0)
               for trial, ep, T, p, rho, G in zip(*cells, strict=True)]
    return tuple(np.array(answers).T)


def test_the_rows_of_lanes_do_not_overlap_and_fill_the_array():
    places = [value for name, value in inspect.getmembers(lanes) if name not in ("WIDTH", "LANES") and isinstance(value, int)]
    assert sorted(places) == list(range(0, LANE_ROWS * LANES, LANES))
    assert LANES % lanes.WIDTH == 0
    assert State(Grid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 71)), 1).lanes.shape[1] == LANE_ROWS * LANES


@pytest.mark.parametrize(("module", "strength", "density"), list(materials()))
def test_together_is_alone(module, strength, density):
    par = module.row(strength.values)
    plastic = melted = 0
    melts = math.isfinite(strength.values.get("melt_temperature", math.inf))
    for k in range(60):
        cells = states(module, par, density, 1 + k % LANES)
        dt, factor = 10.0 ** RANDOM.uniform(-12.0, -5.0), (1.0, 1.5625)[k % 2]
        answers, expected = together(module.ID, par, dt, factor, *cells), alone(module.ID, par, dt, factor, *cells)
        for mine, other in zip(answers, expected, strict=True):
            np.testing.assert_array_equal(mine, other)
        plastic += np.count_nonzero(answers[0])
        melted += np.count_nonzero((answers[1] == 0.0) & (answers[0] > 0.0))
    assert plastic > 200
    assert (melted > 0) == (melts and module.CONSTANT_MODULUS)


@pytest.mark.parametrize("name", ["johnson-cook", "steinberg-guinan", "power-law", "zerilli-armstrong", "elastic-plastic"])
def test_neither_place_nor_company_changes_a_bit(name):
    module, density = STRENGTH_MODELS[name], 2750.0
    par = module.row(STRENGTH_CASES[name])
    cells = states(module, par, density, LANES)
    whole = np.array(together(module.ID, par, 1e-8, 1.0, *cells))
    order = RANDOM.permutation(LANES)
    np.testing.assert_array_equal(together(module.ID, par, 1e-8, 1.0, *(values[order] for values in cells)), whole[:, order])
    for k in range(LANES):
        one = together(module.ID, par, 1e-8, 1.0, *(values[k:k + 1] for values in cells))
        np.testing.assert_array_equal(np.ravel(one), whole[:, k])
    spoilt = [values.copy() for values in cells]
    spoilt[0][::2] = math.nan
    answers = np.array(together(module.ID, par, 1e-8, 1.0, *spoilt))
    np.testing.assert_array_equal(answers[:, 1::2], whole[:, 1::2])
    assert np.isnan(answers[:, ::2][:, cells[5][::2] > 0.0]).all()


#: arguments on which the flow stress of each model depends
FEELS = {
    "johnson-cook": ("strain", "T"), "steinberg-guinan": ("strain", "T", "p", "rho"), "power-law": ("strain",),
    "zerilli-armstrong": ("strain", "T"), "elastic-plastic": ("strain", "T"), "kinematic-hardening": ("strain",),
    "voce": ("strain", "T"), "steinberg-lund": ("strain", "T", "p", "rho"),
    "preston-tonks-wallace": ("strain", "T", "p", "rho"),
}


@pytest.mark.parametrize("name", FEELS)
def test_no_nan_ends_as_an_elastic_step(name):
    module = STRENGTH_MODELS[name]
    par = module.row(STRENGTH_CASES[name])
    trial, strain, T, p, rho, G = 2e9, 0.1, 400.0, 1e9, 2750.0, 26e9
    assert plastic_increment(module.ID, trial, strain, 1e-8, T, p, rho, G, 1.0, par, 0.0)[0] > 0.0
    for what in ("trial", *FEELS[name]):
        given = {"trial": trial, "strain": strain, "T": T, "p": p, "rho": rho, what: math.nan}
        cell = [np.array([value]) for value in (*given.values(), G)]
        for answer in (alone(module.ID, par, 1e-8, 1.0, *cell), together(module.ID, par, 1e-8, 1.0, *cell)):
            assert np.isnan(answer).all(), what


def test_a_flow_stress_that_turns_nan_ends_the_search():
    """Y was finite at x = 0."""
    x, seq, stiffness = 1e-3, 1e9, 3e11
    ended, dep, stress, *_ = next_trial(True, seq, stiffness, x, math.log(x), math.nan, -30.0, -5.0, -7.0, 5e8, math.inf, -18.0)
    assert ended
    assert math.isnan(dep)
    assert math.isnan(stress)
