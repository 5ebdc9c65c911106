"""The columns of history.h5 and the keys of summary.json, with their meanings: every number that a run writes.

In a name, BODY, TARGET, STATION, DERIVED, SINK and TRANSFER stand for the names of each; a station is `tracer_NAME` or
`gauge_NAME`.
"""

from __future__ import annotations

from hydro2d.measure.bodies import Body
from hydro2d.measure.penetrator import Projectile
from hydro2d.measure.station_columns import Point
from hydro2d.measure.summary import OF_EVERY_BODY, PROJECTILE, Conservation, Sink, Summary

#: summary keys that call a projectile of any shape a rod, and the keys that replace them
OLD: dict[str, str] = {
    **{old: f"projectile.{new}" for old, new in PROJECTILE.items()},
    **{old: f"bodies.{'TARGET' if old.startswith('target') else 'BODY'}.{new}" for old, new in OF_EVERY_BODY.items()},
}

#: columns of the audit, and the results of the summary that they are over time
AUDIT = {"internal_energy_J": "internal_energy_J", "kinetic_energy_J": "kinetic_energy_J", "mass_change_BODY": "mass",
         "axial_momentum_change": "axial_momentum", "total_energy_change": "total_energy"}

HISTORY: dict[str, str] = {
    "time": "time since the start",
    "cycle": "cycle number",
    "dt": "time step",
    **Projectile.meanings(),
    **{column: Conservation.meanings()[name] for column, name in AUDIT.items()},
    **{f"body_BODY_{key}": f"of each body: {meaning}" for key, meaning in Body.meanings().items()},
    **{f"STATION_{key}": f"of each tracer and gauge: {meaning}" for key, meaning in Point.meanings().items()},
    "DERIVED": "a quantity that `[derived]` of the deck defines, or a file of `[result]` measures",
    **{f"sink_SINK_{key}": f"{meaning} since the start" for key, meaning in Sink.meanings().items()},
}

SUMMARY: dict[str, str] = {
    each.name: f"old name of {OLD[each.name]}, which later versions will not write" if each.name in OLD else each.meaning
    for each in Summary.listed()
}
