"""[sample] of a study file: points from distributions and from tables, and refusals before the first run."""

import json
import tomllib
from collections import Counter

import numpy as np
import pytest
from scipy import stats

from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.materials.library import load
from hydro2d.study.plan import cases, members, relating, sampling
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import Distribution
from hydro2d.study.plan.sample_section import Sample
from hydro2d.study.plan.sampling import Points
from hydro2d.study.plan.scaling import Size
from tests.study import fake, tubes

BASE = f'deck = "{(tubes.ROOT / fake.BASE).as_posix()}"\n'
INPUTS = """
[sample.input."body.rod.velocity"]
normal = ["1086 m/s", "3 m/s"]
[sample.input.body.rod.strength_factor]
lognormal = [1.0, 1.05]
[sample.input."body.rod.material"]
choice = ["W_alloy", "Al5083"]
"""
SOBOL = BASE + '[sample]\nmethod = "sobol"\nn = 4\n' + INPUTS
AXIS = '[[axis]]\nname = "advection"\nkey = "numerics.advection"\nvalues = ["ke", "both"]\n'


def plan(folder, text, table=None):
    """The plan of a study file with its table of points."""
    if table is not None:
        (folder / "x.csv").write_text(table)
    file = folder / "study.toml"
    file.write_text(text)
    return cases.plan(file, quiet=True)


def of_table(folder, table, more=""):
    return plan(folder, f'{BASE}[sample]\ntable = "x.csv"\n{more}', table)


def refused(folder, text, table=None):
    with pytest.raises(StudyError) as problem:
        plan(folder, text, table)
    return str(problem.value).replace(f"{folder}/", "").splitlines()


def test_points_are_cases_with_their_keys(tmp_path):
    made = plan(tmp_path, SOBOL)
    assert [case.name for case in made.cases] == ["row1", "row2", "row3", "row4"]
    assert [case.values for case in made.cases] == [{"row": "1"}, {"row": "2"}, {"row": "3"}, {"row": "4"}]
    velocity, factor, material = made.cases[0].overrides
    assert velocity == f'body.rod.velocity="{made.sample.rows[0][0]!r} m/s"'
    assert factor == f"body.rod.strength_factor={made.sample.rows[0][1]!r}"
    assert material == f'body.rod.material="{made.sample.rows[0][2]}"'
    assert {row[2] for row in made.sample.rows} == {"W_alloy", "Al5083"}
    assert plan(tmp_path, SOBOL).cases == made.cases, "the same seed makes the same points"
    assert plan(tmp_path, SOBOL.replace("n = 4", "n = 4\nseed = 1")).sample.rows != made.sample.rows


def test_more_points_of_sobol_keep_the_earlier_ones(tmp_path):
    few, many = plan(tmp_path, SOBOL), plan(tmp_path, SOBOL.replace("n = 4", "n = 6"))
    assert many.sample.rows[:4] == few.sample.rows
    assert not few.notes
    assert many.notes == ("sample.n = 6 is not a power of two, so that the points of Sobol's sequence do not fill the space "
                          "evenly; 4 or 8 would",)
    assert not plan(tmp_path, SOBOL.replace("n = 4", "n = 6").replace("sobol", "latin-hypercube")).notes


def test_inputs_relative_to_the_deck(tmp_path):
    text = BASE + """
[sample]
method = "latin-hypercube"
n = 3
[sample.input."body.rod.velocity"]
normal = ["0 km/s", "0.003 km/s"]
relative = "difference"
[sample.input."body.rod.diameter"]
uniform = [0.9, 1.1]
relative = "factor"
[[axis]]
name = "speed"
key = "body.rod.velocity"
values = ["1086 m/s", "1.2 km/s"]
"""
    lines = refused(tmp_path, text)
    assert "the axis \"speed\" sets body.rod.velocity as well" in lines[0]
    base = (tubes.ROOT / fake.BASE).as_posix()
    (tmp_path / "fast.toml").write_text(f'include = "{base}"\n[[body]]\nname = "rod"\nvelocity = "1200 m/s"\n')
    shots = f'[axis.variants]\nslow.deck = "{base}"\nfast.deck = "fast.toml"\n'
    made = plan(tmp_path, text[: text.index("key =")] + shots)
    velocity, diameter = made.sample.inputs
    assert (velocity.head, diameter.head) == ("body.rod.velocity (difference) [km/s]", "body.rod.diameter (factor)")
    assert velocity.words.endswith("standard deviation 0.003 km/s, added to the value of the deck")
    assert [case.name for case in made.cases] == ["slow_row1", "slow_row2", "slow_row3", "fast_row1", "fast_row2", "fast_row3"]
    for case, base, row in zip(made.cases, [1.086] * 3 + [1.2] * 3, made.sample.rows * 2, strict=True):
        given = tomllib.loads(case.text)["body"][0]
        assert given["velocity"][1] == pytest.approx(1e3 * (base + row[0]), rel=1e-11)
        assert given["diameter"] == pytest.approx(0.67568e-2 * row[1], rel=1e-11)
    assert Points.of_data(json.loads(json.dumps(made.sample.data()))).inputs == made.sample.inputs


