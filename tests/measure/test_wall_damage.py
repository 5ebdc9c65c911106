"""The damage of a wall: perforated, detached spall, attached spall, none, of states made by hand and of a small shot."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.decks import entry, mesh, plate, stop, table

#: a plate of 6 mm with cells of 0.5 mm, and a ball before it
TEXT = (
    mesh(("12 mm", 24), ("-10 mm", "20 mm", 60))
    + entry("body", name="ball", material="W_alloy", shape="sphere", centre="-3.1 mm", radius="3 mm", velocity="1 km/s")
    + plate("6 mm", radius="11 mm")
    + stop("1 us")
)
BACK = ['body.ball.centre="3.1 mm"', 'body.ball.velocity="-1 km/s"', 'body.plate.z_front="-6 mm"', 'mesh.z_start="-20 mm"',
        'mesh.z.0.to="10 mm"']
BOTH = pytest.mark.parametrize("options", [[], BACK], ids=["to +z", "to -z"])


def wall(*options):
    return Simulation(deck.loads(TEXT, list(options)))


def fill(sim, body, r, depth, share, velocity=None):
    """Sets the share of a body, 0 or 1, within r and depth, mm, and the velocity along the flight of the vertices there."""
    grid, sign = sim.grid, sim.penetrator.direction
    z = sign * 1e3 * grid.zc[grid.inside[0]]
    radius = 1e3 * grid.rc[grid.inside[1]]
    cells = np.ix_((z > depth[0]) & (z < depth[1]), (radius > r[0]) & (radius < r[1]))
    grid.interior(sim.state.vof)[body][cells] = share
    grid.interior(sim.state.rho)[body][cells] = 2660.0
    if velocity is not None:
        z = sign * 1e3 * grid.z_edges
        grid.interior_vertices(sim.state.v[0])[(z > depth[0] - 0.1) & (z < depth[1] + 0.1)] = sign * velocity


def found(sim):
    target = sim.of_targets()["plate"]
    return target["damage_class"], target["crater"]["hole_diameter_m"]


@BOTH
def test_a_sound_plate(options):
    assert found(wall(*options)) == ("none", None)


@BOTH
def test_a_hole_that_the_ball_did_not_go_through(options):
    """The ball lies in the hole that it has opened, or has fallen back from it; neither has perforated."""
    sim = wall(*options)
    fill(sim, 0, (0, 12), (-10, 20), 0.0)
    fill(sim, 1, (0, 3), (0, 6), 0.0)
    assert found(sim) == ("perforated", pytest.approx(6e-3, rel=1e-6))
    fill(sim, 1, (0, 4), (0, 2), 0.0)
    fill(sim, 0, (0, 3), (2, 6), 1.0)
    target = sim.of_targets()["plate"]
    assert (target["exit_time_s"], target["damage_class"]) == (None, "perforated")
    assert target["crater"]["hole_diameter_m"] == pytest.approx(6e-3, rel=1e-6)
    assert target["crater"]["entrance_diameter_m"] == pytest.approx(8e-3, rel=1e-6)


@BOTH
def test_a_crater_is_no_damage_of_the_rear(options):
    sim = wall(*options)
    fill(sim, 1, (0, 4), (0, 3), 0.0)
    assert found(sim) == ("none", None)


@BOTH
@pytest.mark.parametrize(("velocity", "said"), [(200.0, "detached spall"), (1.0, "attached spall"), (-200.0, "attached spall")])
def test_a_disc_that_has_come_off(options, velocity, said):
    """It is spall if it flies from the wall, and still attached if it is as slow as the wall."""
    sim = wall(*options)
    sim.state.v[...] = 0.0
    fill(sim, 1, (0, 5), (5, 6), 0.0)
    fill(sim, 1, (0, 5), (8, 9), 1.0, velocity)
    assert found(sim) == (said, None)


@BOTH
def test_a_crumb_is_no_spall(options):
    sim = wall(*options)
    fill(sim, 1, (0, 1), (8, 8.5), 1.0, 200.0)
    assert found(sim) == ("none", None)


@BOTH
def test_a_piece_that_flies_back_is_no_spall(options):
    sim = wall(*options)
    fill(sim, 1, (8, 10), (-6, -4), 1.0, -200.0)
    assert found(sim) == ("none", None)


@BOTH
@pytest.mark.parametrize(("share", "said"), [(0.0, "attached spall"), (0.4, "attached spall"), (0.6, "none"), (0.97, "none")])
def test_a_crack_within_the_plate(options, share, said):
    """It counts from half a cell of void on."""
    sim = wall(*options)
    fill(sim, 1, (0, 5), (4, 4.5), share)
    assert found(sim) == (said, None)


@pytest.mark.parametrize("radius", ["11.3 mm", "12 mm"])
def test_a_rim_that_a_surface_cuts_is_no_crack(radius):
    """Nor is one at an open edge of the mesh, from which some of it has flowed out."""
    sim = wall(f'body.plate.radius="{radius}"')
    assert found(sim) == ("none", None)
    sim.grid.interior(sim.state.vof)[1, :, -2:] *= np.array([1.0, 0.9])
    assert found(sim) == ("none", None)


@BOTH
def test_void_around_the_ball_is_no_crack(options):
    """A ball in a crater that has closed behind it, with a gap between."""
    sim = wall(*options)
    fill(sim, 0, (0, 12), (-10, 20), 0.0)
    fill(sim, 1, (0, 3), (1, 4), 0.0)
    fill(sim, 0, (0, 2), (2, 4), 1.0)
    assert found(sim) == ("none", None)


@BOTH
@pytest.mark.parametrize(("height", "said"), [(2.5, "none"), (3.5, "attached spall")])
def test_a_bulge(options, height, said):
    """The ball has pushed the wall out, without a hole."""
    sim = wall(*options)
    fill(sim, 0, (0, 12), (-10, 20), 0.0)
    fill(sim, 1, (0, 4), (0, height), 0.0)
    fill(sim, 1, (0, 4), (6, 6 + height), 1.0)
    assert found(sim) == (said, None)


def test_a_wall_whose_rear_is_not_in_the_mesh_has_no_class():
    assert found(wall('mesh.z.0.to="6 mm"')) == (None, None)


def test_nor_has_one_whose_spall_may_have_left_the_mesh():
    sim = wall()
    sim._ejecta[0].resume([0.0, 0.0, 0.02 * sim.penetrator.mass])
    assert found(sim) == (None, None)
    fill(sim, 1, (0, 3), (0, 6), 0.0)
    assert found(sim)[0] == "perforated"


@pytest.mark.thorough
@pytest.mark.parametrize(("velocity", "thickness", "said"), [
    ("4 km/s", "2 mm", "perforated"), ("6 km/s", "6 mm", "attached spall"), ("3 km/s", "14 mm", "none")])
def test_a_ball_on_walls(velocity, thickness, said):
    """An aluminium ball of 2 mm: through a wall of 2 mm, a layer that comes off one of 6 mm, no damage of one of 14 mm."""
    text = (
        mesh(("10 mm", 50), ("-6 mm", "20 mm", 130))
        + entry("body", name="ball", material="Al6061_T6", shape="sphere", centre="-1 mm", radius="1 mm", velocity=velocity)
        + plate(thickness, material="Al6061_T6:spall")
        + table("failure", tensile="material")
        + stop("5 us")
    )
    sim = Simulation(deck.loads(text))
    sim.run()
    assert found(sim)[0] == said
