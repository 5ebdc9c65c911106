"""The steps of docs/how-to/paraview.md, carried out with VTK's own classes on the files of a short shot with contact."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from vtkmodules import vtkFiltersGeneral
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataObject
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import (
    vtkCellCenters,
    vtkCellDataToPointData,
    vtkGlyph3D,
    vtkMassProperties,
    vtkThreshold,
    vtkTriangleFilter,
)
from vtkmodules.vtkFiltersGeneral import vtkReflectionFilter, vtkTemporalPathLineFilter
from vtkmodules.vtkFiltersModeling import vtkRotationalExtrusionFilter
from vtkmodules.vtkFiltersParallel import vtkExtractCTHPart
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLRectilinearGridReader

import hydro2d
from hydro2d.deck import deck as decks
from hydro2d.running.run import run
from tests.rules import source

PAGE = (source.ROOT / "docs" / "how-to" / "paraview.md").read_text(encoding="utf-8")
QUICK = source.PROBLEMS / "cth_nose_shape" / "hemi_5083_1086_quick.toml"
RADIUS, LENGTH, THICKNESS, SPEED = 3.3784e-3, 20e-3, 40e-3, 1086.0
CELL = RADIUS / 6
TRACERS = [[0.0, -19e-3], [3e-3, -10e-3], [2e-3, 30e-3]]
#: the quick shot with two velocities in contact, on a rod and a plate cut short
SHOT = [
    "body.rod.length='20 mm'", "body.plate.thickness='40 mm'", "sliding.method='contact'", "sliding.yield_factor='off'",
    "mesh.reach=none", "mesh.z_start='-24 mm'", "mesh.z=[{to=0.0, cells=42}, {cells=80, across='rod', cells_across=6}]",
    "mesh.r=[{cells=18, across='rod', cells_across=6}]", "stop.time='8 us'", "output.vtk_interval='2 us'",
    "tracer=[" + ", ".join(f"{{name='t{n}', r='{r} m', z='{z} m'}}" for n, (r, z) in enumerate(TRACERS)) + "]",
]
LINES = vtkXMLPolyDataReader
#: VTK's readers of the files of every series
SERIES = {"series.pvd": vtkXMLRectilinearGridReader, "interfaces.pvd": LINES, "tracers.pvd": LINES}


@pytest.fixture(scope="module")
def shot(tmp_path_factory):
    directory = tmp_path_factory.mktemp("runs") / "shot"
    run(decks.load(QUICK, SHOT), directory, quiet=True)
    return hydro2d.open_run(directory)


def collection(shot, name):
    """Times and files of a .pvd, read as ParaView does."""
    root = ElementTree.parse(shot.directory / name).getroot()
    assert (root.tag, root.get("type")) == ("VTKFile", "Collection")
    sets = root.findall("./Collection/DataSet")
    assert [(each.get("part"), each.get("group")) for each in sets] == [("0", "")] * len(sets)
    return [(float(each.get("timestep")), shot.directory / each.get("file")) for each in sets]


def reader(shot, number, name="series.pvd"):
    """VTK's reader of one file of a series, updated."""
    read = SERIES[name]()
    file = str(collection(shot, name)[number][1])
    assert read.CanReadFile(file)
    read.SetFileName(file)
    read.Update()
    assert read.GetErrorCode() == 0
    return read


def arrays(data):
    """Cell arrays by name."""
    return {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}


def parts(read, cap=True):
    """Extract CTH Parts with the settings of the page: the filter, and the surfaces by array."""
    extract = vtkExtractCTHPart()
    extract.SetInputConnection(read.GetOutputPort())
    for name in arrays(read.GetOutput().GetCellData()):
        if name.startswith("Volume Fraction for "):
            extract.AddVolumeArrayName(name)
    extract.SetVolumeFractionSurfaceValue(0.5)
    extract.SetGenerateTriangles(False)
    extract.SetCapping(cap)
    extract.Update()
    surfaces = extract.GetOutput()
    names = [surfaces.GetMetaData(k).Get(vtkCompositeDataSet.NAME()) for k in range(surfaces.GetNumberOfBlocks())]
    return extract, {name: surfaces.GetBlock(k) for k, name in enumerate(names)}


