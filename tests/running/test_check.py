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
