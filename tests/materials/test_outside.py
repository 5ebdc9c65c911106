"""Models from outside: how decks name them, models that come too late for the kernels, and models of packages."""

import json
import re
import textwrap
import tomllib

import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.materials import outside
from hydro2d.output.directory import RunError
from hydro2d.running import run
from hydro2d.study.plan import cases
from tests.materials.made_models import DECK, GAS, VOCE, python


@pytest.fixture
def folder(tmp_path):
    """A deck and its model."""
    (tmp_path / "my_model.py").write_text(VOCE)
    (tmp_path / "shot.toml").write_text(DECK)
    return tmp_path


# ------------------------------------------------------------------------------------------------ decks


def test_a_deck_names_a_file_next_to_it_and_carries_its_text(folder, monkeypatch):
    monkeypatch.chdir("/")
    loaded = deck.load(folder / "shot.toml")
    model = loaded.materials["Al5083"].strength
    assert (model.name, model.file, model.code) == ("own-voce", "my_model.py", VOCE)
    assert model.values == {"shear_modulus": 26e9, "yield_stress": 240e6, "saturation": 0.0}
    text = loaded.to_toml()
    (folder / "my_model.py").unlink()
    assert tomllib.loads(text)["materials"]["Al5083"]["strength"]["code"] == VOCE
    assert '\nNAME = \\"own-voce\\"\n' in text  # line by line
    again = deck.loads(text)
    assert again.to_toml() == text
    assert again.materials["Al5083"].strength.module("strength") is model.module("strength")
    assert run.models_from_outside(again) == [outside.from_text(VOCE, "my_model.py", "strength").about()]


def test_the_file_of_an_included_deck_is_next_to_it(folder):
    (folder / "below").mkdir()
    (folder / "below" / "shot.toml").write_text('include = "../shot.toml"\nstop.time = "2 us"\n')
    assert deck.load(folder / "below" / "shot.toml").materials["Al5083"].strength.name == "own-voce"


def test_a_file_of_the_command_line_is_in_the_working_folder_and_replaces_the_text(folder, tmp_path_factory, monkeypatch):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / "other.py").write_text(VOCE.replace('"own-voce"', '"other"'))
    monkeypatch.chdir(elsewhere)
    chosen = ["materials.Al5083.strength.file=other.py"]
    assert deck.load(folder / "shot.toml", chosen).materials["Al5083"].strength.name == "other"
    plain = DECK.replace('file = "my_model.py"', 'model = "elastic-plastic"')
    assert deck.loads(plain, chosen, folder=folder).materials["Al5083"].strength.name == "other"
    resolved = deck.load(folder / "shot.toml").to_toml()
    loaded = deck.loads(resolved, chosen, folder=folder).materials["Al5083"].strength
    assert (loaded.name, loaded.file) == ("other", "other.py")


STUDY = """
deck = "shot.toml"
[[axis]]
name = "law"
[axis.variants.own]
"materials.Al5083.strength" = { file = "law.py", shear_modulus = "10 GPa", yield_stress = "0.1 GPa" }
"""


def test_a_file_of_a_study_is_next_to_the_study(folder, tmp_path_factory, monkeypatch):
    """The file of an override on the command line is in the working folder, for a study as for a deck."""
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    for place, name in ((folder, "study"), (elsewhere, "command")):
        (place / "law.py").write_text(VOCE.replace('"own-voce"', f'"{name}"'))
    (folder / "laws.toml").write_text(STUDY)
    monkeypatch.chdir(elsewhere)
    assert 'model = "study"' in cases.plan(folder / "laws.toml", quiet=True).cases[0].text
    (folder / "laws.toml").write_text(STUDY[: STUDY.index('"materials')] + '"stop.time" = "1 us"')
    chosen = ["materials.Al5083.strength.file=law.py"]
    assert 'model = "command"' in cases.plan(folder / "laws.toml", chosen, quiet=True).cases[0].text


