"""THE list of what a run writes as numbers: the columns of history.h5 and the keys of summary.json, with their meanings.

In a name BODY, TARGET, STATION, SINK and TRANSFER stand for the name of each; a station is `tracer_NAME` or `gauge_NAME`.
"""

from __future__ import annotations

from hydro2d.solver import bodies, crater, penetrator, tracers

PLACES = {"r_m": "radial position", "z_m": "axial position"}

#: amounts of a sink, and of a contact transfer
AMOUNTS = {"mass_kg": "mass", "momentum_N_s": "axial momentum", "energy_J": "energy"}

HISTORY: dict[str, str] = {
    "time": "time since the start",
    "cycle": "number of the cycle",
    "dt": "time step",
    **penetrator.QUANTITIES,
    "internal_energy_J": "internal energy of all bodies",
    "kinetic_energy_J": "kinetic energy of all vertices",
    "mass_change_BODY": "relative change of the mass of a body that no sink explains",
    "axial_momentum_change": "change of the axial momentum that no sink explains, relative to what there was of it",
    "total_energy_change": "relative change of the total energy that no sink explains",
    **{f"body_BODY_{key}": f"of each body: {meaning}" for key, meaning in bodies.QUANTITIES.items()},
    **{f"STATION_{key}": f"of each tracer and gauge: {meaning}" for key, meaning in {**PLACES, **tracers.QUANTITIES}.items()},
    **{f"sink_SINK_{key}": f"{meaning} that a sink has taken since the start" for key, meaning in AMOUNTS.items()},
}

SUMMARY: dict[str, str] = {
    "deck": "name of the deck",
    "title": "its title",
    "deck_sha256": "hash of the resolved deck: the same for the same case",
    "version": "version of hydro2d",
    "status": "done, interrupted or unphysical",
    "stop_reason": "what ended the run",
    "trustworthy": "whether nothing is wrong with the state at the end",
    "faults": "what is wrong, in sentences",
    "time_s": "time at the end",
    "cycles": "number of cycles",
    "wall_s": "seconds that the run took",
    "ns_per_cell_cycle": "nanoseconds per cell and cycle",
    "cells": "number of cells",
    **penetrator.QUANTITIES,
    **{f"crater.{key}": f"hole in the first target: {meaning}" for key, meaning in crater.QUANTITIES.items()},
    **{f"targets.TARGET.{key}": f"of each target: {meaning}" for key, meaning in penetrator.PASSAGE.items()},
    **{f"targets.TARGET.crater.{key}": f"of each target: {meaning}" for key, meaning in crater.QUANTITIES.items()},
    **{f"bodies.BODY.{key}": f"of each body: {meaning}" for key, meaning in bodies.QUANTITIES.items()},
    **{f"stations.STATION.{key}": f"of each tracer and gauge: {meaning}"
       for key, meaning in {**PLACES, **tracers.QUANTITIES, **tracers.PEAKS}.items()},
    "experiment.penetration_m": "depth of the experiment that the deck names",
    "experiment.qualifier": "measured, estimated or at least",
    "experiment.source": "where it comes from",
    "conservation.mass.BODY": "relative change of the mass of a body that no sink explains",
    "conservation.axial_momentum": "change of the axial momentum that no sink explains, relative to what there was of it",
    "conservation.total_energy": "relative change of the total energy that no sink explains",
    "conservation.internal_energy_J": "internal energy of all bodies",
    "conservation.kinetic_energy_J": "kinetic energy of all vertices",
    "conservation.start_energy_J": "total energy at the start, with the kinetic energy of all bodies",
    **{f"conservation.sinks.SINK.{key}": f"{meaning} that a sink has taken" for key, meaning in AMOUNTS.items()},
    **{f"conservation.contact_transfers.TRANSFER.{key}": f"{meaning} that bodies in contact have transferred"
       for key, meaning in AMOUNTS.items() if key != "mass_kg"},
    "provenance": "commit, machine, packages, command and times",
}  # fmt: skip
