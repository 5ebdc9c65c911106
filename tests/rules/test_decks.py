"""Every shipped deck loads, says where it comes from, and is named in its folder's README."""

import pytest

from hydro2d.analytic.model_transition import experiments
from hydro2d.deck import deck
from hydro2d.study import study_parts
from hydro2d.study.plan import cases
from hydro2d.study.plan.scaling import AS_IT_IS
from tests.rules import source

PROBLEMS = source.PROBLEMS
DECKS, STUDIES = source.problems()
FILES = [*DECKS, *STUDIES]
COMPLETE = [file for file in DECKS if not file.stem.startswith("_")]


def name_of(file):
    return str(file.relative_to(PROBLEMS))


def test_decks_are_shipped():
    assert (PROBLEMS / "cth_nose_shape" / "hemi_5083_1086_quick.toml") in COMPLETE


@pytest.mark.parametrize("file", COMPLETE, ids=name_of)
def test_deck_loads(file):
    assert deck.load(file).title


@pytest.mark.parametrize("file", COMPLETE, ids=name_of)
def test_deck_says_which_failure_it_means(file):
    assert [text for text in deck.warnings(deck.load(file)) if "failure." in text] == []


@pytest.mark.parametrize("file", COMPLETE, ids=name_of)
def test_resolved_deck_is_the_same_deck(file):
    loaded = deck.load(file)
    assert deck.loads(loaded.to_toml()).to_toml() == loaded.to_toml()


@pytest.mark.thorough
@pytest.mark.parametrize("file", STUDIES, ids=name_of)
def test_study_has_a_title_and_no_wrong_deck(file):
    if study_parts.is_of_parts(file):
        plans = [each.plan for each in study_parts.plans(file, (), AS_IT_IS, quiet=True)]
    else:
        plans = [cases.plan(file, quiet=True)]
    assert all(plan.title for plan in plans)
    assert [case.message for plan in plans for case in plan.cases if case.message] == []


@pytest.mark.parametrize("folder", sorted({file.parent for file in FILES}), ids=lambda folder: folder.name)
def test_every_study_has_a_readme(folder):
    text = (folder / "README.md").read_text(encoding="utf-8")
    assert [file.name for file in FILES if file.parent == folder and file.stem not in text] == []


@pytest.mark.parametrize("shot", experiments(), ids=lambda shot: shot.number)
def test_every_shot_of_the_study_has_its_deck(shot):
    noses = {"hemispherical": "hemi", "ogival": "ogive"}
    name = f"{noses[shot.nose]}_{shot.target[2:]}_{shot.velocity:.0f}"
    loaded = deck.load(PROBLEMS / "cth_nose_shape" / f"{name}.toml")
    rod, plate = loaded.body
    assert (rod.velocity[1], rod.material, plate.material) == (shot.velocity, shot.rod, shot.target)
    assert (rod.length, rod.rod_radius) == pytest.approx((shot.length, 0.5 * shot.diameter), rel=1e-9)
    assert (loaded.experiment.penetration, loaded.experiment.qualifier) == (pytest.approx(shot.depth), shot.depth_is)
    assert f"shot {shot.number} " in loaded.experiment.source
