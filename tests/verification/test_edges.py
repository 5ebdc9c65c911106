"""Edges of the mesh: a body in free flight leaves through an open one unchanged, waves leave through a transmitting one."""

import numpy as np
import pytest

from hydro2d.base.errors import DeckError, UnphysicalState
from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, contact, material, mesh, rod, stop, table, walls
from tests.verification.running import ADVECTION, advection

FLIGHT = (
    mesh(("12 mm", 20), ("12 mm", 20), geometry="planar")
    + table("boundaries", r_min="outflow")
    + body("block", "W_alloy", "polygon", points=[["4 mm", "4.3 mm"], ["7 mm", "3.5 mm"], ["8.2 mm", "7 mm"], ["5 mm", "8 mm"]])
    + box("gas", "Al5083", r=["5 mm", "6 mm"], z=["9 mm", "9.7 mm"])
    + stop("13 us")
)
CONTACT = 'sliding.method="contact"', 'sliding.hard=["block"]'
SPEED = 1000.0


def leaves_unchanged(simulation: Simulation, m: int, velocity: tuple[float, float]) -> None:
    """Runs to the end: body m keeps its velocity to 1e-6 and its pressure below 1 MPa until none of it is left."""
    s, g = simulation.state, simulation.grid
    mass = simulation.body_sums(m)[0].sum()
    while simulation.stop_reason() is None:
        simulation.step()
        share = g.interior(s.vof)[m]
        there = np.zeros(np.add(share.shape, 1), dtype=bool)
        for corner in (np.s_[:-1, :-1], np.s_[1:, :-1], np.s_[:-1, 1:], np.s_[1:, 1:]):
            there[corner] |= share > 1e-6
        for field, expected in zip((s.u, s.v), velocity, strict=True):
            assert np.abs(g.interior_vertices(field)[s.group[m]][there] - expected).max(initial=0.0) < 1e-6 * SPEED
        assert np.abs(g.interior(s.vof * s.pm)[m]).max() < 1e6
    assert simulation.body_sums(m)[0].sum() < 1e-9 * mass
    balance = simulation.conservation()
    assert max(map(abs, balance["mass"].values())) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12
    assert abs(balance["total_energy"]) < 1e-12


@pytest.mark.parametrize("options", [(), CONTACT], ids=["one velocity", "contact"])
@pytest.mark.parametrize("choice", ADVECTION)
@pytest.mark.parametrize("direction", [(0, 1), (0, -1), (1, 0), (-1, 0), (0.6, 0.8)], ids=str)
def test_free_flight_through_an_open_edge(direction, choice, options):
    """All bodies move together. Earlier, `ke` braked the body to 122 m/s and put it under 2.5 GPa."""
    velocity = (SPEED * direction[0], SPEED * direction[1])
    bodies = [f"body.{name}.velocity=[{velocity[0]}, {velocity[1]}]" for name in ("block", "gas")]
    leaves_unchanged(Simulation(decks.loads(FLIGHT, [*bodies, advection(choice), *options])), 0, velocity)


BEHIND = (
    mesh(("9 mm", 15), ("-8 mm", "8 mm", 24), follow="rod")
    + rod("2.1 mm", "4 mm", nose="flat", tip="1 mm", velocity="1000 m/s")
    + box("ring", "Al5083", r=["5 mm", "7.3 mm"], z=["0.4 mm", "5.5 mm"])
    + stop("16 us")
)


@pytest.mark.parametrize("choice", ADVECTION)
def test_a_body_that_a_following_mesh_leaves_behind(choice):
    """A ring at rest goes out through the rear edge as the mesh passes it."""
    leaves_unchanged(Simulation(decks.loads(BEHIND, [advection(choice)])), 1, (0.0, 0.0))


WAVE = (
    mesh(("120 mm", "1 mm"), ("-10 mm", "10 mm", "0.5 mm"), geometry="planar")
    + table("boundaries", r_min="outflow", z_min="transmit", z_max="transmit")
    + box("kick", "Al_elastic", z=["-2 mm", "2 mm"])
    + box("plate", "Al_elastic", join="kick", z=["-1 m", "1 m"])
    + material("Al_elastic", "Al5083", fracture_pressure="10 GPa",
               strength={"model": "elastic-plastic", "shear_modulus": "26 GPa", "yield_stress": "10 GPa"})
    + stop("8 us")
)
FREE = 'boundaries.z_min="outflow"', 'boundaries.z_max="outflow"'
LONG = "mesh.z_start=-0.06", 'mesh.z=[{ to = "60 mm", size = "0.5 mm" }]'


def middle(simulation: Simulation, component: str) -> np.ndarray:
    """Velocity along the line in the middle of the plate, within 10 mm of its centre, m/s."""
    while simulation.stop_reason() is None:
        simulation.step()
    z = simulation.grid.z_edges
    column = simulation.grid.nr // 2
    values = simulation.grid.interior_vertices(getattr(simulation.state, component))[0, :, column]
    return values[(z > -10.2e-3) & (z < 10.2e-3)]


