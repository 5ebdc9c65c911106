"""Figures of analytic models: the main output against the impact velocity, one colour for each regime."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hydro2d.analytic.models import VELOCITY, Case
from hydro2d.base.units import reader_unit

COLOURS = ("#1f4e79", "#b5651d", "#4f7942", "#8b3a62", "#5b6770", "#c9a227")


def _stretches(words: Sequence[str]) -> Iterator[tuple[int, int]]:
    """(first, one past last) of each sequence of equal words."""
    first = 0
    for n in range(1, len(words) + 1):
        if n == len(words) or words[n] != words[first]:
            yield first, n
            first = n


def _label(output, factor_name: str) -> str:
    unit = "" if output.unit in ("", "1") else f" [{factor_name}]"
    return f"{output.name.replace('_', ' ')}{unit}"


def draw(case: Case, rows: Sequence[dict]):
    """A matplotlib Figure of the model's main output; for a depth, the right axis shows depth over length."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    model = case.model
    main = next(entry for entry in model.outputs if entry.name == model.main)
    unit, scale = reader_unit(main.unit)
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    velocity = np.array([row[VELOCITY] for row in rows])
    _lines(axes, velocity, np.array([row[main.name] for row in rows], dtype=float) * scale, rows)
    axes.set_xlabel("impact velocity [m/s]")
    axes.set_ylabel(_label(main, unit))
    axes.set_xlim(velocity[0], velocity[-1])
    axes.grid(alpha=0.3)
    axes.set_title(model.title, fontsize=9, wrap=True)
    length = case.values.get("rod.length")
    if main.name == "depth" and length:
        right = axes.secondary_yaxis("right", functions=(lambda y: y / scale / length, lambda y: y * scale * length))
        right.set_ylabel("depth / length")
    return figure


def _lines(axes, velocity: np.ndarray, values: np.ndarray, rows: Sequence[dict]) -> None:
    words = [str(row.get("regime", "")) for row in rows]
    colours = {word: COLOURS[n % len(COLOURS)] for n, word in enumerate(dict.fromkeys(words))}
    seen = set()
    for first, last in _stretches(words):
        word = words[first]
        few = {"marker": "."} if last - first == 1 else {}
        axes.plot(velocity[first:last], values[first:last], color=colours[word], label=None if word in seen else word, **few)
        seen.add(word)
    if len(colours) > 1 or "" not in colours:
        axes.legend(fontsize=8)
