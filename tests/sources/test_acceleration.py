"""Forces per mass: free fall, hydrostatic pressure, their audit, walls, two bodies, restarts."""

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.materials import library
from hydro2d.solver.simulation import Simulation
from tests.restarts import restarted

G = -2e8
FALL = """
numbers = "SI"
[mesh]
geometry = "planar"
r = [{ to = "2 mm", cells = 4 }]
z = [{ to = "20 mm", cells = 40 }]
[boundaries]
r_max = "wall"
[[body]]
name = "plate"
material = "Al5083"
shape = "plate"
z_front = "12 mm"
thickness = "5 mm"
velocity = "100 m/s"
[[source]]
name = "gravity"
kind = "acceleration"
body = "plate"
axial = -2e8
[stop]
time = "6 us"
"""


def face(simulation):
    """Height of the lower face of the plate."""
    grid = simulation.grid
    share, edges = grid.interior(simulation.state.vof)[0, :, 1], grid.z_edges
    middle = int(np.argmax(share == 1.0)) + 2
    return edges[middle] - (share[:middle] * np.diff(edges)[:middle]).sum()


@pytest.mark.parametrize("advection", ["ke", "momentum", "both"])
def test_free_fall_is_exact(advection):
    """Velocity v0 + g t and place v0 t + g t^2/2, no stress and no heat; the source's impulse is M g t and its work M g h."""
    simulation = Simulation(deck.loads(FALL, [f'numerics.advection="{advection}"']))
    simulation.run()
    t, mass = simulation.time, simulation.audit.start.mass.sum()
    v = 100.0 + G * t
    moving = simulation.grid.interior_vertices(simulation.state.mass[0]) > 1e-6 * simulation.state.mass.max()
    np.testing.assert_allclose(simulation.grid.interior_vertices(simulation.state.v[0])[moving], v, rtol=1e-9)
    assert face(simulation) == pytest.approx(12e-3 + 100.0 * t + 0.5 * G * t * t, abs=1e-9)
    assert abs(simulation.grid.interior(simulation.state.e)).max() < 1e-6 * 0.5 * v * v
    balance, sink = simulation.conservation(), simulation.audit.sinks["gravity"]
    assert abs(balance["total_energy"]) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12
    assert sink.momentum == pytest.approx(-mass * G * t, rel=1e-12)
    assert sink.energy == pytest.approx(-0.5 * mass * (v**2 - 100.0**2), rel=1e-9)
    assert simulation.doubts() == []


def test_a_table_gives_its_integral():
    simulation = Simulation(deck.loads(FALL.replace("axial = -2e8", 'axial = [["1 us", 0], ["2 us", "2e8 m/s^2"]]')))
    simulation.run()
    v = simulation.grid.interior_vertices(simulation.state.v[0])
    assert v[28] == pytest.approx(100.0 + 100.0, rel=1e-9)


def test_material_out_of_reach_is_not_pushed():
    """A source over the lower half of the plate gives half of the momentum."""
    lower_half = ['source.gravity.z=["0 mm", "14.5 mm"]', 'stop.time="0.1 us"', "body.plate.velocity=0"]
    simulation = Simulation(deck.loads(FALL, lower_half))
    simulation.run()
    momentum = -simulation.audit.sinks["gravity"].momentum
    assert momentum == pytest.approx(0.5 * simulation.audit.start.mass.sum() * G * simulation.time, rel=1e-3)
    assert abs(simulation.conservation()["axial_momentum"]) < 1e-12


@pytest.mark.parametrize(("override", "words"), [
    ("source.gravity.axial=[[0, 1]]", "expected a table of 2 to 100000 rows"),
    ('source.gravity.axial="3 m/s"', r"is a speed; expected an acceleration|expected .*m/s\^2"),
    ("source.gravity.kind=gravity", r"unknown kind .gravity. \(allowed: acceleration, detonation, heating\)"),
    ("source.gravity.axle=1", 'unknown key "axle"; did you mean "axial"'),
])
def test_wrong_tables(override, words):
    with pytest.raises(DeckError, match=words):
        deck.loads(FALL, [override])


# ------------------------------------------------------------------------------------------------ a column at rest

#: cells, their height, and the material of the column
N, H = 20, 0.5e-3
#: its energy at the start, J/kg: at zero energy, changes by round-off would exceed the whole
ENERGY = 1e3


def density_at(material, p):
    """The density at a pressure and the energy of the column, kg/m^3."""
    from scipy.optimize import brentq

    module, values = material.eos.module("eos"), material.eos.values
    par, rest = module.row(values), material.reference_density
    return brentq(lambda rho: module.evaluate(rho, ENERGY, par)[0] - p, 0.9 * rest, 1.5 * rest, xtol=1e-13, rtol=1e-15)


def column(names):
    """Densities from the top down in which every vertex is in balance: the pressure difference carries its half cells."""
    densities, p = [], 0.0
    weight = 0.0  # of the half cell above
    for name in names:
        material = library.load(name)
        rho = material.reference_density
        for _ in range(60):
            rho = density_at(material, p + weight - 0.5 * G * H * rho)
        p, weight = p + weight - 0.5 * G * H * rho, -0.5 * G * H * rho
        densities.append((rho, p))
    return densities


