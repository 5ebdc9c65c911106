"""What the phases of a step are given: every parameter is found, always the array that is in use, and of the same types."""

from functools import partial

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.kernels import lagrangian_step, remap_step
from hydro2d.solver.arguments import OF_THE_CALL, Arguments, names
from hydro2d.solver.contact import slots
from hydro2d.solver.first_cycle import calls_of_a_cycle
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
PHASES = {name: value for module in (lagrangian_step, remap_step) for name, value in vars(module).items()
          if hasattr(value, "compiled") and value.__module__ == module.__name__}
every_phase = pytest.mark.parametrize("phase", PHASES.values(), ids=PHASES)
every_deck = pytest.mark.parametrize("options", DECKS.values(), ids=DECKS)


def started(options) -> Simulation:
    return Simulation(deck.loads(SHOT, options))


def given(engine, phase) -> dict:
    """The arguments of a phase that stay, by the names of its parameters."""
    return dict(zip(names(phase), engine.arguments.of(phase), strict=True))


@every_phase
def test_what_changes_from_call_to_call_comes_first(phase):
    parameters = phase.compiled.py_func.__code__.co_varnames[:phase.compiled.py_func.__code__.co_argcount]
    number = len(parameters) - len(names(phase))
    assert number > 2
    assert set(parameters[:number]) <= set(OF_THE_CALL)
    assert parameters[number:] == names(phase)


@every_deck
@every_phase
def test_every_parameter_is_found(phase, options):
    engine = started(options).engine
    found = given(engine, phase)
    assert set(found) == set(names(phase))
    for name, value in found.items():
        assert isinstance(value, (np.ndarray, bool, int, float, np.generic)), name
        if getattr(engine.state, name, np.zeros(0)).size:
            assert np.shares_memory(value, getattr(engine.state, name)), name


def test_one_compiled_phase_serves_all_decks():
    """What is written down for compilation ahead of time has one tuple of types for each phase, whatever the deck."""
    types: dict[str, set] = {name: set() for name in PHASES}
    for options in DECKS.values():
        for call in calls_of_a_cycle(partial(started, options)):
            name = call.name.split(".")[-1]
            if call.compiled is getattr(PHASES.get(name), "compiled", None):
                types[name].add(call.types)
    assert {name: len(found) for name, found in types.items()} == dict.fromkeys(PHASES, 1)


@every_deck
def test_no_cycle_compiles_a_phase_again(options):
    simulation = started(options)
    for _ in range(4):
        simulation.step()
    simulation.load_restart_arrays({name: array.copy() for name, array in simulation.restart_arrays().items()})
    simulation.load_restart_scalars(simulation.restart_scalars())
    simulation.step()
    called = [phase for name, phase in PHASES.items() if name != "find_contact" or simulation.state.groups > 1]
    assert [len(phase.compiled.signatures) for phase in called] == [1] * len(called)


def same(one, other) -> bool:
    if not isinstance(one, np.ndarray):
        return one == other
    return one.__array_interface__ == other.__array_interface__ or (
        one.shape == other.shape and one.dtype == other.dtype and one.tobytes() == other.tobytes())


@every_deck
def test_arguments_are_those_of_now(options):
    """After cycles, in which velocities take turns and ties need more slots, and after a restart."""
    simulation = started(options)
    engine = simulation.engine

    def assert_as_found_anew():
        anew = Arguments(engine, engine.table)
        anew.limit_speed(engine.speed_limit)
        for phase in PHASES.values():
            for name, value, now in zip(names(phase), engine.arguments.of(phase), anew.of(phase), strict=True):
                assert same(value, now), f"{phase.__name__}: {name}"

    for _ in range(6):
        simulation.step()
        assert_as_found_anew()
    for _ in range(2):
        engine.state.swap_velocities()
        assert_as_found_anew()
    engine.contact.ties = slots(len(engine.contact.ties.strength) + 1)
    assert_as_found_anew()
    scalars = simulation.restart_scalars()
    scalars["speed_limit"] *= 2.0
    simulation.load_restart_scalars(scalars)
    assert_as_found_anew()
    assert given(engine, PHASES["accelerate"])["speed_limit"] == scalars["speed_limit"]
