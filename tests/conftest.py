"""Every worker of pytest-xdist computes on one thread: two teams of threads on the same cores wait for one another."""

import os

import pytest

from hydro2d import jit


@pytest.fixture(autouse=True)
def one_thread_for_a_worker():
    """A test that asks for more threads has them."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        jit.set_threads(1)
