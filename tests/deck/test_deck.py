"""Decks: what they accept and refuse, and the messages."""

import copy
import json
import re
import subprocess
import sys
import textwrap
import tomllib
from pathlib import Path

import numpy as np
import pytest

from hydro2d.base.errors import nearest
from hydro2d.deck import deck, key_messages
from hydro2d.deck.layout import axis_edges
from hydro2d.files.key_lines import line_of

TEXT = """\
title = "a rod and a plate"
[mesh]
z_start = "-20 mm"
r = [
  { to = "16 mm", across = "rod", cells_across = 8 },
  { cells = 5, ratio = 1.05 },
]
z = [ { to = "40 mm", size = "0.5 mm" } ]
[[body]]
name = "rod"
material = "W_alloy"
shape = "rod"
nose = "hemispherical"
radius = "4 mm"
length = "16 mm"
tip = 0.0
velocity = "1086 m/s"
[[body]]
name = "plate"
material = "Al5083"
shape = "plate"
z_front = 0.0
thickness = "30 mm"
[sliding]
method = "slip-layer"
hard = ["rod"]
yield_factor = "radius"
[stop]
time = "10 us"
"""


def changed(old, new=""):
    assert old in TEXT
    return TEXT.replace(old, new)


def message(text, **options):
    with pytest.raises(deck.DeckError) as caught:
        deck.loads(text, **options)
    return str(caught.value)


def test_a_deck_is_resolved_to_si():
    d = deck.loads(TEXT)
    rod, plate = d.body
    assert (d.name, d.title) == ("deck", "a rod and a plate")
    assert (rod.rod_radius, rod.length, rod.velocity) == (0.004, 0.016, (0.0, 1086.0))
    assert (plate.thickness, plate.velocity) == (0.03, (0.0, 0.0))
    assert (d.stop.time, d.output.history_interval, d.output.directory) == (1e-5, 1e-8, "runs/deck")
    assert d.boundaries.r_min == "axis"
    assert (d.penetration.rod, d.penetration.target, d.penetration.surface) == ("rod", "plate", 0.0)
    assert d.numerics.interface_order == ("rod", "plate")
    assert deck.slots(d) == ["rod", "plate"]
    assert deck.warnings(d) == []


def test_a_deck_does_not_change():
    with pytest.raises(ValueError, match="frozen"):
        deck.loads(TEXT).stop.time = 1.0


