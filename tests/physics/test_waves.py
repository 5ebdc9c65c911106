"""The bounds of the time step, and the impedances of a cell."""

import math

import numpy as np
import pytest

from hydro2d.physics import waves

step_limits = waves.step_limits.py_func
impedances = waves.impedances.py_func

#: a slow cell of 1 by 2 mm: the first and the last vertex of a row belong to other cells
CELL = {
    "ub": [9e9, 1.0, 1.0, 9e9],
    "ut": [9e9, 1.0, 1.0, 9e9],
    "vb": [9e9, 1.0, 1.0, 9e9],
    "vt": [9e9, 1.0, 1.0, 9e9],
    "courant": 0.5,
    "shock_courant": 0.5,
    "advective": 0.4,
    "linear": 0.0,
    "quadratic": 1.0,
    "mesh_speed": 0.0,
    "dr": [9e-9, 1e-3, 9e-9],
    "h": 2e-3,
    "rho": 8000.0,
    "cl": 5000.0,
    "q": 0.0,
    "loss": 0.0,
}


def limits(**changed) -> dict[str, float]:
    """Bounds by cause, with some of CELL changed."""
    given = (np.array(value) if isinstance(value, list) else value for value in (CELL | changed).values())
    return dict(zip(waves.CAUSES, step_limits(1, *given), strict=True))


def changed_by(**changed) -> set[str]:
    """The bounds that differ from those of CELL."""
    before, after = limits(), limits(**changed)
    return {cause for cause in before if after[cause] != before[cause]}


def row(first: float, last: float) -> list[float]:
    return [9e9, first, last, 9e9]


# ---------------------------------------------------------------------------------------------------------- sound


def test_sound_may_cross_half_of_the_smaller_side():
    """0.5 * 1 mm at 5 km/s."""
    assert limits()["sound"] == pytest.approx(1e-7)


def test_the_height_counts_where_it_is_the_smaller_side():
    assert limits(h=0.25e-3)["sound"] == pytest.approx(0.25e-7)


def test_viscosity_adds_twice_its_pressure_over_density_to_the_square_of_the_speed():
    """q = 3/2 rho c^2 makes the wave twice as fast."""
    assert limits(q=1.5 * 8000.0 * 5000.0**2)["sound"] == pytest.approx(0.5e-7)


def test_courant_and_the_wave_bear_on_the_sound_limit_alone():
    assert changed_by(courant=0.25) == changed_by(cl=6000.0) == changed_by(q=1e9) == {"sound"}


# ------------------------------------------------------------------------------------------------------- velocity


@pytest.mark.parametrize("speed", [800.0, -800.0])
@pytest.mark.parametrize("name", ["ub", "ut"])
@pytest.mark.parametrize("end", [0, 1])
def test_the_fastest_vertex_may_cross_two_fifths_of_the_width(speed, name, end):
    changed = {name: row(*((speed, 1.0) if end == 0 else (1.0, speed)))}
    assert limits(**changed)["radial velocity"] == pytest.approx(0.4 * 1e-3 / 800.0)
    assert changed_by(**changed) == {"radial velocity"}


@pytest.mark.parametrize("speed", [800.0, -800.0])
@pytest.mark.parametrize("name", ["vb", "vt"])
@pytest.mark.parametrize("end", [0, 1])
def test_the_fastest_vertex_may_cross_two_fifths_of_the_height(speed, name, end):
    changed = {name: row(*((speed, 1.0) if end == 0 else (1.0, speed)))}
    assert limits(**changed)["axial velocity"] == pytest.approx(0.4 * 2e-3 / 800.0)
    assert changed_by(**changed) == {"axial velocity"}


@pytest.mark.parametrize(("name", "end"), [("vb", 0), ("vb", 1), ("vt", 0), ("vt", 1)])
def test_along_the_axis_only_the_motion_through_the_mesh_counts(name, end):
    """Three vertices go with the mesh, one is 200 m/s slower."""
    moving = {"vb": row(1000.0, 1000.0), "vt": row(1000.0, 1000.0)}
    moving[name] = row(*((800.0, 1000.0) if end == 0 else (1000.0, 800.0)))
    assert limits(mesh_speed=1000.0, **moving)["axial velocity"] == pytest.approx(0.4 * 2e-3 / 200.0)
    assert limits(mesh_speed=1000.0, **moving)["radial velocity"] == limits()["radial velocity"]


