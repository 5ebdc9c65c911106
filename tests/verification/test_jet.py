"""Jets without strength along a cylinder, against compressible Bernoulli: velocity of the interface, stagnation pressure.

Both are means over several diameters of depth, because jet and target oscillate after the impact.
"""

import pytest

from hydro2d.deck import deck as decks
from hydro2d.materials import pressure_temperature
from problems.validation import jet
from tests.verification.running import advection, finish

COARSE = ("mesh.r.0.size=1 mm", "mesh.z.0.size=1 mm")
EVERY = 5


def errors(name: str, *overrides: str, last: float = 10.0) -> tuple[float, float, float]:
    """Relative errors from 3 to `last` diameters of depth: velocity, mean pressures on the side of jet and target."""
    deck, points = decks.load(f"problems/validation/{name}.toml", list(overrides)), []
    radius = decks.body_radius(deck, "jet")

    def watch(simulation):
        if simulation.cycle % EVERY == 0:
            grid = simulation.grid
            shares = (grid.interior(body)[:, 0] for body in simulation.state.vof)
            pressures, _ = pressure_temperature.of(simulation)
            columns = tuple(body[:, 0] for body in pressures)
            points.append(jet.point(grid.z_edges, *shares, columns, jet.REACH * radius, simulation.time))

    finish(deck, watch)
    mean = jet.mean([at for at in points if at], 6.0 * radius, 2.0 * last * radius)
    materials = (deck.materials[body.material] for body in deck.body)
    u, p = jet.bernoulli(*materials, deck.body[0].velocity[1])
    return mean["velocity"] / u - 1.0, mean["jet"] / p - 1.0, mean["target"] / p - 1.0


@pytest.mark.parametrize("name", ["jet_w_5083_2", "jet_w_5083_5"])
def test_five_cells_across(name):
    velocity, own, other = errors(name, *COARSE)
    assert abs(velocity) < 0.01
    assert abs(own) < 0.03
    assert abs(other) < 0.03


@pytest.mark.slow
@pytest.mark.parametrize("name", ["jet_w_5083_2", "jet_w_5083_3", "jet_w_5083_5"])
def test_ten_cells_across(name):
    velocity, own, other = errors(name)
    assert abs(velocity) < 0.01
    assert abs(own) < 0.03
    assert abs(other) < 0.03


@pytest.mark.slow
def test_copper_on_copper():
    """Until the impact wave is back from the jet's tail."""
    velocity, own, other = errors("jet_cu_cu_3", last=7.0)
    assert abs(velocity) < 0.01
    assert abs(own) < 0.03
    assert abs(other) < 0.03


@pytest.mark.slow
@pytest.mark.parametrize("choice", ["momentum", "both"])
def test_other_advection(choice):
    velocity, own, other = errors("jet_w_5083_2", advection(choice))
    assert abs(velocity) < 0.01
    assert abs(own) < 0.03
    assert abs(other) < 0.03
