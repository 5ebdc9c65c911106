"""A step that compiled code plays from the tape has the bits of one that Python goes through, whatever needs Python between."""

import json
import re

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.base.errors import UnphysicalState
from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.decks import box, entry, mesh, stop, walls
from tests.regression.test_bitwise import SHOT
from tests.restarts import restarted
from tests.solver.test_given import DECKS

BLOCKS = (
    mesh(("4 mm", 8), ("20 mm", 40)) + box("flyer", "Al6061_T6", r=["0 mm", "3 mm"], z=["4 mm", "8 mm"], velocity="300 m/s")
    + box("wall", "Al6061_T6", r=["0 mm", "4 mm"], z=["9 mm", "14 mm"]) + stop("20 us"))
#: decks that need Python in a cycle, each in another way
ASKING = {
    "piston": BLOCKS + walls("r_max", z_min="piston", z_min_piston=[[0.0, 0.0], [1e-7, 10.0], [1e-6, 50.0]]),
    "pressure": BLOCKS.replace('"14 mm"', '"20 mm"') + walls("r_max", z_max="pressure", z_max_pressure=[[0, 0], [1e-6, 1e6]]),
    "force": BLOCKS + entry("source", kind="acceleration", name="gravity", body="wall", axial=-1e6),
    "surface": BLOCKS + entry("gauge", name="rear", r=0.0, z="14 mm", surface="wall"),
    "tracer": BLOCKS + entry("tracer", name="tip", r=0.0, z="7.9 mm"),
    "quiet": BLOCKS,
}
ALL = {**{name: (SHOT, options) for name, options in DECKS.items()}, **{name: (text, ()) for name, text in ASKING.items()}}


def bits(simulation: Simulation) -> tuple[str, dict[str, bytes]]:
    arrays = {name: array.tobytes() for name, array in simulation.restart_arrays().items()}
    return json.dumps(simulation.restart_scalars(), sort_keys=True), arrays


@pytest.mark.parametrize(("text", "options"), ALL.values(), ids=ALL)
def test_playing_has_the_bits_of_going_through_the_page(text, options):
    page, played = (Simulation(deck.loads(text, options)) for _ in range(2))
    while page.cycle < 43:
        page.step()
    for most in (1, 1, 3, 100, 7, 100):
        played.advance(cycles=most)
    while played.cycle < 43:
        played.advance(cycles=43 - played.cycle)
    assert bits(played) == bits(page)
    again = restarted(played)
    for simulation in (again, page):
        while simulation.cycle < 55:
            simulation.advance(cycles=55 - simulation.cycle)
    assert bits(again) == bits(page)


def test_the_number_of_threads_may_change_between_calls():
    one, other = (Simulation(deck.loads(SHOT, DECKS["contact"])) for _ in range(2))
    before, most = jit.threads(), jit.max_threads()
    try:
        for cycle, threads in enumerate((1, most, most, 1, most)):
            while one.cycle < 11 * (cycle + 1):
                one.step()
            jit.set_threads(threads)
            while other.cycle < 11 * (cycle + 1):
                other.advance(cycles=11 * (cycle + 1) - other.cycle)
            assert len(other.engine.rows) == threads + 1
            one.step()  # with other parts than before, on the page
            other.step()
    finally:
        jit.set_threads(before)
    assert bits(other) == bits(one)


def test_a_call_ends_at_the_first_cycle_at_or_after_a_time():
    page, played = (Simulation(deck.loads(BLOCKS)) for _ in range(2))
    for _ in range(17):
        page.step()
    while played.time < page.time:
        played.advance(until=page.time)
    assert (played.cycle, played.time) == (17, page.time)
    played.advance(until=page.time)
    assert played.cycle == 18


def test_at_least_one_cycle_is_played_and_looks_come_as_often_as_on_the_page(monkeypatch):
    simulation, looks = Simulation(deck.loads(BLOCKS)), []
    monkeypatch.setattr(Simulation, "refuse_nonsense", lambda self: looks.append(self.cycle))
    while simulation.cycle < 40:
        assert simulation.advance() >= 1
    assert looks == [10, 20, 30, 40]


@pytest.mark.parametrize(("array", "value", "said"), [
    ("e", np.nan, "energy nan J/kg"), ("v", np.nan, "not finite|nan"),
    ("v", 1e7, "turned the cell inside out|below dt_min|does not add up"),
])
def test_a_state_that_is_refused_is_refused_with_the_same_words(array, value, said):
    words = []
    for go in (Simulation.step, lambda simulation: simulation.advance(cycles=1)):
        simulation = Simulation(deck.loads(BLOCKS))
        for _ in range(4):
            go(simulation)
        getattr(simulation.state, array)[0, 12, 4] = value  # within the flyer

        def go_on(simulation=simulation, go=go):
            while simulation.cycle < 20:
                go(simulation)

        with pytest.raises(UnphysicalState) as failure:
            go_on()
        words.append(str(failure.value))
    assert words[0] == words[1]
    assert re.search(said, words[0])


def test_a_callback_sees_every_cycle():
    seen = []
    simulation = Simulation(deck.loads(BLOCKS))
    simulation.run(until="0.5 us", callbacks=[lambda sim: seen.append(sim.cycle)])
    assert seen == list(range(1, simulation.cycle + 1))
