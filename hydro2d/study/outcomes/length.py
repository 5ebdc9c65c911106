"""Whether a projectile loses a third of its length."""

from __future__ import annotations

from hydro2d.measure.regime import LEAST_KEPT_LENGTH
from hydro2d.study.outcomes.base import BY_DEPTH, Outcome, Verdict, lost

KEPT, USED_UP = "kept", "used up"


class Length(Outcome):
    """The length at the end of a run over that at its start."""

    name = "length"
    meaning = "whether it loses a third of its length"
    order = (KEPT, USED_UP)
    transitions = {USED_UP: "a third of the length lost"}
    terms = {KEPT: "at least two thirds of the projectile's length are left at the end", USED_UP: "less is left", **BY_DEPTH}
    of_rod = True

    @classmethod
    def judge(cls, record, depth):
        if verdict := lost(record):
            return verdict
        kept = record.value("rod_length_m") >= LEAST_KEPT_LENGTH * record.value("rod_initial_length_m")
        return Verdict(KEPT if kept else USED_UP)
