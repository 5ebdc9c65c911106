"""The version of hydro2d."""

__version__ = "0.3.0"
