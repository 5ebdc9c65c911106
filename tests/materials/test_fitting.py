"""Strength models fitted to measured flow stresses: files of points, the fit, the command, and the library's 4340 steel."""

import csv
import math

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.cli.main import call
from hydro2d.files import shipped
from hydro2d.materials import curves, fitting, library
from strength import STRENGTH_MODELS

STEEL = {"yield_stress": 1.1e9, "hardening": 0.5e9, "hardening_exponent": 0.3, "rate_coefficient": 0.012,
         "thermal_exponent": 0.8, "melt_temperature": 1793.0, "shear_modulus": 77.5e9}
IRON = {"athermal_stress": 65e6, "thermal_stress": 1033e6, "thermal_softening": 6.98e-3, "rate_hardening": 4.15e-4,
        "hardening": 266e6, "hardening_exponent": 0.289, "shear_modulus": 80e9, "melt_temperature": 1811.0}
ALLOY = {"yield_stress": 276e6, "hardening_exponent": 0.084, "youngs_modulus": 70.3e9, "poisson_ratio": 1 / 3}
TUNGSTEN = {"yield_stress": 1.87e9, "hardening_coefficient": 7.7, "hardening_exponent": 0.13,
            "temperature_coefficient": 1.52e-4, "shear_modulus": 145e9, "grueneisen": 1.67, "reference_density": 18160.0}
PLATE = {"yield_stress": 270e6, "saturation": 330e6, "hardening_rate": 3.8, "rate_coefficient": 0.018, "thermal_exponent": 1.36,
         "melt_temperature": 893.0, "shear_modulus": 26.36e9}
COPPER = {"theta": 0.034, "s0": 0.03, "s_inf": 0.008, "y0": 0.0066, "y_inf": 0.005, "kappa": 0.23, "y1": 0.094, "y2": 0.575,
          "beta": 0.25, "gamma": 1e-5, "molar_mass": 0.027, "melt_temperature": 893.0, "shear_modulus": 31e9,
          "modulus_softening": 0.46, "grueneisen": 1.97, "reference_density": 2660.0}
LAWS = {"johnson-cook": STEEL, "zerilli-armstrong": IRON, "power-law": ALLOY, "steinberg-guinan": TUNGSTEN, "voce": PLATE,
        "preston-tonks-wallace": COPPER}
HEATING = fitting.Heating(100.0, 7830.0 * 477.0)


def made(name, values, heating=None, group=0.0):
    """Points that follow a law exactly: three rates, four temperatures, five strains."""
    grid = np.array(np.meshgrid([0.0, 0.02, 0.05, 0.1, 0.2], [1e-3, 30.0, 2000.0], [298.0, 400.0, 550.0, 800.0])).reshape(3, -1)
    points = fitting.Points(*grid, np.ones(grid.shape[1]), np.full(grid.shape[1], group))
    stress = fitting.computed(fitting.law(name), values, points, heating)
    return fitting.Points(*grid, stress, points.group)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("heating", [None, HEATING])
def test_made_up_points_give_their_law_back(name, heating):
    law, values = fitting.law(name), LAWS[name]
    given = {key: value for key, value in values.items() if key not in law.free}
    fitted = fitting.fit(law, made(name, values, heating), given, heating=heating)
    assert fitted.largest < 1e-6
    assert fitted.constants[0.0] == pytest.approx(values, rel=1e-3)
    assert set(fitted.errors[0.0]) == set(law.free)


def test_a_search_turns_back_from_impossible_constants():
    """y0 above s0 is refused; one trial on the way to these points asks for it, and the fit still ends at its law."""
    values = COPPER | {"s0": 0.0075, "s_inf": 0.0065}
    law = fitting.law("preston-tonks-wallace")
    given = {key: value for key, value in values.items() if key not in law.free}
    fitted = fitting.fit(law, made("preston-tonks-wallace", values), given)
    assert fitted.constants[0.0] == pytest.approx(values, rel=1e-6)
    with pytest.raises(DeckError, match="s0 = 0.012 is above y1 = 0.01: must not be"):
        fitting.fit(law, made("preston-tonks-wallace", values), given | {"y1": 0.01})


