"""Rules that every registered equation of state, strength model and damage model must keep."""

import types

import numpy as np
import pytest

import eos
import strength
from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter
from hydro2d.materials import contract, contract_strength, tabulate
from hydro2d.materials.outside import KINDS
from strength import dispatch, tensile_pressure

SOLID = {
    "reference_density": 2770.0,
    "sound_speed": 5200.0,
    "hugoniot_slope": 1.36,
    "grueneisen": 2.2,
    "specific_heat": 875.0,
}
DENSE = {"reference_density": 999.0, "sound_speed": 1500.0, "adiabatic_index": 1.19, "covolume": 6.72e-4,
         "specific_heat": 3610.0}
LIQUID = {"reference_density": 1000.0, "sound_speed": 1480.0, "adiabatic_index": 3.0, "specific_heat": 4180.0}
TILLOTSON = {"reference_density": 2700.0, "a": 0.5, "b": 1.63, "A": 75.2e9, "B": 65e9, "E0": 5e6, "alpha": 5.0, "beta": 5.0,
             "incipient_vaporisation": 3e6, "complete_vaporisation": 13.9e6, "specific_heat": 900.0}

POROUS = {name: value for name, value in SOLID.items() if name != "reference_density"} | {
    "reference_density": 2770.0 / 1.275, "solid_density": 2770.0, "elastic_sound_speed": 4110.0, "elastic_pressure": 0.08e9,
    "crush_pressure": 0.7e9, "crush_exponent": 1.7}
CERAMIC = {"reference_density": 2510.0, "K1": 233e9, "K2": -593e9, "K3": 2800e9, "specific_heat": 950.0}
EXPLOSIVE = {"reference_density": 1630.0, "A": 371.2e9, "B": 3.231e9, "R1": 4.15, "R2": 0.95, "omega": 0.30,
             "detonation_energy": 7e9, "detonation_velocity": 6930.0, "cj_pressure": 21e9, "compression_burn": 1.0}

#: per equation of state: parameters, density over rest and specific energies (J/kg) of its stated range
EOS_CASES = {
    "mie-grueneisen": (SOLID, np.linspace(0.95, 2.0, 22), (0.0, 1e5, 3e6)),
    "ideal-gas": ({"reference_density": 1.2, "adiabatic_index": 1.4}, np.geomspace(0.01, 20.0, 9), (1.0, 2e5, 1e9)),
    "stiffened-gas": (LIQUID, np.linspace(0.9, 1.6, 9), (0.0, 1e5, 3e6)),
    "noble-abel-stiffened-gas": (DENSE, np.linspace(0.9, 1.3, 9), (0.0, 1e5, 3e6)),
    "p-alpha": (POROUS, np.linspace(0.95, 1.5, 12), (0.0, 1e5, 3e6)),
    "johnson-holmquist": (CERAMIC, np.linspace(0.95, 1.5, 12), (0.0, 1e5, 3e6)),
    "jwl": (EXPLOSIVE, np.linspace(0.95, 1.5, 12), (0.0, 4.29e6, 7e6)),
    "tillotson": (TILLOTSON, np.linspace(0.95, 2.0, 22), (0.0, 1e5, 2.9e6)),
    "tabular": ({"reference_density": 2770.0}, np.linspace(0.95, 2.0, 22), (0.0, 1e5, 3e6)),
}


def tabulated():
    """A table of SOLID in fine steps."""
    density, temperature = tabulate.points(0.9 * 2770.0, 2770.0, 2.2 * 2770.0, 201), tabulate.temperatures(298.0, 2e4, 101)
    return tabulate.table_of("aluminium", eos.MODELS["mie-grueneisen"], SOLID, density, temperature)


