"""Contact with two velocity fields, on the decks of problems/sliding: what must and must not happen at an interface."""

import functools
import math

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.output.derived_quantities import Cells
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, contact, mesh, stop, table, walls
from tests.verification.running import ADVECTION, Line, advection, between, finish, to_the_end

FOLDER = "problems/sliding"
#: the single velocity of all bodies, with which contact is compared
SINGLE = 'sliding.method="none"', "sliding.friction=0.0"
#: upper end of the tungsten in mm, in cells of 0.5 mm, and the share of its cell that it fills
CUTS = {"2 %": 0.01, "50 %": 0.25, "98 %": 0.49}
EDGE = {"edge": 0.0}
#: an under-filled node of tungsten, whose surface recedes into the next cell
LIGHT = {"70 %": 0.35}
P, U = 14.1016e9, 817.535  # impedance match at 1 km/s, as in test_planar_impact.py


def cases(table):
    """The values of a table, with its keys as names."""
    return [pytest.param(value, id=key) for key, value in table.items()]


def cut_at(end: float) -> str:
    """The override that puts the interface of impact_head_on and parting at ``end`` (mm)."""
    return f'body.flyer.z=["-30 mm", "{end} mm"]'


@functools.cache
def run(name: str, *overrides: str):
    """A deck of problems/sliding at its end; each combination of overrides runs once. Not to be modified."""
    return finish(decks.load(f"{FOLDER}/{name}.toml", ["numbers=SI", *overrides]))


def velocities(simulation, m: int):
    """u and v of the group of body m, at the vertices where it has mass."""
    s, k = simulation.state, simulation.state.group[m]
    there = simulation.grid.interior_vertices(s.mass[k]) > 0.0
    return (simulation.grid.interior_vertices(w[k])[there] for w in (s.u, s.v))


def closed(simulation) -> None:
    """Mass, momentum and energy are kept, and the speed limit applied at no vertex."""
    balance = simulation.conservation()
    assert max(abs(x) for x in balance["mass"].values()) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12
    assert abs(balance["total_energy"]) < 1e-11  # 4.6e-12 as the rod leaves its hole, elsewhere below 1e-12
    assert balance["sinks"]["speed_limit"]["energy_J"] == 0.0


# ---------------------------------------------------------------------------------------------------- head-on, parting


def plateau(simulation) -> tuple[float, float]:
    """Pressure and velocity of the target between the interface and its shock."""
    line, cells = Line(simulation), Cells(simulation)
    here = between(line.x, U * simulation.time + 1e-3, 6484.55 * simulation.time)
    return cells.by_volume(cells.p)[here].mean(), cells.velocity()[here, :, 1].mean()


@pytest.mark.parametrize("choice", ADVECTION)
@pytest.mark.parametrize("end", cases(CUTS))
def test_head_on_impact(end, choice):
    simulation = run("impact_head_on", cut_at(end), advection(choice))
    p, u = plateau(simulation)
    assert p == pytest.approx(P, rel=5e-3)
    assert u == pytest.approx(U, rel=5e-3)
    closed(simulation)


@pytest.mark.parametrize("choice", ADVECTION)
@pytest.mark.parametrize("end", cases(CUTS))
def test_head_on_impact_is_that_of_a_single_velocity(end, choice):
    single = plateau(run("impact_head_on", cut_at(end), advection(choice), *SINGLE))
    assert single == pytest.approx((P, U), rel=5e-3)
    assert plateau(run("impact_head_on", cut_at(end), advection(choice))) == pytest.approx(single, rel=5e-3)


@pytest.mark.parametrize("choice", ADVECTION)
@pytest.mark.parametrize("end", cases(CUTS | LIGHT | EDGE))
def test_parting_bodies_do_not_hold_each_other(end, choice):
    pressure = []
    simulation = finish(
        decks.load(f"{FOLDER}/parting.toml", [cut_at(end), advection(choice)]),
        watch=lambda s: pressure.append(np.abs(s.state.p).max()),
    )
    assert max(pressure) < 1e6
    for m, v in enumerate((-100.0, 100.0)):
        assert np.abs(list(velocities(simulation, m))[1] - v).max() < 1e-9 * 100.0
    closed(simulation)


def test_a_single_velocity_holds_parting_bodies():
    """The previous test would fail like this without contact."""
    assert np.abs(run("parting", *SINGLE).state.p).max() > 1e8


# ---------------------------------------------------------------------------------------------------- level blocks