@pytest.mark.parametrize(("velocity", "component", "time"), [((0.0, 10.0), "v", "4 us"), ((10.0, 0.0), "u", "7 us")],
                         ids=["longitudinal", "shear"])
def test_a_plane_wave_leaves_through_a_transmitting_edge(velocity, component, time):
    """A pulse of 5 m/s goes out; a free surface sends all of it back, the edge 3.3 % (longitudinal) and 5.4 % (shear).

    The pulse is eight cells long, and the reflection is mostly the ringing behind its steep ends.
    """
    options = [f"body.kick.velocity={list(velocity)}", f"stop.time={time[0]}e-6"]
    left = middle(Simulation(decks.loads(WAVE, options)), component)
    endless = middle(Simulation(decks.loads(WAVE, [*options, *LONG])), component)
    free = middle(Simulation(decks.loads(WAVE, [*options, *FREE])), component)
    assert np.abs(free - endless).max() > 3.0
    assert np.abs(left - endless).max() < (0.2 if component == "v" else 0.3)


def test_flow_through_transmitting_edges_is_recorded():
    simulation = Simulation(decks.loads(WAVE, ["body.kick.velocity=[0.0, 10.0]", "stop.time=4e-6"]))
    start = simulation.conservation()["start_energy_J"]
    middle(simulation, "v")
    balance = simulation.conservation()
    assert balance["sinks"]["transmitted"]["energy_J"] > 0.8 * start
    assert abs(balance["total_energy"]) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12


CORNER = (
    mesh(("10 mm", 20), ("-10 mm", "10 mm", 40))
    + table("boundaries", z_max="transmit", r_max="transmit")
    + box("hot", "Al5083", r=["7 mm", "9 mm"], z=["6 mm", "8 mm"], velocity=["40 m/s", "60 m/s"])
    + box("other", "Al5083", join="hot", r=["7 mm", "9 mm"], z=["-9 mm", "-7 mm"], velocity=["40 m/s", "60 m/s"])
    + box("plate", "Al5083", join="hot", r=["0 mm", "1 m"], z=["-1 m", "1 m"])
    + stop("4 us")
)


@pytest.mark.parametrize("geometry", ["cylindrical", "planar"])
@pytest.mark.parametrize("lower", ["transmit", "wall", "velocity", "outflow"])
def test_the_corner_of_a_transmitting_edge_is_counted_once(lower, geometry):
    """Waves reach every corner: of two transmitting edges, and of one with the axis, a wall, a piston and an open edge."""
    options = ["boundaries.z_min_velocity=5.0"] if lower == "velocity" else []
    options += [f'mesh.geometry="{geometry}"', f'boundaries.z_min="{lower}"']
    simulation = Simulation(decks.loads(CORNER, options))
    while simulation.stop_reason() is None:
        simulation.step()
    balance = simulation.conservation()
    assert balance["sinks"]["transmitted"]["energy_J"] > 0.2 * balance["start_energy_J"]
    assert abs(balance["total_energy"]) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12


@pytest.mark.parametrize(("choice", "energy"), [
    *((choice, 5e6) for choice in ADVECTION), *((choice, 2e7) for choice in ADVECTION if choice != "ke"), pytest.param(
        "ke", 2e7, marks=pytest.mark.xfail(strict=True, raises=UnphysicalState, reason="ke_bound takes 2.2 % of 2 %"))])
def test_hot_debris_that_leaves_takes_nothing_unnamed_along(choice, energy):
    """A ball of aluminium with several times the energy of evaporation bursts and flies out through three open edges."""
    ball = body("ball", "Al6061_T6", "sphere", centre=0.0, radius="5 mm", energy=energy)
    text = mesh(("10 mm", 12), ("-10 mm", "10 mm", 24)) + ball + stop("20 us")
    simulation, worst = Simulation(decks.loads(text, [advection(choice)])), 0.0
    while simulation.time < 20e-6:
        simulation.step()
        audit = simulation.conservation()
        worst = max(worst, abs(audit["total_energy"]), abs(audit["axial_momentum"]), abs(audit["mass"]["ball"]))
    assert worst < 1e-12
    assert simulation.audit.sinks["outflow"].mass.sum() > 0.1 * simulation.audit.start.mass.sum()  # much has to be audited
    assert simulation.faults() == []


# ------------------------------------------------------------------------------------------------ an anvil

#: an elastic bar of 50 mm meets a rigid surface at 20 m/s: the wave is back after 2 L/c = 19.3 us, c = 5.18 km/s along a bar
BAR = (
    mesh(("8 mm", "0.5 mm"), ("56 mm", "0.5 mm"))
    + material("bar", "steel_4340", strength={"model": "elastic-plastic", "yield_stress": "2 GPa", "shear_modulus": "80 GPa"},
               fracture_pressure="4 GPa")
    + body("bar", "bar", "box", r=[0.0, "4.25 mm"], z=[0.0, "50 mm"], velocity="-20 m/s")
    + stop("30 us")
)  # fmt: skip


