"""Laws of the plate and of the rod: what the page says of the kept rows."""

from dataclasses import replace

import hydro2d
from problems.cth_nose_shape import plate_laws, rigid_rod

FOUND = plate_laws.found(*rigid_rod.ALLOYS)
STRONG, WEAK = ("Steinberg-Guinan", "Johnson-Cook, sintered"), ("Johnson-Cook, 90W", "Johnson-Cook, Y925")


def runs(rods, velocity):
    """The runs of these rods at a velocity in m/s, by law of the plate and rod."""
    return {laws: run for laws, cases in FOUND.items() if laws[1] in rods
            for shot, run in cases.items() if shot.velocity == velocity}


def test_no_pair_of_laws_ends_all_shots_as_measured():
    assert plate_laws.pairs() == (0, 20)
    for slow, fast in ((1086.0, 1200.0), (1038.0, 1165.0)):
        assert all(run.held for run in runs(STRONG, fast).values())
        assert not any(run.held for run in runs(WEAK, slow).values())
    assert len(runs(STRONG, 1200.0)) == len(runs(WEAK, 1086.0)) == 10


def test_the_drag_of_the_plate_by_its_law():
    depths = {plate: run.depth for (plate, _), run in runs((plate_laws.STIFF,), 1086.0).items()}
    assert round(depths.pop("published"), 1) == 49.4
    assert [round(each(depths.values()), 1) for each in (min, max)] == [41.6, 44.9]
    losses = [run.loss for (plate, _), run in runs(STRONG, 1086.0).items() if plate != "published"]
    assert 3.0 < min(losses) < max(losses) < 10.0


def test_no_loss_of_length_is_a_negative_zero():
    """Some rods end a hair longer than they began."""
    every = [run for cases in FOUND.values() for run in cases.values()]
    assert any(-0.05 < run.loss < 0.0 for run in every)
    assert "-0.0" not in "".join(map(str, every))
    assert str(replace(every[0], loss=-0.04)).endswith(", 0.0 %")
    assert str(replace(every[0], loss=-0.2)).endswith(", -0.2 %")


def test_rows_are_of_this_method_and_trusted():
    every = [run for cases in FOUND.values() for run in cases.values()]
    assert len(every) == 90
    assert {run.method for run in every} == {hydro2d.METHOD}
    assert all(run.trusted for run in every)