@pytest.mark.parametrize(
    ("old", "new", "line", "fragments"),
    [
        ('thickness = "30 mm"', 'thicknes = "30 mm"', 23, ['unknown key "thicknes"', 'did you mean "thickness"?']),
        ("[sliding]", "[sliiding]", 24, ['unknown key "sliiding"', 'did you mean "sliding"?', "numerics"]),
        ('nose = "hemispherical"', 'nose = "hemisferical"', 13, ['did you mean "hemispherical"?', "ogival"]),
        ('shape = "plate"', 'shape = "plat"', 21, ["body[1].shape", 'did you mean "plate"?']),
        ('shape = "plate"\n', "", 18, ["body[1].shape: is missing", "polygon"]),
        ('material = "Al5083"', 'material = "Al5038"', 20, ['unknown material "Al5038"', 'did you mean "Al5083"?']),
        ('hard = ["rod"]', 'hard = ["rood"]', 26, ['unknown body "rood"', 'did you mean "rod"?']),
        ('across = "rod"', 'across = "bar"', 5, ['mesh.r[0].across: unknown body "bar"']),
        ('"1086 m/s"', '"1086 mm"', 17, ['"1086 mm" is a length; expected a velocity', '"1.5 m/s"']),
        ('velocity = "1086 m/s"', "velocity = [1, 2, 3]", 17, ["expected two numbers or strings in m/s"]),
        ('radius = "4 mm"', 'radius = "4"', 14, ['"4" has no unit; expected a length']),
        ('radius = "4 mm"', "radius = true", 14, ["True is not a quantity"]),
        ('thickness = "30 mm"', 'thickness = "-30 mm"', 23, ["body[1].thickness: must be positive, is -30 mm"]),
        ('thickness = "30 mm"', 'thickness = "-2 inch"', 23, ["body[1].thickness: must be positive, is -2 inch"]),
        ('length = "16 mm"', 'length = "3 mm"', 9, ["must not be less than the length of the nose (0.004 m)"]),
        ('length = "16 mm"\n', "", 9, ["body[0].length: is missing"]),
        ('radius = "4 mm"\n', "", 9, ["a rod needs its radius or its diameter"]),
        ('radius = "4 mm"', 'radius = "4 mm"\ndiameter = "9 mm"', 9, ["radius and diameter are both given"]),
        ("tip = 0.0", 'tip = "50 mm"', 9, ['"rod" is cut off by the mesh: z from 0.034 to 0.05 m, the mesh from']),
        ("tip = 0.0", 'tip = "80 mm"', 9, ['"rod" lies outside the mesh: z from 0.064 to 0.08 m']),
        ('radius = "4 mm"', 'diameter = "50 mm"', 9, ["must not be less than the length of the nose"]),
        ("z_front = 0.0", 'z_front = "1 m"', 18, ['"plate" lies outside the mesh: z from 1 to 1.03 m']),
        ('time = "10 us"', 'time = "-10 us"', 29, ["stop.time: must be positive"]),
        ('time = "10 us"', "", 28, ["stop: needs time or cycles"]),
        ('time = "10 us"', 'time = "10 us"\ncycles = 0', 30, ["stop.cycles: should be greater than 0, is 0"]),
        ('time = "10 us"', 'time = "10 us"\nbody = "rdo"', 30, ['unknown body "rdo"', 'did you mean "rod"?']),
        ('method = "slip-layer"', 'method = "slip"', 25, ['unknown value "slip"', 'did you mean "slip-layer"?']),
        ('hard = ["rod"]\n', "", 24, ["sliding.hard: a slip layer needs the names of the hard bodies"]),
        ('"radius"', '"radus"', 27, ["is 'radus'", 'must be "radius", "printed", "off" or a number']),
        ('"radius"', "-1.0", 27, ["must be positive"]),
        ('hard = ["rod"]', 'hard = ["plate"]', 27, ['"radius" needs a hard body with a radius']),
        ('hard = ["rod"]', 'hard = ["rod"]\nfriction = 0.1', 27, ['friction needs shear = "shear"']),
        ('hard = ["rod"]', 'hard = ["rod"]\nboundary_layer = "2 GPa"', 27, ["expected a length"]),
        ('name = "plate"', 'name = "rod"', 19, ['the name "rod" is already used by an earlier body']),
        ('name = "plate"', 'name = "plate"\njoin = "rod"', 20, ["is made of W_alloy, not of Al5083"]),
        ('name = "plate"', 'name = "plate"\njoin = "bar"', 20, ['unknown earlier body "bar"']),
        ('name = "plate"', 'name = "plate"\njoin = "rod"\nstrength_factor = 2', 21, ['belongs to "rod"']),
        ('z_start = "-20 mm"', 'r_start = "-1 mm"', 3, ["must start at r >= 0, not at -0.001 m"]),
        ("[stop]", '[boundaries]\nr_min = "wall"\n[stop]', 29, ["r = 0 of a cylindrical mesh is the axis"]),
        ("[mesh]", '[boundaries]\nr_min = "axis"\n[mesh]\ngeometry = "planar"', 3, ["needs a cylindrical mesh"]),
        ('size = "0.5 mm"', 'size = "0.7 mm"', 8, ["cells of 0.7 mm do not divide 60 mm",
         "to = 39.5 mm or 40.2 mm would fit, or cells = 85 (of 0.7059 mm) or 86 (of 0.6977 mm)"]),
        ('to = "40 mm", size', 'to = "-40 mm", size', 8, ["must end beyond its start at -0.02 m"]),
        ('size = "0.5 mm"', "cells = 5, ratio = 1.1", 8, ["does not define a segment"]),
        ('size = "0.5 mm"', "ratio = 1.1", 8, ["needs `first`, the size of its first cell"]),
        ('size = "0.5 mm"', "cells = 2000000000", 8, ["less than or equal to 1000000"]),
        (", cells_across = 8", "", 5, ["across and cells_across go together"]),
        ('across = "rod"', 'across = "plate"', 5, ['"plate" is not a body with a radius']),
        ("[stop]", "[numerics]\ncourant = 1.5\n[stop]", 29, ["courant: must lie between 0.001 and 1, is 1.5: "]),
        ("[stop]", "[numerics]\ncourant = nan\n[stop]", 29, ["nan is not finite"]),
        ("[stop]", "[numerics]\ntrace = 1e-9\n[stop]", 29, ["numerics.trace: is now called numerics.cutoff"]),
        ("[stop]", "[failure]\nloose = 0.9\n[stop]", 29, ["failure.loose: is now called failure.strength_cutoff"]),
        ("[stop]", '[output]\nfields = ["velocity_rest"]\n[stop]', 29, ["velocity_rest is now called velocity_soft"]),
        ("[stop]", '[numerics]\ninterface_order = ["rod"]\n[stop]', 29, ["must name every body once: rod, plate"]),
        ("[stop]", '[failure]\ndamage = "yes"\n[stop]', 29, ['unknown value "yes"', "material, none"]),
        ("[stop]", '[[tracer]]\nname = "t"\nr = "1 m"\nz = 0.0\n[stop]', 28, ['"t" at r = 1 m, z = 0 m lies outside']),
        ("[stop]", "[experiment]\npenetration = 0.4\n[stop]", 28, ["experiment.source: is missing"]),
        ("[stop]", '[experiment]\nresidual_velocity = 0\nsource = "x"\n[stop]', 28, ["residual_velocity needs velocity"]),
        ("z_front = 0.0", "z_front = 0.0\nenergy = \"1 J/kg\"\npressure = 0.0", 18, ["energy or pressure, not both"]),
    ],
)
def test_mistakes_are_named_with_their_line(old, new, line, fragments):
    error = message(changed(old, new))
    assert any(entry.startswith(f"deck.toml:{line}: ") for entry in error.splitlines()), error
    for fragment in fragments:
        assert fragment in error


