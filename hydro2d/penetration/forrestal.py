"""Forrestal's rigid rod: the force of a cavity-expansion pressure on the nose, integrated in closed form.

On every element of the nose the normal stress is A Y + B rho Vn^2, where Vn is the normal component of the rod's velocity, and
sliding friction adds mu times this stress along the surface. The sum along the axis is pi a^2 (A Y N1 + B rho N2 V^2), from
which deceleration, duration and depth follow. Forrestal, Okajima & Luk, J. Appl. Mech. 55 (1988) 755 [recalled]; Anderson, Int.
J. Impact Engng 108 (2017) 3, equations (39) to (46). explanation/penetration/forrestal
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from hydro2d.noses.base import Shaped
from hydro2d.noses.profile import Arc, Cone, Disc, Piece
from hydro2d.penetration import inputs
from hydro2d.penetration.cavity import CAVITY_VELOCITY, given_or_fitted
from hydro2d.penetration.model import Example, Input, Model, Motion, Output, non_negative, positive
from hydro2d.penetration.surface import angles

#: number of points of a motion under the force on the whole nose
POINTS = 33


@dataclass(frozen=True)
class Nose:
    """A nose of a certain shape, with friction. InputError for impossible values."""

    shaped: Shaped
    friction: float = 0.0

    def __post_init__(self) -> None:
        non_negative(friction=self.friction)

    @property
    def diameter(self) -> float:
        return 2.0 * self.shaped.radius

    @property
    def length(self) -> float:
        return self.shaped.length

    def factors(self, immersed: float = math.inf) -> tuple[float, float]:
        """N1 and N2 of the part within ``immersed`` (m) of the tip; explanation/penetration/forrestal, equations 3 to 6."""
        parts = [self._factors(piece, -max(immersed, 0.0)) for piece in self.shaped.pieces]
        return sum(part[0] for part in parts), sum(part[1] for part in parts)

    def _factors(self, piece: Piece, waterline: float) -> tuple[float, float]:
        """N1 and N2 of the part of a piece with z above ``waterline`` (m)."""
        if isinstance(piece, Disc):
            share = (piece.r / self.shaped.radius) ** 2 if piece.z >= waterline else 0.0
            return share, share
        if waterline >= piece.end:
            return 0.0, 0.0
        return self._cone(piece, waterline) if isinstance(piece, Cone) else self._arc(piece, waterline)

    def _cone(self, cone: Cone, waterline: float) -> tuple[float, float]:
        height, width = cone.end - cone.start, cone.start_r - cone.end_r
        outer = cone.end_r + width * min((cone.end - waterline) / height, 1.0)
        covered = (outer**2 - cone.end_r**2) / self.shaped.radius**2 * (1.0 + self.friction * height / width)
        return covered, covered * width**2 / (height**2 + width**2)

    def _arc(self, arc: Arc, waterline: float) -> tuple[float, float]:
        base, tip = angles(arc)
        line = math.asin(min((waterline - arc.centre_z) / arc.radius, 1.0)) if waterline > arc.start else base
        k, scale = -arc.centre_r / arc.radius, 2.0 * (arc.radius / self.shaped.radius) ** 2
        top, low = _integrals(tip, k, self.friction), _integrals(line, k, self.friction)
        return tuple(scale * max(a - b, 0.0) for a, b in zip(top, low, strict=True))  # negative only by round-off, at the tip


def _integrals(theta: float, k: float, friction: float) -> tuple[float, float]:
    """Antiderivatives of (cos - k)(sin + mu cos) and of (cos - k)(sin + mu cos) sin^2."""
    sine, cosine = math.sin(theta), math.cos(theta)
    first = 0.5 * sine**2 + k * cosine + friction * (0.5 * (theta + sine * cosine) - k * sine)
    plain = 0.25 * sine**4 + k * (cosine - cosine**3 / 3.0)
    rubbed = theta / 8.0 - math.sin(4.0 * theta) / 32.0 - k * sine**3 / 3.0
    return first, plain + friction * rubbed


@dataclass(frozen=True)
class Target:
    """A Y + B rho Vn^2: ``static`` is A Y (Pa), ``dynamic`` is B rho (kg/m^3)."""

    static: float
    dynamic: float

    def __post_init__(self) -> None:
        positive(static=self.static)
        non_negative(dynamic=self.dynamic)


def force(velocity: float, nose: Nose, target: Target, immersed: float = math.inf) -> float:
    """The axial force on the part of the nose within ``immersed`` (m) of the tip, N; explanation/penetration/forrestal, (2)."""
    n1, n2 = nose.factors(immersed)
    return 0.25 * math.pi * nose.diameter**2 * (target.static * n1 + target.dynamic * n2 * velocity**2)


def deep(velocity: float, mass: float, nose: Nose, target: Target) -> tuple[float, float]:
    """Depth (m) and time (s) to rest under the force on the whole nose; explanation/penetration/forrestal, equations 7 and 8.

    Anderson (2017), eq. (44), for a hemispherical nose without friction.
    """
    positive(mass=mass)
    non_negative(velocity=velocity)
    n1, n2 = nose.factors()
    area = 0.25 * math.pi * nose.diameter**2
    constant, quadratic = target.static * n1 * area / mass, target.dynamic * n2 * area / mass
    if quadratic * velocity**2 < 1e-12 * constant:
        return 0.5 * velocity**2 / constant, velocity / constant
    depth = 0.5 / quadratic * math.log1p(quadratic * velocity**2 / constant)
    return depth, math.atan(velocity * math.sqrt(quadratic / constant)) / math.sqrt(constant * quadratic)


def entering(velocity: float, mass: float, nose: Nose, target: Target) -> tuple[float, float]:
    """Depth and time to rest with the force on the immersed part of the nose only; explanation/penetration/forrestal, (9)."""
    positive(mass=mass)
    non_negative(velocity=velocity)
    if velocity == 0.0 or nose.length == 0.0:
        return deep(velocity, mass, nose, target)
    time, depth, left = (row[-1] for row in immersion(velocity, mass, nose, target))
    further, longer = deep(left, mass, nose, target) if left > 0.0 else (0.0, 0.0)
    return float(depth) + further, float(time) + longer


def immersion(velocity: float, mass: float, nose: Nose, target: Target) -> np.ndarray:
    """Times (s), depths (m) and velocities (m/s) until the nose is inside or the rod at rest (last velocity 0)."""
    from scipy.integrate import solve_ivp

    def slopes(_, state):
        return state[1], -force(state[1], nose, target, state[0]) / mass

    def buried(_, state):
        return state[0] - nose.length

    def stopped(_, state):
        return state[1]

    buried.terminal = stopped.terminal = True
    small = (1e-12 * nose.length, 1e-12 * velocity)
    done = solve_ivp(slopes, (0.0, math.inf), (0.0, velocity), events=(buried, stopped), rtol=1e-10, atol=small)
    rows = np.vstack([done.t, done.y])
    if not done.t_events[0].size:
        rows[2, -1] = 0.0
    return rows


def of_inputs(*, friction, target_density, target_strength, cavity_a, cavity_b, **others) -> tuple[Nose, Target]:
    """Nose and target of a model's inputs, SI; ``others`` are those of the nose and of the target. InputError."""
    shaped = inputs.taken_nose(others)
    a, b = given_or_fitted(cavity_a, cavity_b, target_density=target_density, target_strength=target_strength, **others)
    return Nose(shaped, friction), Target(a * target_strength, b * target_density)


