"""Seven shots on several meshes: which have an order of convergence, and what the table says of those that have none."""

import pytest

from problems.cth_nose_shape import convergence, rigid_rod
from problems.cth_nose_shape.rigid_rod import Result, Shot

SHOT = Shot("hemispherical", "5083", 1086.0)


def run(cells, depth, loss=2.0, member=0, residual=None):
    return Result({"shot": "5083-1086", rigid_rod.CELLS: f"{cells:g}"}, member, depth, loss, residual, "rigid", 17.0, "m")


def row(meshes, quantity=convergence.DEPTH):
    (line,) = convergence.table({SHOT: meshes}, quantity)[2:]
    return [cell.strip() for cell in line.strip("|").split("|")][1:]


def test_members_on_each_mesh_and_what_their_medians_come_to():
    meshes = {cells: [run(cells, 40.0 + 8.0 / cells + shift, member=number) for number, shift in enumerate((0.0, -1.0, 0.5))]
              for cells in (2.0, 4.0, 8.0)}
    assert row(meshes) == ["44.0 (43.0 to 44.5)", "42.0 (41.0 to 42.5)", "41.0 (40.0 to 41.5)", "40.0, order 1.0, index 3 %"]
    assert row(meshes, convergence.LENGTH)[:3] == ["95.8"] * 3
    assert row({2.0: [run(2.0, 44.0)], 4.0: [run(4.0, 42.0)]}) == ["44.0", "42.0", ""]


@pytest.mark.parametrize(("finest", "said"), [
    (run(8.0, 14.0, loss=70.0), "some hold, some erode"), (run(8.0, 45.0), "up and down from mesh to mesh"),
    (run(8.0, 30.0), "the change grows from mesh to mesh")])
def test_sequences_without_an_order(finest, said):
    assert row({2.0: [run(2.0, 44.0)], 4.0: [run(4.0, 42.0)], 8.0: [finest]})[-1] == said


def test_rods_that_perforate_have_no_depth():
    meshes = {cells: [run(cells, None, residual=300.0)] for cells in (2.0, 4.0)}
    assert len(convergence.table({SHOT: meshes}, convergence.DEPTH)) == 2
    assert row(meshes, convergence.RESIDUAL) == ["300", "300", ""]


def test_the_figure_has_a_dot_for_every_member():
    meshes = {SHOT: {2.0: [run(2.0, 44.0), run(2.0, 43.0, member=1)], 4.0: [run(4.0, 42.0)]}}
    depth, length = convergence.draw(meshes).axes
    assert depth.lines[0].get_xydata().tolist() == [[0.5, 43.0], [0.5, 44.0], [0.25, 42.0]]
    assert len(length.lines[0].get_xdata()) == 3
