"""Tate-Alekseevskii: a long rod that erodes, stays rigid, or first erodes and then continues as a rigid body.

The equations give the stress on both sides of the interface, with a strength Y_p of the rod and a resistance R_t of the
target, the deceleration of the rod behind it, and its shortening:

    rho_p (v - u)^2/2 + Y_p = rho_t u^2/2 + R_t,    rho_p l dv/dt = -Y_p,    dl/dt = -(v - u).

Anderson, Int. J. Impact Engng 108 (2017) 3, equations (28) to (36); Tate, J. Mech. Phys. Solids 15 (1967) 387, 17 (1969) 141;
Alekseevskii, Combust. Explos. Shock Waves 2 (1966) 63. The remaining length is a closed form of the velocity, so that depth and
time are quadratures over the velocity. explanation/penetration/tate.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from hydro2d.base.parameters import NON_NEGATIVE
from hydro2d.penetration import inputs
from hydro2d.penetration.hydrodynamic import interface_velocity
from hydro2d.penetration.model import Example, Input, Model, Motion, Output, non_negative, positive
from hydro2d.penetration.target_resistance import RESISTANCE_INPUTS, resistance_of

NO_PENETRATION, RIGID, ERODING, ERODING_THEN_RIGID = "no penetration", "rigid", "eroding", "eroding, then rigid"
#: -ln(l/L) at which a rod counts as consumed
CONSUMED = 60.0
#: nodes of a panel of the quadrature over the velocity, and points of a track while the rod is rigid
NODES, RIGID_POINTS = 12, 17


@dataclass(frozen=True)
class Pair:
    """Rod and target: densities (kg/m^3), strength Y_p of the rod and resistance R_t of the target (Pa)."""

    rod_density: float
    rod_strength: float
    target_density: float
    resistance: float

    def __post_init__(self):
        positive(**vars(self))

    @property
    def difference(self) -> float:
        """R_t - Y_p, Pa."""
        return self.resistance - self.rod_strength

    @property
    def critical_velocity(self) -> float:
        """Velocity at and below which the rod does not penetrate, m/s; 0 for Y_p >= R_t. Anderson (2017), eq. (33)."""
        return math.sqrt(max(0.0, 2.0 * self.difference) / self.rod_density)

    @property
    def transition_velocity(self) -> float:
        """Velocity up to which the rod is rigid, m/s; 0 for Y_p <= R_t. Anderson (2017), eq. (34)."""
        return math.sqrt(max(0.0, -2.0 * self.difference) / self.target_density)

    def regime(self, velocity: float) -> str:
        """The regime of an impact at a velocity (m/s)."""
        if self.rod_strength > self.resistance:
            return RIGID if velocity <= self.transition_velocity else ERODING_THEN_RIGID
        return NO_PENETRATION if velocity <= self.critical_velocity else ERODING

    def penetration_velocity(self, velocity: float) -> float:
        """Velocity u of the interface for a rod at a velocity (m/s), m/s: Anderson (2017), eq. (32); v of a rigid rod."""
        regime = self.regime(velocity)
        if regime in (NO_PENETRATION, RIGID):
            return velocity if regime == RIGID else 0.0
        return float(self.interface_velocity(velocity))

    def interface_velocity(self, velocity: np.ndarray) -> np.ndarray:
        """u while the rod erodes, m/s: Anderson (2017), eq. (32)."""
        return interface_velocity(
            velocity, rod_density=self.rod_density, target_density=self.target_density, difference=self.difference)

    def shortening(self, first: float, velocity: np.ndarray) -> np.ndarray:
        """-ln(l/L) when an eroding rod has slowed from ``first`` to ``velocity``: explanation/penetration/tate, equation 8."""
        lost = self._integral(np.asarray(first, float)) - self._integral(np.asarray(velocity, float))
        return self.rod_density / self.rod_strength * lost

    def _integral(self, v: np.ndarray) -> np.ndarray:
        """The integral of v - u over v: explanation/penetration/tate, equation 7."""
        u = self.interface_velocity(v)
        half = 0.5 * v * (v - u)
        if self.difference == 0.0:
            return half
        momentum = math.sqrt(self.target_density) * u + math.sqrt(self.rod_density) * (v - u)
        return half + self.difference / math.sqrt(self.rod_density * self.target_density) * np.log(momentum)


@dataclass(frozen=True)
class Track:
    """The motion from impact to the end of penetration, arrays of one entry per instant.

    ``time`` (s), ``velocity`` v of the rod and ``penetration_velocity`` u (m/s), ``length`` of the rod (m), ``depth`` (m).
    """

    time: np.ndarray
    velocity: np.ndarray
    penetration_velocity: np.ndarray
    length: np.ndarray
    depth: np.ndarray
    regime: str


def critical_velocity(*, rod_density: float, rod_strength: float, resistance: float) -> float:
    """v_c = sqrt(2 (R_t - Y_p)/rho_p), m/s: at and below it nothing penetrates. 0 for Y_p >= R_t. Anderson (2017), eq. (33)."""
    return Pair(rod_density, rod_strength, rod_density, resistance).critical_velocity


def transition_velocity(*, rod_strength: float, target_density: float, resistance: float) -> float:
    """v_tr = sqrt(2 (Y_p - R_t)/rho_t), m/s: above it the rod erodes. 0 for Y_p <= R_t. Anderson (2017), eq. (34)."""
    return Pair(target_density, rod_strength, target_density, resistance).transition_velocity


def penetrate(velocity: float, *, rod_density: float, rod_length: float, rod_strength: float, target_density: float,
              resistance: float) -> Track:
    """The penetration of a semi-infinite target at an impact velocity in m/s.

    rod_length (m); densities (kg/m^3); rod_strength Y_p and resistance R_t (Pa). Solves eqs. (28), (30) and (31) of Anderson
    (2017) while the rod erodes, and eq. (35) from the transition velocity down. A rod that does not penetrate has a track of
    one instant; the length that it loses on the surface is not computed. Accurate to 1e-10.
    """
    non_negative(velocity=velocity)
    positive(rod_length=rod_length)
    pair = Pair(rod_density, rod_strength, target_density, resistance)
    regime = pair.regime(velocity)
    if regime == NO_PENETRATION or velocity == 0.0:
        return Track(*(np.array([x]) for x in (0.0, velocity, 0.0, rod_length, 0.0)), regime=NO_PENETRATION)
    if regime == RIGID:
        rows = _rigid(pair, velocity, rod_length)
    else:
        rows = _eroding(pair, velocity, rod_length)
        last = dict(zip(("time", "velocity", "u", "length", "depth"), rows[:, -1], strict=True))
        if regime == ERODING_THEN_RIGID and last["velocity"] == pair.transition_velocity:
            after = _rigid(pair, last["velocity"], last["length"])
            after[0] += last["time"]
            after[4] += last["depth"]
            rows = np.hstack([rows, after[:, 1:]])
    return Track(*rows, regime=regime)


def _rigid(pair: Pair, velocity: float, length: float) -> np.ndarray:
    """Rows of a track while a rod of a length (m) is rigid, from its velocity to rest: Anderson (2017), eqs. (35) and (36)."""
    a, b = pair.resistance, 0.5 * pair.target_density
    v = np.linspace(velocity, 0.0, RIGID_POINTS)
    turn = math.sqrt(b / a)
    time = pair.rod_density * length / math.sqrt(a * b) * (math.atan(turn * velocity) - np.arctan(turn * v))
    depth = pair.rod_density * length / pair.target_density * (math.log1p(b * velocity**2 / a) - np.log1p(b * v**2 / a))
    return np.array([time, v, v, np.full_like(v, length), depth])


def _eroding(pair: Pair, velocity: float, length: float) -> np.ndarray:
    """Rows of a track while the rod erodes, by Gauss-Legendre panels: explanation/penetration/tate, equations 9 and 10.

    Panels are uniform in the root of v - v_end: u(v) may bend sharply near v_end.
    """
    end = _end_of_erosion(pair, velocity)
    span = velocity - end
    panels = 8 + math.ceil(2.0 * float(pair.shortening(velocity, end)))
    node, weight = np.polynomial.legendre.leggauss(NODES)
    edge = np.linspace(1.0, 0.0, panels + 1)
    x = edge[:-1, None] - (0.5 + 0.5 * node) / panels
    v = end + span * x * x
    per_velocity = weight / panels * span * x * pair.rod_density / pair.rod_strength * np.exp(-pair.shortening(velocity, v))
    duration = (per_velocity * length).sum(axis=1)
    depth = (per_velocity * length * pair.interface_velocity(v)).sum(axis=1)
    v = end + span * edge * edge
    return np.array([
        np.concatenate([[0.0], np.cumsum(duration)]),
        v,
        pair.interface_velocity(v),
        length * np.exp(-pair.shortening(velocity, v)),
        np.concatenate([[0.0], np.cumsum(depth)]),
    ])


def _end_of_erosion(pair: Pair, velocity: float) -> float:
    """The velocity at which the rod stops, turns rigid, or is consumed, m/s."""
    end = max(pair.critical_velocity, pair.transition_velocity)
    if pair.shortening(velocity, end) <= CONSUMED:
        return end
    from scipy.optimize import brentq

    return brentq(lambda v: float(pair.shortening(velocity, v)) - CONSUMED, end, velocity)


def pair_of(*, rod_density: float, rod_strength: float, rod_dynamic_factor: float, target_density: float,
            **target: float | str | None) -> Pair:
    """Rod and target of the inputs: Y_p = (1 + lambda) rod.strength by Anderson (2017), eq. (38), R_t as ``resistance_of``."""
    positive(**{"rod.strength": rod_strength})
    return Pair(rod_density, (1.0 + rod_dynamic_factor) * rod_strength, target_density, resistance_of(**target))


def motion(velocity: float, *, rod_length: float, **values: float | str | None) -> Motion:
    """The track of an impact at a velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    track = penetrate(velocity, rod_length=rod_length, **vars(pair_of(**values)))
    return Motion(track.time, track.velocity, track.depth, track.length)


