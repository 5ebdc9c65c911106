"""How compiled functions choose among models."""

import ast
import importlib
import inspect
import math
import operator
import os
import re
import stat
import tempfile
import types
from pathlib import Path

import llvmlite.binding
import numba
import numpy as np
import pytest
from numba.core import caching, codegen, compiler, cpu, imputils, inline_closurecall, registry, targetconfig
from numba.core.typing import templates
from numba.np import arrayobj

from hydro2d import jit
from hydro2d.jit import cache, options
from hydro2d.mesh.fields import LANE_ROWS, LANES
from strength import dispatch, lanes
from strength.layout import ROW
from tests.solver.test_given import PHASES


def model(number: int, **functions) -> types.SimpleNamespace:
    return types.SimpleNamespace(ID=number, __name__="strength.hydrodynamic", **functions)


def test_the_model_with_the_id_is_called():
    for module in dispatch.STRENGTH_MODULES:
        par = np.linspace(1.0, 2.0, ROW)
        assert dispatch.shear_modulus(module.ID, 0.0, 1.0, 300.0, par) == module.shear_modulus(0.0, 1.0, 300.0, par)


def test_an_unknown_id_gives_what_was_said():
    assert math.isnan(dispatch.flow_stress(99, 0.0, 0.0, 300.0, 0.0, 1.0, dispatch.STRENGTH_MODULES[0].row({})))
    assert dispatch.yield_floor(99, dispatch.STRENGTH_MODULES[0].row({})) == 0.0
    lane = np.zeros(LANE_ROWS * LANES)
    dispatch.flow_row(99, 8, np.zeros(ROW), lane)
    assert np.isnan(lane[lanes.FLOW:][:8]).all()
    assert np.isnan(lane).sum() == 8


def test_models_without_the_function_are_left_out():
    with_it = [module.ID for module in dispatch.STRENGTH_MODULES if hasattr(module, "yield_floor")]
    assert 0 < len(with_it) < len(dispatch.STRENGTH_MODULES)


def test_the_chain_has_one_name_for_the_same_text():
    """Its compiled code is found again by that name and by the text, for which no file exists."""
    function = dispatch.flow_stress.py_func
    again = jit.by_id(dispatch.STRENGTH_MODULES, "flow_stress", "ep, rate, T, p, rho, par", dispatch.flow_stress.__doc__)
    assert again.py_func.__code__.co_filename == (file := function.__code__.co_filename)
    assert again._cache.file_name(()) == dispatch.flow_stress._cache.file_name(())
    assert not os.path.exists(file)
    assert inspect.getsource(function).startswith("@point\ndef flow_stress(model, ")  # as tracebacks show it


def test_two_models_with_one_id_are_an_error():
    with pytest.raises(ValueError, match="ID 0"):
        jit.by_id((model(0, flow_stress=None), model(0, flow_stress=None)), "flow_stress", "ep", "one of them")


ROOT = cache.ROOT
KERNELS = sorted(file for file in ROOT.glob("hydro2d/kernels/[a-z]*.py") if "\n@" in file.read_text(encoding="utf-8"))


def seen_by(name: str) -> set[str]:
    return {file.relative_to(ROOT).as_posix() for file in cache.seen_by(ROOT / name)}


@pytest.mark.parametrize("file", KERNELS, ids=lambda file: file.stem)
def test_all_functions_that_a_kernel_can_call_are_sources_of_its_cache(file):
    """Every compiled function that its module knows, and those that their modules know, and so on."""
    seen, waiting, known = cache.seen_by(file), [importlib.import_module(f"hydro2d.kernels.{file.stem}")], set()
    while waiting:
        for value in vars(waiting.pop()).values():
            compiled = getattr(value, "compiled", value)
            if not hasattr(compiled, "py_func") or compiled.py_func.__module__ in known:
                continue
            known.add(compiled.py_func.__module__)
            module = importlib.import_module(compiled.py_func.__module__)
            assert Path(module.__file__).resolve() in seen or Path(module.__file__).parent == Path(jit.all_folder())
            waiting.append(module)
    assert known


def test_constants_of_any_folder_are_among_the_sources():
    """A kernel of the solver once kept old columns: their file next to it was not in the hash."""
    assert "hydro2d/measure/station_columns.py" in seen_by("hydro2d/measure/tracers.py")
    assert "hydro2d/mesh/fields.py" in seen_by("hydro2d/kernels/remap.py")
    assert not {"hydro2d/__init__.py", "hydro2d/files/whole.py", "hydro2d/api.py"} & seen_by("hydro2d/kernels/mixed.py")


