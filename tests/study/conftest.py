"""What the tests of reports share."""

from .browser import browser  # noqa: F401
