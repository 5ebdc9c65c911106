"""The names given to the phases of a step: each has a value, always the array in use, and of one type."""

from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.jit.handle import TABLE
from hydro2d.kernels import between_phases, lagrangian_step, names, remap_step
from hydro2d.measure import tracers
from hydro2d.mesh.fields import Work
from hydro2d.solver.contact_ties import Ties
from hydro2d.solver.first_cycle import calls_of_a_cycle
from hydro2d.solver.given import Given, values
from hydro2d.solver.simulation import Simulation
from tests.regression.test_bitwise import CONTACT, FOLLOWING, SHOT

INTERNAL = ('materials.hardening={based_on="Al7039", strength={model="kinematic-hardening", shear_modulus="27.6 GPa", '
            'yield_stress="0.3 GPa", hardening_modulus="2 GPa", isotropic_share=0.5}}', "body.plate.material=hardening")
DECKS = {
    "plain": (),
    "both": ('numerics.advection="both"', 'numerics.mixed_cell="uniform"'),
    "slip-layer": ('sliding.method="slip-layer"', 'sliding.hard=["rod"]', "sliding.yield_factor=1.5"),
    "contact": CONTACT,
    "friction": (*CONTACT, "sliding.friction=0.1", 'numerics.advection="momentum"'),
    "following": FOLLOWING,
    "following, contact": (*FOLLOWING, *CONTACT),
    "internal variables": INTERNAL,
    "memory": ("body.plate.material=Al_porous",),
    "planar": ('mesh.geometry="planar"', "numerics.active_region=false"),
}
PHASES = {name: value for module in (lagrangian_step, remap_step, between_phases, tracers) for name, value in
          vars(module).items() if isinstance(value, jit.Phase)}
#: names whose values steps change, or measurements give
CHANGING = {name.symbol for name in (*names.OF_THE_CALL, *names.WATCHES, *names.BOOKS, *names.TRAVEL)} | {*TABLE.values()}
every_deck = pytest.mark.parametrize("options", DECKS.values(), ids=DECKS)


def started(options) -> Simulation:
    return Simulation(deck.loads(SHOT, options))


def test_every_name_is_used_by_a_phase():
    """A name that no kernel uses is not a name of the step; the rows of q have names for those who read results."""
    used = frozenset().union(*(phase.takes for phase in PHASES.values()))
    assert used <= {name.symbol for name in names.NAMES} | set(TABLE.values())
    stated = (*names.MESH, *names.EDGES, *names.BODIES, *names.WORDS, *names.DERIVED, *names.TIES)
    assert {name.symbol for name in stated} - used == set()


#: phases before the first step and those of a step, in order, of a deck with a tracer; further ones that others have
BEFORE, STEP = {"find_bodies", "find_masses"}, [
    "find_moving", "grow_box", "cut_parts", "close_cells", "judge_cells", "choose_step_length", "begin_step", "accelerate",
    "book_acceleration", "deform", "deform_mixed", "aim", "carry_bodies", "book_outflow", "carry_momentum", "book_momentum",
    "end_step", "is_time_to_look", "move_tracers", "sample_stations", "keep_peaks_of_stations", "watch_shot", "look_at_clock"]
BESIDE = {"plain": set(), "slip-layer": {"is_time_for_zones", "slip_zones"}, "contact": {"count_slots", "find_contact"},
          "following": {"announce", "follow_core", "look_ahead", "move_mesh"}}


@pytest.mark.parametrize("name", BESIDE)
def test_a_deck_has_the_phases_that_it_needs(name):
    called = [call.name.split(".")[-1] for call in calls_of_a_cycle(partial(started, DECKS[name]))]
    assert [phase for phase in called if phase in STEP] == STEP
    assert {*called} & {*PHASES} == BEFORE | {*STEP} | BESIDE[name]


def owner(**attributes) -> tuple[SimpleNamespace, list[Work]]:
    """An owner and the names of its attributes."""
    return SimpleNamespace(**attributes), [Work(symbol, "", "") for symbol in attributes]


def test_values_are_those_of_the_owners():
    assert values(owner(courant=0.7), owner(friction=0.1, refresh=5)) == {"courant": 0.7, "friction": 0.1, "refresh": 5}


def test_a_name_that_its_owner_does_not_have_is_refused():
    with pytest.raises(AttributeError, match="couratn"):
        values(owner(courant=0.7), (SimpleNamespace(courant=0.7), [Work("couratn", "", "")]))


def test_a_name_with_two_owners_is_refused():
    with pytest.raises(ValueError, match="the name courant has two owners"):
        values(owner(courant=0.7), owner(courant=0.7))


def test_numbers_of_the_deck_are_those_of_its_sections():
    """Every key that is always a number, with its value in the deck."""
    simulation = started(("numerics.courant=0.3", "sliding.threshold=0.4", "failure.record=true", "numerics.ramp_cycles=7"))
    handle = simulation.engine.given.handle
    assert (handle.courant, handle.threshold, handle.record, handle.ramp_cycles) == (0.3, 0.4, True, 7)
    for section in (simulation.deck.numerics, simulation.deck.sliding, simulation.deck.failure):
        stated = {key: value for key, value in section.model_dump().items()
                  if isinstance(value, (float, int)) and key not in ("boundary_layer", "slip_layer", "yield_factor")}
        assert {name.symbol: getattr(handle, name.symbol) for name in names.NUMBERS[type(section)]} == stated


def test_ties_are_those_of_the_table():
    assert tuple(name.symbol for name in names.TIES) == Ties._fields


@every_deck
def test_every_name_has_a_value(options):
    simulation = started(options)
    simulation.step()
    engine, known = simulation.engine, simulation.engine.given.handle.values
    assert {name.symbol for name in names.NAMES} | set(TABLE.values()) == set(known)
    assert (known["width_bl"] > 0.0) is engine.method.slip_layer
    for name in (each.symbol for each in names.NAMES):
        if getattr(engine.state, name, np.zeros(0)).size:
            assert np.shares_memory(known[name], getattr(engine.state, name)), name


def test_one_compiled_phase_serves_all_decks():
    """The types recorded for compilation ahead of time are one tuple for each phase, for all decks."""
    types: dict[str, set] = {}
    for options in DECKS.values():
        for call in calls_of_a_cycle(partial(started, options)):
            if call.types == jit.PHASE_TYPES:
                types.setdefault(call.name.split(".")[-1], set()).add(call.compiled)
    assert {name: len(tuples) for name, tuples in types.items()} == dict.fromkeys(PHASES, 1)


def same(one, other) -> bool:
    if not isinstance(one, np.ndarray):
        return one == other
    return one.__array_interface__ == other.__array_interface__ or (
        one.shape == other.shape and one.dtype == other.dtype and one.tobytes() == other.tobytes())


@every_deck
def test_values_are_those_of_now(options):
    """After cycles, in which velocities swap arrays and ties need more slots, and after a restart."""
    simulation = started(options)
    engine = simulation.engine

    def assert_as_found_anew():
        now, anew = engine.given.handle.values, Given(engine, engine.table).handle.values
        for name in set(anew) - CHANGING:
            assert same(now[name], anew[name]), name

    for _ in range(6):
        simulation.step()
        assert_as_found_anew()
    if engine.state.groups > 1:
        engine.contact.make_room(engine.given.handle)
        assert_as_found_anew()
    scalars = simulation.restart_scalars()
    scalars["speed_limit"] *= 2.0
    simulation.load_restart_scalars(scalars)
    assert_as_found_anew()
    assert engine.given.handle.values["speed_limit"] == scalars["speed_limit"]
