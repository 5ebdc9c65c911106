"""Tables of the SESAME type 301: reading, refusals, writing; decks that name them; the commands."""

import json
import subprocess
import sys
import tomllib

import numpy as np
import pytest

from hydro2d.base.errors import DeckError, UnphysicalState
from hydro2d.cli.main import app
from hydro2d.deck import deck
from hydro2d.materials import library, sesame, tabulate
from hydro2d.mesh.fields import DMG
from hydro2d.output.directory import RunError
from hydro2d.running import run
from hydro2d.solver.simulation import Simulation

#: three densities, three temperatures; p = rho - 1, e = T/1000
PLAIN = """ RECORD     TYPE =  301     NWDS =       26
 3.0 3.0 0.9 1.0 1.1
 0.0 298.0 1000.0
 -0.1 0.0 0.1
 -0.1 0.0 0.1
 -0.1 0.0 0.1
 0.0 0.0 0.0
 0.298 0.298 0.298
 1.0 1.0 1.0
"""
INDEX = """ INDEX      MATID =      7    NWDS =        9
  1.0 2.0 2.0 1.0 2.0
  201.0 301.0 5.0 26.0
 RECORD     TYPE =  201     NWDS =        5
  1.0 2.0 3.0 4.0 5.0
"""


def test_units_and_order():
    table = sesame.read(PLAIN)
    assert table.density.tolist() == [900.0, 1000.0, 1100.0]
    assert table.temperature.tolist() == [0.0, 298.0, 1000.0]
    assert table.pressure[:, 1].tolist() == [-1e8, 0.0, 1e8]
    assert table.energy[2].tolist() == [0.0, 298e3, 1e6]


@pytest.mark.parametrize("text", [
    INDEX + PLAIN,
    PLAIN[PLAIN.index("\n") + 1:],  # numbers alone
    PLAIN.replace("26", "35") + " 9 9 9 9 9 9 9 9 9\n",  # with free energies
    PLAIN + " RECORD     TYPE =  401     NWDS =        2\n 1.0 nonsense\n",
])
def test_other_records_and_free_energies_change_nothing(text):
    table_read, plain = sesame.read(text), sesame.read(PLAIN)
    assert all((vars(table_read)[name] == array).all() for name, array in vars(plain).items())


@pytest.mark.parametrize(("old", "new", "words"), [
    ("NWDS =       26", "NWDS =       27", "its heading states 27 numbers .NWDS.; there are 26"),
    (" 3.0 3.0 0.9", " 3.0 4.0 0.9", "3 densities and 4 temperatures take 33 numbers, 45 with free energies; there are 26"),
    (" 3.0 3.0 0.9", " 2.5 3.0 0.9", "each at least 3; that of densities is 2.5"),
    (" 3.0 3.0 0.9", " 3.0 2.0 0.9", "that of temperatures is 2"),
    (" 3.0 3.0 0.9", " nan 3.0 0.9", "that of densities is nan"),
    ("0.9 1.0 1.1", "0.9 x 1.1", "line 2: 'x' is not a number"),
    ("0.9 1.0 1.1", "0.9 0.9 1.1", "line 2: density 2, 0.9 Mg/m.3, is not above the one before, 0.9"),
    ("0.9 1.0 1.1", "-0.9 1.0 1.1", "line 2: the first density, -0.9 Mg/m.3, is negative"),
    ("298.0 1000.0", "298.0 200.0", "line 3: temperature 3, 200 K, is not above the one before, 298"),
    ("-0.1 0.0 0.1", "-0.1 inf 0.1", "line 4: inf is not a finite number"),
    ("0.9 1.0 1.1", "0.0 1.0 1.1", "line 4: at density zero and 0 K there is a pressure of -0.1 GPa"),
    ("0.298 0.298 0.298", "0.298 0.0 0.298", "line 8: at 1 Mg/m.3 the energy does not rise from 0 to 298 K: 0 to 0 MJ/kg"),
    ("TYPE =  301", "TYPE =  304", "has no record 301, only 304"),
])
def test_a_fault_has_its_line_and_number(old, new, words):
    assert old in PLAIN
    with pytest.raises(sesame.TableError, match=words):
        sesame.read(PLAIN.replace(old, new, 1))


def test_one_material_to_a_file():
    with pytest.raises(sesame.TableError, match="line 10: a second record 301"):
        sesame.read(PLAIN + PLAIN)
    with pytest.raises(sesame.TableError, match="line 15: a second index"):
        sesame.read(INDEX + PLAIN + INDEX)


def test_more_text_than_a_deck_carries():
    with pytest.raises(sesame.TableError, match="characters; at most"):
        sesame.read(PLAIN + " " * sesame.MOST)


