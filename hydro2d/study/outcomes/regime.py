"""The regime of a projectile: rigid, deforming or eroding."""

from __future__ import annotations

from hydro2d.measure.regime import DEFORMING, ERODING, GROWING, RULE
from hydro2d.study.outcomes.base import BY_DEPTH, Outcome, Verdict, lost


class Regime(Outcome):
    """The regime at the end of a run."""

    name = "regime"
    meaning = "the regime of the projectile"
    order = GROWING
    transitions = {DEFORMING: "rigid to deforming", ERODING: "to eroding"}
    terms = RULE | BY_DEPTH
    of_rod = True

    @classmethod
    def judge(cls, record, depth):
        return lost(record) or Verdict(record.case.summary.regime)
