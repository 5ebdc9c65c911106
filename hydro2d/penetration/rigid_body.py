"""A rigid projectile in free flight through layers of target: six degrees of freedom, the area force law.

The rod keeps its shape. Every facet of its surface that lies inside a layer and moves into it feels the pressure
A Y + B rho Vn^2 of that layer's cavity expansion, and friction; force and torque move the body, which may pitch, yaw,
spin, stop, pass through with a residual velocity, or glance off. The framework is that of
Ahmad Zaidi, Li & Yusof, Penetration depth prediction in mesh-less metal targets (2008), who followed the axis alone.
explanation/penetration/rigid-body
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from hydro2d.base.parameters import ANY
from hydro2d.penetration import inputs
from hydro2d.penetration.cavity import CAVITY_VELOCITY, given_or_fitted
from hydro2d.penetration.layers import Layer, Target, stack
from hydro2d.penetration.model import Example, Input, InputError, Model, Output, non_negative, positive
from hydro2d.penetration.projectile import Body, load, projectile
from hydro2d.penetration.rotation import coast, matrix, pointing

#: a step carries the rod by no more than this share of its diameter
STRIDE = 0.04
#: share of the impact velocity from which on the flank's static pressure is full, and largest stable time step over the
#: ratio of mass to the flank's stiffness
TOUCH, STIFFNESS = 0.005, 1.0
#: a rod slower than this share of the impact velocity has stopped, and the number of steps that a shot may take
REST, MOST_STEPS = 1e-6, 100_000
#: the remaining duration of a shot is checked once, when the rod has travelled this many of its lengths
FORECAST = 2.0


@dataclass(frozen=True)
class Motion:
    """Position, velocity and attitude of the body in the fixed frame: z is depth, x lies in the plane of obliquity.

    ``position`` (m) and ``velocity`` (m/s) of the centre of mass, angular ``momentum`` about it (kg m^2/s),
    ``attitude`` from the body's frame to the fixed one.
    """

    position: np.ndarray
    velocity: np.ndarray
    momentum: np.ndarray
    attitude: np.ndarray


@dataclass(frozen=True)
class Shot:
    """The outcome of a shot. ``regime`` is "embedded", "perforated" or "ricochet"; SI, angles in rad.

    ``depth`` is the largest depth in the target of any part of the rod, ``drift`` the distance of the
    centre of mass from the line of flight before impact, ``pitch`` and ``yaw`` the angles of the rod's axis with that
    line, in the plane of obliquity and out of it. ``history`` has rows of time, depth of the tip, speed and kinetic
    energy with its rotational part.
    """

    regime: str
    depth: float
    residual_velocity: float
    duration: float
    pitch: float
    yaw: float
    drift: float
    final: Motion
    history: np.ndarray


def penetrate(body: Body, layers: Sequence[Layer], velocity: float, *, pitch: float = 0.0, yaw: float = 0.0,
              spin: float = 0.0, obliquity: float = 0.0, friction: float = 0.0, time_step: float | None = None,
              touch: float | None = None) -> Shot:
    """The shot of ``body`` at ``layers`` with the impact ``velocity``, m/s.

    ``pitch`` turns the nose away from the line of flight in the plane of obliquity, towards larger obliquity; ``yaw``
    turns it out of that plane; ``spin`` about the axis in rad/s; ``obliquity`` between the line of flight and the
    target's normal. ``touch`` (m/s): see ``projectile.load``; a two-hundredth of the impact velocity where not given.
    Central differences with ``time_step`` (s), of first order. Raises InputError for impossible input.
    """
    positive(velocity=velocity)
    non_negative(friction=friction)
    if not abs(obliquity) < 0.5 * math.pi:
        raise InputError(f"obliquity = {obliquity:g}: must lie between -pi/2 and pi/2 rad")
    target = stack(layers)
    touch = TOUCH * velocity if touch is None else touch
    positive(touch=touch)
    dt = step(body, target, velocity, touch if pitch or yaw or obliquity else math.inf) if time_step is None else time_step
    positive(time_step=dt)
    start = launch(body, velocity, pitch, yaw, spin, obliquity)
    return _report(target, obliquity, start, *_fly(body, target, friction, touch, dt, start))


def launch(body: Body, velocity: float, pitch: float, yaw: float, spin: float, obliquity: float) -> Motion:
    """The motion at first touch of the struck face, with the centre of mass on the depth axis x = y = 0."""
    attitude = pointing(obliquity + pitch, yaw)
    turned = matrix(attitude)
    return Motion(
        position=np.array([0.0, 0.0, -np.max(turned[2] @ body.outline)]),
        velocity=velocity * np.array([math.sin(obliquity), 0.0, math.cos(obliquity)]),
        momentum=body.moments[0] * spin * turned[:, 2],
        attitude=attitude,
    )


def step(body: Body, target: Target, velocity: float, touch: float) -> float:
    """The default time step, s: that of one stride of the rod, or the largest that the flank's stiffness allows, if less.

    ``touch`` is infinite for a rod whose flank never pushes.
    """
    stiffness = float(np.max(target.static)) * body.flank_projection / touch
    stride = STRIDE * body.diameter / velocity
    return min(stride, STIFFNESS * body.mass / stiffness) if stiffness > 0.0 else stride


def kinetic_energy(body: Body, motion: Motion) -> float:
    """M v^2/2 + L . omega/2, J; explanation/penetration/rigid-body, equation 2."""
    axial, transverse = body.moments
    along = matrix(motion.attitude)[:, 2] @ motion.momentum
    across = motion.momentum @ motion.momentum - along * along
    return 0.5 * (body.mass * (motion.velocity @ motion.velocity) + along * along / axial + across / transverse)


def push(body: Body, target: Target, friction: float, touch: float, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Force (N) and torque (N m) on the body in the fixed frame."""
    turned = matrix(motion.attitude)
    spin = (turned.T @ motion.momentum) / np.array([body.moments[1], body.moments[1], body.moments[0]])
    force, torque = load(body, target, friction, touch, motion.position[2], turned[2], turned.T @ motion.velocity, spin)
    return turned @ force, turned @ torque


