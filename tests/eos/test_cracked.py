"""Cracked material: the pressure of its solid, cracks that open and close, and what its deck needs."""

import numpy as np
import pytest

from eos import cracked, dispatch, mie_grueneisen
from eos.layout import SOLID_AT
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.materials import library
from tests.decks import box, material, mesh, stop, table

RHO0, TENSION = 2700.0, 1.2e9
SOLID = mie_grueneisen.row({"reference_density": RHO0, "sound_speed": 5350.0, "hugoniot_slope": 1.34, "grueneisen": 2.0,
                            "specific_heat": 890.0})
ROW = cracked.row(mie_grueneisen.ID, SOLID)

#: the models that cracked material may build on must be known before its compiled functions are loaded
assert dispatch.WITH_MEMORY


def state(rho, e, cracks, growth=0.0):
    return cracked.evaluate(rho, e, np.array([cracks, growth]), ROW)


def after(rho, e, cracks):
    """The crack volume after a step to a density and an energy."""
    internal = np.array([cracks, 0.0])
    cracked.update(RHO0, rho, e, *np.zeros(7), ROW, internal)
    return internal[0]


@pytest.mark.parametrize("rho", [2500.0, 2700.0, 3100.0])
def test_without_cracks_it_is_its_solid(rho):
    """To the last bit."""
    assert state(rho, 1e5, 0.0) == mie_grueneisen.evaluate(rho, 1e5, SOLID)
    assert ROW[SOLID_AT:].tolist() == SOLID.tolist()


@pytest.mark.parametrize("cracks", [1e-6, 4e-5, 1.5e-4])
def test_the_pressure_is_that_of_the_solid_and_follows_from_the_energy(cracks):
    """p = p_s; its slope agrees with differences; at constant crack volume only the volume of the solid changes."""
    rho, e, small = 1.0 / (1.0 / 2650.0 + cracks), 2e5, 1e-3
    p, dpdrho, dpde, T = state(rho, e, cracks)
    assert (p, T) == pytest.approx(mie_grueneisen.evaluate(2650.0, e, SOLID)[::3], rel=1e-10)
    slope = (state(rho + small, e, cracks)[0] - state(rho - small, e, cracks)[0]) / (2 * small)
    assert dpdrho == pytest.approx(slope, rel=1e-6)
    assert dpde == pytest.approx((state(rho, e + 1.0, cracks)[0] - state(rho, e - 1.0, cracks)[0]) / 2.0, rel=1e-6)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_cracks_open_until_the_tension_is_what_is_borne(share):
    rho, e = 2500.0, 1e5
    assert state(rho, e, 0.0)[0] < -TENSION
    wide = cracked.opened(rho, e, share * TENSION, 0.0, ROW)
    assert wide > 0.0
    assert state(rho, e, wide)[0] == pytest.approx(-share * TENSION, abs=1e-9 * TENSION)
    assert cracked.opened(rho, e, share * TENSION, 1.01 * wide, ROW) == 1.01 * wide, "cracks that are wider stay"


def test_cracks_close_without_pressure_before_the_solid_is_compressed():
    open_ = 1e-5
    assert state(2690.0, 0.0, open_)[0] > 0.0
    left = after(2690.0, 0.0, open_)
    assert 0.0 < left < open_
    assert state(2690.0, 0.0, left)[0] == pytest.approx(0.0, abs=1.0)
    assert after(2600.0, 0.0, open_) == open_, "in tension they stay"
    assert after(2800.0, 0.0, open_) == 0.0
    assert state(2800.0, 0.0, 0.0)[0] > 0.0


PLATE = mesh((1e-3, 2), (1e-2, 10)) + box("plate", "metal", z=[0.0, 5e-3]) + stop(1e-7)
CRACKS = {"model": "cochran-banner", "opening": "17 um"}


def table_of(text):
    return library.resolve(deck.loads(PLATE + text))


def test_a_body_of_it_has_the_crack_volume_and_no_other_fracture_pressure():
    metal = material("metal", "Al6061_T6", fracture_pressure=TENSION, damage=CRACKS)
    cracking = table_of(metal + table("failure", damage="material"))
    assert [field.name for field in cracking.internal[0]] == ["crack_volume", "crack_growth"]
    assert (cracking.cracking.tolist(), cracking.fracture_pressure.tolist()) == ([TENSION], [np.inf])
    plain = table_of(metal + table("failure", damage="none"))
    assert (plain.internal, plain.cracking.tolist(), plain.fracture_pressure.tolist()) == (((),), [0.0], [TENSION])


@pytest.mark.parametrize(("based_on", "keys", "failure", "message"), [
    ("Al6061_T6", {}, {}, "needs a fracture_pressure, the tension at which cracks open"),
    ("Al6061_T6", {"fracture_pressure": TENSION}, {"tensile": "none"}, 'write tensile = "material"'),
    ("Al_porous", {"fracture_pressure": TENSION}, {}, "without internal variables, and p-alpha has some"),
    ("alumina_995", {"fracture_pressure": TENSION}, {}, "the strength model johnson-holmquist falls with a damage of its own"),
])
def test_models_that_do_not_go_with_cracks_are_refused(based_on, keys, failure, message):
    with pytest.raises(DeckError, match=message):
        table_of(material("metal", based_on, damage=CRACKS, **keys) + table("failure", damage="material", **failure))
