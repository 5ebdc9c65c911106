"""The experience with a kind of shot: which rows of the shipped table belong to a run or to an analytic model."""

import json
import tomllib
from dataclasses import replace

import pytest

import hydro2d
from hydro2d.analytic import experience, models
from hydro2d.analytic.experience import Experience, Impact
from hydro2d.cli.main import call
from hydro2d.materials import library

RODS = Impact("tungsten rod", "aluminium")
RIGID = Experience("hydro2d", "depth", "tungsten rod", "aluminium", "rigid", False, False, "a", 21, bias=0.97, low=0.92,
                   high=1.02, scatter=0.13, least=0.8, most=1.3, slowest=900.0, fastest=1200.0, coarsest=6.0,
                   finest=12.0, thinnest=2.0, thickest=3.0, projectile_materials="W_alloy", target_materials="Al5083; Al7039")
KNOWN = Impact("tungsten rod", "aluminium", "W_alloy", ("Al7039",), 2.5)


def change(**changes):
    return Experience(**{**vars(RIGID), **changes})


@pytest.fixture
def table(monkeypatch):
    """Replaces the shipped table by these rows."""
    def by(*rows):
        monkeypatch.setattr(experience, "table", lambda: rows)

    return by


def test_a_line(table):
    table(RIGID)
    assert experience.of_run(RODS, "rigid", False) == [
        "experience: computed/measured 0.97 (0.92 to 1.02), scatter 13 %, 21 shots (depth of rigid tungsten rods in aluminium, "
        "900 to 1200 m/s, 6 to 12 cells, targets 2 to 3 lengths thick)"]


@pytest.mark.parametrize(("velocity", "outside"), [(870.0, False), (1250.0, False), (-1000.0, False), (None, False),
                                                   (500.0, True), (1300.0, True)])
def test_a_velocity_outside_the_range_of_a_row_is_named(table, velocity, outside):
    table(RIGID)
    (line,) = experience.of_run(RODS, "rigid", False, velocity)
    assert line.startswith("experience: outside its range of velocities; computed") == outside
    assert line.endswith("900 to 1200 m/s, 6 to 12 cells, targets 2 to 3 lengths thick)")


@pytest.mark.parametrize(("changes", "thickness", "outside"), [
    ({}, 2.5, False), ({}, 1.92, False), ({}, 1.8, True), ({}, 9.0, False), ({}, None, False), ({"thinnest": None}, 0.1, False),
    ({"ended": ""}, 9.0, True), ({"ended": ""}, 3.1, False), ({"ended": ""}, 1.8, True)])
def test_a_thickness_outside_the_range_of_a_row_is_named(changes, thickness, outside):
    """A target that is thicker is of the range of rods that end in theirs, and not of the range of all others."""
    line = change(**changes).words_at(replace(KNOWN, thickness=thickness), [])
    assert line.startswith("outside its range of thickness; computed") == outside


@pytest.mark.parametrize(("changes", "begins"), [
    ({}, "computed"),
    ({"target_materials": ("Al2024_T4",)}, "with other materials (Al5083, Al7039); computed"),
    ({"target_materials": ("Al5083", "Al2024_T4")}, "with other materials (Al5083, Al7039); computed"),
    ({"projectile_material": "W_X21C"}, "with other materials (W_alloy); computed"),
    ({"projectile_material": "W_X21C", "target_materials": ("own",)},
     "with other materials (W_alloy into Al5083, Al7039); computed"),
    ({"projectile_material": "", "target_materials": ()}, "computed"),
    ({"target_materials": ("own",), "thickness": 1.0},
     "outside its range of thickness; with other materials (Al5083, Al7039); computed"),
])
def test_other_materials_of_the_same_metals_are_named(changes, begins):
    assert RIGID.words_at(replace(KNOWN, **changes), [1000.0]).startswith(begins)


def test_velocity_and_thickness_outside_the_range_are_named_together():
    line = RIGID.words_at(replace(KNOWN, thickness=1.0), [1000.0, 3000.0])
    assert line.startswith("outside its range of velocities and thickness; computed")


