"""The field table and what depends on it."""

import numpy as np
import pytest

from hydro2d.mesh import fields
from hydro2d.mesh.grid import Grid
from hydro2d.mesh.state import State


def test_the_state_has_a_view_of_either_offset_of_the_centroids_which_a_restart_needs():
    state = State(Grid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 5)), 2)
    assert state.centroid.shape == (2, 2, 8, 7)
    state.centroid[0], state.centroid[1] = 1.0, 2.0
    assert (state.centroid_r == 1.0).all()
    assert (state.centroid_z == 2.0).all()
    assert state.restartable()["centroid"] is state.centroid


def test_the_rules_are_the_table_and_the_internal_variables_behind_it():
    own = (fields.Field("spread", "", "body", "1", -1, "mass", True, "a number", -2.0, 3.0),)
    rules = fields.remap_rules([(), own])
    assert rules.shape == (2, len(fields.BODY) + 1, 4)
    np.testing.assert_array_equal(rules[0, :-1], rules[1, :-1])
    assert rules[1, fields.INTERNAL].tolist() == [1.0, -2.0, 3.0, -1.0]
    assert rules[0, fields.INTERNAL].tolist() == [0.0, -np.inf, np.inf, 1.0]
    for field, (by_mass, least, most, parity) in zip(fields.BODY, rules[0, :-1], strict=True):
        assert (by_mass == 1.0) == (field.symbol in ("e", "ep", "dmg"))
        assert (least == 0.0) == (field.symbol in ("ep", "dmg"))
        assert (most == fields.FAILED) == (field.symbol == "dmg")
        assert (parity == -1.0) == (field.symbol == "srz")


def test_only_a_run_that_needs_them_has_rows_for_internal_variables():
    grid = Grid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 5))
    assert State(grid, 2).q.shape[0] == fields.INTERNAL
    own = (fields.Field("spread", "", "body", "1", -1, "mass", True, "a number"),)
    assert State(grid, 2, None, [(), own]).q.shape[0] == fields.INTERNAL + 1


@pytest.mark.parametrize("groups", [1, 2])
def test_every_array_of_the_state_is_in_a_table(groups):
    state = State(Grid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 5)), 2, [0, groups - 1])
    tables = [*fields.FIELDS, *fields.WORK, *(fields.CONTACT_WORK if groups == 2 else fields.HOLD_WORK)]
    symbols = [entry.symbol for entry in tables]
    assert len(set(symbols)) == len(symbols)
    arrays = {name for name, value in vars(state).items() if isinstance(value, np.ndarray)}
    assert arrays - set(symbols) == {"group", "rules", "initial", "q", "centroid", "velocity", "velocity0", "body_range",
                                     "active_range"}
    assert set(symbols) <= arrays


def test_fields_that_a_body_carries():
    """In addition to the density: energy for all bodies, deviators and strain for those with strength, damage likewise."""
    own = (fields.Field("spread", "", "body", "1", 1, "mass", True, "a number", initial=lambda row: 2.0 * row[0]),)
    assert fields.carried((), strength=False, damage=False) == [fields.E]
    assert fields.carried((), strength=True, damage=False) == [1, 2, 3, 4, 5]
    assert fields.carried(own, strength=False, damage=True) == [1, fields.DMG, fields.INTERNAL]
    rows = fields.carried_rows([[1], [1, 6, 7]])
    np.testing.assert_array_equal(rows, [[1, 1, 0, 0], [3, 1, 6, 7]])
    assert own[0].at_rest(np.array([3.0])) == 6.0
    assert fields.BODY[0].at_rest(np.zeros(1)) == 0.0


def test_virgin_material_fills_the_state():
    grid = Grid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 5))
    own = (fields.Field("spread", "", "body", "1", 1, "mass", True, "a number", initial=3.0),)
    state = State(grid, 2, None, [(), own], [np.zeros(0), np.array([3.0])], remembers=True)
    assert state.initial.shape == (fields.INTERNAL + 1, 2)
    assert (state.q[fields.INTERNAL, 1] == 3.0).all()
    assert not state.q[:, 0].any()
    assert state.before.shape == (3, 2, *grid.shape)
