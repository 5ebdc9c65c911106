"""Two body groups in everything around the solver: method, insertion, tracers, diagnostics, output, restart. No cycles."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.materials import quantities
from hydro2d.measure import tracers
from hydro2d.output import derived_quantities, snapshot
from hydro2d.output.vtk import Dump
from hydro2d.results import figures, scales
from hydro2d.running import check
from hydro2d.solver.simulation import Simulation
from tests.decks import entry, mesh, plate, rod, stop, table, walls

TEXT = (
    mesh(("8 mm", 8), ("-8 mm", "8 mm", 16))
    + walls("z_max")
    + rod("3.5 mm", "6 mm", nose="flat", tip="0.4 mm", velocity=["3 m/s", "1000 m/s"])
    + plate("4 mm", velocity="-50 m/s")
    + plate("4 mm", name="backing", material="steel_4340", z_front="4 mm", velocity="20 m/s")
    + table("sliding", method="contact", hard=["rod"], friction=0.1, yield_factor=1.25)
    + stop("1 us")
)
#: interior cells (j, i): rod alone; rod and plate; plate alone; both sides of the surface of the backing; void
PURE, CUT, PLATE, VOID = (5, 1), (8, 1), (8, 6), (5, 6)


def started(*overrides):
    return Simulation(deck.loads(TEXT, overrides))


@pytest.fixture
def contact():
    return started()


def one_velocity():
    return started("sliding.method=none", "sliding.friction=0")


def set_velocities(simulation, rest, hard):
    """Uniform (u, v) of both groups; nan for the hard ones at vertices whose cells contain none of them."""
    s = simulation.state
    s.u[0], s.v[0] = rest
    constrained = np.zeros(simulation.grid.vertex_shape, dtype=bool)
    there = s.vof[0] > 0
    for corner in (constrained[:-1, :-1], constrained[1:, :-1], constrained[:-1, 1:], constrained[1:, 1:]):
        corner |= there
    s.u[1], s.v[1] = (np.where(constrained, value, np.nan) for value in hard)


def centre(simulation, cell):
    grid = simulation.grid
    return grid.rc[cell[1] + grid.g], grid.zc[cell[0] + grid.g]


def test_check_prints_the_contact_and_counts_its_memory():
    checked = check.check(deck.loads(TEXT))
    assert "sliding   contact; hard: rod; friction 0.1, yield factor 1.25" in checked.lines(1)
    without = check.check(deck.loads(TEXT, ["sliding.method=none", "sliding.friction=0"]))
    assert "sliding   none" in without.lines(1)
    state = Simulation(deck.loads(TEXT)).state
    others = "group", "rules", "initial"
    arrays = [array for name, array in vars(state).items() if isinstance(array, np.ndarray) and name not in others]
    assert checked.memory == sum(array.nbytes for array in arrays if array.base is None)
    vertices = (16 + 4 + 1) * (8 + 4 + 1)
    assert checked.memory > without.memory + 5 * 8 * vertices  # a second velocity at both ends of the step, and its mass


def test_each_group_starts_with_its_own_momentum(contact):
    grid, state = contact.grid, contact.state
    u, v = grid.interior_vertices(state.u), grid.interior_vertices(state.v)
    vof = grid.interior(state.vof)
    j, i = CUT
    assert vof[0][CUT] == pytest.approx(0.4)
    assert vof[1][CUT] == pytest.approx(0.6)
    np.testing.assert_allclose(v[1, j:j + 2, i:i + 2], 1000.0, rtol=1e-14)
    np.testing.assert_allclose(v[0, j:j + 2, i:i + 2], -50.0, rtol=1e-14)
    np.testing.assert_allclose(u[1, j:j + 2, i:i + 2], 3.0, rtol=1e-14)
    surface = 12  # the backing above it, the plate below, with cells of one size
    w_plate, w_backing = (grid.interior(state.rho[m])[surface - 2 + m, 4] for m in (1, 2))
    mean = (w_plate * -50.0 + w_backing * 20.0) / (w_plate + w_backing)
    np.testing.assert_allclose(v[0, surface], mean, rtol=1e-14)
    single = one_velocity()
    assert -50.0 < single.grid.interior_vertices(single.state.v)[0, j, i] < 1000.0


def test_a_group_that_is_not_there_takes_the_velocity_of_the_other(contact):
    grid, state = contact.grid, contact.state
    v = grid.interior_vertices(state.v)
    np.testing.assert_allclose(v[0, 4:8, :5], 1000.0, rtol=1e-14)  # behind the plate there is the rod alone
    np.testing.assert_array_equal(v[1, 10:], v[0, 10:])  # deeper than the rod
    assert np.all(v[:, :8, 6:] == 0.0)  # void


def test_axis_and_walls_hold_both_groups(contact):
    grid, state = contact.grid, contact.state
    u, v = grid.interior_vertices(state.u), grid.interior_vertices(state.v)
    assert np.all(u[:, :, 0] == 0.0)
    assert np.all(v[:, -1] == 0.0)
    np.testing.assert_allclose(v[:, -2], 20.0, rtol=1e-14)
    np.testing.assert_allclose(u[1, 4:8, 1], 3.0, rtol=1e-14)


def test_one_group_starts_with_the_mean_of_the_mixture():
    simulation = one_velocity()
    grid, state = simulation.grid, simulation.state
    assert len(state.v) == 1
    mass = grid.interior(state.vof * state.rho)
    momentum = mass[0] * 1000.0 - mass[1] * 50.0 + mass[2] * 20.0
    inner, outer = (share[grid.inside[1]] for share in (grid.cm_in, grid.cm_out))
    j, i = CUT

    def around(cell):
        return sum(outer[i - 1] * cell[row, i - 1] + inner[i] * cell[row, i] for row in (j - 1, j))

    expected = around(momentum) / around(mass.sum(axis=0))
    assert grid.interior_vertices(state.v)[0, j, i] == pytest.approx(expected, rel=1e-13)


def test_a_body_moves_with_the_velocity_of_its_group(contact):
    assert contact.mean_velocity(0) == pytest.approx(1000.0, rel=1e-13)
    assert one_velocity().mean_velocity(0) < 999.0
    contact.state.v[0], contact.state.v[1] = 7.0, 8.0
    assert [contact.mean_velocity(m) for m in range(3)] == pytest.approx([8.0, 7.0, 7.0], rel=1e-13)


@pytest.mark.parametrize(("share", "expected"), [(0.5, 2.0), (0.49, 1.0), (0.0, 1.0)])
def test_a_point_moves_with_the_group_that_fills_its_cell(contact, share, expected):
    contact.state.vof[:, CUT[0] + 2, CUT[1] + 2] = share, 0.8 - share, 0.0
    set_velocities(contact, (0.1, 1.0), (0.2, 2.0))
    points = np.array([centre(contact, cell) for cell in (CUT, PURE, PLATE, VOID)])
    assert contact.velocity_at(points)[:, 1].tolist() == [expected, 2.0, 1.0, 1.0]
    assert contact.velocity_at(points[:2], group=1).tolist() == [[0.2, 2.0]] * 2
    assert contact.velocity_at(points, group=0).tolist() == [[0.1, 1.0]] * 4


@pytest.mark.parametrize(("own", "moved"), [(1, 2.0), (0, 1.0), (-1, 1.0)])
def test_a_tracer_stays_with_the_group_that_it_began_in(contact, own, moved):
    """A rod that fills a third of the cell: a tracer in it does not move with the plate."""
    contact.state.vof[:, CUT[0] + 2, CUT[1] + 2] = 0.3, 0.7, 0.0
    set_velocities(contact, (0.0, 1.0), (0.0, 2.0))
    points = np.array([centre(contact, CUT)])
    before, g, s = points.copy(), contact.grid, contact.state
    tracers.advect(g.g, g.nr, g.nz, 1e-5, g.r, g.z, np.array([own]), s.group, s.vof, s.u, s.v, points)
    np.testing.assert_allclose(points - before, [[0.0, 1e-5 * moved]], rtol=1e-6)


def test_tracers_have_the_group_of_the_body_in_which_they_begin():
    places = {"rod": (0.0, -1e-3), "plate": (5e-3, 1e-3), "void": (5e-3, -1e-3)}
    sim = Simulation(deck.loads(TEXT + "".join(entry("tracer", name=name, r=r, z=z) for name, (r, z) in places.items())))
    assert sim.stations._groups.tolist() == [1, 0, -1]


def test_a_tracer_without_a_body_changes_its_group_with_its_place(contact):
    """Half a step at the velocity of the plate takes the point into the rod, with which it moves for the whole step."""
    set_velocities(contact, (0.0, -1.0), (0.0, -2.0))
    contact.state.vof[:2, CUT[0] + 2] = 0.0
    contact.state.vof[1, CUT[0] + 2] = 1.0
    points = np.array([[1.5e-3, 0.3e-3], [6.5e-3, 3e-3]])
    g, s = contact.grid, contact.state
    tracers.advect(g.g, g.nr, g.nz, 1e-3, g.r, g.z, np.full(2, -1), s.group, s.vof, s.u, s.v, points)
    np.testing.assert_allclose(points, [[1.5e-3, -1.7e-3], [6.5e-3, 2e-3]], rtol=1e-12)


def test_nose_and_tail_have_the_velocity_of_the_rod(contact):
    set_velocities(contact, (0.0, 100.0), (0.0, 900.0))
    diagnostics = contact.diagnostics()
    assert [diagnostics[f"rod_{of}_velocity_m_s"] for of in ("nose", "tail", "mean")] == pytest.approx([900.0] * 3, rel=1e-13)
    soft_rod = started('sliding.hard=["backing"]')
    soft_rod.state.v[0], soft_rod.state.v[1] = 100.0, 900.0
    assert soft_rod.diagnostics()["rod_nose_velocity_m_s"] == 100.0


def test_fields_of_a_contact(contact):
    state, grid = contact.state, contact.grid
    set_velocities(contact, (5.0, 100.0), (7.0, 900.0))
    state.contact_pressure[CUT[0] + grid.g, CUT[1] + grid.g] = 2e9
    fields = derived_quantities.evaluate(contact, ["standard"])
    velocity, hard, soft = (fields[f"Velocity{of} [m/s]"] for of in ("", " of Hard Bodies", " of Soft Bodies"))
    assert velocity.shape == hard.shape == soft.shape == (16, 8, 3)
    assert [hard[cell].tolist() for cell in (PURE, CUT, PLATE, VOID)] == [[7, 900, 0], [7, 900, 0], [0, 0, 0], [0, 0, 0]]
    assert [soft[cell].tolist() for cell in (PURE, CUT, PLATE, VOID)] == [[0, 0, 0], [5, 100, 0], [5, 100, 0], [0, 0, 0]]
    rod, plate = 0.4 * grid.interior(state.rho[0])[CUT], 0.6 * grid.interior(state.rho[1])[CUT]
    mean = [(rod * of_rod + plate * of_plate) / (rod + plate) for of_rod, of_plate in ((7.0, 5.0), (900.0, 100.0))]
    np.testing.assert_allclose(velocity[CUT], [*mean, 0.0], rtol=1e-12)
    assert (velocity[PURE].tolist(), velocity[PLATE].tolist()) == ([7, 900, 0], [5, 100, 0])
    np.testing.assert_array_equal(fields["Share of Hard Bodies"], fields["Volume Fraction for rod"])
    pressure = fields["Contact Pressure [Pa]"]
    assert pressure.shape == (16, 8)
    assert pressure[CUT] == pressure.sum() == 2e9
    state.contact_pressure[...] = 0.0
    assert pressure[CUT] == 2e9  # the evaluated pressure is not a view of the state


def test_fields_of_a_contact_are_written_only_there(contact):
    titles = {quantity.name() for quantity in quantities.TABLE if quantity.contact}
    assert len(titles) == 4
    single = one_velocity()
    for keys in (["standard"], ["all"]):
        assert titles <= derived_quantities.evaluate(contact, keys).keys()
        assert derived_quantities.evaluate(contact, keys).keys() - derived_quantities.evaluate(single, keys).keys() == titles
    assert not titles & derived_quantities.evaluate(single, ["contact_pressure"]).keys()
    assert Dump.of(contact).bodies == ["rod", "plate", "backing"]


def test_velocities_of_a_contact_have_components(contact):
    set_velocities(contact, (5.0, 100.0), (7.0, 900.0))
    assert np.nanmax(figures.chosen(Dump.of(contact), "velocity_hard:z").values) == pytest.approx(900.0)
    with pytest.raises(scales.FigureError, match="only velocity, velocity_hard, velocity_soft have components"):
        figures.chosen(Dump.of(contact), "contact_pressure:z")


def test_a_restart_file_holds_both_groups(contact, tmp_path):
    contact.state.u[...] = np.random.default_rng(1).random(contact.state.u.shape)
    contact.state.v[...] = np.random.default_rng(2).random(contact.state.v.shape)
    contact.engine.prepare()  # a vertex of one group has one velocity
    arrays, scalars = contact.restart_arrays(), contact.restart_scalars()
    snapshot.write(tmp_path / "restart.h5", snapshot.Snapshot(arrays, scalars, {}, contact.deck.to_toml(), {}))
    saved = snapshot.read(tmp_path / "restart.h5")
    assert saved.arrays["u"].shape == (2, *contact.grid.vertex_shape)
    again = Simulation(deck.loads(saved.deck))
    again.load_restart_arrays(saved.arrays)
    again.load_restart_scalars(saved.scalars)
    for name, array in contact.restart_arrays().items():
        assert again.restart_arrays()[name].tobytes() == array.tobytes()
    with pytest.raises(ValueError, match="u is "):
        one_velocity().load_restart_arrays(saved.arrays)
