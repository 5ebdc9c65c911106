"""The rigid body: free motion, symmetry, layers, and its limits along the axis."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from hydro2d.penetration import rigid_axial, rigid_body, rotation
from hydro2d.penetration.layers import Layer, gap, stack
from hydro2d.penetration.model import InputError
from hydro2d.penetration.projectile import load, projectile, rigid
from hydro2d.penetration.rigid_body import MODEL, drift, kick, kinetic_energy, launch, penetrate
from hydro2d.penetration.surface import body_surface, nose_surface
from tests.penetration.noses import a_nose

# Forrestal & Piekutowski (2000): 7.11 mm steel rods with a spherical nose, 23 g, 74.7 mm long, into 6061-T6511
DIAMETER, MASS, LENGTH = 7.11e-3, 0.023, 74.7e-3 - 7.11e-3 / 6.0
A, B, STRENGTH, DENSITY = 5.0394, 0.9830, 276e6, 2710.0
HALF_SPACE = Layer(math.inf, DENSITY, STRENGTH, A, B)


def plate(thickness: float) -> Layer:
    return Layer(thickness, DENSITY, STRENGTH, A, B)


@pytest.fixture(scope="module")
def rod():
    """Coarse: these tests do not depend on the number of facets unless they say so."""
    return projectile(a_nose("hemispherical", DIAMETER), MASS, LENGTH, rings=24, shank_rings=24, sectors=12)


@pytest.fixture(scope="module")
def ogive():
    return projectile(a_nose("ogival", DIAMETER), MASS, LENGTH, rings=24, shank_rings=24, sectors=12)


# --- the body


def test_mass_properties_of_a_cylinder():
    body = rigid(body_surface(a_nose("flat", 0.02), 0.1, rings=200, shank_rings=10, tail_rings=200, sectors=4), 2.0)
    assert body.moments[0] == pytest.approx(2.0 * 0.01**2 / 2.0, rel=2e-5)
    assert body.moments[1] == pytest.approx(2.0 * (0.01**2 / 4.0 + 0.1**2 / 12.0), rel=1e-6)
    assert body.tip == pytest.approx(0.05, rel=1e-12)


def test_mass_properties_of_a_rod_with_a_spherical_nose():
    """Cylinder and half ball about their common centre of mass, by the theorem of Steiner."""
    a, shank = 0.01, 0.08
    cylinder, ball = math.pi * a**2 * shank, 2.0 / 3.0 * math.pi * a**3
    volume = cylinder + ball
    places = np.array([-0.5 * shank, 3.0 / 8.0 * a])  # from the base of the nose
    centre = (cylinder * places[0] + ball * places[1]) / volume
    across = cylinder * (a**2 / 4 + shank**2 / 12 + (places[0] - centre) ** 2)
    across += ball * (83.0 / 320.0 * a**2 + (places[1] - centre) ** 2)
    along = cylinder * a**2 / 2 + ball * 2.0 / 5.0 * a**2
    body = projectile(a_nose("hemispherical", 2 * a), 1.0, volume / (math.pi * a**2), rings=200)
    assert body.tip == pytest.approx(a - centre, rel=1e-5)
    assert body.moments == pytest.approx((along / volume, across / volume), rel=1e-3)  # second order in the rings


def test_an_open_surface_is_no_body():
    with pytest.raises(InputError, match="not closed"):
        rigid(nose_surface(a_nose("hemispherical", 0.01), sectors=4), 1.0)
    with pytest.raises(InputError, match="even number"):
        rigid(body_surface(a_nose("flat", 0.01), 0.1, sectors=3), 1.0)
    with pytest.raises(InputError, match="shorter than its nose|positive"):
        projectile(a_nose("ogival", 0.01), 1.0, 0.001)


# --- free motion


def test_free_precession_is_the_exact_solution(rod):
    """In the body's frame the transverse spin turns at (1 - I_a/I_t) omega_1: exactly, for steps of any length."""
    axial, transverse = rod.moments
    spin = np.array([300.0, 0.0, 2000.0])
    momentum = spin * [transverse, transverse, axial]
    motion = rigid_body.Motion(np.zeros(3), np.array([1.0, 2.0, 3.0]), momentum, rotation.IDENTITY)
    for _ in range(200):
        motion = drift(rod, motion, 1.7e-4)
    time = 200 * 1.7e-4
    phase = (axial / transverse - 1.0) * 2000.0 * time
    expected = [300.0 * math.cos(phase), 300.0 * math.sin(phase), 2000.0]
    computed = rotation.matrix(motion.attitude).T @ motion.momentum / [transverse, transverse, axial]
    assert computed == pytest.approx(expected, rel=1e-10, abs=1e-8)
    assert motion.momentum == pytest.approx(momentum, rel=0)
    assert motion.position == pytest.approx(time * motion.velocity, rel=1e-12)