def aluminium(number=21):
    material = library.load("Al_tillotson")
    return tabulate.of_material(material, tabulate.points(2200.0, 2700.0, 5400.0, number),
                                tabulate.temperatures(298.0, 12000.0, number))


def test_a_written_table_is_read_again():
    table = aluminium()
    again = sesame.read(sesame.write(table))
    for name, array in vars(table).items():
        assert vars(again)[name] == pytest.approx(array, rel=1e-8, abs=1.0)
    assert sesame.is_table(sesame.write(table))
    assert not sesame.is_table('"""A model."""\n\nNAME = 1\n')


def test_a_table_gives_density_and_temperature_of_the_model():
    table, material = aluminium(), library.load("Al_tillotson")
    module = material.eos.module("eos")
    par = module.row(material.eos.values)
    assert 2700.0 in table.density
    assert 298.0 in table.temperature
    for i, j in np.ndindex(table.pressure.shape):
        p, _, _, T = module.evaluate(table.density[i], table.energy[i, j], par)
        assert p == pytest.approx(table.pressure[i, j], abs=1e-2)
        assert pytest.approx(table.temperature[j], abs=1e-4) == T


@pytest.mark.parametrize("name", ["Al_porous", "TNT"])
def test_models_with_memory_are_not_tabulated(name):
    with pytest.raises(DeckError, match=f"material {name}: .* cannot be tabulated: its pressure depends on internal variables"):
        tabulate.of_material(library.load(name), np.array([1e3, 2e3]), np.array([0.0, 300.0]))


# ------------------------------------------------------------------------------------------------ decks


DECK = """
title = "Two plates"
numbers = "SI"
[mesh]
r = [{ to = "0.2 mm", cells = 4 }]
z_start = "-3 mm"
z = [{ to = "3 mm", size = "0.1 mm" }]
[boundaries]
r_max = "wall"
[[body]]
name = "flyer"
material = "al"
shape = "plate"
z_front = "-2 mm"
thickness = "2 mm"
velocity = "1 km/s"
[[body]]
name = "target"
material = "al"
shape = "plate"
z_front = 0.0
thickness = "2 mm"
[materials.al.eos]
model = "tabular"
table = "al.301"
reference_density = 2700
[failure]
tensile = "none"
[stop]
time = "0.3 us"
"""


@pytest.fixture
def folder(tmp_path):
    """A deck and its table."""
    (tmp_path / "al.301").write_text(sesame.write(aluminium()))
    (tmp_path / "shot.toml").write_text(DECK)
    return tmp_path


def test_a_deck_names_a_table_next_to_it_and_carries_its_text(folder, monkeypatch):
    monkeypatch.chdir("/")
    loaded = deck.load(folder / "shot.toml")
    text = (folder / "al.301").read_text()
    model = loaded.materials["al"].eos
    assert (model.name, model.table_from, model.table, model.title) == ("tabular", "al.301", text, "tabular (al.301)")
    (folder / "al.301").unlink()
    resolved = loaded.to_toml()
    assert tomllib.loads(resolved)["materials"]["al"]["eos"]["table_data"] == text
    again = deck.loads(resolved)
    assert again.to_toml() == resolved
    assert run.models_from_outside(again) == [{"kind": "table", "name": "al", "file": "al.301", "sha256": sesame.digest(text)}]


def test_a_restart_with_another_table_is_refused(folder):
    before = deck.load(folder / "shot.toml").to_toml()
    (folder / "al.301").write_text(sesame.write(aluminium(23)))
    with pytest.raises(RunError, match="differs from that of the run in materials, the code of the model al, its table"):
        run.check_same_deck(deck.load(folder / "shot.toml").to_toml(), before)


@pytest.mark.parametrize(("old", "new", "said"), [
    ('"al.301"', '"no.301"', "shot.toml:25: materials.al.eos.table: "),
    ('"al.301"', "3", "must be the name of a file with a table"),
    ('table = "al.301"', "", "tabular needs table, the name of a file with a table of the SESAME type 301"),
    ('model = "tabular"', 'model = "tillotson"', "shot.toml:25: materials.al.eos.table: tillotson has no table"),
    ('table = "al.301"', 'table = "al.301"\nspecific_heat = 3', 'unknown parameter of tabular "specific_heat"'),
    ('"al.301"', '"shot.toml"', "materials.al.eos.table: shot.toml: line 2: 'title' is not a number"),
    ('"tabular"\ntable = "al.301"', '"p-alpha"\nsolid = "tabular"', "tabular needs table, the name of a file"),
    ('"tabular"', '"p-alpha"\nsolid = "tillotson"', "shot.toml:26: materials.al.eos.table: tillotson has no table"),
    ('"tabular"', '"p-alpha"\nsolid = "tabular"', "p-alpha needs solid_density"),
])
def test_a_mistake_in_the_deck_says_where(folder, old, new, said):
    assert old in DECK
    (folder / "shot.toml").write_text(DECK.replace(old, new))
    with pytest.raises(DeckError) as error:
        deck.load(folder / "shot.toml")
    assert said in str(error.value)