def evaluate(velocity, *, rod_mass, nose_entry, **shot):
    """A rigid rod from ``velocity`` to rest; keywords are those of ``MODEL.inputs``, in SI."""
    nose, target = of_inputs(**shot)
    depth, duration = (deep if nose_entry == "ignored" else entering)(velocity, rod_mass, nose, target)
    pushed = force(velocity, nose, target)
    return {
        "depth": depth,
        "duration": duration,
        "deceleration": pushed / rod_mass,
        "resistance": pushed / (0.25 * math.pi * nose.diameter**2),
        "cavity_a": target.static / shot["target_strength"],
        "cavity_b": target.dynamic / shot["target_density"],
    }


def motion(velocity, *, rod_mass, nose_entry, **shot) -> Motion:
    """The rod after an impact at ``velocity``; keywords are those of ``MODEL.inputs``, in SI."""
    nose, target = of_inputs(**shot)
    rows = np.array([[0.0], [0.0], [velocity]])
    if nose_entry == "resisted" and nose.length > 0.0:
        rows = immersion(velocity, rod_mass, nose, target)
    time, depth, left = rows[:, -1]
    slower = np.linspace(left, 0.0, POINTS)[1:] if left > 0.0 else np.array([])
    ways = np.array([deep(speed, rod_mass, nose, target) for speed in (left, *slower)])  # to rest
    further = np.array([time + ways[0, 1] - ways[1:, 1], depth + ways[0, 0] - ways[1:, 0], slower])
    time, depth, speed = np.hstack([rows, further])
    return Motion(time, speed, depth)


NOSE_ENTRY = Input(
    "nose.entry", "", "whether the force acts in full from first touch, or on the part of the nose that is inside",
    default="ignored", choices=("ignored", "resisted"),
)
#: inputs that the rigid models share: see ``of_inputs``
SHOT = (
    inputs.ROD_DIAMETER, *inputs.NOSE, inputs.FRICTION,
    inputs.TARGET_DENSITY, inputs.TARGET_STRENGTH, inputs.CAVITY_A, inputs.CAVITY_B,
    inputs.TARGET_YOUNGS_MODULUS.but(default=None), inputs.TARGET_POISSON_RATIO.but(default=None),
    inputs.TARGET_HARDENING_EXPONENT, CAVITY_VELOCITY,
)

MODEL = Model(
    name="forrestal",
    title="Forrestal's rigid rod: cavity-expansion pressure on the nose, in closed form",
    source="Forrestal, Okajima & Luk, J. Appl. Mech. 55 (1988) 755 [recalled]; Anderson, Int. J. Impact Engng 108 (2017) 3, "
    "eqs. (39) to (46)",
    validity="rods that do not deform, at normal impact on thick and wide targets, in a tunnel of their own diameter",
    inputs=(inputs.ROD_MASS, *SHOT, NOSE_ENTRY),
    outputs=(
        Output("depth", "m", "final depth of the tip below the struck face", "P"),
        Output("duration", "s", "time from touch to rest"),
        Output("deceleration", "m/s^2", "deceleration at the impact velocity with the whole nose inside"),
        Output("resistance", "Pa", "force over the rod's section at the impact velocity with the whole nose inside"),
        Output("cavity_a", "1", "A, given or from the target", "A"),
        Output("cavity_b", "1", "B, given or from the target", "B"),
    ),
    main="depth",
    example=Example(
        rod="steel_4340", target="Al6061_T651", velocity=781.0, velocities=(200.0, 1200.0),
        values=MappingProxyType({"rod.mass": 0.023, "rod.diameter": 7.11e-3}),
    ),
    evaluate=evaluate,
    motion=motion,
)
