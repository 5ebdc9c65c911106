"""What contact does at vertices: masters, impulses, the force on a piece of surface, ties, what slopes see."""

import numpy as np
import pytest

from hydro2d.kernels.contact import contact_geometry, contact_velocities
from hydro2d.kernels.contact.contact_geometry import REACH
from hydro2d.kernels.contact.contact_velocities import heat_contact_nodes, resolve_contact
from hydro2d.kernels.contact.extension import MASTERS, SPAN, TIED
from hydro2d.solver import contact_ties
from tests.kernels.cells import handle, lines
from tests.kernels.test_extension import Extensions, N, half_plane, pair, scattered

mismatch = contact_velocities.mismatch.source
masters_mobility = contact_velocities.masters_mobility.source
mobility = contact_velocities.mobility.source
face_aperture = contact_geometry.face_aperture.source

NOWHERE = lines()


# ----------------------------------------------------------------------------------------------- one slave, its masters


def one_tie(*masters):
    """(number, where, weights) of slot 0, whose node of group 1 has these masters (place, weight)."""
    number, where = np.array([[0, len(masters)]]), np.zeros((1, 2, MASTERS + 1), dtype=np.int64)
    weights = np.zeros((1, 2, MASTERS + 1))
    for n, (place, weight) in enumerate(masters):
        where[0, 1, n], weights[0, 1, n] = place, weight
    return number, where, weights


def place(dj: int, di: int) -> int:
    return SPAN * (dj + REACH) + di + REACH


def room_for_ties(slots: int, vertices=(7, 7)):
    """places and what `resolve_contact` writes of ties, which nothing has written yet."""
    ties = contact_ties.slots(slots)._asdict()
    room = {name: ties[name] for name in ties if name not in ("strength", "masters", "where", "weights")}
    for values in room.values():
        values[...] = np.nan if values.dtype == np.float64 else -1
    return {"places": np.zeros((2, *vertices), dtype=np.int64), **room}


def test_a_slave_is_as_heavy_as_it_and_its_masters():
    number, where, weights = one_tie((place(0, -1), 0.75), (TIED, 0.25))
    mass, strength = np.full((2, 7, 7), 4.0), np.array([[0.0, 1.0]])
    mass[0, 3, 3] = 2.0
    master_mobility = 0.75**2 / 4.0 + 0.25**2 / 2.0
    ties = handle(constrained=NOWHERE, strength=strength, masters=number, where=where, weights=weights, mass=mass)
    assert masters_mobility(1, 3, 3, 0, ties) == pytest.approx((master_mobility, master_mobility))
    assert mobility(0, 3, 3, 0, ties) == 0.5
    tied = 1.0 / (4.0 + 1.0 / master_mobility)
    assert mobility(1, 3, 3, 0, ties) == pytest.approx(tied)
    strength[0, 1] = 0.25
    assert mobility(1, 3, 3, 0, ties) == pytest.approx(0.25 * tied + 0.75 / 4.0)
    ties.constrained = lines(2, -1, -1, -1)
    assert masters_mobility(1, 3, 3, 0, ties)[0] == pytest.approx(0.03125)


# ----------------------------------------------------------------------------------------------------------- all ties


class Settled:
    """Random velocities of both groups at the vertices of a mesh, before and after `resolve_contact`, and the heat of it."""

    def __init__(self, found: Extensions, before, strength=None, friction=0.0, constrained=NOWHERE):
        g, slots, vertices, cells = found.grid, int(found.first[-1]), found.grid.vertex_shape, found.grid.shape
        ties = found.ties if strength is None else (np.where(found.ties[0] > 0.0, strength, 0.0), *found.ties[1:])
        self.before, self.mass, self.heat = before, found.mass, np.zeros((2, *vertices))
        self.transfer, w = np.zeros((5, vertices[0])), before.copy()
        line, pressure = np.zeros((10, *cells)), np.full(cells, -1e3)
        line[contact_geometry.SHARE] = found.hard
        listed = room_for_ties(slots, vertices)
        rows = np.array([g.g, g.g + N])
        names = handle(
            parts=rows, dt=1e-3, friction=friction, constrained=constrained, metrics=g.metrics, dz=g.dz,
            contact_columns=np.tile(rows, (cells[0], 1)), line=line, contact_node_count=found.count, contact_nodes=found.nodes,
            first_slot=found.first, contact_normal=found.normal, touch=np.ones(vertices), strength=ties[0], masters=ties[1],
            where=ties[2], weights=ties[3], sig_rr=pressure, sig_zz=pressure.copy(), sig_rz=np.zeros(cells), mass=self.mass,
            u0=before[0].copy(), v0=before[1].copy(), u=w[0], v=w[1], **listed, heat=self.heat, transfer=self.transfer)
        resolve_contact(names)
        heat_contact_nodes(names)
        self.after = w
        slot, group = names.nodes[:2]
        #: of every slave: its strength, and by what it differs from its masters before and after
        self.slaves = [(ties[0][slot[t], group[t]], *(np.array(mismatch(t, *u, names)) for u in (before, w)))
                       for t in range(np.count_nonzero(ties[0]))]

    def sums(self, w):
        """(momentum along r and z, kinetic energy)"""
        return np.array([*np.sum(self.mass * w, axis=(1, 2, 3)), 0.5 * np.sum(self.mass * w**2)])


