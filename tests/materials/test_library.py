"""The library of materials, materials of decks, and the rows that kernels read."""

import math
import re

import numpy as np
import pytest

import eos
import strength
from hydro2d.cli import info
from hydro2d.deck import deck
from hydro2d.materials import library, rows
from hydro2d.measure.reach import Material, stagnation
from strength.layout import SHEAR

TEXT = """\
numbers = "SI"
[mesh]
r = [ { to = 0.01, cells = 5 } ]
z = [ { to = 0.02, cells = 10 } ]
[[body]]
name = "a"
material = "A"
shape = "box"
z = [0.0, 0.01]
[[body]]
name = "b"
material = "Al5083"
shape = "box"
z = [0.01, 0.02]
[stop]
time = "1 us"
[materials.A]
"""


def with_material(text):
    return deck.loads(TEXT + text)


def message(text):
    with pytest.raises(deck.DeckError) as caught:
        with_material(text)
    return str(caught.value)


@pytest.mark.parametrize("name", library.names())
def test_every_number_of_the_library_has_a_source(name):
    for variant in (None, *library.load(name).variants):
        material = library.load(name, variant)
        assert material.title
        for model in (material.eos, material.strength, material.damage):
            for key, number in model.numbers.items():
                assert number.source, f"{name}.{key}"
                assert number.confidence in library.CONFIDENCE
        if material.fracture_pressure is not None:
            assert material.fracture_pressure.source


@pytest.mark.parametrize("name", library.names())
def test_every_material_makes_rows(name):
    material = library.load(name)
    assert eos.MODELS[material.eos.name].row(material.eos.values, *material.eos.base())[eos.RHO0] == material.reference_density
    assert np.isfinite(strength.STRENGTH_MODELS[material.strength.name].row(material.strength.values)[SHEAR])
    strength.DAMAGE_MODELS[material.damage.name].row(material.damage.values)


#: molar mass, kg/mol, by the first letters of a metal's name; Poisson's ratio where it differs from that of most metals
MOLAR_MASS = {"Al": 0.027, "W_": 0.180, "tungsten": 0.1838, "copper": 0.0635, "steel": 0.0558, "iron": 0.0558,
              "tantalum": 0.1809, "lead": 0.2072, "Ti_": 0.0459, "uranium": 0.238, "U_": 0.238}
POISSON = {"uranium": (0.18, 0.25), "U_": (0.22, 0.28), "lead": (0.38, 0.45)}


def by_start(table, name, default=None):
    return next((value for start, value in table.items() if name.startswith(start)), default)


def metals():
    return [name for name in library.names() if by_start(MOLAR_MASS, name)]


def test_metals_are_metals():
    """Poisson's ratio of every metal, from the bulk modulus rho0 c0^2 and G, is that of a metal."""
    solids = {name for name in library.names() if library.load(name).has_strength}
    assert solids - set(metals()) == {"nylon", "alumina_995", "aluminium_nitride", "boron_carbide", "float_glass", "WC", "LiF"}
    for name in metals():
        material = library.load(name)
        if not material.has_strength or material.eos.name != "mie-grueneisen":
            continue
        values = material.eos.values
        bulk = values["reference_density"] * values["sound_speed"] ** 2
        shear = strength.STRENGTH_MODELS[material.strength.name].row(material.strength.values)[SHEAR]
        nu = (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))
        low, high = by_start(POISSON, name, (0.25, 0.37))
        assert low < nu < high, name


#: 500 J/(kg K), from memory, is 1.12 of 3R; 477 would be 1.07. The kept rows of a ball through 304 have it.
WARM = pytest.mark.xfail(reason="wanted 0.9 to 1.1 of 3R, got 1.12", strict=True)