def volume_of_rod(dump):
    """From volume fractions and the cells' volumes, m3."""
    area = np.pi * np.diff(dump.r_edges**2)
    return np.sum(dump.fields["Volume Fraction for rod"] * np.diff(dump.z_edges)[:, None] * area)


@pytest.mark.parametrize("name", SERIES)
def test_series(shot, name):
    """Times rise, every file exists and has its time, and all series have the same times."""
    entries = collection(shot, name)
    times = [time for time, _ in entries]
    assert times == [time for time, _ in shot.dumps]
    assert times == sorted(set(times))
    assert len(times) == 5
    for number, time in enumerate(times):
        stamp = reader(shot, number, name).GetOutput().GetFieldData().GetArray("TimeValue")
        assert (stamp.GetNumberOfTuples(), stamp.GetValue(0)) == (1, time)


def test_every_grid_is_whole(shot):
    nz, nr = shot.dump().fields["Material"].shape
    for number in range(5):
        grid = reader(shot, number).GetOutput()
        assert grid.GetDimensions() == (nr + 1, nz + 1, 1)
        assert grid.GetPointData().GetNumberOfArrays() == 0
        fields = arrays(grid.GetCellData())
        assert {len(values) for values in fields.values()} == {nz * nr}
        assert all(np.isfinite(values).all() for values in fields.values())


def test_the_grid_of_the_series_moves(shot):
    """The mesh follows the rod: each file has its own coordinates, and pyvista's reader of the series gives them by time."""
    import pyvista

    lows = [reader(shot, number).GetOutput().GetBounds()[2] for number in range(5)]
    assert lows[0] == pytest.approx(-24e-3)
    assert np.diff(lows) == pytest.approx(SPEED * 2e-6, rel=0.2)
    whole = pyvista.get_reader(shot.directory / "series.pvd")
    for number, time in enumerate(whole.time_values):
        whole.set_active_time_point(number)
        block = whole.read()[0]
        assert time == shot.dumps[number][0]
        assert block.bounds.y_min == pytest.approx(lows[number])
        assert block["Volume Fraction for rod"].max() == pytest.approx(1.0)


def test_the_page_names_what_the_files_have(shot):
    """Every array and every series that the page names, in backquotes, exists, and so do the columns of the history."""
    read, tracers = reader(shot, 0), reader(shot, 0, "tracers.pvd").GetOutput().GetPointData()
    part = parts(read)[1]["Volume Fraction for rod"].GetPointData()
    have = {*arrays(read.GetOutput().GetCellData()), *arrays(tracers), *arrays(part)}
    named = set(re.findall(r"`([A-Z][^`]+)`", PAGE))
    assert len(named) > 6
    assert named - have == set()
    assert set(re.findall(r"`([a-z]+\.pvd)`", PAGE)) == set(SERIES)
    columns = set(re.findall(r"`(tracer_NAME_\w+)`", PAGE))
    assert columns <= {name.replace("t0", "NAME") for name in shot.history if name.startswith("tracer_t0")}
    assert len(columns) == 2


