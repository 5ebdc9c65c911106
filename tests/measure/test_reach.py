"""Energies that a body can reach: against Hugoniots and isentropes in closed form, and for gases next to metals."""


import numpy as np
import pytest

from hydro2d.base.errors import UnphysicalState
from hydro2d.deck import deck as decks
from hydro2d.measure.audit import totals
from hydro2d.measure.sanity import _harmless, doubts
from hydro2d.solver.simulation import Simulation
from strength import SHEAR
from tests.decks import box, entry, mesh, plate, stop, table, walls
from tests.restarts import restarted

SHOT = (
    mesh(("1 mm", 4), ("-4 mm", "8 mm", "0.25 mm"), geometry="planar")
    + walls("r_max")
    + box("flyer", "Al5083", z=["-3.9 mm", "-0.9 mm"], velocity="1 km/s")
    + plate("6 mm", z_front="0.1 mm")
    + box("air", "air", z=["-0.9 mm", "0.1 mm"], pressure="0.1 MPa")
    + table("materials.air", eos={"model": "ideal-gas", "adiabatic_index": 1.4, "reference_density": "1.2 kg/m^3"})
    + stop("3 us")
)


def reach(*options):
    return Simulation(decks.loads(SHOT, options))._reach


def test_a_gas_is_shocked_and_then_compressed_along_its_isentrope():
    """The shock that stops an ideal gas, U = (g + 1)/4 v + sqrt(((g + 1)/4 v)^2 + c^2), then e ~ p^((g - 1)/g)."""
    bounds, gamma, rho, p0 = reach(), 1.4, 1.2, 1e5
    v, c2 = bounds.speed, gamma * p0 / rho
    assert v == pytest.approx(1000.0, rel=0.01)
    shock = (gamma + 1) / 4 * v + np.sqrt(((gamma + 1) / 4 * v) ** 2 + c2)
    p = p0 + rho * shock * v
    e = p0 / rho / (gamma - 1) + 0.5 * v**2 + p0 * v / (rho * shock)
    assert bounds.highest[2] == pytest.approx(e * (bounds.pressure / p) ** ((gamma - 1) / gamma), rel=5e-3)
    assert bounds.lowest[2] == pytest.approx(0.0, abs=1e-6)
    assert bounds.gas.tolist() == [False, False, True]


def test_a_solid_stops_on_its_hugoniot():
    """p = rho0 (c0 + s v) v and e = v^2/2, with the constants of 5083 in the library."""
    bounds = reach()
    v = bounds.speed
    assert bounds.pressure == pytest.approx(2670.0 * (5340.0 + 1.34 * v) * v, rel=0.02)
    assert bounds.highest[0] == pytest.approx(0.5 * v**2, rel=1e-6)
    assert -4e5 < bounds.lowest[0] < -2e5  # its heat at room temperature


@pytest.mark.parametrize(("option", "speed"), [
    ("body.flyer.velocity=[0.0, 0.0]", 0.0), ("body.flyer.pressure=1e8", 1000.0), ("body.plate.velocity=[0.0, -500.0]", 1500.0),
    ('body.flyer.flow={ pattern = "spherical", speed = -300.0 }', np.hypot(1300.0, 300.0))])
def test_the_closing_speed_is_that_of_the_deck(option, speed):
    assert reach(option).speed == pytest.approx(speed, abs=5.0)


def test_where_two_bodies_meet_the_softer_one_sets_the_pressure():
    tungsten = ["body.flyer.material=W_alloy", "boundaries.r_max=outflow", "boundaries.r_min=outflow"]
    assert reach(*tungsten).pressure == pytest.approx(reach().pressure, rel=5e-3)
    assert reach(*tungsten, "boundaries.z_max=wall").pressure > 4.0 * reach().pressure


@pytest.mark.parametrize("body", [0, 2])
def test_a_body_beyond_its_reach_is_a_fault(body):
    """Far too little to show in the energy of the shot."""
    simulation = Simulation(decks.loads(SHOT))
    s, bounds = simulation.state, simulation._reach
    assert simulation.faults() == []
    for energy in (3.0 * bounds.highest[body], 2.5 * bounds.lowest[body] - 0.1 * bounds.highest[body]):
        kept = s.e[body].copy()
        s.e[body][s.vof[body] > 0] = energy
        assert any(f'body "{simulation.table.names[body]}" has ' in fault for fault in simulation.faults())
        s.e[body] = kept


def doubted(simulation):
    return [doubt.sentence for doubt in doubts(simulation.state, simulation.table, simulation.time, simulation._reach,
                                               simulation.sources.given, simulation.audit)]


