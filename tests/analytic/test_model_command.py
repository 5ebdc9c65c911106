"""`hydro2d model`: inputs and where they come from, tables, files, and one message for each mistake."""

import csv
import json
import math
import re
import shlex

import pytest

from hydro2d.analytic import model_deck, model_materials, model_text, model_transition, models
from hydro2d.analytic.model_materials import Given
from hydro2d.cli.main import call
from hydro2d.materials import library
from hydro2d.penetration import catalogue, inputs
from hydro2d.penetration.model import Example, Input, InputError, Model, Output
from hydro2d.results.reading import ResultsError

HEMI = "problems/cth_nose_shape/hemi_5083_1086.toml"
W_INTO_5083 = ["--rod", "W_alloy", "--target", "Al5083"]


def toy(*extra: Input, values=None) -> Model:
    """A model whose depth is v M: every part of the machinery, none of the physics."""
    return Model(
        name="toy", title="a toy", source="none", validity="none", main="depth",
        inputs=(inputs.ROD_DENSITY, inputs.ROD_STRENGTH, inputs.ROD_DIAMETER, inputs.ROD_LENGTH, inputs.ROD_MASS,
                inputs.NOSE[0], *extra),
        outputs=(Output("depth", "m", "depth"), Output("regime", "", "word")),
        example=Example("W_alloy", "Al5083", 1000.0, (500.0, 1500.0),
                        values or {"rod.diameter": 0.01, "rod.length": 0.1, "nose.shape": "ogival"}),
        evaluate=lambda velocity, **keywords: {"depth": velocity * keywords["rod_mass"], "regime": "rigid"},
        transition=lambda **keywords: 1e-6 * keywords["rod_strength"],
    )


# ------------------------------------------------------------------------------------------- the material library


def test_a_curved_hugoniot_has_no_slope():
    """Models that need the slope of a straight line say that it is missing, and do not take the first of three."""
    assert "hugoniot_slope" in model_materials.quantities(library.load("nylon"))
    assert "hugoniot_slope" not in model_materials.quantities(library.load("nylon:steinberg"))


def test_numbers_of_a_steinberg_guinan_material():
    """K = rho0 c0^2 and G give E and nu; the ultimate strength is Y0 (1 + beta)^n, below the cap."""
    quantities = {name: given.value for name, given in model_materials.quantities(library.load("W_alloy")).items()}
    K, G = 18160.0 * 4030.0**2, 145e9
    assert quantities["density"] == 18160.0
    assert quantities["sound_speed"] == 4030.0
    assert quantities["hugoniot_slope"] == 1.237
    assert quantities["strength"] == pytest.approx(1.87e9, rel=1e-12)
    assert quantities["ultimate_strength"] == pytest.approx(1.87e9 * 8.7**0.13, rel=1e-12)
    assert quantities["shear_modulus"] == pytest.approx(G, rel=1e-12)
    assert quantities["youngs_modulus"] == pytest.approx(2.0 * G * (1.0 + quantities["poisson_ratio"]), rel=1e-12)
    assert quantities["youngs_modulus"] == pytest.approx(3.0 * K * (1.0 - 2.0 * quantities["poisson_ratio"]), rel=1e-12)
    assert quantities["hardening_exponent"] == 0.0


def test_numbers_of_a_power_law():
    """E, nu and n are the law's own; the strength at a strain is already hardened, and n is not applied again."""
    material = library.load("Al5083")
    quantities = model_materials.quantities(material)
    assert (quantities["strength"].value, quantities["hardening_exponent"].value) == (276e6, 0.084)
    assert (quantities["youngs_modulus"].value, quantities["poisson_ratio"].value) == (70.3e9, 0.33333)
    hard = model_materials.quantities(material, strain=0.3)
    Y = hard["strength"].value
    assert Y == pytest.approx(276e6 * (70.3e9 / 276e6 * 0.3 + Y / 276e6) ** 0.084, rel=1e-12)
    assert hard["hardening_exponent"].value == 0.0
    assert hard["ultimate_strength"] == quantities["ultimate_strength"]


def test_johnson_cook_at_a_strain_and_a_variant():
    assert model_materials.quantities(library.load("Al7039"), 0.2)["strength"].value == pytest.approx(
        337e6 + 343e6 * 0.2**0.41, rel=1e-12)
    assert model_materials.quantities(library.load("Al5083:c0-5240"))["sound_speed"].value == 5240.0


