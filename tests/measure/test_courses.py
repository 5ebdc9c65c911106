"""The course of every body: its centre of mass follows its momentum, through edges of the mesh as well."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.measure.courses import PARTED, PARTED_OF_WAY
from hydro2d.mesh.fields import RHO
from hydro2d.solver.simulation import Simulation
from tests.decks import box, mesh, stop, table, walls
from tests.restarts import restarted

NO_FRACTURE = table("failure", tensile="none")
PLAIN = mesh(("1 mm", 10), ("4 mm", 40)), mesh(("1 mm", 10), ("4 mm", 40), geometry="planar")


def shot(*parts: str) -> Simulation:
    return Simulation(deck.loads("".join(parts) + NO_FRACTURE + stop("10 us")))


def foil(speed: float = 1000.0) -> str:
    return box("foil", "Al5083", r=["0 mm", "0.4 mm"], z=["1.03 mm", "1.06 mm"], velocity=f"{speed} m/s")


def run(simulation: Simulation, end: float) -> np.ndarray:
    """Largest deviation of the bodies, in cells."""
    most = np.zeros_like(simulation.engine.courses.apart)
    while simulation.time < end:
        simulation.step()
        np.maximum(most, np.abs(simulation.engine.courses.apart), out=most)
    assert simulation.cycle > 20  # and was checked every ten cycles
    return most


@pytest.mark.parametrize("plain", PLAIN)
def test_a_foil_is_on_its_course_along_z(plain):
    simulation = shot(plain, walls("r_max"), foil())
    assert run(simulation, 1e-6).max() < 1e-4
    assert simulation.engine.courses._way[0, 1] == pytest.approx(10.0, rel=0.1)
    assert simulation.doubts() == []


def test_a_ring_is_on_its_course_along_r():
    ring = box("ring", "Al5083", r=["0.33 mm", "0.36 mm"], z=["1 mm", "2 mm"], velocity=["300 m/s", "0 m/s"])
    simulation = shot(PLAIN[0], ring)
    assert run(simulation, 5e-7).max() < 0.02
    assert simulation.engine.courses._way[0, 0] > 1.0


def test_outflow_through_the_edges_takes_its_share_along():
    """Half of a block leaves through the upper edge, and a fifth of another one through the outer edge."""
    upward = box("upward", "Al5083", r=["0 mm", "0.5 mm"], z=["3 mm", "4 mm"], velocity="1000 m/s")
    outward = box("outward", "Al5083", r=["0.5 mm", "1 mm"], z=["1 mm", "2 mm"], velocity=["1000 m/s", "0 m/s"])
    simulation = shot(PLAIN[1], upward, outward)
    assert run(simulation, 5e-7).max() < 0.05
    lost = simulation.audit.sinks["outflow"].mass / simulation.audit.start.mass
    assert (lost > 0.2).all()


def test_bodies_that_a_travelling_mesh_meets_enter_in_place():
    follow = mesh(("1 mm", 10), ("4 mm", 40), follow="rod")
    rod = box("rod", "W_alloy", r=["0 mm", "0.4 mm"], z=["0.5 mm", "1.5 mm"], velocity="1000 m/s")
    ahead = box("ahead", "Al5083", r=["0 mm", "1 mm"], z=["3.03 mm", "9 mm"])
    simulation = shot(follow, rod, ahead)
    assert run(simulation, 1.4e-6).max() < 1e-3
    assert -simulation.audit.sinks["inflow"].mass[1] > simulation.audit.start.mass[1]


@pytest.mark.parametrize(("row", "axis"), [(0, "r"), (1, "z")])
def test_a_body_that_is_not_where_its_momentum_takes_it_is_not_trusted(row, axis):
    simulation = shot(PLAIN[1], walls("r_max"), foil(), box("witness", "Al5083", z=["3 mm", "3.8 mm"]))
    while simulation.cycle < 15:
        simulation.step()
    simulation.state.centroid[row, 0][simulation.state.vof[0] > 0.0] += 0.15
    for _ in range(6):
        simulation.step()
    (doubt,) = simulation.doubts()
    assert doubt.startswith("cycle 20, time ")
    assert f"cells ahead of where its momentum has taken its centre of mass along {axis}" in doubt
    assert float(doubt.split('body "foil" is ')[1].split()[0]) == pytest.approx(0.15, abs=0.011)


def test_how_far_a_body_may_be_off():
    courses = shot(PLAIN[0], foil()).engine.courses
    courses.apart[0] = 0.99 * PARTED, -0.99 * PARTED
    assert list(courses.parted(["foil"])) == []
    courses.apart[0, 1] = -1.01 * PARTED
    assert [doubt.sentence for doubt in courses.parted(["foil"])] == [
        'body "foil" is 0.1 cells behind where its momentum has taken its centre of mass along z, after a way of 0 cells']
    courses._way[0, 1] = 1.1 * PARTED / PARTED_OF_WAY
    assert list(courses.parted(["foil"])) == []


def squeezed(part: float) -> Simulation:
    """A plate of 1.2 mm on cells of 0.1 mm, of which `part` of the length of a cell stays in each."""
    simulation = shot(PLAIN[1], walls("r_max"), box("plate", "Al5083", z=["1 mm", "2.2 mm"]))
    courses, s = simulation.engine.courses, simulation.state
    s.vof[0] *= part
    s.q[RHO, 0] *= 0.5 / part
    courses.look(0.0)
    courses.apart[0] = PARTED + 1.0, 0.0
    return simulation


def test_the_course_of_a_film_or_a_cloud_decides_nothing():
    """A body that fills no cell any more, and one that has ten times its volume of the start."""
    (doubt,) = squeezed(1.0).engine.courses.parted(["plate"])
    assert not doubt.harmless
    (note,) = squeezed(0.5).engine.courses.parted(["plate"])
    assert note.harmless == "most of its mass is in cells that it does not fill"
    simulation = shot(PLAIN[1], walls("r_max"), box("plate", "Al5083", z=["1 mm", "2.2 mm"]))
    courses = simulation.engine.courses
    for factor, harmless in ((0.11, False), (0.09, True)):
        rho = simulation.state.q[RHO, 0].copy()
        simulation.state.q[RHO, 0] *= factor
        courses.look(0.0, keep=False)
        courses.apart[0] = PARTED + 1.0, 0.0
        (said,) = courses.parted(["plate"])
        assert bool(said.harmless) == harmless
        simulation.state.q[RHO, 0] = rho


def test_a_foil_is_judged_though_it_fills_no_cell():
    courses = shot(PLAIN[0], foil()).engine.courses
    courses.look(0.0)
    courses.apart[0] = 0.0, PARTED + 1.0
    (doubt,) = courses.parted(["foil"])
    assert not doubt.harmless


def test_a_restart_goes_on_with_the_course():
    text = "".join((PLAIN[0], walls("r_max"), foil())) + NO_FRACTURE + stop("10 us")
    first = Simulation(deck.loads(text))
    for _ in range(15):
        first.step()
    second = restarted(first)
    for simulation in (first, second):
        while simulation.cycle < 40:
            simulation.step()
    assert first.engine.courses.saved() == second.engine.courses.saved()
    assert first.conservation()["off_course_cells"] == {"foil": np.abs(first.engine.courses.apart).max()}
