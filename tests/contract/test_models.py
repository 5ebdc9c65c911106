"""What every registered equation of state, strength model and damage model must keep."""

import itertools
import math
import types

import numpy as np
import pytest

import eos
import strength
from eos import dispatch as eos_dispatch
from strength import dispatch, radial_return, tensile_pressure

SOLID = {
    "reference_density": 2770.0,
    "sound_speed": 5200.0,
    "hugoniot_slope": 1.36,
    "grueneisen": 2.2,
    "specific_heat": 875.0,
}
LIQUID = {"reference_density": 1000.0, "sound_speed": 1480.0, "adiabatic_index": 3.0, "specific_heat": 4180.0}

#: per equation of state: parameters, density over rest and specific energies (J/kg) of its stated range
EOS_CASES = {
    "mie-grueneisen": (SOLID, np.linspace(0.95, 2.0, 22), (0.0, 1e5, 3e6)),
    "ideal-gas": ({"reference_density": 1.2, "adiabatic_index": 1.4}, np.geomspace(0.01, 20.0, 9), (1.0, 2e5, 1e9)),
    "stiffened-gas": (LIQUID, np.linspace(0.9, 1.6, 9), (0.0, 1e5, 3e6)),
}

G, Y = 26e9, 0.3e9

#: per strength model: parameters with every term on
STRENGTH_CASES = {
    "hydrodynamic": {},
    "elastic-plastic": {
        "shear_modulus": G,
        "yield_stress": Y,
        "hardening_modulus": 1e9,
        "max_yield_stress": 5e8,
        "melt_temperature": 900.0,
    },
    "johnson-cook": {
        "shear_modulus": G,
        "yield_stress": Y,
        "hardening": 343e6,
        "hardening_exponent": 0.41,
        "rate_coefficient": 0.01,
        "thermal_exponent": 1.3,
        "melt_temperature": 877.0,
    },
    "steinberg-guinan": {
        "shear_modulus": G,
        "yield_stress": Y,
        "max_yield_stress": 0.68e9,
        "hardening_coefficient": 125.0,
        "hardening_exponent": 0.1,
        "pressure_coefficient": 6.52e-11,
        "temperature_coefficient": 6.16e-4,
        "melt_temperature": 1220.0,
        "melt_exponent": 1.5,
        "grueneisen": 1.97,
        "reference_density": 2700.0,
    },
    "power-law": {"youngs_modulus": 2.5 * G, "poisson_ratio": 0.25, "yield_stress": Y, "hardening_exponent": 0.084},
    "kinematic-hardening": {"shear_modulus": G, "yield_stress": Y, "hardening_modulus": 1e9, "isotropic_share": 0.4},
    "zerilli-armstrong": {
        "shear_modulus": G, "athermal_stress": 65e6, "thermal_stress": 1033e6, "thermal_softening": 6.98e-3,
        "rate_hardening": 4.15e-4, "hardening": 266e6, "hardening_exponent": 0.289, "melt_temperature": 1809.0,
    },
}  # fmt: skip

#: the same constant yield stress in every model that has one, some of the special terms switched off by their values
CONSTANT_YIELD = {
    "elastic-plastic": {"shear_modulus": G, "yield_stress": Y, "max_yield_stress": Y},
    "johnson-cook": {"shear_modulus": G, "yield_stress": Y, "hardening_exponent": 0.41, "thermal_exponent": 1.3},
    "steinberg-guinan": {
        "shear_modulus": G,
        "yield_stress": Y,
        "max_yield_stress": Y,
        "hardening_coefficient": 125.0,
        "hardening_exponent": 0.1,
        "grueneisen": 1.97,
        "reference_density": 2700.0,
    },
    "power-law": {"youngs_modulus": 2.5 * G, "poisson_ratio": 0.25, "yield_stress": Y, "hardening_exponent": 0.0},
    "kinematic-hardening": {"shear_modulus": G, "yield_stress": Y, "isotropic_share": 0.4},
    "zerilli-armstrong": {"shear_modulus": G, "athermal_stress": Y, "thermal_stress": 0.0, "thermal_softening": 7e-3},
}

DAMAGE_CASES = {
    "none": {},
    "johnson-cook": {"D1": 0.14, "D2": 0.14, "D3": -1.5, "D4": 0.018, "D5": 0.5, "melt_temperature": 877.0},
}

MODELS = (
    [(eos.MODELS[name], EOS_CASES[name][0], eos.ROW) for name in eos.MODELS]
    + [(strength.STRENGTH_MODELS[name], STRENGTH_CASES[name], strength.ROW) for name in strength.STRENGTH_MODELS]
    + [(strength.DAMAGE_MODELS[name], DAMAGE_CASES[name], strength.DAMAGE_ROW) for name in strength.DAMAGE_MODELS]
)


