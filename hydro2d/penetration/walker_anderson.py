"""Walker-Anderson: momentum along the centreline of a long rod and a semi-infinite target.

No resistance is fitted: Tate's Rt results as (7/3) Yt ln(alpha), with the plastic flow's radius alpha from a dynamic
cavity expansion. The radius of the crater as a function of the impact velocity is the one empirical input.
Walker & Anderson, Int. J. Impact Engng 16 (1995) 19, as given by Anderson, Int. J. Impact Engng 108 (2017) 3, equations
(54) to (58). ``centreline`` has the equations of motion; explanation/penetration/walker-anderson.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from hydro2d.penetration import inputs
from hydro2d.penetration.centreline import LAST_SPEED, Centreline, Rod, Target, Track, plastic_extent
from hydro2d.penetration.model import Example, Input, Model, Motion, Output

#: highest impact velocity in the search for a transition, and its step, m/s
FASTEST, SEARCH_STEP = 6000.0, 50.0


def resistance(u: float, target: Target) -> float:
    """Rt = (7/3) Yt ln(alpha(u)), Anderson (2017), eq. (58); Pa."""
    return 7.0 / 3.0 * target.strength * math.log(plastic_extent(u, target)[0])


def penetrate(velocity: float, rod: Rod, target: Target, radius: float | None = None) -> Track:
    """The penetration of a semi-infinite target at an impact velocity in m/s; ``radius`` of the crater, m, by default
    ``crater_radius``. InputError for values outside the model's range."""
    return Centreline(velocity, rod, target, radius).solve()


def rigid_stress(velocity: float, rod: Rod, target: Target, radius: float | None = None) -> float:
    """The stress on the nose of a rod that penetrates without eroding, Pa: its share of the resistance of eq. (54).

    With s = 0 and dv/dt = du/dt the target's flow decelerates with the rod:
    q = (rho_t u^2/2 + (7/3) Yt ln(alpha)) rho_p L/(rho_p L + carried mass). explanation/penetration/walker-anderson, equation 9
    """
    motion = Centreline(velocity, rod, target, radius)
    alpha, alpha_u = plastic_extent(velocity, target)
    inertia = rod.density * rod.length
    return motion.resisting(velocity, alpha, []) * inertia / (inertia + motion.carried(velocity, alpha, alpha_u))


def transition_velocity(rod: Rod, target: Target, radius: float | None = None) -> float | None:
    """The lowest velocity at which ``rigid_stress`` exceeds the rod's strength, m/s: 0 if a rod at rest would already
    erode, None if none up to 6 km/s does. The shock of the impact, which erodes a little of any rod, is ignored."""
    from scipy.optimize import brentq

    def excess(velocity):
        return rigid_stress(velocity, rod, target, radius) - rod.strength

    low = LAST_SPEED
    if excess(low) >= 0.0:
        return 0.0
    while low < FASTEST:
        high = low + SEARCH_STEP
        if excess(high) >= 0.0:
            return float(brentq(excess, low, high))
        low = high
    return None


def materials(values: Mapping[str, float]) -> tuple[Rod, Target, float | None]:
    """Rod, target and crater radius from the keywords of ``evaluate``."""
    rod, target = (
        kind(**{name: values[f"{kind.owner}_{name}"] for name in kind.__dataclass_fields__}) for kind in (Rod, Target))
    return rod, target, values.get("crater_radius")


def evaluate(velocity: float, **values: float) -> dict[str, float | str]:
    """Depth and related quantities at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    rod, target, radius = materials(values)
    motion = Centreline(velocity, rod, target, radius)
    track = motion.solve()
    return {
        "depth": track.depth,
        "depth_over_length": track.depth / rod.length,
        "residual_length": float(track.states[2, -1]),
        "duration": float(track.times[-1]),
        "interface_velocity": motion.first,
        "plastic_extent": plastic_extent(motion.first, target)[0],
        "resistance": resistance(motion.first, target),
        "crater_radius": motion.radius,
        "regime": track.regime,
    }


def motion(velocity: float, **values: float) -> Motion:
    """The rod after an impact at a velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    track = penetrate(velocity, *materials(values))
    tail, _, length, depth = track.states[:4]
    return Motion(track.times, tail, depth, length)


def transition(**values: float) -> float | None:
    """``transition_velocity`` from the keywords of ``MODEL.inputs``."""
    return transition_velocity(*materials(values))


ROD_INPUTS = (
    inputs.ROD_DENSITY,
    inputs.ROD_STRENGTH.but(description="dynamic flow stress of the rod: the waves that slow its rear", symbol="sigma_p"),
    inputs.ROD_YOUNGS_MODULUS,
    inputs.ROD_SOUND_SPEED,
    inputs.ROD_HUGONIOT_SLOPE,
    inputs.ROD_DIAMETER,
    inputs.ROD_LENGTH,
)
TARGET_INPUTS = (
    inputs.TARGET_DENSITY,
    inputs.TARGET_STRENGTH.but(description="effective flow stress of the target"),
    inputs.TARGET_SHEAR_MODULUS,
    inputs.TARGET_SOUND_SPEED,
    inputs.TARGET_HUGONIOT_SLOPE,
)
CRATER_RADIUS = Input(
    "crater.radius", "m", "radius of the crater; from the fit to tungsten into steel where not given", "R_c", default=None)

MODEL = Model(
    name="walker-anderson",
    title="Walker-Anderson: centreline momentum of an eroding rod in a semi-infinite target",
    source="Walker & Anderson, Int. J. Impact Engng 16 (1995) 19; Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (54)-(58)",
    validity="metals, normal impact, rods of several diameters; the crater's radius is a fit to tungsten alloy into steel",
    inputs=(*ROD_INPUTS, *TARGET_INPUTS, CRATER_RADIUS),
    outputs=(
        Output("depth", "m", "depth at the end of the motion", "P"),
        Output("depth_over_length", "1", "depth over the rod's length", "P/L"),
        Output("residual_length", "m", "length of rod that is left"),
        Output("duration", "s", "time from impact to rest"),
        Output("interface_velocity", "m/s", "velocity of the interface just after impact", "u_0"),
        Output("plastic_extent", "1", "radius of the plastic flow just after impact, in crater radii", "alpha"),
        Output("resistance", "Pa", "(7/3) Yt ln(alpha) just after impact", "R_t"),
        Output("crater_radius", "m", "radius of the crater", "R_c"),
        Output("regime", "", "one of: eroding; consumed; eroding, then rigid"),
    ),
    main="depth_over_length",
    example=Example(
        rod="W_alloy",
        target="steel_4340",
        velocity=1500.0,
        velocities=(600.0, 2500.0),
        values=MappingProxyType({"rod.diameter": 0.010, "rod.length": 0.100, "rod.strength": 2.0e9, "target.strength": 1.2e9}),
    ),
    evaluate=evaluate,
    transition=transition,
    motion=motion,
)
