"""What several of these tests need."""

import sys
from types import SimpleNamespace

import pytest

from tests.study.browser import browser  # noqa: F401
from tests.unit import fake


@pytest.fixture
def simulation(monkeypatch):
    """The fake simulation in the place of the real one; the class is the test's own."""
    own = type("Simulation", (fake.Simulation,), {})
    module = SimpleNamespace(Simulation=own)
    monkeypatch.setitem(sys.modules, "hydro2d.solver.simulation", module)
    return own


@pytest.fixture
def finished(simulation, tmp_path):
    """The directory of a fake run that has ended."""
    from hydro2d.running.run import run

    run(fake.FakeDeck(), tmp_path / "shot", quiet=True)
    return tmp_path / "shot"
