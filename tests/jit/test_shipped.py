"""Compiled code shipped in a wheel: it is used wherever the package lies, and contains nothing of the user's."""

import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import types
from pathlib import Path

import pytest

from hydro2d.base.errors import TargetError
from hydro2d.jit import cache, target
from hydro2d.running import compile_all
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
    about = ("from hydro2d.jit import cache; from hydro2d.files.whole import write_json\n"
             "write_json(cache.SHIPPED / cache.ABOUT, cache.about())")
    subprocess.run([sys.executable, "-c", about], env={**os.environ, "PYTHONPATH": str(site)}, cwd=site, check=True)


@pytest.mark.thorough
def test_code_that_the_package_brings_is_used_at_another_path(tmp_path):
    site, home = installed(tmp_path / "site"), tmp_path / "home"
    assert runs(site, home)[:2] == ("6.0", [])
    ship(site, home)
    site = site.rename(tmp_path / "another")
    (site / "hydro2d" / "_compiled").chmod(0o555)
    new = tmp_path / "new"
    assert runs(site, new) == ("6.0", [], set())
    printed, (line,), compiled = runs(site, new, NUMBA_OPT="1")
    assert (printed, len(compiled)) == ("6.0", 2)
    assert line.startswith("hydro2d: the compiled code of the package is not used: it is for numba.config.OPT ")
    assert runs(site, new, NUMBA_OPT="1")[:2] == ("6.0", [])  # by then the user's cache has it
    with (site / "hydro2d" / "jit" / "bits.py").open("a") as file:
        file.write("#\n")
    printed, (line,), compiled = runs(site, new)
    assert (printed, len(compiled)) == ("6.0", 4)
    assert line == "hydro2d: the compiled code of the package is used in part: its sources were changed"


def test_damaged_code_of_the_package_is_compiled_into_the_users_cache(tmp_path):
    site, home = installed(tmp_path / "site"), tmp_path / "home"
    runs(site, home)
    ship(site, home)
    first, _ = sorted((site / "hydro2d" / "_compiled").glob("**/*.code"))
    first.write_bytes(first.read_bytes()[:-1])
    printed, (line,), compiled = runs(site, tmp_path / "new")
    assert (printed, compiled) == ("6.0", {f"{first.parent.name}/{first.name}"})
    assert line.startswith(f"hydro2d: {first} is damaged (its checksum does not match)")
    assert runs(site, tmp_path / "new")[1] == [line]  # a package is not written to


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
    assert {name: about[name] for name in cache.about()} == cache.about()
    with pytest.raises(FileExistsError, match="is not empty"):
        compile_all.main()


def test_code_for_this_processor_alone_is_not_shipped(nothing_compiled, monkeypatch):
    monkeypatch.setattr(target, "PROCESSOR", "znver4")
    with pytest.raises(TargetError, match="code for znver4 runs on no other processor"):
        compile_all.main()
    assert not nothing_compiled.exists()


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
    module.CompiledKernels.started = started = []
    monkeypatch.setattr(module.subprocess, "run", lambda command, **options: started.append((command, options)))
    return module.CompiledKernels


@pytest.mark.parametrize(("value", "kind", "version"), [("", "wheel", "standard"), ("0", "wheel", "standard"),
                                                        ("1", "sdist", "standard"), ("1", "wheel", "editable")])
def test_nothing_is_compiled_unless_a_wheel_is_to_have_it(value, kind, version, hook, monkeypatch):
    """Not for `pip install .`, the sdist or an editable install."""
    monkeypatch.setenv("HYDRO2D_BUILD_COMPILED", value)
    build, data = hook(kind), {"force_include": {}}
    build.initialize(version, data)
    build.finalize(version, data, "")
    assert (hook.started, data) == ([], {"force_include": {}})
    if version != "editable":
        assert build.dependencies() == []


def test_a_wheel_is_compiled_for_the_named_target_by_nothing_of_the_users(hook, monkeypatch):
    for name in ("HYDRO2D_BUILD_COMPILED", "NUMBA_OPT", "HYDRO2D_CACHE_DIR"):
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


def test_the_build_knows_every_named_target():
    text = (cache.ROOT / "hatch_build.py").read_text(encoding="utf-8")
    known = dict(re.findall(r'"(\w+)": "([\w-]+)"', text[text.index("TARGETS ="):].splitlines()[0]))
    assert known == {"x86_64": target.NAMED["x86_64"].name, "aarch64": target.NAMED["aarch64"].name}
