"""Handles: compiled code finds under a name what Python has stored under it; values of another type are refused."""

import numba
import numpy as np
import pytest

from hydro2d import jit
from hydro2d.jit import handle as handles
from hydro2d.jit.handle import Handle, as_handle
from hydro2d.kernels import names


@pytest.fixture(scope="module")
def read():
    """A compiled function that reads names of each kind."""
    assert names.NAMES  # they are declared

    @numba.njit(_nrt=False)
    def read(address, found):
        w = as_handle(address)
        found[0] = w.dt
        found[1] = w.i1
        found[2] = 1.0 if w.travels else 0.0
        found[3] = w.u[1, 2, 3]
        found[4] = w.u.shape[0] * 100 + w.u.shape[1] * 10 + w.u.shape[2]
        found[5] = w.zone[1, 2]
        found[6] = 1.0 if w.gases[1] else 0.0
        found[7] = w.mixed_count[2]
        w.p[1, 1] = 7.0

    return read


def filled() -> Handle:
    handle = Handle()
    handle.update(dt=1.5e-9, i1=7, travels=True, u=np.arange(24.0).reshape(2, 3, 4), zone=np.full((2, 3), -3, dtype=np.int8),
                gases=np.array([False, True]), mixed_count=np.array([4, 5, 6]), p=np.zeros((2, 2)))
    return handle


def test_compiled_code_reads_and_writes_by_name(read):
    handle, values = filled(), np.zeros(8)
    read(handle.address, values)
    assert values.tolist() == [1.5e-9, 7.0, 1.0, 23.0, 234.0, -3.0, 1.0, 6.0]
    assert handle.p.tolist() == [[0.0, 0.0], [0.0, 7.0]]
    handle.update(dt=2.0, travels=False, u=np.arange(48.0).reshape(2, 4, 6))
    read(handle.address, values)
    assert values.tolist() == [2.0, 7.0, 0.0, 39.0, 246.0, -3.0, 1.0, 6.0]


def test_two_handles_have_values_of_their_own(read):
    one, other, values = filled(), filled(), np.zeros(8)
    other.update(dt=3.0)
    read(one.address, values)
    assert values[0] == 1.5e-9


def test_a_handle_keeps_its_arrays_alive(read):
    handle, values = filled(), np.zeros(8)
    for _ in range(20):
        handle.update(u=np.full((2, 3, 4), 5.0))
        np.full((2, 3, 4), -1.0)
        read(handle.address, values)
        assert values[3] == 5.0


@pytest.mark.parametrize("value", [
    np.zeros((2, 3)), np.zeros((2, 3, 4), dtype=int), np.zeros((2, 3, 4), dtype=np.float32), np.zeros((2, 3, 8))[..., ::2],
    np.zeros((4, 3, 2)).T, 1.0, [[[1.0]]], None,
], ids=["axes", "kind", "precision", "steps", "order", "number", "list", "none"])
def test_arrays_of_another_type_are_refused(value):
    handle = filled()
    with pytest.raises(TypeError, match="u is an array of float64 with 3 axes"):
        handle.update(u=value)
    assert handle.u.shape == (2, 3, 4)


@pytest.mark.parametrize(("name", "value"), [("dt", np.zeros(1)), ("dt", None), ("dt", "1"), ("i1", 1.5), ("i1", np.zeros(2)),
                                             ("travels", 2), ("travels", np.zeros(1))])
def test_numbers_of_another_type_are_refused(name, value):
    with pytest.raises(TypeError, match=f"{name} is a number"):
        filled().update(**{name: value})


def test_names_that_nobody_has_declared_are_refused():
    with pytest.raises(KeyError):
        filled().update(nonsense=1.0)
    with pytest.raises(AttributeError):
        _ = filled().nonsense
    with pytest.raises(numba.TypingError, match="nonsense"):
        numba.njit(lambda address: as_handle(address).nonsense)(filled().address)


def test_a_name_has_one_meaning():
    with pytest.raises(ValueError, match="the name dt is declared twice"):
        jit.declare({"dt": (float, 0)})
    assert len(handles.declared()) == len(names.NAMES) + len(names.LIGHT) + len(handles.TABLE)


def test_names_exchange_their_arrays():
    handle, one, other = jit.Handle(), np.full((2, 1, 3, 4), 1.0), np.full((2, 1, 3, 4), 2.0)
    handle.update(velocity=one, velocity0=other)
    before = handle.words.copy()
    handle.exchange("velocity", "velocity0")
    assert handle.velocity is other
    assert handle.velocity0 is one
    rows = [handles._rows[name][0] for name in ("velocity", "velocity0")]
    np.testing.assert_array_equal(handle.words[rows], before[rows[::-1]])
    assert before[rows[0], 0] != before[rows[1], 0]