@pytest.mark.parametrize("number", range(5))
def test_part_surfaces_are_the_bodies(shot, number):
    """Radius, ends and volume of the rod, the faces of the plate; blocks in alphabetical order, as the page says."""
    _, surfaces = parts(reader(shot, number))
    assert list(surfaces) == ["Volume Fraction for plate", "Volume Fraction for rod"]
    time, dump = shot.dumps[number][0], shot.dump(shot.dumps[number][0])
    depth, length, radius = (
        np.interp(time, shot.history["time"], shot.history[name])
        for name in ("penetration_depth_m", "rod_length_m", "rod_max_radius_m")
    )
    low_r, high_r, low_z, high_z, *_ = surfaces["Volume Fraction for rod"].GetBounds()
    assert low_r == pytest.approx(0.0, abs=1e-9)
    assert high_r == pytest.approx(radius, abs=CELL)
    assert (low_z, high_z) == pytest.approx((depth - length, depth), abs=CELL)
    middles, areas = faces(surfaces["Volume Fraction for rod"])
    assert 2 * np.pi * np.sum(middles[:, 0] * areas) == pytest.approx(volume_of_rod(dump), rel=0.01)
    low_r, high_r, low_z, high_z, *_ = surfaces["Volume Fraction for plate"].GetBounds()
    assert (low_r, high_r, high_z) == pytest.approx((0.0, dump.r_edges[-1], THICKNESS), abs=CELL)
    assert low_z < CELL


