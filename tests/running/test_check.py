"""The time that `hydro2d check` estimates."""

from types import SimpleNamespace

import pytest

from hydro2d.base.terminal import duration
from hydro2d.deck import deck as decks
from hydro2d.running import check

#: measured cycles of whole runs: a bar against a wall, a rod on a mesh that follows it, an eroding rod, a crater
CYCLES = [
    ("problems/validation/copper_bar.toml", "60 us", 2090),
    ("problems/cth_nose_shape/hemi_5083_1086_quick.toml", "120 us", 1934),
    ("problems/classic/long_rod.toml", "60 us", 1209),
    ("problems/classic/crater.toml", "40 us", 796),
]


@pytest.mark.parametrize(("deck", "time", "cycles"), CYCLES)
def test_cycles_are_estimated(deck, time, cycles):
    """7 % too few; 16 to 17 % where a shock shortens the steps all the time."""
    guess = check.check(decks.load(deck, [f"stop.time={time}"])).cycles
    assert guess == pytest.approx(cycles, rel=0.18 if "classic" in deck else 0.1)


def wall(cells, threads):
    """Estimated time on one thread, as many seconds as there are cells, without the start."""
    deck = SimpleNamespace(grid=SimpleNamespace(cells=cells), seconds=float(cells))
    return check.Check.wall(deck, threads) - check.START


def test_threads_gain_what_was_measured_on_large_meshes_and_little_on_small_ones():
    """Of explanation/speed: 130 thousand cells from 137 to 106 ns, 400 thousand from 140 to 80; on 10 thousand, nothing."""
    assert wall(130e3, 2) / 130e3 == pytest.approx(106 / 137, abs=0.1)
    assert wall(400e3, 2) / 400e3 == pytest.approx(80 / 140, abs=0.1)
    assert wall(10e3, 16) > 0.9 * wall(10e3, 1)
    assert wall(10e3, 1) == 10e3


def test_the_start_of_the_program_is_counted():
    checked = check.check(decks.load("problems/classic/long_rod.toml", ["stop.cycles=1"]))
    assert checked.wall(1) == pytest.approx(check.START, abs=0.1)
    assert f"about 1 cycle, {duration(checked.wall(1))} on 1 thread (a guess)" in "\n".join(checked.lines(1))


QUICK = "problems/cth_nose_shape/hemi_5083_1086_quick.toml"


def about_rod(overrides, deck=QUICK):
    """The lines of the report that follow the one on the body that the mesh follows, and the number of cells."""
    checked = check.check(decks.load(deck, overrides))
    lines = [line.strip() for line in checked.lines(1)]
    first = next(number for number, line in enumerate(lines) if line.startswith("follow "))
    return lines[first + 1:first + 3], checked.grid.cells


#: cells of one size along the rod
EVEN = ["mesh.reach=none", "mesh.cells_across=none", "mesh.fine=none", "mesh.z_start=-104.423273 mm",
        'mesh.z=[{to=0.0, cells=170}, {cells=37, across="rod", cells_across=5.5}, {to="101.352 mm", ratio=1.12}]']


def test_a_mesh_graded_along_the_rod_is_proposed_and_has_the_cells_that_were_promised():
    said, cells = about_rod(EVEN)
    assert (said, cells) == ([
        "if it stays whole, a mesh graded along it would have 4624 instead of 7854 cells:",
        'mesh.fine = "7 radii", mesh.cells_across = 5.5, mesh.reach = "30 radii" instead of mesh.z'], 7854)
    keys = [text.replace(" = ", "=") for text in said[1].removesuffix(" instead of mesh.z").split(", ")]
    said, cells = about_rod([EVEN[3], *keys])
    assert (said[0], cells) == ("mesh.fine grades the mesh along it: 4624 cells instead of 7684", 4624)
    assert about_rod([EVEN[3], "mesh.fine=none"])[0] == [
        "if it stays whole, a mesh graded along it would have 4624 instead of 7684 cells:", 'mesh.fine = "7 radii"']


@pytest.mark.parametrize("overrides", [
    ['mesh.z=[{to="-24 mm", first="2.4 mm", last="0.6143 mm"}, {to=0.0, cells=39}, {to="101.352 mm", cells=165}]'],
    ["body.rod.length=26 mm", "mesh.z_start=-33 mm", 'mesh.z=[{to=0.0, cells=54}, {to="101.352 mm", ratio=1.12}]'],
])
def test_nothing_is_proposed_for_a_mesh_that_is_graded_or_gains_little(overrides):
    assert not [line for line in about_rod(["tracer=[]", *EVEN[:4], *overrides])[0] if "graded" in line]


def test_nothing_is_proposed_for_a_ball():
    assert not [line for line in about_rod([], "problems/perforation/sphere.toml")[0] if "graded" in line]
