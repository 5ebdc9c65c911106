"""Writes the dumps of a run directory: fields, outlines and tracers, and the lists of their times."""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path

import numpy as np

from hydro2d.files.locks import check_place, remove
from hydro2d.files.strange import own_folder
from hydro2d.output import derived_quantities, vtk
from hydro2d.output.outlines import Filling


def numbered(directory: Path, kind: str) -> list[tuple[int, Path]]:
    """The dumps of a kind of vtk.SERIES in a run directory, with their numbers; other files in the folder are ignored."""
    name = re.compile(rf"{kind}_([0-9]{{6,}})\.vt[rp]")
    files = ((name.fullmatch(file.name), file) for file in (directory / vtk.FOLDER).glob(f"{kind}_*"))
    return [(int(match.group(1)), file) for match, file in files if match]


class Series:
    """The dumps of a run directory.

    Parameters
    ----------
    directory : the run directory
    fields : keys of quantities.TABLE, or words of quantities.GROUPS, to write
    dumps : number of dumps of the existing series to keep (a restart); later ones are removed

    Attributes
    ----------
    repaired : the fault of the existing series, whose times were then read from the dumps; empty if there was none
    """

    def __init__(self, directory: Path, fields=("standard",), dumps: int = 0):
        self.directory, self.fields = Path(directory), fields
        self._times: list[float] = []
        self.repaired = ""
        if dumps:
            self._times = self._read(dumps)
        for kind in vtk.SERIES:
            for number, file in numbered(self.directory, kind):
                if number >= len(self._times):
                    remove(file)
        if self._times:
            self._write_series()

    def _read(self, dumps: int) -> list[float]:
        """Times of the first dumps, from the series or, if that is damaged, from the dumps up to the first damaged dump."""
        try:
            return [time for time, _ in vtk.read_series(self.directory / vtk.SERIES["dump"])][:dumps]
        except vtk.VtkError as error:
            self.repaired = f"{error}; its times are read from the dumps"
        times: list[float] = []
        with suppress(vtk.VtkError):
            for number in range(dumps):
                times.append(vtk.read_grid(self._path("dump", number)).time)
        return times

    def __len__(self) -> int:
        return len(self._times)

    @property
    def last_time(self) -> float | None:
        """Time of the last dump."""
        return self._times[-1] if self._times else None

    def dump(self, sim) -> Path:
        """Writes fields, outlines and tracers of a simulation and lists them in the series."""
        number, time = len(self._times), sim.time
        check_place(self.directory / vtk.FOLDER)
        own_folder(self.directory / vtk.FOLDER)
        path = self._path("dump", number)
        vtk.write_grid(path, sim.grid.r_edges, sim.grid.z_edges, derived_quantities.evaluated(sim, self.fields), time)
        vtk.write_lines(self._path("interfaces", number), _body_lines(sim), time)
        if len(sim.stations.tracers):
            vtk.write_points(self._path("tracers", number), sim.stations.tracers, time)
        self._times.append(time)
        try:
            self._write_series()
        except Exception:
            self._times.pop()
            raise
        return path

    def _path(self, kind: str, number: int) -> Path:
        return self.directory / vtk.FOLDER / f"{kind}_{number:06d}.{'vtr' if kind == 'dump' else 'vtp'}"

    def _write_series(self) -> None:
        for kind, name in vtk.SERIES.items():
            paths = [self._path(kind, number) for number in range(len(self._times))]
            entries = [(time, f"{vtk.FOLDER}/{path.name}") for time, path in zip(self._times, paths, strict=True)
                       if path.exists()]
            if entries:
                vtk.write_series(self.directory / name, entries)


def _body_lines(sim) -> list[tuple[int, np.ndarray]]:
    cells, grid = derived_quantities.Cells(sim), sim.grid
    offsets = np.stack([cells.centroid_r(), cells.centroid_z()], axis=1)
    return [
        (m + 1, line)
        for m, (fraction, off) in enumerate(zip(cells.vof, offsets, strict=True))
        for line in Filling(grid.r_edges, grid.z_edges, fraction, off).outlines()
    ]
