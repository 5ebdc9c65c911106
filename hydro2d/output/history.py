"""history.h5: one dataset per quantity against time and, at the end of a run, the holes in the targets.

Every dataset has the attribute `units` and `time` as its dimension scale, so that xarray can open the file directly. Datasets
of tracers and gauges have the station as a second dimension, see station_arrays.py. The group `crater` is the hole in the first
target, its radius over its axial positions; those of further targets are `crater_NAME`. The group `debris_NAME` is the debris
behind a target: the mass of each body by axial speed and by angle, and a list of fragments. The attributes of the root are the
title of the run, the version of hydro2d and the text of the deck, so that a file alone says what it is of. The whole file is
written under a temporary name and renamed each time, so a run that is killed leaves the last complete file.
"""

from __future__ import annotations

import csv
import io
from array import array
from collections.abc import Iterable
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.base.errors import Error, from_extra
from hydro2d.base.formats import cell, in_hdf5
from hydro2d.files import checksums
from hydro2d.files.strange import own
from hydro2d.files.whole import hdf5, replacing
from hydro2d.measure.debris import FRAGMENTS, Debris
from hydro2d.measure.regime import REGIMES
from hydro2d.measure.result import unit
from hydro2d.output import foreign
from hydro2d.output.station_arrays import KEYS, KINDS, of_station, stations

if TYPE_CHECKING:
    import pandas
    import xarray


#: prefix of the groups of debris behind targets
DEBRIS = "debris"
#: group of the hole in the first target, also the prefix of the groups of others, and its datasets
CRATER, CRATER_COLUMNS = "crater", ("z_m", "radius_m")
#: bytes that an attribute of HDF5 can have; a longer deck is left out
LARGEST_ATTRIBUTE = 60_000


class HistoryError(Error):
    """A history file that cannot be read."""


def spoken(name: str) -> str:
    """A quantity in words, without its unit: "penetration depth" for penetration_depth_m; a rod may be a ball."""
    name = f"projectile_{name[4:]}" if name.startswith("rod_") else name
    return name.removesuffix("_" + unit(name).replace("/", "_").replace(" ", "_")).replace("_", " ")


def attributes(name: str) -> dict:
    """Attributes of a quantity: its unit, and for the regime the meaning of its numbers."""
    if name == "regime":
        words = " ".join(word.replace(" ", "_") for word in REGIMES)
        return {"units": unit(name), "flag_values": np.arange(len(REGIMES), dtype=np.int8), "flag_meanings": words}
    return {"units": unit(name)}


def _encode(value) -> float:
    if isinstance(value, str):
        return float(REGIMES.index(value))
    return np.nan if value is None else float(value)


class Columns:
    """Rows of named numbers, kept as columns."""

    def __init__(self) -> None:
        self._columns: dict[str, array[float]] = {}
        self._rows = 0

    def __len__(self) -> int:
        return self._rows

    @property
    def last_time(self) -> float | None:
        """Time of the last row."""
        return self._columns["time"][-1] if self._rows else None

    def some(self, names: Iterable[str]) -> dict[str, np.ndarray]:
        """Those of the named columns that exist, as floats, shapes (rows,)."""
        return {name: np.array(self._columns[name]) for name in names if name in self._columns}

    def append(self, row: dict[str, float | str | None]) -> None:
        """Adds a row, which must contain `time`. Quantities missing from other rows are NaN there."""
        for name in row:
            if name not in self._columns:
                self._columns[name] = array("d", [np.nan]) * self._rows
        for name, column in self._columns.items():
            column.append(_encode(row[name]) if name in row else np.nan)
        self._rows += 1

    def arrays(self) -> dict[str, np.ndarray]:
        """All columns by name, `time` first, as `read` returns them for a file."""
        names = sorted(self._columns, key=lambda name: (name != "time", name))
        return {name: _numbers(name, self._columns[name]) for name in names}