def test_the_names_of_handles_are_among_the_sources_of_every_phase():
    """Phases contain places in the table of names: three were once kept when names came in between, and read other arrays."""
    assert len(PHASES) == 33
    for phase in PHASES.values():
        files = {Path(run.kernel.__wrapped__.__code__.co_filename).resolve() for run in phase.runs()}
        seen = {name.relative_to(ROOT).as_posix() for file in files for name in cache.seen_by(file)}
        assert {"hydro2d/kernels/names.py", "hydro2d/mesh/fields.py"} <= seen, phase.__name__


#: features that numba does not promise to keep: (object, attribute, words that its signature must have)
RELIED_ON = [
    (codegen.CPUCodeLibrary, "_optimize_final_module", ("self",)),
    (codegen.CPUCodeLibrary, "_finalize_final_module", ("self",)),
    (codegen.CPUCodeLibrary, "_finalize_dynamic_globals", ("self",)),
    (codegen.CPUCodeLibrary, "_verify_declare_only_symbols", ("self",)),
    (codegen.JITCodeLibrary, "get_pointer_to_function", ("name",)),
    (cpu.CPUContext, "get_executable", ("library", "fndesc", "env")),
    (numba.core.funcdesc.FunctionDescriptor, "llvm_cfunc_wrapper_name", ()),
    (imputils, "lower_getattr_generic", ("ty",)),
    (templates, "infer_getattr", ()),
    (templates, "AttributeTemplate", ()),
    (arrayobj, "make_array", ("array_type",)),
    (arrayobj, "populate_array", ("array", "data", "shape", "strides", "itemsize", "meminfo")),
    (cpu, "CPUTargetOptions", ()),
    (numba.core.options, "TargetOptions", ()),
    (numba.core.options.TargetOptions, "Mapping", ("flag_name",)),
    (numba.core.compiler.Flags(), "noalias", ()),
    (caching, "_Cache", ()),
    (compiler, "CompileResult", ()),
    (compiler.CompileResult, "_reduce", ("self",)),
    (compiler.CompileResult, "_rebuild", ("target_context", "reload_init", "referenced_envs")),
    (compiler.CompileResult, "_fields", ()),
    (compiler.CompileResult, "lifted", ()),
    (compiler.CompileResult, "type_annotation", ()),
    (codegen.CodeLibrary, "has_dynamic_globals", ()),
    (numba.core.serialize, "dumps", ("obj",)),
    (numba.core.sigutils, "normalize_signature", ("sig",)),
    (registry.cpu_target, "target_context", ()),
    (codegen.JITCPUCodegen, "magic_tuple", ("self",)),
    (numba.config, "CPU_NAME", ()),
    (numba.config, "CPU_FEATURES", ()),
    (numba.config, "ENABLE_AVX", ()),
    (numba.core, "event", ()),
    (numba.core.event, "Listener", ()),
    (numba.core.event, "register", ("kind", "listener")),
    (numba.core.dispatcher.Dispatcher, "typeof_pyval", ("val",)),
    (numba.core.dispatcher.Dispatcher, "compile", ("sig",)),
    (numba.core.options.DefaultOptions, "_nrt", ()),
    (targetconfig.TargetConfig, "__eq__", ("other",)),
    (compiler.Flags(), "_values", ()),
    (numba.types.functions.BaseFunction, "get_call_type", ("self", "context", "args", "kws")),
    (numba.types.Function(templates.make_concrete_template("max", max, [])), "_impl_keys", ()),
    (numba.types.Function(templates.make_concrete_template("max", max, [])), "typing_key", ()),
    (inline_closurecall.InlineWorker, "inline_function", ("caller_ir", "block", "i", "function", "arg_typs")),
    (inline_closurecall.InlineWorker, "inline_ir", ("caller_ir", "block", "i", "callee_ir", "callee_freevars", "arg_typs")),
    (inline_closurecall.InlineWorker, "run_untyped_passes", ("func",)),
    (inline_closurecall.copy, "deepcopy", ("x",)),
    (numba.config, "THREADING_LAYER", ()),
    (llvmlite.binding, "set_option", ("name", "option")),
]


