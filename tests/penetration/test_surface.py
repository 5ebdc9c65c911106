"""The surface of a projectile: exact projections, known areas, a closed body."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.penetration.model import InputError
from hydro2d.penetration.surface import body_surface, nose_surface
from tests.penetration.noses import SHAPES, a_nose

NOSES = {
    "shape": st.sampled_from(SHAPES), "crh": st.floats(0.5, 12.0), "half_angle": st.floats(0.05, 1.5),
    "rings": st.integers(1, 200),
}


@settings(max_examples=60)
@given(**NOSES)
def test_projections_of_a_nose_sum_to_its_section(shape, crh, half_angle, rings):
    """To round-off, for any number of rings; and all normals are unit vectors that point ahead."""
    nose = nose_surface(a_nose(shape, 0.02, crh, half_angle), rings)
    assert np.sum(nose.axial_area) == pytest.approx(math.pi * 1e-4, rel=1e-13)
    assert np.all(nose.normal_z > 0.0)
    np.testing.assert_allclose(np.hypot(nose.normal_z, nose.normal_r), 1.0, rtol=1e-14)


@settings(max_examples=60)
@given(**NOSES)
def test_every_ring_lies_on_the_nose(shape, crh, half_angle, rings):
    nose = nose_surface(a_nose(shape, 0.02, crh, half_angle), rings)
    length = a_nose(shape, 0.02, crh, half_angle).length
    assert np.all((nose.z <= 0.0) & (nose.z >= -length * (1 + 1e-12)))
    radius = 0.02 * crh if shape == "ogival" else 0.01
    if shape in ("hemispherical", "ogival"):
        away = np.hypot(nose.r - (0.01 - radius), nose.z + length)
        np.testing.assert_allclose(away, radius, rtol=1e-12)
    elif shape == "flat-rounded":
        edge = np.hypot(nose.r - 0.007, nose.z + 0.003)
        assert np.all((nose.z == 0.0) & (nose.r < 0.007) | (np.abs(edge - 0.003) < 1e-15))
    elif shape == "conical":
        np.testing.assert_allclose(-nose.z * math.tan(half_angle), nose.r, rtol=1e-12)


@pytest.mark.parametrize(
    ("shape", "half_angle", "area"),
    [("hemispherical", 0.5, 2.0), ("flat", 0.5, 1.0), ("conical", math.pi / 6, 2.0),
     ("flat-rounded", 0.5, 0.7**2 + math.pi * 0.3 * 0.7 + 2.0 * 0.3**2)],
)
def test_areas_are_those_of_geometry(shape, half_angle, area):
    """In sections of the rod."""
    total = np.sum(nose_surface(a_nose(shape, 0.02, half_angle=half_angle), rings=7).area)
    assert total == pytest.approx(area * math.pi * 1e-4, rel=1e-13)


def test_an_ogive_has_the_length_and_area_of_its_arc():
    """CRH 3: length a sqrt(11); area by quadrature along the arc."""
    nose = nose_surface(a_nose("ogival", 0.02, 3.0), rings=5)
    assert a_nose("ogival", 0.02, 3.0).length == pytest.approx(0.01 * math.sqrt(11.0), rel=1e-14)
    theta = np.linspace(0.0, math.acos(5.0 / 6.0), 20001)
    r = -0.05 + 0.06 * np.cos(theta)
    assert np.sum(nose.area) == pytest.approx(np.trapezoid(2.0 * math.pi * r * 0.06, theta), rel=1e-8)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_uniform_pressure_on_the_whole_body_has_no_resultant(shape):
    body = body_surface(a_nose(shape, 0.02, 3.0, 0.4), 0.2, sectors=16)
    assert np.abs(body.area @ body.normals).max() < 1e-14 * np.sum(body.area)
    torque = np.sum(body.area[:, None] * np.cross(body.points, body.normals), axis=0)
    assert np.abs(torque).max() < 1e-14 * np.sum(body.area) * 0.2


def test_the_volume_inside_is_that_of_hemisphere_and_shank():
    body = body_surface(a_nose("hemispherical", 0.02), 0.2, rings=400)
    inside = np.sum(body.z * body.axial_area)
    assert inside == pytest.approx(math.pi * 1e-4 * 0.19 + 2.0 / 3.0 * math.pi * 1e-6, rel=1e-6)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"shape": "round"}, "unknown nose"),
        ({"crh": 0.4}, "crh = 0.4"),
        ({"shape": "conical", "half_angle": 1.6}, "half_angle = 1.6"),
        ({"shape": "flat-rounded", "edge": 1.2}, "edge_radius = 0.012"),
        ({"diameter": 0.0}, "diameter"),
        ({"rings": 0}, "rings"),
        ({"rings": 2.5}, "rings"),
        ({"sectors": 0}, "sectors"),
    ],
)
def test_impossible_noses_are_refused(change, word):
    sizes = {key: change.pop(key) for key in ("rings", "sectors") if key in change}
    with pytest.raises(InputError, match=re.escape(word)):
        nose_surface(a_nose(**{"shape": "ogival", "diameter": 0.02} | change), **sizes)


def test_a_body_shorter_than_its_nose_is_refused():
    with pytest.raises(InputError, match=r"rod\.length"):
        body_surface(a_nose("ogival", 0.02, 3.0), 0.01)