def test_text_that_is_no_toml_names_the_line():
    assert message(changed("tip = 0.0", "tip = ")).startswith("deck.toml:16: not valid TOML: invalid value")


def test_all_mistakes_are_reported_at_once():
    text = changed('thickness = "30 mm"', 'thickness = "-30 mm"').replace('"10 us"', '"10 m"')
    assert [line.split(": ")[1] for line in message(text).splitlines()] == ["body[1].thickness", "stop.time"]


def test_a_hard_body_needs_strength():
    fluid = '[materials.fluid]\nbased_on = "W_alloy"\nstrength.model = "hydrodynamic"\n'
    text = TEXT.replace("W_alloy", "fluid") + fluid
    error = message(text)
    assert error == (
        'deck.toml:26: sliding.hard[0]: "rod" is made of fluid, which has no strength; a hard body needs strength'
    )


CONTACT = changed('method = "slip-layer"', 'method = "contact"').replace('yield_factor = "radius"', "friction = 0.1")


def test_a_contact_asks_for_no_strength_and_no_factor():
    fluid = '[materials.fluid]\nbased_on = "W_alloy"\nstrength.model = "hydrodynamic"\n'
    for text in (CONTACT, CONTACT.replace("W_alloy", "fluid") + fluid):
        d = deck.loads(text)
        assert deck.warnings(d) == []
        assert deck.yield_factor(d) == 1.0
        assert deck.loads(d.to_toml()).to_toml() == d.to_toml()
    assert deck.yield_factor(deck.loads(CONTACT, ["sliding.yield_factor=1.5"])) == 1.5


@pytest.mark.parametrize(
    ("old", "new", "line", "complaint"),
    [
        ('hard = ["rod"]\n', "", 24, "sliding.hard: a contact needs the names of the hard bodies"),
        ('["rod"]', '["plate", "rod"]', 26, "sliding.hard: a contact needs a body that is not hard"),
        ('["rod"]', '["rood"]', 26, 'sliding.hard[0]: unknown body "rood"; did you mean "rod"?'),
        ("friction = 0.1", 'yield_factor = "radius"', 27, '"radius" is for the slip layer only; a contact takes "off"'),
        ("friction = 0.1", 'yield_factor = "printed"', 27, '"printed" is for the slip layer only; a contact takes "off"'),
        ("friction = 0.1", "boundary_layer = 1", 27, "sliding.boundary_layer: boundary_layer is for the slip layer only"),
        ("friction = 0.1", 'slip_layer = "1 mm"', 27, "sliding.slip_layer: slip_layer is for the slip layer only"),
        ("friction = 0.1", "threshold = 0.5", 27, "sliding.threshold: threshold is for the slip layer only"),
        ("friction = 0.1", 'shear = "shear"', 27, "sliding.shear: shear is for the slip layer only"),
        ("friction = 0.1", "refresh = 1", 27, "sliding.refresh: refresh is for the slip layer only"),
        ("friction = 0.1", "friction = -0.1", 27, "sliding.friction: must not be negative"),
        ('"contact"', '"contct"', 25, 'unknown value "contct"; did you mean "contact"?'),
    ],
)
def test_mistakes_in_a_contact_are_named_with_their_line(old, new, line, complaint):
    assert CONTACT.count(old) == 1
    error = message(CONTACT.replace(old, new))
    assert error.startswith(f"deck.toml:{line}: sliding.")
    assert complaint in error


def test_keys_of_the_slip_layer_at_their_defaults_are_no_mistake_in_a_contact():
    text = CONTACT.replace("friction = 0.1", 'boundary_layer = 2\nslip_layer = 2.0\nshear = "fluid"\nyield_factor = "off"')
    assert deck.loads(text).sliding.method == "contact"


def test_the_hard_bodies_of_a_contact_come_first_in_mixed_cells():
    other = CONTACT.replace('["rod"]', '["plate"]')
    assert deck.loads(other).numerics.interface_order == ("plate", "rod")
    assert deck.body_groups(deck.loads(other)) == [0, 1]
    kept = other.replace("[stop]", '[numerics]\ninterface_order = ["rod", "plate"]\n[stop]')
    assert deck.loads(kept).numerics.interface_order == ("rod", "plate")
    assert deck.loads(TEXT, ['sliding.hard=["plate"]', "sliding.yield_factor=1.5"]).numerics.interface_order == ("rod", "plate")
    assert deck.body_groups(deck.loads(TEXT)) == [0, 0]


