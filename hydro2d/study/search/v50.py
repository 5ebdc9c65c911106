"""The result of a search with a budget: ballistic limit, v50 and width of an outcome that is partly chance, uncertainties."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.analytic.model_transition import Bracket
from hydro2d.files.whole import plain
from hydro2d.study.outcomes.base import Outcome
from hydro2d.study.outcomes.perforation import LIMIT
from hydro2d.study.plan.velocities import Velocities
from hydro2d.study.records.study_directory import DONE, Interval
from hydro2d.study.search import ballistic, logit, sequence

if TYPE_CHECKING:
    import pandas

#: of MIL-STD-662F: shots with each outcome, and the largest difference of their velocities, m/s: 60, 90 and 125 ft/s. They
#: are from memory, not checked against the text of the standard, which was not at hand
MILITARY = ((5, 38.0), (3, 27.0), (2, 18.0))
CRITERIA = {
    "v50": "the velocity at which both outcomes are equally frequent, by logistic regression with Firth's correction",
    "width": "from the velocity with 10 % of the outcome of fast shots to that with 90 %",
    "90 % interval": "by the profile of the penalised likelihood; it is of chance on this mesh, not of the mesh or the models",
}
#: of a search for a ballistic limit, beside CRITERIA
BALLISTIC_CRITERIA = {
    LIMIT: "from impact and residual velocities by Lambert-Jonas, every shot with a limit of its own; the 90 % interval is "
    "that of the posterior distribution, of chance on this mesh alone",
}
MILITARY_CRITERION = {
    "V50 of MIL-STD-662F": "mean velocity of the fastest stopped shots and as many of the slowest perforating ones: "
    + ", or ".join(f"{count} of each within {spread:g} m/s" for count, spread in MILITARY)
    + "; the spreads are not checked against the text of the standard"
}


#: name of the bracket of v50 beside that of a ballistic limit
V50 = "v50"
#: entries of transition.json about a ballistic limit
OF_LIMIT = {
    "ballistic_limit_m_s": "limit_velocity", "ballistic_limit_low_m_s": "low", "ballistic_limit_high_m_s": "high",
    "limit_scatter_m_s": "scatter", "lambert_jonas_a": "a", "lambert_jonas_p": "p", "residual_velocities": "perforated",
}


@dataclass(frozen=True)
class Estimate:
    """Result of the shots of one combination of the axes for one transition.

    name : of the transition;  outcomes : of slow and of fast shots;  shots : in the order of the search, as
        `regimes.judged` has them
    budget : number of runs allowed;  spent : whether no further run is to be made
    fit : None if the shots do not determine it
    limit, no_limit : ballistic limit from residual velocities, or None and the reason; None and "" for other outcomes
    military : V50 of MIL-STD-662F in m/s, with the number of shots; None if no shots qualify; for a ballistic limit only
    """

    name: str
    outcomes: tuple[str, str]
    shots: pandas.DataFrame
    budget: int
    spent: bool
    fit: logit.Fit | None
    ballistic: bool
    limit: ballistic.Limit | None
    no_limit: str
    military: tuple[float, int] | None

    @property
    def brackets(self) -> list[Bracket]:
        """The intervals of the ballistic limit, if it is known, and of v50."""
        low, high = (self.fit.v50_low, self.fit.v50_high) if self.fit else (None, None)
        rounded = (None if end is None else round(end, 1) for end in (low, high))
        words = f"90 % interval of v50 = {self.fit.v50:.1f} m/s" if self.fit else "v50 is not known"
        if self.limit is None:
            return [Bracket(self.name, *rounded, words)]
        ends, said = (round(self.limit.low, 1), round(self.limit.high, 1)), f"{self.limit.limit_velocity:.1f} m/s"
        return [Bracket(self.name, *ends, f"90 % interval of {said}, from residual velocities"), Bracket(V50, *rounded, words)]

    @property
    def known(self) -> pandas.DataFrame:
        """The shots that have an outcome."""
        return self.shots[self.shots["regime"].notna()]

    @property
    def done(self) -> int:
        """The number of shots that are done."""
        return int((self.shots["status"] == DONE).sum())

    @property
    def notes(self) -> list[str]:
        """v50, its interval, the width, and the runs made of the budget, in words."""
        known, done, (slow, fast) = self.known, self.done, self.outcomes
        number = int((known["regime"] == fast).sum())
        notes = [*self._in_words(), f"bought with {done} of {self.budget} runs: {number} {fast}, {len(known) - number} {slow}"
                 + (f", {done - len(known)} without an outcome" if done > len(known) else "")]
        if self.ballistic:
            notes.append("V50 of MIL-STD-662F: " + (f"{self.military[0]:.1f} m/s from {self.military[1]} shots" if self.military
                         else "none, since no shots lie as close together as it requires"))
        return notes if self.spent else [*notes, "the budget is not spent; --resume continues"]

    @property
    def in_short(self) -> str:
        """The ballistic limit or v50 and its interval, or why they are not known."""
        return self._in_words()[0]

    def _in_words(self) -> list[str]:
        if self.limit is not None:
            return [f"{self.name} = {self.limit.in_words}", self.limit.origin, *self._of_outcomes()]
        no_limit = [f"no {self.name} from residual velocities: {self.no_limit}"] if self.no_limit else []
        return [*self._of_outcomes(), *no_limit]

    def _of_outcomes(self) -> list[str]:
        """v50 and the width in words, or why they are not known."""
        if self.fit is None:
            return [self._unknown()]
        fit = self.fit
        width = f"width, 10 to 90 %: {fit.width:.3g} m/s, {_range(fit.width_low or None, fit.width_high, '.3g')}"
        sudden = [] if fit.overlap else ["the outcomes do not overlap: a sudden change fits the shots as well as a gradual one"]
        return [f"v50 = {fit.v50:.1f} m/s, {_range(fit.v50_low, fit.v50_high, '.1f')}", width, *sudden]

    def _unknown(self) -> str:
        """Why there is no estimate."""
        seen, speeds = set(self.known["regime"]), self.known["velocity_m_s"]
        if not seen:
            return "v50 is not known: no run has an outcome"
        if len(seen) == 1:
            side = f"above {speeds.max():g}" if seen == {self.outcomes[0]} else f"below {speeds.min():g}"
            return f"v50 is not known: {len(speeds)} of {len(speeds)} shots {seen.pop()}; it lies {side} m/s, or chance hid it"
        return f"v50 is not known: shots that are {self.outcomes[1]} were no faster than those that are {self.outcomes[0]}"

    def data(self) -> dict:
        """For programs, SI."""
        names = ("v50", "v50_low", "v50_high", "width", "width_low", "width_high")
        numbers = {f"{name}_m_s": getattr(self.fit, name) if self.fit else None for name in names}
        limit = {name: self.limit and getattr(self.limit, attribute) for name, attribute in OF_LIMIT.items()}
        return plain({
            **(limit if self.ballistic else {}),
            "outcome": self.outcomes[1], "level": logit.LEVEL, **numbers, "overlap": self.fit and self.fit.overlap,
            "runs": self.done, "budget": self.budget,
            "mil_std_662f_m_s": self.military and self.military[0], "mil_std_662f_shots": self.military and self.military[1],
        })


def _range(low: float | None, high: float | None, form: str) -> str:
    """A 90 % interval in words."""
    if low is None or high is None:
        known = [f"{word} {end:{form}} m/s" for word, end in (("at least", low), ("at most", high)) if end is not None]
        return f"90 % interval {known[0]}" if known else "90 % interval open at both ends"
    return f"90 % interval {low:{form}} to {high:{form}} m/s"


def estimate(search: Interval | Velocities, kind: type[Outcome], shots: pandas.DataFrame) -> Estimate:
    """v50 and width from the runs of one combination, in the order of the search; kind : of outcome."""
    (slow, fast), known = kind.order, shots[shots["regime"].notna()]
    outcomes = [None if each is None else each == fast for each in shots["regime"]]
    speeds, successes = known["velocity_m_s"], known["regime"] == fast
    limit, no_limit = limit_of(known) if kind.is_ballistic and len(known) else (None, "")
    return Estimate(
        name=kind.transitions[fast], outcomes=(slow, fast), shots=shots, budget=search.budget.runs,
        spent=bool((shots["status"] == DONE).all())
        and (len(shots) >= search.budget.runs or sequence.alike(outcomes, search.budget.round)),
        fit=logit.fit_transition(speeds, successes) if len(known) else None, ballistic=kind.is_ballistic,
        limit=limit, no_limit=no_limit, military=military(speeds, successes) if kind.is_ballistic else None,
    )


def limit_of(shots: pandas.DataFrame) -> tuple[ballistic.Limit | None, str]:
    """The ballistic limit from the residual velocities of shots with an outcome, or None and the reason."""
    left = ballistic.residuals(shots)
    return ballistic.of_shots(shots.loc[left.index, "velocity_m_s"].astype(float), left)


def military(speeds: Sequence[float], perforated: Sequence[bool]) -> tuple[float, int] | None:
    """V50 by MIL-STD-662F in m/s and the number of shots in it; None if no shots lie close enough together.

    It is the mean of the highest velocities that were stopped and of as many of the lowest that perforated, for the largest
    number of shots whose velocities differ by no more than MILITARY allows.
    """
    v, y = np.asarray(speeds, float), np.asarray(perforated, bool)
    stopped, through = np.sort(v[~y])[::-1], np.sort(v[y])
    for count, spread in MILITARY:
        group = np.concatenate([stopped[:count], through[:count]])
        if len(group) == 2 * count and np.ptp(group) <= spread:
            return float(group.mean()), 2 * count
    return None
