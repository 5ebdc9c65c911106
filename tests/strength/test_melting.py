"""The melting line of a material: Lindemann's slope, which states are solid, and the lines of the library."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.deck import deck
from hydro2d.materials import library
from strength import STRENGTH_MODELS, dispatch, melting
from tests.contract.test_models import STRENGTH_CASES

ALUMINIUM = {"melt_temperature": 1220.0, "melt_exponent": 1.5, "grueneisen": 1.97, "reference_density": 2703.0}
LINE = melting.row(ALUMINIUM)
WITH_LINE = [name for name in library.names() if library.load(name).melting]
#: decks of one body
DECK = """
numbers = "SI"
[mesh]
r = [{ to = 0.01, cells = 5 }]
z = [{ to = 0.02, cells = 10 }]
[[body]]
name = "a"
material = "A"
shape = "box"
z = [0.0, 0.01]
[stop]
time = "1 us"
[materials.A]
"""


def line_of(name):
    return melting.row({key: number.value for key, number in library.load(name).melting.items()})


@settings(max_examples=300)
@given(eta=st.floats(0.5, 3.0), gamma=st.floats(0.5, 3.5), a=st.floats(0.0, 3.5))
def test_the_slope_is_lindemanns(eta, gamma, a):
    """d ln Tm/d ln rho = 2 (Gamma - 1/3) with Gamma = Gamma0 - a (1 - 1/eta), from Tm0 on."""
    line = melting.row({**ALUMINIUM, "grueneisen": gamma, "melt_exponent": a})
    assert melting.temperature(1.0, line) == pytest.approx(1220.0, rel=1e-15)
    d = 1e-5
    low, high = (math.log(melting.temperature(eta * math.exp(x), line)) for x in (-d, d))
    assert (high - low) / (2 * d) == pytest.approx(2 * (gamma - a * (1 - 1 / eta) - 1 / 3), abs=1e-8)


@settings(max_examples=500)
@given(eta=st.floats(0.3, 3.0), share=st.floats(0.0, 3.0), gamma=st.floats(0.3, 3.5), a=st.floats(0.0, 3.5))
def test_solid_is_what_is_colder_than_the_line(eta, share, gamma, a):
    line = melting.row({**ALUMINIUM, "grueneisen": gamma, "melt_exponent": a})
    T = share * melting.temperature(eta, line)
    solid = T < melting.temperature(eta, line)
    assert melting.is_solid(T, eta, line[0], line[1], line[2]) == solid


def test_at_the_line_and_a_hair_below_it():
    for eta in (0.95, 1.0, 1.5):
        T = melting.temperature(eta, LINE)
        assert melting.solid_modulus(26e9, 2703.0 * eta, math.nextafter(T, 0.0) * (1 - 1e-14), LINE) == 26e9
        assert melting.solid_modulus(26e9, 2703.0 * eta, T * (1 + 1e-14), LINE) == 0.0


def test_a_nan_is_not_hidden():
    assert math.isnan(melting.solid_modulus(math.nan, 2703.0, 300.0, LINE))
    assert melting.is_solid(math.nan, 1.0, LINE[0], LINE[1], LINE[2])


@pytest.mark.parametrize("name", WITH_LINE)
def test_lines_of_the_library_rise_without_a_jump(name):
    line, eta = line_of(name), np.linspace(0.9, 2.0, 2201)
    temperatures = np.array([melting.temperature(x, line) for x in eta])
    rises = np.diff(temperatures) / temperatures[1:]
    assert (rises > 0.0).all()
    assert rises.max() < 0.005
    assert library.load(name).eos.numbers["specific_heat"].source


def test_how_many_metals_have_a_line():
    assert len(WITH_LINE) >= 20


@pytest.mark.parametrize("name", WITH_LINE)
def test_where_steinberg_and_guinan_melt_the_line_is_theirs(name):
    material = library.load(name)
    own = material.strength.numbers
    if material.strength.name == "steinberg-guinan":
        assert all(own[key].value == number.value for key, number in material.melting.items())
    assert all(number.source and number.confidence in library.CONFIDENCE for number in material.melting.values())


@pytest.mark.parametrize("name", sorted(set(STRENGTH_CASES) - {"hydrodynamic"}))
def test_a_row_of_moduli_ends_at_the_line_with_every_model(name):
    module = STRENGTH_MODELS[name]
    par = module.row({**STRENGTH_CASES[name], **({"melt_temperature": math.inf} if name == "steinberg-guinan" else {})})
    rho, T = np.full(6, 2703.0), np.array([300.0, 1219.9, 1220.1, 5e4, 300.0, math.nan])
    rho[4] = 0.0
    shear, p = np.full(8, -1.0), np.zeros(6)
    dispatch.modulus_row(module.ID, par, 0, 6, p, rho, T, shear)
    before = shear.copy()
    dispatch.end_at_melt(np.array(melting.NONE), 0, 6, rho, T, shear)
    np.testing.assert_array_equal(shear, before)
    dispatch.end_at_melt(LINE, 0, 6, rho, T, shear)
    np.testing.assert_array_equal(shear[[0, 1, 5, 6, 7]], before[[0, 1, 5, 6, 7]])
    assert (shear[2:5] == 0.0).all()
    assert shear[0] > 0.0


def table_of(text, failure='melting = "material"'):
    return library.resolve(deck.loads(f"{DECK}{text}\n[failure]\n{failure}\n"))


def test_the_deck_asks_for_the_line():
    text = 'based_on = "Al6061_T651"'
    np.testing.assert_array_equal(table_of(text).melting, [line_of("Al6061_T651")])
    assert table_of(text, "").melting.tolist() == [list(melting.NONE)]
    own = f"{text}\nmelting.melt_temperature = 1000.0"
    np.testing.assert_array_equal(table_of(own).melting[0][:2], [1000.0, 3.0])
    assert table_of('based_on = "nylon"').melting.tolist() == [list(melting.NONE)]


def test_another_equation_of_state_has_no_line():
    other = """based_on = "Al6061_T651"