@pytest.mark.parametrize(
    ("nose", "fragment"),
    [
        ('nose = "ogival"', "an ogival nose needs crh or nose_length"),
        ('nose = "ogival"\ncrh = 3\nnose_length = "9 mm"', "give crh or nose_length, not both"),
        ('nose = "ogival"\ncrh = 0.4', "at least 0.5"),
        ('nose = "ogival"\nnose_length = "3 mm"', "is at least the radius"),
        ('nose = "ogival"\nhalf_angle = "23 deg"', "an ogival nose has no half_angle; give crh or nose_length"),
        ('nose = "conical"\nhalf_angle = 30', 'half_angle: 30 has no unit; write "30 deg"'),
        ('nose = "conical"\nnose_length = "0 mm"', "must be positive"),
        ('nose = "ogival"\nnose_length = "-9 mm"', "must be positive"),
        ('nose = "conical"\ncrh = 3', "a conical nose has no crh; give half_angle or nose_length"),
        ('nose = "flat"\ncrh = 3', "a flat nose has no crh"),
        ('nose = "flat-rounded"', "a flat-rounded nose needs edge_radius"),
        ('nose = "flat-rounded"\nedge_radius = "5 mm"', "must lie between 0 and the radius"),
        ('nose = "flat-rounded"\nnose_length = "1 mm"', "a flat-rounded nose has no nose_length; give edge_radius"),
    ],
)
def test_impossible_noses(nose, fragment):
    assert fragment in message(changed('nose = "hemispherical"', nose))


@pytest.mark.parametrize(
    ("body", "fragment"),
    [
        ('shape = "polygon"\npoints = [[0, 0], [0, 0.01]]', "at least three points"),
        ('shape = "polygon"\npoints = [[0, 0], [0.01, 0.01], [0.01, 0], [0, 0.01]]', "cross"),
        ('shape = "polygon"\npoints = [[0, 0], [-0.01, 0.01], [0.01, 0.01]]', "r is negative at -0.01 m"),
        ('shape = "polygon"\npoints = [[0, 0], [0, 0], [0.01, 0.01]]', "corner 0 is given twice"),
        ('shape = "sphere"\ncentre = 0.0\nradius = 0.01\ninner_radius = 0.02', "must be smaller than radius"),
        ('shape = "box"\nr = [0.02, 0.01]\nz = [0, 0.01]', "the second must be greater than the first"),
        ('shape = "box"\nr = [-0.01, 0.01]\nz = [0, 0.01]', "r is negative at -0.01 m"),
    ],
)
def test_impossible_shapes(body, fragment):
    text = 'numbers = "SI"\n' + changed('shape = "plate"\nz_front = 0.0\nthickness = "30 mm"', body)
    assert fragment in message(text)


def write(folder, **files):
    for name, text in files.items():
        (folder / f"{name}.toml").write_text(textwrap.dedent(text), encoding="utf-8")
    return folder


def test_include_merges_tables_by_key_and_bodies_by_name(tmp_path):
    write(tmp_path, base=TEXT)
    write(tmp_path, shot='include = "base.toml"\n[[body]]\nname = "rod"\nvelocity = "1200 m/s"\n[stop]\ncycles = 7\n')
    base, shot = deck.load(tmp_path / "base.toml"), deck.load(tmp_path / "shot.toml")
    assert shot.body[0].velocity == (0.0, 1200.0)
    assert (shot.stop.time, shot.stop.cycles) == (1e-5, 7)
    assert (shot.name, shot.title) == ("shot", base.title)
    assert shot.body[1] == base.body[1]


def test_mistakes_are_traced_through_includes(tmp_path):
    write(tmp_path, base=changed('thickness = "30 mm"', 'thickness = "-1 m"'))
    write(tmp_path, shot='include = "base.toml"\n\n[[body]]\nname = "plate"\nz_frnt = 0.0\n')
    with pytest.raises(deck.DeckError) as caught:
        deck.load(tmp_path / "shot.toml")
    errors = sorted(caught.value.args[0].splitlines())
    assert errors[0].startswith(f"{tmp_path}/base.toml:23: body[1].thickness: must be positive")
    assert errors[1].startswith(f"{tmp_path}/shot.toml:5: body[1].z_frnt: unknown key")


def test_include_cycles_are_found(tmp_path):
    write(tmp_path, a='include = "b.toml"\n', b='include = "a.toml"\n')
    with pytest.raises(deck.DeckError, match=r"the files include each other in a circle: a\.toml -> b\.toml -> a\.toml"):
        deck.load(tmp_path / "a.toml")


def test_a_shipped_deck_is_included_from_any_folder(tmp_path):
    """The deck that the README shows. A base of the same name next to it may be equal; one with other contents is refused."""
    readme = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    write(tmp_path, own=re.search(r"```toml\n(.*?)```", readme, re.S)[1])
    base = deck.load("problems/perforation/sphere.toml")
    assert deck.load(tmp_path / "own.toml").body_named("ball").shape == base.body_named("ball").shape
    beside = tmp_path / "problems" / "perforation" / "sphere.toml"
    beside.parent.mkdir(parents=True)
    beside.write_bytes(deck.find("problems/perforation/sphere.toml").read_bytes())
    assert deck.load(tmp_path / "own.toml").body_named("plate").thickness == 0.008
    beside.write_text(beside.read_text() + "# changed\n")
    with pytest.raises(deck.DeckError, match=r"own\.toml:1: include: .* differ: give the full path of the one that you mean"):
        deck.load(tmp_path / "own.toml")


