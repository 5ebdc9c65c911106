"""The table of experience is that of the kept results, and the page shows it."""

import tomllib
from dataclasses import replace

import pytest

import hydro2d
from hydro2d.analytic import experience as shipped
from problems import kept
from problems.validation import against_experiments as against
from problems.validation import experience
from problems.validation.experience import Shot

RODS = hydro2d.Impact("tungsten rod", "aluminium")
#: models that take less than a second for all shots
QUICK = ("tate", "chen-li")


@pytest.fixture(scope="module")
def runs():
    return experience.rows(experience.of_runs())


def lines(found):
    """Lines of the file of the table."""
    return experience.text(found).splitlines()[1:]


def of(name):
    """Lines of the kept file that are the experience of runs or of a model."""
    return [line for line in experience.FILE.read_text(encoding="utf-8").splitlines() if line.startswith(f"{name},")]


def test_the_kept_table_is_that_of_the_kept_results(runs):
    assert lines(runs) == of("hydro2d"), "python -m problems.validation.experience writes it"


@pytest.mark.parametrize("name", QUICK)
def test_the_kept_table_is_that_of_the_models(name):
    assert lines(experience.rows(experience.of_models([name]))) == of(name)


@pytest.mark.slow
def test_the_kept_table_is_that_of_all_models_and_the_page_shows_it(capsys):
    assert experience.main(["--check"]) == 0


def test_the_page_shows_the_table(runs):
    models = [row for row in shipped.table() if row.of != "hydro2d"]
    text = experience.PAGE.read_text(encoding="utf-8")
    assert kept.filled(text, experience.tables(runs, models)) == text, "python -m problems.validation.experience fills it"


def test_what_the_command_writes_is_what_hydro2d_reads(runs):
    assert [row for row in shipped.table() if row.of == "hydro2d"] == runs


def shot(*ratios, **changes):
    return replace(Shot("tungsten into aluminium", "depth", RODS, "rigid", ratios, velocity=1000.0, cells=(8.5,)), **changes)


def test_members_of_a_shot_count_once():
    """Its median counts, and the spread of members within shots is the numerical uncertainty."""
    (row,) = experience.rows([shot(0.9, 1.0, 1.5, cells=(5.5, 8.5, 12.5)), shot(1.21, velocity=1200.0)])
    assert (row.shots, row.bias) == (2, pytest.approx(1.1))
    assert row.numerical == pytest.approx(experience._numerical([(0.9, 1.0, 1.5)]), rel=1e-3)
    assert (row.slowest, row.fastest, row.coarsest, row.finest) == (1000.0, 1200.0, 5.5, 12.5)
    assert experience._numerical([(1.0, 1.21), (5.0,)]) == pytest.approx(0.13479, rel=1e-4)  # ln 1.21 over the root of 2
    assert experience._numerical([(1.0,), (5.0,)]) is None


def test_a_row_has_the_thicknesses_and_materials_of_its_shots():
    def into(plate, thickness):
        return hydro2d.Impact("tungsten rod", "aluminium", "W_alloy", plate, thickness)

    (row,) = experience.rows([shot(1.0, impact=into(("Al7039",), 2.66666)), shot(1.1, impact=into(("Al5083", "Al7039"), 4.0)),
                              shot(1.2, impact=into(("Al5083",), None)), shot(ratios=(), impact=into(("lead",), 9.0))])
    assert (row.thinnest, row.thickest) == (2.667, 4.0)
    assert (row.projectile_materials, row.target_materials) == ("W_alloy", "Al5083; Al7039")


def test_the_materials_of_studies_are_those_of_their_files():
    """The table of materials has those of the axes of the studies."""
    for file, axis, body in (("cth_nose_shape/twelve_shots", "law", "rod_alloy"), ("long_rods/hardness", "steel", "steel"),
                             ("validation/rigid_steel_rods", "rod", "rod_steel"),
                             ("validation/steel_rods_fitted", "rod", "rod_steel")):
        known = experience.ARMOUR if body == "steel" else experience.RODS
        with open(experience.PROBLEMS / f"{file}.toml", "rb") as text:
            (axis,) = (each for each in tomllib.load(text)["axis"] if each["name"] == axis)
        own = {label: keys[f"materials.{body}"]["based_on"] for label, keys in axis["variants"].items()
               if f"materials.{body}" in keys and label in known}
        assert own, file
        assert own == {label: known[label] for label in own}


