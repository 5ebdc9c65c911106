"""The rigid rod on its axis: printed depths, closed form, order, energy, friction."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.penetration import forrestal, rigid_axial
from hydro2d.penetration.forrestal import Target, deep, entering
from hydro2d.penetration.model import InputError
from hydro2d.penetration.rigid_axial import Pressure, penetrate
from hydro2d.penetration.surface import nose_surface
from tests.penetration.noses import SHAPES, a_nose

MASS, DIAMETER, STRENGTH, DENSITY = 0.023, 7.11e-3, 276e6, 2710.0
PRINTED = Pressure(5.0394 * STRENGTH, 0.9830 * DENSITY)
THREE = Pressure(5.0394 * STRENGTH, 0.9402 * DENSITY, 0.9830 * math.sqrt(DENSITY * STRENGTH))
BALL = nose_surface(a_nose("hemispherical", DIAMETER), rings=100)
SHOT = dict(
    rod_mass=MASS, rod_diameter=DIAMETER, nose_shape="hemispherical", nose_crh=3.0, nose_half_angle=0.5, nose_edge_radius=None,
    friction=0.0,
    target_density=DENSITY, target_strength=STRENGTH, cavity_a=5.0394, cavity_b=0.9830, cavity_c=None,
    target_youngs_modulus=None, target_poisson_ratio=None, target_hardening_exponent=0.0, cavity_velocity=1200.0,
    surface_velocity="normal", nose_entry="resisted",
)


@pytest.mark.parametrize(
    ("velocity", "printed", "axial", "normal", "entry", "three", "three_entry"),
    [
        (496.0, 41.9, 41.97741, 46.00408, 47.09970, 41.41504, 42.48439),
        (572.0, 52.8, 52.89938, 59.27111, 60.34398, 52.83717, 53.88549),
        (781.0, 83.9, 84.14786, 100.03803, 101.04908, 87.45153, 88.44606),
        (821.0, 89.9, 90.13449, 108.30286, 109.30274, 94.42264, 95.40776),
        (841.0, 92.9, 93.11474, 112.46944, 113.46383, 97.93432, 98.91485),
        (932.0, 106.2, 106.52239, 131.63135, 132.60185, 114.07302, 115.03369),
        (967.0, 111.3, 111.59834, 139.05897, 140.02076, 120.32810, 121.28156),
    ],
)
def test_the_seven_shots(velocity, printed, axial, normal, entry, three, three_entry):
    """mm: the printed simulation within 0.3 % by the axial reading, and every reading as computed independently."""

    def depth(pressure, surface_velocity, with_entry):
        flight = penetrate(BALL, MASS, velocity, pressure, surface_velocity=surface_velocity, entry=with_entry)
        return flight.depth * 1e3

    whole = depth(PRINTED, "axial", False)
    assert whole == pytest.approx(printed, rel=0.003)
    assert whole == pytest.approx(axial, rel=3e-4)
    assert depth(PRINTED, "normal", False) == pytest.approx(normal, rel=3e-4)
    assert depth(PRINTED, "normal", True) == pytest.approx(entry, rel=3e-4)
    assert depth(THREE, "normal", False) == pytest.approx(three, rel=3e-4)
    assert depth(THREE, "normal", True) == pytest.approx(three_entry, rel=3e-4)


def orders(errors):
    return [math.log2(coarse / fine) for coarse, fine in zip(errors, errors[1:], strict=False)]


def test_first_order_in_time():
    """Against the closed form for the same rings: N2 as given by the rings."""
    rings = nose_surface(a_nose("hemispherical", DIAMETER), rings=20)
    whole = math.pi * DIAMETER**2 / 4.0
    n2 = np.sum(rings.normal_z**3 * rings.area) / whole
    ratio = PRINTED.dynamic * n2 * 781.0**2 / PRINTED.static
    exact = MASS / (2.0 * whole * PRINTED.dynamic * n2) * math.log1p(ratio)
    errors = [abs(penetrate(rings, MASS, 781.0, PRINTED, entry=False, time_step=dt).depth - exact)
              for dt in (2e-6, 1e-6, 5e-7, 2.5e-7)]
    assert all(0.9 < order < 1.1 for order in orders(errors))


def test_second_order_in_the_rings():
    """Depth with a small time step, its own error removed by extrapolation."""
    exact = deep(781.0, MASS, forrestal.Nose(a_nose("hemispherical", DIAMETER)), Target(PRINTED.static, PRINTED.dynamic))[0]
    errors = []
    for count in (3, 6, 12):
        rings = nose_surface(a_nose("hemispherical", DIAMETER), rings=count)
        coarse, fine = (penetrate(rings, MASS, 781.0, PRINTED, entry=False, time_step=dt).depth for dt in (4e-7, 2e-7))
        errors.append(abs(2.0 * fine - coarse - exact))
    assert all(1.9 < order < 2.1 for order in orders(errors))


@pytest.mark.parametrize("shape", ["hemispherical", "ogival", "conical", "flat"])
def test_the_closed_form_with_entry_and_friction(shape):
    shaped = a_nose(shape, DIAMETER, 3.0, 0.4)
    nose = forrestal.Nose(shaped, 0.05)
    flight = penetrate(nose_surface(shaped, 200), MASS, 781.0, PRINTED, friction=0.05, time_step=5e-8)
    depth, duration = entering(781.0, MASS, nose, Target(PRINTED.static, PRINTED.dynamic))
    assert flight.depth == pytest.approx(depth, rel=2e-4)
    assert flight.duration == pytest.approx(duration, rel=2e-4)


@settings(max_examples=20)
@given(
    st.sampled_from(SHAPES), st.floats(100.0, 1500.0), st.floats(0.01, 0.1),
    st.floats(0.0, 0.2), st.sampled_from(("normal", "axial")), st.booleans(),
)
def test_loss_of_kinetic_energy_is_the_work_of_the_force(shape, velocity, mass, friction, surface_velocity, entry):
    """To round-off by the steps' own sum; and by quadrature of the recorded force over the recorded depth."""
    rings = nose_surface(a_nose(shape, DIAMETER), rings=30)
    flight = penetrate(
        rings, mass, velocity, PRINTED, friction=friction, surface_velocity=surface_velocity, entry=entry,
        time_step=0.01 * DIAMETER / velocity,
    )
    lost = 0.5 * mass * velocity**2
    assert flight.work == pytest.approx(lost, rel=1e-10)
    _, depth, _, pushed = flight.history.T
    assert np.trapezoid([*pushed, pushed[-1]], [*depth, flight.depth]) == pytest.approx(lost, rel=0.02)
    assert np.all(np.diff(flight.history[:, 2]) <= 0.0)


