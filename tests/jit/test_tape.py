"""Tapes: what a conductor has noted runs as it did when Python asked for it, on any number of parts, until Python is needed."""

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.jit import Conductor
from hydro2d.jit.by_name import flat, steering
from hydro2d.kernels import between_phases, remap_step
from tests.kernels.cells import source


def conductor(parts: int = 1) -> Conductor:
    """A clock that counts steps of 1 s, and vertices of which some move."""
    given, (u, v) = Conductor(), np.zeros((2, 1, 13, 9))
    u[0, 4:7, 3] = 1.0
    given.handle.update(
        parts=np.linspace(2, 10, parts + 1).astype(np.int64), i0=2, i1=6, u=u, v=v, grows=True, asks=0, cycle=0, dt=1.0,
        row_moving=np.zeros((13, 2), dtype=np.int64), moving=np.zeros(4, dtype=np.int64),
        gate=np.zeros(jit.GATE, dtype=np.int64), time=0.0, reached=0.0, until=np.inf, last_cycle=3,
        lengths=np.zeros(8), grown=np.zeros(8, dtype=np.bool_), limited_by=0,
        dt_min=1e-9, mesh_speed=0.0, advance=0.0)
    return given


def step(given: Conductor, said: list) -> None:
    given.set(dt=2.0)
    given.ask(between_phases.begin_step, lambda: said.append("small"))
    given.exchange(("u", "v"))
    given.run(remap_step.find_moving)
    given.do(lambda: said.append(given.handle.moving.tolist()))
    given.run(between_phases.end_step)


def played(parts: int, last: int) -> tuple[Conductor, list]:
    given, said = conductor(parts), []
    with given.record() as tape:
        step(given, said)
        given.ask(between_phases.look_at_clock, None)
    given.handle.update(last_cycle=last)
    tape.play(given.handle, 0)
    return given, said


@pytest.mark.parametrize("parts", [1, 2])
@pytest.mark.parametrize("steps", [1, 2, 5])
def test_a_tape_does_what_python_does(parts, steps):
    if parts > jit.parts_at_once():
        pytest.skip("this process has one thread now")
    by_hand, said = conductor(parts), []
    for _ in range(steps):
        step(by_hand, said)
    given, also_said = played(parts, steps)
    assert said == also_said
    assert len(said) == steps
    assert said[0] == [4, 7, 3, 4]  # velocities that were u are v now, and move as well
    for name in ("cycle", "reached", "dt", "asks"):
        assert getattr(given.handle, name) == getattr(by_hand.handle, name), name
    assert given.handle.reached == 2.0 * steps
    assert given.handle.lengths.tolist() == by_hand.handle.lengths.tolist()
    assert (given.handle.u[0, 4, 3], given.handle.v[0, 4, 3]) == ((0.0, 1.0) if steps % 2 else (1.0, 0.0))


def test_nothing_is_computed_while_a_tape_is_recorded():
    given, said = conductor(), []
    before = given.handle.words.copy()
    with given.record():
        step(given, said)
    np.testing.assert_array_equal(given.handle.words, before)
    assert not said


def test_what_raises_leaves_the_tape():
    given = conductor()

    def fail():
        raise RuntimeError("no more")

    with given.record() as tape:
        given.set(dt=1e-12)
        given.ask(between_phases.begin_step, fail)
        given.run(between_phases.end_step)
    with pytest.raises(RuntimeError, match="no more"):
        tape.play(given.handle, 0)
    assert given.handle.cycle == 0
    assert given.handle.asks == 0


def test_a_tape_ends_at_a_time():
    given, said = conductor(), []
    with given.record() as tape:
        step(given, said)
        given.ask(between_phases.look_at_clock, None)
    given.handle.update(until=6.5, last_cycle=100)
    tape.play(given.handle, 0)
    assert given.handle.reached == 8.0


def test_only_functions_that_steer_set_numbers():
    from hydro2d.kernels.between import choose_step

    written = source(choose_step.end_step)
    with pytest.raises(ValueError, match="assigns w.reached|assigns w.cycle"):
        flat(type(written)(written.__code__, written.__globals__, written.__name__))
    assert steering(written) is written
    assert "numbers" in flat(written).named


def test_a_phase_has_no_kernels_that_steer_beside_others():
    from hydro2d.kernels import audit_sums
    from hydro2d.kernels.between import choose_step

    with pytest.raises(ValueError, match="kernels that steer and others"):
        jit.Phase("mixture", "", jit.alone(choose_step.end_step), jit.alone(audit_sums.sum_momentum))