def standing(names, extra=""):
    """A deck of a column of cells, of the materials given from the top down, on a wall."""
    text = f"""
numbers = "SI"
[mesh]
geometry = "planar"
r = [{{ to = "2 mm", cells = 4 }}]
z = [{{ to = "{N + 4} mm", size = "{H * 1e3} mm" }}]
[boundaries]
r_max = "wall"
z_min = "wall"
[failure]
tensile = "none"
[stop]
time = "20 us"
{extra}
"""
    first = {}
    for k, (name, (rho, _)) in enumerate(zip(names, column(names), strict=True)):
        join = f'join = "{first[name]}"' if name in first else ""
        first.setdefault(name, f"b{k}")
        low = (N - 1 - k) * H
        text += f"""
[[body]]
name = "b{k}"
material = "{name}_fluid"
shape = "plate"
z_front = {low!r}
thickness = {H!r}
density = {rho!r}
energy = {ENERGY!r}
{join}
"""
    for name, body in first.items():
        text += f"""
[materials.{name}_fluid]
based_on = "{name}"
strength.model = "hydrodynamic"
[[source]]
name = "gravity on {name}"
kind = "acceleration"
body = "{body}"
axial = {G}
"""
    return text


@pytest.mark.thorough
@pytest.mark.parametrize("names", [["Al5083"] * N, ["Al5083"] * (N // 2) + ["copper_OFHC"] * (N // 2)])
def test_a_column_at_rest_keeps_its_hydrostatic_pressure(names):
    """Ten transit times of sound, to round-off; walls take the impulse that gravity gives."""
    simulation = Simulation(deck.loads(standing(names)))
    simulation.run()
    expected = [p for _, p in reversed(column(names))]
    pressure = simulation.grid.interior(simulation.state.p)[:N, 1]
    np.testing.assert_allclose(pressure, expected, rtol=1e-6)
    assert abs(simulation.state.v).max() < 1e-6
    balance, sinks = simulation.conservation(), simulation.audit.sinks
    weight = simulation.audit.start.mass.sum() * G * simulation.time
    given = sum(sinks[f"gravity on {name}"].momentum for name in set(names))
    assert given == pytest.approx(-weight, rel=1e-12)
    assert sinks["walls"].momentum == pytest.approx(weight, rel=1e-12)  # the momentum of the column itself is round-off
    assert abs(balance["total_energy"]) < 1e-12
    assert simulation.doubts() == []


def test_without_the_source_the_same_column_rises():
    """The check above can fail: without its weight the column expands upwards."""
    text = standing(["Al5083"] * N)
    simulation = Simulation(deck.loads(text[: text.index("[[source]]")]))
    for _ in range(20):
        simulation.step()
    assert abs(simulation.state.v).max() > 1.0


#: a block that the plate falls on
BLOCK = """
[[body]]
name = "block"
material = "W_alloy"
shape = "box"
r = ["0 mm", "2 mm"]
z = ["5.2 mm", "11.9 mm"]
[sliding]
method = "contact"
hard = ["block"]
"""


@pytest.mark.parametrize("pushed", ["plate", "block"])
def test_a_force_next_to_a_contact_passes_through_it(pushed):
    """A plate falls onto a block, or the block is driven into the plate: momentum of both, except for crumbs, and the audit."""
    push = G if pushed == "plate" else -G
    text = FALL.replace('body = "plate"', f'body = "{pushed}"').replace("axial = -2e8", f"axial = {push}")
    text = text.replace('velocity = "100 m/s"', "velocity = 0.0")
    simulation = Simulation(deck.loads(text + BLOCK))
    simulation.run(2e-6)
    mass = dict(zip(simulation.table.names, simulation.audit.start.mass, strict=True))
    means = {name: simulation.mean_velocity(m) for m, name in enumerate(simulation.table.names)}
    given = push * simulation.time * mass[pushed]
    assert sum(mass[name] * means[name] for name in mass) == pytest.approx(given, rel=1e-8)
    (other,) = set(mass) - {pushed}
    assert means[other] * given > 0.0
    assert abs(means[other]) > 0.01 * abs(means[pushed])
    balance = simulation.conservation()
    assert abs(balance["total_energy"]) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12
    assert simulation.audit.sinks["gravity"].momentum == pytest.approx(-given, rel=1e-8)


def test_a_force_on_both_bodies_of_a_contact_is_free_fall():
    """Nothing presses: both groups fall together, at contact nodes as elsewhere."""
    both = """
[[source]]
name = "of the block"
kind = "acceleration"
body = "block"
axial = -2e8
"""
    text = FALL.replace('velocity = "100 m/s"', "velocity = 0.0") + BLOCK.replace("11.9 mm", "12 mm") + both
    simulation = Simulation(deck.loads(text))
    simulation.run(2e-6)
    state = simulation.state
    assert state.groups == 2
    moving = simulation.grid.interior_vertices(state.mass) > 1e-6 * state.mass.max()
    np.testing.assert_allclose(simulation.grid.interior_vertices(state.v)[moving], G * simulation.time, rtol=1e-9)
    assert abs(simulation.grid.interior(state.p)).max() < 1e3


def test_a_restart_goes_on_falling_to_the_same_bits():
    first = Simulation(deck.loads(FALL))
    while first.time < 2e-6:
        first.step()
    second = restarted(first)
    for _ in range(5):
        first.step()
        second.step()
    for name in ("q", "v"):
        np.testing.assert_array_equal(getattr(second.state, name), getattr(first.state, name))
    assert second.audit.sinks["gravity"].energy == first.audit.sinks["gravity"].energy