def test_a_row_without_materials_has_no_others():
    assert change(target_materials="", projectile_materials="").words_at(KNOWN, []).startswith("computed")


@pytest.mark.parametrize(("thinnest", "thickest", "words"), [
    (2.667, 8.0, "targets 2.7 to 8 lengths thick)"), (0.144, 0.144, "targets 0.14 lengths thick)"),
    (3.249, 3.2491, "targets 3.2 lengths thick)"), (None, None, "6 to 12 cells)")])
def test_words_of_a_thickness(thinnest, thickest, words):
    assert change(thinnest=thinnest, thickest=thickest).words.endswith(f", {words}")


def test_a_model_outside_the_range_of_its_row_says_so(capsys):
    for velocity, outside in (("1200", False), ("3000", True)):
        command = ["model", "tate", "--rod", "W_alloy", "--target", "Al5083", "--velocity", f"{velocity} m/s"]
        assert call(command) == 0
        assert ("outside its range of velocities" in " ".join(capsys.readouterr().out.split())) == outside


@pytest.mark.parametrize(("changes", "words"), [
    ({"numerical": 0.05}, "scatter 13 %, 5 % between runs of one shot, 21 shots ("),
    ({"missed": 2}, "21 shots, and 2 that perforated where the measured one stopped ("),
    ({"fit": True, "low": None}, "0.97, scatter 13 %, 21 points of a fit to shots ("),
    ({"shots": 1, "low": None, "scatter": None}, "0.97, 1 shot ("),
    ({"shots": 0, "bias": None, "missed": 1}, "no ratio, and 1 that perforated where the measured one stopped ("),
    ({"quantity": "residual velocity", "ended": "", "missed": 1}, "21 shots, and 1 that stopped where the measured one perf"),
    ({"chosen": True}, "6 to 12 cells, targets 2 to 3 lengths thick, set-up chosen by results)"),
    ({"coarsest": 8.5, "finest": 8.5, "slowest": None, "thickest": None},
     "(depth of rigid tungsten rods in aluminium, 8.5 cells)"),
    ({"quantity": "perforation", "ended": "", "right": 10, "shots": 12},
     "10 of 12 shots ended as measured (perforation of tungsten rods through aluminium, "),
])
def test_words_of_a_row(changes, words):
    assert words in change(**changes).words


@pytest.mark.parametrize(("quantity", "impact", "ended", "words"), [
    ("depth", RODS, "eroding", "depth of eroding tungsten rods in aluminium"),
    ("depth", RODS, "stayed rigid", "depth of tungsten rods that stayed rigid, in aluminium"),
    ("residual velocity", Impact("steel rod", "steel"), "", "residual velocity of steel rods through steel"),
    ("length", Impact("copper bar", "wall"), "", "length of a copper bar on a wall"),
    ("wall velocity at 6 mm", Impact("explosive", "copper"), "", "wall velocity at 6 mm of copper driven by an explosive"),
])
def test_words_of_a_kind(quantity, impact, ended, words):
    assert experience.kind(quantity, impact, ended) == words


def test_a_run_has_the_rows_of_its_regime_and_materials(table):
    rows = change(shots=7), change(ended="eroding", shots=2), change(target="steel", shots=9), change(of="tate", shots=8)
    table(*rows)
    (line,) = experience.of_run(RODS, "eroding", False)
    assert ", 2 shots (" in line
    assert experience.of_run(RODS, "deforming", False) == [
        "experience: none for this kind of shot (depth of deforming tungsten rods in aluminium)"]


def test_a_run_has_no_experience_of_a_formula(table):
    table(change(of="tate"))
    assert experience.of_run(RODS, "rigid", False) == [
        "experience: none for this kind of shot (depth of rigid tungsten rods in aluminium)"]


def test_a_rod_that_perforates_has_no_experience_of_depths(table):
    table(RIGID, change(quantity="residual velocity", projectile="steel rod", target="steel", ended=""))
    assert experience.of_run(RODS, "rigid", True) == [
        "experience: none for this kind of shot (residual velocity of tungsten rods through aluminium)"]
    (line,) = experience.of_run(Impact("steel rod", "steel"), "rigid", True)
    assert "(residual velocity of steel rods through steel, " in line
    assert "residual" not in "".join(experience.of_run(Impact("steel rod", "steel"), "rigid", False))


