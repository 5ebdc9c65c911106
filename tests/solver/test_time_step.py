"""Time steps that have collapsed end a run; those that fall for a reason do not."""

import json
import math
import re

import numpy as np
import pytest

from hydro2d.base.errors import UnphysicalState
from hydro2d.deck import deck
from hydro2d.kernels.between.choose_step import CELL
from hydro2d.solver.cycle import Cycle
from hydro2d.solver.simulation import Simulation
from hydro2d.solver.time_step import COLLAPSED, PATIENCE, Steps
from tests.decks import box, mesh, stop, table, walls
from tests.restarts import restarted

#: what has set a step: a cell, or only the growth from the step before
SOUND, GROWTH = False, True


def cycles_until(steps, *runs):
    """Number of steps after which they have collapsed, None if they have not.

    runs : (number, step in s or function, whether it only grew)
    """
    taken = 0
    for number, dt, cause in runs:
        for k in range(number):
            taken += 1
            if steps.collapse(dt(k) if callable(dt) else dt, cause):
                return taken
    return None


def test_a_collapse_is_seen_after_as_many_cycles_as_it_must_last():
    assert cycles_until(Steps(), (500, 1e-8, SOUND), (1000, 0.9e-11, SOUND)) == 500 + PATIENCE


def test_thousands_of_falling_steps_do_not_move_the_median():
    """A cylinder of 17 000 cycles: over cycles the median falls with the steps, over time it does not."""
    steps = Steps()
    found = cycles_until(steps, (200, 1e-8, SOUND), (20000, lambda k: 1e-8 * math.exp(-k / 800.0), SOUND))
    assert found is not None
    assert steps.median == pytest.approx(1e-8, rel=0.5)


@pytest.mark.parametrize("runs", [
    [(2000, lambda k: 1e-12 * 1.1**min(k, 90), GROWTH)],
    [(100, 1e-12, SOUND), (2000, 1e-8, SOUND)],
    [(500, 1e-8, SOUND), (5000, 1e-10, SOUND)],
    [(500, 1e-8, SOUND), (PATIENCE - 1, 1e-12, SOUND), (1, 1e-8, SOUND), (PATIENCE - 1, 1e-12, SOUND)],
    [(500, 1e-8, SOUND), (1, 1e-16, SOUND), (190, lambda k: 1e-16 * 1.1**k, GROWTH)],
], ids=["growth from the first step", "small first steps", "compression by 100", "dips", "one dip, from which it grows back"])
def test_no_collapse(runs):
    assert cycles_until(Steps(), *runs) is None


def test_a_step_that_falls_again_and_again_as_it_grows_has_collapsed():
    steps = Steps()
    assert cycles_until(steps, (500, 1e-8, SOUND)) is None
    assert any(steps.collapse(1e-12 * 1.1**(k % 3), SOUND if k % 3 == 0 else GROWTH) for k in range(4 * PATIENCE))


def test_a_restart_goes_on_with_the_same_decision():
    whole = Steps()
    for k in range(777):
        whole.collapse(1e-8 * (1.0 + 0.3 * math.sin(k)) * (1.0 if k < 730 else 1e-5), SOUND)
    again = Steps()
    again.resume(json.loads(json.dumps(whole.saved())))
    assert again.saved() == whole.saved()
    assert cycles_until(whole, (60, 1e-13, SOUND)) == cycles_until(again, (60, 1e-13, SOUND)) == 53
    assert again.saved() == whole.saved()


TEXT = (
    mesh(("2 mm", 4), ("20 mm", 40), geometry="planar")
    + walls("r_max", "z_max")
    + box("flyer", "Al6061_T6", z=["2 mm", "8 mm"], velocity="300 m/s")
    + box("wall", "Al6061_T6", z=["8 mm", "18 mm"])
    + table("numerics", ramp_cycles=20)
    + stop("1 us")
)


def shrink(monkeypatch, dt, after=250):
    """Steps from this cycle on have this length, s, instead of some 4e-8 s."""
    choose = Cycle.choose_step

    def shorter(cycle):
        choose(cycle)
        if cycle.number >= after:
            cycle.given.set(dt=dt, time=cycle.time + dt, limited_by=CELL)

    monkeypatch.setattr(Cycle, "choose_step", shorter)


def last_words(simulation):
    """The sentence with which a simulation ends within 1000 cycles; empty if it does not."""
    try:
        while simulation.cycle < 1000:
            simulation.step()
    except UnphysicalState as error:
        return str(error)
    return ""


def test_a_run_whose_steps_collapse_ends_and_says_where(monkeypatch):
    shrink(monkeypatch, 1e-12)
    said = last_words(Simulation(deck.loads(TEXT)))
    assert re.fullmatch(r"cycle 350, time \S+ s: the time step has fallen to 1e-12 s and was below 0.001 of its median, \S+ s, "
                        r'for 100 cycles, set by sound at r = 0.250 mm, z = 9.750 mm, in body "wall": no wave that .*', said)


def test_a_run_that_continues_ends_in_the_same_cycle(monkeypatch):
    shrink(monkeypatch, 1e-12)
    first = Simulation(deck.loads(TEXT))
    while first.cycle < 310:
        first.step()
    again = restarted(first)
    assert last_words(first) == last_words(again) != ""


def test_steps_that_motion_explains_are_no_collapse(monkeypatch):
    """Below a thousandth of the median, but not of what the fastest wave needs: cold gas that is hit late, for example."""
    shrink(monkeypatch, 1e-12)
    simulation = Simulation(deck.loads(TEXT))
    monkeypatch.setattr("hydro2d.solver.simulation.SOUND_STEP", 1e-6)
    while simulation.cycle < 500:
        simulation.step()


#: gas without energy, whose sound hardly moves, and an edge that moves after 70 ms
COLD = (
    mesh(("2 mm", 4), ("20 mm", 40), geometry="planar")
    + walls("r_max", "z_max", z_min="piston", z_min_piston=[[0.0, 0.0], [0.07, 0.0], [0.070001, 3000.0]])
    + box("gas", "cold", z=["0 mm", "20 mm"])
    + table("materials.cold.eos", model="ideal-gas", reference_density="1.2 kg/m^3", adiabatic_index=1.4)
    + table("numerics", ramp_cycles=20)
    + stop("80 ms")
)


def test_an_edge_that_moves_late_is_no_collapse():
    simulation, steps = Simulation(deck.loads(COLD)), []
    while simulation.cycle < 400:
        simulation.step()
        steps.append(simulation.dt)
    assert (np.array(steps) < 0.9 * COLLAPSED * simulation._steps.median).sum() > PATIENCE
