"""The version of hydro2d."""

__version__ = "0.4.0.dev0"
