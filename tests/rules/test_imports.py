"""A file imports only modules above it in the list, which is the architecture."""

import ast
import subprocess
import sys
from fnmatch import fnmatch

import pytest

from tests.rules import source

#: from the bottom to the top; a name represents itself and all modules inside it, and a * any text
LAYERS = (
    ("hydro2d.base",),
    ("hydro2d.files",),
    ("hydro2d.jit",),
    ("hydro2d.noses",),
    ("hydro2d.mesh", "hydro2d.penetration", "hydro2d.problems"),
    ("eos", "strength"),
    ("hydro2d.sources", "hydro2d.materials"),
    ("hydro2d.physics",),
    ("hydro2d.kernels",),
    ("hydro2d.measure",),
    ("hydro2d.deck",),
    ("hydro2d.output",),
    ("hydro2d.solver",),
    ("hydro2d.running",),
    ("hydro2d.results",),
    ("hydro2d.analytic",),
    ("hydro2d.study.outcomes",),
    ("hydro2d.study.plan",),
    ("hydro2d.study.records",),
    ("hydro2d.study.run",),
    ("hydro2d.study.search",),
    ("hydro2d.study.ensemble",),
    ("hydro2d.study.samples",),
    ("hydro2d.study.report",),
    ("hydro2d.study",),
    ("hydro2d.api",),
    ("hydro2d.cli", "hydro2d.__main__"),
)
OURS = ("hydro2d", "eos", "strength")
#: packages that import these modules of hydro2d and no others
NARROW = {
    "eos": ("eos", "hydro2d.base.parameters", "hydro2d.jit", "hydro2d.mesh.fields"),
    "strength": ("strength", "hydro2d.base.parameters", "hydro2d.jit", "hydro2d.mesh.fields"),
    "hydro2d.physics": ("hydro2d.physics", "hydro2d.jit", "hydro2d.mesh.fields", "hydro2d.mesh.grid", "eos", "strength"),
    "hydro2d.kernels": ("hydro2d.kernels", "hydro2d.physics", "hydro2d.jit", "hydro2d.mesh.fields", "hydro2d.mesh.grid",
                        "hydro2d.mesh.sinks", "hydro2d.mesh.sums", "hydro2d.materials.rows",
                        "hydro2d.base.method_sections", "eos", "strength"),
    "hydro2d.penetration": ("hydro2d.penetration", "hydro2d.noses", "hydro2d.base.units", "hydro2d.base.parameters",
                            "hydro2d.base.errors"),
}


def within(name: str, *places: str) -> bool:
    return any(fnmatch(name, place) or name.startswith(place + ".") for place in places)


def layer(name: str) -> int | None:
    """Index of the module's layer, None for one not in the list."""
    for index, places in enumerate(LAYERS):
        if within(name, *places):
            return index
    return None


def breaches(name: str, imported) -> list[str]:
    """Every import of the module that the architecture forbids."""
    wrong = []
    for other, line in imported:
        if other == "hydro2d" or not within(other, *OURS):
            continue
        where = f"{name}, line {line}, imports {other}"
        for place, allowed in NARROW.items():
            if within(name, place) and not within(other, *allowed):
                wrong.append(f"{where}; {place} may import {', '.join(allowed)}")
        mine, theirs = layer(name), layer(other)
        if mine is not None and theirs is not None and theirs > mine:
            wrong.append(f"{where}, which stands above it")
    return wrong


MODULES = sorted(name for name in source.modules() if name != "hydro2d")


@pytest.mark.parametrize("name", MODULES)
def test_imports_point_downwards(name):
    assert breaches(name, source.imports_of(name)) == []


def test_every_module_has_its_place():
    lost = [name for name in MODULES if layer(name) is None]
    assert lost == [], "give these a layer in LAYERS"


def test_no_circles():
    graph = {name: {other for other, _ in source.imports_of(name) if other in source.modules()} for name in MODULES}
    done: set[str] = set()
    path: list[str] = []

    def visit(name: str) -> None:
        assert name not in path, " -> ".join([*path[path.index(name) :], name])
        if name in done:
            return
        path.append(name)
        for other in sorted(graph.get(name, ()) - {"hydro2d", name}):
            visit(other)
        path.pop()
        done.add(name)

    for name in MODULES:
        visit(name)


def test_the_package_itself_imports_nothing_at_once():
    """``import hydro2d`` is instant; its names are imported when they are used."""
    waiting, seen = ["hydro2d"], set()
    while waiting:
        name = waiting.pop()
        seen.add(name)
        body = source.tree(source.modules()[name]).body
        at_once = ast.Module([node for node in body if isinstance(node, (ast.Import, ast.ImportFrom))], [])
        imported = {other for other, _ in source.imports(at_once, frozenset(source.modules()))}
        assert {other.split(".")[0] for other in imported} <= {"hydro2d", *sys.stdlib_module_names}
        waiting += (imported & source.modules().keys()) - seen
    assert seen == {"hydro2d", "hydro2d.base.start", "hydro2d.base.version"}


