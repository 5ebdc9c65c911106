"""The columns of history.h5 and the keys of summary.json, with their meanings: every number that a run writes.

In a name, BODY, TARGET, STATION, DERIVED, SINK and TRANSFER stand for the names of each; a station is `tracer_NAME` or
`gauge_NAME`.
"""

from __future__ import annotations

from hydro2d.measure.bodies import Body
from hydro2d.measure.penetrator import Projectile
from hydro2d.measure.station_columns import Point
from hydro2d.measure.summary import OF_EVERY_BODY, PROJECTILE, Summary

#: amounts of a sink
AMOUNTS = {"mass_kg": "mass", "momentum_N_s": "axial momentum", "energy_J": "energy"}

#: summary keys that call a projectile of any shape a rod, and the keys that replace them
OLD: dict[str, str] = {
    **{old: f"projectile.{new}" for old, new in PROJECTILE.items()},
    **{old: f"bodies.{'TARGET' if old.startswith('target') else 'BODY'}.{new}" for old, new in OF_EVERY_BODY.items()},
}

HISTORY: dict[str, str] = {
    "time": "time since the start",
    "cycle": "cycle number",
    "dt": "time step",
    **Projectile.meanings(),
    "internal_energy_J": "internal energy of all bodies",
    "kinetic_energy_J": "kinetic energy of all nodes",
    "mass_change_BODY": "relative change of the mass of a body that no sink accounts for",
    "axial_momentum_change": "change of the axial momentum that no sink accounts for, over sqrt(2 m E) at the start",
    "total_energy_change": "relative change of the total energy that no sink accounts for",
    **{f"body_BODY_{key}": f"of each body: {meaning}" for key, meaning in Body.meanings().items()},
    **{f"STATION_{key}": f"of each tracer and gauge: {meaning}" for key, meaning in Point.meanings().items()},
    "DERIVED": "a quantity that `[derived]` of the deck defines, or a file of `[result]` measures",
    **{f"sink_SINK_{key}": f"{meaning} that a sink has taken since the start" for key, meaning in AMOUNTS.items()},
}

SUMMARY: dict[str, str] = {
    each.name: f"old name of {OLD[each.name]}, which later versions will not write" if each.name in OLD else each.meaning
    for each in Summary.listed()
}
