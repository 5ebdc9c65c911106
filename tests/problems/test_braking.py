"""The forces that brake a rod in its first 90 us: how a run is read, and the tables of the page."""

import numpy as np
import pytest

from hydro2d.study.plan import cases
from problems.cth_nose_shape import braking
from tests.rules import source


def test_stresses_are_means_over_the_rods_own_section():
    """Cells count by the volume of the rod in them, between 5 and 10 mm behind the tip, and nowhere else."""
    r_edges, z_edges = np.array([0.0, 1e-3, 2e-3]), np.linspace(0.0, 20e-3, 21)
    fraction = np.zeros((20, 2))
    fraction[:15, 0], fraction[:15, 1] = 1.0, 0.5
    axial, lateral = np.full((20, 2), 9e9), np.full((20, 2), 9e9)
    axial[5:10] = 1e9, 3e9
    lateral[5:10] = 0.5e9, 0.0
    stresses = braking.section(r_edges, z_edges, fraction, axial, lateral)
    assert stresses == pytest.approx(((1.0 * 1e9 + 1.5 * 3e9) / 2.5, 1.0 * 0.5e9 / 2.5))
    with pytest.raises(ValueError, match="no rod on the axis"):
        braking.section(r_edges, z_edges, 0.0 * fraction, axial, lateral)


def test_statements_of_the_page_on_the_force():
    """It hardly grows on a hemispherical nose, and by a quarter on a flat one; the law of 5083 matters less to the latter."""
    force = {(row["nose"], row["plate"], row["velocity"]): float(row["force_GPa"]) for row in braking.kept()}
    for plate, share, flat, steep in (("5083", 1.043, 1.265, 1.160), ("5083 as measured", 1.029, 1.252, 1.135),
                                      ("5083 as measured, strongest fit", 1.046, 1.197, 1.084), ("7039", 1.025, 1.217, 1.125)):
        for nose, grows in (("hemispherical", share), ("flat", flat)):
            assert force[nose, plate, "1400 m/s"] / force[nose, plate, "900 m/s"] == pytest.approx(grows, abs=0.005)
        assert force["flat", plate, "1300 m/s"] / force["flat", plate, "1100 m/s"] == pytest.approx(steep, abs=0.005)
    larger = {key[1:]: force["flat", *key[1:]] / value for key, value in force.items() if key[0] == "hemispherical"}
    assert (min(larger.values()), max(larger.values())) == pytest.approx((1.15, 1.47), abs=0.005)
    by_law = {(nose, at): force[nose, "5083 as measured", at] / force[nose, "5083", at]
              for nose in ("hemispherical", "flat") for at in ("1200 m/s", "1300 m/s")}
    assert list(by_law.values()) == pytest.approx([1.10, 1.11, 1.024, 1.036], abs=0.005)


def test_kept_rows_are_cases_of_their_study():
    plan = cases.plan(source.PROBLEMS / "cth_nose_shape/nose_force.toml", quiet=True)
    cases_kept = [(*(row[label] for label in braking.LABELS), row["member"]) for row in braking.kept()]
    assert len(set(cases_kept)) == len(cases_kept) > 0
    assert set(cases_kept) <= {(*(case.values[label] for label in braking.LABELS), str(case.member)) for case in plan.cases}


def test_a_directory_of_another_study_is_refused(tmp_path, capsys):
    assert braking.main([str(tmp_path)]) == 2
    assert str(tmp_path) in capsys.readouterr().err