@pytest.mark.parametrize("strain", [-0.1, math.nan, math.inf])
def test_an_impossible_strain_is_refused(strain):
    with pytest.raises(InputError, match="strain"):
        model_materials.quantities(library.load("Al5083"), strain)


@pytest.mark.parametrize("name", library.names())
def test_every_material_of_the_library_is_read(name):
    """The numbers of every material are finite; a gas has no strength, and the message says so."""
    material = library.load(name)
    quantities = model_materials.quantities(material)
    assert set(quantities) <= set(inputs.FROM_LIBRARY)
    assert all(math.isfinite(given.value) and given.source.startswith(name) for given in quantities.values())
    assert (quantities["strength"].value > 0.0) == material.has_strength


# --------------------------------------------------------------------------------------------- where inputs come from


def test_the_order_of_sources():
    W, Al = library.load("W_alloy"), library.load("Al5083")
    request = models.Request(rod=W, target=Al, settings={"rod.strength": 2e9, "rod.diameter": 0.02})
    inputs = models.resolve(toy(), request).inputs
    assert inputs["rod.strength"] == Given(2e9, "given")
    assert inputs["rod.density"].source.startswith("W_alloy")
    assert inputs["rod.diameter"] == Given(0.02, "given")
    assert inputs["rod.length"] == Given(0.1, models.EXAMPLE)
    assert inputs["rod.mass"].value == pytest.approx(18160.0 * math.pi / 4.0 * 0.02**2 * 0.1, rel=1e-14)
    assert inputs["nose.shape"] == Given("hemispherical", "default")


def test_without_choices_the_whole_example_is_used():
    values = {"rod.diameter": 0.01, "rod.mass": 0.5, "rod.strength": 1e9, "nose.shape": "ogival"}
    inputs = models.example(toy(values=values)).inputs
    assert inputs["nose.shape"] == Given("ogival", models.EXAMPLE)
    assert inputs["rod.strength"] == Given(1e9, models.EXAMPLE)
    assert inputs["rod.density"].source.endswith(models.EXAMPLE)
    assert inputs["rod.length"].value == pytest.approx(0.5 / (18160.0 * math.pi / 4.0 * 0.01**2), rel=1e-14)


def test_a_material_that_is_chosen_outranks_the_example():
    model = toy(values={"rod.diameter": 0.01, "rod.length": 0.1, "rod.strength": 1e9})
    inputs = models.resolve(model, models.Request(rod=library.load("W_alloy"))).inputs
    assert inputs["rod.strength"].value == pytest.approx(1.87e9)


@pytest.mark.parametrize("missing", models.CYLINDER)
def test_the_third_of_diameter_length_and_mass(missing):
    """Two of them and the density give the third, whatever the example has."""
    whole = {"rod.diameter": 0.008, "rod.length": 0.05, "rod.mass": 18160.0 * math.pi / 4.0 * 0.008**2 * 0.05}
    request = models.Request(rod=library.load("W_alloy"), settings={k: v for k, v in whole.items() if k != missing})
    resolved = models.resolve(toy(), request).values
    assert {name: resolved[name] for name in whole} == pytest.approx(whole, rel=1e-14)


def test_an_input_that_nothing_gives_is_named():
    with pytest.raises(InputError, match="'crater.depth' is missing"):
        models.example(toy(Input("crater.depth", "m", "depth of a crater")))


def test_a_deck_gives_the_geometry():
    """The hemispherical rod of the study: 62.94 g, and the cylinder of that mass is R/3 shorter than the rod."""
    shot = model_deck.read(HEMI)
    values = {name: given.value for name, given in shot.values.items()}
    R = 0.5 * 0.0067568
    assert (shot.rod.name, shot.target.name, shot.velocity, shot.nose) == ("W_alloy", "Al5083", 1086.0, "hemispherical")
    assert values["rod.diameter"] == pytest.approx(0.0067568, rel=1e-12)
    assert values["rod.length"] == pytest.approx(0.09779 - R / 3.0, rel=1e-12)
    assert values["rod.mass"] == pytest.approx(0.06294, rel=1e-3)
    assert values["nose.shape"] == "hemispherical"
    assert values["target.thickness"] == pytest.approx(0.5334)


