"""Where material fractures, and how much void opens."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hydro2d.mesh.fields import CRUSHED, FAILED
from hydro2d.physics import fracture

crushed = fracture.crushed.py_func
damaged = fracture.damaged.py_func
tension_limit = fracture.tension_limit.py_func
share_that_stays = fracture.share_that_stays.py_func


@pytest.mark.parametrize("damage", [1.0, 1.0000001])
def test_failed_material_bears_no_tension(damage):
    assert tension_limit(3.5e9, 0.0, damage) == 0.0


def test_the_tension_of_brittle_material_fades_with_damage():
    assert tension_limit(2e8, 1.0, 0.25) == 1.5e8
    assert tension_limit(2e8, 1.0, CRUSHED) == pytest.approx(0.2, rel=1e-6)


def test_crushed_material_has_not_failed():
    assert crushed(0.2, 0.3) == 0.5
    assert crushed(0.2, 5.0) == CRUSHED < 1.0 < damaged(0.2, 5.0)


@given(st.floats(1.0, 2e4), st.floats(1.0, 1.25))
def test_the_mass_of_what_stays_has_the_density_without_tension(rho, stretched):
    """Up to the opening allowed, here a fifth: a volume of one contained the mass rho."""
    relaxed = stretched * rho
    assert rho / share_that_stays(rho, relaxed, 0.2) == pytest.approx(relaxed, rel=1e-12)


@pytest.mark.parametrize(
    ("before", "increment", "after"),
    [(0.0, 0.3, 0.3), (0.5, 0.4999, 0.9999), (0.5, 0.5, FAILED), (0.0, 7.0, FAILED), (FAILED, 0.1, FAILED), (1.2, 0.1, 1.2)],
)
def test_damage_jumps_once_it_reaches_one(before, increment, after):
    """As far beyond 1 as sound material is below it; values mixed by the remap stay as they are."""
    assert FAILED == 2.0
    assert damaged(before, increment) == pytest.approx(after, abs=1e-15)


def test_the_opening_of_cracks_is_their_volume_per_area():
    """Half of a cell of 40 um, with 1e-5 m^3/kg of cracks in 2000 kg/m^3: 2 % of 20 um."""
    assert fracture.crack_opening.py_func(0.5, 2000.0, 1e-5, 4e-5) == pytest.approx(4e-7, rel=1e-15)