@pytest.mark.parametrize(("owner", "name", "words"), RELIED_ON, ids=[name for _, name, _ in RELIED_ON])
def test_unpromised_features_of_numba_exist(owner, name, words):
    feature = getattr(owner, name)
    assert not words or set(words) <= set(inspect.signature(feature).parameters)


def test_no_other_private_name_of_numba_is_used():
    """Attributes that begin with an underscore, and imports from inside numba, in the whole of hydro2d."""
    known = {name for _, name, _ in RELIED_ON}
    for file in (ROOT / "hydro2d").glob("**/*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        modules = {alias.asname or alias.name for node in ast.walk(tree) if isinstance(node, (ast.Import, ast.ImportFrom))
                   for alias in node.names if "numba" in (getattr(node, "module", None) or alias.name)}
        used = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and node.attr.startswith("_")
                and node.attr != "__version__"
                and isinstance(node.value, ast.Name) and node.value.id in modules}
        assert used <= known, file


def test_an_edit_compiles_again_what_can_see_it_and_nothing_else():
    sees_strength = {file.stem for file in KERNELS if "strength/power_law.py" in seen_by(f"hydro2d/kernels/{file.name}")}
    assert {"deformation", "mixed"} <= sees_strength
    assert not sees_strength & {"remap", "momentum", "interfaces", "contact_geometry", "contact_motion", "contact_velocities",
                                "contact_volumes", "vertex_forces", "sliding", "column_ranges", "mesh_motion", "boundaries"}
    assert "hydro2d/physics/interfaces.py" in seen_by("hydro2d/kernels/contact/contact_volumes.py")
    assert "hydro2d/physics/interfaces.py" not in seen_by("hydro2d/kernels/momentum.py")


def test_the_folder_changes_with_the_text_of_a_source(tmp_path):
    first, second = tmp_path / "a.py", tmp_path / "b.py"
    first.write_text("A = 1\n")
    second.write_text("B = 1\n")
    before = cache.folder_for([first, second])
    assert cache.folder_for([second, first]) == before
    second.write_text("B = 2\n")
    assert cache.folder_for([first, second]) != before
    assert cache.folder_for([first]) != before


def test_the_cache_in_the_temporary_folder_is_the_users_alone(tmp_path, monkeypatch, capsys):
    """Files kept there are executed: a folder that somebody else has prepared is not used."""
    monkeypatch.setenv("HYDRO2D_CACHE_DIR", os.environ.get("HYDRO2D_CACHE_DIR", ""))  # restored afterwards
    own = str(tmp_path / "own")
    assert cache._private(own) == cache._private(own) == own
    assert stat.S_IMODE(os.stat(own).st_mode) == 0o700
    assert capsys.readouterr().err == ""
    open_to_all, link = tmp_path / "open", tmp_path / "link"
    open_to_all.mkdir(mode=0o777)
    open_to_all.chmod(0o777)
    link.symlink_to(own)
    for folder in (open_to_all, link):
        used = cache._private(str(folder))
        assert used == os.environ["HYDRO2D_CACHE_DIR"] not in (str(folder), own)
        assert stat.S_IMODE(os.stat(used).st_mode) == 0o700
        assert f"{folder} is not a private folder of this user" in capsys.readouterr().err


def test_a_home_that_cannot_be_written_to_has_a_private_cache(tmp_path, monkeypatch):
    monkeypatch.delenv("HYDRO2D_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", "/proc/none/cache")
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    assert cache.root.__wrapped__() == str(tmp_path / f"hydro2d-{os.getuid()}")


@pytest.mark.parametrize(("own", "home"), [("", ""), ("", "here"), ("", "./here"), (None, ""), (None, "here")])
def test_a_cache_in_the_current_directory_is_only_used_where_the_user_asks_for_it(own, home, tmp_path, monkeypatch):
    """Files kept there are executed, and the directory can be anybody's."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    (tmp_path / "home" / ".cache").mkdir(parents=True)
    monkeypatch.setenv("XDG_CACHE_HOME", home)
    monkeypatch.delenv("HYDRO2D_CACHE_DIR", raising=False) if own is None else monkeypatch.setenv("HYDRO2D_CACHE_DIR", own)
    assert cache.root.__wrapped__() == str(tmp_path / "home" / ".cache" / "hydro2d")
    monkeypatch.setenv("HYDRO2D_CACHE_DIR", "here")
    assert cache.root.__wrapped__() == str(tmp_path / "here")


@pytest.mark.parametrize("promised", [True, False])
def test_arrays_of_kernels_are_promised_not_to_overlap(promised):
    """The option is numba's own; without it the compiler compares addresses before every loop."""
    def add(n, a, b):
        for i in range(n):
            a[i] += b[i]

    assert jit.kernel(add).compiled.targetoptions["noalias"]
    made = numba.njit(**options.OPTIONS, noalias=promised)(add)
    made.compile((numba.int64, numba.float64[::1], numba.float64[::1]))
    (text,) = made.inspect_llvm().values()
    (head,) = [line for line in text.splitlines() if line.startswith("define ") and "%arg.a.4" in line]
    assert len(re.findall(r"noalias[^,]*%arg\.[ab]\.4", head)) == (2 if promised else 0), head


