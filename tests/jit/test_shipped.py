"""Compiled code shipped in a wheel: it is used wherever the package lies, and contains nothing of the user's."""

import importlib.util
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import types
from pathlib import Path

import llvmlite.binding
import numba
import pytest

from hydro2d.base.errors import TargetError
from hydro2d.files.whole import write_json
from hydro2d.jit import cache, shipped, target
from hydro2d.running import compile_all
from tests import error_output
from tests.jit.test_store import PROGRAM


def installed(place: Path) -> Path:
    """A copy of the packages, as in an installation."""
    for name in ("hydro2d", "eos", "strength"):
        shutil.copytree(cache.ROOT / name, place / name, ignore=shutil.ignore_patterns("__pycache__", "_compiled"))
    return place


def runs(site: Path, home: Path, **environment: str) -> tuple[str, list[str], set[str]]:
    """The program's output, the lines of its error output, and the names of the files of code in the user's cache then."""
    home.mkdir(exist_ok=True)
    (home / "program.py").write_text(PROGRAM)
    own = {name: value for name, value in os.environ.items() if not name.startswith("HYDRO2D_")}
    own |= {"HYDRO2D_CACHE_DIR": str(home / "cache"), "PYTHONPATH": str(site), **environment}
    done = subprocess.run([sys.executable, str(home / "program.py")], env=own, text=True, capture_output=True, check=True)
    names = {f"{file.parent.name}/{file.name}" for file in (home / "cache").glob("*/*.code")}
    return done.stdout.strip(), done.stderr.splitlines(), names


def ship(site: Path, home: Path) -> None:
    """Ships the user's cache as the compiled code of the package."""
    shutil.copytree(home / "cache", site / "hydro2d" / "_compiled")
    about = ("from hydro2d.jit import shipped; from hydro2d.files.whole import write_json\n"
             "write_json(shipped.SHIPPED / shipped.ABOUT, shipped.about())")
    own = {**os.environ, "HYDRO2D_TARGET": NAME, "PYTHONPATH": str(site)}
    subprocess.run([sys.executable, "-c", about], env=own, cwd=site, check=True)


NAME = target.named().name if target.named() else ""
needs_name = pytest.mark.skipif(not NAME or bool(target.named().missing()), reason="this processor has no named target")


@pytest.mark.thorough
@needs_name
def test_code_that_the_package_brings_is_used_at_another_path(tmp_path):
    """It is for the named target, which nobody has to ask for."""
    site, home = installed(tmp_path / "site"), tmp_path / "home"
    assert runs(site, home, HYDRO2D_TARGET=NAME)[:2] == ("6.0", [])
    ship(site, home)
    site = site.rename(tmp_path / "another")
    (site / "hydro2d" / "_compiled").chmod(0o555)
    new = tmp_path / "new"
    assert runs(site, new) == ("6.0", [], set())
    printed, (line,), compiled = runs(site, new, NUMBA_OPT="1")
    assert (printed, len(compiled)) == ("6.0", 2)
    assert line.startswith("hydro2d: the compiled code of the package is not used: it is for numba.config.OPT ")
    assert runs(site, new, NUMBA_OPT="1")[:2] == ("6.0", [])  # by then the user's cache has it
    printed, lines, compiled = runs(site, tmp_path / "native", HYDRO2D_TARGET="native")
    assert (printed, lines, len(compiled)) == ("6.0", [], 2)
    with (site / "hydro2d" / "jit" / "bits.py").open("a") as file:
        file.write("#\n")
    printed, (line,), compiled = runs(site, new)
    assert (printed, len(compiled)) == ("6.0", 4)
    assert line == "hydro2d: the compiled code of the package is used in part: its sources were changed"


