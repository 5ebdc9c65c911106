"""A reason to doubt a run, or a note: something out of its bounds on which no result of the run hangs."""

from __future__ import annotations

from typing import NamedTuple


class Doubt(NamedTuple):
    """Something out of its bounds.

    what : names it, for the first of its kind to be kept;  sentence : with the place and the bound
    harmless : why nothing hangs on it, which makes it a note; empty for a doubt
    """

    what: str
    sentence: str
    harmless: str = ""