@pytest.mark.parametrize(
    ("place", "allowed"),
    [
        ("eos", {"numpy"}),
        ("strength", {"numpy"}),
        ("hydro2d.physics", {"numpy"}),
        ("hydro2d.kernels", {"numpy"}),
        ("hydro2d.penetration", {"numpy", "scipy"}),
    ],
)
def test_physics_needs_few_libraries(place, allowed):
    foreign = {other.split(".")[0] for name in MODULES if within(name, place) for other, _ in source.imports_of(name)}
    assert foreign - {*OURS, *sys.stdlib_module_names} <= allowed


#: programs next to the decks that import more of hydro2d than its public interface, and why
SCRIPTS_WITH_MORE = {
    "problems.validation.jet": "an isentrope by the equation of state",
    "problems.verification.accuracy": "the exact detonation has the constants of the explosive's model",
    "problems.verification.hugoniot": "it verifies equations of state and melting lines themselves",
}
SCRIPTS = {".".join(file.relative_to(source.ROOT).with_suffix("").parts): file
           for file in sorted(source.ROOT.glob("problems/**/*.py"))}


def internals(name: str) -> set[str]:
    """Modules of hydro2d that a program next to the decks imports in addition to `hydro2d` itself."""
    imported = {other for other, _ in source.imports(source.tree(SCRIPTS[name]), frozenset(source.modules()))}
    return {other for other in imported if within(other, *OURS) and other != "hydro2d"}


@pytest.mark.parametrize("name", SCRIPTS)
def test_programs_import_the_public_interface(name):
    assert bool(internals(name)) is (name in SCRIPTS_WITH_MORE)


def users(library: str) -> set[str]:
    return {name for name in source.modules() if any(within(other, library) for other, _ in source.imports_of(name))}


@pytest.mark.parametrize(
    ("library", "allowed"),
    [
        ("numba", ("hydro2d.jit.options", "hydro2d.jit.target", "hydro2d.jit.store", "hydro2d.jit.calls", "hydro2d.jit.bits",
                   "hydro2d.jit.barrier", "hydro2d.jit.handle", "hydro2d.jit.phases", "hydro2d.jit.tape")),
        ("pyvista", ("hydro2d.output.vtk", "hydro2d.results.cutaway")),
        ("vtk", ("hydro2d.output.vtk", "hydro2d.results.cutaway")),
        ("pint", ("hydro2d.base.units",)),
        ("scipy", ("hydro2d.penetration", "hydro2d.materials.fitting", "hydro2d.measure.crater", "hydro2d.measure.debris",
                   "hydro2d.measure.wall_damage", "hydro2d.measure.reach", "hydro2d.output.outlines",
                   "hydro2d.deck.mesh", "hydro2d.study.ensemble.chance", "hydro2d.study.ensemble.extrapolation",
                   "hydro2d.study.plan.distributions", "hydro2d.study.plan.joint", "hydro2d.study.plan.sampling",
                   "hydro2d.study.samples", "hydro2d.study.search.ballistic", "hydro2d.study.search.logit")),
        ("plotly", ("hydro2d.study.report.charts", "hydro2d.study.report.page")),
        ("jinja2", ("hydro2d.study.report.page",)),
        ("pandas", ("hydro2d.study.records.runs", "hydro2d.study.records.sample_table", "hydro2d.study.records.table",
                    "hydro2d.study.ensemble", "hydro2d.study.report", "hydro2d.study.samples.results", "hydro2d.study.search",
                    "hydro2d.api", "hydro2d.output.history", "hydro2d.results.tables")),
        ("xarray", ("hydro2d.output.datasets", "hydro2d.output.history")),
        ("hydro2d.penetration", ("hydro2d.penetration", "hydro2d.analytic")),
        ("hydro2d.kernels", ("hydro2d.kernels", "hydro2d.solver", "hydro2d.measure.sanity", "hydro2d.measure.tracers",
                             "hydro2d.running.bench")),
    ],
)
def test_only_these_import(library, allowed):
    assert [name for name in sorted(users(library)) if not within(name, *allowed)] == []


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("hydro2d.mesh.grid", "from hydro2d.solver.cycle import advance"),
        ("hydro2d.kernels.eos_sweep", "from hydro2d.mesh.state import State"),
        ("eos.ideal_gas", "from hydro2d.base import units"),
        ("strength.steinberg_guinan", "import eos.dispatch"),
        ("hydro2d.penetration.tate", "def f():\n    from hydro2d.solver.simulation import Simulation"),
    ],
)
def test_a_forbidden_import_is_found(name, text):
    known = frozenset({"hydro2d.base.units", "hydro2d.mesh.state", "hydro2d.solver.cycle", "hydro2d.solver.simulation",
                       "eos.dispatch"})
    assert breaches(name, source.imports(ast.parse(text), known)) != []


def test_help_needs_nothing_heavy():
    """``hydro2d --help`` answers at once: the command line imports at use."""
    heavy = set("numba numpy h5py pyvista vtkmodules pint scipy matplotlib pydantic distributed plotly jinja2 ssl "
                "pandas".split())
    script = f"import sys; from hydro2d.cli import main; print(sorted({heavy!r} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", script], cwd=source.ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