def test_missing_files(tmp_path):
    write(tmp_path, a='title = "x"\ninclude = "nothing.toml"\n')
    with pytest.raises(deck.DeckError, match=r"a\.toml:2: include: there is no file .*nothing\.toml, and no shipped deck of"):
        deck.load(tmp_path / "a.toml")
    with pytest.raises(deck.DeckError, match=r"aa\.toml: there is no such file; .* did you mean \"a\.toml\"\?"):
        deck.load(tmp_path / "aa.toml")


def test_shipped_decks_are_found_from_anywhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert deck.load("problems/verification/sod_z.toml").name == "sod_z"


@pytest.mark.parametrize(
    ("override", "value"),
    [
        ("body.rod.velocity=1200 m/s", lambda d: d.body[0].velocity[1] == 1200.0),
        ("body.0.velocity=1300 m/s", lambda d: d.body[0].velocity[1] == 1300.0),
        ('body[1].thickness="20 mm"', lambda d: d.body[1].thickness == 0.02),
        ("numerics.advection=momentum", lambda d: d.numerics.advection == "momentum"),
        ("numerics.active_region=false", lambda d: d.numerics.active_region is False),
        ("sliding.yield_factor=1.25", lambda d: deck.yield_factor(d) == 1.25),
        ('sliding.hard=["rod"]', lambda d: d.sliding.hard == ("rod",)),
        ("mesh.z.0.size=0.25 mm", lambda d: len(deck.edges(d)[1]) == 241),
        ("title=two words", lambda d: d.title == "two words"),
    ],
)
def test_overrides(override, value):
    assert value(deck.loads(TEXT, [override]))


@pytest.mark.parametrize(
    ("override", "fragment"),
    [
        ("body.rod.velocity=12 GPa", '--set body.rod.velocity=12 GPa: body[0].velocity: "12 GPa" is a pressure'),
        ("body.bar.velocity=1", "--set body.bar.velocity=1: there is no entry bar; there are rod, plate"),
        ("numerics.advecton=ke", '--set numerics.advecton=ke: numerics.advecton: unknown key "advecton"'),
        ("numerics.trace=1e-9", "--set numerics.trace=1e-9: numerics.trace: is now called numerics.cutoff"),
        ("title.x=1", "title is a value and has no key x"),
        ("title", "expected key=value"),
    ],
)
def test_wrong_overrides(override, fragment):
    assert fragment in message(TEXT, overrides=[override])


def test_a_resolved_deck_of_an_older_version_gets_the_keys_of_today():
    now = tomllib.loads(deck.loads(TEXT).to_toml())
    old = copy.deepcopy(now)
    for before, after in key_messages.RENAMED.items():
        (section, key), (place, name) = before.split("."), after.split(".")
        old[section][key] = old[place].pop(name)
    assert old != now
    assert key_messages.renewed(old) == now
    del old["numbers"]
    assert key_messages.renewed(old) == now
    assert key_messages.renewed({"numerics": 3}) == {"numerics": 3, "numbers": "SI"}


def test_the_resolved_deck_is_complete_and_loads_to_the_same():
    text = deck.loads(TEXT).to_toml()
    for key in ("ke_bound = 1.05", "[boundaries]", 'r_min = "axis"', "[materials.Al5083.strength]", "refresh = 5"):
        assert key in text
    assert deck.loads(text).to_toml() == text


def test_sliding_widths_and_yield_factor():
    d = deck.loads(TEXT)
    assert deck.sliding_widths(d) == (0.001, 0.001)
    assert deck.yield_factor(d) == pytest.approx((5 / 4) ** 2, rel=1e-12)
    printed = deck.loads(TEXT, ["sliding.yield_factor=printed"])
    assert deck.yield_factor(printed) == pytest.approx(((18.16 + 0.1) / 18.16) ** 2, rel=1e-12)
    assert deck.yield_factor(deck.loads(TEXT, ["sliding.yield_factor=off"])) == 1.0
    assert deck.yield_factor(deck.loads(TEXT, ["sliding.method=none"])) == 1.0
    assert deck.sliding_widths(deck.loads(TEXT, ["sliding.slip_layer=2 mm"])) == (0.001, 0.002)


def test_the_study_has_the_printed_mesh_and_factor():
    d = deck.load("problems/cth_nose_shape/hemi_5083_1086_layer.toml")
    r, z = deck.edges(d)
    assert (len(r) - 1, len(z) - 1) == (85, 1545)
    assert r[40] == 0.016891
    assert np.allclose(np.diff(r)[:40], 4.22275e-4, rtol=1e-12)
    assert np.allclose(np.diff(r)[40:] / np.diff(r)[39:-1], 1.05, rtol=1e-12)
    assert r[-1] == pytest.approx(8.77e-2, rel=1e-4)
    assert np.allclose(np.diff(z), 4.22275e-4, rtol=1e-12)
    assert deck.yield_factor(d) == pytest.approx(1.5625, abs=1e-4)


