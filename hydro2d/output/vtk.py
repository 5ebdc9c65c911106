"""Fields as VTK files that ParaView opens with one click: a .vtr file for each dump and a .pvd file with their times.

In the files x = r and y = z. Values are float32, appended raw and compressed with LZ4. The outlines of the bodies and the
tracers are separate series of .vtp files. Names and units: derived_quantities.py.
"""

from __future__ import annotations

import errno
import math
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from hydro2d.base.errors import Error, unknown
from hydro2d.base.formats import in_xml
from hydro2d.files import checksums
from hydro2d.files.whole import replacing, write_text
from hydro2d.materials import quantities
from hydro2d.mesh.edges.registry import halved
from hydro2d.output import derived_quantities, foreign
from hydro2d.output.outlines import Filling

FOLDER = "vtk"
SERIES = {"dump": "series.pvd", "interfaces": "interfaces.pvd", "tracers": "tracers.pvd"}

#: size of a compressed block, bytes
BLOCK = 1 << 18


class VtkError(Error):
    """A VTK file that cannot be read."""


def _stamp(dataset, time: float) -> None:
    """Gives a dataset its time in s."""
    from vtkmodules.vtkCommonCore import vtkDoubleArray

    stamp = vtkDoubleArray()
    stamp.SetName("TimeValue")
    stamp.InsertNextValue(time)
    dataset.GetFieldData().AddArray(stamp)


@contextmanager
def _without_messages() -> Iterator[None]:
    """Keeps VTK from printing errors as many coloured lines; an exception reports them in one."""
    from vtkmodules.vtkCommonCore import vtkObject

    shown = vtkObject.GetGlobalWarningDisplay()
    vtkObject.GlobalWarningDisplayOff()
    try:
        yield
    finally:
        vtkObject.SetGlobalWarningDisplay(shown)


def _write(dataset, path: Path, time: float, writer) -> None:
    _stamp(dataset, time)
    for data in (dataset.GetCellData(), dataset.GetPointData()):
        for number in range(data.GetNumberOfArrays()):
            array = data.GetAbstractArray(number)
            array.SetName(in_xml(array.GetName()))  # VTK writes names into its XML unescaped
    writer.SetInputData(dataset)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToLZ4()
    writer.SetBlockSize(BLOCK)
    with replacing(path) as temporary, _without_messages():
        writer.SetFileName(str(temporary))
        if writer.Write() != 1:
            raise _write_error(writer.GetErrorCode(), path)
        checksums.seal(temporary, path.suffix)


def _write_error(code: int, path: Path) -> OSError:
    """The error for a file that VTK could not write; codes below VTK's own are errors of the operating system."""
    from vtkmodules.vtkCommonMisc import vtkErrorCode

    if code == vtkErrorCode.OutOfDiskSpaceError:
        code = errno.ENOSPC
    if 0 < code < vtkErrorCode.FirstVTKErrorCode:
        return OSError(code, os.strerror(code), str(path))
    return OSError(f"{path}: VTK could not write the file: {vtkErrorCode.GetStringFromErrorCode(code)}")