@pytest.mark.parametrize(("key", "said"), [
    ("body.rod.strength_factor", "the deck gives no value of body.rod.strength_factor, to which"),
    ("body.rod.material", '"W_alloy" is not a number with its unit'),
    ("mesh.r", "mesh.r of the deck is ["),
])
def test_a_deck_without_a_value_to_relate_to_is_refused(tmp_path, key, said):
    text = f'{BASE}[sample]\nmethod = "sobol"\nn = 2\n[sample.input."{key}"]\nuniform = [0.9, 1.1]\nrelative = "factor"\n'
    lines = refused(tmp_path, text)
    assert lines[0].startswith("study.toml:"), lines
    assert said in lines[0], lines


def test_inputs_relative_to_the_material_on_which_one_of_the_deck_is_based(tmp_path):
    """Its constants and its fracture pressure, which the deck does not write down, and one that it does."""
    keys = {"eos.sound_speed": ("[0.98, 1.02]", "factor"), "strength.shear_modulus": ('["0 GPa", "1 GPa"]', "difference"),
            "fracture_pressure": ("[1, 2]", "factor"), "eos.hugoniot_slope": ("[0.9, 1.1]", "factor")}
    inputs = "".join(f'[sample.input."materials.mine.{key}"]\nuniform = {numbers}\nrelative = "{relative}"\n'
                     for key, (numbers, relative) in keys.items())
    own = '[set]\n"materials.mine" = { based_on = "W_alloy", eos.hugoniot_slope = 1.5 }\n"body.rod.material" = "mine"\n'
    made = plan(tmp_path, f'{BASE}{own}[sample]\nmethod = "sobol"\nn = 2\n{inputs}')
    library = load("W_alloy")
    for case, row in zip(made.cases, made.sample.rows, strict=True):
        mine = tomllib.loads(case.text)["materials"]["mine"]
        assert mine["eos"]["sound_speed"] == pytest.approx(library.number("eos", "sound_speed").value * row[0], rel=1e-11)
        assert mine["strength"]["shear_modulus"] == pytest.approx(
            library.number("strength", "shear_modulus").value + 1e9 * row[1], rel=1e-11)
        assert mine["fracture_pressure"] == pytest.approx(library.number("fracture_pressure").value * row[2], rel=1e-11)
        assert mine["eos"]["hugoniot_slope"] == pytest.approx(1.5 * row[3], rel=1e-11)
    for key in ("mine.strength.A", "mine.melting", "mine.eos", "other.eos.sound_speed", "mine.eos.sound_speed.x", "mine"):
        text = f'[sample]\nmethod = "sobol"\nn = 2\n[sample.input."materials.{key}"]\nuniform = [1, 2]\nrelative = "factor"\n'
        assert refused(tmp_path, BASE + own + text)[0].startswith("study.toml:")


