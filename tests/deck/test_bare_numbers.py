"""Numbers without a unit: refused with a suggestion, unless the deck says that they are in SI units."""

import pytest

from hydro2d.base import units
from hydro2d.deck import deck
from hydro2d.study.plan import cases
from hydro2d.study.plan.definition import StudyError

TEXT = """\
title = "a flyer"
[mesh]
r = [{ to = "2 mm", cells = 4 }]
z = [{ to = "4 mm", cells = 8 }]
[[body]]
name = "flyer"
material = "alloy"
shape = "box"
z = ["1 mm", "3 mm"]
velocity = "300 m/s"
[materials.alloy]
based_on = "Al5083"
strength = { model = "elastic-plastic", shear_modulus = "27 GPa", yield_stress = "0.3 GPa" }
[stop]
time = "1 us"
"""
IN_SI = 'numbers = "SI"\n'


def message(text, overrides=()):
    with pytest.raises(deck.DeckError) as caught:
        deck.loads(text, overrides)
    return str(caught.value)


@pytest.mark.parametrize(("old", "new", "line", "told"), [
    ('"2 mm"', "95.25", 3, 'mesh.r[0].to: 95.25 has no unit; write "95.25 mm" (or numbers = "SI" at the top of the deck, '
                           "if 95.25 m is meant)"),
    ('"2 mm"', "0.002", 3, 'mesh.r[0].to: 0.002 has no unit; write "0.002 m" (or numbers = "SI" at the top of the deck)'),
    ('["1 mm", "3 mm"]', "[1, 3]", 9, 'body[0].z: 1 has no unit; write "1 mm"'),
    ('"300 m/s"', "300", 10, 'body[0].velocity: 300 has no unit; write "300 m/s" (or'),
    ('"300 m/s"', "[0, 1.086]", 10, 'body[0].velocity: 1.086 has no unit; write "1.086 km/s"'),
    ('"300 m/s"', '"300 m/s"\ndensity = 17.6', 11, 'body[0].density: 17.6 has no unit; write "17.6 g/cm^3"'),
    ('"300 m/s"', '"300 m/s"\ntemperature = 300', 11, 'body[0].temperature: 300 has no unit; write "300 K"'),
    ('"27 GPa"', "27", 13, 'materials.alloy.strength.shear_modulus: 27 has no unit; write "27 GPa"'),
    ('"0.3 GPa"', "1.506", 13, 'materials.alloy.strength.yield_stress: 1.506 has no unit; write "1.506 GPa"'),
    ('"0.3 GPa"', "3e8", 13, 'materials.alloy.strength.yield_stress: 300000000 has no unit; write "300000000 Pa"'),
    ('"0.3 GPa"', "{ value = 1.5 }", 13, 'materials.alloy.strength.yield_stress: 1.5 has no unit; write "1.5 GPa"'),
    ('"Al5083"', '"Al5083"\nfracture_pressure = 1.2', 13, 'alloy.fracture_pressure: 1.2 has no unit; write "1.2 GPa"'),
    ('"Al5083"', '"Al5083"\neos.reference_density = 2.7', 13, 'eos.reference_density: 2.7 has no unit; write "2.7 g/cm^3"'),
    ('"1 us"', "60", 15, 'stop.time: 60 has no unit; write "60 us"'),
    ("[stop]", '[boundaries]\nz_min = "piston"\nz_min_piston = [[0, 0], [2, 300]]\n[stop]', 16,
     'boundaries.z_min_piston: row 1: 2 has no unit; write "2 us"'),
])
def test_a_number_without_its_unit_is_refused(old, new, line, told):
    assert old in TEXT
    said = message(TEXT.replace(old, new, 1))
    assert said.startswith(f"deck.toml:{line}: ")
    assert told in said


@pytest.mark.parametrize("key", ["body.flyer.velocity=300", "mesh.r.0.to=0.002", "stop.time=1e-6",
                                 "materials.alloy.strength.yield_stress=3e8", "body.flyer.z=[0.001, 0.003]"])
def test_a_number_on_the_command_line_is_refused_unless_the_deck_or_the_line_says_si(key):
    assert f"--set {key}: " in (said := message(TEXT, [key]))
    assert "has no unit; write" in said
    expected = deck.loads(TEXT).to_toml()
    assert deck.loads(IN_SI + TEXT, [key]).to_toml() == expected
    assert deck.loads(TEXT, [key, "numbers=SI"]).to_toml() == expected


