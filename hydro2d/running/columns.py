"""The columns of history.h5 and the keys of summary.json, with their meanings: every number that a run writes.

In a name, BODY, TARGET, STATION, DERIVED, SINK and TRANSFER stand for the names of each; a station is `tracer_NAME` or
`gauge_NAME`.
"""

from __future__ import annotations

from hydro2d.measure import measured
from hydro2d.measure.measured import PLACES
from hydro2d.measure.station_columns import PEAKS, QUANTITIES
from hydro2d.running import residual_velocity

#: amounts of a sink, and of a contact transfer
AMOUNTS = {"mass_kg": "mass", "momentum_N_s": "axial momentum", "energy_J": "energy"}

#: summary keys that call a projectile of any shape a rod, and the keys that replace them
OLD: dict[str, str] = {
    **{old: f"projectile.{new}" for old, new in measured.PROJECTILE.items()},
    **{old: f"bodies.{'TARGET' if old.startswith('target') else 'BODY'}.{new}"
       for old, new in measured.OF_EVERY_BODY.items()},
}

HISTORY: dict[str, str] = {
    "time": "time since the start",
    "cycle": "cycle number",
    "dt": "time step",
    **measured.QUANTITIES,
    "internal_energy_J": "internal energy of all bodies",
    "kinetic_energy_J": "kinetic energy of all nodes",
    "mass_change_BODY": "relative change of the mass of a body that no sink accounts for",
    "axial_momentum_change": "change of the axial momentum that no sink accounts for, over sqrt(2 m E) at the start",
    "total_energy_change": "relative change of the total energy that no sink accounts for",
    **{f"body_BODY_{key}": f"of each body: {meaning}" for key, meaning in measured.BODY.items()},
    **{f"STATION_{key}": f"of each tracer and gauge: {meaning}" for key, meaning in {**PLACES, **QUANTITIES}.items()},
    "DERIVED": "a quantity that `[derived]` of the deck defines",
    **{f"sink_SINK_{key}": f"{meaning} that a sink has taken since the start" for key, meaning in AMOUNTS.items()},
}

SUMMARY: dict[str, str] = {
    "deck": "name of the deck",
    "title": "title of the deck",
    "deck_sha256": "hash of the resolved deck, the same for the same case",
    "version": "version of hydro2d",
    "method": "version of the method: results of one version can be compared",
    "status": "done, interrupted or unphysical",
    "stop_reason": "why the run ended",
    "trustworthy": "whether the state at the end has no faults",
    "faults": "the faults of that state, in sentences",
    "notes": "what was beyond a bound and decides nothing, in sentences with the reason",
    "time_s": "time at the end",
    "cycles": "number of cycles",
    "wall_s": "wall-clock time of the run",
    "cycles_s": "of this, in cycles, without compilation",
    "compilation_s": "time in which this process compiled kernels or waited for another one that did; 0 if the cache had all",
    "outputs_s": "time for the history, dumps, restart files and progress reports",
    "set_up_s": "time from the deck to the first cycle, in which kernels are read from the cache",
    "ns_per_cell_cycle": "nanoseconds of the cycles per cell and cycle",
    "cells": "number of cells",
    **{key: meaning for key, meaning in measured.QUANTITIES.items() if key not in OLD},
    "projectile.body": "name of the projectile, which is also in `bodies`",
    **{f"projectile.{new}": measured.QUANTITIES[old] for old, new in measured.PROJECTILE.items()},
    **{f"projectile.{key}": meaning for key, meaning in residual_velocity.MEANINGS.items()},
    **{old: f"old name of {new}, which later versions will not write" for old, new in OLD.items()},
    **{f"crater.{key}": f"hole in the first target: {meaning}" for key, meaning in measured.CRATER.items()},
    **{f"targets.TARGET.{key}": f"of each target: {meaning}" for key, meaning in measured.PASSAGE.items()},
    **{f"targets.TARGET.{key}": f"of each target: {meaning}" for key, meaning in measured.WALL.items()},
    **{f"targets.TARGET.crater.{key}": f"of each target: {meaning}" for key, meaning in measured.CRATER.items()},
    **{f"targets.TARGET.debris.{key}": f"of the debris behind each target: {meaning}"
       for key, meaning in measured.DEBRIS.items()},
    **{f"targets.TARGET.ejecta.{key}": f"of what flies back from each target: {meaning}"
       for key, meaning in measured.EJECTA.items()},
    "derived.DERIVED": "a quantity that `[derived]` of the deck defines, at the end",
    **{f"bodies.BODY.{key}": f"of each body: {meaning}" for key, meaning in measured.BODY.items()},
    **{f"stations.STATION.{key}": f"of each tracer and gauge: {meaning}"
       for key, meaning in {**PLACES, **QUANTITIES, **PEAKS}.items()},
    "experiment.penetration_m": "penetration depth of the experiment in the deck",
    "experiment.qualifier": "measured, estimated or at least",
    "experiment.residual_velocity_m_s": "residual velocity of the experiment; 0 if the projectile did not perforate",
    "experiment.source": "source of the experiment",
    "conservation.mass.BODY": "relative change of the mass of a body that no sink accounts for",
    "conservation.off_course_cells.BODY": "cells between the centre of mass of a body and where its momentum has taken it",
    "conservation.axial_momentum": "change of the axial momentum that no sink accounts for, over sqrt(2 m E) at the start",
    "conservation.total_energy": "relative change of the total energy that no sink accounts for",
    "conservation.internal_energy_J": "internal energy of all bodies",
    "conservation.kinetic_energy_J": "kinetic energy of all nodes",
    "conservation.start_energy_J": "total energy at the start, including the kinetic energy of all bodies",
    **{f"conservation.sinks.SINK.{key}": f"{meaning} that a sink has taken" for key, meaning in AMOUNTS.items()},
    **{f"conservation.contact_transfers.TRANSFER.{key}": f"{meaning} that bodies in contact have transferred"
       for key, meaning in AMOUNTS.items() if key != "mass_kg"},
    "provenance": "commit, machine, packages, command and times",
}  # fmt: skip
