"""Walker-Anderson through a plate: the rear surface bulges, and the plate fails at a strain of its centreline.

The motion is that of ``walker_anderson`` until the plastic flow ahead of the crater reaches the rear surface. From then
on the flow is a blend of the deep flow and simple shear, the resistance falls with the remaining material, and the rear
surface moves. The rod perforates when the strain of this surface reaches the plate's failure strain. Anderson, Int. J. Impact
Engng 108 (2017) 3, equations (59) to (63), after Walker (1999) and Chocron, Anderson & Walker (1999);
explanation/penetration/walker-anderson-finite.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

from hydro2d.penetration import inputs
from hydro2d.penetration.centreline import Centreline, Rod, Target
from hydro2d.penetration.model import Example, Input, Model, Output, positive
from hydro2d.penetration.walker_anderson import CRATER_RADIUS, ROD_INPUTS, TARGET_INPUTS, materials

#: share of the plate left ahead of the rod at which the rear surface counts as reached
LAST_SHARE_OF_PLATE = 1e-6
#: the search for a ballistic limit: first and last velocity, m/s, growth of the step, and final width of the bracket, m/s
SLOWEST, FASTEST, GROWTH, BRACKET = 100.0, 6000.0, 1.25, 0.01
#: a failure strain that nothing reaches
UNBREAKABLE = 1e9


@dataclass(frozen=True)
class Exit:
    """The result of a shot: ``residual_velocity`` is the mean over the rod, 0 if it stops; SI."""

    perforated: bool
    depth: float
    bulge: float
    strain: float
    residual_velocity: float
    residual_length: float
    duration: float
    regime: str


def blend(share: float) -> float:
    """beta = (3/2) x^2 - x^3/2 of the deep flow, x = h/((alpha - 1) Rc): Anderson (2017), eq. (60).

    Share of the plastic hemisphere's volume on this side of the rear surface; 1 if that is not reached.
    """
    share = min(max(share, 0.0), 1.0)
    return share * share * (1.5 - 0.5 * share)


def rear_velocity(u: float, alpha: float, ahead: float, radius: float) -> float:
    """Velocity of the rear surface on the centreline, m/s, with h = ``ahead`` of the plate left in front of the rod.

    u [((alpha Rc/(Rc + h))^2 - 1)/(alpha^2 - 1)]^beta, which follows from the product of the potentials, Anderson
    (2017), eq. (59), on the axis: explanation/penetration/walker-anderson-finite, equation 4
    """
    reach = (alpha - 1.0) * radius
    if ahead >= reach:
        return 0.0
    deep = ((alpha * radius / (radius + max(ahead, 0.0))) ** 2 - 1.0) / (alpha * alpha - 1.0)
    return u * deep ** blend(ahead / reach)


def strain_rate(u: float, ahead: float, radius: float) -> float:
    """(4/3) (Rc/r)^2 u/r at the rear surface, r = Rc + h: Anderson (2017), eq. (63); 1/s."""
    r = radius + ahead
    return 4.0 / 3.0 * (radius / r) ** 2 * u / r


class Plate(Centreline):
    """A shot at a plate: in the state, the displacement of the rear surface and its strain follow the depth."""

    more = (0.0, 0.0)

    def __init__(self, velocity: float, rod: Rod, target: Target, thickness: float, failure_strain: float,
                 radius: float | None = None):
        super().__init__(velocity, rod, target, radius)
        positive(**{"target.thickness": thickness, "target.failure_strain": failure_strain})
        self.thickness, self.failure_strain = thickness, failure_strain

    def resisting(self, u: float, alpha: float, state: list[float]) -> float:
        """rho_t (u - u_back)^2/2 + (7/3) Yt ln(alpha~), alpha~ = 1 + h/Rc up to alpha: Anderson (2017), eq. (61)."""
        ahead = max(self.ahead(state), 0.0)
        closing = u - rear_velocity(u, alpha, ahead, self.radius)
        left = min(alpha, 1.0 + ahead / self.radius)
        return 0.5 * self.target.density * closing * closing + 7.0 / 3.0 * self.target.strength * math.log(left)

    def further(self, u: float, alpha: float, state: list[float]) -> tuple[float, float]:
        """Velocity of the rear surface, and its strain rate once the flow has reached it."""
        ahead = max(self.ahead(state), 0.0)
        if ahead >= (alpha - 1.0) * self.radius:
            return 0.0, 0.0
        return rear_velocity(u, alpha, ahead, self.radius), strain_rate(u, ahead, self.radius)

    def ahead(self, state) -> float:
        """h, the thickness of plate between the rod and the rear surface, m."""
        return self.thickness + state[4] - state[3]

    def ends(self) -> list[Callable]:
        """The ends for a thick target, failure of the rear surface, and no plate left ahead."""
        return [
            *super().ends(),
            lambda time, state: self.failure_strain - state[5],
            lambda time, state: self.ahead(state) - LAST_SHARE_OF_PLATE * self.thickness,
        ]


def shoot(velocity: float, rod: Rod, target: Target, thickness: float, failure_strain: float,
          radius: float | None = None) -> Exit:
    """One shot at a plate; SI, ``radius`` of the crater by default ``centreline.crater_radius``."""
    plate = Plate(velocity, rod, target, thickness, failure_strain, radius)
    track = plate.solve()
    v, u, length, depth, bulge, strain = (float(x) for x in track.states[:, -1])
    perforated = track.end >= len(Centreline.ends(plate))
    residual = v - 0.5 * plate.plastic_zone(v, u) / length * (v - u) if perforated else 0.0
    word = "perforated" if perforated else track.regime
    return Exit(perforated, depth, bulge, strain, residual, length, float(track.times[-1]), word)


@functools.lru_cache(maxsize=64)
def limit_velocity(rod: Rod, target: Target, thickness: float, failure_strain: float, radius: float | None = None) -> float:
    """The lowest impact velocity that perforates, m/s, by bisection; infinite where 6 km/s does not."""

    def through(velocity: float) -> bool:
        return shoot(velocity, rod, target, thickness, failure_strain, radius).perforated

    low, high = 0.0, SLOWEST
    while not through(high):
        if high == FASTEST:
            return math.inf
        low, high = high, min(high * GROWTH, FASTEST)
    while high - low > BRACKET:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if through(middle) else (middle, high)
    return high


def calibrate(limit: float, rod: Rod, target: Target, thickness: float, radius: float | None = None) -> float:
    """The failure strain with which the model has a measured ballistic limit, m/s: the strain of a shot at that velocity if
    the plate cannot fail. InputError if the plastic flow of such a shot does not reach the rear surface."""
    strain = shoot(limit, rod, target, thickness, UNBREAKABLE, radius).strain
    positive(**{"target.failure_strain": strain})
    return strain


def evaluate(velocity: float, **values: float) -> dict[str, float | str]:
    """The result of a shot at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    rod, target, radius = materials(values)
    plate = values["target_thickness"], values["target_failure_strain"], radius
    shot = shoot(velocity, rod, target, *plate)
    return {
        "residual_velocity": shot.residual_velocity,
        "residual_length": shot.residual_length,
        "limit_velocity": limit_velocity(rod, target, *plate),
        "depth": shot.depth,
        "bulge": shot.bulge,
        "strain": shot.strain,
        "duration": shot.duration,
        "regime": shot.regime,
    }