def test_free_flight_conserves_energy(rod):
    start = launch(rod, 800.0, 0.2, -0.1, 3000.0, 0.3)
    motion = kick(rod, start, np.zeros(3), np.array([0.4, -0.7, 0.2]), 1e-3)  # set tumbling
    energy = kinetic_energy(rod, motion)
    for _ in range(500):
        motion = drift(rod, motion, 3e-5)
    assert kinetic_energy(rod, motion) == pytest.approx(energy, rel=1e-12)


def test_forced_rotation_follows_eulers_equations(rod):
    """Under a torque fixed in space the steps converge, at second order, to an independent integration."""
    moments = np.array([rod.moments[1], rod.moments[1], rod.moments[0]])
    torque, spin, end = np.array([0.9, 0.3, -0.2]), np.array([40.0, -30.0, 500.0]), 0.01

    def euler(_, y):
        turned = Rotation.from_quat(y[:4]).as_matrix()
        rate = (turned.T @ torque - np.cross(y[4:], moments * y[4:])) / moments
        x, y_, z, w = y[:4]
        p, q, r = y[4:]
        return [0.5 * (w * p + y_ * r - z * q), 0.5 * (w * q + z * p - x * r), 0.5 * (w * r + x * q - y_ * p),
                -0.5 * (x * p + y_ * q + z * r), *rate]

    exact = solve_ivp(euler, (0.0, end), [0, 0, 0, 1, *spin], rtol=1e-11, atol=1e-12, method="DOP853").y[:4, -1]
    errors = []
    for steps in (100, 200, 400):
        motion, dt = rigid_body.Motion(np.zeros(3), np.zeros(3), spin * moments, rotation.IDENTITY), end / steps
        for count in range(steps):
            motion = drift(rod, kick(rod, motion, np.zeros(3), torque, dt if count else 0.5 * dt), dt)
        errors.append(np.max(np.abs(rotation.matrix(motion.attitude) - Rotation.from_quat(exact).as_matrix())))
    assert errors[2] < 1e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.1)


# --- the load


