"""A hard block that slides on a soft one, in planar geometry: the effect of the slip layer on the exchange of momentum.

Tungsten slides at 200 m/s along z on aluminium. The ends of the blocks are free and 24 mm away: no wave from them reaches
the middle, where the motion depends on r alone, and the momentum of the aluminium is the traction times the time.

The slip layer can do this: beyond it the aluminium feels friction times pressure, and nothing without friction. It cannot do
this: the boundary layer, two cells of aluminium, sticks to the tungsten and takes its velocity, which costs the tungsten their
momentum once; and the width of both layers, not the surface of the bodies, is where it slides.
"""

import functools

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.decks import box, material, mesh, stop, table, walls

SPEED, YIELD = 200.0, 0.3e9
SURFACE, CELL = 2.1e-3, 0.25e-3
LAYERS = SURFACE + 4 * CELL
BLOCKS = (
    mesh(("6 mm", 24), ("48 mm", 96), geometry="planar")
    + walls("r_min", "r_max")
    + box("hard", "elastic_W", r=[0.0, "2.1 mm"], z=["-1 m", "1 m"], velocity="200 m/s")
    + box("soft", "elastic_Al", r=["2.1 mm", "6 mm"], z=["-1 m", "1 m"])
    + material("elastic_W", "W_alloy")
    + material("elastic_Al", "Al5083",
               strength={"model": "elastic-plastic", "shear_modulus": "26 GPa", "yield_stress": "0.3 GPa"})
    + table("numerics", initial_dt_factor=1.0)
    + stop("2.5 us")
)
SLIP = 'sliding.method="slip-layer"', 'sliding.hard=["hard"]'
SHEAR = *SLIP, 'sliding.shear="shear"'


@functools.cache
def slid(pressure: float, *options: str) -> tuple[float, float, float]:
    """Mean shear traction on the aluminium beyond the layers and on all of it, mean pressure in the slip layer: Pa."""
    loaded = [f"body.{name}.pressure={pressure}" for name in ("hard", "soft")] if pressure else []
    simulation = Simulation(deck.loads(BLOCKS, [*options, *loaded]))
    s, g = simulation.state, simulation.grid
    j, slip, impulse = g.g + g.nz // 2, int(np.searchsorted(g.r, SURFACE + 3 * CELL)) - 1, 0.0
    while simulation.stop_reason() is None:
        simulation.step()
        impulse += s.p[j, slip] * simulation.dt
    v = 0.25 * (s.v[0, j, :-1] + s.v[0, j, 1:] + s.v[0, j + 1, :-1] + s.v[0, j + 1, 1:])
    momentum = s.vof[1, j] * s.rho[1, j] * g.dr * v
    beyond = momentum[g.r[:-1] > LAYERS].sum()
    return beyond / simulation.time, momentum.sum() / simulation.time, impulse / simulation.time


@pytest.mark.parametrize("pressure", [0.0, 1e9])
def test_without_treatment_the_traction_is_the_yield_in_shear(pressure):
    """Y/sqrt 3 = 173 MPa would act on the aluminium; the part beyond the layers gets it less the momentum on its way."""
    beyond, everywhere, _ = slid(pressure)
    assert 0.75 < beyond / (YIELD / 3**0.5) < 1.0
    assert everywhere > YIELD / 3**0.5


@pytest.mark.parametrize("options", [SLIP, SHEAR], ids=["fluid", "shear"])
@pytest.mark.parametrize("pressure", [0.0, 1e9])
def test_slip_layer_lets_no_traction_through(options, pressure):
    beyond, everywhere, _ = slid(pressure, *options)
    assert abs(beyond) < 1e-4 * slid(pressure)[0]
    # the momentum exchanged is that of the boundary layer, some of it in cells shared with the slip layer
    layer = 2660.0 * 2.6 * CELL * SPEED / 2.5e-6
    assert 0.6 * layer < everywhere < layer


@pytest.mark.parametrize("friction", [0.05, 0.1])
def test_friction_times_pressure_gets_through(friction):
    free, _, _ = slid(1e9, *SHEAR)
    beyond, _, pressure = slid(1e9, *SHEAR, f"sliding.friction={friction}")
    assert (beyond - free) / pressure == pytest.approx(friction, rel=0.2)


def test_much_friction_is_tied_contact():
    beyond, _, _ = slid(1e9, *SHEAR, "sliding.friction=0.5")
    assert beyond == pytest.approx(slid(1e9)[0], rel=0.1)


def test_friction_needs_pressure():
    assert slid(0.0, *SHEAR, "sliding.friction=0.1")[0] < 0.05 * slid(0.0)[0]