def _array(values: np.ndarray, name: str):
    """A VTK array that owns its numbers: float32 for real numbers, int32 for integers."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    kind = np.int32 if values.dtype.kind in "iu" else np.float32
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=kind), deep=True)
    array.SetName(name)
    return array


def _coordinates(values, name: str):
    """A float64 VTK array with a name; without one VTK would write a memory address and no two files would match."""
    from vtkmodules.util.numpy_support import numpy_to_vtk

    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
    array.SetName(name)
    return array


def write_grid(path: Path, r_edges, z_edges, fields: Iterable[tuple[str, np.ndarray]], time: float) -> None:
    """Writes cell data on a rectilinear grid.

    r_edges (nr + 1,), z_edges (nz + 1,) in m;  fields: names and values (nz, nr) or (nz, nr, 3);  time in s

    The first vector is marked as the one that filters rotate and mirror with the geometry.
    """
    from vtkmodules.vtkIOXML import vtkXMLRectilinearGridWriter

    _write(_grid(r_edges, z_edges, fields), path, time, vtkXMLRectilinearGridWriter())


def _grid(r_edges, z_edges, fields: Iterable[tuple[str, np.ndarray]]):
    """Cell data on a vtkRectilinearGrid."""
    from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid

    grid = vtkRectilinearGrid()
    grid.SetDimensions(len(r_edges), len(z_edges), 1)
    grid.SetXCoordinates(_coordinates(r_edges, "r"))
    grid.SetYCoordinates(_coordinates(z_edges, "z"))
    grid.SetZCoordinates(_coordinates([0.0], "height"))
    data, cells = grid.GetCellData(), (len(z_edges) - 1) * (len(r_edges) - 1)
    for name, values in fields:
        data.AddArray(_array(values.reshape(cells, *values.shape[2:]), name))
        if values.ndim == 3 and data.GetVectors() is None:
            data.SetActiveVectors(name)
    return grid


def write_lines(path: Path, lines: list[tuple[int, np.ndarray]], time: float) -> None:
    """Writes polylines, each with the number of its body; every line is an array (n, 2) of r, z."""
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    cells, data, start = vtkCellArray(), vtkPolyData(), 0
    for _, line in lines:
        cells.InsertNextCell(len(line))
        for point in range(start, start + len(line)):
            cells.InsertCellPoint(point)
        start += len(line)
    data.SetPoints(_points(np.concatenate([line for _, line in lines]) if lines else np.zeros((0, 2))))
    data.SetLines(cells)
    data.GetCellData().AddArray(_array(np.array([body for body, _ in lines], dtype=np.int32), "Material"))
    _write(data, path, time, vtkXMLPolyDataWriter())


def write_points(path: Path, positions: np.ndarray, time: float) -> None:
    """Writes tracers as vertices, each with its number; positions (n, 2) of r, z."""
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    cells, data = vtkCellArray(), vtkPolyData()
    for point in range(len(positions)):
        cells.InsertNextCell(1)
        cells.InsertCellPoint(point)
    data.SetPoints(_points(positions))
    data.SetVerts(cells)
    data.GetPointData().AddArray(_array(np.arange(len(positions), dtype=np.int32), "Tracer"))
    _write(data, path, time, vtkXMLPolyDataWriter())


def _points(positions: np.ndarray):
    from vtkmodules.vtkCommonCore import vtkPoints

    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(_coordinates(np.column_stack([positions, np.zeros(len(positions))]), "Points"))
    return points


def write_series(path: Path, entries: list[tuple[float, str]]) -> None:
    """Writes a .pvd file: times in s, and file names relative to it."""
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1", byte_order="LittleEndian")
    collection = ElementTree.SubElement(root, "Collection")
    for time, file in entries:
        ElementTree.SubElement(collection, "DataSet", timestep=repr(float(time)), group="", part="0", file=file)
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding="unicode")
    write_text(path, f'<?xml version="1.0"?>\n{text}\n', checksum=True)


def read_series(path: Path) -> list[tuple[float, str]]:
    """Times and file names of a .pvd file; all names must be plain ones in FOLDER. Raises VtkError, StrangeFile."""
    data = checksums.verified(path, VtkError)
    try:
        foreign.check_xml(data)
        entries = [(float(e.get("timestep")), e.get("file")) for e in ElementTree.fromstring(data).iter("DataSet")]
        foreign.check_names((file for _, file in entries), FOLDER)
        return entries
    except (ElementTree.ParseError, TypeError, ValueError) as error:
        raise VtkError(f"{path} is not a series of VTK files: {error}") from None


@dataclass(frozen=True)
class Dump:
    """A dump read from a file: r_edges (nr + 1,), z_edges (nz + 1,), fields by name (nz, nr[, 3]), time in s.

    mirrored : whether pictures show the mirror image as well, see `boundary_conditions.halved`; not stored in files
    """

    r_edges: np.ndarray
    z_edges: np.ndarray
    fields: dict[str, np.ndarray]
    time: float
    mirrored: bool = True

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, in order."""
        prefix = quantities.BY_KEY["volume_fraction"].title.format(body="")
        return [name.removeprefix(prefix) for name in self.fields if name.startswith(prefix)]

    def values(self, key: str, body: str | None = None) -> np.ndarray | None:
        """The values of a quantity by its key, (nz, nr[, 3]); None if the file has none.

        A total stress that was not written is made of the deviator and the pressure.
        """
        name = quantities.BY_KEY[key].name(body)
        if name in self.fields or key not in quantities.DEVIATORS:
            return self.fields.get(name)
        deviator, pressure = self.values(quantities.DEVIATORS[key]), self.values("pressure")
        if key == "stress_rz" or deviator is None or pressure is None:
            return deviator if key == "stress_rz" else None
        return deviator - pressure

    @property
    def shape(self) -> tuple[int, int]:
        """Number of cells along z and r, (nz, nr)."""
        return len(self.z_edges) - 1, len(self.r_edges) - 1

    @property
    def r_centres(self) -> np.ndarray:
        """Radii of the cell centres, m, shape (nr,)."""
        return 0.5 * (self.r_edges[1:] + self.r_edges[:-1])

    @property
    def z_centres(self) -> np.ndarray:
        """Axial positions of the cell centres, m, shape (nz,)."""
        return 0.5 * (self.z_edges[1:] + self.z_edges[:-1])

    def outlines(self, body: str) -> list[np.ndarray]:
        """Lines around a body, each an array (n, 2) of r, z in m; see `Filling.outlines`. Raises VtkError."""
        return self.filling(body).outlines()

    def filling(self, body: str | None = None) -> Filling:
        """The filling of the cells by a body, or by all bodies together. Raises VtkError."""
        if body is not None and body not in self.bodies:
            raise VtkError(unknown("body", body, self.bodies))
        fillings = [self._filling(each) for each in (self.bodies if body is None else [body])]
        if len(fillings) == 1:
            return fillings[0]
        fraction = sum(each.fraction for each in fillings)
        if any(each.offsets is None for each in fillings):
            return Filling(self.r_edges, self.z_edges, fraction)
        moments = sum(each.fraction * each.offsets for each in fillings)
        offsets = np.divide(moments, fraction, out=np.zeros_like(moments), where=fraction > 0.0)
        return Filling(self.r_edges, self.z_edges, fraction, offsets)

    def _filling(self, body: str) -> Filling:
        share, *places = (quantities.BY_KEY[key].name(body) for key in ("volume_fraction", "centroid_r", "centroid_z"))
        known = all(each in self.fields for each in places)  # dumps of older versions lack them
        offsets = np.stack([self.fields[each].astype(float) for each in places]) if known else None
        return Filling(self.r_edges, self.z_edges, self.fields[share].astype(float), offsets)

    @classmethod
    def of(cls, sim, keys=("all",)) -> Dump:
        """The state of a simulation as a dump would hold it."""
        half = halved(sim.grid.geometry, sim.grid.r_edges[0], sim.deck.boundaries.r_min)
        return cls(sim.grid.r_edges, sim.grid.z_edges, derived_quantities.evaluate(sim, keys), sim.time, half)