def test_load_along_the_axis_is_the_closed_form(ogive):
    """Deep in, a hemisphere: pi a^2 (A Y + B rho V^2/2). Nothing across to the last bit, no torque to round-off."""
    body = projectile(a_nose("hemispherical", DIAMETER), MASS, LENGTH, rings=200, shank_rings=10, sectors=8)
    target, ahead, v = stack([HALF_SPACE]), np.array([0.0, 0.0, 1.0]), 821.0
    force, torque = load(body, target, 0.0, 1.0, 1.0, ahead, v * ahead, np.zeros(3))
    exact = math.pi * (DIAMETER / 2) ** 2 * (A * STRENGTH + 0.5 * B * DENSITY * v**2)
    assert -force[2] == pytest.approx(exact, rel=1e-5)
    assert [*force[:2], *torque[:2]] == [0.0] * 4
    assert abs(torque[2]) < 1e-15 * exact * DIAMETER
    force, torque = load(ogive, target, 0.1, 1.0, 1.0, ahead, v * ahead, np.array([0.0, 0.0, 4000.0]))
    assert [*force[:2], *torque[:2]] == [0.0] * 4
    assert torque[2] < 0.0, "friction slows the spin"


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_load_is_the_sum_over_the_facets(ogive, friction):
    """A tumbling rod half in an oblique plate, facet by facet with vectors."""
    target, depth = stack([plate(0.01), Layer(0.02, 7800.0, 1e9, 4.0, 1.1)]), 0.012
    inward, velocity, spin = np.array([0.6, 0.0, 0.8]), np.array([-90.0, 40.0, 500.0]), np.array([3000.0, -5000.0, 800.0])
    points, normals = (field.reshape(3, -1).T for field in (ogive.points, ogive.normals))
    force, torque = np.zeros(3), np.zeros(3)
    for x, n, area, flank in zip(points, normals, ogive.area.ravel(), ogive.flank.ravel(), strict=True):
        v, place = velocity + np.cross(spin, x), depth + inward @ x
        if not (0.0 <= place < 0.03 and v @ n > 0.0):
            continue
        y, rho = (A * STRENGTH, B * DENSITY) if place < 0.01 else (4e9, 1.1 * 7800.0)
        pressure = y * (min((v @ n) / 7.0, 1.0) if flank else 1.0) + rho * (v @ n) ** 2
        sliding = v - (v @ n) * n
        push = -pressure * area * (n + friction * sliding / np.linalg.norm(sliding))
        force, torque = force + push, torque + np.cross(x, push)
    computed = load(ogive, target, friction, 7.0, depth, inward, velocity, spin)
    assert computed[0] == pytest.approx(force, rel=1e-10)
    assert computed[1] == pytest.approx(torque, rel=1e-10)


def test_only_facets_inside_a_layer_feel_it(rod):
    ahead = np.array([0.0, 0.0, 1.0])

    def push(layers, depth):
        return -load(rod, stack(layers), 0.0, 1.0, depth, ahead, 500.0 * ahead, np.zeros(3))[0][2]

    deep = push([HALF_SPACE], 1.0)
    assert push([HALF_SPACE], -rod.tip) == 0.0, "touching, not in"
    assert push([plate(0.02)], 0.02 + 1.0) == 0.0, "behind the plate"
    assert push([plate(0.02)], 0.019 - rod.tip) == deep
    assert 0.0 < push([plate(0.02)], 0.02 + DIAMETER / 4 - rod.tip) < deep, "the nose comes out"
    assert push([plate(0.02), gap(0.05), plate(0.02)], 0.045 - rod.tip) == 0.0, "between two plates"


# --- along the axis


@pytest.mark.parametrize(("velocity", "depth"), [
    (496.0, 47.100), (572.0, 60.344), (781.0, 101.049), (821.0, 109.303), (841.0, 113.464), (932.0, 132.602), (967.0, 140.021),
])
def test_depths_of_a_spherical_nose(velocity, depth):
    """mm, by quadrature of M v dv/dz over the entry of the nose and in closed form from there on."""
    body = projectile(a_nose("hemispherical", DIAMETER), MASS, LENGTH, shank_rings=2, sectors=4)
    shot = penetrate(body, [HALF_SPACE], velocity, time_step=1.5e-7)
    assert shot.regime == "embedded"
    assert 1e3 * shot.depth == pytest.approx(depth, rel=2e-4)


@pytest.mark.parametrize("friction", [0.0, 0.08])
@pytest.mark.parametrize("nose", ["hemispherical", "ogival", "conical", "flat"])
def test_along_the_axis_it_is_the_one_dimensional_model(nose, friction):
    """Rings, step, order of operations and stop are the same: depth and time agree to round-off."""
    body = projectile(a_nose(nose, DIAMETER), MASS, LENGTH, rings=40, shank_rings=4, sectors=6)
    surface, pressure = nose_surface(a_nose(nose, DIAMETER), rings=40), rigid_axial.Pressure(A * STRENGTH, B * DENSITY)
    axial = rigid_axial.penetrate(surface, MASS, 821.0, pressure, friction=friction, time_step=3e-7)
    shot = penetrate(body, [HALF_SPACE], 821.0, friction=friction, time_step=3e-7)
    assert shot.depth == pytest.approx(axial.depth, rel=1e-12)
    assert shot.duration == pytest.approx(axial.duration, rel=1e-12)
    assert shot.history[:-1, 1] == pytest.approx(axial.history[:, 1], rel=1e-12, abs=1e-15)