def evaluate(velocity: float, *, rod_length: float, **values: float | str | None) -> dict[str, float | str]:
    """Depth and regime at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    pair = pair_of(**values)
    track = penetrate(velocity, rod_length=rod_length, **vars(pair))
    return {
        "depth": float(track.depth[-1]),
        "depth_over_length": float(track.depth[-1]) / rod_length,
        "residual_length": float(track.length[-1]),
        "duration": float(track.time[-1]),
        "penetration_velocity": float(track.penetration_velocity[0]),
        "critical_velocity": pair.critical_velocity,
        "transition_velocity": pair.transition_velocity,
        "rod_strength": pair.rod_strength,
        "resistance": pair.resistance,
        "regime": track.regime,
    }


def transition(*, rod_length: float | None = None, **values: float | str | None) -> float:
    """``Pair.transition_velocity`` of ``MODEL.inputs``, m/s: 0 where Y_p <= R_t; never None, as every fast rod erodes."""
    return pair_of(**values).transition_velocity


#: inputs of ``pair_of``
PAIR_INPUTS = (
    inputs.ROD_DENSITY,
    inputs.ROD_STRENGTH,
    Input("rod.dynamic_factor", "1", "share of dynamic effects to add to rod.strength; Tate: 0.7 for a static yield stress",
          "lambda_p", default=0.0, sign=NON_NEGATIVE),
    inputs.TARGET_DENSITY,
    *RESISTANCE_INPUTS,
)

MODEL = Model(
    name="tate",
    title="Tate-Alekseevskii: a long rod, rigid, eroding, or both",
    source="Tate, J. Mech. Phys. Solids 15 (1967) 387, 17 (1969) 141; Alekseevskii, Combust. Explos. Shock Waves 2 (1966) 63; "
    "Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (28) to (36)",
    validity="long rods at normal impact on thick targets; one resistance at all velocities, no nose shape, no mushrooming",
    inputs=(inputs.ROD_LENGTH, *PAIR_INPUTS),
    outputs=(
        Output("depth", "m", "depth of penetration", "P"),
        Output("depth_over_length", "1", "depth over the rod's length", "P/L"),
        Output("residual_length", "m", "length of rod left when penetration ends"),
        Output("duration", "s", "time from impact to the end of penetration"),
        Output("penetration_velocity", "m/s", "velocity of the interface at impact", "u"),
        Output("critical_velocity", "m/s", "velocity up to which nothing penetrates; 0 for Y_p >= R_t", "v_c"),
        Output("transition_velocity", "m/s", "velocity up to which the rod is rigid; 0 for Y_p <= R_t", "v_tr"),
        Output("rod_strength", "Pa", "strength of the rod, with dynamic effects", "Y_p"),
        Output("resistance", "Pa", "resistance of the target", "R_t"),
        Output("regime", "", f"one of: {NO_PENETRATION}; {RIGID}; {ERODING}; {ERODING_THEN_RIGID}"),
    ),
    main="depth_over_length",
    example=Example(
        rod="W_alloy", target="Al5083", velocity=1200.0, velocities=(200.0, 3000.0),
        values=MappingProxyType({"rod.length": 0.0973}),
    ),
    evaluate=evaluate,
    transition=transition,
    motion=motion,
)