def kick(body: Body, motion: Motion, force: np.ndarray, torque: np.ndarray, time: float) -> Motion:
    """Velocity and angular momentum after a push; explanation/penetration/rigid-body, equation 10."""
    velocity = motion.velocity + (time / body.mass) * force
    return Motion(motion.position, velocity, motion.momentum + time * torque, motion.attitude)


def drift(body: Body, motion: Motion, time: float) -> Motion:
    """Position and attitude after free motion, exact; explanation/penetration/rigid-body, equations 9 and 10."""
    attitude = coast(motion.attitude, motion.momentum, *body.moments, time)
    return Motion(motion.position + time * motion.velocity, motion.velocity, motion.momentum, attitude)


def _fly(body, target, friction, touch, dt, motion):
    """Steps until the rod stops or leaves: (regime, duration, deepest point, last motion, history)."""
    outline, speed = body.outline, math.sqrt(motion.velocity @ motion.velocity)
    rest, forecast = REST * speed, int(FORECAST * np.ptp(body.outline[2]) / (speed * dt))
    deepest, history, regime = 0.0, [_row(body, motion, 0.0)], ""
    if forecast > MOST_STEPS:
        raise InputError(f"time_step = {dt:g}: the rod, {np.ptp(outline[2]):g} m long, would not have moved by its own length "
                         f"after {MOST_STEPS // FORECAST:g} steps: it is too slender, or its flank too stiff, for this model")
    for count in range(MOST_STEPS):
        if count == forecast:
            _refuse_a_long_way(body, target, friction, touch, motion, dt)
        pushed = kick(body, motion, *push(body, target, friction, touch, motion), dt if count else 0.5 * dt)
        if _stopped(motion.velocity, pushed.velocity, rest):
            regime, pushed, time = "embedded", *_halt(motion, pushed, count * dt, dt)
        else:
            pushed, time = drift(body, pushed, dt), (count + 1) * dt
        motion = pushed
        depths = motion.position[2] + matrix(motion.attitude)[2] @ outline
        deepest = max(deepest, float(np.max(depths)))
        history.append(_row(body, motion, time))
        regime = regime or _left(depths, motion, target)
        if regime:
            return regime, time, deepest, motion, np.array(history)
    raise InputError(f"time_step = {dt:g}: the rod has neither stopped nor left after {MOST_STEPS} steps")


def _refuse_a_long_way(body: Body, target: Target, friction: float, touch: float, motion: Motion, dt: float) -> None:
    """InputError if the rod, slowed by a + b v^2 as it is now, would need more than ``MOST_STEPS`` steps to stop or leave.

    It stops after M/sqrt(a b) arctan(v sqrt(b/a)); a and b follow from the force at this velocity and at half of it.
    """
    speed = math.sqrt(motion.velocity @ motion.velocity)
    slower = replace(motion, velocity=0.5 * motion.velocity)
    whole, half = (np.linalg.norm(push(body, target, friction, touch, at)[0]) for at in (motion, slower))
    inertial = max(whole - half, 0.0) / 0.75
    static = max(whole - inertial, 1e-12 * whole)
    if inertial > 1e-6 * whole:
        ratio = math.sqrt(inertial / static)
        to_rest = body.mass * speed / (static * ratio) * math.atan(ratio)
    else:
        to_rest = body.mass * speed / static if static > 0.0 else math.inf
    to_leave = (target.back - motion.position[2]) / speed
    if min(to_rest, to_leave) > MOST_STEPS * dt:
        raise InputError(f"the target hardly resists: the rod would be in motion for {min(to_rest, to_leave):.3g} s, "
                         f"more than {MOST_STEPS} steps of this model; a plate needs target.thickness")


def _stopped(before: np.ndarray, after: np.ndarray, rest: float) -> bool:
    """Whether the velocity has reversed within a step, or is practically zero."""
    return before @ after <= 0.0 or after @ after < rest * rest


