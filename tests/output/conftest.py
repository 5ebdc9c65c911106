"""Fixtures for the tests of output."""

import pytest

from tests import fake


@pytest.fixture
def moved():
    """A simulation after 30 cycles."""
    sim = fake.Simulation(fake.FakeDeck())
    for _ in range(30):
        sim.step()
    return sim
