"""Ravid-Bodner: the first stage of a rigid blunt rod's passage through a plate, by an upper bound on the plastic work.

Ravid & Bodner, Int. J. Engng Sci. 21 (1983) 577, divide perforation into penetration, bulge formation, bulge advancement,
plug formation, and exit. Anderson, Int. J. Impact Engng 108 (2017) 3, section 8, says what each stage assumes but prints
no equations. Stage one can be built from that description: three moving zones in a plate at rest, matching velocities
that conserve volume, an extent of the zones that minimises the plastic work, and an energy balance for the rod. The velocity
field here is ours and is the simplest of this kind. The later stages need the shape of the bulge, the law by
which its radius stops growing, and the failure criteria, none of which is printed: the model ends where the plastic flow
reaches the rear surface, and gives neither a residual velocity nor a ballistic limit. explanation/penetration/ravid-bodner.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from hydro2d.penetration import inputs
from hydro2d.penetration.model import Example, Model, Output, positive

#: shear yield stress over yield stress, von Mises
SHEAR = 1.0 / math.sqrt(3.0)
#: range in which the radial extent is sought, and number of depths into which a plate is divided
NARROWEST, WIDEST, STEPS = 1.0 + 1e-6, 100.0, 100


@dataclass(frozen=True)
class Flow:
    """The plastic flow at one depth, per radius R of the rod, speed, flow stress and density of the target.

    ``pressure`` is the power of plastic work over pi R^2 Y v, ``radial`` and ``axial`` the extents alpha and eta in radii,
    ``inertia`` the kinetic energy over rho R^3 v^2/2.
    """

    pressure: float
    radial: float
    axial: float
    inertia: float


@dataclass(frozen=True)
class Stage:
    """The end of stage one: at rest, or (``bulges``) with the plastic flow at the rear surface; SI.

    Resistances are the power of plastic work over the rod's area and speed, at the surface and at the end.
    """

    bulges: bool
    depth: float
    velocity: float
    duration: float
    first_resistance: float
    resistance: float
    flow: Flow


def annulus_work(alpha: float) -> float:
    """Plastic power of zone II over pi R^2 Y v: explanation/penetration/ravid-bodner, equation 5.

    (1/(alpha^2 - 1)) times the integral of sqrt(1 + a^2/w^2) over w from 1 to alpha^2, a = alpha^2/sqrt(3)
    """
    a = SHEAR * alpha * alpha

    def primitive(w: float) -> float:
        return math.hypot(w, a) - a * math.asinh(a / w)

    return (primitive(alpha * alpha) - primitive(1.0)) / (alpha * alpha - 1.0)


def axial_extent(alpha: float) -> float:
    """eta of minimum power at a given alpha: explanation/penetration/ravid-bodner, equation 8."""
    side = alpha / (alpha - 1.0)
    return math.sqrt(_ends(alpha) / side)


def pressure(alpha: float, depth: float) -> float:
    """Plastic power over pi R^2 Y v at a depth in radii, eta at its best: explanation/penetration/ravid-bodner, equation 7.

    Bodies of zones I and II, sliding along their sides and ends, and sliding of the uplifted zone III along its rim.
    """
    sides_and_ends = 2.0 * SHEAR * math.sqrt(_ends(alpha) * alpha / (alpha - 1.0))
    return 1.0 + annulus_work(alpha) + sides_and_ends + 2.0 * SHEAR * alpha * depth / (alpha * alpha - 1.0)


def _ends(alpha: float) -> float:
    """Sliding across the two ends of zone II and the bottom of zone I, times eta."""
    return (1.0 + 2.0 * (alpha - 1.0) * (2.0 * alpha + 1.0) / (alpha + 1.0)) / 3.0


def inertia(alpha: float, eta: float, depth: float) -> float:
    """Kinetic energy of zones I, II and III over rho R^3 v^2/2: explanation/penetration/ravid-bodner, equation 9."""
    ring = alpha * alpha - 1.0
    first = eta / 3.0 + 1.0 / (8.0 * eta)
    axial = eta / (3.0 * ring)
    radial = (alpha**4 * math.log(alpha * alpha) - 2.0 * alpha * alpha * ring + 0.5 * (alpha**4 - 1.0)) / (4.0 * eta * ring**2)
    return math.pi * (first + axial + radial + depth / ring)


def flow(depth: float) -> Flow:
    """The flow of minimum plastic power at a depth in radii."""
    from scipy.optimize import minimize_scalar

    best = minimize_scalar(pressure, args=(depth,), bounds=(NARROWEST, WIDEST), method="bounded", options={"xatol": 1e-10})
    alpha = float(best.x)
    eta = axial_extent(alpha)
    return Flow(float(best.fun), alpha, eta, inertia(alpha, eta, depth))


def first_stage_depth(thickness: float) -> float:
    """Depth at which the plastic flow reaches the rear surface, x + eta = T, all in radii; 0 for the thinnest plates."""
    from scipy.optimize import brentq

    if flow(0.0).axial >= thickness:
        return 0.0
    return float(brentq(lambda depth: depth + flow(depth).axial - thickness, 0.0, thickness))


@functools.lru_cache(maxsize=64)
def _curves(thickness: float):
    """That depth, and as functions of depth the work over pi R^3 Y and the inertia of ``Flow``."""
    from scipy.interpolate import CubicHermiteSpline, CubicSpline

    end = first_stage_depth(thickness)
    depths = np.linspace(0.0, max(end, 1e-6), STEPS + 1)
    flows = [flow(depth) for depth in depths]
    slopes = [2.0 * SHEAR * each.radial / (each.radial**2 - 1.0) for each in flows]
    work = CubicHermiteSpline(depths, [each.pressure for each in flows], slopes).antiderivative()
    return end, work, CubicSpline(depths, [each.inertia for each in flows])


def first_stage(velocity: float, *, rod_density: float, rod_diameter: float, rod_length: float, target_density: float,
                target_strength: float, target_thickness: float) -> Stage:
    """Stage one of a rigid cylinder at an impact velocity in m/s; SI.

    (M + rho R^3 kappa(x)) v^2/2 = M V^2/2 - pi R^3 Y times the integral of p(x): the kinetic energies of rod and flow are
    the impact energy minus the plastic work. explanation/penetration/ravid-bodner, equation 10
    """
    from scipy.optimize import brentq

    positive(velocity=velocity, **{"rod.density": rod_density, "rod.diameter": rod_diameter, "rod.length": rod_length,
                                   "target.density": target_density, "target.strength": target_strength,
                                   "target.thickness": target_thickness})
    radius = 0.5 * rod_diameter
    mass = math.pi * radius**2 * rod_length * rod_density
    scale = math.pi * radius**3 * target_strength
    end, work, carried = _curves(target_thickness / radius)
    available = 0.5 * mass * velocity**2 / scale
    bulges = available > float(work(end))
    last = end if bulges else float(brentq(lambda depth: work(depth) - available, 0.0, end))
    depths = np.linspace(0.0, last, STEPS + 1)
    left = 2.0 * scale * np.maximum(available - work(depths), 0.0)
    speeds = np.sqrt(left / (mass + target_density * radius**3 * carried(depths)))
    duration = radius * float(np.sum(2.0 * np.diff(depths) / (speeds[1:] + speeds[:-1])))
    final = flow(last)
    return Stage(bulges, radius * last, float(speeds[-1]) if bulges else 0.0, duration,
                 target_strength * flow(0.0).pressure, target_strength * final.pressure, final)


def evaluate(velocity: float, **values: float) -> dict[str, float | str]:
    """Stage one at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    stage = first_stage(velocity, **values)
    return {
        "depth": stage.depth,
        "stage_velocity": stage.velocity,
        "duration": stage.duration,
        "first_resistance": stage.first_resistance,
        "resistance": stage.resistance,
        "radial_extent": stage.flow.radial,
        "axial_extent": stage.flow.axial,
        "regime": "reaches stage two" if stage.bulges else "stopped in stage one",
    }


