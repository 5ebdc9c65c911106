"""The state in which a body of a deck begins: its slot, its velocity, and density and energy by its material."""

from __future__ import annotations

import math
from contextlib import suppress

import numpy as np

from hydro2d.base.errors import DeckError

#: equation of state of material that has a pressure at any density
GAS = "ideal-gas"


def slot_of(deck, table) -> list[int]:
    """Index m of every body of the deck."""
    return [table.names.index(body.join or body.name) for body in deck.body]


def body_velocity(body, r, z) -> tuple[np.ndarray, np.ndarray]:
    """Radial and axial velocity of a body at the points (r, z), in m/s; arrays or numbers."""
    r, z = np.broadcast_arrays(np.asarray(r, dtype=float), np.asarray(z, dtype=float))
    u, v = np.full(r.shape, body.velocity[0]), np.full(r.shape, body.velocity[1])
    flow = body.flow
    if flow is None:
        return u, v
    height = z - flow.centre if flow.pattern == "spherical" else np.zeros(r.shape)
    distance = np.hypot(r, height)
    there = distance > 0
    safe = np.where(there, distance, 1.0)
    speed = np.where(there, flow.speed * (flow.radius / safe) ** flow.exponent, 0.0)
    return u + speed * r / safe, v + speed * height / safe


def body_state(body, table, m: int) -> tuple[float, float]:
    """Initial density and specific internal energy of a body in slot m.

    By default a body is at exactly zero pressure: rho0 and e0 of its material. With a given temperature it has the density
    at which its pressure is the given one, or zero; a gas has its own density.
    DeckError if no state has the required pressure or temperature.
    """
    gas = table.materials[m].eos.name == GAS
    if body.temperature is not None and body.density is None and not (gas and body.pressure is None):
        return _state_for(body, table, m, body.pressure or 0.0, body.temperature)
    rho = body.density if body.density is not None else float(table.rho0[m])
    if body.energy is not None:
        return rho, body.energy
    if body.pressure is not None:
        return rho, _energy_for(body, table, m, rho, 0, body.pressure)
    if body.temperature is not None:
        return rho, _energy_for(body, table, m, rho, 3, body.temperature)
    return rho, float(table.e0[m])


def _state_for(body, table, m: int, pressure: float, temperature: float) -> tuple[float, float]:
    """Density and energy at which a body has a pressure and a temperature: that nearest to its own density.

    DeckError if there is none from a fifth of its own density to five times it.
    """
    own = float(table.rho0[m])

    def error(rho: float) -> float:
        return table.evaluate(m, rho, _energy_for(body, table, m, rho, 3, temperature))[0] - pressure

    inner, at_inner = own, error(own)
    step = 0.98 if at_inner > 0.0 else 1.02
    outer, at_outer = inner, at_inner
    with suppress(DeckError):  # without this temperature there is no such state either
        while at_outer * at_inner > 0.0 and 0.2 * own < outer < 5.0 * own:
            inner, outer = outer, outer * step
            at_outer = error(outer)
    if not at_outer * at_inner <= 0.0:
        raise DeckError(f'body "{body.name}": {table.materials[m].name} has no density with a pressure of {pressure:g} Pa at '
                        f"{temperature:g} K; give its density")
    for _ in range(200):
        middle = 0.5 * (inner + outer)
        if middle in (inner, outer):
            break
        inner, outer = (middle, outer) if error(middle) * at_inner > 0.0 else (inner, middle)
    return inner, _energy_for(body, table, m, inner, 3, temperature)


def _energy_for(body, table, m: int, rho: float, which: int, target: float) -> float:
    """The energy at which output ``which`` of the equation of state (0 pressure, 3 temperature) has a value.

    Both are linear in the energy in every model with a constant specific heat; a secant serves the others.
    """
    def error(e: float) -> float:
        return table.evaluate(m, rho, e)[which] - target

    low, high = float(table.e0[m]), float(table.e0[m]) + 1e5
    at_low, at_high = error(low), error(high)
    for _ in range(50):
        if at_low == 0.0 or at_high == at_low:
            break
        low, high, at_high = low - at_low * (high - low) / (at_high - at_low), low, at_low
        at_low = error(low)
    if not abs(at_low) <= 1e-9 * abs(target) + 1e-6:
        what = ("pressure", "", "", "temperature")[which]
        limits = table.limits(m, rho, table.virgin(m))
        raise DeckError(f'body "{body.name}": no energy gives a {what} of {target:g} at a density of {rho:g} kg/m^3'
                        + (f"; {limits}" if limits else ""))
    return low


def refuse_unstable(body, table, m: int) -> None:
    """Raises DeckError if the square of the speed of sound is negative at the start, since such material fails at once, if
    its table has no such state, or if the equation of state gives a number that is not finite."""
    rho, e = body_state(body, table, m)
    state = table.evaluate(m, rho, e)
    p = state[0]
    if math.isnan(p) and (limits := table.limits(m, rho, table.virgin(m))):
        raise DeckError(f'body "{body.name}": cannot begin with a density of {rho:g} kg/m^3 and an energy of {e:g} J/kg: '
                        f"{limits}")
    if not np.isfinite(state).all():
        raise DeckError(f'body "{body.name}": cannot begin with a density of {rho:g} kg/m^3 and an energy of {e:g} J/kg: '
                        f"{table.materials[m].eos.title} gives p, dp/drho, dp/de and T of {', '.join(f'{x:g}' for x in state)}")
    if table.sound_speed_squared(m, rho, e, -math.inf) < 0.0:
        raise DeckError(f'body "{body.name}": cannot begin with a density of {rho:g} kg/m^3 and an energy of {e:g} J/kg; at '
                        f"{p:.3g} Pa, its pressure there, {table.materials[m].name} has no speed of sound")
