"""Spoiled decks, settings and studies: `check` accepts them or refuses them in words, and accepted ones run."""

import random

import pytest

from hydro2d.files.shipped import problems_folder
from tests.cli.test_main import DECK
from tests.measure.test_sanity import TEXT
from tests.trials import spoil

CONTACT = DECK + """
[sliding]
method = "contact"
hard = ["rod"]
yield_factor = "off"
friction = 0.05
[numerics]
advection = "both"
"""
GAS = """
numbers = "SI"
[mesh]
r = [{ cells = 6, size = "1 mm" }, { to = "20 mm", ratio = 1.2 }]
z = [{ to = "30 mm", first = "1 mm", last = "2 mm" }]
[[body]]
name = "ball"
material = "copper_OFHC"
shape = "sphere"
centre = [0.0, "12 mm"]
radius = "5 mm"
velocity = "500 m/s"
[[body]]
name = "air"
material = "gas_7_5"
shape = "box"
z = [0.0, "30 mm"]
density = 1.2
pressure = "1e5 Pa"
[stop]
time = "2 us"
"""
#: decks that run in a second, and shipped ones, which are only checked
SMALL = {"rod": DECK, "bar": "\n" + TEXT, "contact": CONTACT, "gas": GAS}
SHIPPED = ("hemi_5083_1086_quick.toml", "hemi_5083_1086.toml", "hemi_5083_1296_johnson_cook_failure.toml")
STUDY = """
title = "three velocities, two schemes"
deck = "shot.toml"
[set]
"stop.time" = "5 us"
[[axis]]
name = "velocity"
key = "body.rod.velocity"
range = { from = "900 m/s", to = "1100 m/s", count = 3 }
[[axis]]
name = "scheme"
[axis.variants."ke"]
"numerics.advection" = "ke"
[axis.variants."momentum"]
"numerics.advection" = "momentum"
"tracer.deep.name" = "deeper"
[[exclude]]
scheme = "ke"
velocity = "1000 m/s"
"""
SEARCH = """
deck = "shot.toml"
[transition]
from = "900 m/s"
to = "1300 m/s"
tolerance = "100 m/s"
"""


def decks():
    folder = problems_folder() / "cth_nose_shape"
    return {**SMALL, **{name: (folder / name).read_text(encoding="utf-8") for name in SHIPPED}}


@pytest.mark.parametrize("name", SMALL)
def test_unspoiled_decks_pass(name, tmp_path):
    file = tmp_path / "deck.toml"
    file.write_text(SMALL[name])
    assert spoil.judge(["check", str(file)]) == (0, "")


def spoiled_decks(seeds, folder):
    """Checks one spoiled deck for each seed; returns how many were refused."""
    refused, known = 0, decks()
    file = folder / "spoiled.toml"
    for name in SHIPPED:
        (folder / name).write_text(known[name], encoding="utf-8")
    for seed in seeds:
        chance = random.Random(seed)
        file.write_text(spoil.text(known[chance.choice(list(known))], chance), encoding="utf-8", errors="replace")
        refused += spoil.judge(["check", str(file)])[0] != 0
    return refused


def test_spoiled_decks(tmp_path):
    assert spoiled_decks(range(150), tmp_path) > 75


@pytest.mark.slow
def test_five_thousand_spoiled_decks(tmp_path, tell):
    refused = spoiled_decks(range(5000), tmp_path)
    tell(f"5000 spoiled decks, {refused} refused in words, 0 failures")
    assert refused > 2500


#: keys of decks, right and wrong, for --set
KEYS = (
    "mesh.r.0.cells", "mesh.z.0.size", "mesh.z_start", "mesh.geometry", "mesh.r.9.cells", "mesh.q", "body", "body.rod",
    "body.0.radius", "body.rod.velocity", "body.rod.name", "body.rod.nose", "body.plate.material", "body.x.velocity",
    "tracer.nose.r", "tracer.nose.name", "tracer.1", "stop", "stop.time", "stop.cycles", "numerics", "numerics.courant",
    "numerics.advection", "sliding.method", "sliding.hard", "failure.tensile", "output.fields", "output.directory",
    "output.vtk_interval", "experiment.penetration", "materials.x", "materials.x.eos.model", "penetration.rod", "include",
    "title", "name", "x", "", ".", "..", "a b",
)


