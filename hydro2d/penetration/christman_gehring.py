"""Christman-Gehring: hydrodynamic penetration by all but one diameter of a rod's length, and the crater of that last diameter.

P = (L - D) sqrt(rho_p/rho_t) + P_c, where P_c is the depth of a rod as long as wide at the same velocity. P_c is
measured or comes from a correlation with energy and hardness. Anderson, Int. J. Impact Engng 108 (2017) 3, equations (15) and
(16); Christman & Gehring, J. Appl. Phys. 37 (1966) 1579. The units of the correlation's coefficient are not known:
explanation/penetration/christman-gehring.
"""

from __future__ import annotations

import math
from types import MappingProxyType

from hydro2d.penetration import inputs
from hydro2d.penetration.model import Example, Input, InputError, Model, Output, positive

#: coefficient of eq. (16) as printed, used here in consistent units
CRATER_COEFFICIENT = 0.13


def crater_depth(velocity: float, *, rod_density: float, rod_diameter: float, target_density: float, hardness: float,
                 coefficient: float = CRATER_COEFFICIENT) -> float:
    """P_c = k (rho_p/rho_t)^(1/3) (m V^2/(2 B_max))^(1/3), m: Anderson (2017), eq. (16).

    m: mass of a rod as long as wide, pi rho_p D^3/4, kg; hardness B_max: highest hardness at the bottom of the crater, Pa.
    In consistent units, as here, k = 0.13 gives craters several times too shallow: explanation/penetration/christman-gehring.
    """
    positive(velocity=velocity, rod_density=rod_density, rod_diameter=rod_diameter, target_density=target_density,
             hardness=hardness, coefficient=coefficient)
    energy = 0.5 * (0.25 * math.pi * rod_density * rod_diameter**3) * velocity**2
    return coefficient * math.cbrt(rod_density / target_density * energy / hardness)


def depth(*, rod_density: float, rod_length: float, rod_diameter: float, target_density: float, crater: float) -> float:
    """P = (L - D) sqrt(rho_p/rho_t) + P_c, m: Anderson (2017), eq. (15), with the crater's depth P_c in m.

    For 2.0 to 6.7 km/s and rods of 1 to 25 diameters, of aluminium and steel into aluminium and steel.
    """
    positive(rod_density=rod_density, rod_length=rod_length, rod_diameter=rod_diameter, target_density=target_density,
             crater=crater)
    if rod_length < rod_diameter:
        raise InputError(f"rod.length = {rod_length:g}: must not be less than rod.diameter = {rod_diameter:g}")
    return (rod_length - rod_diameter) * math.sqrt(rod_density / target_density) + crater


def evaluate(velocity: float, *, rod_density: float, rod_length: float, rod_diameter: float, target_density: float,
             target_hardness: float | None, crater_depth_one: float | None, crater_coefficient: float) -> dict[str, float]:
    """Depth at an impact velocity in m/s; keywords are those of ``MODEL.inputs``, in SI."""
    positive(velocity=velocity)
    values = {"rod_density": rod_density, "rod_diameter": rod_diameter, "target_density": target_density}
    crater = crater_depth_one
    if crater is None:
        if target_hardness is None:
            raise InputError("crater.depth_one is not given: it needs target.hardness")
        crater = crater_depth(velocity, hardness=target_hardness, coefficient=crater_coefficient, **values)
    total = depth(rod_length=rod_length, crater=crater, **values)
    return {
        "depth": total,
        "depth_over_length": total / rod_length,
        "primary_depth": total - crater,
        "crater_depth": crater,
    }


MODEL = Model(
    name="christman-gehring",
    title="Christman-Gehring: hydrodynamic penetration and a terminal crater",
    source="Christman & Gehring, J. Appl. Phys. 37 (1966) 1579; Anderson, Int. J. Impact Engng 108 (2017) 3, eqs. (15), (16)",
    validity="2.0 to 6.7 km/s, rods of 1 to 25 diameters, aluminium and steel; give crater.depth_one where it is known",
    inputs=(
        inputs.ROD_DENSITY,
        inputs.ROD_LENGTH.but(description="length of the rod, a cylinder"),
        inputs.ROD_DIAMETER,
        inputs.TARGET_DENSITY,
        Input("target.hardness", "Pa", "highest hardness at the bottom of the crater, as a pressure", "B_max", default=None),
        Input("crater.depth_one", "m", "depth that a rod as long as wide reaches; from target.hardness where not given", "P_c",
              default=None),
        Input("crater.coefficient", "1", "coefficient of the correlation for that depth", "k", default=CRATER_COEFFICIENT),
    ),
    outputs=(
        Output("depth", "m", "depth of penetration", "P"),
        Output("depth_over_length", "1", "depth over the rod's length", "P/L"),
        Output("primary_depth", "m", "depth of the steady phase"),
        Output("crater_depth", "m", "depth of the terminal phase", "P_c"),
    ),
    main="depth_over_length",
    example=Example(
        rod="steel_4340", target="Al2024_T4", velocity=4000.0, velocities=(2000.0, 6700.0),
        values=MappingProxyType({"rod.length": 0.05, "rod.diameter": 0.005, "target.hardness": 1.5e9}),
    ),
    evaluate=evaluate,
)
