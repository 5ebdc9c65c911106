"""The twelve shots by their members."""

from statistics import median

import pytest

from hydro2d.base.method_version import METHOD
from hydro2d.study.records import keeping
from problems.cth_nose_shape import members, rigid_rod
from problems.cth_nose_shape.rigid_rod import Result, Shot

HELD, USED_UP = Shot("hemispherical", "5083", 1086.0), Shot("hemispherical", "5083", 1200.0)
THROUGH = Shot("ogival", "5083", 1227.0)


def made(depth, loss, shot="5083-1086", law="A", residual=None):
    return Result({"law": law, "shot": shot}, 0, depth, loss, residual, "rigid", None, METHOD)


def test_a_cell_has_the_median_the_spread_and_the_outcome():
    three = [made(44.0, 2.0), made(46.5, 1.5), made(20.0, 60.0)]
    assert members.cell(three, True) == "44.0 cm (20.0 to 46.5), 2.0 %, 2 of 3"
    assert members.cell(three, False).endswith(", 1 of 3")
    assert members.cell(three[:1], None) == "44.0 cm, 2.0 %"


def test_rods_that_perforate():
    through, stuck = made(None, 1.0, residual=200.0), made(51.2, 1.0)
    assert members.cell([through, through], True) == "perforated, 1.0 %, 2 of 2"
    assert members.cell([through, stuck, stuck], True) == "51.2 cm (1 of 3 perforated, least 51.2 cm), 1.0 %, 3 of 3"
    assert members.within_aim([through, through, stuck], THROUGH)
    assert not members.within_aim([through, stuck, stuck], THROUGH)


@pytest.mark.parametrize(("shot", "depth", "within"), [(HELD, 44.8 * 1.09, True), (HELD, 44.8 * 1.11, False),
                                                      (USED_UP, 20.0 * 0.81, True), (USED_UP, 20.0 * 1.21, False)])
def test_the_aim(shot, depth, within):
    assert members.within_aim([made(depth, 1.0)], shot) == within


def test_scores_count_members_and_shots():
    results = [made(44.0, 2.0), made(43.0, 2.5), made(20.0, 60.0, "5083-1200"), made(41.0, 9.0, "5083-1200"),
               made(9.0, 80.0, law="B")]
    assert members.scores(members.grouped(results))[2:] == [
        "| A | 2 | 3 of 4 (36 to 94 %) | 1 | 1 |", "| B | 1 | 0 of 1 (0 to 73 %) | 0 | 0 |",
    ]


def test_every_shot_of_the_experiments_is_rigid_or_not():
    assert set(members.rigid()) == set(rigid_rod.experiments())
    assert members.rigid()[HELD] is True
    assert members.rigid()[USED_UP] is False


def test_the_figure_has_a_dot_for_every_member():
    results = [made(44.0, 2.0), made(46.0, 2.5), made(None, 2.5, residual=90.0), made(20.0, 60.0, "5083-1200")]
    first = members.draw(members.grouped(results)).axes[0]
    dots = [line for line in first.lines if line.get_marker() in ("o", "^") and line.get_alpha() == 0.6]
    assert [len(line.get_xdata()) for line in dots] == [3, 1]
    (line,) = (line for line in first.lines if line.get_linewidth() == 0.8 and line.get_linestyle() == "-"
               and len(line.get_xdata()) == 2)
    assert list(line.get_ydata()) == [median([44.0, 46.0, rigid_rod.PLATE]), 20.0]


def test_nothing_to_show(tmp_path, capsys):
    file = tmp_path / "none.csv"
    file.write_text(",".join(["law", "shot", keeping.CELLS, keeping.MEMBER, *keeping.RESULTS, *keeping.ORIGIN]) + "\n")
    assert members.main([str(file)]) == 2
    assert "no finished case" in capsys.readouterr().err