def _halt(before: Motion, after: Motion, time: float, dt: float) -> tuple[Motion, float]:
    """The motion at rest and its time: the vertex of the parabola through this step's mean velocity and acceleration."""
    mean, change = 0.5 * (before.velocity + after.velocity), after.velocity - before.velocity
    left = -dt * float(mean @ change) / float(change @ change)
    return Motion(before.position + 0.5 * left * mean, np.zeros(3), np.zeros(3), before.attitude), time + left


def _left(depths: np.ndarray, motion: Motion, target: Target) -> str:
    """The way in which the whole rod has left the target; empty if it has not."""
    if np.min(depths) >= target.back:
        return "perforated"
    return "ricochet" if np.max(depths) <= 0.0 and motion.velocity[2] < 0.0 else ""


def _row(body: Body, motion: Motion, time: float) -> tuple[float, float, float, float]:
    tip = motion.position[2] + matrix(motion.attitude)[2, 2] * body.tip
    return time, tip, math.sqrt(motion.velocity @ motion.velocity), kinetic_energy(body, motion)


def _report(target, obliquity, start, regime, duration, deepest, motion, history) -> Shot:
    axis = matrix(motion.attitude)[:, 2]
    line, moved = start.velocity / math.sqrt(start.velocity @ start.velocity), motion.position - start.position
    aside = moved - (moved @ line) * line
    return Shot(
        regime=regime,
        depth=min(deepest, target.back),
        residual_velocity=math.sqrt(motion.velocity @ motion.velocity),
        duration=duration,
        pitch=math.remainder(math.atan2(axis[0], axis[2]) - obliquity, 2.0 * math.pi),
        yaw=math.asin(min(max(axis[1], -1.0), 1.0)),
        drift=math.sqrt(aside @ aside),
        final=motion,
        history=history,
    )


def evaluate(
    velocity, *, rod_mass, rod_length, friction, target_density, target_strength, target_thickness, pitch, yaw, spin, obliquity,
    **others,
):
    """A rod with the named nose into one plate, or a half space if no thickness is given; keywords as in ``MODEL.inputs``."""
    nose = inputs.taken_nose(others)
    a, b = given_or_fitted(target_density=target_density, target_strength=target_strength, **others)
    body = projectile(nose, rod_mass, rod_length)
    layer = Layer(math.inf if target_thickness is None else target_thickness, target_density, target_strength, a, b)
    shot = penetrate(body, [layer], velocity, pitch=pitch, yaw=yaw, spin=spin, obliquity=obliquity, friction=friction)
    return {output.name: getattr(shot, output.name) for output in MODEL.outputs}


PITCH = Input(
    "pitch", "rad", "angle of the rod's axis with the line of flight, in the plane of obliquity", default=0.0, sign=ANY)
YAW = Input(
    "yaw", "rad", "angle of the rod's axis with the line of flight, out of the plane of obliquity", default=0.0, sign=ANY)
SPIN = Input("spin", "rad/s", "angular velocity about the rod's axis", "omega_1", default=0.0, sign=ANY)

MODEL = Model(
    name="rigid-body",
    title="Rigid body: six degrees of freedom under the area force law",
    source="Ahmad Zaidi, Li & Yusof, Penetration depth prediction in mesh-less metal targets (2008), eqs. (1)-(9)",
    validity="rods that do not deform; plane layers; a target that the rod's passage has not disturbed, no spall or petals",
    inputs=(
        inputs.ROD_MASS, inputs.ROD_DIAMETER, inputs.ROD_LENGTH,
        *inputs.NOSE,
        inputs.FRICTION.but(description="coefficient of sliding friction on nose and shank"),
        inputs.TARGET_DENSITY, inputs.TARGET_STRENGTH, inputs.CAVITY_A, inputs.CAVITY_B,
        inputs.TARGET_YOUNGS_MODULUS.but(default=None), inputs.TARGET_POISSON_RATIO.but(default=None),
        inputs.TARGET_HARDENING_EXPONENT, CAVITY_VELOCITY,
        inputs.TARGET_THICKNESS.but(default=None, description="thickness of the plate; a half space where not given"),
        PITCH, YAW, SPIN, inputs.OBLIQUITY,
    ),
    outputs=(
        Output("depth", "m", "largest depth of the rod in the target", "P"),
        Output("residual_velocity", "m/s", "speed of the centre of mass at the end", "V_r"),
        Output("duration", "s", "time from touch to rest, or until the whole rod has left"),
        Output("pitch", "rad", "angle of the axis with the first line of flight at the end, in the plane of obliquity"),
        Output("yaw", "rad", "angle of the axis with the first line of flight at the end, out of the plane of obliquity"),
        Output("drift", "m", "distance of the centre of mass from the first line of flight at the end"),
        Output("regime", "", "embedded, perforated or ricochet"),
    ),
    main="depth",
    example=Example(
        rod="steel_4340", target="Al6061_T651", velocity=781.0, velocities=(200.0, 1200.0),
        values=MappingProxyType({
            "rod.mass": 0.023, "rod.diameter": 7.11e-3, "rod.length": 0.0735, "target.strength": 276e6,
            "cavity.a": 5.0394, "cavity.b": 0.9830, "nose.shape": "ogival",
        }),
    ),
    evaluate=evaluate,
)
