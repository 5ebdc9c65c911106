"""The history is complete, carries units, and opens in xarray."""

import h5py
import numpy as np
import pytest

from hydro2d.output.history import History, HistoryError, read, unit, write_csv
from hydro2d.output.station_arrays import KEYS, KINDS


def filled(path, rows=5):
    history = History(path)
    for k in range(rows):
        history.append({"time": 1e-6 * k, "cycle": k, "rod_length_m": 0.1 / 3 * k, "regime": "eroding"})
    history.write()
    return history


def test_its_root_says_what_it_is_of(tmp_path):
    history = filled(tmp_path / "history.h5")
    history.about = {"title": "a \0 title, µ", "version": "hydro2d 1", "deck": "x" * 70_000}
    history.write()
    with h5py.File(tmp_path / "history.h5") as file:
        assert dict(file.attrs) == {"title": "a   title, µ", "version": "hydro2d 1"}
    assert len(read(tmp_path / "history.h5")["time"]) == 5


def test_xarray_opens_it(tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    filled(tmp_path / "history.h5")
    with xarray.open_dataset(tmp_path / "history.h5", engine="h5netcdf") as data:
        assert data["rod_length_m"].dims == ("time",)
        assert data["rod_length_m"].attrs["units"] == "m"
        assert data["regime"].attrs["flag_meanings"] == "rigid deforming eroding left_the_mesh"
        assert data["time"].values[3] == 3e-6
        assert int(data["regime"][0]) == 2


def test_bits_survive(tmp_path):
    filled(tmp_path / "history.h5")
    assert read(tmp_path / "history.h5")["rod_length_m"].tolist() == [0.1 / 3 * k for k in range(5)]


def test_rows_after_the_restart_point_are_dropped(tmp_path):
    filled(tmp_path / "history.h5")
    history = History(tmp_path / "history.h5", rows=3)
    history.append({"time": 9e-6, "cycle": 9, "rod_length_m": 0.0, "regime": "rigid"})
    history.write()
    assert read(tmp_path / "history.h5")["cycle"].tolist() == [0, 1, 2, 9]


def test_a_quantity_that_appears_later_is_nan_before(tmp_path):
    history = filled(tmp_path / "history.h5", 2)
    history.append({"time": 3e-6, "sink_outflow_mass_kg": 1.0})
    history.write()
    columns = read(tmp_path / "history.h5")
    assert np.isnan(columns["sink_outflow_mass_kg"]).tolist() == [True, True, False]
    assert columns["cycle"].tolist() == [0, 1, -1]


def test_dimension_scale(tmp_path):
    filled(tmp_path / "history.h5")
    with h5py.File(tmp_path / "history.h5") as file:
        assert file["rod_length_m"].dims[0][0].name == "/time"


@pytest.mark.parametrize(
    ("name", "expected"),
    [("dt", "s"), ("rod_tail_velocity_m_s", "m/s"), ("x_N_s", "N s"), ("x_kg", "kg"), ("x_J", "J"), ("cycle", "1"),
     ("rod_max_plastic_strain", "1"), ("mass_change_rod", "1")],
)
def test_units(name, expected):
    assert unit(name) == expected


def test_no_history(tmp_path):
    with pytest.raises(HistoryError):
        read(tmp_path / "none.h5")
    (tmp_path / "foreign.h5").write_text("time,depth\n")
    with pytest.raises(HistoryError):
        read(tmp_path / "foreign.h5")


def test_a_history_claims_no_more_than_its_file_holds(tmp_path):
    """Values that unpack to far more than the file, in one column or many, and texts that share one place in the file."""
    path = tmp_path / "history.h5"
    for columns, rows in ((1, 6_000_000), (300, 8000)):
        filled(path)
        with h5py.File(path, "a") as file:
            for n in range(columns):
                file.create_dataset(f"x{n}", data=np.zeros(rows), compression="gzip", chunks=(rows,))
        assert path.stat().st_size < rows * columns / 3
        with pytest.raises(HistoryError, match=r"it claims \d+ bytes of values, more than its \d+ bytes can hold"):
            read(path)
    filled(path)
    with h5py.File(path, "a") as file:
        at = file.create_dataset("gauge", data=[100_000 * "x", *(5000 * ["a"])], dtype=h5py.string_dtype()).id.get_offset()
    data = path.read_bytes()
    path.write_bytes(data[:at] + 5001 * data[at : at + 16] + data[at + 5001 * 16 :])
    with pytest.raises(HistoryError, match="it claims 500"):
        read(path)


def test_csv(tmp_path):
    filled(tmp_path / "history.h5")
    write_csv(read(tmp_path / "history.h5"), tmp_path / "history.csv")
    lines = (tmp_path / "history.csv").read_text().splitlines()
    assert lines[0].startswith("time [s],cycle [1],regime [1],rod_length_m [m]")
    assert float(lines[3].split(",")[3]) == 0.1 / 3 * 2


def with_stations(path, number, rows=4):
    """A history of so many gauges and tracers, in each of which a quantity is the number of its station and of its row."""
    history = History(path)
    names = [f"{kind}_p{n}_{key}" for n in range(number) for kind in KINDS for key in KEYS]
    for row in range(rows):
        history.append({"time": 1e-6 * row, "cycle": row, **{name: n + 0.25 * row for n, name in enumerate(names)}})
    history.write()
    return names


def test_thousands_of_stations(tmp_path):
    """As datasets of their own, 288 of them overflowed an attribute of the time."""
    names = with_stations(tmp_path / "history.h5", 3000)
    columns = read(tmp_path / "history.h5")
    assert set(columns) == {"time", "cycle", *names}
    assert [columns[names[n]].tolist() for n in (0, 40_000)] == [[n + 0.25 * row for row in range(4)] for n in (0, 40_000)]
    again = History(tmp_path / "history.h5", rows=3)
    again.append({"time": 1.0, **dict.fromkeys(names, 7.0)})
    again.write()
    assert read(tmp_path / "history.h5")[names[-1]].tolist()[2:] == [columns[names[-1]][2], 7.0]


def test_xarray_opens_thousands_of_stations(tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    names = with_stations(tmp_path / "history.h5", 3000)
    with xarray.open_dataset(tmp_path / "history.h5", engine="h5netcdf") as data:
        assert data["gauge_pressure_Pa"].dims == ("time", "gauge")
        assert data["gauge_pressure_Pa"].attrs["units"] == "Pa"
        value = data["gauge_pressure_Pa"].sel(gauge="p2999", time=1e-6)
        assert float(value) == names.index("gauge_p2999_pressure_Pa") + 0.25


@pytest.mark.thorough
def test_more_columns_than_an_attribute_of_64_kib_refers_to(tmp_path):
    history = History(tmp_path / "history.h5")
    history.append({"time": 0.0, **{f"mine_{n}": float(n) for n in range(4200)}})
    history.write()
    assert read(tmp_path / "history.h5")["mine_4199"].tolist() == [4199.0]


def test_a_file_with_a_dataset_for_each_column_of_a_station(tmp_path):
    """Files of earlier versions have this form."""
    names = [f"gauge_wall_{key}" for key in KEYS]
    with h5py.File(tmp_path / "history.h5", "w") as file:
        for name in ("time", *names):
            file[name] = np.arange(3.0)
    assert set(read(tmp_path / "history.h5")) == {"time", *names}
    assert len(History(tmp_path / "history.h5", rows=2)) == 2