def test_numbers_that_need_no_unit():
    loaded = deck.loads(TEXT, ["mesh.z_start=0", "body.flyer.velocity=[0, 0.0]", "numerics.courant=0.3", "mesh.r.0.cells=5",
                               "materials.alloy.eos.grueneisen=1.9", "stop.cycles=7"])
    assert (loaded.numerics.courant, loaded.stop.cycles, loaded.mesh.r[0].cells) == (0.3, 7, 5)
    assert [type(value) for value in (loaded.numerics.courant, loaded.stop.cycles, loaded.mesh.r[0].cells)] == [float, int, int]


def test_each_file_says_so_for_itself(tmp_path):
    (tmp_path / "base.toml").write_text(IN_SI + TEXT.replace('"2 mm"', "0.002"))
    (tmp_path / "shot.toml").write_text('include = "base.toml"\n')
    assert deck.load(tmp_path / "shot.toml").mesh.r[0].to == 0.002
    (tmp_path / "shot.toml").write_text('include = "base.toml"\n\n[stop]\ntime = 2e-6\n')
    with pytest.raises(deck.DeckError, match=r"shot.toml:4: stop.time: 2e-06 has no unit"):
        deck.load(tmp_path / "shot.toml")
    (tmp_path / "base.toml").write_text(TEXT.replace('"2 mm"', "0.002"))
    (tmp_path / "shot.toml").write_text(f'{IN_SI}include = "base.toml"\n')
    with pytest.raises(deck.DeckError, match=r"base.toml:3: mesh.r\[0\].to: 0.002 has no unit"):
        deck.load(tmp_path / "shot.toml")


def test_another_system_of_units_is_none():
    assert 'numbers: unknown value "cgs"' in message('numbers = "cgs"\n' + TEXT)


def test_a_resolved_deck_says_so_and_is_read_again(tmp_path):
    loaded = deck.loads(TEXT)
    assert loaded.numbers == "SI"
    assert 'numbers = "SI"\n' in loaded.to_toml()
    assert deck.loads(loaded.to_toml()).to_toml() == loaded.to_toml()
    old = loaded.to_toml().replace('numbers = "SI"\n', "")  # as earlier versions wrote it
    assert "has no unit" in message(old)
    assert deck.loads(f"# sha256 {'0' * 64}\n{old}").to_toml() == loaded.to_toml()


def test_segments_of_a_mesh_in_two_words_are_written_with_their_unit():
    """To the last bit, so that an override gives the same mesh."""
    segments = 'r = [{ to = "2 mm", cells = 4 }]\nz = [{ to = "4 mm", cells = 8 }]'
    words = TEXT.replace(segments, 'cells_across = 7\nreach = "3 mm"')
    loaded = deck.loads(words)
    again = deck.loads(words, deck.written_segments(loaded))
    assert again.mesh.model_dump() == loaded.mesh.model_dump()
    assert units.to_si(units.exact(0.1 + 0.2, "m"), "m") == 0.1 + 0.2


STUDY = """\
deck = "flyer.toml"
{}
[[axis]]
name = "velocity"
key = "body.flyer.velocity"
values = [{}]
"""


def plan(tmp_path, text):
    (tmp_path / "flyer.toml").write_text(TEXT)
    (tmp_path / "study.toml").write_text(text)
    return cases.plan(tmp_path / "study.toml", quiet=True)


@pytest.mark.parametrize(("settings", "value"), [("", "300"), ('[set]\n"stop.time" = 1e-6', '"300 m/s"')])
def test_numbers_of_a_study_follow_the_same_rule(tmp_path, settings, value):
    (case,) = plan(tmp_path, STUDY.format(settings, value)).cases
    assert not case.text
    assert "has no unit; write" in case.message
    in_si = (settings or "[set]") + '\nnumbers = "SI"'
    (case,) = plan(tmp_path, STUDY.format(in_si, value)).cases
    assert case.message == ""


def test_velocities_of_a_search_need_their_unit(tmp_path):
    search = 'deck = "flyer.toml"\n[transition]\nfrom = 900\nto = "1500 m/s"\n'
    with pytest.raises(StudyError, match=r'study.toml:3: transition.from: 900 has no unit; write "900 m/s"'):
        plan(tmp_path, search)