def test_rows_with_choices_are_shown_where_there_are_no_others(table):
    chosen = change(chosen=True, shots=3)
    table(RIGID, chosen)
    (line,) = experience.of_run(RODS, "rigid", False)
    assert "chosen" not in line
    table(chosen)
    (line,) = experience.of_run(RODS, "rigid", False)
    assert "set-up chosen by results" in line


def test_no_kind_of_shot_has_no_experience():
    assert experience.of_run(None, None, False) == ["experience: none for this kind of shot"]
    assert experience.of_run(Impact("tungsten bar", "wall"), None, False) == ["experience: none for this kind of shot"]
    (line,) = experience.of_run(RODS, "left the mesh", False)[-1:]
    assert line == "experience: none for this kind of shot (depth of tungsten rods in aluminium)"


def test_every_metal_of_the_library_is_recognised():
    found = {name: experience.substance(library.load(name)) for name in library.names()}
    for name, metal in {"Al": "aluminium", "steel_": "steel", "copper_": "copper", "W_": "tungsten"}.items():
        own = [each for each in found if each.startswith(name) and library.load(each).has_strength and "porous" not in each]
        assert {found[each] for each in own} == {metal}, name
    others = {name for name, substance in found.items() if substance == name}
    assert {"tantalum", "uranium", "lead", "nylon", "alumina_995", "Al_porous", "Al_tillotson", "granite_tillotson"} <= others
    assert {name for name, substance in found.items() if substance == "explosive"} >= {"TNT", "C4", "octol"}


@pytest.mark.parametrize(("deck", "impact"), [
    ("cth_nose_shape/hemi_5083_1086", RODS),
    ("validation/eroding_w_4340_2070", Impact("tungsten rod", "steel")),
    ("whipple/shield", Impact("aluminium sphere", "2 bodies of aluminium")),
    ("explosives/cylinder", Impact("explosive", "copper")),
    ("classic/taylor_bar", Impact("copper bar", "wall")),
    ("templates/jacketed", Impact("tungsten rod", "steel and aluminium")),
    ("verification/sedov", None),
])
def test_what_strikes_what(deck, impact):
    assert hydro2d.impact_of(hydro2d.Deck.from_file(f"problems/{deck}.toml")) == impact


@pytest.mark.parametrize(("deck", "projectile", "targets", "thickness"), [
    ("cth_nose_shape/hemi_5083_1086", "W_alloy", ("Al5083",), 533.4 / 97.79),
    ("long_rods/rod_10", "W_90_7_3", ("steel_RHA",), 8.0),
    ("whipple/shield", "Al2024_T4", ("Al6061_T6",), 1.45 / 3.18),
    ("perforation/two_plates", "steel_4340", ("Al6061_T6",), (3 + 3) / 10),
    ("perforation/psaap", "steel_Arne", ("steel_304",), 2.667 / 1.778),
    ("explosives/cylinder", "TNT", ("copper_OFHC",), None),
    ("classic/taylor_bar", "copper_OFHC", (), None),
])
def test_materials_and_thickness_of_an_impact(deck, projectile, targets, thickness):
    """A material of a deck is named by that of the library on which it is based; gaps are no thickness."""
    found = hydro2d.impact_of(hydro2d.Deck.from_file(f"problems/{deck}.toml"))
    assert (found.projectile_material, found.target_materials) == (projectile, targets)
    assert found.thickness == (None if thickness is None else pytest.approx(thickness))


def test_a_variant_is_no_other_material_and_a_run_knows_the_origin_of_its_materials():
    deck = hydro2d.Deck.from_file("problems/cth_nose_shape/hemi_5083_1086.toml",
                                  ['body.plate.material="Al5083:published"', 'body.rod.material="own"',
                                   'materials.own.based_on="W_sintered"'])
    for each in (deck, hydro2d.Deck.from_toml(deck.to_toml())):
        found = hydro2d.impact_of(each)
        assert (found.projectile_material, found.target_materials) == ("W_sintered", ("Al5083",))


