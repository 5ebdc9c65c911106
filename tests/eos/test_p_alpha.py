"""P-alpha: the elastic range, the crush curve, permanent crushing, and material without pores."""


import numpy as np
import pytest

from eos import dispatch, ideal_gas, mie_grueneisen, p_alpha
from eos.layout import RHO0
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.materials import library

SOLID = {"sound_speed": 5350.0, "hugoniot_slope": 1.34, "grueneisen": 2.0, "specific_heat": 890.0}
POROUS = {"reference_density": 2000.0, "solid_density": 2700.0, "elastic_sound_speed": 4110.0, "elastic_pressure": 0.08e9,
          "crush_pressure": 0.7e9}
ROW = p_alpha.row({**SOLID, **POROUS}, mie_grueneisen)
VIRGIN = 2700.0 / 2000.0


#: the models that p-alpha may build on must be known before its compiled functions are loaded
assert dispatch.WITH_MEMORY


def after(rho, distention=VIRGIN, e=0.0):
    """The distention after a step to a density and an energy."""
    internal = np.array([distention])
    p_alpha.update(ROW[RHO0], rho, e, *np.zeros(7), ROW, internal)
    return internal[0]


def pressure(rho, distention, e=0.0):
    return p_alpha.evaluate(rho, e, np.array([distention]), ROW)[0]


def test_the_elastic_range_is_herrmanns():
    """d(alpha)/dp = alpha^2/K_s (1 - 1/h^2) at low pressure."""
    rho = 2000.0 * (1 + 1e-7)
    alpha = p_alpha.solid_density(rho, VIRGIN, ROW)[0] / rho
    slope = VIRGIN**2 / (2700.0 * 5350.0**2) * (1.0 - (5350.0 / 4110.0) ** 2)
    assert (alpha - VIRGIN) / pressure(rho, VIRGIN) == pytest.approx(slope, rel=1e-5)


@pytest.mark.parametrize("e", [0.0, 1e5])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_on_the_crush_curve(share, e):
    """The distention and the pressure after a step lie on it: alpha = 1 + (alpha_e - 1) ((P_s - p)/(P_s - P_e))^2."""
    rho = 2000.0 + share * 690.0
    left = after(rho, e=e)
    p, alpha = pressure(rho, left, e), p_alpha.solid_density(rho, left, ROW)[0] / rho
    assert 0.08e9 < p < 0.7e9
    elastic = ROW[p_alpha.DISTENTION]
    assert alpha == pytest.approx(1.0 + (elastic - 1.0) * ((0.7e9 - p) / 0.62e9) ** 2, abs=1e-10)


def test_crushed_material_stays_crushed():
    crushed = after(2400.0)
    back = 2700.0 / crushed  # the density at zero pressure
    assert back > 2000.0
    assert pressure(back, crushed) == pytest.approx(0.0, abs=1.0)
    assert after(back, crushed) == crushed
    assert after(2399.9, crushed) == crushed
    assert after(2400.1, crushed) < crushed
    assert after(2400.0, crushed) == pytest.approx(crushed, abs=1e-11)


def test_heat_crushes_as_well():
    assert after(2300.0, e=2e5) < after(2300.0)


@pytest.mark.parametrize(("change", "words"), [
    ({"reference_density": 2700.0}, "must be below solid_density = 2700"),
    ({"elastic_pressure": 0.7e9}, "must be below crush_pressure"),
    ({"elastic_sound_speed": 5400.0}, "above the 5350 of the solid"),
    ({"elastic_pressure": 1e14, "crush_pressure": 2e14}, "reached at no density below twice that at rest"),
])
def test_constants_that_contradict_one_another(change, words):
    with pytest.raises(ValueError, match=words):
        p_alpha.row({**SOLID, **POROUS, **change}, mie_grueneisen)


DECK = "problems/verification/porous_compaction.toml"


@pytest.mark.parametrize(("override", "words"), [
    ('materials.Al_porous={based_on="Al_porous", eos={reference_density="2800 kg/m^3"}}',
     "reference_density = 2800, with the pores, must be below solid_density = 2700"),
    ('materials.Al_porous={based_on="Al_porous", eos={model="p-alpha", solid="p-alpha"}}',
     "unknown equation of state without memory .*allowed: ideal-gas, mie-grueneisen, noble-abel-stiffened-gas, stiffened-gas"),
    ('materials.Al_porous={based_on="Al_porous", eos={hardness=1}}', 'unknown parameter of p-alpha "hardness"'),
    ('materials.Al_porous={based_on="Al_porous", eos={sound_speed="-1 m/s"}}', "must be non-negative|must be positive"),
    ('materials.Al_porous={eos={model="p-alpha", reference_density=2000}}', "p-alpha needs solid"),
    ('materials.Al_porous={based_on="Al5083", eos={solid="ideal-gas"}}', "mie-grueneisen does not build on another"),
])
def test_decks_that_are_wrong(override, words):
    with pytest.raises(DeckError, match=words):
        library.resolve(deck.load(DECK, [override]))


def test_any_equation_of_state_without_memory_may_be_the_solid():
    """An ideal gas as the solid makes little sense, but its pressure at rest is divided by alpha."""
    own = {name: value for name, value in POROUS.items() if name != "elastic_pressure"}
    gas = {**own, "adiabatic_index": 1.4, "reference_energy": 1e7, "elastic_pressure": 1.1e10, "crush_pressure": 1.2e11,
           "elastic_sound_speed": 1900.0}
    row = p_alpha.row(gas, ideal_gas)
    assert p_alpha.evaluate(2000.0, 1e7, np.array([VIRGIN]), row)[0] == pytest.approx(0.4 * 2700.0 * 1e7 / VIRGIN, rel=1e-12)


def test_the_resolved_deck_names_the_solid():
    loaded = deck.load(DECK)
    again = deck.loads(loaded.to_toml(), name=loaded.name)
    assert again.materials["Al_porous"].eos.solid == "mie-grueneisen"
    assert again.to_toml() == loaded.to_toml()
    table = library.resolve(again)
    assert table.virgin(0) == pytest.approx([1.275], rel=1e-6)
    assert table.remembers
