"""Columns of tracers and gauges in a file: one array over time and station for each quantity.

A file holds the columns `gauge_NAME_pressure_Pa` of all gauges as the dataset `gauge_pressure_Pa` over `time` and `gauge`, the
names of the gauges; likewise for tracers.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from hydro2d.measure.station_columns import QUANTITIES

#: kinds of stations, also names of the dimension scales that hold their names, and the quantities of each in the history
KINDS = ("tracer", "gauge")
KEYS = ("r_m", "z_m", *QUANTITIES)
#: names of datasets, reserved for them
RESERVED = (*KINDS, *(f"{kind}_{key}" for kind in KINDS for key in KEYS))


def stations(columns: Collection[str], kind: str) -> list[str]:
    """Names of the stations of a kind that have columns of all quantities, in order."""
    first = f"_{KEYS[0]}"
    named = [name[len(kind) + 1 : -len(first)] for name in columns if name.startswith(f"{kind}_") and name.endswith(first)]
    return [name for name in named if name and all(column in columns for column in of_station(kind, name))]


def of_station(kind: str, name: str) -> Iterator[str]:
    """Names of the columns of a station."""
    return (f"{kind}_{name}_{key}" for key in KEYS)
