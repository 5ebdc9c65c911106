"""Whether a projectile reaches a depth."""

from __future__ import annotations

from hydro2d.measure.outcome import AT_LEAST
from hydro2d.study.outcomes.base import Outcome, Verdict

SHALLOW, DEEP = "shallower", "deeper"


class Deeper(Outcome):
    """Fast shots reach `depth` of the study file, slow ones do not."""

    name = "deeper"
    meaning = "whether fast shots go deeper than `depth`"
    order = (SHALLOW, DEEP)
    transitions = {DEEP: "depth reached"}
    terms = {DEEP: "the largest depth of the run is at least `depth` of the study", SHALLOW: "it is less"}
    has_depth = True

    @classmethod
    def judge(cls, record, depth):
        reached = record.outcome.depth_m
        if reached is None:
            return Verdict(None, "it has no depth")
        if reached < depth and record.outcome.depth_is == AT_LEAST:
            return Verdict(None, f"the projectile left the target or the mesh before a depth of {100 * depth:g} cm")
        return Verdict(DEEP if reached >= depth else SHALLOW)


class Shallower(Deeper):
    """Slow shots reach `depth`, fast ones no longer do."""

    name = "shallower"
    meaning = "whether fast shots go less deep than `depth`"
    order = (DEEP, SHALLOW)
    transitions = {SHALLOW: "depth no longer reached"}
