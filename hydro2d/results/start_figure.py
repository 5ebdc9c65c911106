"""The picture of a deck before a run: materials above the axis, the mesh below it, tracers and gauges in place."""

from __future__ import annotations

import math

import numpy as np

from hydro2d.output.vtk import Dump
from hydro2d.results import figures

#: smallest distance of distinguishable mesh lines, pixels, and pixels per inch
PIXELS, PER_INCH = 4.0, 160.0
#: largest number of stations whose names are written
NAMED = 20


def draw(dump: Dump, deck):
    """A figure of the initial state of a deck (deck.deck.Deck).

    If the mesh is too fine for the picture, only every second, third ... line is drawn, as the caption says. Without a mirror
    image the lines are drawn over the materials.
    """
    figure = figures.draw_sections([[(dump, deck.name, None)]], "material")
    axes = figure.axes[0]
    step = _draw_mesh(axes, dump, figure.get_size_inches() * PER_INCH)
    _draw_stations(axes, deck)
    said = "mesh" if step == 1 else f"one line of the mesh in {step}"
    axes.set_title(f"{figures.verbatim(deck.title or deck.name)}\n{said}" + _stations_in_words(deck), fontsize=9)
    return figure


def _draw_mesh(axes, dump: Dump, pixels: np.ndarray) -> int:
    """Draws lines of the mesh in a picture of a size in pixels. Returns the number of lines that each drawn one stands for."""
    from matplotlib.collections import LineCollection

    r, z = dump.r_edges * 1e3, dump.z_edges * 1e3
    scale = min(pixels[0] / (z[-1] - z[0]), pixels[1] / ((r[-1] - r[0]) * (2.0 if dump.mirrored else 1.0)))
    step = math.ceil(PIXELS / (scale * min(np.diff(r).min(), np.diff(z).min())))
    sign = -1.0 if dump.mirrored else 1.0
    across = [[(at, sign * r[0]), (at, sign * r[-1])] for at in z[::step]]
    along = [[(z[0], sign * at), (z[-1], sign * at)] for at in r[::step]]
    axes.add_collection(LineCollection(across + along, colors="black", linewidths=0.2, alpha=0.6))
    return step


def _draw_stations(axes, deck) -> None:
    """Draws tracers as dots and gauges as crosses, with their names if there are few."""
    kinds = [("o", "#c1121f", [(entry.name, (entry.r, entry.z)) for entry in deck.tracer]),
             ("x", "#005f99", [place for entry in deck.gauge for place in entry.places()])]
    few = sum(len(places) for *_, places in kinds) <= NAMED
    for marker, colour, places in kinds:
        for name, (r, z) in places:
            axes.plot(z * 1e3, r * 1e3, marker, color=colour, markersize=3.5, markeredgewidth=1.0)
            if few:
                axes.annotate(figures.verbatim(name), (z * 1e3, r * 1e3), (2, 3), textcoords="offset points", fontsize=6,
                              color=colour)


def _stations_in_words(deck) -> str:
    said = [words for words, given in ((", tracers (dots)", deck.tracer), (", gauges (crosses)", deck.gauge)) if given]
    return "".join(said)
