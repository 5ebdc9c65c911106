"""The field table and what follows from it."""

import numpy as np
import pytest

from hydro2d.mesh import fields
from hydro2d.mesh.grid import Grid
from hydro2d.mesh.state import State


def test_constants_are_positions_in_the_table():
    named = {"rho": fields.RHO, "e": fields.E, "srr": fields.SRR, "szz": fields.SZZ, "srz": fields.SRZ, "ep": fields.EP,
             "dmg": fields.DMG}
    assert {field.symbol: k for k, field in enumerate(fields.BODY)} == named


def test_the_state_has_a_view_of_every_row():
    state = State(Grid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 5)), 2)
    for k, field in enumerate(fields.BODY):
        state.q[k] = k
        assert (getattr(state, field.symbol) == k).all()


def test_what_has_a_sign_is_not_bounded():
    for field, bounded in zip(fields.BODY, fields.BOUNDED, strict=True):
        assert bounded == (field.symbol in ("ep", "dmg"))


@pytest.mark.parametrize("field", fields.FIELDS, ids=lambda field: field.name)
def test_rows_make_sense(field):
    assert field.centring in ("body", "cell", "vertex")
    assert field.remap in ("volume", "mass", "momentum", "")
    assert field.parity in (-1, 1)
    assert field.least < field.most
