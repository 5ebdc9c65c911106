"""Equations of state, one at a time."""