def test_a_model_replaces_the_whole_part_and_numbers_are_laid_over_it(folder):
    further = """
[materials]
soft = { based_on = "Al5083", strength = { yield_stress = "100 MPa" } }
plain = { based_on = "Al5083", strength = { model = "elastic-plastic", shear_modulus = "1 GPa", yield_stress = "1 MPa" } }
"""
    loaded = deck.loads(DECK + further, folder=folder).materials
    assert (loaded["soft"].strength.name, loaded["soft"].strength.values["yield_stress"]) == ("own-voce", 1e8)
    assert (loaded["plain"].strength.name, loaded["plain"].strength.code) == ("elastic-plastic", "")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"my_model.py"', '"no_model.py"', "shot.toml:18: materials.Al5083.strength.file: "),
        ('"my_model.py"', "3", "must be the name of a Python file"),
        ('file = "my_model.py"', 'file = "my_model.py"\nmodel = "vocal"', 'strength.model: is "vocal", but the model in'),
        ('file = "my_model.py"', 'model = "own-voce"', 'unknown strength model "own-voce"'),
        ('file = "my_model.py"', 'file = "my_model.py"\nhardening = 3', 'unknown parameter of own-voce "hardening"'),
        ('yield_stress = "240 MPa"', "", "own-voce needs yield_stress (initial yield stress, Pa)"),
        ('yield_stress = "240 MPa"', 'yield_stress = "240 mm"', "materials.Al5083.strength.yield_stress"),
    ],
)
def test_a_mistake_in_the_deck_says_where(folder, old, new, said):
    assert old in DECK
    (folder / "shot.toml").write_text(DECK.replace(old, new))
    with pytest.raises(DeckError) as error:
        deck.load(folder / "shot.toml")
    assert said in str(error.value)


def test_a_restart_with_another_text_is_refused(folder):
    before = deck.load(folder / "shot.toml").to_toml()
    (folder / "my_model.py").write_text(VOCE.replace("-10.0 * ep", "-11.0 * ep"))
    with pytest.raises(RunError, match="the deck differs from that of the run in materials, the code of the model own-voce"):
        run.check_same_deck(deck.load(folder / "shot.toml").to_toml(), before)
    run.check_same_deck(before.replace("my_model.py", "renamed.py"), before)


def test_its_flow_stress_can_be_drawn(folder):
    from hydro2d.materials import curves

    loaded = deck.load(folder / "shot.toml", ["materials.Al5083.strength.saturation=100 MPa"]).materials["Al5083"]
    stresses, _ = curves.flow_stress(loaded, 1.0, [0.0, 0.1], isothermal=True)
    assert stresses == pytest.approx([240e6, 240e6 + 1e8 * (1 - 0.36787944)], rel=1e-7)


def test_the_schema_takes_files():
    strength = deck.schema()["$defs"]["Strength"]
    assert {"file", "code", "code_from"} <= set(strength["properties"])
    assert strength["if"]["not"] == {"required": ["file"]}
    assert {"yield_stress", "file"} <= set(strength["then"]["propertyNames"]["enum"])


FIELD = 'INTERNAL = (Field("softness", "", "body", "1", 1, "mass", True, "how soft it is", 0.0, 1.0),)'
INTERNAL = VOCE.replace("from hydro2d.base.parameters", "from hydro2d.mesh.fields import Field\nfrom hydro2d.base.parameters")
INTERNAL = INTERNAL.replace("EXAMPLE", f"{FIELD}\nEXAMPLE", 1)


WRITTEN = """
    from hydro2d.deck import deck
    from hydro2d.materials import quantities
    print(deck.load("shot.toml", ['output.fields=["softness"]']).output.fields)
    print(quantities.BY_KEY["softness"] in quantities.TABLE)
    print(*("softness" in quantities.expand([word]) for word in ("all", "standard")))
"""


def test_an_internal_variable_is_a_field_that_can_be_written(folder):
    (folder / "my_model.py").write_text(INTERNAL)
    assert python(WRITTEN, folder) == "('softness',)\nTrue\nTrue False\n"
    (folder / "my_model.py").write_text(INTERNAL.replace('"softness"', '"damage"'))
    assert "the internal variable damage has the name of a field" in python(WRITTEN, folder)