@pytest.mark.parametrize(
    ("nose", "key", "value"), [
        ("ogival", "nose.crh", 2.5), ("flat-rounded", "nose.edge_radius", 0.001), ("conical", "nose.half_angle", 0.4)]
)
def test_a_nose_of_a_deck(nose, key, value):
    from hydro2d.deck import deck

    unit = {"nose.crh": "", "nose.half_angle": " rad", "nose.edge_radius": " m"}[key]
    given = f"{key.removeprefix('nose.')}={value}{unit}"
    loaded = deck.load(HEMI, [f"body.rod.nose={nose}", f"body.rod.{given}"])
    inputs = model_deck.shot(loaded).values
    assert inputs[key].value == pytest.approx(value, rel=1e-12)
    assert inputs["nose.shape"].value == nose


def test_settings_are_checked():
    model = toy()
    assert models.settings(["rod.diameter=8.12 mm", "rod.mass=0.1 kg", "nose.shape=flat"], [model]) == {
        "rod.diameter": pytest.approx(0.00812), "rod.mass": 0.1, "nose.shape": "flat"
    }
    for text, message in (
        ("rod.diameter", "expected key=value"), ("rod.diametre=1", "did you mean .rod.diameter"),
        ("rod.diameter=1 s", "a time"), ("rod.diameter=1", "has no unit; write .1 mm."),
        ("rod.diameter=-1 m", "must be positive"), ("nose.shape=flad", 'did you mean "flat"'),
    ):
        with pytest.raises(InputError, match=message):
            models.settings([text], [model])


# ------------------------------------------------------------------------------------------------------- the command


def test_list_and_pages(capsys):
    assert call(["model"]) == 0
    listed = capsys.readouterr().out
    assert [name for name in catalogue.MODELS if f"  {name} " not in listed] == []
    assert call(["model", "--help"]) == 0
    assert "hydro2d model" in capsys.readouterr().out


@pytest.mark.parametrize("name", catalogue.MODELS)
def test_the_page_of_a_model(name, capsys):
    model = catalogue.MODELS[name]
    shown = []
    for arguments in (["model", name], ["model", name, "--help"], ["info", name]):
        assert call(arguments) == 0
        shown.append(capsys.readouterr().out)
    assert shown[0] == shown[1]
    assert shown[0].strip() in shown[2]
    for entry in (*model.inputs, *model.outputs):
        assert f"  {entry.name} " in shown[0]
    assert model.source in shown[0]
    assert model.validity in shown[0]


@pytest.mark.parametrize("name", catalogue.MODELS)
def test_the_example_that_is_shown_runs(name, capsys):
    """The command of the page gives the result of the model's example."""
    model = catalogue.MODELS[name]
    program, *arguments = shlex.split(model_text.example_command(model))
    assert program == "hydro2d"
    assert call([*arguments, "--json"]) == 0
    (shown,) = json.loads(capsys.readouterr().out)["results"]
    (row,) = models.example(model).rows([model.example.velocity])
    numbers = {key: value for key, value in row.items() if not isinstance(value, str)}
    assert {key: shown[key] for key in numbers} == pytest.approx(numbers, rel=1e-3, abs=1e-12)


def test_every_input_is_printed_with_its_source(capsys):
    assert call(["model", "tate", *W_INTO_5083, "--velocity", "1086m/s", "--set", "rod.diameter=6.7568mm"]) == 0
    shown = capsys.readouterr().out
    for entry in catalogue.MODELS["tate"].inputs:
        assert f"  {entry.name} " in shown
    assert "W_alloy: reference_density of mie-grueneisen (printed)" in shown
    assert "at 1086 m/s" in shown


