"""Analytic penetration models: one model a file, numbers in, numbers out, nothing of the solver.

Every file has functions of plain SI numbers, for scripts and notebooks, and a ``MODEL`` that describes itself to the
command line; ``catalogue.MODELS`` lists them.
"""