MODEL = Model(
    name="ravid-bodner",
    title="Ravid-Bodner, stage one: a rigid blunt rod until the plastic flow reaches the rear of the plate",
    source="Ravid & Bodner (1983), as reported by Anderson, Int. J. Impact Engng 108 (2017) 3, section 8; velocity field: ours",
    validity="rigid flat-nosed rods, ductile plates of a few calibres; no perforation, as later stages are not printed",
    inputs=(
        inputs.ROD_DENSITY,
        inputs.ROD_DIAMETER,
        inputs.ROD_LENGTH,
        inputs.TARGET_DENSITY,
        inputs.TARGET_STRENGTH.but(description="flow stress of the target, averaged over the plastic work"),
        inputs.TARGET_THICKNESS,
    ),
    outputs=(
        Output("depth", "m", "depth at the end of stage one"),
        Output("stage_velocity", "m/s", "velocity of the rod there; 0 where it stopped"),
        Output("duration", "s", "time from impact to there"),
        Output("first_resistance", "Pa", "plastic resistance to the rod at the surface"),
        Output("resistance", "Pa", "plastic resistance to the rod at the end of stage one"),
        Output("radial_extent", "1", "radius of the plastic flow there, in radii of the rod", "alpha"),
        Output("axial_extent", "1", "depth of the plastic flow ahead of the rod there, in radii of the rod", "eta"),
        Output("regime", "", "reaches stage two; or stopped in stage one"),
    ),
    main="stage_velocity",
    example=Example(
        rod="steel_S7",
        target="Al5083",
        velocity=500.0,
        velocities=(100.0, 900.0),
        values=MappingProxyType({
            "rod.diameter": 0.010, "rod.length": 0.050, "target.thickness": 0.030, "target.strength": 0.4e9,
        }),
    ),
    evaluate=evaluate,
)
