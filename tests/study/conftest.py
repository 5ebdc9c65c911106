"""What several of these tests need."""

from tests.unit.conftest import simulation  # noqa: F401

from .browser import browser  # noqa: F401
