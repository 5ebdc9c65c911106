"""The standard copper bar at 227 m/s, on a wall and on its like, and the Johnson-Cook bar, against Lagrangian solutions."""

import functools

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from problems.validation import bar
from tests.verification.running import finish

FOLDER = "problems/validation"


@functools.cache
def history(name: str, *overrides: str, body: int = 0):
    """The simulation at its end, and the bar after every step."""
    deck, bars = decks.load(f"{FOLDER}/{name}.toml", list(overrides)), []

    def watch(simulation):
        grid, state = simulation.grid, simulation.state
        fields = (grid.interior(field)[body] for field in (state.vof, state.ep))
        bars.append(bar.shape(grid.r_edges, grid.z_edges, *fields, deck.body[body].velocity[1], simulation.time))

    return finish(deck, watch), bars


def held(bars, known, length: float, foot: float, early: float = 0.05) -> None:
    """Length and foot agree with a solution within shares of its values: at its last time, the foot before within `early`."""
    for expected in known:
        shape, last = bar.at(bars, expected.time), expected is known[-1]
        assert shape.length == pytest.approx(expected.length, rel=length), f"length at {expected.time:g} s"
        assert shape.foot == pytest.approx(expected.foot, rel=foot if last else early), f"foot at {expected.time:g} s"


KNOWN = bar.reference(227.0, 32.4e-3)


@pytest.mark.thorough
def test_on_a_wall():
    """21.42 mm within 1.5 %, 7.226 mm within 4 %, and so on the way; the audit closes."""
    simulation, bars = history("copper_bar")
    held(bars, KNOWN, 0.015, 0.04)
    assert 2.4 < bars[-1].strain < 3.4
    balance = simulation.conservation()
    assert abs(balance["total_energy"]) < 1e-11
    assert max(abs(x) for x in balance["mass"].values()) < 1e-12


@pytest.mark.slow
def test_on_a_wall_with_32_cells():
    _, bars = history("copper_bar_32")
    held(bars, KNOWN, 0.01, 0.025)
    assert 2.4 < bars[-1].strain < 3.4


@pytest.mark.slow
def test_two_bars_do_as_the_wall_does():
    """As one body they are mirror images, except for growing round-off, and each has the length of the bar on the wall."""
    simulation, bars = history("copper_bar_pair", "body.other.join=bar")
    vof = simulation.grid.interior(simulation.state.vof)[0]
    assert np.sum(np.abs(vof - vof[::-1])) < 1e-3 * np.sum(vof)
    _, alone = history("copper_bar")
    assert 0.5 * bars[-1].length == pytest.approx(alone[-1].length, rel=2e-3)


@pytest.mark.slow
def test_length_of_two_bars_of_their_own():
    _, bars = history("copper_bar_pair")
    _, alone = history("copper_bar")
    assert bars[-1].length == pytest.approx(alone[-1].length, rel=2e-3)


@pytest.mark.slow
@pytest.mark.xfail(strict=True, reason="where both bars meet void, nested interfaces take the first bar's rim for a corner")
def test_foot_of_two_bars_of_their_own():
    """5.40 mm in the first row of cells and 7.01 in the next, where the bar on the wall has 7.275 and 7.1."""
    _, bars = history("copper_bar_pair")
    held(bars, KNOWN, 0.015, 0.04)


@pytest.mark.slow
def test_johnson_cook():
    """17.375 mm within 1.5 %, 7.27 mm within 4 %, at 60 us."""
    _, bars = history("copper_bar_johnson_cook")
    held(bars, bar.reference(190.0, 25.4e-3), 0.015, 0.04)
    assert bars[-1].strain == pytest.approx(2.0, rel=0.15)


@pytest.mark.thorough
def test_friction_at_the_anvil_narrows_the_foot():
    """By 11 % at a coefficient of 0.2 with 16 cells across the radius, and leaves the bar 2 % longer; here with 8 cells."""
    free, rubbed = (
        finish(decks.load(f"{FOLDER}/copper_bar_friction.toml", ["mesh.cells_across=8", f"sliding.friction={friction}"]))
        .of_bodies()["bar"] for friction in (0.0, 0.2))
    assert rubbed["radius_at_z_min_m"] / free["radius_at_z_min_m"] == pytest.approx(0.89, abs=0.02)
    assert rubbed["length_m"] / free["length_m"] == pytest.approx(1.02, abs=0.01)
