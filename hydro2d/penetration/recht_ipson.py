"""Recht-Ipson: the velocity left after perforating a plate, from momentum and energy and one measured limit velocity.

A chunky projectile drives out a plug that leaves with it; an armour-piercing bullet drives out none. In both cases the plate
takes up the same work as at the ballistic limit V50. Anderson, Int. J. Impact Engng 108 (2017) 3, equations (17) to (25);
Recht & Ipson, J. Appl. Mech. 30 (1963) 384. explanation/penetration/recht-ipson.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType

from hydro2d.penetration import inputs
from hydro2d.penetration.model import Example, Input, Model, Output, non_negative, positive


@dataclass(frozen=True)
class Budget:
    """The parts of the kinetic energy of the projectile, J: eqs. (18) to (20).

    ``residual`` of projectile and plug, ``deformation`` and heat of the inelastic collision, ``shear`` work of the plug.
    """

    residual: float
    deformation: float
    shear: float


def plug_mass_ratio(*, rod_density: float, rod_length: float, rod_diameter: float, target_density: float,
                    target_thickness: float, plug_diameter: float | None = None) -> float:
    """m_p/M_p = (rho_t/rho_p)(d/D)^2 (T/L) of a cylinder: the ratio in Anderson (2017), eq. (22).

    d: diameter of the plug, by default the rod's D; T: thickness of the plate; all lengths in m, densities in kg/m^3.
    """
    plug_diameter = rod_diameter if plug_diameter is None else plug_diameter
    positive(rod_density=rod_density, rod_length=rod_length, rod_diameter=rod_diameter, target_density=target_density,
             target_thickness=target_thickness, plug_diameter=plug_diameter)
    return target_density / rod_density * (plug_diameter / rod_diameter) ** 2 * target_thickness / rod_length


def residual_velocity(velocity: float, *, limit_velocity: float, plug_mass_ratio: float = 0.0) -> float:
    """V_r = sqrt(V^2 - V50^2)/(1 + m_p/M_p), m/s; 0 up to the limit V50. Anderson (2017), eqs. (21) and, without plug, (25).

    With a plug for plates thinner than half the projectile's length and diameter.
    """
    positive(limit_velocity=limit_velocity)
    non_negative(velocity=velocity, plug_mass_ratio=plug_mass_ratio)
    if velocity <= limit_velocity:
        return 0.0
    return math.sqrt((velocity - limit_velocity) * (velocity + limit_velocity)) / (1.0 + plug_mass_ratio)


def energy_budget(velocity: float, *, mass: float, limit_velocity: float, plug_mass_ratio: float) -> Budget:
    """The parts of M_p V^2/2, J, at a velocity (m/s) from the limit on; mass M_p in kg. Anderson (2017), eqs. (18) to (20)."""
    positive(mass=mass)
    left = residual_velocity(velocity, limit_velocity=limit_velocity, plug_mass_ratio=plug_mass_ratio)
    return Budget(
        residual=0.5 * mass * (1.0 + plug_mass_ratio) * left**2,
        deformation=0.5 * mass * velocity**2 * plug_mass_ratio / (1.0 + plug_mass_ratio),
        shear=0.5 * mass * min(velocity, limit_velocity) ** 2 / (1.0 + plug_mass_ratio),
    )


def evaluate_plug(velocity: float, *, rod_density: float, rod_length: float, rod_diameter: float, target_density: float,
                  target_thickness: float, plug_diameter: float | None, plate_limit_velocity: float) -> dict[str, float | str]:
    """Residual velocity with a plug at an impact velocity in m/s; keywords are those of ``PLUG.inputs``, in SI."""
    ratio = plug_mass_ratio(rod_density=rod_density, rod_length=rod_length, rod_diameter=rod_diameter,
                            target_density=target_density, target_thickness=target_thickness, plug_diameter=plug_diameter)
    return {**_left(velocity, plate_limit_velocity, ratio), "plug_mass_ratio": ratio}


def evaluate_piercing(velocity: float, *, plate_limit_velocity: float) -> dict[str, float | str]:
    """Residual velocity without a plug at an impact velocity in m/s; the keyword is that of ``PIERCING.inputs``, in SI."""
    return _left(velocity, plate_limit_velocity, 0.0)


def _left(velocity: float, limit: float, ratio: float) -> dict[str, float | str]:
    left = residual_velocity(velocity, limit_velocity=limit, plug_mass_ratio=ratio)
    return {
        "residual_velocity": left,
        "residual_over_limit": left / limit,
        "limit_velocity": limit,
        "regime": "perforation" if left > 0.0 else "stopped",
    }


LIMIT_VELOCITY = Input("plate.limit_velocity", "m/s", "ballistic limit of projectile and plate, measured", "V50")
OUTPUTS = (
    Output("residual_velocity", "m/s", "velocity behind the plate", "V_r"),
    Output("residual_over_limit", "1", "velocity behind the plate over the ballistic limit", "V_r/V50"),
    Output("limit_velocity", "m/s", "ballistic limit", "V50"),
    Output("regime", "", "perforation or stopped"),
)
SOURCE = "Recht & Ipson, J. Appl. Mech. 30 (1963) 384; Anderson, Int. J. Impact Engng 108 (2017) 3, "

PLUG = Model(
    name="recht-ipson-plug",
    title="Recht-Ipson: residual velocity of a chunky projectile that drives out a plug",
    source=SOURCE + "eqs. (17) to (22)",
    validity="chunky projectiles that do not deform much, plates thinner than half their length and diameter, normal impact",
    inputs=(
        inputs.ROD_DENSITY,
        inputs.ROD_LENGTH,
        inputs.ROD_DIAMETER,
        inputs.TARGET_DENSITY,
        inputs.TARGET_THICKNESS,
        Input("plug.diameter", "m", "diameter of the plug; the rod's where not given", "d", default=None),
        LIMIT_VELOCITY,
    ),
    outputs=(*OUTPUTS, Output("plug_mass_ratio", "1", "mass of the plug over that of the projectile", "m_p/M_p")),
    main="residual_velocity",
    example=Example(
        rod="steel_4340", target="iron_Armco", velocity=600.0, velocities=(100.0, 1200.0),
        values=MappingProxyType(
            {"rod.length": 0.02, "rod.diameter": 0.02, "target.thickness": 0.006, "plate.limit_velocity": 200.0}),
    ),
    evaluate=evaluate_plug,
)

PIERCING = Model(
    name="recht-ipson-piercing",
    title="Recht-Ipson: residual velocity of an armour-piercing bullet, without a plug",
    source=SOURCE + "eqs. (23) to (25)",
    validity="bullets that do not deform, thick plates, work in the plate that does not depend on velocity",
    inputs=(LIMIT_VELOCITY,),
    outputs=OUTPUTS,
    main="residual_velocity",
    example=Example(
        rod="steel_4340", target="steel_4340", velocity=900.0, velocities=(300.0, 1500.0),
        values=MappingProxyType({"plate.limit_velocity": 600.0}),
    ),
    evaluate=evaluate_piercing,
)

MODELS = (PLUG, PIERCING)
