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
    """It grows by some per cent over 500 m/s, and less the pressure on the flank by 7 to 10 % from 1000 to 1200 m/s."""
    for plate, share, borne in (("5083", 1.04, 1.10), ("5083 as measured", 1.03, 1.08), ("7039", 1.025, 1.07)):
        here = {row["velocity"]: row for row in braking.kept() if (row["nose"], row["plate"]) == ("hemispherical", plate)}
        force = {at: float(row["force_GPa"]) for at, row in here.items()}
        left = {at: force[at] - float(row["lateral_GPa"]) for at, row in here.items()}
        assert force["1400 m/s"] / force["900 m/s"] == pytest.approx(share, abs=0.005)
        assert left["1200 m/s"] / left["1000 m/s"] == pytest.approx(borne, abs=0.01)


def test_kept_rows_are_cases_of_their_study():
    plan = cases.plan(source.PROBLEMS / "cth_nose_shape/nose_force.toml", quiet=True)
    cases_kept = [(*(row[label] for label in braking.LABELS), row["member"]) for row in braking.kept()]
    assert len(set(cases_kept)) == len(cases_kept) > 0
    assert set(cases_kept) <= {(*(case.values[label] for label in braking.LABELS), str(case.member)) for case in plan.cases}


def test_a_directory_of_another_study_is_refused(tmp_path, capsys):
    assert braking.main([str(tmp_path)]) == 2
    assert str(tmp_path) in capsys.readouterr().err
