"""Analytic penetration models: one model per file, numbers in and numbers out, independent of the solver.

Every file has functions of plain SI numbers, for scripts and notebooks, and a ``MODEL`` that describes itself to the
command line; ``catalogue.MODELS`` lists them.
"""