@pytest.mark.parametrize("body", [0, 2])
def test_a_body_that_is_too_hot_or_too_cold_in_one_cell_is_a_doubt(body):
    """In a cell that it fills; a body that fills less than a hundredth of its cell does not count."""
    simulation = Simulation(decks.loads(SHOT))
    s, bounds, name = simulation.state, simulation._reach, simulation.table.names[body]
    assert doubted(simulation) == []
    j, i = np.argwhere(s.vof[body] == 1.0)[5]
    for energy, what in ((1.3 * bounds.cell_highest[body], "hot"), (1.1 * bounds.cell_lowest[body], "cold"), (np.nan, "hot")):
        s.e[body, j, i] = energy
        assert doubted(simulation)[0].startswith(f'body "{name}" is too {what} with ')
    s.vof[body, j, i] = 0.005
    assert doubted(simulation) == []


def test_plastic_work_makes_a_cell_hotter_than_any_shock():
    simulation = Simulation(decks.loads(SHOT))
    s, highest = simulation.state, simulation._reach.cell_highest[0]
    j, i = np.argwhere(s.vof[0] == 1.0)[5]
    s.e[0, j, i] = 1.5 * highest
    assert len(doubted(simulation)) == 1
    s.ep[0, j, i] = 5.0
    assert doubted(simulation) == []


def test_a_temperature_of_zero_is_a_doubt():
    simulation = Simulation(decks.loads(SHOT))
    s = simulation.state
    j, i = np.argwhere(s.vof[1] == 1.0)[5]
    s.e[1, j, i] = 1.001 * simulation._reach.lowest[1]
    (sentence,) = doubted(simulation)
    assert sentence.startswith('body "plate" is too cold with -')


#: bodies that start at zero temperature, alone in the void, as in Sedov's problem
COLD = (
    mesh(("1 mm", 4), ("-4 mm", "8 mm", "0.25 mm"), geometry="planar")
    + box("hot", "gas", z=["-4 mm", "2 mm"], density=1.0, energy=1e6)
    + box("cold", "gas", z=["2 mm", "8 mm"], density=1.0, energy=1.0)
    + table("materials.gas", eos={"model": "ideal-gas", "adiabatic_index": 1.4, "reference_density": "1.2 kg/m^3"})
    + stop("3 us")
)


@pytest.mark.parametrize(("share", "doubtful"), [(1e-6, False), (9e-4, False), (1.1e-3, True), (0.1, True)])
def test_a_temperature_of_zero_is_missed_by_round_off(share, doubtful):
    """A gas behind a blast, 0.034 J/kg below zero temperature where it can reach 20 500, is sound."""
    simulation = Simulation(decks.loads(COLD))
    bounds = simulation._reach
    simulation.state.e[0, 20, 4] = -share * (bounds.highest[0] - bounds.lowest[0])
    assert len(doubted(simulation)) == doubtful


def test_elastic_energy_is_no_heat():
    """In a cell with a stress of its own, in any shot: p^2/(2 K rho) + q^2/(6 G rho)."""
    simulation = Simulation(decks.loads(SHOT, ["body.flyer.velocity=[0.0, 10.0]", "body.air.pressure=1.0"]))
    s, bounds = simulation.state, simulation._reach
    j, i = np.argwhere(s.vof[0] == 1.0)[5]
    rho = s.rho[0, j, i]
    s.srr[0, j, i], s.szz[0, j, i] = 0.5e9, -1e9  # von Mises 1.5 GPa
    own = 3 * (0.25e18 + 1e18 - 0.5e18) / (6.0 * simulation.table.strength_par[0, SHEAR] * rho)
    s.e[0, j, i] = bounds.cell_highest[0] + 0.99 * own
    assert doubted(simulation) == []
    s.e[0, j, i] = bounds.cell_highest[0] + 1.3 * own
    assert len(doubted(simulation)) == 1


def test_an_elastic_element_that_a_piston_squeezes_is_sound():
    """By a fourteenth: 89 kJ/kg, where 50 m/s alone give 1.25. More work than the edge has done is doubted."""
    simulation = Simulation(decks.loads(
        mesh(("4 mm", 4), ("20 mm", 20), geometry="planar")
        + walls("r_max", "z_min", z_max="piston", z_max_piston=[[0.0, 0.0], [5e-6, -50.0], [1e-3, -50.0]])
        + table("materials.elastic", based_on="steel_4340",
                strength={"model": "elastic-plastic", "yield_stress": "50 GPa", "shear_modulus": "77 GPa"})
        + box("block", "elastic", z=[0.0, "25 mm"]) + stop("30 us")))
    while simulation.stop_reason() is None:
        simulation.step()
    assert simulation.faults() == simulation.doubts() == []
    (work,) = simulation._reach.given_by(simulation.audit.worked)
    assert work == pytest.approx(89e3, rel=0.05)
    s = simulation.state
    s.e[0, 8, 3] = 1.5 * (simulation._reach.cell_highest[0] + 3.0 * work)
    assert len(list(doubts(s, simulation.table, simulation.time, simulation._reach, np.array([3.0 * work]),
                           simulation.audit))) == 1


