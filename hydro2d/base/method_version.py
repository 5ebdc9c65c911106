"""The version of the method, which says whether two results can be compared in one table.

It is the day on which the numbers of a run last changed by more than round-off, with a number from the second change of a day
on, and is kept with every result. A change of the method must update it: tests/solver/test_method.py fails until it does.
Faster code and new features leave it alone.
"""

#: the present version of the method
METHOD = "2026-11-29.4"
