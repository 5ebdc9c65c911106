"""Analytic penetration models: one model per file, numbers in and numbers out, independent of the solver.

Each file has functions of plain SI numbers, for scripts and notebooks, and a ``MODEL`` that describes it to the command line;
``catalogue.MODELS`` lists them.
"""
