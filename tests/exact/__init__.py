"""Exact solutions, independent of the solver: they import nothing of hydro2d."""