class History(Columns):
    """The columns of history.h5.

    Parameters
    ----------
    path : the file, which need not exist
    rows : number of rows of the existing file to keep (a restart); 0 begins an empty one
    unwritten : further rows that the file of an earlier process lacks, as `unwritten` gave them

    Attributes
    ----------
    craters : axial positions and radii of the hole in each target, m, by its name, written as well; empty before the end of
        a run
    about : attributes of the root of the file, texts by name
    debris : debris behind each target, by its name, likewise
    """

    def __init__(self, path: Path, rows: int = 0, unwritten: dict[str, list[float]] | None = None):
        super().__init__()
        self.path = Path(path)
        self.craters: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        self.debris: dict[str, Debris] = {}
        self.about: dict[str, str] = {}
        if rows:
            for name, values in read(self.path).items():
                self._columns[name] = array("d", values[:rows].astype(float).tobytes())
            self._rows = min(rows, len(self._columns["time"]))
        self._written = self._rows
        further = unwritten or {}
        for number in range(len(further.get("time", ()))):
            self.append({name: values[number] for name, values in further.items()})

    def unwritten(self, rows: int) -> dict[str, list[float]]:
        """Those of the first rows that are not in a file yet, by column."""
        if self._written >= rows:
            return {}
        return {name: column[self._written : rows].tolist() for name, column in self._columns.items()}

    def write(self) -> None:
        """Writes all rows."""
        self._write()
        self._written = self._rows

    def _write(self) -> None:
        with replacing(self.path) as temporary, hdf5(temporary) as file:
            texts = {name: text.replace("\0", " ") for name, text in self.about.items()}
            file.attrs.update({name: text for name, text in texts.items() if len(text.encode()) <= LARGEST_ATTRIBUTE})
            time = _dataset(file, "time", self._columns.get("time", []))
            time.make_scale("time")
            kept = {kind: stations(self._columns, kind) for kind in KINDS}
            of_stations = {column for kind, names in kept.items() for name in names for column in of_station(kind, name)}
            for name, values in self._columns.items():
                if name != "time" and name not in of_stations:
                    _dataset(file, name, values).dims[0].attach_scale(time)
            for kind, names in kept.items():
                if names:
                    self._write_stations(file, kind, names)
            for number, (name, crater) in enumerate(self.craters.items()):
                group = file.create_group(f"{CRATER}_{name}" if number else CRATER)
                group.attrs.update(target=name, number=number)
                z, radius = (_dataset(group, *column) for column in zip(CRATER_COLUMNS, crater, strict=True))
                z.make_scale(CRATER_COLUMNS[0])
                radius.dims[0].attach_scale(z)
            for number, (name, debris) in enumerate(self.debris.items()):
                _write_debris(file.create_group(f"{DEBRIS}_{name}"), name, number, debris)

    def _write_stations(self, file, kind: str, names: list[str]) -> None:
        """Writes the columns of tracers or gauges as arrays over time and station."""
        import h5py

        scale = file.create_dataset(kind, data=names, dtype=h5py.string_dtype())
        scale.make_scale(kind)
        for key in KEYS:
            columns = [np.asarray(self._columns[f"{kind}_{name}_{key}"]) for name in names]
            dataset = file.create_dataset(f"{kind}_{key}", data=np.column_stack(columns))
            dataset.attrs.update(attributes(key))
            for dimension, along in zip(dataset.dims, (file["time"], scale), strict=True):
                dimension.attach_scale(along)


def _write_debris(group, target: str, number: int, debris: Debris) -> None:
    """Writes the debris behind a target: bins with the mass of each body in them, and the fragments."""
    import h5py

    group.attrs.update(target=target, number=number)
    group.create_dataset("body", data=debris.bodies, dtype=h5py.string_dtype())
    for what, edges, mass in (("speed_m_s", debris.speeds, debris.by_speed), ("angle_rad", debris.angles, debris.by_angle)):
        _dataset(group, f"{what.split('_')[0]}_edges_{what.split('_', 1)[1]}", edges)
        _dataset(group, f"mass_by_{what.split('_')[0]}_kg", mass)
    for key, column in zip(FRAGMENTS, debris.fragments.T, strict=True):
        _dataset(group, f"fragment_{key}", column)
    group.create_dataset("fragment_body", data=debris.kinds)


def _numbers(name: str, values) -> np.ndarray:
    """A column as stored in the file."""
    kind = {"cycle": np.int64, "regime": np.int8}.get(name, np.float64)
    numbers = np.asarray(values, dtype=float)
    if kind is not np.float64:
        numbers = np.nan_to_num(numbers, nan=-1)  # integers have no NaN
    return numbers.astype(kind)


def frame(columns: dict[str, np.ndarray]) -> pandas.DataFrame:
    """Columns as a pandas.DataFrame with time in s as index and the regime in words; `attrs["units"]` has every unit."""
    import pandas

    shown: dict = dict(columns) or {"time": np.empty(0)}
    if "regime" in shown:
        shown["regime"] = pandas.Categorical.from_codes(shown["regime"], REGIMES)
    table = pandas.DataFrame(shown).set_index("time")
    table.attrs["units"] = {name: unit(name) for name in columns}
    return table


