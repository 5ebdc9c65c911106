"""Fields as xarray datasets, by the keys of the table of quantities: of one state, or of all dumps of a run.

Dimensions are z and r, preceded by `body` for quantities of each body and followed by `component` for vectors. Dumps of a run
have `time` as the first dimension and are read when their values are used. Coordinates are the centres of the cells in m, in
the laboratory frame. On a mesh that follows a body, z depends on time, shape (time, mesh_z), and the dimension along the axis
is `mesh_z`, the z of the cell in the first dump: z = mesh_z + mesh_position.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.base.errors import from_extra
from hydro2d.materials import quantities
from hydro2d.materials.quantities import Quantity
from hydro2d.output.vtk import Dump, VtkError, read_grid

if TYPE_CHECKING:
    import xarray

#: components of vectors; the third, which ParaView needs in the files, is zero
COMPONENTS = ("r", "z")
#: dimension along the axis of a travelling mesh
MESH_Z = "mesh_z"


def _names(quantity: Quantity, dump: Dump) -> list[str]:
    """Names of a quantity in files: one, or one for each body."""
    return [quantity.name(body) for body in dump.bodies] if quantity.per_body else [quantity.name()]


def _values(quantity: Quantity, dump: Dump) -> np.ndarray:
    """The values of a quantity, shape ([body,] nz, nr[, component]); NaN where a body or the dump has none."""
    names = _names(quantity, dump)
    like = next((dump.fields[name] for name in names if name in dump.fields), np.empty(dump.shape, np.float32))
    arrays = [dump.fields[name] if name in dump.fields else np.full(like.shape, np.nan, np.float32) for name in names]
    if quantity.per_body:
        return np.stack(arrays)
    return arrays[0][..., : len(COMPONENTS)] if like.ndim > 2 else arrays[0]


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


def quantities_of(*dumps: Dump) -> list[Quantity]:
    """The quantities in any of the dumps, including internal variables of outside models, which the table lacks."""
    table = [quantity for quantity in quantities.TABLE
             if any(name in dump.fields for dump in dumps for name in _names(quantity, dump))]
    known = {name for dump in dumps for quantity in table for name in _names(quantity, dump)}
    further = [each for dump in dumps for name in dump.fields if name not in known
               for each in quantities.from_name(name, dump.bodies)]
    keys = {quantity.key for quantity in table}
    return table + list({each.key: each for each in further if each.key not in keys}.values())


def of_state(dump: Dump) -> xarray.Dataset:
    """A state as a dataset over z and r; the time in s is a scalar coordinate. Raises MissingPackage."""
    with from_extra("data", "a dataset of fields"):
        import xarray

    variables = {}
    for quantity in quantities_of(dump):
        values = _values(quantity, dump)
        variables[quantity.key] = (_dimensions(quantity, values), values, _attributes(quantity))
    time = ((), dump.time, {"units": "s"})
    return xarray.Dataset(variables, coords={**_coordinates(dump), "time": time})


def _travelling(dimensions: tuple[str, ...]) -> tuple[str, ...]:
    """Dimensions as named on a travelling mesh."""
    return tuple(MESH_Z if name == "z" else name for name in dimensions)


def _read(path: Path, shape: tuple[int, ...]) -> Dump:
    """A dump whose mesh has this shape, (nz, nr). Raises VtkError."""
    dump = read_grid(path)
    if dump.shape != shape:
        raise VtkError(f"{path} has another mesh than the dumps opened before: the run was started anew")
    return dump


def _travel(dump: Dump, start: float) -> np.ndarray:
    return np.array(dump.z_edges[0] - start)


def of_dumps(dumps: Sequence[tuple[float, Path]], follows: bool = False) -> xarray.Dataset:
    """All dumps of a run as one dataset over time, z and r, whose values are read from the files when needed.

    dumps : times in s and files, at least one
    follows : whether the mesh travels with a body; if so, the dimensions are time, `mesh_z` and r, and z depends on time

    Raises MissingPackage, and VtkError, also later if a file is damaged or gone.
    """
    import dask
    import dask.array

    with from_extra("data", "a dataset of fields"):
        import xarray

    first, last = read_grid(dumps[0][1]), read_grid(dumps[-1][1])
    opened = [dask.delayed(_read)(path, first.shape) for _, path in dumps]  # all variables of a dump share one read of its file
    variables = {}
    for quantity in quantities_of(first, last):
        like = _values(quantity, last)
        parts = [dask.array.from_delayed(dask.delayed(_values)(quantity, dump), like.shape, like.dtype) for dump in opened]
        names = _dimensions(quantity, like)
        variables[quantity.key] = (("time", *(_travelling(names) if follows else names)), dask.array.stack(parts),
                                   _attributes(quantity))
    start = first.z_edges[0]
    travelled = [dask.array.from_delayed(dask.delayed(_travel)(dump, start), (), float) for dump in opened]
    coordinates = {
        **_coordinates(first),
        **(_places(first, opened) if follows else {}),
        "time": ("time", [time for time, _ in dumps], {"units": "s"}),
        "mesh_position": ("time", dask.array.stack(travelled), {"units": "m", "long_name": "how far the mesh has travelled"}),
    }
    return xarray.Dataset(variables, coords=coordinates)


def _places(first: Dump, opened: list) -> dict:
    """z of a travelling mesh, from its dumps as dask opens them, and the coordinate that does not change."""
    import dask
    import dask.array

    places = [dask.array.from_delayed(dask.delayed(_middles)(dump), first.z_centres.shape, float) for dump in opened]
    return {
        "z": (("time", MESH_Z), dask.array.stack(places), {"units": "m", "long_name": "axial position"}),
        MESH_Z: (MESH_Z, first.z_centres, {"units": "m", "long_name": "axial position in the first dump"}),
    }


def _middles(dump: Dump) -> np.ndarray:
    return dump.z_centres
