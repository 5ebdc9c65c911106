"""A shock of 12 km/s into aluminium and its release into vacuum: Tillotson's equation of state in all regions."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from eos import tillotson
from eos.dispatch import sound_speed_squared
from hydro2d.materials import library
from tests.eos.test_tillotson import shocked
from tests.verification.running import ADVECTION, Line, advection, between, run

ROW = tillotson.row(library.load("Al_tillotson").eos.values)
U = 6000.0
#: pressure and density of the plateau, and its energy: `ke` and `momentum` lose kinetic energy at strong shocks
PLATEAU = {"both": (3e-3, 1e-2), "momentum": (1e-2, 6e-2), "ke": (2e-2, 7e-2)}


@pytest.mark.parametrize("choice", ADVECTION)
def test_shock_and_release(choice):
    simulation = run("plate_impact_vapour", advection(choice))
    line, time = Line(simulation), simulation.time
    rho, p = shocked(ROW, U)
    near, nearly = PLATEAU[choice]
    speed = p / (ROW[tillotson.RHO0] * U)
    interface = U * time
    plateau = between(line.x, (2.0 * U - speed) * time, interface)
    assert line.pressure[plateau].mean() == pytest.approx(p, rel=near)
    assert line.body("rho", 0)[plateau].mean() == pytest.approx(rho, rel=near)
    assert line.body("e", 0)[plateau].mean() == pytest.approx(0.5 * U * U, rel=nearly)
    assert abs(simulation.conservation()["total_energy"]) < 1e-12

    def slope(density, y):
        state = tillotson.evaluate(density, y[0], ROW)
        c = sound_speed_squared(density, state[0], state[1], state[2], 0.0) ** 0.5
        return [state[0] / density**2, -c / density]

    fan = solve_ivp(slope, (rho, 1900.0), [0.5 * U * U, U], rtol=1e-9, atol=1e-6, dense_output=True)
    density, velocity = line.body("rho", 1), 0.5 * (line.velocity[1:] + line.velocity[:-1])
    inside = (line.body("vof", 1) == 1.0) & (density > 1900.0) & (density < 0.97 * rho) & (line.x > interface + 0.5e-3)
    e, u = fan.sol(density[inside])
    pressed = np.array([tillotson.evaluate(*state, ROW)[0] for state in zip(density[inside], e, strict=True)]) > 2e9
    assert pressed.sum() > 20
    assert np.abs(velocity[inside] - u)[pressed].max() < nearly * (u.max() - U)
    assert np.abs(line.body("e", 1)[inside] - e)[pressed].max() < nearly * 0.5 * U * U
    assert e[density[inside] < 2700.0].min() > 3e6  # partly vaporised where it has expanded