def test_a_cell_at_rest_in_the_mesh_is_bound_by_sound_alone():
    still = {name: row(0.0, 0.0) for name in ("ub", "ut", "vb", "vt")}
    with np.errstate(divide="ignore"):
        bounds = limits(**still)
    assert min(bounds, key=bounds.get) == "sound"
    assert min(bound for cause, bound in bounds.items() if cause != "sound") >= 1e300


def test_the_advective_share_bears_on_both_velocities():
    assert changed_by(advective=0.2) == {"radial velocity", "axial velocity"}


# --------------------------------------------------------------------------------------------------------- volume


def test_a_cell_may_lose_a_fifth_of_its_volume():
    assert limits(loss=1e5)["volume change"] == pytest.approx(2e-6)
    assert limits(loss=0.5)["volume change"] == pytest.approx(0.4)
    assert changed_by(loss=1e5) == {"volume change"}


@pytest.mark.parametrize("loss", [0.0, -1e5, -1e30])
def test_expansion_bounds_no_step(loss):
    assert limits(loss=loss)["volume change"] >= 1e300


# ------------------------------------------------------------------------------------------------------ impedances

RHO, K, SHEAR = 7850.0, 160e9, 80e9
C_LONG, C_SHEAR = math.sqrt((K + 4.0 / 3.0 * SHEAR) / RHO), math.sqrt(SHEAR / RHO)


def impedances_of(rho, c, bulk):
    """Those of cell (1, 2), nothing around it."""
    cells = np.full((3, 3, 4), np.nan)
    cells[:, 1, 2] = rho, c, bulk
    return impedances(1, 2, *cells)


def test_impedances_of_an_elastic_cell_are_density_times_the_speeds_of_its_waves():
    assert impedances_of(RHO, C_LONG, K) == pytest.approx((RHO * C_LONG, RHO * C_SHEAR))


def test_a_fluid_has_no_shear_impedance():
    z_l, z_s = impedances_of(1000.0, 1500.0, 1000.0 * 1500.0**2)
    assert z_l == pytest.approx(1.5e6)
    assert z_s == pytest.approx(0.0, abs=1e-3 * z_l)


def test_a_modulus_below_zero_by_round_off_is_none():
    assert impedances_of(1000.0, 1500.0, 1000.0 * 1500.0**2 * (1.0 + 1e-12))[1] == 0.0


def test_a_cell_with_void_has_a_longitudinal_impedance_alone():
    """Its bulk modulus is 0, which must not be taken for a solid with shear only."""
    assert impedances_of(RHO, C_LONG, 0.0) == (pytest.approx(RHO * C_LONG), 0.0)


def test_sound_and_a_shock_cross_a_length():
    """The viscosity counts as twice its stress over the density: (3, 4, 5) in km/s."""
    sound_step = waves.sound_step.py_func
    assert sound_step(0.5, 0.5, 1e-3, 0.5, 1.3, 8000.0, 5000.0, 0.0) == pytest.approx(1e-7)
    assert sound_step(0.5, 0.5, 1e-3, 0.5, 1.3, 8000.0, 3000.0, 0.5 * 8000.0 * 4000.0**2) == pytest.approx(1e-7)


def test_a_shock_crosses_less_of_a_cell():
    """From a thousandth of rho c_l^2 on, and by half at half of that; a courant below shock_courant is kept."""
    shocked = waves.SHOCKED * RHO * C_LONG**2
    shares = [waves.share_crossed.py_func(0.7, 0.5, RHO, C_LONG, q) for q in (0.0, 0.5 * shocked, shocked, 9.0 * shocked)]
    assert shares == pytest.approx([0.7, 0.6, 0.5, 0.5])
    assert waves.share_crossed.py_func(0.4, 0.5, RHO, C_LONG, 9.0 * shocked) == 0.4
    step = waves.sound_step.py_func(0.7, 0.5, 1e-3, 0.0, 0.0, RHO, C_LONG, shocked)
    assert step == pytest.approx(0.5e-3 / (C_LONG * np.sqrt(1.0 + 2.0 * waves.SHOCKED)))


def test_the_slope_of_the_viscosity():
    """Half of what 2 du + 0.5 c is at du = 300 m/s and c = 4 km/s."""
    q = 8000.0 * (1.0 * 300.0**2 + 0.5 * 4000.0 * 300.0)
    assert waves.damping_speed.py_func(0.5, 1.0, 8000.0, 4000.0, q) == pytest.approx(0.5 * (2.0 * 300.0 + 0.5 * 4000.0))


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