@needs_name
def test_damaged_code_of_the_package_is_compiled_into_the_users_cache(tmp_path):
    site, home = installed(tmp_path / "site"), tmp_path / "home"
    runs(site, home, HYDRO2D_TARGET=NAME)
    ship(site, home)
    first, _ = sorted((site / "hydro2d" / "_compiled").glob("**/*.code"))
    first.write_bytes(first.read_bytes()[:-1])
    printed, (line,), compiled = runs(site, tmp_path / "new")
    assert (printed, compiled) == ("6.0", {f"{first.parent.name}/{first.name}"})
    assert line.startswith(f"hydro2d: {first} is damaged (its checksum does not match)")
    assert runs(site, tmp_path / "new")[1] == [line]  # a package is not written to


# ------------------------------------------------------------------------------------------------ which code is used


@pytest.fixture
def brought(tmp_path, monkeypatch):
    """A package with code for the named target of a processor that has AVX-512, and a cache; returns a change of about.json."""
    monkeypatch.setattr(shipped, "SHIPPED", tmp_path / "_compiled")
    monkeypatch.setattr(cache, "root", lambda: str(tmp_path / "cache"))
    monkeypatch.setattr(platform, "machine", lambda: "x86_64")
    has = dict.fromkeys((*target.named().features, shipped.WIDE), True)
    monkeypatch.setattr(llvmlite.binding, "get_host_cpu_features", lambda: has)
    (tmp_path / "_compiled").mkdir()

    def change(lacks: str = "", **changes: str) -> None:
        has.update({lacks: False} if lacks else {})
        named = target.named()
        write_json(tmp_path / "_compiled" / shipped.ABOUT,
                   {**shipped.about(), "processor": named.name, "features": named.flags, **changes})

    change()
    return change


def test_code_of_the_package_is_the_default_where_it_fits(brought):
    assert shipped.default() == target.named()
    brought(sources="0123")  # only functions whose sources are the same are taken
    assert shipped.default() == target.named()


@pytest.mark.parametrize("changes", [{"lacks": "avx2"}, {"numba": "0.61.0"}, {"Python": "cpython-39"}, {"processor": "znver4"},
                                     {"features": "+sse2"}, {"numba.config.OPT": "1"}])
def test_code_that_does_not_fit_is_not_the_default(changes, brought):
    brought(**changes)
    assert shipped.default() is None


@pytest.mark.parametrize("text", [None, "", "{", "[]", "{}", "1"])
def test_code_that_does_not_say_what_it_is_for_is_not_the_default(text, brought):
    (shipped.SHIPPED / shipped.ABOUT).unlink()
    if text is not None:
        (shipped.SHIPPED / shipped.ABOUT).write_text(text)
    assert shipped.default() is None


@pytest.mark.parametrize("option", ["CPU_NAME", "CPU_FEATURES"])
def test_numbas_own_choice_of_a_processor_is_kept(option, brought, monkeypatch):
    monkeypatch.setattr(numba.config, option, "")
    assert shipped.default() is None


def test_native_code_is_preferred_once_it_was_compiled_until_the_package_changes(brought, monkeypatch):
    Path(cache.root()).mkdir()
    shipped.prefer_native()
    assert shipped.default() is None
    with monkeypatch.context() as other:
        other.setattr(llvmlite.binding, "get_host_cpu_name", lambda: "another")  # a node of a cluster with the same home
        assert shipped.default() == target.named()
    brought(sources="of another version")
    assert shipped.default() == target.named()


def test_a_processor_that_lacks_something_is_said_in_one_line(brought, capsys):
    cache.say_once.cache_clear()
    shipped.say_if_unused.cache_clear()
    brought(lacks="avx2")
    shipped.say_if_unused()
    (line,) = error_output.lines(capsys.readouterr().err)
    assert line == ("hydro2d: the compiled code of the package is not used: it is for x86-64-v3, and this processor has no "
                    "avx2")


def test_faster_code_is_advised_once_in_every_cache(brought, monkeypatch):
    assert shipped.advice() == ""  # this process runs from a checkout
    monkeypatch.setattr(shipped, "IN_USE", True)
    assert shipped.advice().endswith("hydro2d compile --native")
    assert shipped.advice() == ""
    monkeypatch.setattr(cache, "root", lambda: "/proc/none")
    assert shipped.advice() == ""
    monkeypatch.setattr(cache, "root", lambda: str(shipped.SHIPPED))
    brought(lacks=shipped.WIDE)
    assert shipped.advice() == ""


