"""Fields as xarray datasets, by the keys of the table of quantities: of one state, or of all dumps of a run.

Dimensions are z and r, preceded by `body` for quantities of each body and followed by `component` for vectors. Dumps of a run
have `time` as the first dimension and are read when their values are used. Coordinates are the centres of the cells in m. A
travelling mesh keeps the z of the first dump, and `mesh_position` is its displacement: a cell is at z + mesh_position.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.mesh.quantities import TABLE, Quantity
from hydro2d.output.vtk import Dump, read_grid

if TYPE_CHECKING:
    import xarray

#: components of vectors; the third, which the files have for ParaView, is zero
COMPONENTS = ("r", "z")
#: largest number of dumps kept in memory
KEPT = 4


def _names(quantity: Quantity, dump: Dump) -> list[str]:
    """Names in files of a quantity: one, or one for every body."""
    return [quantity.name(body) for body in dump.bodies] if quantity.per_body else [quantity.name()]


def _values(quantity: Quantity, dump: Dump) -> np.ndarray:
    """The values of a quantity, shape ([body,] nz, nr[, component]); NaN where a body, or the dump, has none."""
    shape = len(dump.z_edges) - 1, len(dump.r_edges) - 1
    names = _names(quantity, dump)
    like = next((dump.fields[name] for name in names if name in dump.fields), np.empty(shape, np.float32))
    found = [dump.fields[name] if name in dump.fields else np.full(like.shape, np.nan, np.float32) for name in names]
    if quantity.per_body:
        return np.stack(found)
    return found[0][..., : len(COMPONENTS)] if like.ndim > len(shape) else found[0]


def _dimensions(quantity: Quantity, values: np.ndarray) -> tuple[str, ...]:
    if quantity.per_body:
        return "body", "z", "r"
    return ("z", "r", "component")[: values.ndim]


def _attributes(quantity: Quantity) -> dict[str, str]:
    return {"units": quantity.unit or "1", "long_name": quantity.title.replace(" of {body}", "").replace(" for {body}", ""),
            "description": quantity.meaning}


def _coordinates(dump: Dump) -> dict:
    return {
        "z": ("z", dump.z_centres, {"units": "m", "long_name": "axial position"}),
        "r": ("r", dump.r_centres, {"units": "m", "long_name": "radius"}),
        "body": list(dump.bodies),
        "component": list(COMPONENTS),
    }


def _quantities(*dumps: Dump) -> list[Quantity]:
    """The quantities that one of the dumps holds."""
    return [quantity for quantity in TABLE
            if any(name in dump.fields for dump in dumps for name in _names(quantity, dump))]


def of_state(dump: Dump) -> xarray.Dataset:
    """A state as a dataset over z and r; the time in s is a coordinate without dimension."""
    import xarray

    variables = {}
    for quantity in _quantities(dump):
        values = _values(quantity, dump)
        variables[quantity.key] = (_dimensions(quantity, values), values, _attributes(quantity))
    time = ((), dump.time, {"units": "s"})
    return xarray.Dataset(variables, coords={**_coordinates(dump), "time": time})


@functools.lru_cache(maxsize=KEPT)
def _kept(path: Path, changed: int) -> Dump:
    return read_grid(path)


def _read(path: Path) -> Dump:
    """A dump, from memory where it was read lately and the file is the same."""
    return _kept(path, os.stat(path).st_mtime_ns)


def _values_of(path: Path, quantity: Quantity) -> np.ndarray:
    return _values(quantity, _read(path))


def _travel(path: Path, start: float) -> np.ndarray:
    return np.array(_read(path).z_edges[0] - start)


def of_dumps(dumps: Sequence[tuple[float, Path]]) -> xarray.Dataset:
    """All dumps of a run as one dataset over time, z and r, whose values are read from the files when they are needed.

    dumps : times in s and files, at least one

    Raises VtkError, also later where a file is damaged.
    """
    import dask
    import dask.array
    import xarray

    first, last = _read(dumps[0][1]), _read(dumps[-1][1])
    variables = {}
    for quantity in _quantities(first, last):
        like = _values(quantity, last)
        parts = [dask.array.from_delayed(dask.delayed(_values_of)(path, quantity), like.shape, like.dtype) for _, path in dumps]
        variables[quantity.key] = (("time", *_dimensions(quantity, like)), dask.array.stack(parts), _attributes(quantity))
    start = first.z_edges[0]
    travelled = [dask.array.from_delayed(dask.delayed(_travel)(path, start), (), float) for _, path in dumps]
    coordinates = {
        **_coordinates(first),
        "time": ("time", [time for time, _ in dumps], {"units": "s"}),
        "mesh_position": ("time", dask.array.stack(travelled), {"units": "m", "long_name": "how far the mesh has travelled"}),
    }
    return xarray.Dataset(variables, coords=coordinates)