def test_the_order_of_the_lines_does_not_matter():
    """A file is a set of points, not a set of curves: no line refers to the one before it."""
    points = made("voce", PLATE, HEATING)
    mixed = points.chosen(np.random.default_rng(3).permutation(len(points)))
    given = {key: PLATE[key] for key in ("melt_temperature", "shear_modulus")}
    one, other = (fitting.fit(fitting.law("voce"), each, given, heating=HEATING) for each in (points, mixed))
    assert one.constants[0.0] == pytest.approx(other.constants[0.0], rel=1e-6)


def test_errors_of_the_constants_are_those_of_the_scatter():
    """Yield stress alone: its relative standard error is the scatter over the root of the number of points."""
    points = made("johnson-cook", STEEL)
    noise = np.random.default_rng(1).normal(0.0, 0.02, len(points))
    points = fitting.Points(points.strain, points.rate, points.temperature, points.stress * (1.0 + noise), points.group)
    given = {key: value for key, value in STEEL.items() if key != "yield_stress"} | {"hardening": 0.0}
    fitted = fitting.fit(fitting.law("johnson-cook"), points, given)
    error = fitted.errors[0.0]["yield_stress"] / fitted.constants[0.0]["yield_stress"]
    assert error == pytest.approx(fitted.rms / math.sqrt(len(points)), rel=0.05)


def test_groups_share_the_chosen_constants():
    hard = STEEL | {"yield_stress": 1.5e9, "hardening": 0.9e9}
    soft, other = made("johnson-cook", STEEL, group=38.0), made("johnson-cook", hard, group=49.0)
    cold = other.chosen(other.temperature < 350.0)  # alone, these do not determine the thermal exponent
    both = fitting.Points(*(np.concatenate([getattr(soft, name), getattr(cold, name)])
                            for name in ("strain", "rate", "temperature", "stress", "group")))
    given = {key: STEEL[key] for key in ("melt_temperature", "shear_modulus")}
    law = fitting.law("johnson-cook")
    with pytest.raises(DeckError, match="the points do not determine thermal_exponent"):
        fitting.fit(law, cold, given)
    fitted = fitting.fit(law, both, given, shared=["thermal_exponent"])
    assert fitted.constants[38.0] == pytest.approx(STEEL, rel=1e-3)
    assert fitted.constants[49.0] == pytest.approx(hard, rel=1e-3)


def test_a_test_that_is_fast_heats_itself():
    """Against rho c dT = w Y d(ep): the softening at a strain of 0.2 is that of the temperature from `curves.along`."""
    points = made("johnson-cook", STEEL, HEATING)
    cool = made("johnson-cook", STEEL)
    slow, fast = points.rate < 100.0, (points.rate > 100.0) & (points.strain == 0.2) & (points.temperature == 298.0)
    assert points.stress[slow] == pytest.approx(cool.stress[slow], rel=1e-12)
    model, row = STRENGTH_MODELS["johnson-cook"], STRENGTH_MODELS["johnson-cook"].row(STEEL)
    work = 0.9 * 0.2 * float(cool.stress[(cool.rate > 100.0) & (cool.strain == 0.1) & (cool.temperature == 298.0)][0])
    hot = model.flow_stress(0.2, 2000.0, 298.0 + work / HEATING.capacity, 0.0, 1.0, row)
    assert float(points.stress[fast][0]) == pytest.approx(hot, rel=5e-3)
    assert float(points.stress[fast][0]) < 0.97 * float(cool.stress[fast][0])


@pytest.mark.parametrize(
    ("text", "columns", "fragment"),
    [
        ("0 1 298 1e9\n0.1 1 298\n", None, "points.txt:2: has 3 numbers, expected 4"),
        ("0 1 298 1e9\n0.1 1 298 x\n", None, "points.txt:2: could not convert string to float"),
        ("0 1 298 nan\n", None, "points.txt:1: has a number that is not finite"),
        ("# nothing\n", None, "points.txt: has no points"),
        ("0 1 298 1e9\n0.1 -1 298 1e9\n", None, "points.txt:2: rate = -1: must be positive"),
        ("-0.1 1 298 1e9\n", None, "points.txt:1: strain = -0.1: must not be negative"),
        ("strain rate temp stress\n0 1 298 1e9\n", None, 'unknown column "temp"'),
        ("strain rate stress\n0 1 1e9\n", None, "needs one column each of strain, rate, temperature, stress"),
    ],
)
def test_files_that_cannot_be_read(tmp_path, text, columns, fragment):
    path = tmp_path / "points.txt"
    path.write_text(text)
    with pytest.raises(DeckError) as caught:
        fitting.read_points(path, columns)
    assert fragment in str(caught.value)


