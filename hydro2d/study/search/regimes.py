"""The results of a search: transitions by regime and by depth, with experiments, the CTH study and analytic models."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

from hydro2d.analytic import model_transition, models
from hydro2d.analytic.catalogue import InputError
from hydro2d.analytic.model_text import columns
from hydro2d.analytic.model_transition import Bracket, Comparison, Prediction, extent
from hydro2d.base.version import __version__
from hydro2d.files.whole import write_json
from hydro2d.measure.outcome import AT_LEAST
from hydro2d.study.outcomes import perforation
from hydro2d.study.outcomes.base import FALL, LIMIT, Verdict
from hydro2d.study.outcomes.regime import Regime
from hydro2d.study.outcomes.registry import BY_NAME
from hydro2d.study.plan import velocities
from hydro2d.study.records import experiments, record
from hydro2d.study.records.record import Record
from hydro2d.study.records.study_directory import Interval, Study
from hydro2d.study.search import bisection, v50

if TYPE_CHECKING:
    import pandas

FILE = "transition.json"
DEPTHS = DEEPER, NOT_DEEPER = "deeper than the hydrodynamic limit", "no deeper than the limit"


def criteria(study: Study) -> Mapping[str, str]:
    """The definitions of the terms of a search."""
    if study.search is None:
        return Regime.terms
    kind = BY_NAME[study.search.of]
    if study.search.budget is None:
        return kind.terms
    terms = {name: words for name, words in kind.terms.items() if name not in (FALL, LIMIT, perforation.LIMIT)}
    if kind.is_ballistic:
        return v50.BALLISTIC_CRITERIA | terms | v50.CRITERIA | v50.MILITARY_CRITERION
    return terms | v50.CRITERIA


HEADS = ("velocity", "regime", "depth", "length", "radius", "core mass", "end")
#: results of the summary that the table of a search has
RESULTS = ("rod_length_m", "rod_initial_length_m", "rod_max_radius_m", "rod_initial_radius_m", "rod_core_mass_kg")


def judge(record: Record, of: str = Regime.name, depth: float | None = None) -> Verdict:
    """The outcome of a case that `of` names, None with the reason if it is not known; depth : threshold in m."""
    if record.done:
        return BY_NAME[of].judge(record, depth)
    status, reason = record.case.status, record.case.message.partition("\n")[0]
    return Verdict(None, f"{status}: {reason}" if reason else status)


def judged(records: Sequence[Record], search: Interval) -> pandas.DataFrame:
    """The runs of a combination in the order of the search, SI: ``regime`` is the outcome that the search asks for.

    The columns are those of transition.json, and ``depth_is``; ``regime`` is None with a ``reason`` where it is not known.
    """
    import pandas

    return pandas.DataFrame([{
        "case": each.case.name, "velocity_m_s": _speed(each), "status": each.case.status,
        **judge(each, search.of, search.depth)._asdict(), "depth_m": each.outcome.depth_m,
        "depth_is": each.outcome.depth_is, "perforated": each.perforated,
        **{name: each.case.summary[name] for name in RESULTS},
        "residual_velocity_m_s": each.outcome.residual_velocity_m_s, "rod_first_mass_kg": each.first.get("rod_mass_kg"),
        "stop_reason": each.case.summary.stop_reason,
    } for each in records], dtype=object).rename(columns={"word": "regime"})


def _speed(record: Record) -> float:
    return record.velocity if record.velocity is not None else velocities.speed(record.case.values[velocities.AXIS])


def _cells(run) -> tuple[str, ...]:
    """Velocity, regime, depth; length, radius and core mass relative to their initial values; and how the run ended."""
    end = str(run.stop_reason or "") + (f", {run.residual_velocity_m_s:.0f} m/s left" if run.residual_velocity_m_s else "")
    return (f"{run.velocity_m_s:g} m/s", run.regime or run.status, "" if run.depth_m is None else _depth(run),
            _share(run.rod_length_m, run.rod_initial_length_m), _share(run.rod_max_radius_m, run.rod_initial_radius_m),
            _share(run.rod_core_mass_kg, run.rod_first_mass_kg), run.reason or end)


def _share(value: float | None, first: float | None) -> str:
    return "" if value is None or not first else f"{value / first:.3f}"


def _depth(run) -> str:
    return f"{'at least ' * (run.depth_is == AT_LEAST)}{100 * run.depth_m:.2f} cm"


@dataclass(frozen=True)
class Transitions:
    """The results of the runs of one combination of the axes.

    values : labels of the axes except the velocity;  brackets : by regime, by depth, by the hydrodynamic limit
    settled : by name of a bracket of regimes, whether no further run could narrow it
    runs : by velocity, as `judged` has them
    notes : open questions with reasons, regimes out of order, runs that did not end at rest
    comparison : models, experiments, the CTH study and, last, these runs; None if there is nothing to compare, as a note says
    estimate : of a search with a budget, whose brackets are intervals of the ballistic limit and of v50
    """

    title: str
    values: dict[str, str]
    brackets: list[Bracket]
    settled: dict[str, bool]
    runs: pandas.DataFrame
    notes: list[str]
    comparison: Comparison | None
    estimate: v50.Estimate | None = None

    @property
    def known(self) -> list[Bracket]:
        """Brackets of experiments and of the CTH study."""
        return self.comparison.brackets[:-1] if self.comparison else []

    @property
    def predictions(self) -> list[Prediction]:
        """The predictions of the analytic models."""
        return self.comparison.predictions if self.comparison else []

    def lines(self) -> list[str]:
        """The results as lines of text."""
        lines = [self.title, *columns((each.name, extent(each), each.source) for each in self.brackets)]
        lines += [f"  {note}" for note in self.notes]
        lines += ["", *columns([HEADS, *map(_cells, self.runs.itertuples())])]
        if self.comparison is not None:
            heading, _, *rest = self.comparison.lines(inputs=False)
            lines += ["", f"  {heading}", *rest]
        return lines

    def data(self) -> dict:
        """For programs, SI."""
        return {
            "title": self.title,
            "values": self.values,
            "transitions": [{"name": each.name, "low_m_s": each.low, "high_m_s": each.high, "in_words": each.source,
                             "settled": self.settled.get(each.name)} for each in self.brackets],
            "estimate": self.estimate and self.estimate.data(),
            "notes": self.notes,
            "runs": self.runs.drop(columns="depth_is").to_dict("records"),
            "comparison": self.comparison and self.comparison.data(),
        }


def label(values: Mapping[str, str]) -> str:
    """A combination in words, by its axes without the velocity."""
    return ", ".join(f"{name} = {value}" for name, value in values.items() if name != velocities.AXIS)


def so_far(outcomes: Mapping[float, str], of: str = Regime.name) -> list[str]:
    """The transitions of regimes by velocity in m/s, in words."""
    kind = BY_NAME[of]
    return [
        f"{name} {extent(Bracket(name, *bisection.bracket(outcomes, regime, kind.order), ''))}"
        for regime, name in kind.transitions.items()
    ]


def of_study(study: Study, records: Sequence[Record] | None = None) -> list[Transitions]:
    """The transitions of every combination of the axes of a search. ``records`` : those of the cases, if already read."""
    groups: dict[str, list[Record]] = {}
    for each in records if records is not None else map(record.read, study.cases):
        groups.setdefault(label(each.case.values), []).append(each)
    return [_transitions(study, words or study.title, members) for words, members in groups.items()]


def _transitions(study: Study, title: str, members: Sequence[Record]) -> Transitions:
    kind = BY_NAME[study.search.of]
    in_turn = judged(members, study.search)
    runs = in_turn.sort_values("velocity_m_s", kind="stable")
    known = runs[runs["regime"].notna()]
    values = {name: value for name, value in members[0].case.values.items() if name != velocities.AXIS}
    by_name = {each.case.name: each for each in members}
    found = [by_name[name] for name in known["case"]]
    cut = [f"{_speed(each):g} m/s" for each in found if each.cut]
    moving = [f"runs that did not end at rest, whose regime is that at their end: {', '.join(cut)}"] if cut else []
    if study.search.budget is None:
        brackets, settled, notes = _by_bisection(study.search, runs, known, found)
        estimate = None
    else:
        estimate = v50.estimate(study.search, kind, in_turn)
        brackets, notes = estimate.brackets, estimate.notes
        settled = {each.name: estimate.spent for each in brackets}
    comparison, problem = _compared(found, brackets[0]) if kind.of_rod else (None, "")
    notes += [*moving, *([problem] if problem else [])]
    return Transitions(title, values, brackets, settled, runs, notes, comparison, estimate)


def _by_bisection(search: Interval, runs: pandas.DataFrame, known: pandas.DataFrame,
                  found: Sequence[Record]) -> tuple[list[Bracket], dict[str, bool], list[str]]:
    """Brackets, which of them are settled, and notes. ``known`` : the runs with an outcome;  found : their records."""
    kind = BY_NAME[search.of]
    outcomes = dict(zip(known["velocity_m_s"], known["regime"], strict=True))
    brackets, settled, notes = [], {}, []
    for regime, name in kind.transitions.items():
        bracket = Bracket(name, *bisection.bracket(outcomes, regime, kind.order), "")
        brackets.append(replace(bracket, source=_ends(bracket, outcomes)))
        settled[name], why = _settled(bracket, search, runs)
        notes += [f"{name}: {why}"] if why else []
    notes += _disordered(outcomes, kind.order)
    limit = v50.limit_of(known)[0] if kind.is_ballistic and len(known) else None
    if limit is not None:
        notes.insert(0, f"{perforation.LIMIT} = {limit.in_words}, {limit.origin}")
    if kind.of_rod:
        limit, disordered = _limit(known, found)
        brackets += [*_fall(known), *limit]
        notes += disordered
    return brackets, settled, notes


def _ends(bracket: Bracket, outcomes: Mapping[float, str]) -> str:
    """The regimes at both ends."""
    return ", ".join(f"{outcomes[end]} at {end:g} m/s" for end in (bracket.low, bracket.high) if end is not None)


def _settled(bracket: Bracket, interval: Interval, runs: pandas.DataFrame) -> tuple[bool, str]:
    """Whether no further run could narrow a bracket, and why it is wider than the tolerance if it is."""
    low, high, slowest, fastest = bracket.low, bracket.high, interval.speeds[0], interval.speeds[-1]
    if low is not None and high is not None and high - low <= interval.tolerance * (1.0 + velocities.SAME):
        return True, ""
    if high is None and low == fastest:
        return True, f"open, not reached at {fastest:g} m/s, the fast end of the interval"
    if low is None and high == slowest:
        return True, f"open, reached already at {slowest:g} m/s, the slow end of the interval"
    lost = [f"{run.velocity_m_s:g} m/s {run.reason}" for run in runs.itertuples()
            if run.regime is None and (low or 0.0) < run.velocity_m_s < (high or 2.0 * fastest)]
    return False, f"not narrowed to {interval.tolerance:g} m/s: " + ("; ".join(lost) or "not all runs were made")


def _fall(known: pandas.DataFrame) -> list[Bracket]:
    """The velocities between which the depth falls: from the deepest run to the next faster one."""
    deep = list(known[known["depth_m"].notna()].itertuples())
    if not deep:
        return []
    deepest = max(deep, key=lambda run: (run.depth_m, run.velocity_m_s))
    after = next((run for run in deep if run.velocity_m_s > deepest.velocity_m_s), None)
    depths = [_depth(run) for run in (deepest, after) if run]
    words = ", then ".join(depths) if after else f"{depths[0]} at the fastest run: no fall is seen"
    return [Bracket(FALL, deepest.velocity_m_s, after.velocity_m_s if after else None, words)]


def by_depth(depths: Mapping[float, float], limit: float) -> Mapping[float, str]:
    """Whether rods went deeper than the hydrodynamic limit, ``DEEPER`` or ``NOT_DEEPER``, by velocity.

    Slow rods, which stop before they reach it, are left out; so are all if none is deeper, since the
    depth does not show whether they were too slow or used up.
    """
    first = min((speed for speed, depth in depths.items() if depth > limit), default=math.inf)
    return {speed: DEEPER if depth > limit else NOT_DEEPER for speed, depth in depths.items() if speed >= first}


def _limit(known: pandas.DataFrame, found: Sequence[Record]) -> tuple[list[Bracket], list[str]]:
    """Velocities from which the depth is no longer above the hydrodynamic limit, if a run is deeper; and notes on order."""
    first = next((each for each in found if each.shot), None)
    if first is None:
        return [], []
    limit = model_transition.hydrodynamic_limit(first.setup.length, first.shot.rod, first.shot.target)
    outcomes = by_depth(known.set_index("velocity_m_s")["depth_m"].dropna().to_dict(), limit)
    if not outcomes:
        return [], []
    return ([Bracket(LIMIT, *bisection.bracket(outcomes, NOT_DEEPER, DEPTHS), f"{100 * limit:.2f} cm")],
            _disordered(outcomes, DEPTHS))


def _disordered(outcomes: Mapping[float, str], order: Sequence[str]) -> list[str]:
    """Notes on regimes out of order."""
    return [f"out of order: {outcomes[slow]} at {slow:g} m/s, {outcomes[fast]} at {fast:g} m/s; the slowest change is given"
            for slow, fast in bisection.disordered(outcomes, order)]


def _compared(found: Sequence[Record], bracket: Bracket) -> tuple[Comparison | None, str]:
    """Models, experiments and the CTH study for the rod and target of the first run, or why there is no comparison."""
    first = next((each for each in found if each.shot), None)
    if first is None:
        why = next((each.without_models for each in found if each.without_models), "there are no projectile and target")
        return None, f"nothing to compare with: {why if found else 'no run is done'}"
    shot = first.shot
    try:
        comparison = model_transition.compare(models.Request(rod=shot.rod, target=shot.target, geometry=shot.values), shot.nose)
    except InputError as error:
        return None, f"the analytic models: {error}"
    shots = experiments.of_materials(first.setup)
    other = shots and not any(experiments.same_geometry(each, first.setup) for each in shots)
    problem = f"the experiments' rods were {shots[0].length * 1e3:.4g} x {shots[0].diameter * 1e3:.4g} mm" if other else ""
    return replace(comparison, brackets=[*comparison.brackets, replace(bracket, name="hydro2d")]), problem


def write(study: Study, combinations: Sequence[Transitions]) -> None:
    """Writes transition.json. Raises OSError."""
    interval = study.search
    data = {
        "title": study.title, "version": __version__, "key": interval.key, "from_m_s": interval.speeds[0],
        "to_m_s": interval.speeds[-1], "tolerance_m_s": interval.tolerance, "of": interval.of,
        "depth_m": interval.depth, "budget": interval.budget and asdict(interval.budget), "criteria": criteria(study),
        "complete": all(all(each.settled.values()) for each in combinations),
        "combinations": [each.data() for each in combinations],
    }
    write_json(study.directory / FILE, data)


def lines(study: Study, combinations: Sequence[Transitions]) -> list[str]:
    """The transitions of a study in words, and the criteria."""
    text = [line for each in combinations for line in (*each.lines(), "")]
    return [*text, "criteria", *columns(criteria(study).items())]
