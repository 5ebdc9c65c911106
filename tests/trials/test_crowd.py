"""A few of the random decks of `crowd`; their twins give the expected results."""

import tomllib

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.trials import crowd


@pytest.mark.parametrize("number", range(2000, 2336, 13))
def test_a_deck_and_its_twins(number):
    """A run that is off its course reports it itself; friction of a contact has an order (explanation/sliding)."""
    text, wrong = crowd.wrong(number, apart_at_most=1e-3)
    assert set(wrong or ()) <= ({"course", "mirror"} if "friction" in text else {"course"}), (wrong, text)


@pytest.mark.parametrize("number", [2009, 2050, 2100, 2163])
def test_further_twins_of_a_deck(number):
    """On other threads, in other units and frames a run is the same; rates of 4340 steel have a unit (explanation/sanity)."""
    text = crowd.text_of(number)
    assert set(crowd.more_wrong(number)) <= ({"length and time"} if "steel_4340" in text else set()), text


def test_further_twins_can_differ(monkeypatch):
    """With one number of the material left as it is, another unit of mass changes bits."""
    text = crowd.text_of(2100)
    monkeypatch.setitem(crowd.POWERS, "Pa", (0, 0, 0))
    assert "u" in crowd.other_bits(text, (0, 0, 3)).split(", ")


def test_an_image_of_an_image_is_the_deck():
    for number in range(0, 336, 17):
        text = crowd.text_of(number)
        once, twice = (tomllib.loads(each) for each in (crowd.mirrored(text), crowd.mirrored(crowd.mirrored(text))))
        first = tomllib.loads(text)
        assert once != first
        assert twice["boundaries"] == first["boundaries"]
        for one, other in zip(first["body"], twice["body"], strict=True):
            assert one["z"] == pytest.approx(other["z"], abs=1e-15)


def test_sums_are_those_of_the_audit():
    simulation = Simulation(decks.loads(crowd.text_of(5)))
    totals, start = crowd.sums(simulation), simulation.audit.start
    assert totals["kinetic energy"] == pytest.approx(start.kinetic, rel=1e-12)
    assert totals["momentum"] == pytest.approx(start.momentum, rel=1e-12)
    for m, name in enumerate(simulation.table.names):
        assert totals[f"mass {name}"] == pytest.approx(start.mass[m], rel=1e-12)
    simulation.state.vof[0, 6, 6] += 0.01
    assert not np.isclose(crowd.sums(simulation)["mass rod"], start.mass[0], rtol=1e-9)