def label(value):
    return getattr(value, "__name__", None) or ""


@pytest.fixture(params=list(eos.MODELS))
def gas(request):
    """(module, row, densities, energies) of an equation of state."""
    values, ratios, energies = EOS_CASES[request.param]
    module = eos.MODELS[request.param]
    return module, module.row(values), values["reference_density"] * ratios, energies


@pytest.fixture(params=list(strength.STRENGTH_MODELS))
def solid(request):
    """(module, row, parameters) of a strength model."""
    module = strength.STRENGTH_MODELS[request.param]
    return module, module.row(STRENGTH_CASES[request.param]), STRENGTH_CASES[request.param]


# what a model says of itself


@pytest.mark.parametrize("models", [eos.MODELS, strength.STRENGTH_MODELS, strength.DAMAGE_MODELS])
def test_ids_differ(models):
    assert len({module.ID for module in models.values()}) == len(models)


@pytest.mark.parametrize(("module", "values", "length"), MODELS, ids=label)
def test_row(module, values, length):
    row = module.row(values)
    assert row.shape == (length,)
    assert row.dtype == np.float64
    assert not np.isnan(row).any()


@pytest.mark.parametrize(("module", "values", "length"), MODELS, ids=label)
def test_wrong_parameters_are_refused(module, values, length):
    with pytest.raises(ValueError, match="unknown parameter 'colour'"):
        module.row({**values, "colour": 1.0})
    for parameter in module.PARAMETERS:
        with pytest.raises(ValueError, match=parameter.name):
            module.row({**values, parameter.name: math.nan})
        if parameter.required:
            with pytest.raises(ValueError, match=f"{parameter.name}' is missing"):
                module.row({name: value for name, value in values.items() if name != parameter.name})


@pytest.mark.parametrize(
    ("describe", "models"),
    [
        (eos.describe, eos.MODELS),
        (strength.describe, strength.STRENGTH_MODELS),
        (strength.describe_damage, {**strength.DAMAGE_MODELS, tensile_pressure.NAME: tensile_pressure}),
    ],
)
def test_every_model_describes_itself(describe, models):
    for name, module in models.items():
        page = describe(name)
        assert page.equation
        assert page.source
        assert page.validity
        text = str(page)
        for parameter in module.PARAMETERS:
            assert parameter.name in text
            assert parameter.description in text
        with pytest.raises(ValueError, match=f"did you mean '{name}'"):
            describe(name + "x")


# equations of state


def test_dispatch_chooses_the_equation_of_state(gas):
    module, row, densities, energies = gas
    for rho, e in itertools.product(densities, energies):
        assert eos_dispatch.evaluate(module.ID, rho, e, row) == module.evaluate(rho, e, row)
    assert np.isnan(eos_dispatch.evaluate(99, 1.0, 1.0, row)).all()


def test_derivatives_against_differences(gas):
    module, row, densities, energies = gas
    for rho, e in itertools.product(densities, energies):
        p, dpdrho, dpde, T = module.evaluate(rho, e, row)
        d = 1e-5 * rho
        below, above = (p - module.evaluate(rho - d, e, row)[0]) / d, (module.evaluate(rho + d, e, row)[0] - p) / d
        if abs(rho - row[eos.RHO0]) <= d:  # a branch ends there: the slope is that of one side
            assert min(abs(dpdrho / below - 1.0), abs(dpdrho / above - 1.0)) < 2e-4
        else:
            assert dpdrho == pytest.approx(0.5 * (below + above), rel=1e-7)
        d = 0.01 * max(e, 1.0)
        slope = (module.evaluate(rho, e + d, row)[0] - module.evaluate(rho, e - d, row)[0]) / (2 * d)
        assert dpde == pytest.approx(slope, rel=1e-7)


def test_sound_speed_is_real(gas):
    module, row, densities, energies = gas
    for rho, e in itertools.product(densities, energies):
        p, dpdrho, dpde, T = module.evaluate(rho, e, row)
        assert dpdrho + p * dpde / rho**2 > 0.0


def test_rest_has_no_pressure(gas):
    module, row, densities, energies = gas
    assert module.evaluate(row[eos.RHO0], 0.0, row)[0] == 0.0


def test_every_density_gives_finite_numbers(gas):
    module, row, densities, energies = gas
    for rho in (1e-300, 1e-100, 1e-12, 1.0, 1e3, 1e5, 1e9):
        for e in (-1e6, 0.0, 1e8):
            assert np.isfinite(module.evaluate(rho, e, row)).all()
            assert module.evaluate(rho, e, row)[3] >= 0.0