#: two gases that a piston or a source presses, in a closed tube of 40 mm
GASES = (
    mesh(("4 mm", 4), ("40 mm", 40), geometry="planar")
    + walls("r_max", "z_min", "z_max")
    + box("light", "gas_7_5", z=[0.0, "20 mm"], density=0.1, pressure="0.1 MPa")
    + box("heavy", "gas_5_3", z=["20 mm", "40 mm"], density=10.0, pressure="0.2 MPa")
    + stop("1 ms")
)


@pytest.mark.parametrize("to", [3e5, 1e7])
def test_work_compresses_all_bodies_to_one_pressure(to):
    """e ~ p^((g - 1)/g) along the isentrope of each. A light gas gets more of it per kg than its neighbour."""
    simulation = Simulation(decks.loads(GASES))
    gamma, p0, rho = np.array([1.4, 5 / 3]), np.array([1e5, 2e5]), np.array([0.1, 10.0])
    heat = p0 / rho / (gamma - 1) * ((to / p0) ** ((gamma - 1) / gamma) - 1)
    work = simulation.audit.start.mass @ heat
    heats = simulation._reach.given_by(work)
    assert heats == pytest.approx(np.maximum(heat, work / simulation.audit.start.mass.sum()), rel=2e-3)
    assert heats[0] == pytest.approx(heat[0], rel=2e-3)


def test_energy_given_to_one_body_by_a_source_reaches_the_others():
    """A gas that is heated presses its neighbour, to eight times its energy: doubtful only without enough heat."""
    beam = entry("source", name="beam", kind="heating", body="heavy", power=[[0.0, 0.0], [1.0, 1.0]])
    simulation = Simulation(decks.loads(GASES + beam))
    s, audit, bounds = simulation.state, simulation.audit, simulation._reach
    s.e[0, 8, 3] *= 8.0
    gained = totals(s).energy - audit.start.energy
    needs = np.interp(7.0 * 2.5e6 / 3.0, bounds.squeezed[0], bounds.work)  # three times the heat is within reach
    assert s.e[0, 8, 3] > 1.5 * bounds.cell_highest[0]
    for given, doubtful in ((1.1 * needs, False), (0.1 * needs, True)):
        audit.sinks["beam"].energy, audit.sinks["outflow"].energy = -given, given - gained
        simulation.refuse_nonsense()
        assert bool(simulation.doubts()) == doubtful


#: edges next to which bodies fly along z and hit nothing: none, the walls of a tube, the axis and a wall
BESIDE = {"nothing": ["boundaries.r_max=outflow", "boundaries.r_min=outflow"], "tube": [],
          "axis": ["mesh.geometry=cylindrical"]}


@pytest.mark.parametrize("open_ends", BESIDE.values(), ids=BESIDE)
@pytest.mark.parametrize("by", [3000.0, -500.0])
def test_a_velocity_added_to_all_bodies_changes_no_verdict(by, open_ends):
    """Unless an edge lies across their path, which they hit."""
    moved = [f"body.{name}.velocity=[0.0, {by + own}]" for name, own in (("flyer", 1000.0), ("plate", 0.0), ("air", 0.0))]
    here, there = reach(*open_ends), reach(*open_ends, *moved)
    for name in ("lowest", "highest", "cell_lowest", "cell_highest", "worked", "speed", "pressure", "stands"):
        np.testing.assert_allclose(getattr(there, name), getattr(here, name), rtol=1e-9, err_msg=name)
    clipped = []
    for options in ((), moved):
        simulation = Simulation(decks.loads(SHOT, [*open_ends, *options]))
        start = simulation.audit.start
        available = start.energy - 0.5 * start.momentum**2 / start.mass.sum()
        simulation.audit.add("cutoff", energy=0.03 * available)
        clipped.append([fault for fault in simulation.faults() if "cutoff has removed" in fault])
    assert clipped[0][0].startswith("cutoff has removed 3 % of the energy")
    assert clipped[1] == clipped[0]
    meets = max(abs(by), abs(by + 1000.0), 1000.0)
    assert reach(*open_ends, *moved, "boundaries.z_max=anvil").speed == pytest.approx(meets, abs=5.0)


