"""VTK's own readers give back the contents of the state."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from hydro2d.materials import quantities
from hydro2d.output import derived_quantities, vtk
from hydro2d.output.series import Series
from tests import fake


def test_fields_survive_as_float32(moved, tmp_path):
    path = Series(tmp_path).dump(moved)
    dump = vtk.read_grid(path)
    assert dump.time == moved.time
    assert dump.bodies == ["rod", "plate"]
    np.testing.assert_array_equal(dump.r_edges, moved.grid.r_edges)
    np.testing.assert_array_equal(dump.z_edges, moved.grid.z_edges)
    expected = derived_quantities.evaluate(moved, ["standard"])
    assert set(dump.fields) == set(expected)
    for name, values in expected.items():
        kind = np.int32 if name == "Material" else np.float32
        assert dump.fields[name].dtype == kind
        np.testing.assert_array_equal(dump.fields[name], values.astype(kind))


def test_pyvista_sees_the_geometry(moved, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.read(Series(tmp_path).dump(moved))
    assert grid.dimensions == (13, 56, 1)
    assert grid.cell_data["Velocity [m/s]"].shape == (12 * 55, 3)
    cell = grid.find_containing_cell((0.5e-3, moved.time * fake.SPEED - 5.5e-3, 0.0))
    assert grid.cell_data["Volume Fraction for rod"][cell] == 1.0
    assert grid.cell_data["Material"][cell] == 1
    assert grid.bounds[:4] == pytest.approx((0, 12e-3, -25e-3, 30e-3))


def test_velocity_is_the_mean_of_four_vertices(moved):
    state, grid = moved.state, moved.grid
    state.v[0] = np.arange(state.v[0].size).reshape(state.v[0].shape)
    v = derived_quantities.evaluate(moved, ["velocity"])["Velocity [m/s]"]
    j, i = 7, 3
    corners = state.v[0][j + grid.g : j + grid.g + 2, i + grid.g : i + grid.g + 2]
    assert v[j, i, 1] == corners.mean()
    assert v[j, i, 2] == 0


def test_von_mises_includes_the_hoop_component(moved):
    state = moved.state
    state.srr[:], state.szz[:], state.srz[:] = 1.0, 1.0, 0.0  # then s_tt = -2, and the equivalent stress is 3
    values = derived_quantities.evaluate(moved, ["von_mises"])
    full = values["Volume Fraction for rod"] == 1
    np.testing.assert_allclose(values["Von Mises Stress [Pa]"][full], 3.0, rtol=1e-14)


def test_void_is_zero(moved):
    values = derived_quantities.evaluate(moved)
    void = values["Volume Fraction for rod"] + values["Volume Fraction for plate"] == 0
    assert void.any()
    for name in ("Density [kg/m3]", "Temperature [K]", "Density of rod [kg/m3]", "Material"):
        assert np.all(values[name][void] == 0)


def test_chosen_fields(moved, tmp_path):
    dump = vtk.read_grid(Series(tmp_path, ["pressure"]).dump(moved))
    always = {f"{of} for {body}{unit}" for body in ("rod", "plate")
              for of, unit in (("Volume Fraction", ""), ("Centroid Offset r", " [m]"), ("Centroid Offset z", " [m]"))}
    assert set(dump.fields) == {"Pressure [Pa]", "Material", *always}


def test_pyvista_opens_the_series(moved, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    Series(tmp_path).dump(moved)
    reader = pyvista.get_reader(tmp_path / "series.pvd")
    assert reader.time_values == [moved.time]
    assert reader.read()[0].n_cells == 12 * 55


def test_outlines_and_tracers(moved, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    Series(tmp_path).dump(moved)
    lines = pyvista.read(tmp_path / "vtk" / "interfaces_000000.vtp")
    assert set(lines.cell_data["Material"]) == {1, 2}
    assert lines.points[:, 0].min() == 0.0  # they reach the axis
    tracers = pyvista.read(tmp_path / "vtk" / "tracers_000000.vtp")
    np.testing.assert_allclose(tracers.points[:, :2], moved.stations.tracers)


def test_not_a_vtk_file(tmp_path):
    (tmp_path / "x.vtr").write_text("nonsense")
    for path in (tmp_path / "x.vtr", tmp_path / "none.vtr"):
        with pytest.raises(vtk.VtkError):
            vtk.read_grid(path)
    (tmp_path / "series.pvd").write_text("<VTKFile>")
    with pytest.raises(vtk.VtkError):
        vtk.read_series(tmp_path / "series.pvd")


def test_every_quantity_is_described():
    for quantity in quantities.TABLE:
        assert quantity.meaning
        assert quantity.title == quantity.title.strip()


def test_lines_are_read_as_they_were_written(tmp_path):
    lines = [(1, np.array([[0.0, 1.0], [2.0, 3.0], [0.5, 4.0]])), (2, np.array([[1.0, 1.0], [1.0, 9.0]]))]
    vtk.write_lines(tmp_path / "a.vtp", lines, 1e-6)
    read = vtk.read_lines(tmp_path / "a.vtp")
    assert [body for body, _ in read] == [1, 2]
    for (_, one), (_, other) in zip(lines, read, strict=True):
        np.testing.assert_array_equal(one, other)
    vtk.write_lines(tmp_path / "none.vtp", [], 0.0)
    assert vtk.read_lines(tmp_path / "none.vtp") == []
    (tmp_path / "b.vtp").write_text("not XML")
    with pytest.raises(vtk.VtkError, match="is not a VTK file"):
        vtk.read_lines(tmp_path / "b.vtp")


FULL = """
import resource, signal
from pathlib import Path
import numpy as np
from hydro2d.output import vtk

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, ({most}, {most}))
values, edges = np.random.default_rng(1).random((100, 100)), np.linspace(0, 1, 101)
for write in (lambda: vtk.write_grid(Path("a.vtr"), edges, edges, [("a", values)], 0.0),
              lambda: vtk.write_lines(Path("a.vtp"), [(1, values.reshape(-1, 2))], 0.0),
              lambda: vtk.write_points(Path("a.vtp"), values.reshape(-1, 2), 0.0)):
    try:
        write()
    except OSError as error:
        print(error)
