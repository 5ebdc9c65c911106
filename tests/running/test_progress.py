"""How long a run still takes."""

from types import SimpleNamespace

import pytest

from hydro2d.running import progress
from hydro2d.running.progress import PACE_SECONDS, Clock


class Pace:
    """A run of `cycles` cycles whose cycles take what it is told; the first compiles for ten minutes."""

    def __init__(self, cycles=10_000):
        self.now, self.sim = 0.0, SimpleNamespace(time=0.0, cycle=0)
        self.clock = Clock(SimpleNamespace(time=None, cycles=cycles), lambda: self.now)
        self.step(600.0)
        self.clock.begin(self.sim)

    def step(self, seconds):
        self.now += seconds
        self.sim.cycle += 1
        return self.clock.left(self.sim)


def test_compilation_does_not_count():
    pace = Pace()
    assert pace.step(0.01) == pytest.approx(0.01 * (10_000 - 2))


def test_the_pace_is_that_of_the_last_minute():
    pace = Pace()
    for _ in range(100):
        pace.step(1.0)
    for _ in range(round(2.0 * PACE_SECONDS / 0.1)):
        left = pace.step(0.1)
    assert left == pytest.approx(0.1 * (10_000 - pace.sim.cycle), rel=0.01)


def test_without_an_end_time_nothing_is_known():
    clock = Clock(SimpleNamespace(time=None, cycles=None))
    clock.begin(SimpleNamespace(time=1.0, cycle=5))
    assert clock.left(SimpleNamespace(time=2.0, cycle=10)) is None


def test_before_the_first_cycle_is_over_nothing_is_known():
    clock = Clock(SimpleNamespace(time=1.0, cycles=None))
    assert clock.left(SimpleNamespace(time=0.1, cycle=1)) is None


@pytest.mark.parametrize(("quiet", "seconds", "said"), [
    (False, 2.0, "decks read: 2 of 6\ndecks read: 5 of 6\n"), (True, 2.0, ""), (False, 0.1, "")])
def test_what_takes_long_is_counted_on_stderr(monkeypatch, capsys, quiet, seconds, said):
    now = (seconds * n for n in range(1000))
    monkeypatch.setattr(progress.clock, "monotonic", lambda: next(now))
    assert list(progress.counted(range(6), "decks read", quiet)) == list(range(6))
    assert capsys.readouterr().err == said


def test_the_last_lines_say_what_moves():
    """The fastest by energy first; what stands still is left out."""
    known = {"plate": (3.0, 40.0), "rod": (3.5, 900.0), "wall": (1e-9, 1e-15), "gone": (None, 0.0)}
    bodies = {name: {"velocity_m_s": speed, "kinetic_energy_J": energy} for name, (speed, energy) in known.items()}
    said = progress._moving({"bodies": bodies, "projectile": {"body": "rod", "tail_velocity_m_s": 355.2}})
    assert said == "rod 3.5 m/s, 900 J; plate 3.0 m/s, 40 J; tail of the rod 355.2 m/s"
    assert progress._moving({"bodies": {"wall": {"velocity_m_s": 0.0, "kinetic_energy_J": 0.0}},
                             "projectile": None}) == ""