def ended(text: str, time: float, *options: str) -> Simulation:
    simulation = Simulation(decks.loads(text, options))
    while simulation.time < time:
        simulation.engine.advance()
    return simulation


def test_a_slab_rebounds_from_an_anvil_as_a_wall_holds_it_until_then():
    """The wave is back after 2 L/c = 17 us, c = 5.88 km/s along a slab."""
    slab = BAR.replace('"4.25 mm"', '"8 mm"')
    wall, anvil = (ended(slab + walls("r_max", z_min=kind), 14e-6) for kind in ("wall", "anvil"))
    for name in ("q", "vof", "u", "v"):
        np.testing.assert_array_equal(getattr(wall.state, name), getattr(anvil.state, name))
    for simulation in (wall, anvil):
        while simulation.time < 24e-6:
            simulation.engine.advance()
    assert 19.0 < anvil.mean_velocity(0) < 20.0  # 19.42: the rest is in the front, some cells thick
    assert wall.mean_velocity(0) < 10.0


def test_a_bar_rebounds_from_an_anvil():
    speeds, anvil = [], ended(BAR, 0.0, 'boundaries.z_min="anvil"')
    for time in (22e-6, 30e-6):
        while anvil.time < time:
            anvil.engine.advance()
        speeds.append(anvil.mean_velocity(0))
    assert 18.0 < speeds[0] < 20.0  # the rest is in waves that the bar keeps
    assert speeds[1] == pytest.approx(speeds[0], rel=1e-12)
    assert np.abs(anvil.audit.sinks["walls"].momentum) > 0.0
    assert abs(anvil.conservation()["axial_momentum"]) < 1e-12
    assert abs(anvil.conservation()["total_energy"]) < 1e-12
    assert anvil.conservation()["off_course_cells"]["bar"] < 0.01


@pytest.mark.parametrize("sliding", ["", "contact"], ids=["bonded", "contact"])
def test_a_ball_goes_about_between_four_anvils(sliding):
    """It hits one side after another, once with a loose block in its way: nothing leaves, and the audit closes."""
    text = (
        mesh(("20 mm", 20), ("20 mm", 20), geometry="planar")
        + table("boundaries", r_min="anvil", r_max="anvil", z_min="anvil", z_max="anvil")
        + body("ball", "steel_4340", "sphere", centre=["14 mm", "13 mm"], radius="4 mm", velocity=["400 m/s", "260 m/s"])
        + (box("block", "Al5083", r=["1 mm", "5 mm"], z=["13 mm", "18 mm"]) + contact("ball") if sliding else "")
        + stop("200 us")
    )  # fmt: skip
    simulation = ended(text, 60e-6)
    assert simulation.state.u[0].min() >= -400.0
    assert simulation.audit.sinks["walls"].momentum > 1.0
    assert simulation.audit.sinks["outflow"].momentum == 0.0
    balance = simulation.conservation()
    assert max(map(abs, (*balance["mass"].values(), balance["axial_momentum"], balance["total_energy"]))) < 1e-11


@pytest.mark.parametrize("edge", ["r_min", "r_max", "z_min", "z_max"])
def test_every_edge_can_be_an_anvil(edge):
    """A block that touches it flies off unhindered, and one that flies at it stays in the mesh."""
    axis, inward = edge[0] == "z", 1.0 if edge.endswith("min") else -1.0
    across, along = ["3 mm", "9 mm"], (["0 mm", "4 mm"] if inward > 0 else ["8 mm", "12 mm"])
    r, z = (across, along) if axis else (along, across)

    def flying(speed: float, kind: str) -> Simulation:
        velocity = [0.0, speed] if axis else [speed, 0.0]
        text = (mesh(("12 mm", 12), ("12 mm", 12), geometry="planar")
                + table("boundaries", **({"r_min": "outflow"} | {edge: kind}))
                + box("block", "Al5083", r=r, z=z, velocity=velocity) + stop("1 ms"))
        return ended(text, 4e-6)

    free = flying(inward * 100.0, "anvil")
    velocity = free.state.v if axis else free.state.u
    mass = free.state.mass
    np.testing.assert_allclose(velocity[mass > 0.0], inward * 100.0, rtol=1e-9)
    assert free.audit.sinks["walls"].momentum == 0.0
    met, open_end = flying(-inward * 100.0, "anvil"), flying(-inward * 100.0, "outflow")
    assert met.conservation()["mass"]["block"] == pytest.approx(0.0, abs=1e-12)
    assert met.audit.sinks["outflow"].mass[0] == 0.0 < open_end.audit.sinks["outflow"].mass[0]
    there = met.state.mass > 0.0
    assert np.abs((met.state.v if axis else met.state.u)[there]).min() < 20.0


def test_a_mesh_that_follows_has_no_anvil_along_z():
    text = mesh(("12 mm", 12), ("30 mm", 30), follow="rod") + rod("2 mm", "10 mm", tip="12 mm", velocity=500.0) + stop("1 us")
    with pytest.raises(DeckError, match="an anvil cannot travel with it"):
        decks.loads(text + table("boundaries", z_min="anvil"))