"""


@pytest.mark.thorough
@pytest.mark.parametrize("most", [0, 10, 1000, 10_000])
def test_a_lack_of_space_is_reported_in_one_line_and_not_by_vtk(tmp_path, most):
    """A limit on the size of a file acts like a full disk; printed output goes through pipes."""
    command = [sys.executable, "-c", FULL.format(most=most)]
    done = subprocess.run(command, cwd=tmp_path, text=True, capture_output=True, timeout=120, check=False,
                          env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"})
    assert (done.returncode, done.stderr) == (0, "")
    assert [line.split("'")[1] for line in done.stdout.splitlines()] == ["a.vtr", "a.vtp", "a.vtp"]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("keep", [100, 1000])
def test_a_damaged_file_is_reported_in_one_line_and_not_by_vtk(tmp_path, moved, capfd, keep):
    path = Series(tmp_path).dump(moved)
    path.write_bytes(path.read_bytes()[:keep])
    for read in (vtk.read_grid, vtk.pyvista_grid):
        with pytest.raises(vtk.VtkError):
            read(path)
    assert "".join(capfd.readouterr()) == ""


def test_a_full_disk_is_named():
    """By the system's error number, from which a study knows the reason."""
    from vtkmodules.vtkCommonMisc import vtkErrorCode

    for code in (errno.ENOSPC, vtkErrorCode.OutOfDiskSpaceError):
        error = vtk._write_error(code, Path("dump.vtr"))
        assert (error.errno, error.filename) == (errno.ENOSPC, "dump.vtr")
        assert "No space left on device" in str(error)
    assert "FileFormatError" in str(vtk._write_error(vtkErrorCode.FileFormatError, Path("dump.vtr")))