TABLE = tabulated()
#: needed for a row in addition to the parameters: the solid that a model builds on, a table
BASES = {"p-alpha": (eos.MODELS["mie-grueneisen"],), "tabular": (TABLE,)}
#: the parameters of a porous material whose solid is in the table
PORES = {name: value for name, value in POROUS.items() if name not in SOLID or name == "reference_density"}

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
        "max_rate_factor": 1.15,
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
    "johnson-holmquist": {
        "shear_modulus": 90.16e9, "A": 0.93, "B": 0.31, "C": 0.007, "M": 0.6, "N": 0.6, "T": 0.2e9, "HEL": 2.79e9,
        "P_HEL": 1.46e9, "crushed_limit": 0.2,
    },
    "voce": {
        "shear_modulus": G, "yield_stress": Y, "saturation": 250e6, "hardening_rate": 6.0, "rate_coefficient": 0.02,
        "max_rate_factor": 1.2, "thermal_exponent": 1.3, "melt_temperature": 877.0,
    },
    "preston-tonks-wallace": {
        "shear_modulus": 51.8e9, "modulus_softening": 0.2, "pressure_coefficient": 2.8e-11, "theta": 0.025, "p": 2.0,
        "s0": 0.0085, "s_inf": 0.00055, "y0": 0.0001, "y_inf": 0.0001, "y1": 0.094, "y2": 0.575, "beta": 0.25, "kappa": 0.11,
        "gamma": 1e-5, "molar_mass": 0.063546, "melt_temperature": 1357.0, "melt_exponent": 1.5, "grueneisen": 2.02,
        "reference_density": 2700.0,
    },
}
STRENGTH_CASES["steinberg-lund"] = STRENGTH_CASES["steinberg-guinan"] | {
    "peierls_stress": 0.82e9, "activation_energy": 0.31 * 1.602176634e-19, "attempt_rate": 0.71e6, "drag": 0.012e6}

#: one constant yield stress for every model that has one, some of the special terms switched off by their values
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
    "voce": {"shear_modulus": G, "yield_stress": Y, "thermal_exponent": 1.3},
}
CONSTANT_YIELD["steinberg-lund"] = CONSTANT_YIELD["steinberg-guinan"] | {
    "peierls_stress": 0.0, "activation_energy": 5e-20, "attempt_rate": 0.71e6, "drag": 0.012e6}

DAMAGE_CASES = {
    "none": {},
    "johnson-cook": {"D1": 0.14, "D2": 0.14, "D3": -1.5, "D4": 0.018, "D5": 0.5, "melt_temperature": 877.0,
                     "reference_cell": 1e-4, "cell_exponent": 0.5},
    "johnson-holmquist": {"D1": 0.005, "D2": 1.0, "T": 0.2e9, "P_HEL": 1.46e9, "reference_cell": 1e-4, "cell_exponent": 0.5},
    "cochran-banner": {"opening": 17e-6},
}

def cases_of(part):
    """Every registered model of a part of a material, with its case."""
    if part == "eos":
        own = [contract.Case(KINDS[part], eos.MODELS[name], values, tuple(ratios), energies, base=BASES.get(name, ()))
               for name, (values, ratios, energies) in EOS_CASES.items()]
        over_table = eos.MODELS["tabular"], TABLE
        return [*own, contract.Case(KINDS[part], eos.MODELS["p-alpha"], PORES, base=over_table)]
    if part == "damage":
        return [contract.Case(KINDS[part], strength.DAMAGE_MODELS[name], values) for name, values in DAMAGE_CASES.items()]
    return [contract.Case(KINDS[part], strength.STRENGTH_MODELS[name], values, constant=CONSTANT_YIELD.get(name))
            for name, values in STRENGTH_CASES.items()]


#: models whose pressure takes an iteration, so that pressure_rises takes half a minute
ITERATED = ("jwl", "p-alpha")
CASES = [pytest.param(case, check, id=f"{part}-{case.module.NAME}{'-over-table' * (len(case.base) > 1)}-{check.__name__}",
                      marks=[pytest.mark.thorough] * (case.module.NAME in ITERATED and check is contract.pressure_rises))
         for part, checks in contract.CHECKS.items() for case in cases_of(part) for check in checks]


@pytest.mark.parametrize(("case", "check"), CASES)
def test_contract(case, check):
    check(case)


@pytest.mark.parametrize("part", list(KINDS))
def test_every_model_has_its_case(part):
    assert {case.module.NAME for case in cases_of(part)} == set(KINDS[part].models)


