"""Models from outside: requirements on their files, and the results of checking them."""

import hashlib
import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from hydro2d.cli.main import call
from hydro2d.materials import outside
from tests import error_output
from tests.materials.made_models import GAS, STRAIN, VOCE, python

ROOT = Path(__file__).parents[2]

# ------------------------------------------------------------------------------------------------ files


@pytest.mark.parametrize(("text", "part"), [(VOCE, "strength"), (GAS, "eos"), (STRAIN, "damage")])
def test_a_file_says_what_it_is_a_model_of(tmp_path, text, part):
    (tmp_path / "model.py").write_text(text)
    model = outside.read(tmp_path / "model.py")
    assert (model.kind.part, model.file, model.text) == (part, "model.py", text)
    assert model.module.ID >= outside.FIRST_ID
    assert model.about()["sha256"] == hashlib.sha256(text.encode()).hexdigest()


def test_the_id_follows_from_the_text_alone(tmp_path):
    """Processes that load models in another order, or under other file names, compile the same code."""
    (tmp_path / "a.py").write_text(VOCE)
    (tmp_path / "b.py").write_text(VOCE)
    assert outside.read(tmp_path / "a.py").module is outside.read(tmp_path / "b.py").module
    ids = "from hydro2d.materials import outside; print([outside.read(name).module.ID for name in ('{}', '{}')])"
    (tmp_path / "c.py").write_text(GAS)
    first, second = (json.loads(python(ids.format(*names), tmp_path)) for names in (("a.py", "c.py"), ("c.py", "b.py")))
    assert first[0] != first[1]
    assert first == second[::-1] == [outside.read(tmp_path / name).module.ID for name in ("a.py", "c.py")]


