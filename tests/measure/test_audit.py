"""The audit closes: changes of velocity by edges, groups, sources and limits are booked once, by the velocities at the end."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, contact, entry, mesh, stop, table, walls
from tests.measure import audited

CLOSES = 1e-12
#: the limit next to products of an explosive, whose modulus may fall by 1e12 below that of the metal in the same cell
CLOSES_BESIDE_PRODUCTS = 1e-9


def after(text: str, cycles: int, *options: str) -> Simulation:
    """The simulation of a deck after some cycles, without a verdict on it."""
    simulation = Simulation(decks.loads(text, options))
    simulation.engine.watches.clear()
    for _ in range(cycles):
        simulation.engine.advance()
    return simulation


def unexplained(simulation: Simulation) -> float:
    """The largest relative change that the audit does not explain."""
    balance = simulation.conservation()
    return max(map(abs, (*balance["mass"].values(), balance["axial_momentum"], balance["total_energy"])))


def unexplained_by_sound(simulation: Simulation) -> float:
    """The largest change that the audit does not explain, of mass m, and of momentum and energy over m c and m c^2, c the
    speed of sound.

    In a cell that a body hardly fills, the stress is a difference of pressures that are larger by the inverse of its share.
    Their round-off does not scale with the energy of a slow shot.
    """
    balance, engine = simulation.conservation(), simulation.engine
    mass, energy = engine.audit.start.mass, engine.audit.scale
    sound = mass @ engine.sound_speeds**2
    return max(*map(abs, balance["mass"].values()), abs(balance["axial_momentum"]) * (2.0 * energy / sound) ** 0.5,
               abs(balance["total_energy"]) * energy / sound)


# ------------------------------------------------------------------------------------------------ two groups and dashpots

SLIDES = (
    mesh(("12 mm", 12), ("30 mm", 30))
    + box("bar", "steel_4340", r=[0.0, "4.4 mm"], z=["-5 mm", "22.3 mm"], velocity=[0.0, 20.0])
    + box("tube", "copper_OFHC", r=["4.4 mm", "10.5 mm"], z=["-5 mm", "35 mm"], velocity=[-10.0, 0.0])
    + table("boundaries", z_min="transmit", z_max="transmit")
    + contact("bar")
    + stop("10 us")
)


@pytest.mark.parametrize("geometry", ["planar", "cylindrical"])
def test_dashpots_act_on_masters_of_a_contact(geometry):
    """A bar slides in a tube, and edges cut through both: heat of the contact comes from the velocities at the end.

    The dashpots keep up the velocities with which both start, against the contact.
    """
    simulation = after(SLIDES, 60, f'mesh.geometry="{geometry}"')
    assert simulation.audit.sinks["transmitted"].energy < 0.0
    assert unexplained(simulation) < CLOSES


# ------------------------------------------------------------------------------------------------ edges that drive

#: a ball moves at one end, and a piston at the other starts later
FAR = (
    mesh(("10 mm", 10), ("60 mm", 60), geometry="planar")
    + walls("r_max", z_max="piston", z_max_piston=[[0.0, 0.0], ["0.2 us", "-200 m/s"], ["10 us", "-200 m/s"]])
    + body("ball", "Al5083", "sphere", centre=["5 mm", "20 mm"], radius="3 mm", velocity="100 m/s")
    + box("slab", "Al5083", z=["35 mm", "60 mm"])
    + stop("4 us")
)


def test_an_edge_that_drives_belongs_to_the_active_box():
    near, whole = after(FAR, 80), after(FAR, 80, "numerics.active_region=false")
    assert near.engine.box[0] > near.engine.mesh_box[0]  # not all cells are active
    for name in ("q", "vof", "u", "v"):
        np.testing.assert_array_equal(getattr(near.state, name), getattr(whole.state, name))
    assert near.mean_velocity(1) < -1.0
    assert unexplained(near) < CLOSES


def test_an_edge_moves_while_nothing_else_does():
    """The step is limited by waves in the rest of the mesh, and by the edge's motion across a cell."""
    text = (
        mesh(("4 mm", 4), ("30 mm", 30), geometry="planar")
        + walls("r_max", z_max="velocity", z_max_velocity="-100 m/s")
        + box("plate", "Al5083", z=["4 mm", "8 mm"])
        + stop("1 ms")
    )
    assert after(text, 40).time < 10e-6
    fast = after(text.replace("-100 m/s", "-100 km/s"), 3, "numerics.ramp_cycles=0")
    assert fast.dt == pytest.approx(0.4 * 1e-3 / 100e3, rel=1e-12)
    assert fast.dt_cause == "velocity of the edge z_max"


def test_a_piston_may_jump():
    """The step in which it jumps ends before material moving with it has crossed a cell."""
    simulation = after(
        mesh(("4 mm", 4), ("60 mm", 60), geometry="planar")
        + walls("r_max", "z_max", z_min="piston", z_min_piston=[[0.0, 0.0], ["20 us", 0.0], ["20.001 us", "5 km/s"]])
        + box("gas", "gas_7_5", density=1.2, pressure="0.1 MPa", z=[0.0, "60 mm"])
        + stop("1 ms"), 100)
    assert simulation.time > 20.1e-6
    assert simulation.faults() == []
    assert unexplained(simulation) < CLOSES


