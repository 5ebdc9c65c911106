"""How compiled functions choose among models."""

import math
import os
import types

import numpy as np
import pytest

from hydro2d import jit
from strength import dispatch
from strength.layout import ROW


def model(number: int, **functions) -> types.SimpleNamespace:
    return types.SimpleNamespace(ID=number, __name__="strength.hydrodynamic", **functions)


def test_the_model_with_the_id_is_called():
    for module in dispatch.STRENGTH_MODULES:
        par = np.linspace(1.0, 2.0, ROW)
        assert dispatch.shear_modulus(module.ID, 0.0, 1.0, 300.0, par) == module.shear_modulus(0.0, 1.0, 300.0, par)


def test_an_unknown_id_gives_what_was_said():
    assert math.isnan(dispatch.flow_stress(99, 0.0, 0.0, 300.0, 0.0, 1.0, dispatch.STRENGTH_MODULES[0].row({})))
    assert dispatch.yield_floor(99, dispatch.STRENGTH_MODULES[0].row({})) == 0.0


def test_models_without_the_function_are_left_out():
    with_it = [module.ID for module in dispatch.STRENGTH_MODULES if hasattr(module, "yield_floor")]
    assert 0 < len(with_it) < len(dispatch.STRENGTH_MODULES)


def test_the_chain_is_a_file_that_does_not_change_between_imports():
    """numba caches what is compiled by the file's name, time and size."""
    file = dispatch.flow_stress.py_func.__code__.co_filename
    before = os.stat(file)
    again = jit.by_id(dispatch.STRENGTH_MODULES, "flow_stress", "ep, rate, T, p, rho, par",
                      dispatch.flow_stress.__doc__)
    after = os.stat(again.py_func.__code__.co_filename)
    assert (before.st_mtime, before.st_size, before.st_ino) == (after.st_mtime, after.st_size, after.st_ino)


def test_two_models_with_one_id_are_an_error():
    with pytest.raises(ValueError, match="ID 0"):
        jit.by_id((model(0, flow_stress=None), model(0, flow_stress=None)), "flow_stress", "ep", "one of them")
