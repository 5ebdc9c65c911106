"""Edges of the mesh: a body in free flight leaves through an open one unchanged, waves leave through a transmitting one."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, material, mesh, rod, stop, table
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
    """Runs to the end: body m keeps its velocity to 1e-6 and its pressure below 1 MPa until nothing of it is left."""
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
    found = simulation.conservation()
    assert max(map(abs, found["mass"].values())) < 1e-12
    assert abs(found["axial_momentum"]) < 1e-12
    assert abs(found["total_energy"]) < 1e-12


@pytest.mark.parametrize("options", [(), CONTACT], ids=["one velocity", "contact"])
@pytest.mark.parametrize("choice", ADVECTION)
@pytest.mark.parametrize("direction", [(0, 1), (0, -1), (1, 0), (-1, 0), (0.6, 0.8)], ids=str)
def test_free_flight_through_an_open_edge(direction, choice, options):
    """All bodies move alike. Before, `ke` braked the body to 122 m/s and put it under 2.5 GPa."""
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
def test_what_a_following_mesh_leaves_behind(choice):
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
    """A pulse of 5 m/s goes out; a free surface sends all of it back, the edge 2.4 % (longitudinal) and 5.4 % (shear).

    The pulse is eight cells long, and what comes back is mostly the ringing behind its steep ends.
    """
    options = [f"body.kick.velocity={list(velocity)}", f"stop.time={time[0]}e-6"]
    left = middle(Simulation(decks.loads(WAVE, options)), component)
    endless = middle(Simulation(decks.loads(WAVE, [*options, *LONG])), component)
    free = middle(Simulation(decks.loads(WAVE, [*options, *FREE])), component)
    assert np.abs(free - endless).max() > 3.0
    assert np.abs(left - endless).max() < (0.15 if component == "v" else 0.3)


def test_what_goes_through_transmitting_edges_is_recorded():
    simulation = Simulation(decks.loads(WAVE, ["body.kick.velocity=[0.0, 10.0]", "stop.time=4e-6"]))
    start = simulation.conservation()["start_energy_J"]
    middle(simulation, "v")
    found = simulation.conservation()
    assert found["sinks"]["transmitted"]["energy_J"] > 0.8 * start
    assert abs(found["total_energy"]) < 1e-12
    assert abs(found["axial_momentum"]) < 1e-12


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
    found = simulation.conservation()
    assert found["sinks"]["transmitted"]["energy_J"] > 0.2 * found["start_energy_J"]
    assert abs(found["total_energy"]) < 1e-12
    assert abs(found["axial_momentum"]) < 1e-12




@pytest.mark.parametrize("choice", ADVECTION)
@pytest.mark.parametrize("energy", [5e6, 2e7])
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
    assert simulation.audit.sinks["outflow"].mass.sum() > 0.1 * simulation.audit.start.mass.sum()  # there is much to audit
    assert simulation.faults() == []
