"""Members of an ensemble: the changes, their size, and refusals."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.deck import identity
from hydro2d.study.ensemble import chance
from hydro2d.study.plan import cases, members
from hydro2d.study.plan.definition import Ensemble, StudyError

SHOT = "problems/cth_nose_shape/hemi_5083_1086_quick.toml"
BAR = "problems/classic/taylor_bar.toml"
ALL = ("mesh offset", "flank offset", "first step")


def planned(deck=SHOT, axes=(), **ensemble):
    return cases.plan_of({"deck": deck, "ensemble": {"repeats": 4, **ensemble}, "axis": list(axes)} if axes else
                         {"deck": deck, "ensemble": {"repeats": 4, **ensemble}}, "shot").cases


def refused(deck=SHOT, axes=(), **ensemble):
    with pytest.raises(StudyError) as error:
        planned(deck, axes, **ensemble)
    (line,) = str(error.value).splitlines()
    return line


def test_the_first_member_is_the_unchanged_deck():
    first = planned()[0]
    assert (first.name, first.member, first.changed) == ("m0", 0, {})
    assert first.text == decks.load(SHOT).to_toml()


def test_the_mesh_is_shifted_by_a_fraction_of_its_smallest_cell():
    """The whole mesh moves, and nothing else does."""
    before = decks.load(SHOT)
    cell = np.diff(decks.edges(before)[1]).min()
    for case in planned(by=["mesh offset"])[1:]:
        after = decks.loads(case.text)
        (r, z), (r0, z0) = decks.edges(after), decks.edges(before)
        np.testing.assert_array_equal(r, r0)
        np.testing.assert_allclose(z - z0, case.changed["mesh offset"] * cell, rtol=1e-6)
        assert after.body == before.body
        assert after.numerics == before.numerics


def test_the_flank_moves_within_its_cell_and_no_cell_is_lost():
    before = decks.load(SHOT)
    _, radius = identity.with_radius(before)
    for case in planned(by=["flank offset"])[1:]:
        after = decks.loads(case.text)
        assert identity.cells_to(after, radius) == pytest.approx(5.5 + case.changed["flank offset"], abs=1e-9)
        assert abs(case.changed["flank offset"]) <= 0.25
        assert [len(one) for one in decks.edges(after)] == [len(one) for one in decks.edges(before)]


def test_the_first_step_is_reduced_by_thousandths():
    for case in planned(by=["first step"])[1:]:
        assert 0.996 <= case.changed["first step"] < 1.0
        assert decks.loads(case.text).numerics.initial_dt_factor == pytest.approx(0.1 * case.changed["first step"])


def test_amounts_cover_their_range_and_do_not_depend_on_the_number_of_members():
    """Of 16 members one or more are in each eighth; another seed gives others."""
    offsets = [members.amounts(Ensemble(repeats=16, by=ALL), n)["mesh offset"] for n in range(1, 17)]
    assert set(np.floor((np.array(offsets) + 0.5) * 8)) == set(range(8))
    few, many = (Ensemble(repeats=repeats, by=ALL) for repeats in (4, 1000))
    assert members.amounts(few, 3) == members.amounts(many, 3)
    assert members.amounts(Ensemble(repeats=4, by=ALL, seed=1), 3) != members.amounts(few, 3)


def test_amounts_stay_the_same_for_ever():
    """They are written in pages and records: a change of the sequence would make other members from the same seed."""
    assert members.amounts(Ensemble(repeats=2), 1) == {"mesh offset": 0.0993, "first step": 0.998343}


def test_members_are_named_after_their_case():
    axis = {"name": "velocity", "key": "body.rod.velocity", "values": ["1086 m/s", "1200 m/s"]}
    plan = planned(axes=[axis], repeats=2)
    assert [(case.name, case.of, case.member) for case in plan] == [
        ("1086m-s", "1086m-s", 0), ("1086m-s_m1", "1086m-s", 1),
        ("1200m-s", "1200m-s", 0), ("1200m-s_m1", "1200m-s", 1)]
    assert plan[1].changed == plan[3].changed


@pytest.mark.parametrize(("ensemble", "said"), [
    ({"repeats": 0}, "repeats"), ({"repeats": 1}, "repeats"), ({"repeats": 1e9}, "repeats"), ({"by": []}, "by"),
    ({"by": ["first step", "first step"]}, "twice"), ({"by": ["second step"]}, "second step"), ({"seed": -1}, "seed"),
    ({"repeat": 3}, 'did you mean "repeats"'),
])
def test_a_wrong_ensemble_is_one_message(ensemble, said):
    if "repeat" in ensemble:
        with pytest.raises(StudyError, match=said):
            cases.plan_of({"deck": SHOT, "ensemble": {"repeats": 2, **ensemble}}, "shot")
    else:
        assert said in refused(**ensemble)


@pytest.mark.parametrize(("key", "by"), [("numerics.initial_dt_factor", "first step"), ("mesh.z_start", "mesh offset")])
def test_an_axis_must_not_set_keys_that_the_ensemble_changes(key, by):
    axis = {"name": "mine", "key": key, "values": [0.1, 0.2]}
    line = refused(axes=[axis])
    assert f'axis "mine" sets {key}' in line
    assert by in line


def test_an_axis_of_whole_meshes_may_be_combined_with_an_offset():
    mesh = {"z_start": "-110 mm", "z": [{"to": "150 mm", "size": "1 mm"}],
            "reach": "none", "cells_across": "none", "fine": "none"}
    plan = planned(axes=[{"name": "mesh", "variants": {"coarse": {"mesh": mesh}}}], by=["mesh offset"])
    assert decks.loads(plan[1].text).mesh.z_start == pytest.approx(-0.11 + 1e-3 * plan[1].changed["mesh offset"])


def test_a_wall_does_not_move_against_the_bodies():
    line = refused(BAR)
    assert 'z_min = "wall"' in line
    assert "first step" in line
    assert len(planned(BAR, by=["first step"])) == 4


def test_too_many_members_of_too_many_cases():
    axis = {"name": "velocity", "key": "body.rod.velocity", "range": {"from": "900 m/s", "to": "1000 m/s", "step": "1 m/s"}}
    assert "101000 cases" in refused(axes=[axis], repeats=1000)


SPEEDS = {"from": "900 m/s", "to": "1000 m/s"}


@pytest.mark.parametrize(("search", "said"), [
    ({}, "give [transition] a `budget` of runs instead"),
    ({"of": "erosion", "budget": 8}, "every run is another draw already; leave it out. `seed` in [transition]"),
])
def test_a_search_takes_no_ensemble_and_says_what_to_do_instead(search, said):
    with pytest.raises(StudyError) as caught:
        cases.plan_of({"deck": SHOT, "ensemble": {"repeats": 2}, "transition": {**SPEEDS, **search}}, "shot")
    assert str(caught.value).startswith("shot: ensemble: ")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_wilson_is_that_of_the_literature():
    """Newcombe, Statistics in Medicine 17 (1998) 857, Table I: 81 of 263 and 0 of 20, 95 %."""
    assert chance.wilson(81, 263, 0.95)[3:] == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert chance.wilson(0, 20, 0.95)[3:] == pytest.approx((0.0, 0.1611), abs=5e-5)


def test_spread_of_values():
    assert chance.spread([]) is None
    assert chance.spread([3.0]) == (3.0, 3.0, 3.0, 1)
    assert chance.spread(range(11)) == (5.0, 1.0, 9.0, 11)