def test_first_order_in_the_time_step(rod):
    """Deep in a half space M dv/dt = -(c + d v^2) has v = sqrt(c/d) tan(phase): the place after 1e-4 s at 821 m/s."""
    target, ahead, time = stack([HALF_SPACE]), np.array([0.0, 0.0, 1.0]), 1e-4

    def resistance(v):
        return -load(rod, target, 0.0, 1.0, 1.0, ahead, v * ahead, np.zeros(3))[0][2]

    c = resistance(1e-9)
    d = (resistance(821.0) - c) / 821.0**2
    scale, phase = math.sqrt(c / d), math.atan(821.0 * math.sqrt(d / c))
    turned = time * math.sqrt(c * d) / MASS
    exact = MASS / d * math.log(math.cos(phase - turned) / math.cos(phase))
    assert scale * math.tan(phase - turned) > 300.0, "still under way"
    errors = []
    for steps in (50, 100, 200, 400):
        motion = rigid_body.Motion(1.0 * ahead, 821.0 * ahead, np.zeros(3), rotation.IDENTITY)
        for count in range(steps):
            force, torque = rigid_body.push(rod, target, 0.0, 8.0, motion)
            motion = drift(rod, kick(rod, motion, force, torque, time / steps * (1.0 if count else 0.5)), time / steps)
        errors.append(abs(motion.position[2] - 1.0 - exact))
    assert errors[-1] < 1e-5
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx([1.0] * 3, abs=0.05)


# --- six degrees of freedom


def test_no_pitch_stays_on_the_axis(rod):
    shot = penetrate(rod, [HALF_SPACE], 700.0, spin=2000.0, friction=0.05)
    assert (shot.pitch, shot.yaw, shot.drift) == (0.0, 0.0, 0.0)


def test_oblique_to_its_axis_but_not_to_its_flight_stays_on_the_axis_to_round_off():
    """Obliquity in the fixed frame only: deep in a layer, the positions of the faces do not matter."""
    body = projectile(a_nose("hemispherical", DIAMETER), MASS, LENGTH, rings=24, shank_rings=24, sectors=12)
    target = stack([HALF_SPACE])
    motion = launch(body, 800.0, 0.0, 0.0, 0.0, 0.7)
    motion = rigid_body.Motion(motion.position + [0, 0, 1.0], motion.velocity, motion.momentum, motion.attitude)
    force, torque = rigid_body.push(body, target, 0.0, 8.0, motion)
    along = motion.velocity / 800.0
    assert np.linalg.norm(force - (force @ along) * along) < 1e-9 * np.linalg.norm(force)
    assert np.linalg.norm(torque) < 1e-9 * np.linalg.norm(force) * LENGTH


@pytest.mark.thorough
@pytest.mark.parametrize("friction", [0.0, 0.1])
@pytest.mark.parametrize("angles", [{"pitch": 0.05}, {"obliquity": 0.6, "yaw": -0.1}, {"pitch": 1.2, "spin": 3000.0},
                                    {"obliquity": 1.45}])
def test_energy_never_grows(rod, angles, friction):
    """At the very end a step may push a resting rod back: by less energy than its pressure gives in one step."""
    dt = rigid_body.step(rod, stack([HALF_SPACE]), 600.0, 3.0)
    shot = penetrate(rod, [HALF_SPACE], 600.0, friction=friction, time_step=dt, touch=3.0, **angles)
    energy = shot.history[:, 3]
    growth, moving = np.diff(energy), energy[:-1] > 1e-3 * energy[0]
    assert np.max(growth[moving]) <= 1e-12 * energy[0]
    assert np.max(growth) <= (A * STRENGTH * DIAMETER * LENGTH * dt) ** 2 / (2.0 * MASS) < 1e-4 * energy[0]


