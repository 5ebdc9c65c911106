"""The results of ensembles: for each case the median and the spread of its members, and the frequency of each regime."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from hydro2d.measure.outcome import AT_LEAST
from hydro2d.study.ensemble import agreement
from hydro2d.study.ensemble.chance import Share, Spread, spread, wilson
from hydro2d.study.records.experiments import Measurement
from hydro2d.study.records.record import Record
from hydro2d.study.records.responses import DEPTH, LENGTH_RATIO, Choice, Response, raw, response
from hydro2d.study.records.study_directory import DONE, Study
from hydro2d.study.records.table import SPREAD, in_files
from hydro2d.study.run.monitor import lines

if TYPE_CHECKING:
    import pandas

FILE = "ensembles.csv"
#: columns of a run that are not those of its ensemble
OF_RUNS = ("ensemble", "member", "seed", "time_s", "cycles", "wall_s", "directory", "depth_error_m", "depth_error_percent",
           "depth_error_is", "residual_error_m_s", "unfinished", "mass_change_worst", "momentum_change", "energy_change",
           "ns_per_cell_cycle")


@dataclass(frozen=True)
class Ensemble:
    """The members of one case. ``measurement`` is that of the experiment, if there is one."""

    name: str
    members: tuple[Record, ...]
    measurement: Measurement | None = None

    @property
    def ended(self) -> tuple[Record, ...]:
        """The members whose results are final; if there are none, those cut off at the end time of the deck."""
        final = tuple(each for each in self.members if not each.unfinished)
        return final or tuple(each for each in self.members if each.cut)

    @property
    def cut(self) -> bool:
        """Whether its numbers are those at the end time of the deck, with the projectile still moving."""
        return any(each.cut for each in self.ended)

    def spread(self, name: str) -> Spread | None:
        """Median and 10 to 90 % of a number of the ended members, SI."""
        return spread([value for each in self.ended if (value := raw(each, name)) is not None])

    @cached_property
    def bound(self) -> float | None:
        """The smallest depth that is only a lower bound, because a member perforated or left the mesh, m."""
        depths = (each.outcome.depth_m for each in self.ended if each.outcome.depth_is == AT_LEAST)
        return min((depth for depth in depths if depth is not None), default=None)

    @cached_property
    def regimes(self) -> dict[str, Share]:
        """The share of each regime among the ended members, the most frequent first."""
        counts = Counter(str(regime) for each in self.ended if (regime := each.value("regime")))
        return {regime: wilson(number, counts.total()) for regime, number in counts.most_common()}

    @cached_property
    def outcome(self) -> tuple[str, Share] | None:
        """The outcome of the experiment, and the share of the members with it; None without an experiment."""
        pairs = [pair for each in self.members if (pair := agreement.pair(each, self.measurement))]
        return (pairs[0][1], wilson(sum(run == shot for run, shot in pairs), len(pairs))) if pairs else None


def grouped(records: Sequence[Record], measurements: Mapping[str, Measurement] | None = None) -> list[Ensemble]:
    """The ensembles of runs, in their order; a run outside ensembles is one by itself. ``measurements`` by case."""
    groups: dict[str, list[Record]] = {}
    for record in records:
        groups.setdefault(record.case.group, []).append(record)
    known = measurements or {}
    return [Ensemble(name, tuple(members), known.get(members[0].case.name)) for name, members in groups.items()]


def score(ensembles: Sequence[Ensemble]) -> agreement.Score | None:
    """The probability of the outcomes of the experiments; None if no ensemble has one."""
    return agreement.score([each.outcome[1] for each in ensembles if each.outcome])


def cases(study: Study, ensembles: Sequence[Ensemble], runs: pandas.DataFrame,
          choice: Choice | None = None) -> pandas.DataFrame:
    """One row for each ensemble: the values that its members share, then medians, ends of the spreads, shares of the regimes.

    runs : the table of the runs;  choice : drawn responses, whose columns are added
    """
    import pandas

    left_out = {*OF_RUNS, *(name for each in study.ensembles for name in each.by)}
    kept = [name for name in runs if not (name in left_out or name.startswith("sink_"))]
    shared = runs.loc[[each.members[0].case.name for each in ensembles], kept]
    names = [*SPREAD, *(y.name for y in choice.y if y.name != DEPTH and y.name not in in_files(SPREAD))] if choice else SPREAD
    regimes = sorted({regime for each in ensembles for regime in each.regimes})
    own = pandas.DataFrame([_row(each, names, regimes) for each in ensembles], shared.index, dtype=object)
    return shared.assign(**own)


def _row(each: Ensemble, names: Sequence[str], regimes: Sequence[str]) -> dict[str, object]:
    statuses = Counter(record.case.status for record in each.members)
    done = f"{statuses.pop(DONE, 0)} of {len(each.members)} done"
    row: dict[str, object] = {
        "case": each.name, "status": ", ".join([done, *(f"{number} {status}" for status, number in statuses.items())]),
        "message": "; ".join(dict.fromkeys(record.case.message for record in each.members if record.case.message)),
        "members": len(each.members), "ended": len(each.ended), "cut": each.cut, "regime": next(iter(each.regimes), None),
    }
    for name in names:
        (stem, unit), values = _stem(name), each.spread(name)
        row |= zip((name, f"{stem}_low{unit}", f"{stem}_high{unit}"), values[:3] if values else (None,) * 3, strict=True)
    depth = each.spread(DEPTH)
    row["depth_is"] = depth and ("at least" if each.bound is not None and depth.median >= each.bound else "computed")
    for regime in regimes:
        none = wilson(0, len(each.ended)) if each.ended else None
        row |= _share(regime.replace(" ", "_"), each.regimes.get(regime, none))
    of, share = each.outcome or (None, None)
    return row | {"experiment_outcome": of} | _share("as_experiment", share)


def _stem(column: str) -> tuple[str, str]:
    """A column without its unit, and the unit: depth_m is depth and _m."""
    unit = next((end for end in ("_m_s", "_kg", "_m", "_s", "_J", "_K", "_Pa") if column.endswith(end)), "")
    return column.removesuffix(unit), unit


def _share(name: str, share: Share | None) -> dict[str, object]:
    return {f"{name}_fraction": share and share.fraction, f"{name}_fraction_low": share and share.low,
            f"{name}_fraction_high": share and share.high}


def table(ensembles: Sequence[Ensemble], drawn: Sequence[Response] = ()) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Heads and rows of text, one row for each ensemble; columns without an entry are left out.

    drawn : further numbers, with medians and spreads
    """
    others = [y for y in drawn if y.name not in (DEPTH, LENGTH_RATIO)]
    shown = [*map(response, (DEPTH, LENGTH_RATIO)), *others]
    heads = ("case", "ended", *(f"{y.title}: median, 10 to 90 %" for y in shown), "regimes, 90 % interval", "as the experiment")
    rows = [_cells(each, shown) for each in ensembles]
    used = [n for n in range(len(heads)) if n < 2 or any(cells[n] for cells in rows)]
    return tuple(heads[n] for n in used), [tuple(cells[n] for n in used) for cells in rows]