@pytest.mark.parametrize("part", list(KINDS))
def test_ids_differ(part):
    models = KINDS[part].models
    assert len({module.ID for module in models.values()}) == len(models)


def test_the_yield_stress_of_the_row_is_the_parameter():
    for name, values in STRENGTH_CASES.items():
        if name not in ("zerilli-armstrong", "johnson-holmquist", "preston-tonks-wallace"):  # whose yield stress is computed
            assert strength.STRENGTH_MODELS[name].row(values)[strength.YIELD] == values.get("yield_stress", 0.0)


def test_constant_yield_has_the_same_numbers_in_every_model():
    assert set(CONSTANT_YIELD) == set(strength.STRENGTH_MODELS) - {"hydrodynamic", "johnson-holmquist", "preston-tonks-wallace"}
    for name, values in CONSTANT_YIELD.items():
        row = strength.STRENGTH_MODELS[name].row(values)
        assert (row[strength.SHEAR], row[strength.YIELD]) == (G, Y)


# the checks can fail


def spoilt(part, name, **functions):
    """A case of a model with some functions or constants replaced."""
    case = next(case for case in cases_of(part) if case.module.NAME == name)
    module = types.SimpleNamespace(**{**vars(case.module), **functions})
    return contract.Case(case.kind, module, case.values, case.densities, case.energies, case.constant, case.base)


def gas(rho=0.0, e=0.0, p=0.0, slope=1.0, T=1.0):
    """An ideal gas with something added to its pressure or its energy, and factors on its slopes and temperature."""
    own = eos.MODELS["ideal-gas"].evaluate

    def evaluate(density, energy, par):
        state = own(density + rho, energy + e, par)
        return state[0] + p, state[1] * slope, state[2], state[3] * T ** (density / 1.2)

    return spoilt("eos", "ideal-gas", evaluate=evaluate)


def pores(**functions):
    return spoilt("eos", "p-alpha", **functions)


def metal(**functions):
    return spoilt("strength", "johnson-cook", **functions)


def layered(**functions):
    return spoilt("strength", "kinematic-hardening", **functions)


def crushed_to(value):
    """An update that sets the distention to this value as soon as the density changes."""
    return lambda rho0, rho, *rest: rest[-1].fill(value) if rho != rho0 else None


POSITIVE_YIELD = (Parameter("yield_stress", "Pa", REQUIRED, "initial yield stress", sign=POSITIVE),)
FLOW = strength.STRENGTH_MODELS["johnson-cook"].flow_stress