def test_a_static_pressure_on_a_flat_nose_is_exact():
    """Constant force: M V^2/2F, for any step."""
    rings = nose_surface(a_nose("flat", DIAMETER), rings=3)
    exact = 0.5 * MASS * 500.0**2 / (1e9 * math.pi * DIAMETER**2 / 4.0)
    for dt in (1e-6, 3e-7):
        assert penetrate(rings, MASS, 500.0, Pressure(1e9, 0.0), time_step=dt).depth == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("velocity", [1.0, 20.0, 3000.0])
def test_slow_and_fast_rods(velocity):
    depth = penetrate(BALL, MASS, velocity, PRINTED).depth
    nose, target = forrestal.Nose(a_nose("hemispherical", DIAMETER)), Target(PRINTED.static, PRINTED.dynamic)
    exact = entering(velocity, MASS, nose, target)[0]
    assert depth == pytest.approx(exact, rel=0.01)


@pytest.mark.parametrize(
    ("change", "word"),
    [({"rod_mass": 0.0}, "mass"), ({"friction": -0.1}, "friction"), ({"cavity_a": -1.0}, "static"),
     ({"cavity_c": -1.0}, "dynamic"), ({"cavity_b": None}, r"cavity\.b")],
)
def test_impossible_shots_are_refused(change, word):
    with pytest.raises(InputError, match=word):
        rigid_axial.evaluate(781.0, **SHOT | change)


def test_a_rod_that_never_stops_is_refused():
    with pytest.raises(InputError, match="time_step"):
        penetrate(BALL, MASS, 500.0, PRINTED, time_step=1e-13)