def settings(seeds, folder):
    """Sets keys to values, both chosen by a seed, by --set; returns how many were refused."""
    refused = 0
    for name, text in SMALL.items():
        (folder / f"{name}.toml").write_text(text)
    for seed in seeds:
        chance = random.Random(seed)
        wanted = [f"{chance.choice(KEYS)}{chance.choice(('=', '=', '=', ' = ', ''))}{chance.choice(spoil.ABSURD)}"
                  for _ in range(chance.choice((1, 1, 2)))]
        given = [part for text in wanted for part in ("--set", text.replace("\n", ""))]
        refused += spoil.judge(["check", str(folder / f"{chance.choice(list(SMALL))}.toml"), *given])[0] != 0
    return refused


def test_absurd_settings(tmp_path):
    assert settings(range(150), tmp_path) > 75


@pytest.mark.slow
def test_five_thousand_absurd_settings(tmp_path, tell):
    refused = settings(range(5000), tmp_path)
    tell(f"5000 absurd settings, {refused} refused in words, 0 failures")
    assert refused > 2500


def spoiled_studies(seeds, folder):
    """Checks one spoiled study, or a study of a spoiled deck, for each seed; returns how many were refused."""
    refused = 0
    study = folder / "study.toml"
    for seed in seeds:
        chance = random.Random(seed)
        text, command = chance.choice(((STUDY, "sweep"), (STUDY, "sweep"), (SEARCH, "transition")))
        of_deck = chance.random() < 0.1
        (folder / "shot.toml").write_text(spoil.text(DECK, chance) if of_deck else DECK, encoding="utf-8", errors="replace")
        study.write_text(text if of_deck else spoil.text(text, chance), encoding="utf-8", errors="replace")
        refused += spoil.judge([command, str(study), "--check"])[0] != 0
    return refused


@pytest.mark.parametrize(("text", "command"), [(STUDY, "sweep"), (SEARCH, "transition")])
def test_a_study_that_is_not_spoiled_passes(text, command, tmp_path):
    (tmp_path / "shot.toml").write_text(DECK)
    (tmp_path / "study.toml").write_text(text)
    assert spoil.judge([command, str(tmp_path / "study.toml"), "--check"]) == (0, "")


def test_spoiled_studies(tmp_path):
    assert spoiled_studies(range(100), tmp_path) > 40


@pytest.mark.slow
def test_two_thousand_spoiled_studies(tmp_path, tell):
    refused = spoiled_studies(range(2000), tmp_path)
    tell(f"2000 spoiled studies, {refused} refused in words, 0 failures")
    assert refused > 1000


def runs(seeds, folder):
    """Runs the spoiled small decks that `check` accepts for three cycles; returns how many there were."""
    ran = 0
    file = folder / "spoiled.toml"
    for seed in seeds:
        chance = random.Random(seed)
        file.write_text(spoil.text(SMALL[chance.choice(list(SMALL))], chance), encoding="utf-8", errors="replace")
        if spoil.judge(["check", str(file)])[0] == 0:
            ran += 1
            few = ["--set", "stop.cycles=3", "--overwrite", "--out", str(folder / "out")]
            spoil.judge(["run", str(file), *few], (0, 3))
    return ran


def test_accepted_decks_run(tmp_path):
    assert runs(range(40), tmp_path) >= 5


@pytest.mark.slow
def test_accepted_decks_of_two_thousand_run(tmp_path, tell):
    ran = runs(range(2000), tmp_path)
    tell(f"{ran} spoiled decks that were taken ran for three cycles, 0 failures")
    assert ran > 300
