"""The page "Add a model", followed word for word."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from problems.validation import bar
from tests.rules import source

PAGE = (source.ROOT / "docs" / "how-to" / "add-a-model.md").read_text(encoding="utf-8")
WALK = PAGE[: PAGE.index("## What the file must have")]


def blocks(language: str) -> list[str]:
    """The code of the walk in a language, in its order."""
    return re.findall(rf"```{language}\n(.*?)```", WALK, re.S)


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """The reader's folder, with what the page says to save in it."""
    made = tmp_path_factory.mktemp("walk")
    names = re.findall(r"Save this as `([\w.]+)`", WALK)
    for name, text in zip(names, [*blocks("python"), *blocks("toml")], strict=True):
        (made / name).write_text(text)
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
    assert "strength voce" in done.stdout
    assert done.returncode == 0


def test_the_walk(folder):
    """Runs, picture and lengths of the page; and Voce hardening that goes on for ever is the linear hardening of hydro2d."""
    for command in commands():
        done = typed(command, folder)
        assert done.returncode == 0, done.stderr
    assert (folder / "bars.png").is_file()
    voce, soft = (bar.measure(folder / name)["bars"][-1] for name in ("voce", "soft"))
    said = re.search(r"bar is (\S+) mm long and its foot (\S+) mm.*?hardening (\S+) and (\S+) mm", WALK, re.S).groups()
    assert tuple(f"{1e3 * value:.1f}" for value in (voce["length"], voce["foot"], soft["length"], soft["foot"])) == said
    strength = "--set materials.copper.strength"
    typed(f"hydro2d run bar.toml --out linear {strength}.saturation=100e9 {strength}.hardening_rate=1e-3", folder)
    own = 'model = "elastic-plastic"\nhardening_modulus = "100 MPa"'
    plain = re.sub("(saturation|hardening_rate).*", "", (folder / "bar.toml").read_text().replace('file = "my_model.py"', own))
    (folder / "plain.toml").write_text(plain)
    typed("hydro2d run plain.toml --out plain", folder)
    linear, plain = (bar.measure(folder / name)["bars"][-1] for name in ("linear", "plain"))
    assert linear["length"] == pytest.approx(plain["length"], rel=5e-4)
    assert linear["length"] < voce["length"] - 0.5e-3