# ------------------------------------------------------------------------------------------------ how it is made


@pytest.fixture
def nothing_compiled(tmp_path, monkeypatch):
    """`main` in an empty cache, where compilation makes a file of each kind; returns the cache."""
    def compiles(files):
        assert all(file.is_file() for file in files)
        folder = tmp_path / "cache" / "0123"
        folder.mkdir(parents=True)
        for name in ("a.code", "a.lock", "b.compiled"):
            (folder / name).write_bytes(b"")

    monkeypatch.setattr(cache, "root", lambda: str(tmp_path / "cache"))
    monkeypatch.setattr(compile_all, "compile_decks", compiles)
    monkeypatch.setattr(target, "PROCESSOR", target.named().name if target.named() else "none")
    return tmp_path / "cache"


@pytest.mark.skipif(target.named() is None, reason="this kind of machine has no named target")
def test_the_folder_of_a_wheel_has_code_and_what_it_is_for(nothing_compiled):
    compile_all.main()
    names = {file.relative_to(nothing_compiled).as_posix() for file in nothing_compiled.glob("**/*") if file.is_file()}
    assert names == {"0123/a.code", "about.json"}
    about = json.loads((nothing_compiled / "about.json").read_text())
    assert {name: about[name] for name in shipped.about()} == shipped.about()
    with pytest.raises(FileExistsError, match="is not empty"):
        compile_all.main()


def test_code_for_this_processor_alone_is_not_shipped(nothing_compiled, monkeypatch):
    monkeypatch.setattr(target, "PROCESSOR", "znver4")
    with pytest.raises(TargetError, match="code for znver4 runs on no other processor"):
        compile_all.main()
    assert not nothing_compiled.exists()


@pytest.mark.slow  # it compiles all kernels
@needs_name
def test_a_run_with_the_code_of_a_wheel_compiles_nothing(tmp_path):
    """Phases, what plays them, and what only outputs call: README's first run, and one with contact."""
    site = installed(tmp_path / "site")
    shutil.copytree(cache.ROOT / "problems", site / "problems")
    own = {name: value for name, value in os.environ.items() if not name.startswith(("HYDRO2D_", "NUMBA_"))}
    own |= {"PYTHONPATH": str(site), "HYDRO2D_CACHE_DIR": str(site / "hydro2d" / "_compiled"), "HYDRO2D_TARGET": NAME}
    subprocess.run([sys.executable, "-m", "hydro2d.running.compile_all"], cwd=site, env=own, check=True)
    own |= {"HYDRO2D_CACHE_DIR": str(tmp_path / "cache"), "HYDRO2D_TARGET": ""}
    for name in ("perforation/sphere", "sliding/block_level"):
        command = [sys.executable, "-m", "hydro2d", "run", f"problems/{name}.toml", "--set", "stop.cycles=400",
                   "--out", str(tmp_path / name)]
        done = subprocess.run(command, cwd=site, env=own, check=True, capture_output=True, text=True)
        assert "compil" not in (tmp_path / name / "log.txt").read_text().replace("hydro2d compile --native", "")
        assert done.stderr == ""
    assert not list((tmp_path / "cache").glob("*/*.code"))


class Interface:
    """The interface that hatchling gives a build hook."""

    def __init__(self, target_name="wheel"):
        self.target_name, self.root = target_name, str(cache.ROOT)
        self.metadata = types.SimpleNamespace(core=types.SimpleNamespace(dependencies=["numba>=0.61"]))