def test_kept_rows_have_the_thickness_of_each_shot(runs):
    """The target of a shield is its wall, and a hole is of its own sheet."""
    found = {(row.quantity, row.impact, row.chosen): (row.thinnest, row.thickest) for row in runs}
    balls = hydro2d.Impact("steel sphere", "steel")
    assert found["hole diameter", balls, False] == (pytest.approx(1.524 / 1.778, rel=1e-3), 1.125)
    shields = hydro2d.Impact("aluminium sphere", "2 bodies of aluminium")
    thick = [float(each["wall_mm"]) for each in experience.whipple.shots() if each["half"] == "B"]
    assert found["perforation", shields, False] == (pytest.approx(min(thick) / 3.18, rel=1e-3),
                                                    pytest.approx(max(thick) / 3.18, rel=1e-3))


def test_perforations_have_no_ratio_and_are_counted():
    (row,) = experience.rows([shot(1.1), shot(missed=True), shot(ratios=())])
    assert (row.shots, row.missed, row.bias) == (1, 1, pytest.approx(1.1))
    (only,) = experience.rows([shot(missed=True)])
    assert (only.shots, only.missed, only.bias) == (0, 1, None)
    assert experience.rows([shot()]) == []


def test_outcomes_are_counted():
    (row,) = experience.rows([shot(quantity="perforation", right=right) for right in (True, False, True)])
    assert (row.shots, row.right, row.bias) == (3, 2, None)


def test_shots_for_which_something_was_chosen_are_apart(runs):
    first, second = experience.rows([shot(1.0), shot(1.2, set="steel rods, 1.6 GPa")])
    assert (first.chosen, second.chosen, second.sets) == (False, True, "steel rods, 1.6 GPa")
    predicted = {each.name for each in against.SETS if each.predicted}
    for row in runs:
        assert row.chosen != bool({*row.sets.split("; ")} & {*predicted, experience.SHIELDS, experience.HARDNESS})


def test_every_set_of_the_comparison_is_in_the_table(runs):
    assert {each.name for each in against.SETS if each.studied} <= {name for row in runs for name in row.sets.split("; ")}


def test_the_laws_are_the_sets_of_the_comparison():
    assert [each.name for each in against.SETS][: len(against.LAWS)] == list(against.LAWS.values())


def test_points_of_a_fit_have_no_interval_and_their_error_is_taken_out():
    ratios = (0.8, 1.0, 1.3)
    (row,) = experience.rows([shot(ratio, fit=True, set=experience.HARDNESS) for ratio in ratios])
    assert (row.low, row.high, row.measurement) == (None, None, 0.03)
    assert row.model**2 == pytest.approx(row.scatter**2 - 0.03**2, rel=1e-3)


def test_a_regime_is_that_of_most_runs():
    def runs_of(*regimes):
        return [experience.rigid_rod.Result({}, 0, 1.0, 0.0, None, regime, None, "") for regime in regimes]

    assert experience._ended(runs_of("rigid", "rigid", "eroding")) == "rigid"
    assert experience._ended(runs_of("rigid", "eroding")) == "eroding"
    assert experience._ended(runs_of("rigid or deforming")) == "deforming"


def test_a_model_that_needs_the_inputs_of_its_example_has_no_row():
    assert experience.of_models(["poncelet"]) == []


def test_a_check_writes_nothing(monkeypatch, tmp_path, capsys):
    page = tmp_path / "page.md"
    page.write_text("<!-- outcomes -->\nold\n<!-- end -->\n")
    file = tmp_path / "experience.csv"
    monkeypatch.setattr(experience, "PAGE", page)
    monkeypatch.setattr(experience, "FILE", file)
    monkeypatch.setattr(experience, "of_runs", lambda: [shot(quantity="perforation", right=True)])
    monkeypatch.setattr(experience, "of_models", lambda: [])
    assert experience.main(["--check"]) == 1
    assert not file.exists()
    assert "old" in page.read_text()
    assert experience.main([]) == 0
    assert "| tungsten into aluminium | 1 | 1 |" in page.read_text()
    assert experience.main(["--check"]) == 0
    file.write_text("other")
    assert experience.main(["--check"]) == 1