def test_a_deck_that_is_only_read_reads_no_file(folder):
    with pytest.raises(DeckError, match="names a file, which only a deck that is run may do"):
        deck.load(folder / "shot.toml", trust=False)


def test_a_density_that_is_not_at_rest_is_refused(folder):
    (folder / "shot.toml").write_text(DECK.replace("= 2700", "= 2710"))
    with pytest.raises(DeckError, match="material al: tabular: at reference_density = 2710 .* it is zero at 2700 kg/m"):
        Simulation(deck.load(folder / "shot.toml"))


@pytest.mark.parametrize(("said", "words"), [
    ("density = 9000", 'body "target": cannot begin with a density of 9000 kg/m.3 and an energy of 0 J/kg: al.301 has'),
    ('temperature = "13000 K"', 'body "target": no energy gives a temperature of 13000 at a density of 2700 kg/m.3; al.301'),
])
def test_a_body_that_begins_beyond_the_table_is_refused(folder, said, words):
    (folder / "shot.toml").write_text(DECK.replace('name = "target"', f'name = "target"\n{said}'))
    with pytest.raises(DeckError, match=words):
        Simulation(deck.load(folder / "shot.toml"))


@pytest.mark.parametrize("failed", [False, True])
def test_a_run_that_leaves_the_table_says_which_state_and_where(folder, failed):
    """Failed material, which bears no tension, does not hide it."""
    simulation = Simulation(deck.load(folder / "shot.toml", ['body.flyer.velocity="9 km/s"']))
    if failed:
        simulation.state.q[DMG] = 1.0
    with pytest.raises(UnphysicalState) as error:
        simulation.run()
    said = str(error.value)
    assert "cell (r, z) = (" in said
    assert "pressure nan Pa" in said
    assert "material al: al.301 has densities of 2200 to 5400 kg/m^3 and temperatures of 0 to 12000 K" in said


# ------------------------------------------------------------------------------------------------ commands


def test_the_commands_write_and_check_a_table(tmp_path, capsys):
    file = tmp_path / "al.301"
    ranges = ["--density", "2.3 g/cm^3:6 g/cm^3:91", "--temperature", "9000 K:61"]
    assert app(["tabulate", "Al_tillotson", "-o", str(file), *ranges], result_action="return_value") == 0
    said = capsys.readouterr().out
    assert "reference_density = 2700 kg/m^3, reference_temperature = 298 K" in said
    assert "densities of 2300 to 6000 kg/m^3 and temperatures of 0 to 9000 K" in said
    assert sesame.read(file.read_text()).pressure.shape == (91, 61)
    assert app(["check-model", str(file)], result_action="return_value") == 0
    said = capsys.readouterr().out
    assert "91 densities and 61 temperatures\n  reference_density = 2700 kg/m^3" in said
    assert "tabular: all checks passed" in said
    file.write_text(sesame.write(aluminium(11)))
    assert app(["check-model", str(file)], result_action="return_value") == 2  # too coarse for its temperatures
    assert "FAILED    the temperature is consistent with the pressure" in capsys.readouterr().out


@pytest.mark.thorough
@pytest.mark.parametrize(("arguments", "words"), [
    (["tabulate", "Al_tillotson", "-o", "x", "--density", "1:2"], "expected LOW:HIGH:NUMBER, with a NUMBER from 3 to 1000"),
    (["tabulate", "Al_tillotson", "-o", "x", "--density", "3 g/cm^3:4 g/cm^3:9"], "must have 2700, the density at rest"),
    (["tabulate", "Al_tillotson", "-o", "x", "--density", "3000:4000:9"], '--density: 3000 has no unit; write "3000 kg/m^3"'),
    (["tabulate", "Al_tillotson", "-o", "x", "--temperature", "100 K:9"], "must be above 298 K, the temperature at rest"),
    (["check-model", "plain.301", "--temperature", "2000 K"], "2000 K is not within its temperatures, 0 to 1000 K"),
])
def test_wrong_arguments_are_one_line(tmp_path, arguments, words):
    (tmp_path / "plain.301").write_text(PLAIN)
    command = [sys.executable, "-m", "hydro2d", *arguments]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "x").exists()


def test_the_schema_has_the_keys():
    from hydro2d.materials.schema import definitions

    assert {"table", "table_data", "table_from"} <= set(definitions()["Eos"]["properties"])
    assert "table" not in definitions()["Strength"]["properties"]
    json.dumps(definitions())