def test_units_that_do_not_begin_at_zero_relate_to_nothing(tmp_path):
    warm = f'include = "{(tubes.ROOT / fake.BASE).as_posix()}"\n[[body]]\nname = "rod"\ntemperature = "20 degC"\n'
    (tmp_path / "warm.toml").write_text(warm)
    for numbers in ('uniform = ["1 degC", "2 degC"]\nrelative = "difference"', 'uniform = [0.9, 1.1]\nrelative = "factor"'):
        text = f'deck = "warm.toml"\n[sample]\nmethod = "sobol"\nn = 2\n[sample.input."body.rod.temperature"]\n{numbers}\n'
        assert "degC does not begin at zero" in refused(tmp_path, text)[0]
    kelvin = Distribution("k", "uniform", "K", (-1.0, 1.0), relative="difference")
    assert relating.value({"k": "20 degC"}, kelvin, "-0.5 K") == "292.65 K"
    assert relating.value({"k": "1086m/s"}, Distribution("k", "uniform", relative="factor"), 1.5) == "1629.0 m/s"


def test_rows_with_changes_that_should_not_matter(tmp_path):
    made = plan(tmp_path, SOBOL.replace("n = 4", 'n = 4\nby = ["mesh offset"]') + AXIS)
    starts = [tomllib.loads(case.text)["mesh"]["z_start"] for case in made.cases]
    assert len(set(starts)) == 4
    assert starts[:4] == starts[4:], "every row has its own, whatever the case"
    still = tomllib.loads(plan(tmp_path, SOBOL).cases[0].text)["mesh"]["z_start"]
    assert all(0.0 < abs(start - still) < 0.7e-3 for start in starts)
    again = plan(tmp_path, SOBOL.replace("n = 4", 'n = 8\nby = ["mesh offset"]') + AXIS)
    assert [case.text for case in again.cases[:4]] == [case.text for case in made.cases[:4]], "more rows keep the earlier ones"
    with pytest.raises(StudyError, match=r"members: sample\.by makes changes already"):
        cases.plan(tmp_path / "study.toml", quiet=True, size=Size(2))


def test_changes_do_not_go_along_with_the_inputs():
    sample = Sample.model_validate({"method": "sobol", "n": 64, "by": ["mesh offset", "first step"], "input": {
        "a": {"uniform": [0, 1]}, "b": {"uniform": [0, 1]}, "c": {"uniform": [0, 1]}}})
    rows = sampling.points(sample, [Distribution.of_input(key, each) for key, each in sample.input.items()], None).rows
    changes = [list(members.amounts_of_row(sample, row).values()) for row in range(1, 65)]
    between = np.corrcoef(np.array(rows).T, np.array(changes).T)[:3, 3:]
    assert np.abs(between).max() < 0.3, "2.4 standard deviations of independent numbers"
    assert np.ptp(changes, axis=0) == pytest.approx([1.0, 0.004], rel=0.1), "from one end to the other"


def test_every_case_of_the_axes_has_the_same_points(tmp_path):
    made = plan(tmp_path, SOBOL + AXIS + "[ensemble]\nrepeats = 2\n")
    assert len(made.cases) == 2 * 4 * 2
    assert [case.name for case in made.cases][:3] == ["ke_row1", "ke_row1_m1", "ke_row2"]
    by_axis = {label: [case.overrides[1:4] for case in made.cases if case.values["advection"] == label and not case.member]
               for label in ("ke", "both")}
    assert by_axis["ke"] == by_axis["both"]


@pytest.mark.parametrize(("table", "law"), [
    ({"normal": ("3 m/s", "2 m/s")}, stats.norm(3.0, 2.0)),
    ({"normal": ("3 m/s", "0.2 cm/ms"), "within": ("2 m/s", "400 cm/s")}, stats.truncnorm(-0.5, 0.5, 3.0, 2.0)),
    ({"lognormal": ("2 GPa", 1.1)}, stats.lognorm(np.log(1.1), scale=2.0)),
    ({"uniform": (1, 3)}, stats.uniform(1.0, 2.0)),
])
def test_quantiles_and_probabilities(table, law):
    from hydro2d.study.plan.sample_section import Input

    each, points = Distribution.of_input("key", Input.model_validate(table)), np.linspace(0.01, 0.99, 50)
    assert each.quantiles(points) == pytest.approx(law.ppf(points), rel=1e-9)
    assert each.points(each.quantiles(points)) == pytest.approx(points, rel=1e-9)
    assert Distribution.of_data(each.data()) == each
    ends = each.quantiles(np.array([0.0, 1.0]))
    assert np.isfinite(ends).all()
    assert each.within is None or tuple(ends) == pytest.approx(each.within)


