"""Selects the equation of state by its integer id, and derives the quantities common to all of them.

The models are those in ``registry`` when this module is imported, together with the kernels.
"""

from __future__ import annotations

from eos import mie_grueneisen, registry
from hydro2d.jit import by_id, not_inlined, point
from hydro2d.mesh.fields import DMG, RHO, E

MODULES = registry.chosen()
#: ids of the models that have internal variables
WITH_MEMORY = tuple(module.ID for module in MODULES if hasattr(module, "INTERNAL"))

_ITERATIONS = 60
_TOLERANCE = 1e-13
_FARTHEST = 16.0


_NAN = 'float("nan"), float("nan"), float("nan"), float("nan")'

evaluate_without_memory = by_id(
    tuple(module for module in MODULES if module.ID not in WITH_MEMORY), "evaluate", registry.FUNCTIONS["evaluate"][0],
    "(p, dp/drho at constant e, dp/de at constant rho, T) of a model without internal variables; SI. par: the material's row.",
    _NAN)

_evaluate_with_memory = by_id(
    tuple(module for module in MODULES if module.ID in WITH_MEMORY), "evaluate", registry.MEMORY_FUNCTIONS["evaluate"][0],
    "(p, dp/drho, dp/de, T) of a model at constant internal variables; SI. internal: float64[n], one cell's.", _NAN)

_update = by_id(
    tuple(module for module in MODULES if module.ID in WITH_MEMORY), "update", registry.MEMORY_FUNCTIONS["update"][0],
    "Internal variables of an equation of state after a step: see `update`.", "None")


@not_inlined
def evaluate_with_memory(model, rho, e, internal, par):
    """`evaluate` of a model with internal variables. Called, not inlined: kernels of bodies without memory stay as they are."""
    return _evaluate_with_memory(model, rho, e, internal, par)


@point
def evaluate(model, rho, e, internal, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) of an equation of state at constant internal variables; SI.

    par : the material's row, float64[k];  internal : float64[n], one cell's; ignored by a model without internal variables
    """
    if model in WITH_MEMORY:
        return evaluate_with_memory(model, rho, e, internal, par)
    return evaluate_without_memory(model, rho, e, par)


@not_inlined
def update(model, rho0, rho, e, dep, work, damage0, damage, released, time, dt, par, internal):
    """Internal variables of an equation of state at the end of a Lagrangian step.

    rho0, rho : density before and after, kg/m^3;  e : energy after, J/kg;  dep, work : plastic strain and plastic work of the
    step, J/m^3;  damage0, damage : before and after;  released : elastic energy of the deviator that the damage of the step has
    released, J/m^3;  time : at the end of the step, s

    Updates  internal [n]
    """
    _update(model, rho0, rho, e, dep, work, damage0, damage, released, time, dt, par, internal)


@point
def pressure_row(model, par, floor, first, number, f, rho, e, damage, p, c2):
    """Fills rows of pressure and c^2, 0 outside the body (f = 0); failed material bears no tension.

    explanation/equation-of-state, explanation/fracture
    """
    if model == mie_grueneisen.ID:
        end = first + number
        f, damage, rho, e = f[first:end], damage[first:end], rho[first:end], e[first:end]
        p, c2 = p[first:end], c2[first:end]
        for x in range(number):
            p[x], c2[x] = _state(f[x], damage[x], rho[x], floor, mie_grueneisen.evaluate(rho[x], e[x], par))
    else:
        for x in range(number):
            i = first + x
            p[i], c2[i] = _state(f[i], damage[i], rho[i], floor, evaluate_without_memory(model, rho[i], e[i], par))


@point
def temperature_row(model, par, first, number, f, rho, e, T):
    """Fills a row of temperature, 0 outside the body. Separate from the pressure: a table cannot be read in vector lanes."""
    for x in range(number):
        i = first + x
        T[i] = evaluate_without_memory(model, rho[i], e[i], par)[3] if f[i] > 0.0 else 0.0


@not_inlined
def pressure_row_with_memory(model, par, floor, m, j, first, at, number, vof, q, pm, c2):
    """`pressure_row` of body m in row j from column `at` on; the internal variables of its model begin at row `first` of q.

    Reads    vof [m, j, i], q [k, m, j, i]
    Writes   pm, c2 [m, j, i]
    """
    for x in range(number):
        i = at + x
        state = evaluate_with_memory(model, q[RHO, m, j, i], q[E, m, j, i], q[first:, m, j, i], par)
        pm[m, j, i], c2[m, j, i] = _state(vof[m, j, i], q[DMG, m, j, i], q[RHO, m, j, i], floor, state)


@not_inlined
def temperature_row_with_memory(model, par, m, j, first, at, number, vof, q, tm):
    """`temperature_row` of a model with internal variables; arguments as in `pressure_row_with_memory`.

    Reads    vof [m, j, i], q [k, m, j, i]
    Writes   tm [m, j, i]
    """
    for x in range(number):
        i = at + x
        T = evaluate_with_memory(model, q[RHO, m, j, i], q[E, m, j, i], q[first:, m, j, i], par)[3]
        tm[m, j, i] = T if vof[m, j, i] > 0.0 else 0.0


@point
def _state(f, damage, rho, floor, state):
    """(p, c^2) of a cell from (p, dp/drho, dp/de, T) of its material."""
    pressure = max(state[0], 0.0) if damage >= 1.0 else state[0]
    square = sound_speed_squared(rho, pressure, state[1], state[2], floor)
    return pressure if f > 0.0 else 0.0, square if f > 0.0 else 0.0


@point
def sound_speed_squared(rho, p, dpdrho, dpde, floor):
    """c^2 = dp/drho|e + (p/rho^2) dp/de|rho, not below ``floor``; m^2/s^2. A NaN stays a NaN.

    explanation/equation-of-state, (5)
    """
    c2 = dpdrho + p * dpde / (rho * rho)
    return floor if c2 < floor else c2


@point
def zero_pressure_density(model, rho, e, internal, par):
    """The density rho* with p(rho*, e) = 0 at constant energy: above ``rho`` in tension, below it otherwise; kg/m^3.

    explanation/fracture, (2), by a bracketed Newton iteration. Where no such density lies within a factor of 16, as in
    a gas, the answer is ``rho`` itself.
    """
    p, dpdrho, dpde, T = evaluate(model, rho, e, internal, par)
    if p == 0.0:
        return rho
    tension = p < 0.0
    factor = 1.25 if tension else 0.8
    near, far = rho, rho * factor
    pressure = evaluate(model, far, e, internal, par)[0]
    while (pressure < 0.0) == tension and pressure != 0.0:
        near, far = far, far * factor
        if not rho < far * _FARTHEST or not far < rho * _FARTHEST:
            return rho
        pressure = evaluate(model, far, e, internal, par)[0]
    low, high = (near, far) if tension else (far, near)
    x = rho - p / dpdrho if dpdrho > 0.0 else low
    for _ in range(_ITERATIONS):
        if not (low < x and x < high):
            x = 0.5 * (low + high)
        p, dpdrho, dpde, T = evaluate(model, x, e, internal, par)
        if p < 0.0:
            low = x
        elif p != 0.0:  # a NaN too: the search has left a table
            high = x
        else:
            return x
        step = p / dpdrho
        x = x - step
        if abs(step) <= _TOLERANCE * x or high - low <= _TOLERANCE * x:
            return min(max(x, low), high)
    return x
