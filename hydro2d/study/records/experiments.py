"""The measurements for the setups of a study, and the errors of runs.

A measurement belongs to a rod, a target and an impact velocity. It comes from the catalogue of shots or from a deck. A deck
with `experiment.velocity` has no experiment at other velocities (`hydro2d.deck.deck`); for one without, see ``unplaced``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isclose

from hydro2d.analytic.model_transition import Shot
from hydro2d.analytic.model_transition import experiments as catalogue
from hydro2d.measure.outcome import AT_LEAST, Outcome, depth_error
from hydro2d.study.records.record import Record, Setup

#: largest relative differences of geometry, velocity and depth that count as equal
SAME_GEOMETRY, SAME_VELOCITY, SAME_DEPTH = 0.01, 0.005, 1e-3


@dataclass(frozen=True)
class Measurement:
    """One experiment: impact velocity in m/s, depth in m, "measured", "estimated" or "at least", and its source."""

    velocity: float
    depth: float
    qualifier: str
    source: str

    def error(self, of: Outcome) -> tuple[float | None, str]:
        """The error of a run's depth and its kind, see `outcome.depth_error`."""
        return depth_error(of.depth_m or 0.0, of.depth_is == AT_LEAST, self.depth, self.qualifier)


def of_materials(setup: Setup) -> list[Shot]:
    """The catalogue's shots of a rod's and a target's material and of its nose."""
    return [shot for shot in catalogue() if (shot.rod, shot.target, shot.nose) == setup[:3]]


def same_geometry(shot: Shot, setup: Setup) -> bool:
    """Whether a shot's rod has the size of a setup's."""
    pairs = ((shot.diameter, setup.diameter), (shot.length, setup.length))
    return all(isclose(one, other, rel_tol=SAME_GEOMETRY) for one, other in pairs)


def measured(setup: Setup, records: Sequence[Record]) -> list[Measurement]:
    """The experiments of a setup by velocity: the shots of the catalogue, and further ones from the decks of its runs.

    An experiment without a velocity is assigned to the velocity of the run; see ``unplaced``.
    """
    measurements = [
        Measurement(shot.velocity, shot.depth, shot.depth_is, f"shot {shot.number} of the CTH nose-shape study")
        for shot in of_materials(setup)
        if same_geometry(shot, setup)
    ]
    for record in records:
        data = record.experiment
        if data and not any(same_depth(record, entry) for entry in measurements):
            velocity = data.get("velocity") or record.velocity
            measurements.append(Measurement(velocity, data["penetration"], data.get("qualifier", "measured"), data["source"]))
    return sorted(measurements, key=lambda entry: entry.velocity)


def same_depth(record: Record, measurement: Measurement) -> bool:
    """Whether a measurement is the one in the deck of a run."""
    return isclose(record.experiment["penetration"], measurement.depth, rel_tol=SAME_DEPTH)


def unplaced(records: Sequence[Record]) -> dict[tuple, set[float]]:
    """Experiments, by source and depth, in decks with several impact velocities that do not say at which they were made."""
    users: dict[tuple, set[float]] = {}
    for record in records:
        data = record.experiment
        if data and record.velocity is not None and not data.get("velocity"):
            users.setdefault((data["source"], data["penetration"]), set()).add(record.velocity)
    return {key: velocities for key, velocities in users.items() if len(velocities) > 1}


def belonging(record: Record, known: Sequence[Measurement]) -> Measurement | None:
    """The measurement at the velocity of a run."""
    if record.velocity is None:
        return None
    near = [entry for entry in known if isclose(entry.velocity, record.velocity, rel_tol=SAME_VELOCITY)]
    return min(near, key=lambda entry: abs(entry.velocity - record.velocity), default=None)