@pytest.mark.parametrize("only_calls", [True, False])
def test_kernels_are_not_optimised_again_in_their_callers(only_calls, monkeypatch):
    """A phase calls its kernels by their names; without the option, a kernel as short as this one is inlined into it."""
    def named_kernel(part, parts, a):
        for j in range(parts[part], parts[part + 1]):
            a[j] *= 2.0

    def over_parts(parts, a):
        for place in numba.prange(parts.shape[0] - 1):
            kernel(np.int64(place), parts, a)

    own = options.OPTIONS
    kernel, phase = numba.njit(**own)(named_kernel), numba.njit(**own, parallel=True)(over_parts)
    monkeypatch.setattr(options, "ONLY_CALLS", {over_parts} if only_calls else set())
    phase.compile((numba.int64[::1], numba.float64[::1]))
    (text,) = phase.inspect_llvm().values()
    assert len(re.findall(r"call [^\n]*named_kernel", text)) == (1 if only_calls else 0)


def test_the_type_of_an_operator_between_numbers_is_asked_for_once(monkeypatch):
    """numba tries half a dozen templates each time, which took a tenth of a compilation."""
    def power(x):
        return x * x * x * x * x

    asked, apply = [], templates.ConcreteTemplate.apply
    monkeypatch.setattr(templates.ConcreteTemplate, "apply", lambda self, *given: asked.append(self.key) or apply(self, *given))
    compiled = numba.njit(**options.OPTIONS)(power)
    assert compiled(np.float32(3.0)) == 243.0
    assert asked.count(operator.mul) <= 1
    assert compiled(3) == 243


@pytest.mark.parametrize("inline", ["always", "never"])
def test_what_is_inlined_twice_is_not_mixed_up(inline):
    """Its form in numba is not copied, since it is made anew for every place."""
    @numba.njit(inline=inline, **options.OPTIONS)
    def weighted(a, b):
        total = 0.0
        for i in range(a.shape[0]):
            total += a[i] * b
        return total

    @numba.njit(**options.OPTIONS)
    def both(a, b, c):
        return weighted(a, b) - weighted(a[1:], c) * weighted(a, c)

    assert both(np.array([1.0, 2.0, 4.0]), 3.0, 5.0) == 21.0 - 30.0 * 35.0


@pytest.mark.parametrize("inner", [True, False])
def test_functions_called_only_by_compiled_code_have_no_code_of_their_own(inner, monkeypatch):
    """A kernel is part of the machine code of the phase that calls it, and is not compiled by itself."""
    def kernel_of_a_phase(a):
        a[0] += 2.0

    def phase_of_a_kernel(a):
        kernel(a)

    own = options.OPTIONS
    kernel, phase = numba.njit(**own, no_cfunc_wrapper=True, no_cpython_wrapper=inner)(kernel_of_a_phase), numba.njit(**own)(
        phase_of_a_kernel)
    monkeypatch.setattr(options, "INNER", {kernel_of_a_phase} if inner else set())
    a = np.zeros(1)
    phase(a)
    assert a[0] == 2.0
    (overload,) = kernel.overloads.values()
    assert (overload.entry_point.__name__ == "append") == inner, "append of a list stands for what Python would call"


def test_python_gets_code_of_its_own_when_it_asks():
    def twice(x):
        return 2.0 * x

    point = jit.point(twice)
    assert "whole" not in vars(point)
    assert point(3.0) == 6.0
    assert point.py_func.__code__ is twice.__code__
    assert point.__name__ == "twice"
    assert not hasattr(point, "__nonsense__")


def test_every_phase_only_calls_kernels():
    """The option assumes it: a function that is neither a kernel nor the barrier would not be optimised at all."""
    assert {phase.compiled.py_func for phase in PHASES.values()} <= options.ONLY_CALLS