def test_pitch_and_yaw_mirror(rod):
    plus = penetrate(rod, [plate(0.03)], 800.0, pitch=0.06, yaw=0.02)
    minus = penetrate(rod, [plate(0.03)], 800.0, pitch=-0.06, yaw=-0.02)
    assert (minus.pitch, minus.yaw) == pytest.approx((-plus.pitch, -plus.yaw), rel=1e-6)
    assert minus.residual_velocity == pytest.approx(plus.residual_velocity, rel=1e-9)


def test_perforation_leaves_what_the_work_leaves(ogive):
    """Along the axis at constant pressure (B = 0) the plate costs A Y pi a^2 T, for any nose."""
    layer = Layer(0.02, DENSITY, STRENGTH, A, 0.0)
    shot = penetrate(ogive, [layer], 800.0, time_step=1e-7)
    cost = A * STRENGTH * math.pi * (DIAMETER / 2) ** 2 * 0.02
    assert shot.regime == "perforated"
    assert shot.depth == 0.02
    assert shot.residual_velocity == pytest.approx(math.sqrt(800.0**2 - 2.0 * cost / MASS), rel=1e-4)


def test_two_spaced_plates_turn_a_pitched_rod(rod):
    """Between the plates the rod coasts: no loss of energy there, and pitch grows with the width of the gap."""
    narrow = penetrate(rod, [plate(0.01), gap(0.05), plate(0.01)], 900.0, pitch=0.1, touch=9.0)
    wide = penetrate(rod, [plate(0.01), gap(0.30), plate(0.01)], 900.0, pitch=0.1, touch=9.0)
    assert narrow.regime == wide.regime == "perforated"
    assert abs(wide.pitch) > abs(narrow.pitch) > 0.1


def test_ricochet_at_a_grazing_angle(rod):
    shot = penetrate(rod, [HALF_SPACE], 600.0, obliquity=math.radians(85.0))
    assert shot.regime == "ricochet"
    assert 0.0 < shot.depth < DIAMETER
    assert 0.5 * 600.0 < shot.residual_velocity < 600.0
    assert shot.final.velocity[2] < 0.0


# --- the interface to users

GIVEN = {
    "rod.mass": MASS, "rod.diameter": DIAMETER, "rod.length": LENGTH, "target.density": DENSITY, "target.strength": STRENGTH,
    "cavity.a": A, "cavity.b": B,
}


def test_model():
    result = MODEL(821.0, GIVEN)
    assert result["regime"] == "embedded"
    assert result["depth"] == pytest.approx(0.10928, rel=5e-4)
    assert MODEL(821.0, {**GIVEN, "target.thickness": 0.02})["regime"] == "perforated"


@pytest.mark.parametrize(("velocity", "change", "message"), [
    (0.0, {}, "velocity"),
    (800.0, {"obliquity": 1.6}, "obliquity"),
    (800.0, {"target.strength": -1.0}, "target.strength"),
    (800.0, {"rod.length": 0.001}, "rod.length"),
])
def test_wrong_input(velocity, change, message):
    with pytest.raises(InputError, match=message):
        MODEL(velocity, {**GIVEN, **change})


@pytest.mark.parametrize(("layers", "message"), [
    ([], "at least one"),
    ([HALF_SPACE, plate(0.01)], "behind"),
    ([Layer(math.inf, 1000.0, 0.0, 1.0, 1.0)], "never stops"),
])
def test_wrong_layers(layers, message):
    with pytest.raises(InputError, match=message):
        stack(layers)
    with pytest.raises(InputError, match="thickness"):
        gap(0.0)
