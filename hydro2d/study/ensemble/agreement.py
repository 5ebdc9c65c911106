"""Whether a projectile ended as in the experiment: by words that apply to both a run and an experiment."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from hydro2d.analytic.model_transition import hydrodynamic_limit
from hydro2d.study.ensemble.chance import Share, probability
from hydro2d.study.outcomes.perforation import PERFORATED, STOPPED
from hydro2d.study.records.experiments import Measurement
from hydro2d.study.records.record import Record
from hydro2d.study.search.regimes import DEEPER, NOT_DEEPER


def _limit(record: Record) -> float | None:
    """Depth that a rod that is used up at a constant rate reaches, L sqrt(rho_p / rho_t), m; None if it has no meaning."""
    shot, setup = record.shot, record.setup
    return hydrodynamic_limit(setup.length, shot.rod, shot.target) if shot and setup and setup.is_rod else None


def pair(record: Record, measurement: Measurement | None) -> tuple[str, str] | None:
    """The outcome of a run and of its experiment; None if one of them is not known.

    With a measured residual velocity: perforated or stopped. With a depth: deeper than the hydrodynamic limit or not.
    """
    if record.unfinished:
        return None
    if record.measured_residual is not None:
        return PERFORATED if record.perforated else STOPPED, PERFORATED if record.measured_residual > 0.0 else STOPPED
    limit = _limit(record)
    if limit is None or measurement is None or record.outcome.depth_m is None:
        return None
    run, shot = (DEEPER if depth > limit else NOT_DEEPER for depth in (record.outcome.depth_m, measurement.depth))
    return run, shot


class Score(NamedTuple):
    """The probability of the experiments' outcomes by the members of each shot.

    shots : with an experiment and ended members;  agreeing, members : of all of them
    most : shots of which most members agree;  probability : of the experiment's outcome, geometric mean over the shots
    """

    shots: int
    agreeing: int
    members: int
    most: int
    probability: float

    @property
    def words(self) -> str:
        """The score in one line."""
        return (f"{self.agreeing} of {self.members} members end as the experiment, most of them in {self.most} of {self.shots} "
                f"shots; an outcome has the probability {self.probability:.2f} (geometric mean of the shots)")


def score(shares: Sequence[Share]) -> Score | None:
    """The score of shots from the share of members that end as in the experiment, for each; None without shots.

    The probability of an outcome is (k + 1/2) / (n + 1) with k of n members. Its logarithm is a proper score: on average no
    other number than the true probability gives a better one (Gneiting and Raftery, J. Am. Stat. Assoc. 102 (2007) 359).
    """
    if not shares:
        return None
    logs = [math.log(probability(each.successes, each.trials)) for each in shares]
    return Score(len(shares), sum(each.successes for each in shares), sum(each.trials for each in shares),
                 sum(2 * each.successes > each.trials for each in shares), math.exp(sum(logs) / len(logs)))