def test_columns_and_units(tmp_path):
    path = tmp_path / "points.txt"
    path.write_text("group, stress, strain, temperature, rate # MPa\n38, 1100, 0, 298, 1\n49, 1500, 0.1, 373, 1000\n")
    points = fitting.read_points(path, unit=1e6)
    assert list(points.stress) == [1.1e9, 1.5e9]
    assert points.groups == [38.0, 49.0]
    assert list(points.rate) == [1.0, 1000.0]


@pytest.mark.parametrize(
    ("given", "shared", "fragment"),
    [
        ({"shear_modulus": 77.5e9}, [], "johnson-cook: a fit needs melt_temperature"),
        ({"melt_temperature": 1793.0}, [], "johnson-cook: a fit needs shear_modulus"),
        (STEEL, [], "no constant is left to fit"),
        ({"yield_strength": 1e9}, [], 'did you mean "yield_stress"?'),
        ({"melt_temperature": 1793.0, "shear_modulus": 77.5e9}, ["melt_temperature"], '"melt_temperature" is not fitted'),
    ],
)
def test_constants_that_do_not_fit_together(given, shared, fragment):
    with pytest.raises(DeckError) as caught:
        fitting.fit(fitting.law("johnson-cook"), made("johnson-cook", STEEL), given, shared)
    assert fragment in str(caught.value)


def test_a_model_without_a_fit():
    with pytest.raises(DeckError, match='unknown model that can be fitted "kinematic-hardening"'):
        fitting.law("kinematic-hardening")


def test_the_command(tmp_path, capsys):
    points = made("johnson-cook", STEEL)
    path, table, picture = tmp_path / "points.txt", tmp_path / "t.csv", tmp_path / "p.png"
    rows = zip(points.strain, points.rate, points.temperature, points.stress / 1e6, strict=True)
    path.write_text("".join(f"{a} {b} {c} 38 {d!r}\n" for a, b, c, d in ((*map(float, row),) for row in rows)))
    arguments = ["fit-strength", str(path), "--columns", "strain,rate,temperature,group,stress", "--stress-unit", "MPa",
                 "--model", "johnson-cook", "--material", "steel_4340", "--temperature", "290 K:600 K",
                 "--fix", "rate_coefficient=0.012"]
    assert call([*arguments, "--group", "38", "--csv", str(table), "--figure", str(picture)]) == 0
    out = capsys.readouterr().out
    assert "johnson-cook: 45 points, differences from the measured stress: rms 0.0%, largest 0.0%" in out
    assert 'strength = { model = "johnson-cook"' in out
    assert "rate_coefficient = 0.012" in out
    assert len(list(csv.DictReader(table.open()))) == 45
    assert picture.read_bytes()[:4] == b"\x89PNG"
    assert call([*arguments, "--group", "49"]) == 2
    assert "--group 49: the file has the groups 38" in capsys.readouterr().err
    assert call([*arguments, "--fix", "rate_coefficient"]) == 2
    given, others = arguments[:2] + arguments[4:10], {"--columns": arguments[3]}
    for option, bare, wanted in (("--fix", "yield_stress=0.8", "0.8 GPa"), ("--temperature", "290:600", "290 K"),
                                 ("--rate", "1:2", "1 /s"), ("--heated-from", "100", "100 /s")):
        capsys.readouterr()
        assert call([*given, *sum((others | {option: bare}).items(), ())]) == 2
        assert f'has no unit; write "{wanted}"' in capsys.readouterr().err


def test_many_points_fit_a_screen(capsys):
    """251 points: lists in bins, and a table by test and strain with the law of a material beside the fit."""
    arguments = ["fit-strength", str(shipped.problems_folder() / "materials" / "flow_stress_5083.txt"), "--stress-unit", "MPa",
                 "--model", "voce", "--material", "Al5083", "--fix", "shear_modulus=26.36 GPa",
                 "--fix", "melt_temperature=893 K", "--heated-from", "100 /s", "--temperature", "290 K:480 K"]
    assert call(arguments) == 0
    short = capsys.readouterr().out.splitlines()
    assert len(short) < 35
    assert "0.05 to 0.1               50            -2.2%  2.9%      6.6%" in short
    assert call([*arguments, "--beside", "Al5083"]) == 0
    table = capsys.readouterr().out.splitlines()[len(short):]
    assert len(table) < 35
    assert max(map(len, table)) <= 128
    at = table.index("7000 /s, 298 K")
    assert [line.split() for line in table[at + 1:at + 4]] == [
        ["measured", "[MPa]", "344", "420", "460", "491", "528", "558", "576"],
        ["voce", "+3.0%", "-2.5%", "-1.5%", "-0.7%", "-1.7%", "-3.1%", "-3.4%"],
        ["Al5083", "-3.9%", "-15.0%", "-19.4%", "-22.6%", "-26.5%", "-29.3%", "-30.6%"]]
    assert call([*arguments, "--rate", "100 /s"]) == 2
    assert 'expected LOW:HIGH, such as "100 /s:1e4 /s"' in capsys.readouterr().err
    assert call([*arguments, "--rate", "100 /s:1e4 /s"]) == 0
    assert "voce: 210 points" in capsys.readouterr().out
    assert call([*arguments, "--beside", "water"]) == 2
    assert "water has no strength" in capsys.readouterr().err