@pytest.mark.parametrize("name", [pytest.param(name, marks=WARM if name == "steel_304" else ()) for name in metals()])
def test_the_heat_of_a_metal_is_near_3_r(name):
    material = library.load(name)
    if material.has_strength and material.eos.name == "mie-grueneisen":
        heat = material.eos.values["specific_heat"] * by_start(MOLAR_MASS, name)
        assert heat / (3 * 8.314) == pytest.approx(1.0, abs=0.1)


def test_every_metal_has_a_tensile_strength():
    """By default, or as the variant `spall` where older results were computed without one; benchmarks have their own."""
    for name in set(metals()) - {"copper_bar_227"}:
        material = library.load(name)
        if not material.has_strength:
            continue
        if material.fracture_pressure is None:
            material = library.load(name, "spall")
        assert 0.3e9 < material.fracture_pressure.value < 5e9, name
        assert material.fracture_pressure.source, name


def shocked(name: str, up: float) -> float:
    """Shock velocity of a material of the library at a particle velocity, m/s."""
    material = library.load(name)
    module = eos.MODELS[material.eos.name]
    row = module.row(material.eos.values, *material.eos.base())
    rho0 = float(row[eos.RHO0])
    return stagnation(Material(module.ID, row, np.zeros(1), rho0, float(row[eos.E0])), up)[2] / (rho0 * up)


def measured_in_water(up: float) -> float:
    """Shock velocity in water, m/s: Rice & Walsh, J. Chem. Phys. 26 (1957) 824; Mitchell & Nellis, there 76 (1982) 6273."""
    return 1483.0 + 25306.0 * math.log10(1.0 + up / 5190.0) if up < 4000.0 else 2393.0 + 1.333 * up


@pytest.mark.parametrize(("name", "fastest", "off"), [
    ("water", 8000.0, 0.02), ("water:steinberg", 8000.0, 0.04), ("water:gas-gun", 1000.0, 0.03),
    ("water:noble-abel", 500.0, 0.025), ("water_tillotson", 8000.0, 0.09)])
def test_shock_velocities_of_water(name, fastest, off):
    """Where a straight line to measurements below 1 GPa ends it is 20 % too fast, and a Noble-Abel stiffened gas 14 %."""
    for up in (60.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 6000.0, 8000.0):
        if up <= fastest:
            assert shocked(name, up) == pytest.approx(measured_in_water(up), rel=off), up
    assert shocked("water:gas-gun", 4000.0) > 1.15 * measured_in_water(4000.0)
    assert shocked("water:noble-abel", 1000.0) > 1.1 * measured_in_water(1000.0)


@pytest.mark.parametrize(("name", "rest", "slope"), [
    ("PMMA", 2572.0, 1.536), ("Lexan", 2232.0, 1.737), ("Ti_6Al_4V", 5130.0, 1.028), ("WC", 5190.0, 1.16),
    ("WC:mcqueen", 4920.0, 1.339), ("LiF", 5150.0, 1.35), ("sapphire", 11186.0, 1.05)])
def test_shock_velocities_of_windows_and_others(name, rest, slope):
    assert shocked(name, 700.0) == pytest.approx(rest + 700.0 * slope, rel=1e-9)


