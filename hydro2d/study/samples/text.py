"""The results of a sample as lines of text."""

from __future__ import annotations

from collections.abc import Iterator

from hydro2d.study.plan.definition import StudyError
from hydro2d.study.records.responses import readers, title
from hydro2d.study.run.monitor import lines
from hydro2d.study.samples.results import OUTCOMES, Samples

SPREADS = ("result", "median", "10 to 90 %", "runs")
FRACTIONS = ("outcome", "fraction", "90 % interval", "runs")
INDICES = ("input", "alone", "90 % interval", "with interactions", "90 % interval")

Table = tuple[tuple[str, ...], list[tuple[str, ...]]]


def spreads(samples: Samples) -> Table:
    """Heads and rows: the median and the spread of each usual result, in the reader's unit."""
    rows = []
    for name in samples.usual:
        unit, factor = readers(name)
        spread = samples.spread(name)
        low, median, high = (f"{part * factor:.4g}" for part in (spread.low, spread.median, spread.high))
        rows.append((title(name), f"{median} {unit}".rstrip(), f"{low} to {high} {unit}".rstrip(), str(spread.count)))
    return SPREADS, rows


def fractions(samples: Samples) -> Table:
    """Heads and rows: the fraction of each outcome; with bounds where runs have no outcome."""
    rows, heads = [], FRACTIONS
    for name in OUTCOMES:
        if name not in samples.table or not samples.table.loc[samples.ended, name].notna().any():
            continue
        for each in samples.fractions(name).values():
            share = each.share
            outcome = each.outcome if name == "regime" else f"{name}: {each.outcome}"
            cells = (outcome, f"{100 * share.fraction:.1f} %", f"{100 * share.low:.0f} to {100 * share.high:.0f} %",
                     f"{share.successes} of {share.trials}")
            if len(samples) > share.trials:
                heads = (*FRACTIONS, "bounds with the others")
                cells += (f"{100 * each.low:.1f} to {100 * each.high:.1f} %",)
            rows.append(cells)
    return heads, [(*cells, "")[: len(heads)] for cells in rows]


def indices(samples: Samples, result: str) -> tuple[Table, str]:
    """Heads and rows: the Sobol indices of a result; and the error of its surrogate with a warning where it is large.

    Raises StudyError if there are none.
    """
    shares = samples.indices(result)
    rows = [(each.input, f"{each.first:z.2f}", f"{each.first_low:z.2f} to {each.first_high:z.2f}", f"{each.total:z.2f}",
             f"{each.total_low:z.2f} to {each.total_high:z.2f}") for each in shares.inputs]
    words = f"{title(result)}: shares of its variance, by a surrogate: {shares.surrogate.words} (SI)"
    notes = shares.grouped, f"Warning: {shares.doubt}" if shares.doubt else ""
    return (INDICES, rows), ". ".join(filter(None, (words, *notes)))


def report(samples: Samples, shares: bool = True) -> Iterator[str]:
    """The results as lines of text; without ``shares`` no Sobol indices, which take seconds for each result."""
    yield f"{samples.title}: {len(samples)} runs, {int(samples.ended.sum())} done"
    yield from (*samples.missed, *samples.doubts)
    for heads, rows in (spreads(samples), fractions(samples)):
        if rows:
            yield ""
            yield from lines(rows, heads)
    for name in samples.usual if shares else ():
        yield ""
        try:
            (heads, rows), words = indices(samples, name)
        except StudyError as error:
            yield str(error)
            continue
        yield words
        yield from lines(rows, heads)
