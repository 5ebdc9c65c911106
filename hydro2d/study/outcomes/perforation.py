"""Whether a projectile perforates its target: the ballistic limit."""

from __future__ import annotations

from hydro2d.study.outcomes.base import Outcome, Verdict, lost

STOPPED, PERFORATED = "stopped", "perforated"
LIMIT = "ballistic limit"


class Perforation(Outcome):
    """Whether the leading end comes out behind the last target."""

    name = "perforation"
    meaning = "whether it perforates the target (ballistic limit)"
    order = (STOPPED, PERFORATED)
    transitions = {PERFORATED: LIMIT}
    terms = {
        PERFORATED: "the leading end is at least the radius of the projectile beyond the rear face of the target",
        LIMIT: "between the fastest run that is stopped and the slowest that perforates",
    }
    is_ballistic = True

    @classmethod
    def judge(cls, record, depth):
        return Verdict(PERFORATED) if record.perforated else lost(record) or Verdict(STOPPED)