def test_choices_have_their_weights():
    from hydro2d.study.plan.sample_section import Input

    each = Distribution.of_input("key", Input(choice=("a", "b"), weights=(1.0, 3.0)))
    values = each.values(np.linspace(0.0005, 0.9995, 1000))
    assert (values.count("a"), values.count("b")) == (250, 750)
    assert each.level_of(each.points(["a", "b"])).tolist() == [0, 1]


JOINT = """
[[sample.joint]]
keys = ["materials.plate.eos.sound_speed", "materials.plate.eos.hugoniot_slope"]
mean = ["5.33 km/s", 1.34]
covariance = [[4e-4, -9e-4], [-9e-4, 2.5e-3]]
"""
#: a rod whose density, and a plate whose law and shock fit, are inputs
SHOT = BASE + """
[set]
materials.rod.based_on = "W_alloy"
materials.plate.based_on = "Al5083"
body.rod.material = "rod"
body.plate.material = "plate"
[sample]
method = "METHOD"
n = 256
[sample.input."materials.rod.eos.reference_density"]
normal = [1, 0.002]
relative = "factor"
[sample.input."body.plate.strength_factor"]
uniform = [0.87, 1.3]
[sample.input."materials.plate.strength"]
choice = [
    {model = "power-law", yield_stress = "276 MPa", youngs_modulus = "70 GPa", poisson_ratio = 0.3, hardening_exponent = 0.084},
    {model = "elastic-plastic", yield_stress = "340 MPa", shear_modulus = "26 GPa"},
]
weights = [3, 1]
""" + JOINT


@pytest.mark.parametrize("method", ["sobol", "latin-hypercube"])
def test_joint_inputs_go_along_with_each_other(tmp_path, method):
    made = plan(tmp_path, SHOT.replace("METHOD", method))
    speed, slope = np.array([row[-2:] for row in made.sample.rows], dtype=float).T
    assert (speed.mean(), slope.mean()) == pytest.approx((5.33, 1.34), rel=1e-3)
    assert np.cov(speed, slope) == pytest.approx(np.array([[4e-4, -9e-4], [-9e-4, 2.5e-3]]), rel=0.03)
    assert abs(np.corrcoef(speed, [row[0] for row in made.sample.rows])[0, 1]) < 0.05
    strata = [len(set(np.floor(256 * each.points(column)))) for each, column in
              zip(made.sample.inputs[-2:], (speed, slope), strict=True)]
    assert strata == [256, 256] if method == "latin-hypercube" else strata[0] == 256


def test_laws_as_tables_and_constants_of_materials_are_inputs(tmp_path):
    made = plan(tmp_path, SHOT.replace("METHOD", "sobol"))
    laws = Counter(row[2].split('"')[1] for row in made.sample.rows)
    assert laws == {"power-law": 192, "elastic-plastic": 64}
    for row, case in zip(made.sample.rows[:4], made.cases, strict=False):
        deck = decks.loads(case.text)
        assert deck.materials["rod"].reference_density == pytest.approx(load("W_alloy").reference_density * row[0], rel=1e-9)
        assert deck.materials["plate"].strength.name == row[2].split('"')[1]
        assert deck.materials["plate"].number("eos", "sound_speed").value == pytest.approx(1e3 * row[3], rel=1e-9)
        assert deck.body_named("plate").strength_factor == pytest.approx(row[1], rel=1e-9)


def test_joint_inputs_come_back_from_the_file_of_a_study(tmp_path):
    made = plan(tmp_path, SHOT.replace("METHOD", "sobol").replace("n = 256", "n = 4")).sample
    data = json.loads(json.dumps(made.data()))
    again = Points.of_data(data)
    assert (again.inputs, again.rows) == (made.inputs, made.rows)
    assert made.inputs[-1].words == ("normal, mean 1.34, standard deviation 0.05, correlation -0.9 with "
                                     "materials.plate.eos.sound_speed")
    data["inputs"][-1]["correlation"] = [2.0, 1.0]
    data["inputs"][-2]["correlation"] = [1.0, 2.0]
    with pytest.raises(ValueError, match="positive definite"):
        Points.of_data(data)


