"""What several of these tests need."""

from tests.study.browser import browser  # noqa: F401
from tests.unit.conftest import finished, simulation  # noqa: F401