def _cells(each: Ensemble, shown: Sequence[Response]) -> tuple[str, ...]:
    regimes = ", ".join(f"{regime} {share.words}" for regime, share in each.regimes.items())
    outcome = f"{each.outcome[1].words}: {each.outcome[0]}" if each.outcome else ""
    others = Counter(record.case.status for record in each.members if not record.done)
    ended = [f"{len(each.ended)} of {len(each.members)}{', still moving' * each.cut}"]
    ended += [f"{number} {status}" for status, number in others.items()]
    return (each.name, ", ".join(ended), *(_in_words(each, y) for y in shown), regimes, outcome)


def _in_words(each: Ensemble, y: Response) -> str:
    values = each.spread(y.name)
    if values is None:
        return ""
    at_least = "at least " * (y.name == DEPTH and each.bound is not None and values.median >= each.bound)
    low, median, high = (f"{part * y.factor:.4g}" for part in (values.low, values.median, values.high))
    return f"{at_least}{median}, {low} to {high}"


def report(ensembles: Sequence[Ensemble], drawn: Sequence[Response] = ()) -> list[str]:
    """The results as lines of text; ``drawn`` as for `table`."""
    heads, rows = table(ensembles, drawn)
    scored = score(ensembles)
    return lines(rows, heads) + (["", f"experiments: {scored.words}"] if scored else [])
