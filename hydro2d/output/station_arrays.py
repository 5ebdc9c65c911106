"""Columns of tracers and gauges in a file: one array over time and station for each quantity, however many stations there are.

A file holds the columns `gauge_NAME_pressure_Pa` of all gauges as the dataset `gauge_pressure_Pa` over `time` and `gauge`, the
names of the gauges; those of tracers likewise.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from hydro2d.mesh.station_columns import QUANTITIES

#: kinds of stations, which are also the dimension scales with their names, and what the history has of each
KINDS = ("tracer", "gauge")
KEYS = ("r_m", "z_m", *QUANTITIES)
#: names of datasets, which no other column may have
RESERVED = (*KINDS, *(f"{kind}_{key}" for kind in KINDS for key in KEYS))


def stations(columns: Collection[str], kind: str) -> list[str]:
    """Names of the stations of a kind for which there are columns of all quantities, in order."""
    first = f"_{KEYS[0]}"
    named = [name[len(kind) + 1 : -len(first)] for name in columns if name.startswith(f"{kind}_") and name.endswith(first)]
    return [name for name in named if name and all(column in columns for column in of_station(kind, name))]


def of_station(kind: str, name: str) -> Iterator[str]:
    """Names of the columns of a station."""
    return (f"{kind}_{name}_{key}" for key in KEYS)