@pytest.mark.parametrize(("change", "said"), [
    (("-9e-4], [-9e-4", "-9e-4], [9e-4"), "is not symmetric: row 1 has -0.0009 in column 2, row 2 has 0.0009 in column 1"),
    (("-9e-4], [-9e-4", "-2e-3], [-2e-3"), "covariance: is not positive definite: the smallest eigenvalue of its matrix of "
     "correlations is -1"),
    (("[[4e-4", "[[0"), "the variance of materials.plate.eos.sound_speed, in row and column 1, must be positive"),
    (("[-9e-4, 2.5e-3]]", "[-9e-4]]"), "covariance: needs 2 rows of 2 numbers, one for each key"),
    (("[[4e-4, -9e-4], ", "["), "covariance: needs 2 rows of 2 numbers, one for each key"),
    (("1.34]", "1.34, 2]"), "mean: has 3 values, and keys 2"),
    (("1.34]", '"inf km/s"]'), "a number is not finite"),
    (("[[4e-4", "[[inf"), "should be a finite number, is inf"),
    (("hugoniot_slope", "sound_speed"), "keys: has materials.plate.eos.sound_speed twice"),
    (("hugoniot_slope", "hugoniot_slop"), 'did you mean "hugoniot_slope"'),
    (('"5.33 km/s"', '"5.33 kg"'), "sample.joint: materials.plate.eos.sound_speed: row 1 has "),
    (("\n[[sample.joint]]",
      '\n[sample.input."materials.plate.eos.sound_speed"]\nuniform = ["5 km/s", "6 km/s"]\n[[sample.joint]]'),
     "sample: materials.plate.eos.sound_speed: the sample (materials.plate.eos.sound_speed) sets"),
])
def test_a_wrong_joint_distribution_is_refused(tmp_path, change, said):
    assert change[0] in SHOT
    lines = refused(tmp_path, SHOT.replace("METHOD", "sobol").replace("n = 256", "n = 2").replace(*change))
    assert any(said in line and line.startswith("study.toml:") for line in lines), lines


def test_a_table(tmp_path):
    made = of_table(tmp_path, "\ufeffbody.rod.velocity [km/s], body.rod.strength_factor ,body.rod.material\n"
                    "1.086,1,W_alloy\n1.1,0.95,Al5083\n\n", AXIS)
    assert [case.name for case in made.cases] == ["ke_row1", "ke_row2", "both_row1", "both_row2"]
    assert made.cases[1].overrides == ['numerics.advection="ke"', 'body.rod.velocity="1.1 km/s"',
                                       "body.rod.strength_factor=0.95", 'body.rod.material="Al5083"']
    assert made.sample.rows == ((1.086, 1.0, "W_alloy"), (1.1, 0.95, "Al5083"))
    assert [each.head for each in made.sample.inputs] == ["body.rod.velocity [km/s]", "body.rod.strength_factor",
                                                          "body.rod.material"]
    assert made.sample.inputs[0].points([1.086, 1.1]) == pytest.approx([0.25, 0.75])


