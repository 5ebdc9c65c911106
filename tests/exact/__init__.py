"""Exact solutions against printed values, and against the equations that they solve."""