@pytest.mark.thorough
@pytest.mark.parametrize("choice", ADVECTION)
def test_level_blocks_keep_their_momentum(choice):
    """Without load, without friction: over eight cells slid 1e-7 to 4e-7 of the slider's momentum goes to the base.

    It goes at single moments, when an end of the slider passes a mesh line: with steps of another length 1e-11 to 4e-7.
    """
    simulation = run("block_level", advection(choice))
    (mass, slider), (_, base) = ([float(rows.sum()) for rows in simulation.body_sums(m)] for m in (0, 1))
    assert slider == pytest.approx(mass * 100.0, rel=1e-6)
    assert abs(base) < 1e-6 * mass * 100.0
    closed(simulation)


def test_a_single_velocity_drags_the_base_along():
    simulation = run("block_level", *SINGLE)
    assert simulation.body_sums(1)[1].sum() > 0.02 * simulation.body_sums(0)[1].sum()


def tractions(simulation) -> tuple[float, float, float]:
    """Shear traction on slider and base from the momentum of the rows that the ends do not reach, and their pressure; Pa."""
    rows = np.abs(simulation.grid.zc[simulation.grid.inside[0]] - 24e-3) < 4e-3
    area = rows.sum() * 0.25e-3
    cells = Cells(simulation)
    gained = []
    for m, v in enumerate((50.0, 0.0)):
        mass, momentum = (values[rows].sum() for values in simulation.body_sums(m))
        gained.append((momentum - mass * v) / (area * simulation.time))
    return *gained, cells.by_volume(cells.p)[rows].mean()


@pytest.mark.parametrize("friction", [0.1, 0.2, 0.3])
def test_friction_is_the_coefficient_times_the_load(friction):
    """Deceleration mu N/m of the slider and acceleration of the base, within 2 %; the load is 100 MPa."""
    simulation = run("block_level_friction", f"sliding.friction={friction}")
    slider, base, p = tractions(simulation)
    closed(simulation)
    assert p == pytest.approx(100e6, rel=0.02)
    assert base == pytest.approx(friction * 100e6, rel=0.02)
    assert slider == pytest.approx(-friction * 100e6, rel=0.02)


def test_load_without_friction_drags_nothing():
    slider, base, p = tractions(run("block_level_friction", "sliding.friction=0.0"))
    assert p == pytest.approx(100e6, rel=1e-3)
    assert abs(base) < 1e-4 * p
    assert abs(slider) < 1e-4 * p


def test_a_single_velocity_is_tied_contact():
    """Welded, the blocks send shear waves of 50 m/s/(1/Z_W + 1/Z_Al) into each other: 358 MPa, until 1.49 us."""
    slider, base, _ = tractions(run("block_level_friction", *SINGLE, "stop.time=1.4e-6"))
    impedance = [math.sqrt(rho * modulus) for rho, modulus in ((18160.0, 145e9), (2660.0, 26e9))]
    assert base == pytest.approx(50.0 / sum(1.0 / z for z in impedance), rel=0.02)
    assert slider == pytest.approx(-base, rel=1e-3)


# ---------------------------------------------------------------------------------------------------- inclined blocks


def drift(simulation) -> tuple[float, float]:
    """Work done by slip in |r|, |z| < 2 mm over p L s, and the largest departure from p over p.

    L is the interface's length there, s the slip. The work is the growth of the specific energies, so that the amount of each
    body in the region does not matter.
    """
    g, slider, cells = simulation.grid, simulation.deck.body[0], Cells(simulation)
    middle = np.ix_(*(np.abs(x) < 2e-3 for x in (g.zc[g.inside[0]], g.rc[g.inside[1]])))
    first = Cells(Simulation(simulation.deck)).e.max(axis=(1, 2), keepdims=True)
    work = np.sum((cells.vof * cells.rho * (cells.e - first))[:, *middle]) * 0.25e-3**2
    u, v = slider.velocity
    length, slip = 4e-3 * math.hypot(u, v) / v, math.hypot(u, v) * simulation.time
    departure = np.abs(cells.by_volume(cells.p)[middle] / slider.pressure - 1.0).max()
    return float(work) / (slider.pressure * length * slip), float(departure)


@pytest.mark.thorough
@pytest.mark.parametrize("angle", [15, 30, 45])
def test_slip_along_an_inclined_interface_does_no_work(angle):
    """One cell slid under 1 GPa: the energy drifts by less than 1e-4 of p L s."""
    assert abs(drift(run(f"block_inclined_{angle}"))[0]) < 1e-4


@pytest.mark.parametrize("angle", [15, 30, 45])
def test_slip_along_an_inclined_interface_keeps_the_pressure(angle):
    assert drift(run(f"block_inclined_{angle}"))[1] < 1e-2


@pytest.mark.thorough
@pytest.mark.parametrize("angle", [15, 30, pytest.param(45, marks=pytest.mark.xfail(
    strict=True, reason="0.86e-3 p L s; it was 2.4e-3 while the hourglass filter damped smooth modes as well"))])
