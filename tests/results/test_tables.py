"""Tables of line-outs, histories and holes: the numbers of the pictures, with units in the headings."""

import csv

import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.results import figures, line_figures, tables
from hydro2d.results.line_figures import Line
from hydro2d.results.reading import Results
from hydro2d.results.scales import FigureError
from tests.results import made_run

ALONG_Z = Line(1e-3, -10e-3, 1e-3, 60e-3)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return Results(made_run.write(tmp_path_factory.mktemp("tables") / "1086m-s", dumps=4))


def read(path):
    """Headings, and the rows, with NaN for an empty cell."""
    with path.open(encoding="utf-8", newline="") as file:
        heads, *rows = csv.reader(file)
    assert len({len(row) for row in rows} | {len(heads)}) == 1
    return heads, [[row[0], *(float(each or "nan") for each in row[1:])] for row in rows]


def test_a_line_out_has_the_numbers_of_the_picture(run, tmp_path):
    file = tmp_path / "x.csv"
    assert call(["plot", str(run.directory), "-o", str(file), "--kind", "line", "--time", "13 us", "--time", "40 us", "--line",
                 "1 mm,-1 cm,1 mm,6 cm"]) == 0
    heads, rows = read(file)
    assert heads == ["run", "t [us]", "r [mm]", "z [mm]", "Pressure [GPa]"]
    drawn = line_figures.line_outs([run], "pressure", ALONG_Z, (13e-6, 40e-6)).axes[0].lines
    times = sorted({row[1] for row in rows})
    assert times == pytest.approx([40 / 3, 40.0])
    for curve, time in zip(drawn, times, strict=True):
        numbers = np.array([row[2:] for row in rows if row[1] == time])
        np.testing.assert_allclose(numbers[:, 1], curve.get_xdata(), rtol=1e-9)
        np.testing.assert_allclose(numbers[:, 2], curve.get_ydata(), rtol=1e-9)
        assert (numbers[:, 0] == 1.0).all()
        assert np.nanmax(numbers[:, 2]) > 1.0
    assert np.isnan([row[-1] for row in rows]).any(), "void behind the rod"
    assert {row[0] for row in rows} == {"1086 m/s"}


def test_a_line_across_has_its_distance_and_units_are_plain_letters(run):
    table = tables.line_outs([run], "density", Line(0.0, -5e-3, 4e-3, 5e-3))
    assert [*table] == ["run", "t [us]", "distance [mm]", "r [mm]", "z [mm]", "Density [g/cm^3]"]
    np.testing.assert_allclose(table["distance [mm]"], np.hypot(table["r [mm]"], table["z [mm]"] + 5.0))
    assert [*tables.line_outs([run], "plastic_strain")][-1] == "Plastic Strain"


def test_a_history_has_the_numbers_of_the_picture(run, tmp_path):
    file = tmp_path / "x.CSV"
    assert call(["plot", str(run.directory), str(run.directory), "-o", str(file), "--kind", "history", "--quantity",
                 "rod_length_m", "--quantity", "rod_tail_velocity_m_s"]) == 0
    heads, rows = read(file)
    assert heads == ["run", "t [us]", "projectile length [mm]", "projectile tail velocity [m/s]"]
    drawn = [axes.lines[0] for axes in figures.histories([run], ["rod_length_m", "rod_tail_velocity_m_s"]).axes]
    assert len(rows) == 2 * len(run.history["time"])
    numbers = np.array([row[1:] for row in rows[: len(rows) // 2]])
    np.testing.assert_allclose(numbers[:, 0], drawn[0].get_xdata(), rtol=1e-9)
    for number, curve in enumerate(drawn, start=1):
        np.testing.assert_allclose(numbers[:, number], curve.get_ydata(), rtol=1e-9)
    with pytest.raises(FigureError, match='did you mean "rod_length_m"'):
        tables.histories([run], ["rod_lenght_m"])


def test_a_hole_has_the_numbers_of_the_picture(run, monkeypatch):
    holes = {"plate": (np.array([0.0, 1e-3, 3e-3]), np.array([5e-3, 4e-3, 0.0])), "whole": (np.zeros(0), np.zeros(0))}
    monkeypatch.setattr(Results, "craters", holes)
    table = tables.craters([run])
    assert table.iloc[:, 1:].to_numpy().tolist() == [["plate", 0.0, 5.0], ["plate", 1.0, 4.0], ["plate", 3.0, 0.0]]
    assert [*table] == ["run", "target", "depth below the original surface [mm]", "radius of the hole [mm]"]
    (curve, *_) = figures.craters([run]).axes[0].lines
    np.testing.assert_allclose(table.iloc[:, 2:], curve.get_xydata()[: len(table)])


def test_requests_without_a_table_are_refused(run, tmp_path, capsys):
    for arguments, said in ((["--kind", "section"], "--kind section has no table; a .csv is for --kind line, history, crater"),
                            (["--kind", "xt"], "--kind xt has no table"),
                            (["--kind", "line", "--log"], "are for pictures, not for a table"),
                            (["--kind", "line", "--colours", "0,1"], "are for pictures, not for a table"),
                            (["--kind", "line", "--line", "1 m,0,1 m,1 m"], "misses the mesh"),
                            (["--kind", "crater"], "has no crater")):
        assert call(["plot", str(run.directory), "-o", str(tmp_path / "x.csv"), *arguments]) == 2
        assert said in " ".join(capsys.readouterr().err.split())
    assert call(["plot", str(run.directory), "-o", str(tmp_path / "no" / "x.csv"), "--kind", "line"]) == 2
    assert "no such directory" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