# ------------------------------------------------------------------------------------------------ sources that push

PUSHED = (
    mesh(("10 mm", 10), ("20 mm", 20), geometry="planar")
    + box("block", "lead", r=[0.0, "12 mm"], z=[0.0, "9.3 mm"])
    + entry("source", name="gravity", kind="acceleration", body="block", axial=-1e8)
    + stop("1 ms")
)


@pytest.mark.parametrize("advection", ["momentum", "ke", "both"])
@pytest.mark.parametrize("edges", [{"z_min": "transmit"}, {"z_min": "transmit", "r_max": "transmit"},
                                   {"z_min": "wall", "r_max": "transmit"}])
def test_a_source_pushes_what_an_edge_holds(edges, advection):
    simulation = after(PUSHED + table("boundaries", **edges) + table("numerics", advection=advection), 60)
    assert simulation.audit.sinks["gravity"].energy < 0.0 < abs(simulation.audit.sinks["transmitted"].energy)
    assert unexplained(simulation) < CLOSES


# ------------------------------------------------------------------------------------------------ the speed limit

#: hot gas, so light next to tungsten that all of its vertices are under-filled, rushes against the edges
LIMITED = (
    mesh(("8 mm", 8), ("16 mm", 16))
    + box("block", "W_X21C", r=[0.0, "3.3 mm"], z=["5.6 mm", "10 mm"])
    + box("gas", "gas_7_5", z=["1.5 mm", "14.5 mm"], r=[0.0, "6.6 mm"], density=1.2, pressure="20 MPa")
    + stop("1 ms")
)
GRAVITY = entry("source", name="gravity", kind="acceleration", body="gas", axial=-1e9)


@pytest.mark.parametrize("source", ["", GRAVITY], ids=["free", "pushed"])
@pytest.mark.parametrize("edge", ["wall", "outflow", "transmit", "velocity"])
def test_the_speed_limit_acts_where_edges_do(edge, source):
    speeds = {f"{each}_velocity": 100.0 for each in ("r_max", "z_min", "z_max")} if edge == "velocity" else {}
    text = LIMITED + source + table("boundaries", r_max=edge, z_min=edge, z_max=edge, **speeds)
    simulation = after(text, 80)
    assert simulation.audit.sinks["speed_limit"].energy > 1e-5 * simulation.audit.start.energy
    assert unexplained(simulation) < CLOSES


def test_the_speed_limit_acts_on_masters_of_a_contact():
    simulation = after(LIMITED + contact("block") + walls("r_max", "z_min", "z_max"), 80)
    assert simulation.audit.sinks["speed_limit"].energy > 1e-5 * simulation.audit.start.energy
    assert unexplained(simulation) < CLOSES


# ------------------------------------------------------------------------------------------------ at rest

AT_REST = (
    mesh(("8 mm", 8), ("30 mm", 30))
    + table("boundaries", z_max="transmit")
    + body("ball", "W_X21C", "sphere", centre="12.3 mm", radius="4.2 mm")
    + box("block", "Al5083", r=[0.0, "6.3 mm"], z=["16.5 mm", "30 mm"])
    + stop("2 us")
)
LATE = entry("source", name="late", kind="heating", body="block", power=[["1 us", 0.0], ["1.1 us", 1e12], ["1.2 us", 0.0]])


@pytest.mark.parametrize("sliding", ["", contact("ball")], ids=["bonded", "contact"])
@pytest.mark.parametrize("source", ["", LATE], ids=["cold", "heated"])
def test_bodies_at_rest_add_up(source, sliding):
    """Round-off of the stresses is not measured against an energy of zero."""
    simulation = Simulation(decks.loads(AT_REST + source + sliding))
    while simulation.time < 1.5e-6:
        simulation.engine.advance()
        assert simulation.faults() == []
        assert unexplained(simulation) < 1e-6
    assert (abs(simulation.state.v).max() > 1.0) == bool(source)


# ------------------------------------------------------------------------------------------------ all of them together


@pytest.mark.thorough
@pytest.mark.parametrize(("edge", "sliding"), sorted({(each.edge, each.sliding) for each in audited.all_choices()}))
def test_every_choice_with_every_other(edge, sliding):
    """Edges of all kinds, sliding, advection, sources, a mesh that follows."""
    errors = {}
    for choices in audited.all_choices():
        if (choices.edge, choices.sliding) == (edge, sliding):
            text = audited.deck(202, choices)
            errors[choices] = (unexplained_by_sound(after(text, 60)), text)
    bounds = {choices: CLOSES_BESIDE_PRODUCTS if choices.source == "detonation" else CLOSES for choices in errors}
    assert {choices: result for choices, result in errors.items() if not result[0] < bounds[choices]} == {}