@pytest.mark.parametrize(("table", "said"), [
    ("body.rod.velocity [m/s]\n1086\n-x\n", 'x.csv: row 2, column "body.rod.velocity [m/s]": "-x" is not a number; the unit of '
     "the column is m/s"),
    ("body.rod.velocity [m/s]\n1086\n1090 m/s\n", 'x.csv: row 2, column "body.rod.velocity [m/s]": "1090 m/s" is not a number; '
     "the unit of the column is m/s"),
    ("body.rod.velocity\n1086 m/s\n", 'x.csv: row 1, column "body.rod.velocity": "1086 m/s" has a unit; the head has the unit '
     "of a column, in brackets, such as [m/s]"),
    ("body.rod.velocity [furlongs/x]\n1\n", 'x.csv: column "body.rod.velocity [furlongs/x]": "furlongs/x" is not a unit'),
    ("body.rod.velocity []\n1\n", 'x.csv: column "body.rod.velocity []": the unit is missing between the brackets'),
    ("body.rod.velocity [m/s],,x\n1,2,3\n", "x.csv: the head of column 2 is empty"),
    ("body.rod.velocity [m/s],body.rod.velocity [km/s]\n1,2\n", 'x.csv: column 2, "body.rod.velocity [km/s]": there is already '
     "a column for body.rod.velocity"),
    ("body.rod.velocity [m/s],body.rod.material\n1086\n", "x.csv: row 1 has 1 cells, and the head 2"),
    ("body.rod.velocity [m/s],body.rod.material\n1086,\n", 'x.csv: row 1, column "body.rod.material": is empty'),
    ("body.rod.velocity [m/s]\n", "x.csv: needs a line of heads and at least one row"),
    ("body.rod.velocity [m/s];body.rod.strength_factor\n1086;1\n", "x.csv: the cells are separated by semicolons; write"),
    ("body.rod.velocity [m/s]\tbody.rod.material\n1086\tW_alloy\n", "x.csv: the cells are separated by tabs"),
    ("body.rod.velocity.x.y\n1\n", 'x.csv: column "body.rod.velocity.x.y": no deck has the key body.rod.velocity.x.y: '
     "body[0].velocity is a value and has no key x"),
    ('body.rod.velocity [m/s]\n"1\n', "x.csv:2: is not a table with commas: unexpected end of data"),
    ("body.rod.velcity [m/s]\n1086\n", 'x.csv: column "body.rod.velcity [m/s]": no deck has the key body.rod.velcity: body[0]: '
     'unknown key "velcity"; did you mean "velocity"?'),
    ("body.rod.velocity [kg]\n1086\n", 'x.csv: row 1, column "body.rod.velocity [kg]": body[0].velocity: "1086 kg" is a mass; '
     "expected a velocity"),
    ("body.rod.velocity [m/s],body.rod.strength_factor\n1086,1\n1090,-1\n", 'x.csv: row 2, column "body.rod.strength_factor": '
     "body[0].strength_factor: must be positive, is -1"),
    ("body.rod.strength_factor\n<<<<<<< HEAD\n1\n=======\n1.1\n>>>>>>> a\n", "x.csv:2: has a mark of git between two versions"),
    ("body.rod.strength_factor\nnan\n", 'x.csv: row 1, column "body.rod.strength_factor": '),
    ("body.rod.velocity [m/s]\nnan\n", 'x.csv: row 1, column "body.rod.velocity [m/s]": "nan" is not a number; '),
    ('body.rod.velocity [m/s]\n"1,086"\n', 'x.csv: row 1, column "body.rod.velocity [m/s]": "1,086" is not a number; '),
    ("body.rod.velocity\n1086\n", 'x.csv: row 1, column "body.rod.velocity": body[0].velocity: 1086 has no unit'),
])
def test_a_wrong_table_is_refused_before_the_first_run(tmp_path, table, said):
    lines = refused(tmp_path, f'{BASE}[sample]\ntable = "x.csv"\n', table)
    assert lines[0].startswith(said), lines


def test_a_mistake_of_many_rows_is_said_once(tmp_path):
    table = "body.rod.velocity [kg],body.rod.material\n" + "".join(f"{row},W_aloy\n" for row in range(40))
    lines = refused(tmp_path, f'{BASE}[sample]\ntable = "x.csv"\n', table)
    assert [line.endswith("; 39 more rows are wrong in the same way") for line in lines] == [True, True], lines
    one_more = refused(tmp_path, f'{BASE}[sample]\ntable = "x.csv"\n', "body.rod.strength_factor\n-1\n1\n-2.5e-3\n")
    assert [line.endswith("is -1; 1 more row is wrong in the same way") for line in one_more] == [True], one_more


def test_a_missing_table(tmp_path):
    assert "y.csv: cannot be read: No such file" in refused(tmp_path, f'{BASE}[sample]\ntable = "y.csv"\n')[0]