def test_pressure_rises_with_density_and_has_no_jump(gas):
    """Also beyond the stated range, where the form of the curve may change."""
    module, row, densities, energies = gas
    rho = row[eos.RHO0] * np.linspace(0.3, 8.0, 20001)
    p = np.array([module.evaluate(x, 1e5, row)[0] for x in rho])
    slope = np.array([module.evaluate(x, 1e5, row)[1] for x in rho])
    rise = np.diff(p)
    assert (rise > 0.0).all()
    expected = 0.5 * (slope[1:] + slope[:-1]) * np.diff(rho)
    np.testing.assert_allclose(rise, expected, rtol=5e-3)


def test_temperature_belongs_to_the_pressure(gas):
    """T ds = de - p drho/rho^2 is a total differential: d(1/T)/drho|e = -d(p/(rho^2 T))/de|rho."""
    module, row, densities, energies = gas
    checked = 0
    for rho, e in itertools.product(densities, energies):
        p, dpdrho, dpde, T = module.evaluate(rho, e, row)
        if T < 50.0:
            continue
        checked += 1
        d = 1e-3 * rho
        dTdrho = (module.evaluate(rho + d, e, row)[3] - module.evaluate(rho - d, e, row)[3]) / (2 * d)
        d = 1e-3 * max(e, 1.0)
        dTde = (module.evaluate(rho, e + d, row)[3] - module.evaluate(rho, e - d, row)[3]) / (2 * d)
        expected = T * dpde / rho**2 - p * dTde / rho**2
        scale = abs(T * dpde / rho**2) + abs(p * dTde / rho**2)
        assert abs(dTdrho - expected) < 2e-3 * scale
    assert checked > 5


# strength


def test_dispatch_chooses_the_strength_model(solid):
    module, row, values = solid
    for ep, rate, T, p, rho in itertools.product((0.0, 0.3), (0.0, 1e4), (300.0, 600.0), (-1e9, 5e9), (2600.0, 3000.0)):
        assert dispatch.flow_stress(module.ID, ep, rate, T, p, rho, row) == module.flow_stress(ep, rate, T, p, rho, row)
        assert dispatch.shear_modulus(module.ID, p, rho, T, row) == module.shear_modulus(p, rho, T, row)
    assert math.isnan(dispatch.flow_stress(99, 0.0, 0.0, 300.0, 0.0, 2700.0, row))
    assert math.isnan(dispatch.shear_modulus(99, 0.0, 2700.0, 300.0, row))


def states():
    """Rows of pressure, density and temperature: all combinations of some, with tension, expansion and melt among them."""
    pressures, densities = (-2e9, 0.0, 1e5, 3.3e10), (1900.0, 2700.0, 4001.7)
    return np.array(list(itertools.product(pressures, densities, (0.0, 298.0, 777.7, 3000.0)))).T


def filled(fill, model, row):
    """The moduli of ``states`` as ``fill`` gives them, between two entries that it has to leave alone."""
    p, rho, T = (np.concatenate([[math.nan], values, [math.nan]]) for values in states())
    shear = np.full(p.size, -1.0)
    fill(model, row, 1, p.size - 2, p, rho, T, shear)
    assert shear[0] == shear[-1] == -1.0
    return shear[1:-1]


def test_a_row_of_moduli_is_the_modulus_of_every_cell(solid):
    module, row, values = solid
    expected = np.array([module.shear_modulus(p, rho, T, row) for p, rho, T in states().T])
    np.testing.assert_array_equal(filled(dispatch.modulus_row, module.ID, row), expected)
    if module.CONSTANT_MODULUS:
        assert set(expected) == {row[strength.SHEAR]}


def test_a_model_that_says_nothing_of_its_modulus_has_it_evaluated_in_every_cell():
    """A made-up model, G = G0 + 2 p + 3 rho + 5 T, in the text of ``modulus_row``."""

    def modulus(model, p, rho, T, par):
        return par[strength.SHEAR] + 2.0 * p + 3.0 * rho + 5.0 * T

    text = dispatch.modulus_row.py_func.__code__
    fill = types.FunctionType(text, {**vars(dispatch), "shear_modulus": modulus})
    row = np.full(strength.ROW, G)
    np.testing.assert_array_equal(filled(fill, 99, row), modulus(99, *states(), row))


