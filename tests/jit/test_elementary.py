"""exp, log, x^y and erf of our own against the library, in extended precision where the platform has it."""

import math
import re

import numba
import numpy as np
import pytest

from hydro2d.jit import erf, exp, log, power, rowwise

EPSILON = 2.0**-52
RANDOM = np.random.default_rng(1)
long = pytest.mark.skipif(np.finfo(np.longdouble).nmant <= 52, reason="the platform has no longer floating-point numbers")


@rowwise
def exps(x, out):
    """exp of a row."""
    for i in range(x.size):
        out[i] = exp(x[i])


@rowwise
def logs(x, out):
    """log of a row."""
    for i in range(x.size):
        out[i] = log(x[i])


@rowwise
def powers(x, y, out):
    """power of a row."""
    for i in range(x.size):
        out[i] = power(x[i], y[i])


def row_of(function, *arguments):
    out = np.full(arguments[0].shape, math.nan)
    function(*arguments, out)
    return out


def error(computed, exact):
    """Largest relative error in units of 2^-52."""
    return float(np.max(np.abs((computed - exact) / exact))) / EPSILON


@long
@pytest.mark.parametrize("x", [
    RANDOM.uniform(-708.0, 709.78, 200_000), RANDOM.uniform(-1.0, 1.0, 200_000), 10.0 ** RANDOM.uniform(-20.0, -3.0, 20_000),
], ids=["all", "about 0", "tiny"])
def test_exp(x):
    assert error(row_of(exps, x), np.exp(x.astype(np.longdouble))) < 1.0


@long
@pytest.mark.parametrize("x", [
    2.0 ** RANDOM.uniform(-1022.0, 1023.99, 200_000), RANDOM.uniform(0.5, 2.0, 200_000),
    1.0 + RANDOM.uniform(-1.0, 1.0, 100_000) * 10.0 ** RANDOM.uniform(-15.0, -2.0, 100_000),
], ids=["all", "about 1", "next to 1"])
def test_log(x):
    x = x[x != 1.0]
    assert error(row_of(logs, x), np.log(x.astype(np.longdouble))) < 1.0


@long
def test_power():
    """Strains from 1e-40 and exponents of all signs; the error grows with the logarithm of the result."""
    x, y = 10.0 ** RANDOM.uniform(-40.0, 8.0, 400_000), RANDOM.uniform(-3.0, 3.0, 400_000)
    exact = x.astype(np.longdouble) ** y.astype(np.longdouble)
    relative = (row_of(powers, x, y) - exact) / exact / (1.0 + np.abs(np.log(exact)))
    assert float(np.max(np.abs(relative))) / EPSILON < 1.0


@pytest.mark.parametrize(("function", "x", "expected"), [
    (exp, 0.0, 1.0), (exp, -0.0, 1.0), (exp, -708.1, 0.0), (exp, -math.inf, 0.0), (exp, 709.79, math.inf),
    (exp, math.inf, math.inf), (exp, math.nan, math.nan), (exp, 1e300, math.inf), (exp, -1e300, 0.0),
    (log, 1.0, 0.0), (log, 0.0, -math.inf), (log, -0.0, -math.inf), (log, -1.0, math.nan), (log, -math.inf, math.nan),
    (log, math.inf, math.inf), (log, math.nan, math.nan), (log, -5e-324, math.nan),
    (log, 5e-324, -math.inf), (log, 2e-308, -math.inf),
])
def test_special_values(function, x, expected):
    np.testing.assert_array_equal(function(x), expected)


@pytest.mark.parametrize(("x", "y", "expected"), [
    (0.0, 0.3, 0.0), (0.0, -1.0, math.inf), (0.0, 0.0, math.nan), (1.0, 0.41, 1.0), (0.7, 0.0, 1.0), (-1.0, 2.0, math.nan),
    (math.inf, 0.5, math.inf), (math.inf, -0.5, 0.0), (math.nan, 0.5, math.nan), (math.nan, 0.0, math.nan),
    (2.0, math.nan, math.nan),
])
def test_special_powers(x, y, expected):
    np.testing.assert_array_equal(power(x, y), expected)


def test_the_last_values_that_are_finite_and_not_zero():
    assert exp(709.782712893384) == pytest.approx(math.exp(709.782712893384), rel=1e-15)
    assert exp(-708.0) == pytest.approx(math.exp(-708.0), rel=1e-15)
    assert log(2.2250738585072014e-308) == pytest.approx(math.log(2.2250738585072014e-308), rel=1e-15)


@pytest.mark.parametrize("number", [1, 7, 8, 9, 31, 64])
def test_the_bits_do_not_depend_on_the_place_in_a_row(number):
    """Vectors, the remainder after the last one, and a single call."""
    x, y = 10.0 ** RANDOM.uniform(-12.0, 3.0, number), RANDOM.uniform(0.05, 1.5, number)
    np.testing.assert_array_equal(row_of(powers, x, y), [power(a, b) for a, b in zip(x, y, strict=True)])
    np.testing.assert_array_equal(row_of(logs, x), [log(a) for a in x])
    np.testing.assert_array_equal(row_of(exps, -x), [exp(-a) for a in x])


def test_the_compiler_fuses_no_product_with_a_sum_and_calls_no_library():
    """Either would make the bits depend on the machine."""
    compiled = numba.njit(error_model="numpy")(powers.py_func)
    row_of(compiled, np.ones(3), np.ones(3))
    (text,) = compiled.inspect_asm().values()
    assert "mul" in text
    assert not re.search(r"fn?m(add|sub|la|ls)", text)
    assert not re.search(r"\b_*(exp|log|pow)\b", text)


def test_erf():
    """Against scipy's, to the absolute accuracy that is stated; never falling by more than that, and 1 far out."""
    from scipy import special

    x = np.concatenate([np.linspace(0.0, 7.0, 70_001), 10.0 ** RANDOM.uniform(-300.0, 300.0, 2000)])
    computed = np.array([erf(each) for each in x.tolist()])
    assert np.abs(computed - special.erf(x)).max() < 2.0**-47
    assert (erf(6.1), erf(math.inf)) == (1.0, 1.0)
    assert math.isnan(erf(math.nan))