def test_a_single_velocity_does_work(angle):
    assert drift(run(f"block_inclined_{angle}", *SINGLE))[0] > 1e-3


# ---------------------------------------------------------------------------------------------------- a rod and its hole


@pytest.mark.thorough
@pytest.mark.parametrize("choice", ADVECTION)
def test_rod_leaves_its_hole_without_drag(choice):
    simulation = run("rod_leaving_hole", advection(choice))
    mass = simulation.body_sums(0)[0].sum()
    assert simulation.mean_velocity(0) == pytest.approx(-200.0, rel=0.005)
    gained = 1.0 + simulation.mean_velocity(0) / 200.0
    assert abs(simulation.body_sums(1)[1].sum() / (mass * 200.0)) == pytest.approx(gained, rel=0.05)
    closed(simulation)


@pytest.mark.xfail(strict=True, reason="at the corners of rod and hole no straight line cuts the cells as the bodies do: 0.2 %")
def test_rod_leaves_its_hole_as_it_was():
    simulation = run("rod_leaving_hole")
    assert simulation.mean_velocity(0) == pytest.approx(-200.0, rel=1e-9)


def test_bodies_that_touch_beyond_the_active_cells_are_no_contact_yet():
    """A ball on two plates that lie on one another: where nothing has arrived, no pressure can be shared. It used to be NaN."""
    options = ['sliding.hard=["ball", "second"]', "body.plate.thickness=3 mm", "body.second.z_front=3 mm", 'mesh.follow="none"']
    simulation = Simulation(decks.load("problems/perforation/two_plates.toml", options))
    assert simulation.engine.box != simulation.engine.mesh_box.tolist()
    for _ in range(40):
        simulation.step()
    assert np.isfinite(simulation.state.velocity).all()
    assert abs(simulation.conservation()["total_energy"]) < 1e-11


INSIDE = (
    mesh(("6 mm", 24), ("10 mm", 40), geometry="planar")
    + walls("r_min", "r_max")
    + box("block", "steel_4340_power_law", r=["1.248 mm", "2.012 mm"], z=["2.1 mm", "7.3 mm"], velocity="2500 m/s")
    + box("slider", "W_alloy", r=["0 mm", "2.1 mm"], z=["-1 mm", "11 mm"], velocity="50 m/s", pressure="100 MPa",
          flow={"pattern": "cylindrical", "speed": -500.0, "centre": "9.2 mm", "radius": "1.8 mm", "exponent": 1.0})
    + box("base", "Al5083", r=["2.1 mm", "6 mm"], z=["-1 mm", "11 mm"], pressure="100 MPa")
    + table("numerics", initial_dt_factor=1.0)
    + contact("slider")
    + stop("1 us", cycles=5)
)


def test_no_body_flows_out_of_a_cell_in_which_it_is_not():
    """Two soft bodies next to a hard one: the rest of a face's flux used to come from one that was not there."""
    simulation = finish(decks.loads(INSIDE))
    assert max(map(abs, simulation.conservation()["mass"].values())) < 1e-12


# ------------------------------------------------------------------------------------------------ two balls that rebound


@pytest.mark.parametrize(("cells", "offset"), [(8, 0.0), (8, 0.1), (8, 0.3), (8, 0.4), (8, 0.6), (8, 0.7), (8, 0.9), (12, 0.3),
                                               (16, 0.3)])
def test_two_elastic_balls_rebound(cells, offset):
    """Steel balls of 8 to 16 cells per radius meet at 20 m/s each, below all yield, with a restitution of 0.95 or more.

    Both lie `offset` of a cell farther on. A rim that closes head on is no void that slip carries into the contact: while such
    void was closed, 15.5 to 18.7 m/s were left. (At some places it is 18.7 m/s on 12 cells, and 18.99 on 16.)
    """
    size = 4.0 / cells
    elastic = {"model": "elastic-plastic", "yield_stress": "50 GPa", "shear_modulus": "77 GPa"}
    text = (
        mesh(("6 mm", round(6.0 / size)), ("20 mm", round(20.0 / size)))
        + table("materials.elastic", based_on="steel_4340", strength=elastic)
        + body("one", "elastic", "sphere", centre=f"{5.5 + size * offset} mm", radius="4 mm", velocity="20 m/s")
        + body("other", "elastic", "sphere", centre=f"{14.5 + size * offset} mm", radius="4 mm", velocity="-20 m/s")
        + contact("one")
        + stop("60 us")
    )
    simulation = to_the_end(Simulation(decks.loads(text)))
    assert simulation.mean_velocity(0) < -19.0
    assert simulation.mean_velocity(1) > 19.0
