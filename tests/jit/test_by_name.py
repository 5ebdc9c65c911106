"""Functions that take arrays by their names: their compiled form, and what is refused."""

import inspect
import traceback
from types import SimpleNamespace

import numpy as np
import pytest

import hydro2d.kernels  # noqa: F401  (declares names)
from hydro2d import jit
from hydro2d.jit import by_name


@jit.point
def half_of(j, i, w):
    """Half of u."""
    return 0.5 * w.u[0, j, i]


@jit.not_inlined
def pushed(j, i, more, w):
    """Velocity that a vertex gains."""
    return w.dt * half_of(j, i, w) + more


@jit.rowwise
def push_row(j, more, w):
    """Pushes the vertices of a row; pushed may be called under another name."""
    for i in range(w.i0, w.i1):
        u = pushed(j, i, more, w)
        w.v[0, j, i] += u


@jit.kernel
def push(part, ranges, w):
    """Pushes all vertices of a part."""
    for j in range(w.parts[part], w.parts[part + 1]):
        push_row(j, 1.0 + ranges[j], w)


@jit.cell_rows
def count(j, part, w):
    """Counts rows, and in the first part in tens."""
    step = 10.0 if part == 0 else 1.0
    w.dz[j] += step


@jit.vertex_rows
def double(j, w):
    """Doubles."""
    w.dz[j] *= 2.0


@jit.serial
def divided(w):
    """Fails in its second line."""
    first = w.nr + 1
    return first // w.nz


def given(**more) -> SimpleNamespace:
    u = np.arange(12.0).reshape(1, 3, 4)
    return SimpleNamespace(parts=np.array([0, 2, 3]), i0=1, i1=3, dt=0.5, u=u, v=np.zeros_like(u), **more)


def test_names_are_found_and_passed_on_through_calls():
    assert half_of.named == ("u",)
    assert pushed.named == ("dt", "u")
    assert push_row.named == ("dt", "i0", "i1", "u", "v")
    assert by_name.takes(push) == ("part", "ranges", "dt", "i0", "i1", "parts", "u", "v")
    assert by_name.own_parameters(push) == ("part", "ranges")
    assert [*inspect.signature(push.compiled.__wrapped__).parameters][2:4] == ["w__dt", "w__i0"]
    assert str(inspect.signature(push)) == "(part, ranges, w)"


@pytest.mark.parametrize("run", [push, by_name.source(push)], ids=["compiled", "Python"])
def test_the_same_comes_of_it_compiled_and_as_python(run):
    w, ranges = given(), np.array([0, 1, 2])
    run(0, ranges, w)
    assert w.v[0].tolist() == [[0, 1.25, 1.5, 0], [0, 3.25, 3.5, 0], [0, 0, 0, 0]]
    run(1, ranges, w)
    assert w.v[0, 2].tolist() == [0, 5.25, 5.5, 0]


@pytest.mark.parametrize("function", [half_of, pushed], ids=lambda each: each.__name__)
def test_functions_that_kernels_call_can_be_called_from_python(function):
    more = (1.0,) if function is pushed else ()
    assert function(2, 1, *more, given()) == by_name.source(function)(2, 1, *more, given())


@pytest.mark.parametrize("compiled", [True, False])
def test_a_function_of_a_row_runs_in_all_rows_of_a_part(compiled):
    w = SimpleNamespace(parts=np.array([0, 2, 3]), dz=np.zeros(5))
    for kernel in (count, double):
        for part in (0, 1):
            (kernel if compiled else by_name.source(kernel))(part, w)
    assert w.dz.tolist() == [20, 20, 2, 0, 0]
    w.dz[3] = 1.0
    double(1, w)
    assert w.dz.tolist() == [20, 20, 4, 2, 0]
    assert by_name.takes(count) == ("part", "dz", "parts")


def test_a_function_keeps_its_name_its_lines_and_its_module():
    flat, source = push.compiled.__wrapped__, by_name.source(push)
    assert (flat.__name__, flat.__qualname__, flat.__doc__, flat.__module__) == (
        source.__name__, source.__qualname__, source.__doc__, source.__module__)
    assert flat.__code__.co_qualname == "push"
    assert flat.__code__.co_filename == __file__ == source.__code__.co_filename
    assert flat.__globals__ is globals()
    assert flat.__code__.co_firstlineno == source.__code__.co_firstlineno
    assert {line for *_, line in flat.__code__.co_lines()} == {line for *_, line in source.__code__.co_lines()}


def test_a_traceback_shows_the_line_as_it_is_written():
    with pytest.raises(ZeroDivisionError) as caught:
        divided.compiled.__wrapped__(1, 0)
    assert traceback.extract_tb(caught.value.__traceback__)[-1].line == "return first // w.nz"


def test_a_function_without_a_handle_is_left_as_it_is():
    def plain(w, s):
        return w + s

    assert by_name.flat(plain) is plain
    assert jit.point(plain)(1.0, 2.0) == 3.0
    assert by_name.takes(jit.point(plain)) == ("w", "s")


REFUSED = {
    "a name that is not declared": ("def f(j, w):\n    return w.nonsense[j]", "3: f uses w.nonsense, which is no name"),
    "the handle by itself": ("def f(j, w):\n    x = w\n    return x.u", "3: f uses w otherwise than by a name"),
    "the handle before the last argument": ("def f(j, w):\n    return half_of(w, j)", "3: f uses w otherwise"),
    "the handle by a word": ("def f(j, w):\n    return half_of(j, j, w=w)", "3: f uses w otherwise"),
    "an assignment of the handle": ("def f(j, w):\n    w = j\n    return w", "3: f uses w otherwise"),
    "a name that is assigned": ("def f(j, w):\n    w.dt = 2.0", "3: f assigns w.dt"),
    "a name that is added to": ("def f(j, w):\n    w.dt += 2.0", "3: f assigns w.dt"),
    "a variable with the name of a parameter": ("def f(j, w):\n    w__u = w.dt\n    return w__u", "3: f has a variable w__u"),
    "a function that is defined later": ("def f(j, w):\n    return later(j, w)", "3: f gives w to later, which is no compiled"),
    "a function that takes no handle": ("def f(j, w):\n    return abs(w)", "3: f gives w to abs, which is no compiled"),
    "a method": ("def f(j, w):\n    return half_of.whole(j, w)", "3: f gives w to half_of.whole, which is no compiled"),
}


@pytest.mark.parametrize(("text", "message"), REFUSED.values(), ids=REFUSED)
def test_functions_that_cannot_be_rewritten_are_refused(text, message):
    with pytest.raises(ValueError, match=message):
        jit.module_of("refused", f"from {__name__} import half_of, jit\n{text}\njit.point(f)\n")


@pytest.mark.parametrize(("text", "message"), [
    ("def f(j, w):\n    if j > 2:\n        return\n    w.dz[j] = 0.0", "4: f returns, which would leave out the rest"),
    ("def f(i, w):\n    w.dz[i] = 0.0", "2: f does not take a row j first and w last"),
    ("def f(j, s):\n    s.dz[j] = 0.0", "2: f does not take a row j first and w last"),
], ids=["returns", "no row", "no handle"])
@pytest.mark.parametrize("rows", ["cell_rows", "vertex_rows"])
def test_values_that_differ_between_rows_are_refused(text, message, rows):
    with pytest.raises(ValueError, match=message):
        jit.module_of("refused", f"from hydro2d import jit\n{text}\njit.{rows}(f)\n")


def test_a_function_within_another_one_is_refused():
    def inner(j, w):
        return w.dz[j]

    with pytest.raises(ValueError, match="inner takes w, which only functions of files can"):
        jit.point(inner)