def faces(surface):
    """Middles (n, 3) and areas (n,) of the triangles of a surface."""
    triangles = vtkTriangleFilter()
    triangles.SetInputData(surface)
    triangles.PassLinesOff()
    triangles.Update()
    data = triangles.GetOutput()
    corners = vtk_to_numpy(data.GetPoints().GetData())[vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return corners.mean(axis=1), 0.5 * np.linalg.norm(across, axis=1)


def test_at_the_start_the_rod_is_that_of_the_deck(shot):
    low_r, high_r, low_z, high_z, *_ = parts(reader(shot, 0))[1]["Volume Fraction for rod"].GetBounds()
    assert (high_r, low_z, high_z) == pytest.approx((RADIUS, -LENGTH, 0.0), abs=0.1 * CELL)


def turned(extract, angle):
    """Rotational Extrusion of the parts about the axis of symmetry by an angle in degrees: that of the rod."""
    extrude = vtkRotationalExtrusionFilter()
    extrude.SetInputConnection(extract.GetOutputPort())
    extrude.SetRotationAxis(0.0, 1.0, 0.0)
    extrude.SetAngle(angle)
    extrude.SetResolution(60)
    extrude.CappingOff()
    extrude.Update()
    return extrude.GetOutputDataObject(0).GetBlock(1)


@pytest.mark.parametrize("number", [0, 4])
def test_the_turned_part_is_the_solid(shot, number):
    """Its volume is the rod's mass over its density if only the outlines are turned; with caps every surface appears twice."""
    extract, surfaces = parts(reader(shot, number), cap=False)
    assert surfaces["Volume Fraction for rod"].GetNumberOfPolys() == 0
    triangles = vtkTriangleFilter()
    triangles.SetInputData(turned(extract, 360.0))
    triangles.Update()
    solid = triangles.GetOutput()
    measured = vtkMassProperties()
    measured.SetInputData(solid)
    mass, density = shot.summary["rod_mass_kg"], 18160.0
    assert measured.GetVolume() == pytest.approx(mass / density, rel=0.02)
    low_x, high_x, _, _, low_z, high_z = solid.GetBounds()
    assert (-low_x, -low_z, high_z) == pytest.approx((high_x,) * 3, rel=0.01)


def test_a_cut_away_ends_where_the_turned_section_is(shot):
    """The page's Rotate 0 270 0 brings the section to the last line of an extrusion by 270 degrees."""
    extract, surfaces = parts(reader(shot, 2), cap=False)
    lines = vtk_to_numpy(surfaces["Volume Fraction for rod"].GetPoints().GetData())
    ends = vtk_to_numpy(turned(extract, 270.0).GetPoints().GetData())[-len(lines) :]
    turn = vtkTransform()
    turn.RotateY(270.0)
    np.testing.assert_allclose(ends, [turn.TransformPoint(point) for point in lines], atol=1e-8)


def test_the_mirrored_half_has_mirrored_velocities(shot):
    """Velocity is marked as the vector; the two of a contact need the filter's option."""
    read = reader(shot, 3)
    half = arrays(read.GetOutput().GetCellData())
    assert half["Velocity [m/s]"][:, 0].max() > 100.0
    for everything in (False, True):
        reflect = vtkReflectionFilter()
        reflect.SetInputConnection(read.GetOutputPort())
        reflect.SetPlaneToXMin()
        reflect.SetFlipAllInputArrays(everything)
        reflect.Update()
        whole, bounds = arrays(reflect.GetOutput().GetCellData()), reflect.GetOutput().GetBounds()
        assert bounds[0] == -bounds[1]
        for name, values in half.items():
            flips = name == "Velocity [m/s]" or (everything and name.startswith("Velocity"))
            np.testing.assert_array_equal(whole[name], np.concatenate([values, values * [-1, 1, 1] if flips else values]))


def test_the_newer_filter_mirrors_alike(shot):
    new = getattr(vtkFiltersGeneral, "vtkAxisAlignedReflectionFilter", None)
    if new is None:
        pytest.skip("this VTK does not have it yet")
    read, reflect = reader(shot, 3), new()
    velocity = arrays(read.GetOutput().GetCellData())["Velocity [m/s]"]
    reflect.SetInputConnection(read.GetOutputPort())
    reflect.SetPlaneModeToXMin()
    reflect.Update()
    grids, each = [], reflect.GetOutputDataObject(0).NewIterator()
    while not each.IsDoneWithTraversal():
        grids.append(arrays(each.GetCurrentDataObject().GetCellData())["Velocity [m/s]"])
        each.GoToNextItem()
    assert sorted(values[:, 0].max() for values in grids) == sorted([velocity[:, 0].max(), -velocity[:, 0].min()])


def test_outlines_are_lines_round_the_bodies(shot):
    data = reader(shot, 0, "interfaces.pvd").GetOutput()
    points, bodies = vtk_to_numpy(data.GetPoints().GetData()), vtk_to_numpy(data.GetCellData().GetArray("Material"))
    assert data.GetNumberOfCells() == data.GetNumberOfLines()
    assert bodies.tolist() == [1, 2, 2]  # the rod, the faces of the plate
    ends = vtk_to_numpy(data.GetLines().GetOffsetsArray())
    rod = points[vtk_to_numpy(data.GetLines().GetConnectivityArray())[ends[0] : ends[1]]]
    assert (rod[:, 0].max(), rod[:, 1].min(), rod[:, 1].max()) == pytest.approx((RADIUS, -LENGTH, 0.0), abs=0.5 * CELL)
    assert rod[[0, -1], 0] == pytest.approx([0.0, 0.0])


class Tracers(VTKPythonAlgorithmBase):
    """The series of tracers as a source with time, as ParaView's reader of .pvd files is one."""

    def __init__(self, shot):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")
        self.shot, self.times = shot, [time for time, _ in collection(shot, "tracers.pvd")]

    def RequestInformation(self, request, inputs, outputs):
        outputs.GetInformationObject(0).Set(Pipeline.TIME_STEPS(), self.times, len(self.times))
        outputs.GetInformationObject(0).Set(Pipeline.TIME_RANGE(), [self.times[0], self.times[-1]], 2)
        return 1

    def RequestData(self, request, inputs, outputs):
        wanted = outputs.GetInformationObject(0).Get(Pipeline.UPDATE_TIME_STEP())
        data = vtkDataObject.GetData(outputs)
        data.ShallowCopy(reader(self.shot, self.times.index(wanted), "tracers.pvd").GetOutput())
        data.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), wanted)
        return 1


def test_tracers_are_points_where_the_deck_puts_them_and_go_with_the_material(shot):
    data = reader(shot, 0, "tracers.pvd").GetOutput()
    assert data.GetNumberOfVerts() == 3
    assert vtk_to_numpy(data.GetPointData().GetArray("Tracer")).tolist() == [0, 1, 2]
    points = vtk_to_numpy(data.GetPoints().GetData())
    assert points[:, :2].tolist() == TRACERS
    assert not points[:, 2].any()
    time = shot.dumps[1][0]
    moved = vtk_to_numpy(reader(shot, 1, "tracers.pvd").GetOutput().GetPoints().GetData())
    assert moved[0, :2] == pytest.approx([0.0, TRACERS[0][1] + SPEED * time], abs=1e-5)  # no wave has arrived yet
    assert moved[2, :2] == pytest.approx(TRACERS[2], abs=1e-6)