def velocities(found: Extensions, seed: int = 0):
    return 100.0 * np.random.default_rng(seed).standard_normal((2, 2, *found.grid.vertex_shape)) * (found.mass > 0.0)


BODIES = [(half_plane(0.4), (np.cos(0.4), np.sin(0.4))), *((scattered(seed), (0.76, 0.64)) for seed in range(3))]
bodies = pytest.mark.parametrize(("hard", "normal"), BODIES)


@bodies
@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("strength", [None, 0.5])
def test_momentum_stays_and_lost_energy_is_heat(hard, normal, friction, strength):
    settled = Settled(found := Extensions(hard, normal, most_squares=2.0), velocities(found), strength, friction)
    before, after = settled.sums(settled.before), settled.sums(settled.after)
    scale = np.sum(settled.mass * np.abs(settled.before))
    np.testing.assert_allclose(after[:2], before[:2], atol=1e-13 * scale)
    lost = before[2] - after[2]
    assert lost > 0.0
    assert np.sum(settled.heat * settled.mass) == pytest.approx(lost, rel=1e-12, abs=1e-12 * before[2])
    assert settled.transfer[1:4].sum() == pytest.approx(lost, rel=1e-11)
    assert (settled.transfer[2].sum() > 0.0) == (friction > 0.0)
    gained = np.sum(settled.mass[0] * (settled.after[1, 0] - settled.before[1, 0]))
    assert settled.transfer[0].sum() == pytest.approx(gained, abs=1e-12 * scale)


@pytest.mark.parametrize("strength", [0.1, 0.5, 0.9])
def test_a_slave_that_is_loosely_tied_goes_part_of_the_way(strength):
    """A single one: what is left of the mismatch follows from its mass, and from the mobility of its masters."""
    hard = np.ones((N, N))
    hard[5, 5] = 0.9  # a crumb of the soft body, whose four vertices are tied to the hard one
    found = Extensions(hard, (1.0, 0.0))
    settled = Settled(found, velocities(found), strength)
    assert len(settled.slaves) == 4
    m, master_mobility = 0.25 * 0.1, 1.0 / (1.0 - 0.25 * 0.1)
    met = (1.0 / m + master_mobility) / (1.0 / (strength * m) + master_mobility)
    assert strength < met < 1.0
    for _, before, after in settled.slaves:
        assert after == pytest.approx((1.0 - met) * before, rel=1e-9)


@pytest.mark.parametrize("beyond", [1e-4, 3e-4, 1e-3])
def test_a_master_that_hardly_counts_does_not_hold_two_nodes_that_hold_each_other(beyond):
    """Its weight is 4e-10 to 4e-6. The nodes of the pair meet, as without it, and no impulse beyond theirs is needed."""
    found = pair(beyond)
    assert 0.0 < 1.0 - found.weights[1, 5, 5, TIED] < 1e-5
    w, at = velocities(found), np.s_[0, :, found.grid.g + 5, found.grid.g + 5]
    settled, alone = Settled(found, w), Settled(pair(0.0), w)
    mismatch = abs(np.diff(w[at])[0])
    assert abs(np.diff(settled.after[at])[0]) < 1e-3 * mismatch
    np.testing.assert_allclose(settled.after[at], alone.after[at], atol=1e-4 * mismatch)
    before, after = settled.sums(settled.before), settled.sums(settled.after)
    assert np.sum(settled.heat * settled.mass) == pytest.approx(before[2] - after[2], abs=1e-14 * before[2])


@bodies
def test_walls_and_the_axis_keep_what_they_hold(hard, normal):
    found = Extensions(hard, normal, most_squares=2.0)
    first = found.grid.g
    constrained = lines(first, -1, -1, first + N)
    w = velocities(found)
    w[0, :, :, first] = 0.0
    w[1, :, first + N] = 0.0
    settled = Settled(found, w, constrained=constrained)
    assert (settled.after[0, :, :, first] == 0.0).all()
    assert (settled.after[1, :, first + N] == 0.0).all()
    before, after = settled.sums(w), settled.sums(settled.after)
    assert after[1] + settled.transfer[4].sum() == pytest.approx(before[1], abs=1e-13 * np.sum(settled.mass * np.abs(w)))
    assert np.sum(settled.heat * settled.mass) == pytest.approx(before[2] - after[2], rel=1e-12)
    assert max(np.abs(left).max() for strength, _, left in settled.slaves if strength == 1.0) < 1e-7


# ------------------------------------------------------------------------------------------------- force on a surface


def one_cell(line, hard: float, soft: float, inside: bool = True, gas: float = 0.0):
    """The cell (0, 0), among the contact-interface cells or not, with some gas of the soft group."""
    return handle(line=line, hard=np.full((1, 1), hard), soft=np.full((1, 1), soft + gas),
                  firm=np.array([soft, hard]).reshape(2, 1, 1), contact_columns=np.array([[0, int(inside)]]))


@pytest.mark.parametrize("inside", [True, False])
def test_without_a_line_an_edge_has_the_share_of_its_cell(inside):
    line = np.zeros((10, 1, 1))
    line[contact_geometry.SHARE] = 0.5
    assert face_aperture(0, 0, 0.0, 0.0, 1.0, 0.0, one_cell(line, 0.3, 0.3, inside)) == (1.0, 0.5, 0.5)