#: measured flow stress of 4340 steel, MPa: Rockwell C, strain rate in 1/s, temperature of the test in K, and the stresses at
#: plastic strains of 0, 0.05 and 0.1 (Banerjee's collection for arXiv cond-mat/0510330: Johnson & Cook 1985, Larson & Nunes
#: 1961, Lee & Yeh 1997). Then the largest differences of the fits from them, Johnson-Cook and Zerilli-Armstrong.
MEASURED = [
    (32, 1.1, 298.0, (865.6, 1003.29, 1067.08), 0.06, 0.11),
    (32, 570.0, 298.0, (818.593, 1058.87, 1162.32), 0.11, 0.13),
    (32, 650.0, 735.0, (677.769, 827.803, 862.33), 0.05, 0.06),
    (38, 2e-4, 298.0, (1057.73, 1198.88, 1239.97), 0.09, 0.10),
    (38, 1500.0, 298.0, (1192.2, 1455.21, 1536.17), 0.09, 0.09),
    (38, 1500.0, 573.0, (923.74, 1053.52, 1105.79), 0.09, 0.10),
    (38, 2500.0, 773.0, (684.187, 792.575, 826.99), 0.06, 0.08),
    (45, 1e-4, 298.0, (1269.47, 1415.99, 1484.71), 0.17, 0.10),
    (45, 1000.0, 298.0, (1498.07, 1603.02), 0.10, 0.09),
    (49, 1e-4, 298.0, (1484.46, 1754.23, 1859.91), 0.07, 0.03),
    (49, 1000.0, 298.0, (1530.55, 1841.81), 0.08, 0.03),
]


@pytest.mark.parametrize(("hardness", "rate", "temperature", "stresses", "johnson_cook", "zerilli_armstrong"), MEASURED)
def test_the_librarys_steels_against_measurements(hardness, rate, temperature, stresses, johnson_cook, zerilli_armstrong):
    for variant, tolerance in ((None, johnson_cook), ("zerilli-armstrong", zerilli_armstrong)):
        material = library.load(f"steel_4340_Rc{hardness}", variant)
        values, heating = material.strength.values, fitting.heating_of(material, 100.0)
        model = STRENGTH_MODELS[material.strength.name]
        row = model.row(values)
        stress, _ = curves.along(lambda ep, T, model=model, row=row: model.flow_stress(ep, rate, T, 0.0, 1.0, row), temperature,
                                 heating.warming(rate), [0.0, 0.05, 0.1][: len(stresses)], fitting.STEP)
        assert stress / 1e6 == pytest.approx(np.array(stresses), rel=tolerance), variant
        confidence = material.strength.numbers["yield_stress" if variant is None else "thermal_stress"].confidence
        assert confidence == "fitted"


#: the file of points of docs/how-to/fit-a-strength-model.md; arguments of a hardness, in addition to `--heated-from "100 /s"`
POINTS = shipped.problems_folder() / "materials" / "flow_stress_4340.txt"
FITS = [
    (32, "johnson-cook", {}, 0.044, 0.108),
    (32, "zerilli-armstrong", {}, 0.048, 0.128),
    (38, "johnson-cook", {}, 0.052, 0.112),
    (38, "zerilli-armstrong", {}, 0.051, 0.096),
    (45, "johnson-cook", {"thermal_exponent": 0.708}, 0.093, 0.162),
    (45, "zerilli-armstrong", {}, 0.054, 0.098),
    (49, "johnson-cook", {"thermal_exponent": 0.708}, 0.043, 0.068),
    (49, "zerilli-armstrong", {}, 0.011, 0.021),
]