def test_coarse_rods_are_warned_of():
    coarse = deck.loads(changed("cells_across = 8", "cells_across = 4"))
    assert deck.warnings(coarse) == [
        'body "rod": 4.0 cells across the radius; with fewer than 5 a rod is poorly resolved'
    ]
    assert deck.warnings(deck.loads(changed("cells_across = 8", "cells_across = 5"))) == []
    jump = deck.loads(changed("{ cells = 5, ratio = 1.05 }", '{ cells = 5, size = "1 mm" }'))
    assert deck.warnings(jump) == ["mesh.r: neighbouring cells differ by a factor of 2.00; "
                                   "above 1.2 shocks are reflected there"]


SHEET = changed('thickness = "30 mm"', 'thickness = "1 mm"')
FLIGHT = changed('[[body]]\nname = "plate"\nmaterial = "Al5083"\nshape = "plate"\nz_front = 0.0\nthickness = "30 mm"\n')


@pytest.mark.parametrize(
    ("text", "overrides", "warned"),
    [
        (SHEET, [], 'body "plate": 2.0 cells across it along z; stresses and waves in it need at least 4'),
        (SHEET.replace('"1 mm"', '"2 mm"'), [], None),
        (FLIGHT, ['stop.time="40 us"'], 'body "rod": reaches the edge of the mesh after 36.8 us and leaves it before the end'),
        (FLIGHT, ['stop.time="30 us"'], None),
        (FLIGHT, ['stop.time="40 us"', "boundaries.z_max=wall"], None),
        (TEXT, ['stop.time="40 us"'], None),
    ],
)
def test_thin_bodies_and_bodies_that_leave_are_warned_of(text, overrides, warned):
    assert deck.warnings(deck.loads(text, overrides)) == ([warned] if warned else [])


@pytest.mark.parametrize(("speed", "surface"), [(800.0, 0.0), (-800.0, 0.03), (0.0, None)])
def test_a_sphere_that_flies_is_a_penetrator(speed, surface):
    sphere = f'shape = "sphere"\ncentre = [0.0, "-10 mm"]\nradius = "4 mm"\nvelocity = "{speed} m/s"\n'
    i, j = TEXT.index('shape = "rod"'), TEXT.index('[[body]]\nname = "plate"')
    d = deck.loads((TEXT[:i] + sphere + TEXT[j:]).replace('yield_factor = "radius"\n', ""))
    assert (d.penetration and (d.penetration.rod, d.penetration.target)) == (("rod", "plate") if speed else None)
    assert deck.surface(d) == surface


def test_mistakes_of_every_kind_are_reported_at_once():
    """Values, names, materials and fields, each with its line."""
    wrong = changed('"W_alloy"', '"W_aloy"').replace('"4 mm"', '"4 kg"') + '[output]\nfields = ["strain_rate"]\n'
    error = message(wrong).splitlines()
    assert len(error) == 3
    assert [line.split(": ")[0] for line in error] == ["deck.toml:14", "deck.toml:31", "deck.toml:11"]
    assert "radius" in error[0]
    assert 'unknown field "strain_rate"' in error[1]
    assert 'did you mean "W_alloy"' in error[2]


@pytest.mark.parametrize("density", ["1.2 kg/m^3", "1000 kg/m^3"])
def test_gas_next_to_solids_gives_a_warning(density):
    """With contact and without; a gas without solids gives no warning."""
    options = [f'materials.air.eos.reference_density="{density}"']
    warned = ('body "air": a gas that is trapped between bodies in contact gets too hot; '
              "leave the space empty unless the gas matters")
    assert warned in deck.warnings(deck.load("problems/sliding/rod_in_air.toml", options))
    warned = 'body "air": a gas sticks to solids, so that a wedge in a stream acts four to five cells thicker; '
    tied = deck.load("problems/sliding/rod_in_air.toml", [*options, 'sliding.method="none"', "sliding.hard=[]"])
    rest = "leave the space empty unless the gas matters"
    assert [text for text in deck.warnings(tied) if text.startswith(warned)] == [warned + rest]
    assert not any("a gas" in text for text in deck.warnings(deck.load("problems/verification/sod_z.toml")))


def test_an_override_removes_a_key():
    """The key then has its default; removing an absent key changes nothing, and an unknown key is reported."""
    file = "problems/cth_nose_shape/ogive_7039_1291.toml"
    flat = [["body.rod.nose=flat", "body.rod.crh="], {"body.rod.nose": "flat", "body.rod.crh": None}]
    for overrides in (*flat, [*flat[0], "body.rod.half_angle="]):
        assert (deck.load(file, overrides).body[0].nose, deck.load(file, overrides).body[0].crh) == ("flat", None)
    with pytest.raises(deck.DeckError, match=r'--set body\.rod\.chr=: body\[0\]: unknown key "chr"'):
        deck.load(file, ["body.rod.chr="])
    with pytest.raises(deck.DeckError, match="there is no entry|unknown entry"):
        deck.load(file, ["body.rd.crh="])


DAMAGED = changed("W_alloy", "alloy") + """\
[materials.alloy]
based_on = "W_alloy"
variant = "strain-failure"
"""
BARE = changed("W_alloy", "Al7075_T6")


