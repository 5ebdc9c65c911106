"""The dumps of a run directory and the lists of their times."""

from hydro2d.output import vtk
from hydro2d.output.series import Series


def test_series(moved, tmp_path):
    series = Series(tmp_path)
    times = []
    for _ in range(4):
        series.dump(moved)
        times.append(moved.time)
        moved.step()
    assert [time for time, _ in vtk.read_series(tmp_path / "series.pvd")] == times
    kept = Series(tmp_path, dumps=2)
    assert len(kept) == 2
    for name in ("series.pvd", "interfaces.pvd", "tracers.pvd"):
        entries = vtk.read_series(tmp_path / name)
        assert [time for time, _ in entries] == times[:2]
        assert all((tmp_path / file).exists() for _, file in entries)
    assert len(list((tmp_path / "vtk").iterdir())) == 6