def test_paths_of_tracers(shot):
    """One line for each tracer, with a point for each dump in which it moved, once the mask lets all pass."""
    tracers = Tracers(shot)
    paths = vtkTemporalPathLineFilter()
    paths.SetInputConnection(tracers.GetOutputPort())
    paths.SetIdChannelArray("Tracer")
    paths.SetMaskPoints(1)
    paths.SetMaxTrackLength(1000)
    for time in tracers.times:
        paths.UpdateTimeStep(time)
    data = paths.GetOutput()
    assert np.diff(vtk_to_numpy(data.GetLines().GetOffsetsArray())).tolist() == [5, 5, 4]
    rod = vtk_to_numpy(data.GetPoints().GetData())[vtk_to_numpy(data.GetLines().GetConnectivityArray())[:5]]
    assert rod[0, :2] == pytest.approx(TRACERS[0])
    assert np.diff(rod[:, 1]) == pytest.approx(SPEED * np.diff(tracers.times), rel=0.1)


@pytest.mark.parametrize(("name", "lowest", "highest"), [("Velocity of Hard Bodies [m/s]", 0.5, 1.0),
                                                         ("Velocity of Soft Bodies [m/s]", 0.0, 0.5)])
def test_glyphs_of_both_velocities(shot, name, lowest, highest):
    """One arrow in every cell on its side of the interface; on the other side the velocity is zero."""
    read = reader(shot, 4)
    side = vtkThreshold()
    side.SetInputConnection(read.GetOutputPort())
    side.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "Share of Hard Bodies")
    side.SetLowerThreshold(lowest)
    side.SetUpperThreshold(highest)
    middles = vtkCellCenters()
    middles.SetInputConnection(side.GetOutputPort())
    glyphs = vtkGlyph3D()
    glyphs.SetInputConnection(middles.GetOutputPort())
    glyphs.SetInputArrayToProcess(1, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, name)
    glyphs.SetVectorModeToUseVector()
    glyphs.SetScaleModeToScaleByVector()
    glyphs.SetScaleFactor(1e-6)
    glyphs.Update()
    fields = arrays(read.GetOutput().GetCellData())
    share, velocity = fields["Share of Hard Bodies"], fields[name]
    inside = (share >= lowest) & (share <= highest)
    assert glyphs.GetOutput().GetNumberOfCells() == inside.sum() > 0
    ends = vtk_to_numpy(glyphs.GetOutput().GetPoints().GetData()).reshape(inside.sum(), 2, 3)
    np.testing.assert_allclose(ends[:, 1] - ends[:, 0], velocity[inside] * 1e-6, atol=1e-8)
    assert not velocity[share == (0.0 if lowest else 1.0)].any()
    if lowest:
        assert np.median(velocity[inside], axis=0)[1] == pytest.approx(shot.summary["rod_mean_velocity_m_s"], rel=0.03)


def test_cell_values_lie_in_the_middle_of_cells(shot):
    """Averaged to points, as for smooth colours, a pressure peak is lower: the caution of the page."""
    read = reader(shot, 1)
    smooth = vtkCellDataToPointData()
    smooth.SetInputConnection(read.GetOutputPort())
    smooth.Update()
    peak = arrays(read.GetOutput().GetCellData())["Pressure [Pa]"].max()
    points = vtk_to_numpy(smooth.GetOutput().GetPointData().GetArray("Pressure [Pa]"))
    assert points.max() < peak
    assert points.min() > arrays(read.GetOutput().GetCellData())["Pressure [Pa]"].min()