@pytest.mark.parametrize(("energy", "mass", "harmless"), [(0.9e-3, 0.9e-2, True), (1.1e-3, 0.9e-2, False),
                                                          (0.9e-3, 1.1e-2, False)])
def test_a_little_of_a_body_beyond_its_bounds_is_a_note(energy, mass, harmless):
    """By its shares of the energy of the shot and of the mass of its body, a thousandth and a hundredth."""
    assert bool(_harmless(energy, mass)) == harmless


def test_a_note_becomes_a_doubt_when_more_of_the_body_follows():
    """One cell in 441 of a plate, 30 J/kg too hot, decides nothing; forty of them do."""
    simulation = Simulation(decks.loads(
        mesh(("10 mm", 21), ("12 mm", 24)) + box("plate", "Al5083", z=["1 mm", "11.5 mm"], velocity="20 m/s")
        + box("other", "Al5083", z=["11.5 mm", "12 mm"], join="plate") + stop("1 us")))
    s, most = simulation.state, simulation._reach.cell_highest[0]
    energy, audit = s.e[0].copy(), simulation.audit
    cells = np.argwhere(s.vof[0] == 1.0)
    for few, shown in ((cells[:1], "notes"), (cells[:40], "doubts")):
        s.e[0] = energy
        for j, i in few:
            s.e[0, j, i] = most + 30.0
        audit.sinks["outflow"].energy = audit.start.energy - totals(s).energy
        simulation.refuse_nonsense()
        assert (bool(simulation.notes()), bool(simulation.doubts())) == (shown == "notes", shown == "doubts")
    (doubt,) = simulation.doubts()
    assert "too hot" in doubt
    assert simulation.notes() == []


def test_a_doubt_is_not_forgotten(tmp_path):
    """Not even after a restart: the run goes on, and is not trusted."""
    simulation = Simulation(decks.loads(SHOT, ["body.air.pressure=0.0", "body.air.material=Al5083"]))
    s = simulation.state
    j, i = np.argwhere(s.vof[0] == 1.0)[5]
    kept, s.e[0, j, i] = s.e[0, j, i], 2.0 * simulation._reach.cell_highest[0]
    with pytest.raises(UnphysicalState, match="does not add up"):
        simulation.refuse_nonsense()
    s.e[0, j, i] = kept
    simulation.refuse_nonsense()
    (doubt,) = simulation.doubts()
    assert doubt.startswith('cycle 0, time 0 s: body "flyer" is too hot')
    assert restarted(simulation).doubts() == [doubt]


def test_a_film_of_air_that_is_crushed_stays_on_its_isentrope():
    """At most 1.4e7 J/kg at 5 GPa; it used to reach 2.3e8: heat and work of the metal went into the air."""
    simulation, hottest = Simulation(decks.loads(SHOT)), 0.0
    s = simulation.state
    while simulation.stop_reason() is None:
        simulation.step()
        hottest = max(hottest, s.e[2][s.vof[2] > 0.0].max())
    assert 8e6 < hottest < 2e7
    assert simulation.faults() == []


def with_hot_air(*options) -> Simulation:
    """The air has more than anything in the run can give it; the flyer has lost as much."""
    simulation = Simulation(decks.loads(SHOT, options))
    simulation.run("0.1 us")
    s, inside = simulation.state, simulation.grid.interior
    masses = inside(s.vof * s.rho * simulation.grid.volume)
    gained = 3.0 * simulation._reach.highest[2] - inside(s.e[2])
    s.e[0] -= (gained * masses[2]).sum() / masses[0].sum() * (s.vof[0] > 0.0)
    inside(s.e[2])[...] += gained
    return simulation


def test_air_that_is_too_hot_is_not_called_done():
    with pytest.raises(UnphysicalState, match='(?s)body "air" has .*Leave the space empty'):
        with_hot_air().run()


def test_a_gas_next_to_a_moving_metal_has_the_heat_of_its_shock():
    """Air ahead of a flyer at 1 km/s, not yet crushed: some 7e5 J/kg behind the shock, where metal and air share cells."""
    simulation = Simulation(decks.loads(SHOT))
    while simulation.time < 0.45e-6:
        simulation.step()
    s = simulation.state
    mixed = (s.vof[2] > 0.01) & (s.vof[0] > 0.01)
    assert mixed.any()
    assert 3e5 < s.e[2][mixed].max() < 1.5e6
    assert simulation.faults() == []


def test_refusing_a_gas_may_be_put_off_but_not_trusted():
    simulation = with_hot_air("numerics.clip_limit=0.5")
    simulation.run("0.12 us")
    assert simulation.faults()