@pytest.mark.parametrize(
    ("check", "case", "words"),
    [
        (contract.row, metal(row=lambda values: np.zeros(3)), r"row gives float64 \(3,\), not float64 \(24,\)"),
        (contract.row, metal(row=lambda values: np.full(strength.ROW, np.nan)), "NaN in slot 0"),
        (contract.wrong_parameters, metal(row=lambda values: np.zeros(strength.ROW)), 'unknown parameter "colour"'),
        (contract.ranges, metal(PARAMETERS=POSITIVE_YIELD), r"row takes a parameter that is wrong \(yield_stress = 0\)"),
        (contract.eos_is_chosen, gas(p=1.0), "by its ID"),
        (contract.derivatives, gas(slope=1.001), "dp/drho is"),
        (contract.sound_speed, gas(slope=-9.0), r"c\^2 is -"),
        (contract.rest, gas(p=1.0), "p is 1 Pa"),
        (contract.finite, gas(p=np.nan), "evaluate"),
        (contract.pressure_rises, gas(slope=1.1), "p rises by"),
        (contract.temperature, gas(T=1.1), "dT/drho is"),
        (contract.memory, pores(update=lambda *step: step[-1].fill(1.1)), r"at rest \[1.275"),
        (contract.memory, pores(update=crushed_to(0.9)), r"become \[0.9\], beyond"),
        (contract.memory, pores(update=crushed_to(np.nan)), r"become \[nan\], beyond"),
        (contract.memory, pores(ID=99), "by its ID"),
        (contract.strength_is_chosen, metal(ID=1), "by its ID"),
        (contract.moduli, metal(shear_modulus=lambda p, rho, T, par: 2 * G), "the modulus is 5.2e[+]10"),
        (contract.virgin, metal(flow_stress=lambda *state: FLOW(*state) + 1.0), "slot YIELD"),
        (contract.monotone, metal(flow_stress=lambda ep, *state: 1e9 - ep), "falls from plastic strain"),
        (contract.monotone, metal(flow_stress=lambda ep, rate, *state: 1e9 - rate), "falls from strain rate"),
        (contract.monotone, metal(flow_stress=lambda ep, rate, T, *state: T), "rises from temperature"),
        (contract.melt, metal(flow_stress=lambda *state: 1.0), "is 1 Pa at 877 K"),
        (contract.yield_floor, metal(yield_floor=lambda par: 1e9), "the floor 1e[+]09"),
        (contract.constant_yield, metal(ID=99), "of elastic-plastic"),
        (contract.internal_variables, layered(harden=lambda *state: state[-1].fill(1.0)), "or spin, zeros become"),
        (contract.internal_variables, layered(kinematic_modulus=lambda par: 1e9), "kinematic_modulus says 1e[+]07 Pa"),
        (contract.internal_variables, layered(turn=lambda spin, internal: internal.fill(spin and np.nan)), "a spin of 0.1"),
        (contract.damage, spoilt("damage", "johnson-cook", damage_increment=lambda *state: 0.1), "without plastic strain"),
        (contract.damage, spoilt("damage", "johnson-cook", damage_increment=lambda dep, *state: -dep), "with a plastic strain"),
        (contract.damage, spoilt("damage", "johnson-cook", damage_increment=lambda dep, *state: 3.0 * dep), "by its ID"),
        (contract.cell_size, spoilt("damage", "johnson-cook", size_factor=lambda area, par: -1.0), "is not positive"),
        (contract.cell_size, spoilt("damage", "johnson-cook", size_factor=lambda area, par: 1.0 / area), "factor falls from"),
        (contract.cell_size, spoilt("damage", "johnson-cook", size_factor=lambda area, par: 1.0 + area), "by its ID"),
        (contract.cracks, spoilt("damage", "cochran-banner", tension_left=lambda damage, par: 1.0), "at damage 1 the share"),
        (contract.cracks, spoilt("damage", "cochran-banner", tension_left=lambda damage, par: 0.9 - damage), "at damage 0"),
        (contract.cracks, spoilt("damage", "cochran-banner", tension_left=lambda damage, par: float(damage < 1.0)), "not fall"),
        (contract.cracks, spoilt("damage", "cochran-banner", tension_left=lambda damage, par: 1.0 - damage), "by its ID"),
        (contract.cracks, spoilt("damage", "cochran-banner", full_opening=lambda par: 0.0), "full_opening is 0 m"),
    ],
)
def test_a_model_that_breaks_the_contract_is_found(check, case, words):
    with pytest.raises(contract.Broken, match=words):
        check(case)


# what a model says about itself


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
        with pytest.raises(ValueError, match=f'did you mean "{name}"'):
            describe(name + "x")


# moduli by rows


def test_a_model_that_says_nothing_of_its_modulus_has_it_evaluated_in_every_cell():
    """A made-up model, G = G0 + 2 p + 3 rho + 5 T, in the text of ``modulus_row``."""

    def modulus(model, p, rho, T, par):
        return par[strength.SHEAR] + 2.0 * p + 3.0 * rho + 5.0 * T

    text = dispatch.modulus_row.py_func.__code__
    fill = types.FunctionType(text, {**vars(dispatch), "shear_modulus": modulus})
    row = np.full(strength.ROW, G)
    p, rho, T = contract_strength.states()
    shear = np.empty(p.size)
    fill(99, row, 0, p.size, p, rho, T, shear)
    np.testing.assert_array_equal(shear, modulus(99, p, rho, T, row))


def test_no_cell_without_material_has_a_modulus_evaluated():
    module = strength.STRENGTH_MODELS["steinberg-guinan"]
    shear = np.ones(1)
    dispatch.modulus_row(module.ID, module.row(STRENGTH_CASES[module.NAME]), 0, 1, *np.zeros((3, 1)), shear)
    assert shear[0] == 0.0