eos = { model = "stiffened-gas", reference_density = 2700.0, sound_speed = 5240.0, adiabatic_index = 3.0, specific_heat = 885 }
"""
    assert table_of(other).melting.tolist() == [list(melting.NONE)]
    own = other + 'melting = { melt_temperature = "1220 K", grueneisen = 2.0 }\n'
    assert table_of(own).melting[0][melting.INVERSE_RHO0] == pytest.approx(1 / 2700.0)
    with pytest.raises(deck.DeckError, match="needs grueneisen"):
        table_of(other + "melting.melt_temperature = 1220.0\n")


def test_a_resolved_deck_keeps_the_line():
    given = deck.loads(f'{DECK}based_on = "Al5083"\nmelting.melt_exponent = 1.2\n[failure]\nmelting = "material"\n')
    again = deck.loads(given.to_toml())
    np.testing.assert_array_equal(library.resolve(again).melting, library.resolve(given).melting)


@pytest.mark.parametrize(("text", "words"), [
    ('based_on = "Al6061_T651"\nmelting.colour = 1.0', "colour"),
    ('based_on = "Al6061_T651"\nmelting.melt_temperature = -1.0', "must be positive"),
    ('based_on = "Al6061_T651"\nmelting = 1220.0', "must be a table"),
    ('based_on = "nylon"\nmelting.melt_exponent = 1.0', "needs melt_temperature"),
    ('based_on = "Al_porous"\nmelting.melt_temperature = 1220.0', "does not say the density of the solid"),
])
def test_refused_melting_lines(text, words):
    with pytest.raises(deck.DeckError, match=words):
        deck.loads(DECK + text)


def test_a_body_that_never_melts_is_reported():
    from hydro2d.deck.warnings import warnings

    def said(name):
        return [text for text in warnings(deck.loads(f'{DECK}based_on = "{name}"\n[failure]\nmelting = "material"\n'))
                if "melting line" in text]

    assert said("nylon")
    assert not said("Al6061_T651")
    assert not said("steel_S7")  # its own law has a melting temperature