def test_table_files_and_json(capsys, tmp_path):
    table, figure = tmp_path / "tate.csv", tmp_path / "tate.png"
    arguments = ["model", "tate", *W_INTO_5083, "--velocity", "500m/s:2km/s:16", "--csv", str(table), "--figure", str(figure)]
    assert call(arguments) == 0
    assert f"wrote {table}" in capsys.readouterr().out
    rows = list(csv.DictReader(table.open()))
    assert len(rows) == 16
    assert [float(rows[0]["velocity [m/s]"]), float(rows[-1]["velocity [m/s]"])] == [500.0, 2000.0]
    assert "depth [m]" in rows[0]
    assert figure.read_bytes().startswith(b"\x89PNG")
    assert call([*arguments[:-4], "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["model"] == "tate"
    assert data["inputs"]["rod.density"]["unit"] == "kg/m^3"
    assert data["units"]["depth"] == "m"
    assert [row["velocity"] for row in data["results"]] == [float(row["velocity [m/s]"]) for row in rows]


def test_a_deck_gives_materials_geometry_and_velocity(capsys):
    assert call(["model", "tate", "--deck", HEMI, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["results"][0]["velocity"] == 1086.0
    assert data["inputs"]["rod.length"]["source"] == "deck hemi_5083_1086"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["tat", "--velocity", "1km/s"], 'did you mean "tate"'),
        (["tate", "--rod", "W_aloy", "--velocity", "1000m/s"], 'did you mean "W_alloy"'),
        (["tate", "--target", "Al5083:c0-524", "--velocity", "1000m/s"], 'did you mean "c0-5240"'),
        (["tate", *W_INTO_5083, "--velocity", "1000 kg"], "is a mass"),
        (["tate", *W_INTO_5083, "--velocity", "-1000 m/s"], "velocity = -1000: must be"),
        (["tate", *W_INTO_5083, "--velocity", "1086"], '--velocity: 1086 has no unit; write "1086 m/s"'),
        (["tate", *W_INTO_5083, "--velocity", "500:1km/s:3"], '--velocity: 500 has no unit; write "500 m/s"'),
        (["tate", *W_INTO_5083, "--velocity", "1.2"], '1.2 has no unit; write "1.2 km/s" (or "1.2 m/s", if that is meant)'),
        (["tate", *W_INTO_5083, "--velocity", "1km/s", "--set", "rod.strength=2e9"], 'rod.strength: 2000000000 has no unit'),
        (["transition", *W_INTO_5083, "--set", "rod.strength=2.1"], '2.1 has no unit; write "2.1 GPa"'),
        (["tate", *W_INTO_5083, "--velocity", "1000m/s:500m/s:3"], "A must be less than B"),
        (["tate", *W_INTO_5083, "--velocity", "500m/s:1km/s"], "A:B:N"),
        (["tate", *W_INTO_5083, "--velocity", "1000m/s", "--set", "target.strength=-1 Pa"], "target.strength"),
        (["tate", *W_INTO_5083, "--velocity", "1000m/s", "--set", "rod.strength=-1 GPa"], "rod.strength = -1e+09: must be"),
        (["tate", *W_INTO_5083, "--velocity", "1000m/s", "--set", "rod.lenght=1 m"], 'did you mean "rod.length"'),
        (["tate", *W_INTO_5083, "--velocity", "1000m/s", "--strain", "-1"], "strain = -1"),
        (["tate", *W_INTO_5083, "--velocity", "1000m/s", "--figure", "a.png"], "A:B:N"),
        (["tate", *W_INTO_5083, "--velocity", "1000m/s:1100m/s:3", "--figure", "a.nothing"], "unknown picture format"),
        (["tate", *W_INTO_5083, "--velocity", "1000m/s", "--csv", "no/such/folder/a.csv"], "no such directory"),
        (["tate", "--deck", "no_such_deck.toml"], "there is no such file"),
        (["tate", "--deck", "problems/verification/sod_z.toml"], "a rod on the axis"),
        (["--rod", "W_alloy"], "the name of a model is missing"),
        (["transition", "--rod", "W_alloy"], "--target"),
        (["transition", *W_INTO_5083, "--nose", "ogiva"], 'did you mean "ogival"'),
        (["transition", *W_INTO_5083, "--set", "rod.strength=-1 Pa"], "rod.strength"),
        (["transition", *W_INTO_5083, "--runs", "problems"], "is not a run directory"),
    ],
)
def test_wrong_input_is_one_message_and_status_2(arguments, message, capsys):
    assert call(["model", *arguments]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert message in printed.err
    assert printed.err.startswith("hydro2d: ")
    assert printed.err.count("\n") == 1


# ---------------------------------------------------------------------------------------------------- the transition


def test_the_experiments_are_those_of_the_study():
    """Twelve shots, six on each alloy; rigid by the rule are those above the study's drop in depth."""
    shots = model_transition.experiments()
    assert len(shots) == 12
    assert sorted(shot.number for shot in shots) == [str(number) for number in range(4338, 4350)]
    assert {shot.number for shot in shots if not shot.stayed_rigid} == {"4338", "4340", "4345", "4346"}


@pytest.mark.parametrize(
    ("target", "nose", "low", "high"),
    [
        ("Al5083", "hemispherical", 1086.0, 1200.0), ("Al7039", "hemispherical", 1038.0, 1165.0),
        ("Al5083", "ogival", 1227.0, None), ("Al7039", "ogival", 1291.0, None),
    ],
)
def test_brackets_follow_from_the_shots(target, nose, low, high):
    first, *rest = model_transition.brackets("W_alloy", target, nose)
    assert (first.name, first.low, first.high) == ("experiment", low, high)
    assert len(rest) == (2 if nose == "ogival" else 0)


def test_predictions_of_the_study():
    predicted = {entry.name: (entry.low, entry.high) for entry in model_transition.brackets("W_alloy", "Al7039", "ogival")}
    assert predicted["the CTH study"] == (1800.0, 1900.0)
    assert predicted["tests at thinner plates"] == (1700.0, None)
    assert model_transition.brackets("W_alloy", "steel_4340", "ogival") == []


def test_how_far_from_a_bracket():
    closed, above = model_transition.Bracket("a", 1000.0, 1100.0, ""), model_transition.Bracket("a", 1000.0, None, "")
    assert [closed.off(v) for v in (900.0, 1050.0, 1250.0)] == [-100.0, 0.0, 150.0]
    assert [above.off(v) for v in (900.0, 5000.0)] == [-100.0, 0.0]
    assert [model_transition.distance(off) for off in (-99.6, 0.0, 150.0)] == ["100 m/s below", "inside", "150 m/s above"]
    assert model_transition.extent(above) == "above 1000 m/s"
    assert model_transition.extent(model_transition.Bracket("a", None, 900.0, "")) == "below 900 m/s"
    assert model_transition.extent(model_transition.Bracket("a", 1000.0, 900.0, "")).startswith("none")


def test_a_rod_weaker_than_its_target_has_no_transition(capsys):
    assert call(["model", "transition", "--rod", "copper_OFHC", "--target", "steel_4340"]) == 0
    assert re.search(r"tate +none: the rod is weaker than the target +not an input", capsys.readouterr().out)


def run_directory(folder, velocity, regime, overrides=()):
    """A directory as a run leaves it, with the files that the comparison reads."""
    from hydro2d.deck import deck

    folder.mkdir()
    (folder / "deck.toml").write_text(deck.load(HEMI, [f"body.rod.velocity={velocity} m/s", *overrides]).to_toml())
    (folder / "summary.json").write_text(json.dumps({"regime": regime} if regime else {}))
    return folder


def test_runs_make_a_bracket(tmp_path):
    runs = [run_directory(tmp_path / str(v), v, word) for v, word in ((900, "rigid"), (1000, "rigid"), (1250, "deforming"),
                                                                       (1300, "eroding"))]
    runs.append(run_directory(tmp_path / "out", 800, "left the mesh"))
    runs.append(run_directory(tmp_path / "ogive", 1800, "rigid", ("body.rod.nose=ogival", "body.rod.crh=2.5")))
    bracket, lines = model_transition.of_runs(runs, "hemispherical")
    assert (bracket.low, bracket.high) == (1000.0, 1250.0)
    assert [line[-1] != "" for line in lines] == [False, False, False, False, True, True]
    assert [line[-1] for line in lines[4:]] == ["not followed to its end, not counted", "other nose, not counted"]
    with pytest.raises(ResultsError, match="has not ended"):
        model_transition.of_runs([run_directory(tmp_path / "unfinished", 1000, "")], "hemispherical")


def test_transition_side_by_side(capsys, tmp_path):
    run = run_directory(tmp_path / "a", 1100, "rigid")
    assert call(["model", "transition", *W_INTO_5083, "--runs", str(run), "--set", "rod.strength=2 GPa"]) == 0
    shown = capsys.readouterr().out
    assert "1086 to 1200 m/s" in shown
    assert "above 1100 m/s" in shown
    assert [model.name for model in model_transition.with_transition() if f"  {model.name} " not in shown] == []
    assert call(["model", "transition", "--deck", HEMI, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["brackets"][0] | {"source": ""} == {"name": "experiment", "low": 1086.0, "high": 1200.0, "source": ""}
    tate = next(entry for entry in data["models"] if entry["model"] == "tate")
    case = models.resolve(catalogue.MODELS["tate"], models.Request(library.load("W_alloy"), library.load("Al5083")))
    assert tate["transition_velocity"] == pytest.approx(case.transition(), rel=1e-12)
    assert tate["inputs"]["rod.strength"]["value"] == pytest.approx(1.87e9)