def test_air_begins_at_the_pressure_and_temperature_of_a_room():
    """And a shock of Mach 2 in it has the pressure ratio (2 gamma M^2 - gamma + 1)/(gamma + 1) = 4.5."""
    row = eos.MODELS["ideal-gas"].row(library.load("air").eos.values)
    p, _, _, T = eos.MODELS["ideal-gas"].evaluate(row[eos.RHO0], row[eos.E0], row)
    assert p == pytest.approx(101325.0, rel=1e-3)
    assert pytest.approx(293.15, abs=0.1) == T
    up = 2.0 / 2.4 * (2.0 - 0.5) * math.sqrt(1.4 * p / row[eos.RHO0])
    rho, _, behind = stagnation(Material(1, row, np.zeros(1), float(row[eos.RHO0]), float(row[eos.E0])), up)
    assert behind / p == pytest.approx(4.5, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "variant", "stress"),
    [
        ("steel_RHA", None, (780e6 + 780e6 * 0.1**0.106) * (1 + 0.004 * math.log(1e3)) * (1 - 200 / 1485)),
        ("steel_1006", None, (350e6 + 275e6 * 0.1**0.36) * (1 + 0.022 * math.log(1e3)) * (1 - 200 / 1513)),
        ("Al2024_T351", None, (265e6 + 426e6 * 0.1**0.34) * (1 + 0.015 * math.log(1e3)) * (1 - 200 / 477)),
        ("Al7075_T651", None, (546e6 + 678e6 * 0.1**0.71) * (1 + 0.024 * math.log(1e3)) * (1 - (200 / 595) ** 1.56)),
        ("Al7075_T651", "flores-johnson", (520e6 + 477e6 * 0.1**0.52) * (1 + 0.001 * math.log(2e6)) * (1 - 200 / 595)),
        ("U_0p75Ti", None, (1079e6 + 1120e6 * 0.1**0.25) * (1 + 0.007 * math.log(1e3)) * (1 - 200 / 1175)),
        ("W_90_7_3", "melt-3695", (1506e6 + 177e6 * 0.1**0.12) * (1 + 0.016 * math.log(1e3)) * (1 - 200 / 3397)),
        ("W_90_7_3", "density-17600", (1506e6 + 176.5e6 * 0.1**0.12) * (1 + 0.016 * math.log(1e3)) * (1 - 204 / 3401)),
        ("Al7039", "low-rate", (337e6 + 343e6 * 0.1**0.41) * (1 + 0.001 * math.log(1e6)) * (1 - 200 / 579)),
    ],
)
def test_flow_stress_by_hand(name, variant, stress):
    """Johnson and Cook's law with the constants of the sources, at a strain of 0.1, 1e3 /s and 498 K."""
    law = library.load(name, variant).strength
    row = strength.STRENGTH_MODELS[law.name].row(law.values)
    assert strength.STRENGTH_MODELS[law.name].flow_stress(0.1, 1e3, 498.0, 0.0, 1.0, row) == pytest.approx(stress, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "strain", "stress"),
    [
        ("tantalum", 0.1, 0.77e9 * 2.0**0.1), ("uranium", 0.0, 0.40e9 * 76.0**0.16), ("uranium", 4.0, 1.68e9),
        ("lead", 0.0, 8e6), ("lead", 0.5, 8e6 * 56.0**0.52), ("lead", 2.0, 100e6),
    ],
)
def test_cold_flow_stress_of_steinbergs_metals(name, strain, stress):
    """At 300 K and no pressure, with the constants of the sources."""
    material = library.load(name)
    model = strength.STRENGTH_MODELS[material.strength.name]
    row = model.row(material.strength.values)
    assert model.flow_stress(strain, 1e5, 300.0, 0.0, material.reference_density, row) == pytest.approx(stress, rel=1e-12)


def test_describe_shows_sources_and_variants():
    page = library.describe("W_alloy")
    for fragment in ("specific_heat", "143", "J/(kg*K)", "cv-printed", "steinberg-guinan", "Table 1", "printed"):
        assert fragment in page


def test_unknown_names():
    with pytest.raises(deck.DeckError, match='unknown material "W_aloy"; did you mean "W_alloy"?'):
        library.load("W_aloy")
    with pytest.raises(deck.DeckError, match=r"tungsten\.toml:\d+: material W_alloy: unknown variant \"cv\""):
        library.load("W_alloy", "cv")


def of_body(material, own=""):
    """A deck whose rod is of a material, and its own tables of materials."""
    return deck.loads(TEXT.removesuffix("[materials.A]\n").replace('material = "A"', f'material = "{material}"') + own)


