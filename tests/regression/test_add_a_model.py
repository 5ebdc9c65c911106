"""The page "Add a model", followed word for word."""

import os
import re
import shlex
import subprocess
import sys
import types
from pathlib import Path

import numpy as np
import pytest

import hydro2d
from hydro2d.mesh.grid import Grid
from problems.validation import bar
from tests.rules import source

PAGE = (source.ROOT / "docs" / "how-to" / "add-a-model.md").read_text(encoding="utf-8")
WALK = PAGE[: PAGE.index("## What the file must have")]
MEMORY = PAGE[PAGE.index("## An equation of state with memory"): PAGE.index("## A source of energy")]
SOURCE = PAGE[PAGE.index("## A source of energy"): PAGE.index("## An edge of the mesh")]


def blocks(language: str, text: str = WALK) -> list[str]:
    """The code of a walk-through in a language, in order."""
    return re.findall(rf"```{language}\n(.*?)```", text, re.S)


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """The reader's folder, with the files that the page says to save in it."""
    made = tmp_path_factory.mktemp("walk")
    names = re.findall(r"Save this as `([\w.]+)`", WALK)
    for name, text in zip(names, [*blocks("python"), *blocks("toml")], strict=True):
        (made / name).write_text(text)
    return made


@pytest.fixture(scope="module")
def burning(tmp_path_factory) -> Path:
    """The reader's folder of the equation of state with memory."""
    made = tmp_path_factory.mktemp("burning")
    (made / "burning.py").write_text(blocks("python", MEMORY)[0])
    (made / "burn.toml").write_text(blocks("toml", MEMORY)[0])
    return made


def typed(command: str, folder: Path) -> subprocess.CompletedProcess:
    """A command of the page in the reader's folder."""
    program, *arguments = shlex.split(command)
    assert program == "hydro2d"
    command = [sys.executable, "-m", "hydro2d", *arguments]
    variables = {**os.environ, "PYTHONPATH": str(source.ROOT)}
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=variables)


def commands() -> list[str]:
    return [line for block in blocks("sh") for line in block.splitlines()]


def test_the_check_prints_what_the_page_shows(folder):
    done = typed(commands()[0], folder)
    assert (done.stdout, done.returncode) == (blocks("text")[0], 0)


@pytest.mark.thorough
def test_the_mistakes_of_the_page_are_found(folder):
    text = (folder / "my_model.py").read_text()
    (folder / "short.py").write_text(text.replace("(ep, rate, T, p, rho, par)", "(ep, rate)"))
    said = re.search(r"such as\s+`(my_model.py: flow_stress.*?)`", WALK, re.S)[1]
    assert typed("hydro2d check-model short.py", folder).stderr.split()[2:] == said.split()[1:]
    assert text.count("1.0 - math.exp") == 1
    (folder / "softens.py").write_text(text.replace("1.0 - math.exp", "math.exp"))
    done = typed("hydro2d check-model softens.py", folder)
    assert "FAILED    strain and strain rate harden" in done.stdout
    assert done.returncode == 2


def test_the_deck_is_in_order(folder):
    assert "`hydro2d check bar.toml`" in WALK
    done = typed("hydro2d check bar.toml", folder)
    assert "strength own-voce" in done.stdout
    assert done.returncode == 0


@pytest.mark.thorough
def test_the_walk(folder):
    """Runs, picture and lengths of the page; unbounded Voce hardening equals hydro2d's linear hardening."""
    for command in commands():
        done = typed(command, folder)
        assert done.returncode == 0, done.stderr
    assert (folder / "bars.png").is_file()
    voce, soft = (bar.measure(folder / name)["bars"][-1] for name in ("voce", "soft"))
    said = re.search(r"bar is (\S+) mm long and its foot (\S+) mm.*?hardening (\S+) and (\S+) mm", WALK, re.S).groups()
    assert tuple(f"{1e3 * value:.1f}" for value in (voce["length"], voce["foot"], soft["length"], soft["foot"])) == said
    strength = "--set materials.copper.strength"
    typed(f"hydro2d run bar.toml --out linear {strength}.saturation='100 GPa' {strength}.hardening_rate=1e-3", folder)
    own = 'model = "elastic-plastic"\nhardening_modulus = "100 MPa"'
    plain = re.sub("(saturation|hardening_rate).*", "", (folder / "bar.toml").read_text().replace('file = "my_model.py"', own))
    (folder / "plain.toml").write_text(plain)
    typed("hydro2d run plain.toml --out plain", folder)
    linear, plain = (bar.measure(folder / name)["bars"][-1] for name in ("linear", "plain"))
    assert linear["length"] == pytest.approx(plain["length"], rel=5e-4)
    assert linear["length"] < voce["length"] - 0.5e-3


@pytest.mark.thorough
def test_an_equation_of_state_with_memory(burning):
    """The check passes, and the gauge of the page shows the pressures of the page."""
    check, run = (block.strip() for block in blocks("sh", MEMORY))
    done = typed(check, burning)
    assert "burning: all checks passed" in done.stdout, done.stdout
    assert "passed    internal variables stay as they are while nothing happens" in done.stdout
    done = typed(run, burning)
    assert done.returncode == 0, done.stderr
    history = hydro2d.open_run(burning / "burnt").history
    time, pressure = history["time"], history["gauge_wall_pressure_Pa"]
    said = re.search(r"After 5 us the gauge shows (\d+) MPa, after 10 us and from then on (\d+) MPa", MEMORY)
    half, whole = (float(number) * 1e6 for number in said.groups())
    np.testing.assert_allclose(np.interp([5e-6, 11.5e-6], time, pressure), [half, whole], rtol=1e-2)
    np.testing.assert_allclose(pressure[time > 10.1e-6], whole, rtol=1e-9)


@pytest.mark.thorough
def test_a_mistake_in_one_with_memory_is_found(burning):
    text = (burning / "burning.py").read_text()
    (burning / "short.py").write_text(text.replace("def evaluate(rho, e, internal, par)", "def evaluate(rho, e, par)"))
    assert "evaluate takes (rho, e, par), not (rho, e, internal, par)" in typed("hydro2d check-model short.py", burning).stderr
    (burning / "unburns.py").write_text(text.replace("time * par[RATE]), 1.0)", "time * par[RATE]), 1.0) - 1e-3"))
    done = typed("hydro2d check-model unburns.py", burning)
    assert "FAILED    internal variables stay as they are" in done.stdout
    assert done.returncode == 2


def test_a_source():
    """The kind of the page as a section of a deck, and its energy: dose times the lit part of the depth."""
    space: dict = {"__name__": "flash"}
    sys.modules["flash"] = types.ModuleType("flash")
    exec(compile(blocks("python", SOURCE)[0], "flash.py", "exec"), space)
    flash = space["Flash"](name="flash", kind="flash", body="plate", z=["5 mm", "15 mm"], dose="1 MJ/kg", absorption="1 mm",
                           duration="0.2 us")
    assert "`Flash` into `KINDS`" in SOURCE
    grid = Grid(np.linspace(0.0, 4e-3, 5), np.linspace(0.0, 20e-3, 401), "planar")
    half, rest, after = (flash.heat(grid, *step) for step in ((0.0, 0.1e-6), (0.1e-6, 0.3e-6), (0.4e-6, 0.1e-6)))
    assert half.sum() == pytest.approx(0.5 * half.shape[1] * 1e6 * 1e-3 / 0.05e-3 * (1.0 - np.exp(-10.0)), rel=1e-3)
    np.testing.assert_allclose(rest, half, rtol=1e-12)
    assert not after.any()
    assert not half[:99].any()