MODEL = Model(
    name="walker-anderson-finite",
    title="Walker-Anderson through a plate, with a bulging rear surface and a strain to failure",
    source="Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (59)-(63), after Walker (1999) and Chocron et al. (1999)",
    validity="as walker-anderson; ductile plates, as hard ones fail by shear bands first. The failure strain is calibrated",
    inputs=(
        *ROD_INPUTS,
        *TARGET_INPUTS,
        inputs.TARGET_THICKNESS,
        Input("target.failure_strain", "1", "strain of the rear surface, on the axis, at which the plate fails", "eps_crit"),
        CRATER_RADIUS,
    ),
    outputs=(
        Output("residual_velocity", "m/s", "mean velocity of the remaining rod; 0 if it stops", "V_r"),
        Output("residual_length", "m", "length of rod that is left"),
        Output("limit_velocity", "m/s", "lowest impact velocity that perforates; infinite where 6 km/s does not", "V_50"),
        Output("depth", "m", "depth of the interface below the original front face when it stops or the plate fails", "P"),
        Output("bulge", "m", "displacement of the rear surface by then"),
        Output("strain", "1", "strain of the rear surface by then", "eps"),
        Output("duration", "s", "time from impact to rest or failure"),
        Output("regime", "", "perforated; or as for a thick target"),
    ),
    main="residual_velocity",
    example=Example(
        rod="W_alloy",
        target="steel_4340",
        velocity=1500.0,
        velocities=(1000.0, 2000.0),
        values=MappingProxyType({
            "rod.diameter": 0.010, "rod.length": 0.100, "rod.strength": 2.0e9, "target.strength": 1.2e9,
            "target.thickness": 0.060, "target.failure_strain": 0.5,
        }),
    ),
    evaluate=evaluate,
)