def dataset(columns: dict[str, np.ndarray]) -> xarray.Dataset:
    """Columns as an xarray.Dataset over the time in s, every variable with its unit. Raises MissingPackage."""
    with from_extra("data", "a history as a dataset"):
        import xarray

    variables = {name: ("time", column, attributes(name)) for name, column in columns.items()}
    return xarray.Dataset({name: entry for name, entry in variables.items() if name != "time"},
                          coords={"time": variables["time"]})


def _dataset(file, name: str, values):
    dataset = file.create_dataset(in_hdf5(name), data=_numbers(name, values))
    dataset.attrs.update(attributes(name) | ({"long_name": name} if in_hdf5(name) != name else {}))
    return dataset


@contextmanager
def _opened(path: Path):
    """A history file opened for reading. Raises HistoryError."""
    import h5py

    checksums.verify(path, HistoryError)
    try:
        with h5py.File(own(path), "r") as file:
            foreign.check_hdf5(file, ratio=1)  # its values are not compressed
            yield file
    except (OSError, KeyError, ValueError, RuntimeError, AttributeError, TypeError) as error:
        raise HistoryError(f"{path} is damaged, or not a history file: {error}") from None


def read(path: Path) -> dict[str, np.ndarray]:
    """All columns by name, `time` first, shapes (rows,). Raises HistoryError."""
    with _opened(path) as file:
        datasets = {file[name].attrs.get("long_name", name): file[name][...] for name in file.keys() - set(_groups(file, ""))}
        for kind in KINDS:
            if kind in datasets and datasets[kind].dtype == object:
                datasets |= _pop_stations(datasets, kind)
        columns = {name: datasets[name] for name in sorted(datasets, key=lambda name: (name != "time", name))}
        if any(column.shape != columns["time"].shape or column.dtype.kind not in "fi" for column in columns.values()):
            raise HistoryError(f"{path} is damaged: its columns differ in length")
        return columns


def _pop_stations(datasets: dict[str, np.ndarray], kind: str) -> dict[str, np.ndarray]:
    """Removes the arrays of tracers or gauges, shapes (rows, stations), and returns them as columns, shapes (rows,)."""
    names = [name.decode() for name in datasets.pop(kind)]
    arrays = {key: np.ascontiguousarray(datasets.pop(f"{kind}_{key}").T) for key in KEYS}
    return {f"{kind}_{name}_{key}": column for key, columns in arrays.items()
            for name, column in zip(names, columns, strict=True)}


def _groups(file, prefix: str) -> list[str]:
    """Names of the groups with a prefix, in the order of the targets."""
    import h5py

    groups = [name for name, entry in file.items() if isinstance(entry, h5py.Group) and name.startswith(prefix)]
    return sorted(groups, key=lambda name: file[name].attrs.get("number", 0))


def read_craters(path: Path) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Axial positions and radii of the hole in each target, m, shapes (n,), by its name; empty if there are none.

    Raises HistoryError.
    """
    with _opened(path) as file:
        groups = [file[name] for name in _groups(file, CRATER)]
        return {group.attrs.get("target", "target"): tuple(group[name][...] for name in CRATER_COLUMNS) for group in groups}


def read_debris(path: Path) -> dict[str, dict[str, np.ndarray]]:
    """Debris behind each target at the end, by the target's name; empty if there are none. Raises HistoryError.

    body : names of the bodies;  speed_edges_m_s, angle_edges_rad (n + 1,) : bins;  mass_by_speed_kg, mass_by_angle_kg
    (n, bodies);  fragment_mass_kg, fragment_r_m, fragment_z_m, fragment_velocity_r_m_s, fragment_velocity_z_m_s and
    fragment_body, the number of its body, (k,)
    """
    with _opened(path) as file:
        debris = {}
        for name in _groups(file, f"{DEBRIS}_"):
            arrays = {key: file[name][key][...] for key in file[name]}
            arrays["body"] = np.array([body.decode() for body in arrays["body"]], dtype=str)
            debris[str(file[name].attrs.get("target", name))] = arrays
        return debris


def write_csv(columns: dict[str, np.ndarray], path: Path) -> None:
    """Writes the columns as CSV with 17 digits; the header gives quantity and unit."""
    header = io.StringIO()
    csv.writer(header, lineterminator="").writerow(cell(f"{name} [{unit(name)}]") for name in columns)
    with replacing(path) as temporary:
        table = np.column_stack(list(columns.values()))
        np.savetxt(temporary, table, fmt="%.17g", delimiter=",", header=header.getvalue(), comments="", encoding="utf-8")
