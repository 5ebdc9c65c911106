"""A rigid rod on its axis: the area force law on the rings of its nose, stepped by explicit central differences.

Every ring of the nose below the struck face feels the pressure of cavity expansion at its surface velocity: the normal
component of the rod's velocity or, to match the printed depths of one paper, all of it. Ahmad Zaidi, Md Yusof, Ghazali &
Mohammad, Simulations of the penetration of 6061-T6511 aluminum alloy targets by semi spherical-nosed rigid projectiles,
equations [1.0] to [1.5]. explanation/penetration/rigid-axial
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from hydro2d.base.parameters import NON_NEGATIVE
from hydro2d.penetration import inputs
from hydro2d.penetration.cavity import given_or_fitted
from hydro2d.penetration.forrestal import NOSE_ENTRY, SHOT
from hydro2d.penetration.model import Example, Input, InputError, Model, Output, non_negative, positive
from hydro2d.penetration.surface import Surface, nose_surface

#: a step carries the rod by no more than this share of its diameter, and a shot has about this many steps or more
STRIDE, LEAST_STEPS = 0.01, 100
#: number of rings of a nose on the command line
RINGS = 100
#: a rod slower than this share of the impact velocity has stopped, and the number of steps that a shot may take
REST, MOST_STEPS = 1e-6, 200_000

SURFACE_VELOCITY = Input(
    "surface.velocity", "", "velocity in the pressure: the component normal to the surface, or the whole axial velocity",
    default="normal", choices=("normal", "axial"),
)


@dataclass(frozen=True)
class Pressure:
    """``static`` + ``linear`` v + ``dynamic`` v^2 at the surface velocity v: A Y (Pa), B sqrt(rho Y) and C rho, SI."""

    static: float
    dynamic: float
    linear: float = 0.0

    def __post_init__(self) -> None:
        positive(static=self.static)
        non_negative(dynamic=self.dynamic, linear=self.linear)


@dataclass(frozen=True)
class Flight:
    """Depth of the tip (m) and time (s) at rest; ``history`` has rows of time, depth of the tip, velocity and force (N).

    A row has the values from which the force of its step was computed, so velocities lag by half a step. ``work`` of the
    forces, J, uses the mean velocities of the steps; it equals the lost kinetic energy to round-off.
    """

    depth: float
    duration: float
    work: float
    history: np.ndarray


class Rings:
    """The rings of a surface that face forward, summed from the tip aft.

    ``surface_velocity`` is "normal" (V cos) or "axial" (all of V); friction acts on every ring.
    """

    def __init__(self, surface: Surface, friction: float = 0.0, surface_velocity: str = "normal") -> None:
        non_negative(friction=friction)
        SURFACE_VELOCITY.check(surface_velocity)
        order = np.argsort(-surface.z, kind="stable")
        order = order[surface.normal_z[order] > 0.0]
        share = surface.normal_z[order] if surface_velocity == "normal" else np.ones(order.size)
        along = (surface.normal_z[order] + friction * surface.normal_r[order]) * surface.area[order]
        self.depths = (-surface.z[order]).tolist()
        self.sums = [(0.0, 0.0, 0.0), *zip(*(np.cumsum(along * share**k).tolist() for k in range(3)), strict=True)]

    def force(self, pressure: Pressure, velocity: float, depth: float = math.inf) -> float:
        """Force along the axis (N) on the rings below the struck face when the tip is at ``depth`` (m).

        explanation/penetration/rigid-axial, equation 3.
        """
        zeroth, first, second = self.sums[bisect_right(self.depths, depth)]
        return pressure.static * zeroth + (pressure.linear * first + pressure.dynamic * second * velocity) * velocity


def penetrate(
    surface: Surface, mass: float, velocity: float, pressure: Pressure, *, friction: float = 0.0,
    surface_velocity: str = "normal", entry: bool = True, time_step: float | None = None,
) -> Flight:
    """The motion from first touch at ``velocity`` (m/s) to rest.

    V(i+1/2) = V(i-1/2) - dt F/M with the force at V(i-1/2) and the depth U(i), then U(i+1) = U(i) + dt V(i+1/2); the
    first push lasts half a step. Of first order in ``time_step`` (s). Without ``entry`` the whole nose counts from first
    touch on. The default step is a small share of a diameter, and of the time in which the whole nose would stop the rod.
    InputError for impossible input. explanation/penetration/rigid-axial, equations 6 and 7.
    """
    positive(mass=mass, velocity=velocity)
    nose = Rings(surface, friction, surface_velocity)
    stop = mass * velocity / nose.force(pressure, velocity)
    stride = STRIDE * 2.0 * float(np.max(surface.r)) / velocity
    dt = min(stride, stop / LEAST_STEPS) if time_step is None else time_step
    positive(time_step=dt)
    history, v, depth, work = [], velocity, 0.0, 0.0
    for count in range(MOST_STEPS):
        pushed = nose.force(pressure, v, depth if entry else math.inf)
        history.append((count * dt, depth, v, pushed))
        step, before = dt if count else 0.5 * dt, v
        v = before - step / mass * pushed
        mean = 0.5 * (before + v)
        if v < REST * velocity:
            left = step * mean / (before - v)
            work += pushed * (0.25 * step * (before + mean) + 0.5 * left * mean)
            return Flight(depth + 0.5 * left * mean, count * dt + left, work, np.array(history))
        work += pushed * step * mean
        depth += dt * v
    raise InputError(f"time_step = {dt:g}: the rod has not stopped after {MOST_STEPS} steps")


def evaluate(
    velocity, *, rod_mass, nose_entry, friction, surface_velocity, target_density, target_strength, cavity_c, **others,
):
    """A rigid rod from ``velocity`` to rest; keywords are those of ``MODEL.inputs``, in SI."""
    nose = inputs.taken_nose(others)
    a, b = given_or_fitted(target_density=target_density, target_strength=target_strength, **others)
    static = a * target_strength
    if cavity_c is None:
        pressure = Pressure(static, b * target_density)
    else:
        pressure = Pressure(static, cavity_c * target_density, b * math.sqrt(target_density * target_strength))
    flight = penetrate(
        nose_surface(nose, RINGS), rod_mass, velocity, pressure,
        friction=friction, surface_velocity=surface_velocity, entry=nose_entry == "resisted",
    )
    peak = float(np.max(flight.history[:, 3]))
    return {"depth": flight.depth, "duration": flight.duration, "deceleration": peak / rod_mass}


CAVITY_C = Input(
    "cavity.c", "1", "C of A Y + B sqrt(rho Y) V + C rho V^2, in which cavity.b is B; without it the two-term form holds", "C",
    default=None, sign=NON_NEGATIVE,
)

MODEL = Model(
    name="rigid-axial",
    title="Rigid rod on its axis: the area force law on the rings of its nose, stepped in time",
    source="Ahmad Zaidi, Md Yusof, Ghazali & Mohammad, Simulations of the penetration of 6061-T6511 aluminum alloy targets by "
    "semi spherical-nosed rigid projectiles, eqs. [1.0] to [1.5]",
    validity="rods that do not deform, at normal impact on thick and wide targets; no resistance on the shank",
    inputs=(inputs.ROD_MASS, *SHOT, CAVITY_C, SURFACE_VELOCITY, NOSE_ENTRY.but(default="resisted")),
    outputs=(
        Output("depth", "m", "final depth of the tip below the struck face", "P"),
        Output("duration", "s", "time from touch to rest"),
        Output("deceleration", "m/s^2", "largest deceleration"),
    ),
    main="depth",
    example=Example(
        rod="steel_4340", target="Al6061_T651", velocity=781.0, velocities=(200.0, 1200.0),
        values=MappingProxyType({
            "rod.mass": 0.023, "rod.diameter": 7.11e-3, "target.strength": 276e6, "cavity.a": 5.0394, "cavity.b": 0.9830,
        }),
    ),
    evaluate=evaluate,
)