@pytest.mark.parametrize(
    ("text", "warned"),
    [
        (DAMAGED, 'body "rod": the johnson-cook damage model of alloy is off, because failure.damage is not given; '
                  '"material" switches it on, "none" keeps it off'),
        (DAMAGED + '[failure]\ndamage = "none"', None),
        (DAMAGED.replace("Al5083", "alloy") + '[failure]\ndamage = "material"', None),
        (DAMAGED + '[failure]\ndamage = "material"',
         'body "plate": Al5083 has no damage model and, with failure.damage = "material", is never damaged; variants '
         '"strain-failure" and "johnson-cook-failure" have one: material = "Al5083:strain-failure"'),
        (DAMAGED.replace('"Al5083"', '"Al5083:strain-failure"') + '[failure]\ndamage = "material"', None),
        (DAMAGED.replace('material = "Al5083"', 'material = "plate_alloy"') + '[materials.plate_alloy]\nbased_on = "Al5083"\n'
         'damage.model = "none"\n[failure]\ndamage = "material"', None),
        (BARE, 'body "rod": Al7075_T6 has no fracture_pressure and, with failure.tensile = "material", never '
               'fractures in tension; variant "spall" has one: material = "Al7075_T6:spall"'),
        (changed("W_alloy", "Al7075_T6:spall"), None),
        (BARE + '[failure]\ntensile = "none"', None),
    ],
)
def test_failure_that_is_left_out_is_warned_of(text, warned):
    assert deck.warnings(deck.loads(text)) == ([warned] if warned else [])


def test_fluids_are_only_reported_to_bear_tension():
    fluid = """\
[failure]
tensile = "material"
damage = "DAMAGE"
[materials.alloy]
based_on = "copper_OFHC"
variant = "johnson-cook"
strength = { model = "hydrodynamic" }
"""
    text = CONTACT.replace("W_alloy", "alloy").replace("Al5083", "alloy") + fluid
    for each in (*(text.replace("DAMAGE", damage) for damage in ("none", "material")), text.replace('damage = "DAMAGE"\n', "")):
        notes = deck.warnings(deck.loads(each))
        assert len(notes) == len(deck.loads(each).body)
        assert all("bears any tension" in warning for warning in notes)


def test_bodies_that_join_are_warned_of_once():
    again = '[[body]]\nname = "more"\nmaterial = "Al7075_T6"\nshape = "box"\nz = ["-5 mm", "-4 mm"]\njoin = "rod"\n'
    assert len(deck.warnings(deck.loads(BARE.replace("[sliding]", again + "[sliding]")))) == 1


@pytest.mark.parametrize(
    ("segments", "sizes"),
    [
        ("{ to = 1.0, cells = 4 }", [0.25] * 4),
        ("{ to = 1.0, size = 0.2 }", [0.2] * 5),
        ("{ cells = 3, size = 0.5 }", [0.5] * 3),
        ("{ cells = 3, first = 0.1, ratio = 2 }", [0.1, 0.2, 0.4]),
        ("{ to = 0.7, first = 0.1, ratio = 2 }", [0.1, 0.2, 0.4]),
        ("{ to = 0.7, first = 0.1, last = 0.4 }", [0.1, 0.2, 0.4]),
        ("{ to = 0.7, first = 0.4, last = 0.1 }", [0.4, 0.2, 0.1]),
        ("{ to = 0.1, cells = 1 }, { to = 1.5, ratio = 2 }", [0.1, 0.2, 0.4, 0.8 - 0.0]),
        ("{ to = 0.1, cells = 1 }, { cells = 2, ratio = 2 }", [0.1, 0.2, 0.4]),
        ("{ to = 0.4, cells = 2 }, { to = 0.9, last = 0.3 }", [0.2, 0.2, 0.2, 0.3]),
    ],
)
def test_segments(segments, sizes):
    text = changed('z = [ { to = "40 mm", size = "0.5 mm" } ]', f"z = [ {segments} ]")
    text = 'numbers = "SI"\n' + text.replace('"-20 mm"', "0.0").replace("tip = 0.0", "tip = 0.05")
    z = axis_edges(deck.loads(text), "z")
    assert np.allclose(np.diff(z), sizes, rtol=1e-9)
    assert z[0] == 0.0


def test_a_graded_segment_ends_where_it_should():
    z = axis_edges(deck.loads(changed('size = "0.5 mm"', 'first = "0.5 mm", ratio = 1.07')), "z")
    ratios = np.diff(z)[1:] / np.diff(z)[:-1]
    assert z[-1] == 0.04
    assert np.ptp(ratios) < 1e-9
    assert ratios[0] == pytest.approx(1.07, abs=0.01)
    assert z[1] - z[0] == pytest.approx(5e-4, rel=1e-12)


def test_schema_is_json_and_knows_every_section():
    schema = json.loads(json.dumps(deck.schema()))
    assert set(schema["required"]) == {"mesh", "body", "stop"}
    assert {"include", "numerics", "sliding", "tracer"} <= set(schema["properties"])
    assert schema["$defs"]["Numerics"]["properties"]["advection"]["enum"] == ["ke", "momentum", "both"]
    assert schema["$defs"]["Sliding"]["properties"]["method"]["enum"] == ["none", "slip-layer", "contact"]