def test_a_body_of_a_variant():
    """As in commands; the resolved deck has its numbers and can be read again as it is."""
    name = "W_alloy:cv-printed:strain-failure"
    loaded = of_body(name)
    material = loaded.materials[name]
    assert (material.name, material.eos.values["specific_heat"], material.damage.values["D1"]) == (name, 1430.5, 1.5)
    again = deck.loads(loaded.to_toml())
    assert again.to_toml() == loaded.to_toml()
    assert again.materials[name].eos.values == material.eos.values
    assert library.load(name) == material


def test_variants_of_a_material_of_the_deck():
    own = '[materials.mine]\nbased_on = "W_alloy:cv-printed"\n[materials.mine.variants.hot]\neos.specific_heat = 200.0\n'
    assert of_body("mine", own).materials["mine"].eos.values["specific_heat"] == 1430.5
    assert of_body("mine:hot", own).materials["mine:hot"].eos.values["specific_heat"] == 200.0
    assert of_body("mine:strain-failure", own).materials["mine:strain-failure"].damage.values["D1"] == 1.5


@pytest.mark.parametrize(("material", "own", "said"), [
    ("W_alloy:cv-prined", "", 'W_alloy: unknown variant "cv-prined"; did you mean "cv-printed"?'),
    ("W_alloy:", "", 'W_alloy: unknown variant ""'),
    ("W_aloy:cv-printed", "", 'unknown material "W_aloy"; did you mean "W_alloy"?'),
    ("mine:cv-prined", '[materials.mine]\nbased_on = "W_alloy"\n',
     'mine:cv-prined: unknown variant "cv-prined"; did you mean "cv-printed"?'),
])
def test_a_body_of_an_unknown_variant(material, own, said):
    with pytest.raises(deck.DeckError, match=r"body\[0\]\.material: ") as raised:
        of_body(material, own)
    assert said in str(raised.value)


def test_a_page_of_a_variant():
    assert re.search(r"specific_heat +1430\.5 ", info.page("W_alloy:cv-printed"))
    with pytest.raises(deck.DeckError, match='did you mean "cv-printed"'):
        info.page("W_alloy:cv-prined")


def test_a_material_based_on_another():
    d = with_material('based_on = "W_alloy"\nvariant = "cv-printed"\nstrength.yield_stress = "2 GPa"\n')
    A, W = d.materials["A"], library.load("W_alloy")
    assert A.strength.values == {**W.strength.values, "yield_stress": 2e9}
    assert A.eos.values == {**W.eos.values, "specific_heat": 1430.5}
    assert A.strength.numbers["yield_stress"].confidence == "deck"
    assert A.strength.numbers["shear_modulus"] == W.strength.numbers["shear_modulus"]


def test_another_model_replaces_the_whole_part():
    other = 'strength = { model = "elastic-plastic", shear_modulus = 1e9, yield_stress = 0 }'
    d = with_material(f'based_on = "W_alloy"\n{other}\n')
    assert d.materials["A"].strength.name == "elastic-plastic"
    assert d.materials["A"].strength.values["max_yield_stress"] == math.inf


def test_strength_takes_what_the_eos_has():
    d = with_material('based_on = "W_alloy"\neos.reference_density = 17000\n')
    assert d.materials["A"].strength.values["reference_density"] == 17000.0


