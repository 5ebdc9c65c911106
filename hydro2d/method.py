"""The version of the method, which says whether two results can stand in one table.

It is the day on which the numbers of a run last changed by more than round-off, and is kept with every result. A change of the
method raises it, and tests/solver/test_method.py fails until it does. Faster code and new features leave it alone.
"""

METHOD = "2026-11-28"
