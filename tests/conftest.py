"""Fixtures for tests of several folders."""

import os
import signal
import sys
from types import SimpleNamespace

import pytest
from hypothesis import settings

from hydro2d import jit
from tests import fake
from tests.browser import browser  # noqa: F401

#: on a busy machine any example may take long
settings.register_profile("hydro2d", deadline=None)
settings.load_profile("hydro2d")


@pytest.fixture(autouse=True)
def no_terminal(monkeypatch):
    """pytest-xdist tells its workers that a terminal is 80 columns wide. There is none: output of commands is not broken."""
    monkeypatch.delenv("COLUMNS", raising=False)


@pytest.fixture(autouse=True)
def one_thread_for_a_worker():
    """Every worker of pytest-xdist computes on one thread: two teams of threads on the same cores wait for one another.

    A test that asks for more threads has them.
    """
    if "PYTEST_XDIST_WORKER" in os.environ:
        jit.set_threads(1)


@pytest.fixture(autouse=True, scope="session")
def interrupts_are_heard():
    """A script that starts the tests in the background makes them ignore SIGINT, which commands of theirs would do as well."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def simulation(monkeypatch):
    """The fake simulation in place of the real one; each test has its own class."""
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