@pytest.mark.parametrize("changes", [
    {"body.bar.shape": "sphere", "body.bar.r": None, "body.bar.z": None, "body.bar.radius": "5 mm", "body.bar.centre": "5 mm"},
    {"body.bar.velocity": "190 m/s"},
    {"body.bar.velocity": "0 m/s"},
    {"body.bar.r": ["1 mm", "3.81 mm"]},
    {"body.bar.z": ["0 mm", "5 mm"]},
    {"mesh.geometry": "planar"},
    {"body.bar.strength_factor": 1.05},
], ids=["ball", "leaves the wall", "at rest", "tube", "disc", "planar", "stronger"])
def test_what_is_no_bar_that_flies_at_a_wall(changes):
    assert impact_with("classic/taylor_bar", changes) is None


def test_a_flat_rod_that_flies_at_the_upper_wall_is_a_bar():
    rod = {"body.bar.shape": "rod", "body.bar.r": None, "body.bar.z": None, "body.bar.radius": "3.81 mm",
           "body.bar.length": "25.4 mm", "body.bar.tip": "29.5275 mm", "body.bar.velocity": "190 m/s",
           "boundaries.z_min": "outflow", "boundaries.z_max": "wall"}
    assert impact_with("classic/taylor_bar", rod) == Impact("copper bar", "wall")
    assert impact_with("classic/taylor_bar", {**rod, "body.bar.nose": "hemispherical"}) is None


def test_a_planar_deck_has_no_rods():
    assert impact_with("templates/rod", {}) is not None
    assert impact_with("templates/rod", {"mesh.geometry": "planar"}) is None


@pytest.mark.parametrize("name", ["rod", "block"])
def test_a_body_that_is_made_stronger_is_another_material(name):
    assert impact_with("templates/rod", {f"body.{name}.strength_factor": 5.0}) is None
    assert impact_with("templates/rod", {f"body.{name}.strength_factor": 1.0}) == impact_with("templates/rod", {})


def test_the_order_of_an_explosive_and_its_tube_does_not_matter():
    with open("problems/explosives/cylinder.toml", "rb") as file:
        tables = tomllib.load(file)
    assert [body["name"] for body in tables["body"]] == ["charge", "tube"]
    tables["body"].reverse()
    assert hydro2d.impact_of(hydro2d.Deck.from_dict(tables)) == Impact("explosive", "copper")


@pytest.mark.parametrize(("name", "known"), [
    ("TNT", True), ("comp_B", True), ("PBX9404", True), ("C4", False), ("PETN", False), ("nitromethane", False),
])
def test_only_explosives_of_the_kept_shots_are_known(name, known):
    assert (impact_with("explosives/cylinder", {"body.charge.material": name}) is not None) == known


@pytest.mark.parametrize("name", ["plate_push", "sandwich"])
def test_a_planar_charge_is_none_of_the_kept_tubes(name):
    assert hydro2d.impact_of(hydro2d.Deck.from_file(f"problems/explosives/{name}.toml")) is None


def impact_with(deck, changes):
    """What strikes what in a deck of `problems` with changed keys; None as a value removes the key."""
    with open(f"problems/{deck}.toml", "rb") as file:
        tables = tomllib.load(file)
    for path, value in changes.items():
        part, *name, key = path.split(".")
        entry = next(body for body in tables["body"] if [body["name"]] == name) if name else tables.setdefault(part, {})
        entry.pop(key, None)
        if value is not None:
            entry[key] = value
    return hydro2d.impact_of(hydro2d.Deck.from_dict(tables))


def test_a_material_of_a_deck_is_its_metal():
    deck = hydro2d.Deck.from_file("problems/cth_nose_shape/hemi_5083_1086.toml",
                                  ['body.rod.material="own"', 'materials.own.based_on="W_sintered"'])
    assert hydro2d.impact_of(deck) == RODS


def test_a_metal_without_strength_is_none_of_them():
    deck = hydro2d.Deck.from_file("problems/validation/jet_w_5083_2.toml")
    assert {experience.substance(material) for material in deck.materials.values()} & {*experience.METALS} == set()


