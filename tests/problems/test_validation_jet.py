"""problems/validation/jet.py on known flows."""

import json

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.files import whole
from hydro2d.materials import library
from hydro2d.output import directory as run_directory
from hydro2d.output import vtk
from problems.validation import jet

DECK = "problems/validation/jet_w_5083_2.toml"
CELL = 0.5e-3
R, Z = np.arange(4) * CELL, np.linspace(-55e-3, 130e-3, 371)
BODIES = ("jet", "target")
FIELDS = [f"{word} {body}{unit}" for word, unit in (("Volume Fraction for", ""), ("Pressure of", " [Pa]")) for body in BODIES]


@pytest.mark.parametrize(
    ("rod", "target", "velocity", "u", "p"),
    [
        ("W_alloy", "Al5083", 2000.0, 1443.84, 2.822e9),
        ("W_alloy", "Al5083", 3000.0, 2161.46, 6.453e9),
        ("W_alloy", "Al5083", 5000.0, 3583.99, 18.748e9),
        ("W_alloy", "Al7039", 2000.0, 1435.55, 2.907e9),
        ("copper_OFHC", "Al5083", 5000.0, 3216.71, 14.867e9),
        ("copper_OFHC", "copper_OFHC", 3000.0, 1500.0, 10.388e9),
    ],
)
def test_compressible_bernoulli(rod, target, velocity, u, p):
    """Against an independent solution; slow jets have the velocity and pressure of incompressible ones."""
    computed = jet.bernoulli(library.load(rod), library.load(target), velocity)
    assert computed == pytest.approx((u, p), rel=3e-4)
    densities = [library.load(name).reference_density for name in (rod, target)]
    slow = 50.0 / (1.0 + (densities[1] / densities[0]) ** 0.5)
    assert jet.bernoulli(library.load(rod), library.load(target), 50.0) == pytest.approx(
        (slow, 0.5 * densities[1] * slow**2), rel=1e-3
    )


def column(position, peaks=(3e9, 2.8e9)):
    """Volume fractions of jet and target on the axis, and pressures that are parabolas about the interface."""
    share = np.clip((position - Z[:-1]) / np.diff(Z), 0.0, 1.0)
    x = 0.5 * (Z[1:] + Z[:-1]) - position
    return share, 1.0 - share, peaks[0] - 1e14 * x**2, peaks[1] - 4e13 * x**2


@pytest.mark.parametrize("position", [10e-3, 10.13e-3, 10.49e-3])
def test_the_interface_and_its_pressures(position):
    share, rest, own, other = column(position)
    interface = jet.point(Z, share, rest, (own, other), 3e-3, 0.0)
    assert interface.position == pytest.approx(position, abs=1e-12)
    assert (interface.jet, interface.target) == pytest.approx((3e9, 2.8e9), rel=1e-12)


def test_mixed_cells_and_their_neighbours_have_no_say():
    share, rest, own, other = column(10.2e-3)
    mixed = int(np.nonzero((share > 0) & (share < 1))[0][0])
    own[mixed - 1 : mixed + 2] = other[mixed - 1 : mixed + 2] = 1e12
    interface = jet.point(Z, share, rest, (own, other), 3e-3, 0.0)
    assert (interface.jet, interface.target) == pytest.approx((3e9, 2.8e9), rel=1e-12)


def test_without_jet_or_target_there_is_no_interface():
    share, rest, own, other = column(10e-3)
    assert jet.point(Z, 0.0 * share, rest, (own, other), 3e-3, 0.0) is None
    assert jet.point(Z, share, 0.0 * rest, (own, other), 3e-3, 0.0) is None
    assert jet.point(Z, np.where(Z[:-1] > 8.9e-3, share, 0.0), rest, (own, other), 3e-3, 0.0) is None  # two cells of jet
    assert jet.point(Z, np.where(Z[:-1] > 7.9e-3, share, 0.0), rest, (own, other), 0.0, 0.0).jet == pytest.approx(3e9)


@pytest.fixture
def steady(tmp_path):
    """A jet that penetrates at 1440 m/s, dumped every microsecond until 60 us."""
    directory = tmp_path / "steady"
    (directory / vtk.FOLDER).mkdir(parents=True)
    whole.write_text(directory / run_directory.DECK, deck.load(DECK).to_toml())
    entries = []
    for number in range(61):
        entries.append((number * 1e-6, f"{vtk.FOLDER}/dump_{number:06d}.vtr"))
        values = (np.repeat(each[:, None], 3, axis=1) for each in column(1440.0 * entries[-1][0]))
        vtk.write_grid(directory / entries[-1][1], R, Z, zip(FIELDS, values, strict=True), entries[-1][0])
    vtk.write_series(directory / vtk.SERIES["dump"], entries)
    return directory


def test_a_steady_flow(steady):
    measured = jet.measure(steady)
    assert measured["exact"] == pytest.approx({"velocity": 1443.84, "pressure": 2.822e9}, rel=3e-4)
    assert [row["depth"] for row in measured["rows"]] == [k + 0.5 for k in range(9)]
    for row in (*measured["rows"], measured["steady"]):
        assert row["velocity"] == pytest.approx(1440.0, rel=1e-5)
        assert (row["jet"], row["target"]) == pytest.approx((3e9, 2.8e9), rel=1e-5)
        assert row["jet_scatter"] < 1e-5 * row["jet"]
    assert measured["steady"]["dumps"] == 40  # 30 mm are passed after 20.8 us
    assert not measured["ended"]


def test_command(steady, tmp_path, capsys):
    assert jet.main([str(steady), "--first", "5", "--last", "8"]) == 0
    out = capsys.readouterr().out
    assert "**steady**, 2000 m/s, `ke`, not ended; compressible Bernoulli: 1443.84 m/s, 2.822 GPa" in out
    assert "| 5 to 8 | 1440.0 (-0.27 %) | 3.000 (+6.3 %, scatter 0.0 %) | 2.800 (-0.8 %, scatter 0.0 %) |" in out
    assert jet.main([str(steady), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["rows"] == jet.measure(steady)["rows"]
    assert jet.main([str(tmp_path)]) == 2
    assert "is not a run directory" in capsys.readouterr().err


def test_a_bar_is_no_jet(tmp_path, capsys):
    whole.write_text(tmp_path / run_directory.DECK, deck.load("problems/validation/copper_bar.toml").to_toml())
    assert jet.main([str(tmp_path)]) == 2
    assert "has no jet that flies towards +z" in capsys.readouterr().err