@pytest.mark.parametrize(("right", "wrong"), [('"body"', '"vertex"'), ('"mass"', '"bogus"'), (', 1, "', ', 7, "'),
                                              ('"softness"', '"soft ness"')])
def test_an_internal_variable_that_no_body_can_have_is_refused(folder, right, wrong):
    declared = INTERNAL[INTERNAL.index("INTERNAL = ") : INTERNAL.index("\nEXAMPLE")]
    assert right in declared, declared
    (folder / "my_model.py").write_text(INTERNAL.replace(declared, declared.replace(right, wrong)))
    assert 'centring is "body", remap is "mass" or "volume", parity is 1 or -1' in python(WRITTEN, folder)


# ------------------------------------------------------------------------------------------------ kernels

LATE = """
    import strength.dispatch, eos.dispatch
    import hydro2d
    from hydro2d.deck import deck
    from hydro2d.materials import library, outside
    loaded = deck.load("shot.toml")
    for late in (lambda: library.resolve(loaded), lambda: hydro2d.register("my_model.py")):
        try:
            late()
        except outside.ModelError as error:
            print(error)
"""


def test_a_model_that_comes_after_the_kernels_is_reported_when_it_is_used(folder):
    output = python(LATE, folder).splitlines()
    assert len(output) == 2
    kernels = "the kernels of this process were loaded without the strength model own-voce of my_model.py"
    assert output[0].startswith(f"material Al5083: {kernels}")
    assert "hydro2d.register" in output[1]
    assert "start a new process" in output[1]


CHOSEN = """
    import sys
    from hydro2d.jit import cache
    from hydro2d.deck import deck
    def folders():
        names = "deformation", "mixed", "remap", "vertex_forces"
        return [cache.folder_of(str(cache.ROOT / f"hydro2d/kernels/{name}.py")) for name in names]
    before = folders()
    loaded = deck.load("shot.toml")
    print(*(a == b for a, b in zip(before, folders(), strict=True)))
    from hydro2d.materials import library
    table = library.resolve(loaded)
    from strength import dispatch
    print(dispatch.STRENGTH_MODULES[-1].NAME, table.strength_model[0] == dispatch.STRENGTH_MODULES[-1].ID)
    print(dispatch.flow_stress(int(table.strength_model[0]), 0.0, 0.0, 300.0, 0.0, 2700.0, table.strength_par[0]))
    print("eos.dispatch" in sys.modules, len(cache._added["eos"]))
"""


def test_only_code_that_sees_the_model_is_compiled_anew(folder):
    """Kernels that do not choose among strength models use the cache of runs without models from outside."""
    assert python(CHOSEN, folder).split() == ["False", "False", "True", "True", "own-voce", "True", "240000000.0", "False", "0"]


PHASES = """
    from hydro2d.kernels import lagrangian_step, remap_step
    phases = lagrangian_step.deform, lagrangian_step.close_cells, lagrangian_step.accelerate, remap_step.find_moving
    print(*(phase.compiled.py_func.__code__.co_filename for phase in phases))
"""


def test_phases_that_see_the_model_are_kept_separately(folder):
    """They used to replace each other: every deck with another model, or with none, compiled them anew."""
    load = 'from hydro2d.deck import deck; deck.load("shot.toml")\n'
    without, given = python(PHASES, folder).split(), python(load + textwrap.dedent(PHASES), folder).split()
    assert [a == b for a, b in zip(without, given, strict=True)] == [False, False, True, True]


LOADED = """
    import sys
    ours = "deck.deck running.run running.check running.compile_ahead study.run.worker study.run.sweep results.reading cli.info"
    for name in ours.split():
        __import__(f"hydro2d.{name}")
    print({"eos.dispatch", "strength.dispatch"} & set(sys.modules))
"""


def test_steps_before_a_deck_do_not_load_the_kernels(tmp_path):
    assert python(LOADED, tmp_path) == "set()\n"


