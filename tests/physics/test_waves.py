"""The bounds of the time step, and the impedances of a cell."""

import math

import numpy as np
import pytest

from hydro2d.physics import waves

impedances = waves.impedances.py_func

@pytest.mark.parametrize("fastest", range(4))
@pytest.mark.parametrize("speed", [800.0, -800.0])
def test_the_fastest_vertex_may_cross_two_fifths_of_a_length(speed, fastest):
    speeds = [1.0, -1.0, 1.0, -1.0]
    speeds[fastest] = speed
    assert waves.crossing_step.py_func(0.4, 1e-3, *speeds) == pytest.approx(0.4 * 1e-3 / 800.0)


RHO, K, SHEAR = 7850.0, 160e9, 80e9
C_LONG, C_SHEAR = math.sqrt((K + 4.0 / 3.0 * SHEAR) / RHO), math.sqrt(SHEAR / RHO)


def impedances_of(rho, c, bulk):
    """Those of cell (1, 2), nothing around it."""
    cells = np.full((3, 3, 4), np.nan)
    cells[:, 1, 2] = rho, c, bulk
    return impedances(1, 2, *cells)


def test_impedances_of_an_elastic_cell_are_density_times_the_speeds_of_its_waves():
    assert impedances_of(RHO, C_LONG, K) == pytest.approx((RHO * C_LONG, RHO * C_SHEAR))


def test_a_cell_with_void_has_a_longitudinal_impedance_alone():
    """Its bulk modulus is 0, which must not be taken for a solid with shear only."""
    assert impedances_of(RHO, C_LONG, 0.0) == (pytest.approx(RHO * C_LONG), 0.0)


def test_a_shock_crosses_less_of_a_cell():
    """From a thousandth of rho c_l^2 on, and by half at half of that; a courant below shock_courant is kept."""
    shocked = waves.SHOCKED * RHO * C_LONG**2
    shares = [waves.share_crossed.py_func(0.7, 0.5, RHO, C_LONG, q) for q in (0.0, 0.5 * shocked, shocked, 9.0 * shocked)]
    assert shares == pytest.approx([0.7, 0.6, 0.5, 0.5])
    assert waves.share_crossed.py_func(0.4, 0.5, RHO, C_LONG, 9.0 * shocked) == 0.4
    step = waves.sound_step.py_func(0.7, 0.5, 1e-3, 0.0, 0.0, RHO, C_LONG, shocked)
    assert step == pytest.approx(0.5e-3 / (C_LONG * np.sqrt(1.0 + 2.0 * waves.SHOCKED)))


@pytest.mark.parametrize("linear", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("du", [0.0, 300.0, 9000.0])
def test_no_step_is_longer_than_a_share_of_the_largest_that_a_damped_leapfrog_allows(linear, du):
    """Of a vertex between cells that are compressed in turn: u' = u - w s - d u, s' = s + w u', whose matrix has an eigenvalue
    of -1 at the limit."""
    rho, c, length, quadratic = 8000.0, 5000.0, 1e-3, 1.3
    q = rho * (quadratic * du * du + linear * c * du)
    step = waves.sound_step.py_func(1.0, 1.0, length, linear, quadratic, rho, c, q) / waves.STABLE
    wave, loss = 2.0 * c * step / length, 2.0 * (linear * c + 2.0 * quadratic * du) * step / length
    eigenvalues = np.linalg.eigvals([[1.0 - loss, -wave], [wave * (1.0 - loss), 1.0 - wave * wave]])
    assert np.abs(eigenvalues).max() == pytest.approx(1.0, abs=1e-9)
    assert eigenvalues.real.min() == pytest.approx(-1.0, abs=1e-9)


def test_a_cell_loses_no_more_than_a_fifth_of_its_volume():
    volume_step = waves.volume_step.py_func
    assert volume_step(1e6) == pytest.approx(2e-7)
    assert volume_step(0.0) == volume_step(-1e6) == 1e300
