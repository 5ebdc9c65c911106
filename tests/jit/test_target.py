"""The processor that code is compiled for; code for another one, or with other options, is never used instead."""

import os
import platform
import subprocess
import sys

import llvmlite.binding
import numba
import pytest

from hydro2d.base.errors import TargetError
from hydro2d.files.whole import write_json
from hydro2d.jit import cache, shipped, target
from tests import error_output
from tests.jit import test_store

NAME = target.named().name if target.named() else ""
needs_name = pytest.mark.skipif(not NAME or bool(target.named().missing()), reason="this processor has no named target")


def in_process(code: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess:
    """A process of its own that runs the code."""
    return subprocess.run([sys.executable, "-c", code, *arguments], cwd=cache.ROOT, env={**os.environ, **environment},
                          capture_output=True, text=True, check=False)


def test_a_checkout_compiles_for_the_processor_at_hand(monkeypatch):
    for value in ("", "native"):
        monkeypatch.setenv("HYDRO2D_TARGET", value)
        assert target.asked_for() is None
    monkeypatch.delenv("HYDRO2D_TARGET")
    assert target.asked_for() is None


def test_a_target_that_is_not_there_is_an_error(monkeypatch):
    monkeypatch.setenv("HYDRO2D_TARGET", "x86-64-v9")
    with pytest.raises(TargetError, match=r"HYDRO2D_TARGET=x86-64-v9: must be native"):
        target.asked_for()
    command = [sys.executable, "-m", "hydro2d", "run", "problems/verification/sod_z.toml"]
    done = subprocess.run(command, cwd=cache.ROOT, text=True, capture_output=True, check=False)
    assert done.returncode == 2
    assert "HYDRO2D_TARGET=x86-64-v9" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(("machine", "name", "lacks"), [("x86_64", "x86-64-v3", "avx2"), ("aarch64", "generic", "neon")])
def test_missing_features_of_a_processor_are_named(machine, name, lacks, monkeypatch):
    monkeypatch.setattr(platform, "machine", lambda: machine)
    monkeypatch.setenv("HYDRO2D_TARGET", name)
    has = dict.fromkeys(target.named().features, True)
    monkeypatch.setattr(llvmlite.binding, "get_host_cpu_features", lambda: has)
    assert target.asked_for() == target.named()
    has[lacks] = False
    with pytest.raises(TargetError, match=f"this processor has no {lacks}"):
        target.asked_for()


@needs_name
def test_numba_compiles_for_the_target():
    """Its own functions are for the same processor: numba has one target in a process."""
    code = ("from hydro2d.jit import target; import numba\n"
            "f = numba.njit(lambda x: x + 1.0); f(1.0); (text,) = f.inspect_llvm().values()\n"
            "print(target.PROCESSOR, target.FEATURES, numba.core.registry.cpu_target.target_context.codegen().magic_tuple())")
    done = in_process(code, HYDRO2D_TARGET=NAME)
    assert done.stdout.split()[:2] == [NAME, target.named().flags]
    assert done.stdout.count(NAME) == 2


@needs_name
def test_a_program_that_has_used_numba_before_gets_a_message(tmp_path):
    """The target stays as it was, also in the names of the files."""
    done = in_process("import numba; numba.njit(lambda x: x)(1); from hydro2d.jit import target; print(target.PROCESSOR)",
                      HYDRO2D_TARGET=NAME)
    assert done.stdout.strip() == llvmlite.binding.get_host_cpu_name()
    assert f"not for {NAME}: numba was used before hydro2d was imported" in done.stderr
    assert len(done.stderr.splitlines()) == 1


#: variables of numba that change code, and the text that says that they differ from the default
CHANGES = {"NUMBA_OPT": "max", "NUMBA_LOOP_VECTORIZE": "0", "NUMBA_SLP_VECTORIZE": "1", "NUMBA_ENABLE_AVX": "0",
           "NUMBA_BOUNDSCHECK": "1", "NUMBA_DEBUGINFO": "1", "NUMBA_CPU_NAME": "x86-64", "NUMBA_CPU_FEATURES": "",
           "HYDRO2D_TARGET": NAME}
HARMLESS = {"NUMBA_FULL_TRACEBACKS": "1", "NUMBA_DEVELOPER_MODE": "0", "NUMBA_COLOR_SCHEME": "dark_bg"}


@needs_name
def test_options_that_change_code_change_the_folder():
    """Variables that only change reports do not."""
    code = "from hydro2d.jit import cache; print(cache.folder_for([cache.HERE / 'bits.py']))"
    processes = {name: subprocess.Popen([sys.executable, "-c", code], cwd=cache.ROOT, stdout=subprocess.PIPE, text=True,
                                        env={**os.environ, **({name: value} if name else {})})
                 for name, value in {"": "", **CHANGES, **HARMLESS}.items()}
    folders = {name: process.communicate()[0] for name, process in processes.items()}
    plain = folders.pop("")
    assert {name for name, folder in folders.items() if folder == plain} == set(HARMLESS)
    assert len({folders[name] for name in CHANGES}) == len(CHANGES)


@pytest.mark.parametrize(("module", "name"), [(numba, "__version__"), (target.llvmlite, "__version__")])
def test_other_versions_have_other_folders(module, name, monkeypatch):
    before = cache.folder_for([])
    monkeypatch.setattr(module, name, "0.1")
    assert cache.folder_for([]) != before


def test_the_folder_is_the_same_wherever_the_package_lies(tmp_path, monkeypatch):
    """A file is known by its path from the folder that contains hydro2d, not by its name alone."""
    for place in ("one", "two"):
        for name in ("eos/a.py", "strength/a.py"):
            (tmp_path / place / name).parent.mkdir(parents=True)
            (tmp_path / place / name).write_text(f"NAME = '{name}'\n")
    names = []
    for place in ("one", "two"):
        monkeypatch.setattr(cache, "ROOT", tmp_path / place)
        names.append(cache.folder_for([tmp_path / place / "eos/a.py", tmp_path / place / "strength/a.py"]))
    assert names[0] == names[1]
    one, other = (tmp_path / "two" / name for name in ("eos/a.py", "strength/a.py"))
    texts = one.read_text(), other.read_text()
    one.write_text(texts[1])
    other.write_text(texts[0])
    assert cache.folder_for([one, other]) != names[0]


# ------------------------------------------------------------------------------------------------ the same bits

BITS = """
import hashlib
import numpy as np
from hydro2d import jit

@jit.kernel
def formulas(a, b):
    for i in range(a.shape[0]):
        b[i] = jit.exp(a[i]) * jit.power(a[i], 0.3) - jit.log(a[i]) / (1.0 + a[i] * a[i]) + (a[i] + 0.1) * 0.7

a = np.random.default_rng(1).random(1001) * 5.0
b = np.empty_like(a)
formulas(a, b)
print(hashlib.sha256(b).hexdigest(), jit.target.PROCESSOR)
"""


@needs_name
def test_formulas_have_the_same_bits_on_another_target(tmp_path):
    """A product and a sum are not fused, however wide the vectors are."""
    (tmp_path / "bits.py").write_text(BITS)
    code = f"import runpy; runpy.run_path({str(tmp_path / 'bits.py')!r})"
    (bits, processor), (others, other) = (in_process(code, HYDRO2D_TARGET=name).stdout.split() for name in (NAME, "native"))
    assert bits == others
    assert processor == NAME != other


STATE = """
import hashlib
import sys
from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.mesh.fields import FIELDS
from hydro2d.solver.simulation import Simulation

simulation = Simulation(deck.load(f"problems/{sys.argv[1]}.toml"))
while simulation.cycle < 150:
    simulation.advance(cycles=150 - simulation.cycle)
digest = hashlib.sha256(simulation.time.hex().encode())
for field in FIELDS:
    digest.update(getattr(simulation.state, field.symbol).tobytes())
print(digest.hexdigest(), jit.target.PROCESSOR)
"""


@pytest.mark.slow  # it compiles all kernels for each of the two, where the cache has none
@needs_name
@pytest.mark.parametrize("deck", ["sliding/block_level", "perforation/sphere"])
def test_a_run_has_the_same_bits_on_another_target(deck):
    """With the code that wheels bring as with that for the processor at hand."""
    (bits, processor), (others, other) = (in_process(STATE, deck, HYDRO2D_TARGET=name).stdout.split()
                                          for name in (NAME, "native"))
    assert bits == others
    assert processor == NAME != other


# ------------------------------------------------------------------------------------------------ shipped


@pytest.fixture
def brought(tmp_path, monkeypatch, capsys):
    """A package with compiled code, of which a test changes the target; returns the message."""
    monkeypatch.setattr(shipped, "SHIPPED", tmp_path / "_compiled")
    (tmp_path / "_compiled").mkdir()

    def said(text: str | None = None, **changes: str) -> list[str]:
        cache.say_once.cache_clear()
        shipped.say_if_unused.cache_clear()
        file = tmp_path / "_compiled" / shipped.ABOUT
        write_json(file, {**shipped.about(), **changes}) if text is None else file.write_text(text)
        compiled = test_store.made(test_store.add, tmp_path / "_compiled" / "folder", tmp_path / "own")
        compiled._cache.flush()
        compiled(1.0)
        test_store.made(test_store.multiply, tmp_path / "_compiled" / "folder", tmp_path / "own")(1.0)
        return error_output.lines(capsys.readouterr().err)

    return said


def test_shipped_code_that_fits_needs_no_words(brought):
    assert brought() == []


@pytest.mark.parametrize(("changes", "said"), [
    ({"numba": "0.61.0"}, "is not used: it is for numba 0.61.0, here is "),
    ({"Python": "cpython-39"}, "is not used: it is for Python cpython-39, here is "),
    ({"processor": "sapphirerapids"}, "is not used: it is for processor sapphirerapids, here is "),
    ({"numba.config.BOUNDSCHECK": "1"}, "is not used: it is for numba.config.BOUNDSCHECK 1, here is None"),
    ({"sources": "0123"}, "is used in part: its sources were changed"),
])
def test_shipped_code_for_something_else_is_said_in_one_line(changes, said, brought):
    (line,) = brought(**changes)
    assert line.startswith(f"hydro2d: the compiled code of the package {said}")


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", "1"])
def test_code_without_a_target_is_not_used(text, brought):
    (line,) = brought(text)
    assert "about.json" in line
    assert "does not say what it is for" in line