def test_a_model_has_its_own_experience(table):
    table(RIGID, change(of="tate", ended="eroded", shots=4))
    rod, target = library.load("W_alloy"), library.load("Al5083")
    (line,) = experience.of_model(models.named("tate"), rod, target)
    assert line.startswith("experience with this model: computed/measured 0.97")
    assert ", 4 shots (depth of tungsten rods that eroded, in aluminium" in line
    assert experience.of_model(models.named("forrestal"), rod, target) == ["experience: none with this model"]
    assert experience.of_model(models.named("tate"), library.load("tantalum"), target) == [
        "experience with this model: none for this kind of shot (depth of tantalum rods in aluminium)"]


@pytest.mark.parametrize("given", [(None, None), ("W_alloy", None), (None, "Al5083")])
def test_the_materials_of_the_example_are_not_those_of_the_user(table, given):
    table(change(of="tate", ended="eroded", shots=4))
    rod, target = (name and library.load(name) for name in given)
    assert experience.of_model(models.named("tate"), rod, target) == [
        "experience with this model: none unless the materials of rod and target are given"]


@pytest.mark.parametrize("own", ["rod.density", "rod.strength", "target.density", "target.resistance", "cavity.a"])
def test_a_model_with_a_property_of_the_user_has_no_experience(table, own):
    table(change(of="tate", ended="eroded", shots=4))
    known = models.named("tate"), library.load("W_alloy"), library.load("Al5083")
    assert experience.of_model(*known, ["rod.length", own]) == [
        f"experience with this model: none with properties of materials that are given ({own})"]
    assert experience.of_model(*known, ["rod.length", "rod.diameter", "rod.mass", "nose.shape"]) == experience.of_model(*known)


def test_the_command_has_no_experience_with_properties_in_place_of_materials(capsys):
    own = ("rod.length=97.3mm", "rod.density=7850kg/m^3", "rod.strength=1GPa", "target.density=7850kg/m^3",
           "target.resistance=5GPa")
    assert call(["model", "tate", "--velocity", "1200m/s", *(word for each in own for word in ("--set", each))]) == 0
    assert "computed/measured" not in capsys.readouterr().out


def test_the_command_shows_it(capsys):
    words = ["model", "tate", "--rod", "W_alloy", "--target", "Al5083", "--velocity", "1086m/s"]
    assert call(words) == 0
    last = capsys.readouterr().out.rstrip().splitlines()[-1]
    assert last.startswith("experience with this model: computed/measured ")
    assert call([*words, "--json"]) == 0
    assert last in json.loads(capsys.readouterr().out)["experience"]


def test_the_command_names_other_materials_and_a_thin_target(capsys):
    """The thickness is that of the inputs or of the deck."""
    def shown(*more, name="tate"):
        assert call(["model", name, "--rod", "W_alloy", "--velocity", "1160m/s", "--target", *more]) == 0
        return " ".join(capsys.readouterr().out.split()).partition("experience with this model: ")[2]

    assert shown("Al5083").startswith("computed")
    assert shown("Al2024_T4").startswith("with other materials (Al5083, Al7039); computed")
    assert shown("Al5083", "--deck", "problems/cth_nose_shape/hemi_5083_1086.toml").startswith("computed")
    for thickness, begins in (("530mm", "computed"), ("200mm", "outside its range of thickness; computed")):
        inputs = (word for each in ("rod.length=97.79mm", f"target.thickness={thickness}") for word in ("--set", each))
        assert shown("Al5083", *inputs, name="ravid-bodner").startswith(begins)


def test_the_model_command_has_no_experience_with_properties_that_are_given(capsys):
    arguments = ["model", "tate", "--rod", "W_alloy", "--target", "Al5083", "--velocity", "1200m/s", "--set"]
    assert call([*arguments, "rod.density=17000kg/m^3"]) == 0
    assert "none with properties of materials that are given (rod.density)" in capsys.readouterr().out
    assert call([*arguments, "rod.length=80mm"]) == 0
    assert "computed/measured" in capsys.readouterr().out