@pytest.mark.parametrize(("change", "said"), [
    (('"3 m/s"', '"3 kg"'), 'study.toml:6: sample.input.body.rod.velocity: "3 kg" is a mass'),
    (('"3 m/s"', '"0 m/s"'), "study.toml:6: sample.input.body.rod.velocity: normal: the standard deviation must be positive"),
    (('"3 m/s"', "3"), "3 has no unit, and the first number has m/s"),
    (("\nnormal =", "\nnorml ="), 'sample.input.body.rod.velocity.norml: unknown key "norml"; did you mean "normal"'),
    (('"1086 m/s", "3 m/s"]', '"1086 m/s", "3 m/s"]\nwithin = ["2 km/s", "3 km/s"]'),
     "study.toml:6: sample.input.\"body.rod.velocity\": within: only 0 of the distribution lies between the bounds"),
    (("1.05]", "1.0]"), "lognormal: the median must be positive, and the factor greater than 1"),
    (('choice = ["W_alloy", "Al5083"]', 'choice = ["W_alloy", "W_alloy"]'), "has a value twice"),
    (('["W_alloy", "Al5083"]', '["W_alloy", "Al5083"]\nweights = [1]'), "weights has 1 numbers, choice 2 values"),
    (("rod.velocity", "rod.velcity"), "study.toml:6: no deck has the key body.rod.velcity"),
    (('["1086 m/s", "3 m/s"]', '["1086 kg", "3 kg"]'), 'study.toml:6: sample.input."body.rod.velocity": row 1 has 1085.31698 '
     'kg: body[0].velocity: "1085.31698 kg" is a mass'),
    (("n = 4", ""), "needs n, and a table of its distribution for each input"),
    (("n = 4", "n = 4\ntable = \"x.csv\""), "give either table or method"),
    (('"sobol"', '"sobl"'), 'sample.method: unknown value "sobl"; did you mean "sobol"?'),
    (("[sample]", '[transition]\nfrom = "1 km/s"\nto = "2 km/s"\n[sample]'), "a search takes no [sample]"),
    (("[sample]", '[ensemble]\nrepeats = 2\n[[axis]]\nname = "v"\nkey = "body.rod.velocity"\nvalues = ["1 km/s"]\n[sample]'),
     'sample: body.rod.velocity: the axis "v" sets body.rod.velocity as well'),
    (('"body.rod.material"]\nchoice = ["W_alloy", "Al5083"]',
      '"mesh.z_start"]\nuniform = ["-1 cm", "-2 mm"]\n[ensemble]\nrepeats = 2'),
     'sample: mesh.z_start: the ensemble changes mesh.z_start by "mesh offset"'),
    (("1.05]", '1.05]\nrelative = "difference"'), "sample.input: "),
    (('"3 m/s"]', '"3 m/s"]\nrelative = "factor"'), '"factor": a factor is a plain number, and the numbers are in m/s'),
    (('"3 m/s"]', '"3 m/s"]\nrelative = "ratio"'), 'relative: unknown value "ratio"'),
    (('"Al5083"]', '"Al5083"]\nrelative = "factor"'), "relative belongs to numbers, not to choice"),
    (("n = 4", 'n = 4\nby = ["mesh offset", "mesh offset"]'), "sample.by: names a change twice"),
    (("n = 4", "n = 4\nby = []"), "sample.by: is empty"),
    (("n = 4", 'n = 4\nresults = ["regime"]'), "sample.results: regime is a word, and samples.csv has it anyway"),
    (("n = 4", 'n = 4\nby = ["mesh ofset"]'), 'did you mean "mesh offset"'),
    (("[sample]", '[ensemble]\nrepeats = 2\n[sample]\nby = ["first step"]'), "sample.by: [ensemble] makes changes already"),
    (("[sample]", '[[axis]]\nname = "row"\nkey = "numerics.courant"\nvalues = [0.4]\n[sample]'), '"row" is the name of the'),
])
def test_a_wrong_section_is_refused(tmp_path, change, said):
    assert change[0] in SOBOL
    lines = refused(tmp_path, SOBOL.replace(*change))
    assert any(said in line for line in lines), lines


def test_the_check_says_how_many_runs(tmp_path, capsys):
    plan(tmp_path, SOBOL.replace("n = 4", "n = 3"))
    assert call(["sweep", str(tmp_path / "study.toml"), "--check"]) == 0
    said = capsys.readouterr().out
    assert "3 cases, about" in said
    assert "not a power of two" in said


def test_heads_with_indices():
    assert sampling._head("mesh.r[0]") == ("mesh.r[0]", "")
    assert sampling._head("mesh.r[0].size [mm]") == ("mesh.r[0].size", "mm")
    assert sampling._head("body.rod.velocity[m/s]") == ("body.rod.velocity", "m/s")