@pytest.fixture
def hook(monkeypatch):
    """The build hook's class, with the processes that it starts as `started`."""
    interface = types.ModuleType("interface")
    interface.BuildHookInterface = Interface
    monkeypatch.setitem(sys.modules, "hatchling.builders.hooks.plugin.interface", interface)
    spec = importlib.util.spec_from_file_location("hatch_build", cache.ROOT / "hatch_build.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.delenv("PIP_BUILD_TRACKER", raising=False)
    module.CompiledKernels.started = started = []
    monkeypatch.setattr(module.subprocess, "run", lambda command, **options: started.append((command, options)))
    return module.CompiledKernels


@pytest.mark.parametrize(("value", "by_pip", "machine", "kind", "version"), [
    ("", True, "x86_64", "wheel", "standard"), ("0", False, "x86_64", "wheel", "standard"),
    ("", False, "riscv64", "wheel", "standard"), ("1", False, "x86_64", "sdist", "standard"),
    ("1", True, "x86_64", "wheel", "editable")])
def test_nothing_is_compiled_unless_a_wheel_is_to_have_it(value, by_pip, machine, kind, version, hook, monkeypatch):
    """Not for `pip install .`, the sdist, an editable install, or a kind of machine without a named target."""
    monkeypatch.setenv("HYDRO2D_BUILD_COMPILED", value)
    if by_pip:
        monkeypatch.setenv("PIP_BUILD_TRACKER", "folder")
    monkeypatch.setattr(platform, "machine", lambda: machine)
    build, data = hook(kind), {"force_include": {}}
    build.initialize(version, data)
    build.finalize(version, data, "")
    assert (hook.started, data) == ([], {"force_include": {}})
    if version != "editable":
        assert build.dependencies() == []


@pytest.mark.parametrize(("value", "by_pip"), [("", False), ("1", True)])
@pytest.mark.parametrize("machine", ["x86_64", "aarch64"])
def test_a_wheel_is_compiled_for_the_named_target_by_nothing_of_the_users(machine, value, by_pip, hook, monkeypatch):
    """`python -m build` compiles unasked."""
    monkeypatch.setattr(platform, "machine", lambda: machine)
    monkeypatch.setenv("HYDRO2D_BUILD_COMPILED", value)
    if by_pip:
        monkeypatch.setenv("PIP_BUILD_TRACKER", "folder")
    for name in ("NUMBA_OPT", "HYDRO2D_CACHE_DIR"):
        monkeypatch.setenv(name, "1")
    build, data = hook(), {"force_include": {}}
    assert build.dependencies() == ["numba>=0.61"]
    build.initialize("standard", data)
    ((command, options),) = hook.started
    ((compiled, place),) = data["force_include"].items()
    own = options["env"]
    assert command[1:] == ["-m", "hydro2d.running.compile_all"]
    assert (place, own["HYDRO2D_CACHE_DIR"], own["PYTHONPATH"]) == ("hydro2d/_compiled", compiled, str(cache.ROOT))
    assert own["HYDRO2D_TARGET"] == target.named().name
    assert not {"NUMBA_OPT", "HYDRO2D_BUILD_COMPILED"} & set(own)
    assert Path(options["cwd"]).is_dir()
    build.finalize("standard", data, "")
    assert not Path(options["cwd"]).exists()


def test_a_build_that_cannot_compile_says_what_to_do(hook, monkeypatch):
    def fails(command, **options):
        hook.started.append(options["cwd"])
        raise subprocess.CalledProcessError(2, command)

    monkeypatch.setattr(subprocess, "run", fails)
    data = {"force_include": {}}
    with pytest.raises(SystemExit, match="HYDRO2D_BUILD_COMPILED=0 builds one without"):
        hook().initialize("standard", data)
    (folder,) = hook.started
    assert not Path(folder).exists()
    assert data == {"force_include": {}}


def test_the_build_knows_every_named_target():
    text = (cache.ROOT / "hatch_build.py").read_text(encoding="utf-8")
    known = dict(re.findall(r'"(\w+)": "([\w-]+)"', text[text.index("TARGETS ="):].splitlines()[0]))
    assert known == {"x86_64": target.NAMED["x86_64"].name, "aarch64": target.NAMED["aarch64"].name}
