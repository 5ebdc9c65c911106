"""Whether a projectile erodes."""

from __future__ import annotations

from hydro2d.measure.regime import ERODING, RULE
from hydro2d.study.outcomes.base import BY_DEPTH, Outcome, Verdict, lost

HOLDS = "not eroding"


class Erosion(Outcome):
    """Whether the regime at the end of a run is eroding."""

    name = "erosion"
    meaning = "whether it erodes"
    order = (HOLDS, ERODING)
    transitions = {ERODING: "to eroding"}
    terms = {ERODING: RULE[ERODING], HOLDS: "less has, whether the projectile is rigid or deforming", **BY_DEPTH}
    of_rod = True

    @classmethod
    def judge(cls, record, depth):
        return lost(record) or Verdict(ERODING if record.case.summary.regime == ERODING else HOLDS)
