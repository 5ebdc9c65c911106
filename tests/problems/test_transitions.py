"""The velocity at which half of the hemispherical rods lose a third of their length: how it is found, and the page's table."""

import pytest

from hydro2d.study import cases
from problems import kept
from problems.cth_nose_shape import transitions
from tests.rules import source

PAGE = source.ROOT / "docs/explanation/rigid-rod.md"
ROWS = kept.rows(transitions.FILE, transitions.COLUMNS)


def rows(law, plate, **outcomes):
    """Rows with velocity and share of the length."""
    return [{"law": law, "plate": plate, "velocity_m_s": f"{velocity:g}", "length_left": f"{left}", "depth_cm": "1"}
            for velocity, left in outcomes["runs"]]  # fmt: skip


def test_the_velocity_lies_between_what_kept_and_what_lost():
    runs = [(1000, 0.99), (1050, 0.98), (1100, 0.97), (1150, 0.6), (1200, 0.9), (1250, 0.3), (1300, 0.2), (1350, 0.1)]
    found = rows("a", "5083", runs=runs)
    fit = transitions.found(found)
    assert 1125.0 < fit.v50 < 1225.0
    line = transitions.table(found)[2]
    assert line.startswith("| a | 5083 | 1086 to 1200 m/s | 1175 m/s |")
    assert line.endswith("| 1200, 1150 m/s | 8 |")
    assert transitions.kept({"length_left": "0.667"})
    assert not transitions.kept({"length_left": "0.666"})


def test_runs_that_do_not_tell_are_refused():
    with pytest.raises(ValueError, match="do not tell"):
        transitions.found(rows("a", "5083", runs=[(1000, 0.99), (1100, 0.98)]))


def test_the_table_of_the_page_is_that_of_the_kept_results():
    page = PAGE.read_text(encoding="utf-8").splitlines()
    assert set(transitions.table(ROWS)[2:]) <= set(page)


def test_kept_runs_have_the_laws_and_plates_of_the_studies():
    """All runs of the budget of each; of the weaker laws only one was run."""
    plans = [cases.plan(source.PROBLEMS / f"cth_nose_shape/{name}.toml", quiet=True)
             for name in ("transition_members", "transition_members_weaker")]  # fmt: skip
    studied = {(case.values["law"], case.values["plate"]) for plan in plans for case in plan.cases}
    assert len(transitions.grouped(ROWS)) == 6
    assert set(transitions.grouped(ROWS)) < studied
    assert {len(runs) for runs in transitions.grouped(ROWS).values()} == {plan.search.budget.runs for plan in plans}


def test_a_directory_that_is_no_study_is_refused(tmp_path, capsys):
    before = transitions.FILE.read_bytes()
    assert transitions.main([str(tmp_path)]) == 2
    assert str(tmp_path) in capsys.readouterr().err
    assert transitions.FILE.read_bytes() == before