def test_no_cell_without_material_has_a_modulus_evaluated():
    module = strength.STRENGTH_MODELS["steinberg-guinan"]
    shear = np.ones(1)
    dispatch.modulus_row(module.ID, module.row(STRENGTH_CASES[module.NAME]), 0, 1, *np.zeros((3, 1)), shear)
    assert shear[0] == 0.0


def test_virgin_material_at_rest(solid):
    module, row, values = solid
    rest = (300.0 if "modulus_temperature" in {entry.name for entry in module.PARAMETERS} else 298.0), 0.0, 2700.0
    assert module.flow_stress(0.0, 0.0, *rest, row) == row[strength.YIELD]
    if module.NAME != "zerilli-armstrong":  # whose yield stress is a sum
        assert row[strength.YIELD] == values.get("yield_stress", 0.0)
    assert module.shear_modulus(0.0, 2700.0, rest[0], row) == row[strength.SHEAR]


def test_strain_and_rate_harden_and_heat_softens(solid):
    module, row, values = solid
    strains = [0.0, 1e-12, 1e-6, *np.linspace(0.001, 5.0, 60), 1e3]
    flow = [module.flow_stress(ep, 1e3, 400.0, 1e9, 2750.0, row) for ep in strains]
    assert (np.diff(flow) >= 0.0).all()
    flow = [module.flow_stress(0.1, rate, 400.0, 1e9, 2750.0, row) for rate in [0.0, *np.geomspace(1e-9, 1e9, 60)]]
    assert (np.diff(flow) >= 0.0).all()
    temperatures = np.linspace(0.0, 3000.0, 200)
    flow = [module.flow_stress(0.1, 1e3, T, 1e9, 2750.0, row) for T in temperatures]
    assert (np.diff(flow) <= 0.0).all()
    assert min(flow) >= 0.0
    modulus = [module.shear_modulus(1e9, 2750.0, T, row) for T in temperatures]
    assert (np.diff(modulus) <= 0.0).all()
    assert min(modulus) >= 0.0


def test_no_strength_above_melt(solid):
    module, row, values = solid
    if "melt_temperature" in values:
        assert module.flow_stress(0.5, 1e6, values["melt_temperature"], 0.0, 2700.0, row) == 0.0
        assert module.flow_stress(0.5, 1e6, 5e4, 5e9, 3000.0, row) == 0.0


def test_every_strength_model_has_its_cases():
    assert set(STRENGTH_CASES) == set(strength.STRENGTH_MODELS)
    assert set(CONSTANT_YIELD) == set(strength.STRENGTH_MODELS) - {"hydrodynamic"}


def test_constant_yield_gives_the_same_bits():
    """With their special terms off, all models are one: flow stress, modulus and return to the yield surface."""
    rows = {name: strength.STRENGTH_MODELS[name].row(values) for name, values in CONSTANT_YIELD.items()}
    states = itertools.product((0.0, 1e-7, 0.3, 7.0), (298.0, 777.7, 3000.0), (-2e9, 0.0, 3.3e10), (2200.0, 4001.7))
    for ep, T, p, rho in states:
        for seq in (0.5 * Y, Y, 1.000001 * Y, 1.37 * Y, 311.0 * Y):
            answers = set()
            for name, row in rows.items():
                model = strength.STRENGTH_MODELS[name].ID
                modulus = dispatch.shear_modulus(model, p, rho, T, row)
                flow = dispatch.flow_stress(model, ep, 4e5, T, p, rho, row)
                answers.add(
                    (modulus, flow)
                    + radial_return.plastic_increment(model, seq, ep, 1e-8, T, p, rho, modulus, 1.0, row)
                )
            assert len(answers) == 1
            modulus, flow, dep, stress = answers.pop()
            assert (modulus, flow) == (G, Y)
            assert dep == pytest.approx(max(seq - Y, 0.0) / (3.0 * G), rel=1e-12)
            assert stress == Y


# damage


@pytest.mark.parametrize("name", list(strength.DAMAGE_MODELS))
def test_damage(name):
    module = strength.DAMAGE_MODELS[name]
    row = module.row(DAMAGE_CASES[name])
    for rate, T, p, seq in itertools.product((0.0, 1e5), (298.0, 2000.0), (-1e9, 0.0, 1e10), (0.0, 1.0, 3e8)):
        assert module.damage_increment(0.0, rate, T, p, seq, row) == 0.0
        increment = module.damage_increment(0.01, rate, T, p, seq, row)
        assert increment == dispatch.damage_increment(module.ID, 0.01, rate, T, p, seq, row)
        assert 0.0 <= increment < math.inf
    assert math.isnan(dispatch.damage_increment(99, 0.01, 0.0, 298.0, 0.0, 1.0, row))
