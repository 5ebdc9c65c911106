"""The field table and what depends on it."""

import numpy as np
import pytest

from hydro2d import jit
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


def test_the_state_has_a_view_of_either_offset_of_the_centroids_which_a_restart_needs():
    state = State(Grid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 5)), 2)
    assert state.centroid.shape == (2, 2, 8, 7)
    state.centroid[0], state.centroid[1] = 1.0, 2.0
    assert (state.centroid_r == 1.0).all()
    assert (state.centroid_z == 2.0).all()
    assert state.restartable()["centroid"] is state.centroid


def test_offsets_along_r_and_components_of_r_change_sign_in_a_mirror():
    odd = {field.symbol for field in fields.FIELDS if field.parity < 0}
    assert odd == {"srz", "centroid_r", "qrz", "sig_rz", "u", "u0"}


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


def test_axes_of_work_are_lengths():
    state = State(Grid(np.linspace(0.0, 1.0, 4), np.linspace(0.0, 1.0, 71)), 2, [0, 1])
    assert state.flux.shape == (7, 2, 6 * jit.max_threads(), 8)
    assert state.scratch.shape == (4, jit.max_threads(), 8)
    assert state.removed.shape == (6, 75)
    assert state.strips.shape == (74, 3, 4, 2)
    assert state.flux_place.shape == (2, 2, 75, 8)
    assert state.edge_dual.shape == (2, 2, 5, 75)
    assert state.body_ranges.shape == (3, 2, 74, 2)
    assert (state.body_ranges.dtype, state.zone.dtype, state.fr.dtype) == (np.int64, np.int8, np.float64)


@pytest.mark.parametrize("field", fields.FIELDS, ids=lambda field: field.name)
def test_rows_make_sense(field):
    assert field.centring in ("body", "cell", "vertex")
    assert field.remap in ("volume", "mass", "momentum", "")
    assert field.parity in (-1, 1)
    assert field.least < field.most


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
