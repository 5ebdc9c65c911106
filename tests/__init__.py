"""Tests of hydro2d."""
