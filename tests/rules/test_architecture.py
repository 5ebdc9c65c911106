"""The tables of the page of the architecture: layers as `test_imports` has them, and the files of each line of a cycle."""

import ast
import importlib
import inspect
import re
import textwrap

import pytest

from hydro2d.kernels import between_phases, lagrangian_step, remap_step
from hydro2d.solver.cycle import Cycle
from tests.rules import source
from tests.rules.test_imports import LAYERS, within

PAGE = (source.ROOT / "docs/explanation/architecture.md").read_text(encoding="utf-8")
PHASES = {"lagrangian_step": lagrangian_step, "remap_step": remap_step, "between_phases": between_phases}


def rows(heading: str) -> list[list[str]]:
    """The cells of the table below a heading."""
    section = PAGE.split(f"## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[1:]]


FOLDERS, CYCLE = rows("The folders"), rows("One cycle")


def module(path: str) -> str:
    """Dotted name of a folder or a file as the table has it."""
    name = path.removesuffix(".py").strip("/").replace("/", ".")
    return name if name in ("eos", "strength") else f"hydro2d.{name}"


def named(cell: str) -> list[str]:
    """The files and folders in a cell, with those in a folder by their paths."""
    here, *inside = re.split(r"in `(\w+)` ", cell)
    at_once = re.findall(r"`([\w/]+(?:\.py|/))`", here)
    return at_once + [f"{folder}/{name}" for folder, names in zip(inside[::2], inside[1::2], strict=True)
                    for name in re.findall(r"`(\w+\.py)`", names)]


def test_the_layers_are_those_of_the_rule():
    table = [{module(path) for number, cell, _ in FOLDERS if int(number) == k + 1 for path in named(cell)}
             for k in range(len(LAYERS))]
    assert table == [set(places) for places in LAYERS]
    numbers = [int(number) for number, *_ in FOLDERS]
    assert numbers == sorted(numbers)


def test_every_folder_is_named():
    said = " ".join(cell for row in FOLDERS for cell in row)
    folders = {".".join(name.split(".")[:-1]) for name in source.modules() if "." in name} - {"hydro2d", "eos", "strength"}
    paths = [folder.removeprefix("hydro2d.").replace(".", "/") for folder in folders if not within(folder, "eos", "strength")]
    assert [path for path in sorted(paths) if f"`{path}/`" not in said and f"`{path}`" not in said] == []


def phases(function) -> set[str]:
    """The phases that a method of the cycle runs."""
    syntax = ast.parse(textwrap.dedent(inspect.getsource(function)))
    return {f"{node.value.id}.{node.attr}" for node in ast.walk(syntax)
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in PHASES}


def kernels(method: str) -> set[str]:
    """Modules of the kernels in the phases that a line of `Cycle._step` runs."""
    lists = [getattr(PHASES[phase.split(".")[0]], phase.split(".")[1]) for phase in phases(getattr(Cycle, method))]
    return {run.kernel.__module__ for phase in lists for run in phase.runs()}


@pytest.mark.parametrize("row", CYCLE, ids=lambda row: row[0].split("`")[1])
def test_a_line_of_the_cycle_has_its_files(row):
    line, files, physics = row
    assert {module(f"kernels/{name}") for name in named(files)} == kernels(line.split("`")[1])
    used = {other for name in kernels(line.split("`")[1]) for other, _ in source.imports_of(name)}
    for name in named(physics):
        place = module(name) if name.endswith("/") else f"hydro2d.physics.{name.removesuffix('.py')}"
        importlib.import_module(place)
        assert any(within(other, place) for other in used)


def test_every_line_of_the_cycle_that_runs_kernels_has_its_row():
    called = re.findall(r"self\.(\w+)\(", inspect.getsource(Cycle._step))
    assert [row[0].split("`")[1] for row in CYCLE] == list(dict.fromkeys(called))


@pytest.mark.parametrize("path", sorted(set(re.findall(r"`((?:\w+/)+\w+\.\w+)`", PAGE))))
def test_every_file_of_the_page_exists(path):
    assert any((source.ROOT / folder / path).is_file() for folder in ("", "hydro2d"))