def test_workers_take_over_the_models_of_a_study(folder):
    """A worker loads the kernels with its first case, and by then has the models of all other cases."""
    (folder / "b.py").write_text(VOCE.replace('"own-voce"', '"b"'))
    models = json.dumps([(VOCE, "my_model.py", "strength"), ((folder / "b.py").read_text(), "b.py", "strength")])
    text = f"""
        import json
        from hydro2d.study.run.worker import Checkpoint
        Checkpoint(False, json.loads({models!r})).setup(None)
        import strength.dispatch
        from hydro2d.deck import deck
        from hydro2d.materials import library
        for name in ("my_model", "b"):
            library.resolve(deck.load("shot.toml", [f"materials.Al5083.strength.file={{name}}.py"]))
        print("fine", len(strength.dispatch.STRENGTH_MODULES))
    """
    assert python(text, folder).split()[0] == "fine"
    deck.load(folder / "shot.toml", [f"materials.Al5083.strength.file={folder}/b.py"])
    assert ((folder / "b.py").read_text(), "b.py", "strength") in outside.offered()


@pytest.mark.parametrize("command", ["check", "run"])
@pytest.mark.parametrize(("text", "old", "new", "said"), [
    (VOCE, "    par = np.zeros(ROW)", "    raise SystemExit(0)", "my_model.py:39: row raises SystemExit: 0"),
    (VOCE, "np.zeros(ROW)", "np.zeros(3)", "my_model.py: row gives float64 (3,), not float64 ("),
    (GAS, "return rho * e, e,", "return np.nan, e,", 'body "ball": cannot begin with a density of 1.2 kg/m^3'),
    (GAS, "return rho * e, e,", "return rho * e, -1e9,", "gas has no speed of sound"),
])
def test_a_command_says_in_a_line_what_is_wrong_with_a_model(folder, command, text, old, new, said):
    """`row` and `evaluate` are called only with the numbers of a deck."""
    assert old in text
    if text is GAS:
        start, end = DECK.index("[materials.Al5083]"), DECK.index("[stop]")
        gas = '[materials.gas.eos]\nfile = "my_model.py"\nreference_density = "1.2 kg/m^3"\n\n'
        (folder / "shot.toml").write_text(DECK[:start].replace('"Al5083"', '"gas"') + gas + DECK[end:])
    (folder / "my_model.py").write_text(text.replace(old, new))
    output = python(f"from hydro2d.cli.main import call; print(call(['{command}', 'shot.toml']))", folder)
    lines = output.splitlines()
    assert lines[-1] == "2" or lines[0] == "2", output
    (line,) = [line for line in lines if line.startswith("hydro2d: ")]
    assert said in line
    assert "Traceback" not in output


# ------------------------------------------------------------------------------------------------ packages


@pytest.fixture
def package(tmp_path):
    """A distribution with a model, in a folder of the path."""
    site = tmp_path / "site"
    (site / "my_models").mkdir(parents=True)
    (site / "my_models" / "__init__.py").write_text("")
    (site / "my_models" / "voce.py").write_text(VOCE)
    about = site / "my_models-1.2.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: my-models\nVersion: 1.2\n")
    (about / "entry_points.txt").write_text("[hydro2d.strength]\n" + "".join(
        f"{name} = my_models.{module}\n" for name, module in (("own-voce", "voce"), ("lost", "lost"), ("another", "voce"))))
    return site


