"""problems/validation/bar.py on bars of known shape."""

import json

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.files import whole
from hydro2d.output import directory as run_directory
from hydro2d.output import vtk
from problems.validation import bar

DECK = "problems/validation/copper_bar.toml"
R, Z = np.linspace(0.0, 12e-3, 61), np.linspace(0.0, 36e-3, 181)


def filled(length, foot, shank=3.2e-3, low=0.0):
    """Volume fractions of a bar: a disk of radius `foot` over the first millimetre, above it one of radius `shank`; m."""

    def shares(edges, first, last):
        return np.clip((np.minimum(edges[1:], last) - np.maximum(edges[:-1], first)) / np.diff(edges), 0.0, 1.0)

    disks = [(low, low + 1e-3, foot), (low + 1e-3, low + length, shank)]
    return sum(np.outer(shares(Z, a, b), shares(R**2, 0.0, radius**2)) for a, b, radius in disks)


def wrote(directory, bars, text=None, fields=("Volume Fraction for bar", "Plastic Strain of bar")):
    """A run directory, not ended, with dumps of bars by time in s."""
    (directory / vtk.FOLDER).mkdir(parents=True)
    whole.write_text(directory / run_directory.DECK, text or deck.load(DECK).to_toml())
    entries = []
    for number, (time, (share, strain)) in enumerate(bars.items()):
        entries.append((time, f"{vtk.FOLDER}/dump_{number:06d}.vtr"))
        vtk.write_grid(directory / entries[-1][1], R, Z, zip(fields, (share, strain), strict=True), time)
    vtk.write_series(directory / vtk.SERIES["dump"], entries)
    return directory


@pytest.fixture
def shortening(tmp_path):
    """A bar that loses 0.1 mm in every microsecond, with a foot that grows by 0.05 mm, and a strain of 0.01 per microsecond."""
    bars = {
        t * 1e-6: (share := filled(32.4e-3 - t * 1e-4, 3.2e-3 + t * 5e-5), np.where(share > 0.4, t * 0.01, 9.0))
        for t in range(0, 45, 3)
    }
    return wrote(tmp_path / "shortening", bars)


def test_shape_of_every_dump(shortening):
    measured = bar.measure(shortening)
    assert [row["time"] for row in measured["bars"]] == pytest.approx([t * 1e-6 for t in range(0, 45, 3)])
    assert [row["length"] for row in measured["bars"]] == pytest.approx([32.4e-3 - t * 1e-4 for t in range(0, 45, 3)], rel=1e-6)
    assert [row["foot"] for row in measured["bars"]] == pytest.approx([3.2e-3 + t * 5e-5 for t in range(0, 45, 3)], rel=1e-6)
    assert [row["strain"] for row in measured["bars"]] == pytest.approx([t * 0.01 for t in range(0, 45, 3)], rel=1e-6)
    assert not measured["ended"]


def test_comparison_with_the_reference_at_its_times(shortening):
    """At 20 us and 40 us, between two dumps; 80 us lie beyond the last dump."""
    measured = bar.measure(shortening)["compared"]
    assert [pair["found"]["time"] for pair in measured] == [20e-6, 40e-6]
    assert [pair["found"]["length"] for pair in measured] == pytest.approx([30.4e-3, 28.4e-3], rel=1e-6)
    assert [pair["reference"]["foot"] for pair in measured] == [6.195e-3, 7.139e-3]


def test_the_foot_is_in_front():
    share = filled(20e-3, 5e-3, low=4e-3)
    for direction, turned in ((-1.0, share), (1.0, share[::-1])):
        measured = bar.shape(R, Z, turned, np.zeros_like(share), direction, 0.0)
        assert (measured.length, measured.foot) == pytest.approx((20e-3, 5e-3), rel=1e-9)


def test_references_are_found_by_speed_and_length():
    assert bar.reference(227.0, 32.4e-3)[-1].length == 21.42e-3
    assert bar.reference(190.0, 25.4e-3)[-1].time == 60e-6
    assert bar.reference(200.0, 32.4e-3) == ()
    assert bar.reference(227.0, 25.4e-3) == ()


def test_command(shortening, tmp_path, capsys):
    assert bar.main([str(shortening)]) == 0
    out = capsys.readouterr().out
    assert "**shortening**, bar at -227 m/s, not ended" in out
    assert "| 20.0 | 30.400 | 28.063 | +8.33 % | 4.200 | 6.195 | -32.20 % | 0.20 |  |" in out
    assert bar.main([str(shortening), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["bars"] == bar.measure(shortening)["bars"]
    assert bar.main([str(shortening), "--body", "rod"]) == 2
    assert 'has no body "rod"; its bodies are bar' in capsys.readouterr().err
    assert bar.main([str(tmp_path)]) == 2
    assert "is not a run directory" in capsys.readouterr().err


def test_every_dump_without_a_reference(tmp_path, capsys):
    text = deck.load(DECK, ["body.bar.velocity=-200 m/s"]).to_toml()
    directory = wrote(tmp_path / "slower", {0.0: (filled(32.4e-3, 3.2e-3), np.zeros((180, 60)))}, text)
    assert bar.main([str(directory)]) == 0
    assert "| 0.0 | 32.400 |  |  | 3.200 |  |  | 0.00 |  |" in capsys.readouterr().out


def test_missing_fields_are_reported(tmp_path, capsys):
    fields = ("Volume Fraction for bar", "Density of bar")
    directory = wrote(tmp_path / "bare", {0.0: (filled(32.4e-3, 3.2e-3), np.zeros((180, 60)))}, fields=fields)
    assert bar.main([str(directory)]) == 2
    assert 'add "body_plastic_strain" to output.fields' in capsys.readouterr().err
