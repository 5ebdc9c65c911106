"""Plate impacts of 5083: how a record is read, the table of the page, and what the page says of it."""

import numpy as np
import pytest

import hydro2d
from problems import kept
from problems.validation import plate_impacts
from problems.validation.plate_impacts import Features


def made_up(pull_back=60.0):
    """A record of straight pieces: elastic front 70 m/s, ramp, plastic front at 0.3 us, plateau 200 m/s, release at 1.2 us."""
    time = np.array([-0.1, -0.002, 0.005, 0.29, 0.31, 1.2, 1.4, 1.6])
    velocity = np.array([0.0, 0.0, 70.0, 80.0, 200.0, 200.0, 200.0 - pull_back, 190.0])
    grid = np.linspace(-0.1, 1.6, 3401)
    return grid + 5.0, np.interp(grid, time, velocity)


def test_numbers_of_a_record():
    found = plate_impacts.features(*made_up())
    assert found.front == pytest.approx(70.0 + 10.0 * 0.025 / 0.285, abs=0.1)
    assert found.delay == pytest.approx(0.3, abs=0.002)
    assert found.ramp == pytest.approx(10.0 * (0.7 * 0.3 - 0.03) / 0.285, abs=0.1)
    assert found.rise == pytest.approx(0.5 * 0.02 * 129.0 / 120.0, rel=0.02)
    assert (found.plateau, found.pull_back) == pytest.approx((200.0, 60.0), abs=0.1)
    assert found.release == pytest.approx(1.2 + 0.2 * 10.0 / 60.0, abs=0.002)


@pytest.mark.parametrize(("record", "message"), [
    ((np.linspace(0.0, 2.0, 50), np.zeros(50)), "does not rise through 20 m/s"),
    (tuple(each[:2000] for each in made_up()), "ends before the release"),
    (made_up(pull_back=15.0), "nothing has spalled"),
])
def test_a_record_without_a_feature_is_refused(record, message):
    with pytest.raises(ValueError, match=message):
        plate_impacts.features(*record)


def test_the_table_of_the_page_is_that_of_the_kept_rows():
    assert plate_impacts.main(["--check"]) == 0
    assert {row["method"] for row in ROWS} == {hydro2d.METHOD}
    assert len(ROWS) == 15


ROWS = kept.rows(plate_impacts.KEPT, plate_impacts.COLUMNS)
MEASURED = {shot: plate_impacts.features(*record) for shot, record in plate_impacts.records().items()}


def ratios(name, *laws):
    """Computed over measured, of all shots and these laws, or of all."""
    return [float(row[name]) / getattr(MEASURED[row["shot"]], name) for row in ROWS if not laws or row["law"] in laws]


def test_statements_of_the_page():
    slow = [row for row in ROWS if row["shot"] != "106S"]
    assert max(abs(float(row["front"]) / MEASURED[row["shot"]].front - 1.0) for row in slow) < 0.11
    assert all(0.835 <= float(row["front"]) / MEASURED["106S"].front <= 0.96 for row in ROWS if row["shot"] == "106S")
    assert max(ratios("ramp", "published", "cap")) < 0.25
    assert all(0.22 < ratio < 0.5 for ratio in ratios("ramp", "Johnson-Cook", "Voce", "Preston-Tonks-Wallace"))
    assert all(float(row["rise"]) < MEASURED[row["shot"]].rise for row in slow)
    assert all(0.4 < ratio < 0.75 for ratio in ratios("pull_back"))
    assert all(abs(ratio - 1.0) < 0.07 for name in ("delay", "release", "plateau") for ratio in ratios(name))


def test_a_study_gives_rows_and_a_picture(tmp_path):
    deck = plate_impacts.HERE / "plate_impact_5083.toml"
    study = tmp_path / "short.toml"
    study.write_text(f"""title = "one"
deck = "{deck.as_posix()}"
[set]
"mesh.z" = [{{ to = "8.4 mm", size = "0.1 mm" }}]
[[axis]]
name = "shot"
[axis.variants]
"104S" = {{ "stop.time" = "3.3 us" }}
[[axis]]
name = "law"
[axis.variants]
"published" = {{ "materials.alloy.variant" = "published" }}
""")
    hydro2d.sweep(study, directory=tmp_path / "out", workers=1)
    (row,) = plate_impacts.rows_of(tmp_path / "out")
    assert row[:2] == ("104S", "published")
    found = Features(*map(float, row[2:-1]))
    assert found.plateau == pytest.approx(MEASURED["104S"].plateau, rel=0.02)
    plate_impacts.draw(tmp_path / "out", tmp_path / "drawn.png")
    assert (tmp_path / "drawn.png").stat().st_size > 10_000
