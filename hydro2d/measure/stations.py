"""Points at which a run records the local state: tracers, which move with the material, and gauges, which are fixed or stay on
a surface."""

from __future__ import annotations

import numpy as np

from hydro2d.jit import Conductor
from hydro2d.measure import tracers
from hydro2d.measure.station_columns import NO_PEAKS, PEAKS, QUANTITIES, U, V
from hydro2d.measure.surfaces import Follower

#: group of a point that begins in no body, or is fixed
NO_GROUP = -1


class Stations:
    """The tracers and gauges of a deck.

    Parameters
    ----------
    sim : Simulation
    deck : its deck
    within : name of the body in which each tracer begins; None for one in void

    Attributes
    ----------
    names : of the columns and keys: "tracer_tip", "gauge_wall", and "gauge_line_1" on for the points of a line
    places : float64[n, 2], r and z in m, tracers first
    tracers : the places of the tracers, a view
    peaks : float64[n, len(PEAKS)], extreme values of each since the start
    """

    def __init__(self, sim, deck, within: list[str | None]):
        self._sim = sim
        followed = [(f"tracer_{entry.name}", (entry.r, entry.z)) for entry in deck.tracer]
        fixed = [(f"gauge_{name}", place) for entry in deck.gauge for name, place in entry.places()]
        self.names = [name for name, _ in (*followed, *fixed)]
        self.places = np.array([place for _, place in (*followed, *fixed)], dtype=float).reshape(-1, 2)
        self.tracers = self.places[: len(followed)]
        self._groups = np.full(len(self.names), NO_GROUP)
        self._groups[: len(followed)] = [NO_GROUP if name is None else sim.state.group[sim.table.names.index(name)]
                                             for name in within]
        self.peaks = np.tile(np.array(NO_PEAKS), (len(self.names), 1))
        on_surface = {f"gauge_{name}": entry for entry in deck.gauge if entry.surface is not None for name, _ in entry.places()}
        self._followers = {n: Follower(sim, on_surface[name], self.places[n]) for n, name in enumerate(self.names)
                           if name in on_surface}
        self._values = np.zeros((len(self.names), len(QUANTITIES)))
        if self.names:
            sim.engine.given.set(
                station_places=self.places, tracer_places=self.tracers, station_groups=self._groups, station_peaks=self.peaks,
                station_values=self._values, eos_model=sim.table.eos_model, memory=sim.table.memory, eos_par=sim.table.eos_par)
            sim.engine.watches.append(self.record)

    def _look(self, given: Conductor) -> None:
        given.run(tracers.sample_stations)
        if self._followers:
            given.do(self._take_velocities)
        given.run(tracers.keep_peaks_of_stations)

    def _take_velocities(self) -> None:
        for n, follower in self._followers.items():
            self._values[n, [U, V]] = follower.velocity()

    def _follow(self) -> None:
        for follower in self._followers.values():
            follower.follow()

    def record(self, given: Conductor) -> None:
        """After a cycle: tracers follow the velocity in their cell, bilinear, by the midpoint rule; gauges stay on
        their surfaces; peaks are kept.

        A tracer that begins in a body moves with that body's group, also where the two groups of a contact share its cell.
        """
        if len(self.tracers):
            given.run(tracers.move_tracers)
        if self._followers:
            given.do(self._follow)
        self._look(given)

    def measure(self) -> dict[str, dict[str, float | None]]:
        """By station, present values and extreme values since the start, SI; None while it is outside the mesh."""
        if not self.names:
            return {}
        self._look(self._sim.engine.given)
        keys = ("r_m", "z_m", *QUANTITIES, *PEAKS)
        rows = np.concatenate([self.places, self._values, self.peaks], axis=1)
        known = np.where(np.isfinite(rows), rows, None).tolist()
        return {name: dict(zip(keys, row, strict=True)) for name, row in zip(self.names, known, strict=True)}
