"""A deck whose mesh follows a body: what it may ask for, the output of `check`, what enters, and the speed of the mesh."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.physics.waves import impedances
from hydro2d.running import check
from hydro2d.solver.following import FixedMesh, FollowingMesh, UndisturbedSpace
from hydro2d.solver.simulation import Simulation
from tests.decks import mesh, plate, rod, stop

TEXT = (
    mesh(("8 mm", 16), ("-12 mm", "8 mm", 40), follow="rod")
    + rod("2.2 mm", "9.1 mm", tip="-0.3 mm", velocity="1000 m/s")
    + plate("5 mm", z_front="0 mm")
    + plate("10 mm", name="second", z_front="20 mm")
    + stop("20 us")
)


def message(*options: str, text: str = TEXT) -> str:
    with pytest.raises(decks.DeckError) as caught:
        decks.loads(text, options)
    return str(caught.value)


@pytest.mark.parametrize(("old", "new", "said"), [
    ('follow = "rod"', 'follow = "rood"', 'deck.toml:3: mesh.follow: unknown body "rood"; did you mean "rod"?'),
    ('follow = "rod"', 'follow = "plate"',
     'deck.toml:3: mesh.follow: "plate" has no velocity along z for the mesh to follow'),
    ('"1000 m/s"', "[300.0, 0.0]", 'deck.toml:3: mesh.follow: "rod" has no velocity along z for the mesh to follow'),
    ('to = "8 mm", cells = 40', 'to = "1 mm", cells = 26',
     "deck.toml:3: mesh.follow: the mesh is too short: it reaches 0.0013 m ahead of"),
    ('z_start = "-12 mm"', 'z_start = "-9 mm"',
     'deck.toml:3: mesh.follow: the mesh is too short: it ends 0.0004 m before the tail of "rod"'),
    ("[stop]", 'velocity = "-100 m/s"\n[stop]',
     'deck.toml:22: body[2]: "second" reaches beyond the end of the travelling mesh'),
    ("[stop]", '[boundaries]\nz_min = "wall"\n[stop]',
     'deck.toml:29: boundaries.z_min: a mesh that follows "rod" must have open ends along z; a wall cannot travel with it'),
    ("[stop]", '[boundaries]\nz_max = "wall"\n[stop]', "deck.toml:29: boundaries.z_max: a mesh that follows"),
    ('z_front = "20 mm"', 'z_front = "-40 mm"', 'deck.toml:22: body[2]: "second" lies outside the mesh'),
])
def test_a_wrong_use_of_a_following_mesh_is_one_error_with_its_line(old, new, said):
    assert TEXT.count(old) == 1
    text = message(text=TEXT.replace(old, new))
    assert said in text
    assert len(text.splitlines()) == 1


def test_without_follow_a_body_beyond_the_mesh_is_an_error():
    assert '"second" lies outside the mesh' in message(text=TEXT.replace('follow = "rod"\n', ""))


def test_check_says_how_far_the_mesh_reaches_and_what_enters():
    lines = check.check(decks.loads(TEXT)).lines(1)
    said = [line for line in lines if "follow " in line or "enters" in line]
    assert said == [
        "follow    rod: the mesh reaches 8.3 mm (3.77 radii) ahead of it and 2.6 mm behind",
        "          second enters the mesh from 12 us on, over 10 mm of its travel",
    ]
    assert any('the mesh ends 3.77 radii ahead of "rod"; below 20 its edge matters' in line for line in lines)


def test_a_deck_chooses_how_the_mesh_moves():
    moving, standing = Simulation(decks.loads(TEXT)), Simulation(decks.loads(TEXT.replace('follow = "rod"\n', "").replace(
        'z_front = "20 mm"', 'z_front = "6 mm"')))
    assert type(standing.engine.mesh) is FixedMesh
    assert type(moving.engine.mesh) is FollowingMesh
    assert moving.engine.mesh.leading == 1


def test_a_strip_has_the_bodies_placed_by_the_deck():
    simulation = Simulation(decks.loads(TEXT.replace("[stop]", "radius = '2.25 mm'\n[stop]")))
    space = UndisturbedSpace(simulation.deck, simulation.table, simulation.grid)
    second = simulation.table.names.index("second")
    outer = (2.25**2 - 2.0**2) / (2.5**2 - 2.0**2)  # of the fifth column, by area
    for low, share in ((10e-3, 0.0), (19.9e-3, 0.75), (25e-3, 1.0), (29.7e-3, 0.75), (30e-3, 0.0)):
        strip, (first, last) = space.strip(low, low + 0.4e-3)
        assert first <= low < low + 0.4e-3 < last or share == 0.75  # there the body begins or ends, and nothing is kept
        np.testing.assert_allclose(strip["vof"][second], np.array([1] * 4 + [outer] + [0] * 11) * share, atol=1e-12)
        assert strip["vof"][simulation.table.names.index("plate")].max() == 0.0
        assert np.all(strip["rho"][second][strip["vof"][second] > 0] == simulation.table.rho0[second])
    assert space.strip(24e-3, 24.1e-3)[0] is space.strip(27e-3, 27.3e-3)[0]  # between two levels it is computed once
    assert space.reach(1.0)[second] == pytest.approx(30e-3)
    assert space.reach(-1.0)[second] == pytest.approx(20e-3)


def test_the_mesh_takes_the_velocity_of_the_core():
    """Debris and a failed part of the rod do not count, and the mesh never goes backward."""
    simulation = Simulation(decks.loads(TEXT))
    s, g, given = simulation.state, simulation.grid, simulation.engine.given

    def velocity() -> float:
        simulation.engine.mesh.follow(given)
        return given.handle.mesh_speed

    assert velocity() == pytest.approx(1000.0, rel=1e-12)
    s.vof[0, g.g + 1, g.g] = 1.0  # a crumb behind the tail, at rest
    s.rho[0, g.g + 1, g.g] = 18160.0
    assert velocity() == pytest.approx(1000.0, rel=1e-12)
    s.v[...] = np.where(s.v > 0, 700.0, 0.0)
    assert velocity() == pytest.approx(700.0, rel=1e-12)
    s.dmg[0] = 1.0  # nothing is intact: the whole body counts, including the crumb
    assert 600.0 < velocity() < 700.0
    s.v[...] = -5.0
    assert velocity() == 0.0


def test_impedances_of_an_elastic_cell():
    """rho c_l = sqrt(rho (K + 4 G/3)) and rho c_s = sqrt(rho G); with void, where no bulk modulus is known, no shear."""
    rho, bulk, shear = np.array([[2700.0]]), np.array([[70e9]]), 26e9
    cl = np.sqrt((bulk + 4 / 3 * shear) / rho)
    values = impedances.py_func(0, 0, rho, cl, bulk)
    assert values == pytest.approx((np.sqrt(2700.0 * (70e9 + 4 / 3 * shear)), np.sqrt(2700.0 * shear)))
    assert impedances.py_func(0, 0, rho, cl, np.zeros((1, 1)))[1] == 0.0


def test_a_restart_places_bodies_ahead_anew():
    simulation = Simulation(decks.loads(TEXT, ['body.plate.thickness="12 mm"']))
    simulation.step()
    mesh, state = simulation.engine.mesh, simulation.state
    stood = state.vof[:, mesh._ghost_rows].copy()
    assert stood.any()
    state.vof[:, mesh._ghost_rows] = 0.0
    simulation.load_restart_arrays(simulation.restart_arrays())
    simulation.load_restart_scalars(simulation.restart_scalars())
    mesh.fill_ghosts(simulation.engine.given)
    np.testing.assert_array_equal(state.vof[:, mesh._ghost_rows], stood)