WRONG = [
    (VOCE, "import math", "import maths", ":3: imports maths; a model may import numpy, Python's own modules"),
    (VOCE, "import math", "import numba", ":3: imports numba"),
    (VOCE, "import math", "from . import other", ":3: imports .other"),
    (VOCE, "import math", "from eos import layout", ":3: imports eos.layout"),
    (VOCE, "import math", "from strength import dispatch", "but not those that choose"),
    (VOCE, "import math", "import math, json.nothing", ":3: cannot be imported: ModuleNotFoundError: No module named"),
    (VOCE, "CONSTANT_MODULUS = True", "CONSTANT_MODULUS = Tru", ":12: cannot be imported: NameError: name 'Tru'"),
    (VOCE, "CONSTANT_MODULUS = True", "CONSTANT_MODULUS =", ":12: is not Python: invalid syntax"),
    (VOCE, "CONSTANT_MODULUS = True\n", "", "needs CONSTANT_MODULUS, True or False"),
    (VOCE, 'NAME = "own-voce"', "", "needs NAME, a text"),
    (VOCE, '"own-voce"', '"johnson-cook"', "the NAME 'johnson-cook' is taken by a strength model of hydro2d"),
    (VOCE, '"own-voce"', '"my model"', "the NAME 'my model' has blanks"),
    (VOCE, 'SOURCE = "Voce', 'SOURCE = "" #', "needs SOURCE, a text"),
    (VOCE, "PARAMETERS = (", "PARAMETERS = (1.0,", "needs PARAMETERS, a tuple of hydro2d.base.parameters.Parameter"),
    (VOCE, '"saturation", "Pa", 0.0', '"shear_modulus", "Pa", 0.0', "has the parameter shear_modulus twice"),
    (VOCE, '"saturation", "Pa", 0.0', '"code", "Pa", 0.0', "has a parameter 'code', which cannot be a key"),
    (VOCE, "def row(", "def rows(", "needs a function row(values)"),
    (VOCE, "def shear_modulus(", "def modulus(", "needs a function shear_modulus(p, rho, T, par)"),
    (VOCE, "(ep, rate, T, p, rho, par)", "(ep, rate, p, T, rho, par)", "flow_stress takes (ep, rate, p, T, rho, par), not ("),
    (VOCE, "@point\ndef flow", "def flow", "flow_stress is not compiled: put @point before it"),
    (VOCE, '    """Flow stress, Pa."""\n', "",
     f"flow_stress, line {VOCE.split('def flow')[0].count(chr(10))}, has no docstring: write what the function returns"),
    (VOCE, "math.exp(", "math.expo(", "flow_stress does not compile: module 'math' has no attribute 'expo'"),
    (VOCE, "math.exp(", "nothing(", "flow_stress does not compile: NameError: name 'nothing' is not defined"),
    (VOCE, "return par[SHEAR]", "return par", "shear_modulus returns array(float64, 1d, C), not one number"),
    (VOCE, "return par[SHEAR]", "return 1", "shear_modulus returns Literal[int](1), not one number (write 1.0, not 1"),
    (VOCE, "    return par[SHEAR]", "    if p > 0.0:\n        return par[SHEAR]", "returns OptionalType(float64)"),
    (GAS, "return rho * e, e, rho, max(e, 0.0) / 700.0", "return rho * e, e, rho", "not 4 numbers"),
    (GAS, '"reference_density", "kg', '"density", "kg', "needs the parameter reference_density"),
    (STRAIN, "THERMAL = False", "THERMAL = 0", "needs THERMAL, True or False"),
    (VOCE, "def row(", "raise GeneratorExit\ndef row(", ":37: cannot be imported: GeneratorExit"),
    (VOCE, "def row(", "import sys\nsys.exit(0)\ndef row(", ":38: cannot be imported: SystemExit: 0"),
    (VOCE, "def row(", "open('/nowhere/table')\ndef row(", ":37: cannot be imported: FileNotFoundError"),
    (VOCE, "def row(", "class Mute(Exception):\n    def __str__(self): return self.none\nraise Mute\ndef row(",
     ":39: cannot be imported: Mute"),
    (VOCE, "def row(", f"x = {'-' * 100000}1\ndef row(", ":1: cannot be imported: MemoryError"),
    (VOCE, "    return par[YIELD]", "    assert ep >= 0.0\n    return par[YIELD]", ":34: flow_stress raises an exception"),
    (VOCE, "    return par[YIELD]", "    print(ep)\n    return par[YIELD]", ":34: flow_stress prints, which a kernel cannot"),
    (VOCE, "    return par[YIELD]", "    par[0] = ep\n    return par[YIELD]", ":34: flow_stress writes into par"),
    (VOCE, "    return par[YIELD]", "    return [ep, 1.0][0] + par[YIELD]", "flow_stress does not compile: it makes an array"),
    (VOCE, '"Pa", 0.0,', '"Pa", "much",', "the default of the parameter saturation is 'much', not a number or REQUIRED"),
    (VOCE, 'adds at most", "Q"', 'adds at most", "Q", "positve"', "the sign of the parameter saturation is 'positve'"),
]


@pytest.mark.parametrize(("text", "old", "new", "said"), WRONG)
def test_a_mistake_in_the_file_is_one_line_with_its_reason(tmp_path, capsys, text, old, new, said):
    assert old in text
    file = tmp_path / "model.py"
    file.write_text(text.replace(old, new))
    part = {"own-voce": "strength", "gamma-two": "eos", "strain": "damage"}[text.split('NAME = "')[1].split('"')[0]]
    with pytest.raises(outside.ModelError) as error:
        outside.read(file, part)
    assert str(error.value).startswith(str(file))
    assert said in str(error.value)
    assert "\n" not in str(error.value)
    assert call(["check-model", str(file), "--as", part]) == 2
    assert error_output.lines(capsys.readouterr().err) == [f"hydro2d: {error.value}"]