@pytest.mark.parametrize(("hardness", "model", "fixed", "rms", "largest"), FITS)
def test_the_librarys_steels_are_the_fits_of_the_page(hardness, model, fixed, rms, largest):
    """Their constants, the root-mean-square difference and the largest one in the table of the page."""
    points = fitting.read_points(POINTS, unit=1e6)
    points = points.chosen((points.group == hardness) & (points.temperature >= 200.0) & (points.temperature <= 800.0)
                           if hardness == 38 else points.group == hardness)
    law, base = fitting.law(model), library.load("steel_4340")
    fitted = fitting.fit(law, points, fitting.from_material(law, base) | fixed, heating=fitting.heating_of(base, 100.0))
    assert (round(fitted.rms, 3), round(fitted.largest, 3)) == (rms, largest)
    kept = library.load(f"steel_4340_Rc{hardness}", None if model == "johnson-cook" else model).strength.values
    constants = fitted.constants[float(hardness)]
    assert {name: kept[name] for name in law.free} == pytest.approx({name: constants[name] for name in law.free}, rel=3e-3,
                                                                     abs=1e-9)


#: fits of docs/how-to/fit-a-strength-model.md: variant, file, model, given constants, ranges of temperature (K) and rate (1/s),
#: and the numbers of the table: points, root mean square, largest difference
DRAG = {"y1": 0.094, "y2": 0.575, "beta": 0.25, "gamma": 1e-5, "molar_mass": 26.98e-3}
OWN = {"shear_modulus": 26.36e9, "melt_temperature": 893.0}
ALUMINIUM = [
    ("Al5083", "gray-johnson-cook", 5083, OWN, (290, 480), (0, 1e9), (251, 0.030, 0.122)),
    ("Al5083", "gray-voce", 5083, OWN, (290, 480), (0, 1e9), (251, 0.033, 0.128)),
    ("Al5083", "gray-cap", 5083, {"shear_modulus": 26.36e9, "max_yield_stress": 600e6}, (290, 480), (100, 1e4),
     (210, 0.023, 0.068)),
    ("Al5083", "gray-preston-tonks-wallace", 5083, OWN | DRAG | {"shear_modulus": 31.2e9, "modulus_softening": 0.46}, (0, 1e9),
     (0, 1e9), (296, 0.034, 0.107)),
    ("Al6061_T6", "hopkinson-johnson-cook", 6061, {"yield_stress": 276e6}, (290, 500), (0, 1e9), (100, 0.036, 0.116)),
    ("Al6061_T6", "hopkinson-voce", 6061, {}, (290, 500), (0, 1e9), (100, 0.031, 0.082)),
]


@pytest.mark.parametrize(("alloy", "variant", "file", "given", "temperatures", "rates", "quality"), ALUMINIUM)
def test_the_librarys_aluminium_is_the_fits_of_the_page(alloy, variant, file, given, temperatures, rates, quality):
    kept, base = library.load(alloy, variant), library.load(alloy, "johnson-cook" if alloy == "Al6061_T6" else None)
    law, points = fitting.law(kept.strength.name), fitting.read_points(POINTS.with_name(f"flow_stress_{file}.txt"), unit=1e6)
    points = points.chosen((points.temperature >= temperatures[0]) & (points.temperature <= temperatures[1])
                           & (points.rate >= rates[0]) & (points.rate <= rates[1]))
    fitted = fitting.fit(law, points, fitting.from_material(law, base) | given, heating=fitting.heating_of(base, 100.0))
    assert (len(points), round(fitted.rms, 3), round(fitted.largest, 3)) == quality
    constants, free = fitted.constants[0.0], [name for name in law.free if name not in given]
    own = {name: kept.strength.values[name] for name in free}
    assert own == pytest.approx({name: constants[name] for name in free}, rel=1e-3)
    assert {kept.strength.numbers[name].confidence for name in free} == {"fitted"}
    assert {kept.strength.numbers[name].confidence for name in given} <= {"chosen", "derived", "recalled", "found"}
    assert round(float(np.sqrt(np.mean(fitting.beside(kept, points, 100.0) ** 2))), 3) == quality[1]


def test_the_published_law_is_the_default():
    own, published = library.load("Al5083"), library.load("Al5083", "published")
    assert (published.strength, published.eos) == (own.strength, own.eos)
