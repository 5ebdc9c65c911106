"""Flow stress of a material against plastic strain at a constant rate, isothermal or heated by its own plastic work."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from hydro2d.base.errors import DeckError
from hydro2d.materials.material import Material

#: temperature, K, of a material whose equation of state has no initial temperature; longest step in plastic strain
ROOM, STEP = 298.0, 1e-3


def at_rest(material: Material):
    """The strength model, its row, and the state at rest: pressure (Pa), density (kg/m^3) and temperature (K)."""
    model = material.strength.module("strength")
    temperature = material.eos.numbers.get("reference_temperature")
    T = temperature.value if temperature else ROOM
    return model, model.row(material.strength.values), (0.0, material.reference_density, T)


def flow_stress(
    material: Material, rate: float, strains: Sequence[float], *, isothermal: bool = False, temperature: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Flow stress (Pa) and temperature (K) at plastic strains, both float64[n], at zero pressure and the density at rest.

    rate : plastic strain rate, 1/s
    strains : plastic strains, not decreasing
    isothermal : at constant temperature; otherwise all plastic work heats, rho c dT = Y d(ep), as in the solver
    temperature : at zero strain, K; None: that of the material at rest

    Raises DeckError for a material without strength, and for one without a specific heat unless isothermal.
    """
    if not material.has_strength:
        raise DeckError(f"{material.name} has no strength")
    heat = material.eos.numbers.get("specific_heat")
    if not (isothermal or heat):
        raise DeckError(f"{material.name} has no specific heat; its flow stress is known at only one temperature")
    model, row, (p, rho, T) = at_rest(material)
    T = T if temperature is None else temperature
    warming = 0.0 if isothermal else 1.0 / (rho * heat.value)

    def law(ep: float, T: float) -> float:
        return model.flow_stress(ep, rate, T, p, rho, row)

    return along(law, T, warming, strains, STEP)


def along(
    law: Callable[[float, float], float], T: float, warming: float, strains: Sequence[float], longest: float
) -> tuple[np.ndarray, np.ndarray]:
    """Flow stress (Pa) and temperature (K) at non-decreasing plastic strains, both float64[n], by the midpoint rule.

    law : flow stress at a plastic strain and a temperature
    T : temperature at zero strain
    warming : temperature gained by a unit of plastic work, K m^3/J: 1/(rho c) if all of it heats, 0 at a constant temperature
    longest : longest step in plastic strain
    """
    ep, stresses, temperatures = 0.0, [], []
    for strain in strains:
        steps = max(int(np.ceil((strain - ep) / longest)), 1) if warming else 0
        step = (strain - ep) / max(steps, 1)
        for _ in range(steps):
            half = T + 0.5 * step * warming * law(ep, T)
            T += step * warming * law(ep + 0.5 * step, half)
            ep += step
        ep = strain
        stresses.append(law(strain, T))
        temperatures.append(T)
    return np.array(stresses, dtype=float), np.array(temperatures, dtype=float)