def test_the_schema_knows_all_that_materials_have():
    """Every key of the library and of the materials of shipped decks."""
    definitions = deck.schema()["$defs"]
    assert deck.schema()["properties"]["materials"]["additionalProperties"] == {"$ref": "#/$defs/Material"}
    tables = [table for file in sorted(Path("problems").rglob("*.toml"))
              for data in [tomllib.loads(file.read_text(encoding="utf-8"))]
              for table in (data.values() if file.parent.name == "materials" else data.get("materials", {}).values())]
    assert len(tables) > 20
    tables += [variant for table in tables for variant in table.get("variants", {}).values()]
    for table in tables:
        assert set(table) <= {*definitions["Material"]["properties"]}
        for part in ("eos", "strength", "damage"):
            if isinstance(table.get(part), dict):
                assert set(table[part]) - {"note"} <= {*definitions[part.capitalize()]["properties"]}


def test_every_key_has_a_description():
    sections = deck.schema()["$defs"]
    bare = [f"{name}.{key}" for name, part in sections.items() for key, entry in part["properties"].items()
            if not entry.get("description")]
    assert bare == []


def test_importing_decks_is_light():
    script = "import sys; import hydro2d.deck.deck; print({'pint', 'numba', 'pyvista', 'scipy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_nearest():
    assert nearest("advecton", ["advection", "courant"]) == "advection"
    assert nearest("W_ALLOY", ["W_alloy"]) == "W_alloy"
    assert nearest("xyz", ["advection"]) is None


AWKWARD = '''\
# a comment with [brackets] and = signs
"quoted key" = 1
a.b.c = "x" # ]
list = [ 1, # one
  [2, 3],
  { d = 1, "e f" = """
text with } and ] and "quotes"
""", g = 'literal # no comment' },
]
[table]
multi = """
[not.a.table]
x = 1"""
esc = "a \\" quote ] \\\\"
date = 1979-05-27T07:32:00Z
[[array]]
name = "first"
[array.sub]
k = 1
[[array.inner]]
k = 2
[[array]]
name = "second"
[[array.inner]]
k = 3
[[array.inner]]
k = 4
[last]
end = """"quoted""""
z = 1
'''


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("quoted key",), 2),
        (("a", "b", "c"), 3),
        (("a",), 3),
        (("list",), 4),
        (("list", 0), 4),
        (("list", 1), 5),
        (("list", 2, "d"), 6),
        (("list", 2, "e f"), 6),
        (("list", 2, "g"), 8),
        (("table",), 10),
        (("table", "multi"), 11),
        (("table", "esc"), 14),
        (("table", "date"), 15),
        (("array", 0), 16),
        (("array", 0, "sub", "k"), 19),
        (("array", 0, "inner", 0, "k"), 21),
        (("array", 1, "name"), 23),
        (("array", 1, "inner", 0, "k"), 25),
        (("array", 1, "inner", 1, "k"), 27),
        (("last", "end"), 29),
        (("last", "z"), 30),
    ],
)
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_the_line_of_a_key(path, line, newline):
    assert line_of(path, AWKWARD.replace("\n", newline)) == line


def test_brackets_in_strings_and_comments_open_nothing():
    text = 'a = [  # [{\n  {b = "[\\"{"}, """say "hi" [\n{\\"""\n""", \'\'\'it\'s [\n{\'\'\',\n]\nc = 1\n'
    lines = [line_of(path, text) for path in (("a",), ("a", 0, "b"), ("a", 1), ("a", 2), ("c",))]
    assert lines == [1, 2, 2, 4, 7]


def test_a_key_that_is_not_there_has_no_line():
    assert line_of(("array", 2), AWKWARD) is None
    assert line_of(("list", "d"), AWKWARD) is None


@pytest.mark.parametrize(("override", "depth"), [
    ("body.rod.velocity=1095 m/s", 0.448), ("body.rod.velocity=1100 m/s", None), ("body.plate.material=Al7039", None),
])
def test_an_experiment_goes_with_its_velocity_and_target(override, depth):
    shot = deck.load("cth_nose_shape/hemi_5083_1086.toml", [override]).experiment
    assert (shot and shot.penetration) == depth


@pytest.mark.parametrize(("rod", "plate", "depth"), [
    (700.0, -386.0, 0.448), (0.0, -1086.0, 0.448), (-100.0, -1186.0, 0.448), (1086.0, -100.0, None), (1186.0, 0.0, None),
])
def test_an_experiment_goes_with_its_velocity_in_any_frame(rod, plate, depth):
    text = deck.find("cth_nose_shape/hemi_5083_1086.toml").read_text().replace('follow = "rod"\n', "")
    moving = ["mesh.fine=none", "mesh.across=rod", f"body.rod.velocity={rod} m/s", f"body.plate.velocity={plate} m/s"]
    shot = deck.loads(text, moving).experiment
    assert (shot and shot.penetration) == depth