def _read(reader, path: Path):
    """The data that a VTK reader reads from a file. Raises VtkError."""
    checksums.verify(path, VtkError)
    with _without_messages():
        if not reader.CanReadFile(str(path)):
            raise VtkError(f"{path} is not a VTK file of a run")
        foreign.check_vtk(Path(path), VtkError)
        reader.SetFileName(str(path))
        reader.Update()
    if reader.GetErrorCode():
        raise VtkError(f"{path} is damaged: VTK cannot read all of it")
    return reader.GetOutput()


def _read_whole(path: Path):
    """The vtkRectilinearGrid of a .vtr file, and its cell arrays. Raises VtkError."""
    from vtkmodules.vtkIOXML import vtkXMLRectilinearGridReader

    grid = _read(vtkXMLRectilinearGridReader(), path)
    data, time = grid.GetCellData(), grid.GetFieldData().GetArray("TimeValue")
    arrays = [data.GetArray(number) for number in range(data.GetNumberOfArrays())]
    axes = [axis for axis in (grid.GetXCoordinates(), grid.GetYCoordinates()) if axis is not None]
    cells = math.prod(axis.GetNumberOfTuples() - 1 for axis in axes)
    whole = len(axes) == 2 and cells > 0 and all(each is not None and each.GetNumberOfTuples() == cells for each in arrays)
    if not whole or time is None or time.GetNumberOfTuples() < 1:
        raise VtkError(f"{path} is damaged: its time, its mesh or its cell values are incomplete")
    return grid, arrays


def read_grid(path: Path) -> Dump:
    """Reads a .vtr file. Raises VtkError."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    (grid, arrays), fields = _read_whole(path), {}
    r, z = map(vtk_to_numpy, (grid.GetXCoordinates(), grid.GetYCoordinates()))
    for each in arrays:
        values = vtk_to_numpy(each)
        fields[each.GetName()] = values.reshape(len(z) - 1, len(r) - 1, *values.shape[1:]).copy()
    return Dump(r.copy(), z.copy(), fields, grid.GetFieldData().GetArray("TimeValue").GetValue(0))


def check_lines(path: Path) -> None:
    """Raises VtkError for a .vtp file that is damaged."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    _read(vtkXMLPolyDataReader(), path)


def read_lines(path: Path) -> list[tuple[int, np.ndarray]]:
    """Reads polylines from a .vtp file in the form of ``write_lines``: number of the body, r and z (n, 2). Raises VtkError."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    data = _read(vtkXMLPolyDataReader(), path)
    bodies = data.GetCellData().GetArray("Material")
    if bodies is None:
        raise VtkError(f"{path} cannot be read: its lines name no body")
    if data.GetNumberOfCells() == 0:
        return []
    points = vtk_to_numpy(data.GetPoints().GetData())[:, :2].copy()
    ends = vtk_to_numpy(data.GetLines().GetOffsetsArray())
    order = vtk_to_numpy(data.GetLines().GetConnectivityArray())
    return [
        (int(bodies.GetTuple1(line)), points[order[first:last]])
        for line, (first, last) in enumerate(zip(ends[:-1], ends[1:], strict=True))
    ]


def pyvista_of(r_edges, z_edges, fields: Iterable[tuple[str, np.ndarray]], time: float):
    """The data of `write_grid` as a pyvista.RectilinearGrid."""
    import pyvista

    grid = _grid(r_edges, z_edges, fields)
    _stamp(grid, time)
    return pyvista.wrap(grid)


def pyvista_grid(path: Path):
    """A .vtr file as a pyvista.RectilinearGrid. Raises VtkError."""
    import pyvista

    return pyvista.wrap(_read_whole(path)[0])