@pytest.mark.parametrize(
    ("text", "line", "fragment"),
    [
        ('based_on = "W_aloy"', 18, 'based_on: unknown material "W_aloy"; did you mean "W_alloy"?'),
        ('based_on = "B"\n[materials.B]\nbased_on = "A"', 20, "are based on each other in a circle: A -> B -> A"),
        ('based_on = "W_alloy"\nvariant = "cv-prined"', 19, 'did you mean "cv-printed"?'),
        ('based_on = "W_alloy"\nvariant = 3', 19, "must be the name of a variant or a list of names"),
        ('based_on = ["W_alloy"]', 18, "must be the name of a material"),
        ('based_on = "W_alloy"\nvariants.x = 3', 19, "must contain a table for each variant"),
        ('title = "x"', 17, "materials.A: has no eos"),
        ('based_on = "W_alloy"\neos.sound_sped = 1.0', 19, 'did you mean "sound_speed"?'),
        ('based_on = "W_alloy"\neos.c0 = 1.0', 19, 'its name is "sound_speed"'),
        ('based_on = "W_alloy"\neos.sound_speed = "4 km"', 19, '"4 km" is a length; expected a velocity'),
        ('based_on = "W_alloy"\neos.sound_speed = -4.0', 19, "sound_speed = -4: must be positive"),
        ('based_on = "W_alloy"\neos.sound_speed = { valu = 1 }', 19, 'unknown key "valu"; did you mean "value"?'),
        ('based_on = "W_alloy"\neos.sound_speed = { value = 1, confidence = "high" }', 19, 'unknown confidence "high"'),
        ('based_on = "W_alloy"\nstrength.model = "steinberg-gunan"', 19, 'did you mean "steinberg-guinan"?'),
        ('based_on = "W_alloy"\nstrenth.model = "hydrodynamic"', 19, 'did you mean "strength"?'),
        ('based_on = "W_alloy"\nfracture_pressure = "-3 GPa"', 19, "must be positive (a tension)"),
        ('[materials.A.eos]\nmodel = "ideal-gas"\nreference_density = 1.0', 18, "ideal-gas needs adiabatic_index"),
    ],
)
def test_mistakes_in_materials(text, line, fragment):
    error = message(text + "\n")
    assert error.startswith(f"deck.toml:{line}: materials.")
    assert fragment in error


def test_a_library_name_without_based_on_says_so():
    text = TEXT.replace("[materials.A]", "[materials.W_alloy]\nstrength.yield_stress = 1e9")
    with pytest.raises(deck.DeckError, match='to change a material of the library, write based_on = "W_alloy"'):
        deck.loads(text)


def test_failure_is_switched_by_the_deck():
    text = 'based_on = "Al7039"\n[failure]\ntensile = "none"\ndamage = "material"\n'
    table = library.resolve(with_material(text))
    assert list(table.fracture_pressure) == [math.inf, math.inf]
    assert list(table.damage_model) == [strength.DAMAGE_MODELS["johnson-cook"].ID, 0]


def test_bodies_that_join_share_a_slot():
    text = TEXT.replace('material = "Al5083"', 'material = "A"\njoin = "a"')
    assert library.resolve(deck.loads(text + 'based_on = "Al7039"\n')).names == ("a",)


def test_a_refusal_by_a_model_is_a_deck_error():
    text = 'based_on = "Al5083"\nstrength.poisson_ratio = 0.7\n'
    with pytest.raises(deck.DeckError, match="material A: power-law: poisson_ratio = 0.7"):
        library.resolve(with_material(text))


def test_a_resolved_deck_gives_the_same_rows():
    d = with_material('based_on = "W_alloy"\nvariant = "strain-failure"\n[failure]\ndamage = "material"\n')
    first, second = library.resolve(d), library.resolve(deck.loads(d.to_toml()))
    for key in ("eos_par", "strength_par", "damage_par", "fracture_pressure", "rho0"):
        assert np.array_equal(getattr(first, key), getattr(second, key))


def test_a_body_carries_the_least_of_its_tensions_and_none_without_strength():
    models, materials = np.ones((5, 5), dtype=int), np.zeros((5, rows.EOS_AT))
    models[4, rows.STRENGTH] = 0
    materials[:, rows.TENSILE] = 3.0, np.inf, np.inf, np.inf, 3.0
    materials[:, rows.CRACKS] = 0.0, 0.0, 2.0, 0.0, 0.0
    materials[:, rows.MOST_STRESS] = np.inf, np.inf, np.inf, 1.0, np.inf
    assert list(rows.tension(models, materials)) == [3.0, np.inf, 2.0, 1.0, 0.0]