def test_a_package_gives_models_by_name(folder, package):
    (folder / "shot.toml").write_text(DECK.replace('file = "my_model.py"', 'model = "own-voce"'))
    (folder / "wrong.toml").write_text(DECK.replace('file = "my_model.py"', 'model = "lost"'))
    (folder / "other.toml").write_text(DECK.replace('file = "my_model.py"', 'model = "another"'))
    (folder / "typo.toml").write_text(DECK.replace('file = "my_model.py"', 'model = "own-voze"'))
    text = """
        from hydro2d.cli.main import call
        from hydro2d.deck import deck
        from hydro2d.running import run
        from hydro2d.base.errors import DeckError
        print(run.models_from_outside(deck.load("shot.toml"))[0]["file"])
        for name in ("wrong", "other", "typo"):
            try:
                deck.load(f"{name}.toml")
            except DeckError as error:
                print(error)
        call(["info"])
        call(["info", "own-voce"])
        print("own-voce" in deck.schema()["$defs"]["Strength"]["properties"]["model"]["enum"])
        print("status", call(["check-model", "own-voce"]))
    """
    output = python(text, folder, package)
    assert output.startswith("my_models.voce (my-models 1.2)\n")
    assert "my_models.lost (my-models 1.2): the entry point lost names a module that cannot be found" in output
    assert "the entry point is called another and the model own-voce; the names must be the same" in output
    assert 'unknown strength model "own-voze"; did you mean "own-voce"?' in output
    assert re.search(r"^  own-voce +strength model from the package my-models", output, re.MULTILINE)
    assert "own-voce (strength model)\n\nY = Y0 + Q (1 - exp(-10 ep))" in output
    assert "\nTrue\n" in output
    assert output.endswith("own-voce: all checks passed\nstatus 0\n")


# ------------------------------------------------------------------------------------------------ a run

#: hydro2d's own models as files, and the results of a run with them
AS_FILES = """
    import hashlib, sys
    from pathlib import Path
    from hydro2d.deck import deck
    root = Path(deck.__file__).parents[2]
    chosen = ["stop.cycles=300", "failure.damage=material"]
    if sys.argv[1:] == ["files"]:
        models = {"eos": "eos/mie_grueneisen", "strength": "strength/johnson_cook", "damage": "strength/johnson_cook_damage"}
        for part, name in models.items():
            text = (root / f"{name}.py").read_text()
            Path(f"own_{part}.py").write_text(text.replace('NAME = "', 'NAME = "own-'))
            chosen += [f"materials.{metal}.{part}.file=own_{part}.py" for metal in ("ball", "plate")]
    loaded = deck.load("shot.toml", chosen)
    assert all(len(each.from_outside()) == 3 * len(sys.argv[1:]) for each in loaded.materials.values())
    from hydro2d.solver.simulation import Simulation
    simulation = Simulation(loaded)
    while simulation.stop_reason() is None:
        simulation.step()
    arrays = simulation.state.vof, simulation.state.q, simulation.state.u, simulation.state.v
    print(simulation.cycle, float(simulation.state.q[6].max()) > 0.1, hashlib.sha256(b"".join(map(bytes, arrays))).hexdigest())
"""
METAL = """\
based_on = "steel_4340"
variant = []
[materials.NAME.eos]
model = "mie-grueneisen"
reference_density = 7830
sound_speed = 4578
hugoniot_slope = 1.33
grueneisen = 1.67
specific_heat = 477
[materials.NAME.strength]
model = "johnson-cook"
shear_modulus = 77e9
yield_stress = 792e6
hardening = 510e6
hardening_exponent = 0.26
rate_coefficient = 0.014
thermal_exponent = 1.03
melt_temperature = 1793
[materials.NAME.damage]
model = "johnson-cook"
D1 = 0.05
D2 = 3.44
D3 = -2.12
D4 = 0.002
D5 = 0.61
melt_temperature = 1793
"""


@pytest.mark.slow
def test_models_of_hydro2d_as_files_give_the_same_bits(tmp_path):
    own = "".join(f"[materials.{name}]\n{METAL.replace('NAME', name)}" for name in ("ball", "plate"))
    plate = '[[body]]\nname = "plate"\nshape = "plate"\nmaterial = "plate"\nz_front = "4 mm"\nthickness = "2 mm"\n\n'
    text = DECK.replace('"Al5083"\nradius', '"ball"\nradius').replace("[materials.Al5083]", f"{plate}[materials.Al5083]")
    start, end = text.index("[materials.Al5083]"), text.index("[stop]")
    (tmp_path / "shot.toml").write_text(text[:start] + own + text[end:].replace("1 us", "1 ms"))
    programs = (f"import sys\nsys.argv[1:] = {given}\n{textwrap.dedent(AS_FILES)}" for given in ([], ["files"]))
    first, second = (python(program, tmp_path) for program in programs)
    assert first == second
    assert first.startswith("300 True ")
