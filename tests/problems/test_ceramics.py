"""The decks of ceramics: the kept results, the tables of their page, and how dwell is read."""

from statistics import median
from types import SimpleNamespace

import numpy as np
import pytest

import hydro2d
from hydro2d.deck import deck as decks
from problems import kept
from problems.ceramics import dwell, read
from tests.rules import source

FOLDER = source.PROBLEMS / "ceramics"
TILES, DWELLS, MEMBERS = read.kept(), dwell.kept(), dwell.kept(dwell.MEMBERS)
INTERFACE = {(row["face"], int(row["velocity_m_s"])): float(row["u_m_s"]) for row in DWELLS}


def test_the_tables_of_the_page_are_those_of_the_kept_results():
    page = (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()
    assert [line for line in page if line.startswith(("| 5.5 |", "| 8.5 |", "| 11.5 |"))] == read.table(TILES)[2:]
    assert [line for line in page if line.startswith(("| cover |", "| bare |"))] == [
        *dwell.table(DWELLS)[2:], *dwell.members_table(MEMBERS)[2:]]
    assert (len(TILES), len(DWELLS), len(MEMBERS)) == (68, 12, 48)


def efficiencies(cells):
    """Differential mass efficiency of the median depth by ceramic and thickness in mm, of one mesh."""
    alone = read.references(TILES)[cells]
    return {(ceramic, float(thickness)): read.efficiency(
        alone - median(float(row["in_steel_mm"]) for row in members), float(members[0]["density_kg_m3"]), float(thickness))
        for (on, ceramic, thickness), members in read.cases(TILES).items() if on == cells and ceramic != "steel"}


def depths(cells, ceramic, thickness):
    """Depths of the members of a case, mm, in ascending order."""
    return sorted(float(row["depth_mm"]) for row in read.cases(TILES)[cells, ceramic, thickness])


def test_statements_of_the_page_on_the_tiles():
    """Alumina 1.1 to 1.2, boron carbide 4 to 5; the reference is 12 % below Odermatt's fit."""
    coarse = efficiencies("5.5")
    assert {round(coarse["alumina_995", each], 1) for each in (10, 20, 30)} == {1.1, 1.2}
    assert 4.0 < coarse["boron_carbide", 10] < coarse["boron_carbide", 20] < 5.0
    assert read.references(TILES)["5.5"] / 38.7 == pytest.approx(0.881, abs=0.005)


def test_statements_of_the_page_on_chance_and_the_mesh():
    """Boron carbide scatters as much as the mesh moves it. Steel changes by more than chance, what alumina saves does not."""
    boron = [depths(cells, "boron_carbide", "20.0") for cells in ("5.5", "8.5", "11.5")]
    assert [(each[0], each[-1]) for each in boron] == [pytest.approx(each, abs=0.05) for each in ((23.5, 25.3), (23.7, 24.9),
                                                                                               (26.6, 26.6))]
    coarse, *finer = (read.references(TILES)[cells] for cells in ("5.5", "8.5", "11.5"))
    assert [each - coarse for each in finer] == pytest.approx([0.7, 0.94], abs=0.01)
    saved = {cells: efficiencies(cells)["alumina_995", 20] for cells in ("5.5", "8.5", "11.5")}
    assert [saved[cells] / saved["5.5"] for cells in ("8.5", "11.5")] == pytest.approx([0.996, 1.005], abs=0.002)
    for ceramic, thickness in (("steel", "20.0"), ("alumina_995", "10.0"), ("alumina_995", "20.0")):
        values = depths("5.5", ceramic, thickness)
        assert values[-1] - values[0] < 0.2
    thick = depths("5.5", "alumina_995", "30.0")
    assert thick[-1] - thick[0] == pytest.approx(0.38, abs=0.005)
    assert {row["trusted"] for row in TILES} == {"yes"}


def test_statements_of_the_page_on_the_transition():
    """Without a cover the interface stands still at 0.8 and 0.9 km/s, creeps at 1.0, and penetrates from 1.2 km/s on."""
    assert max(INTERFACE["bare", 800], INTERFACE["bare", 900]) < 5.0
    assert 30.0 < INTERFACE["bare", 1000] < 80.0 < 200.0 < INTERFACE["bare", 1200]
    rod = dwell.rod_of(decks.load(FOLDER / "dwell.toml"))
    low, high = (dwell.transition(each, *rod) for each in dwell.BOUNDS)
    assert (low, high) == pytest.approx((1121.0, 1606.0), abs=1.0)
    ratios = [dwell.pressure(each, *rod) * 1e-9 / dwell.STRENGTH for each in (900.0, 1000.0)]
    assert ratios == pytest.approx([0.79, 0.90], abs=0.005)
    assert ratios[1] < dwell.BOUNDS[0]


def test_statements_of_the_page_on_the_members():
    """Without a cover it stands still at 0.9 km/s, and creeps by chance at 1.0; with it, two velocities differ by more."""
    velocities = {case: sorted(int(row["u_m_s"]) for row in rows)
                  for case, rows in kept.grouped(MEMBERS, ("face", "velocity_m_s")).items()}
    ends = {case: (speeds[0], speeds[-1]) for case, speeds in velocities.items()}
    assert [ends["bare", each] for each in ("900", "1000", "1100")] == [(1, 3), (33, 76), (103, 161)]
    assert [ends["cover", each] for each in ("900", "1000", "1100")] == [(7, 67), (123, 149), (195, 220)]
    dents = [float(row["depth_10_us_mm"]) for row in MEMBERS if (row["face"], row["velocity_m_s"]) == ("bare", "900")]
    assert (min(dents), max(dents)) == (2.2, 2.4)
    doubted = [(row["face"], row["velocity_m_s"]) for row in MEMBERS if row["trusted"] == "no"]
    assert doubted == [("bare", "1000")] * 5


def test_the_strength_is_that_of_the_library():
    tile = decks.load(FOLDER / "dwell.toml").materials["boron_carbide"].strength.values
    assert 1.5 * (tile["HEL"] - tile["P_HEL"]) * 1e-9 == pytest.approx(dwell.STRENGTH)


def test_efficiency_and_pressure():
    """A tile of steel saves its own thickness; a rod at rest presses with its strength, a fast one with rho v^2/2 and more."""
    assert read.efficiency(20.0, read.STEEL, 20.0) == 1.0
    assert dwell.pressure(0.0, 17600.0, 280e9, 1.5e9) == pytest.approx(4.905e9)
    assert dwell.pressure(1000.0, 17600.0, 280e9, 0.0) == pytest.approx(8.8e9 + 8.8e9**2 / 560e9)


def test_how_dwell_is_read(monkeypatch, tmp_path, capsys):
    """The rod dwells up to a wear of 8 mm, and then the interface moves at 200 m/s."""
    time = np.linspace(0.0, 50e-6, 501)
    depth = np.maximum(time - 10e-6, 0.0) * 200.0
    history = {"time": time, "rod_length_m": 40e-3 - 800.0 * time, "penetration_depth_m": depth,
               "rod_tail_velocity_m_s": np.full(501, 990.0)}
    summary = hydro2d.Summary(trustworthy=True, method="2026-11-29")
    run = SimpleNamespace(deck=decks.load(FOLDER / "dwell.toml"), history=history, summary=summary)
    monkeypatch.setattr(dwell, "ended", lambda directory: run)
    assert dwell.of_run(tmp_path) == ("cover", 1000, 13.86, 0.0, 2.0, 4.0, 8.0, 200, 990, "yes", "2026-11-29")
    history["rod_length_m"] = 40e-3 - 300.0 * time
    with pytest.raises(ValueError, match="the rod is worn by 15.0 mm only"):
        dwell.of_run(tmp_path)
    assert dwell.main([str(tmp_path)]) == 0  # it is reported, and other runs are read
    out, err = capsys.readouterr()
    assert out.splitlines() == [",".join(dwell.COLUMNS)]
    assert "the rod is worn by 15.0 mm only" in err


def test_a_run_that_goes_on_is_refused(monkeypatch, tmp_path):
    """Its largest depth so far is not a final depth."""
    monkeypatch.setattr(read.hydro2d, "open_run", lambda directory: SimpleNamespace(summary=hydro2d.Summary()))
    with pytest.raises(ValueError, match="has not ended"):
        read.of_run(tmp_path)