def test_files_that_are_no_models(tmp_path):
    (tmp_path / "bytes.py").write_bytes(b"\xff\xfe\x00")
    (tmp_path / "empty.py").write_text("")
    for name, said in (("none.py", "cannot be read: No such file"), ("bytes.py", "is not UTF-8"), ("empty.py", "has none of")):
        with pytest.raises(outside.ModelError, match=said):
            outside.read(tmp_path / name)


ROWS = [
    (VOCE, "    par = np.zeros(ROW)", "    raise KeyError('colour')", ":39: row raises KeyError: 'colour'"),
    (VOCE, "    par = np.zeros(ROW)", "    raise SystemExit(0)", ":39: row raises SystemExit: 0"),
    (VOCE, "np.zeros(ROW)", "np.zeros(3)", ": row gives float64 (3,), not float64 ("),
    (VOCE, "    return par\n", "    return list(par)\n", ": row gives list , not float64 ("),
    (VOCE, "    return par\n", "    par[2] = math.nan\n    return par\n", ": row has NaN in slot 2"),
    (GAS, "    return par\n", "    par[0] = 2.0\n    return par\n", ": slot RHO0 = 0 of the row is 2, not reference_density"),
]


@pytest.mark.parametrize(("text", "old", "new", "said"), ROWS)
def test_a_row_that_kernels_cannot_read_is_one_line_with_its_reason(text, old, new, said):
    """A short row used to move the numbers of all models behind it."""
    assert old in text
    model = outside.from_text(text.replace(old, new), "model.py", "strength" if text is VOCE else "eos")
    with pytest.raises(outside.ModelError) as error:
        model.row(model.module.EXAMPLE)
    assert str(error.value).startswith(f"model.py{said}")
    assert "\n" not in str(error.value)


def test_a_model_that_never_ends_is_ended_by_an_interrupt(tmp_path):
    (tmp_path / "model.py").write_text(VOCE.replace("def row(", "print('begun', flush=True)\nwhile True: pass\ndef row("))
    process = subprocess.Popen([sys.executable, "-m", "hydro2d", "check-model", str(tmp_path / "model.py")], cwd=ROOT,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    process.send_signal(signal.SIGTERM)
    assert process.communicate(timeout=30) == ("", "")
    assert process.returncode == 143


# ------------------------------------------------------------------------------------------------ the contract


CHECK = "from hydro2d.cli.main import call; print(call(['check-model', 'model.py']))"


@pytest.mark.thorough
@pytest.mark.parametrize("text", [VOCE, GAS, STRAIN])
def test_check_model_passes_a_good_one(tmp_path, text):
    (tmp_path / "model.py").write_text(text)
    output = python(CHECK, tmp_path)
    assert output.endswith("all checks passed\n0\n")
    assert "FAILED" not in output


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("text", "old", "new", "said"),
    [
        (VOCE, "1.0 - math.exp(", "math.exp(", "the flow stress falls from plastic strain 0 to 1e-12"),
        (VOCE, "return par[SHEAR]", "return par[SHEAR] + p", "not slot SHEAR of the row"),
        (VOCE, "collect(NAME, PARAMETERS, values)", "{**dict(saturation=0.0), **values}", 'unknown parameter "colour"'),
        (GAS, "max(e, 0.0) / 700.0", "300.0", "dT/drho is 0"),
        (STRAIN, "dep / par[0]", "(dep + 1e-9) / par[0]", "without plastic strain"),
    ],
)
def test_check_model_finds_what_is_wrong(tmp_path, text, old, new, said):
    assert old in text
    (tmp_path / "model.py").write_text(text.replace(old, new))
    output = python(CHECK, tmp_path)
    assert "  FAILED " in output
    assert said in output
    assert output.endswith("failed\n2\n")


def test_check_model_needs_an_example(tmp_path):
    (tmp_path / "model.py").write_text(VOCE.replace("EXAMPLE", "EXAMPLES"))
    output = python(CHECK, tmp_path)
    assert "needs EXAMPLE, parameters in SI to try it with" in output
    assert "\n2\n" in output
