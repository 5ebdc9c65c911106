"""The remap, kernel by kernel, on cells made by hand: all motion is through one face of one row."""

import numpy as np
import pytest

from hydro2d.kernels import interfaces, momentum, remap
from hydro2d.kernels.momentum import BOTH, KE, MOMENTUM
from hydro2d.mesh.fields import DMG, FAILED, RHO, SRR, E
from tests.kernels.cells import Cells

#: (dj, di), the cell that a volume comes from, the one that it goes to, and the array of the swept volumes
WAYS = [(0, 1, (3, 3), (3, 4), "fr"), (1, 0, (3, 3), (4, 3), "fz")]


@pytest.mark.parametrize("first", [True, False])
def test_a_cell_that_is_turned_inside_out_is_reported_with_its_body(first):
    """The first such cell of a row with a body in it; void may be swept away, and a cell of zero volume does not count."""
    cells = Cells(bodies=2)
    cells.vof[:, 3, 4], cells.vof[:, 3, 5], cells.vof[0, 4, 2] = (0.2, 0.7), (0.6, 0.4), 1.0
    cells.fr[3, 3:7] = 2.0, 0.5, -0.5, -3.0
    cells.fr[4, 3] = -0.99
    cells.call(interfaces.sweep_volumes, dj=0, di=1, second=not first)
    assert cells.pre_sweep_volume[3, 3:6].tolist() == [-0.5, 0.0, -1.5]
    assert cells.turned[3].tolist() == [4, 1]
    assert cells.turned[[2, 4, 5], 0].tolist() == [-1, -1, -1]


def test_nothing_but_void_flows_in_at_an_edge():
    cells = Cells()
    cells.vof[...] = 1.0
    cells.fr[3, [2, 6]] = 0.1
    cells.call(interfaces.donor_volumes, dj=0, di=1, face=cells.fr, void_only=cells.mesh_box)
    assert cells.flux_volume[0, 3, [2, 6]].tolist() == [0.0, 0.1]


def carried(dj, di, source, target, face) -> tuple[Cells, dict]:
    """A cell of 1.25 m^3, full, of which a quarter of a cubic metre flows on; the next one has 0.75 m^3 of void."""
    cells = Cells()
    cells.vof[0, *source], cells.pre_sweep_volume[source], cells.pre_sweep_volume[target] = 1.0, 1.25, 0.75
    cells.q[[RHO, E, SRR, DMG], 0, *source] = 2.0, 10.0, -6.0, 0.5
    getattr(cells, face)[target] = cells.flux_volume[0, *target] = 0.25
    return cells, {"face": getattr(cells, face), "second": True}


def arrived(cells: Cells, source, target) -> None:
    assert cells.vof[0, *source] == 1.0
    assert cells.vof[0, *target] == 0.25
    for cell in (source, target):
        assert cells.q[[RHO, E, SRR, DMG], 0, *cell].tolist() == [2.0, 10.0, -6.0, 0.5]
    assert cells.flux_mass[0, *target] == 0.5
    assert cells.cell_mass[0, *source] == 2.0
    assert cells.cell_mass[0, *target] == 0.5
    assert (cells.mixed_count[target[0]], cells.mixed[target[0], 0]) == (1, target[1])


def test_two_parts_share_the_fluxes_between_them():
    """The volume crosses from one part to the other, whose fluxes are known before either part changes."""
    way = WAYS[1]
    cells, given = carried(*way)
    buffers = {"flux": np.zeros((*cells.flux.shape[:2], 12, cells.flux.shape[3])), "scratch": np.zeros((4, 2, 9))}
    parts = np.array([2, 4, 6])
    for kernel, more in ((remap.shared_fluxes, {}), (remap.sweep_z, given)):
        for part in (1, 0):
            cells.call(kernel, part=part, parts=parts, **buffers, **more)
    arrived(cells, *way[2:4])


def column(*orders: int) -> list:
    """A full column after a sweep along z, by one part or by two parts in an order; every face sweeps a tenth."""
    cells, chance = Cells(nr=1, nz=8), np.random.default_rng(7)
    cells.vof[...], cells.q[...] = 1.0, chance.uniform(1.0, 1.2, cells.q.shape)
    cells.fz[3:10], cells.pre_sweep_volume[...] = 0.1, 1.0
    cells.flux_volume[0, 3:10] = 0.1
    two = {"parts": np.array([2, 6, 10]), "flux": np.zeros((*cells.flux.shape[:2], 12, cells.flux.shape[3])),
           "scratch": np.zeros((4, 2, 13))}
    given = {"face": cells.fz, "second": True}
    for part in orders:
        cells.call(remap.shared_fluxes, part=part, **two)
    for part in orders:
        cells.call(remap.sweep_z, part=part, **two, **given)
    if not orders:
        cells.call(remap.sweep_z, **given)
    return [each[..., 2:10, 2].tolist() for each in (cells.vof, cells.q, cells.cell_mass, cells.flux_mass)]


@pytest.mark.parametrize("orders", [(0, 1), (1, 0)])
def test_two_parts_do_what_one_does_to_the_last_bit(orders):
    assert column(*orders) == column()


def test_flow_over_the_edge_of_the_mesh_is_kept():
    cells, given = carried(0, 1, (3, 5), (3, 6), "fr")
    cells.call(remap.sweep_r, **given)
    assert cells.edge_flux[1, :, 0, 3].tolist() == [0.5, 5.0]
    assert not cells.edge_flux[0].any()
    cells, given = carried(1, 0, (5, 3), (6, 3), "fz")
    cells.call(remap.sweep_z, **given)
    assert cells.edge_flux[1, :, 0, 3].tolist() == [0.5, 5.0]


def test_failed_material_stays_failed_and_bears_no_deviator():
    cells, given = carried(*WAYS[0])
    cells.q[DMG, 0, 3, 3] = FAILED
    cells.call(remap.sweep_r, **given)
    assert cells.q[[DMG, SRR], 0, 3, 4].tolist() == cells.q[[DMG, SRR], 0, 3, 3].tolist() == [FAILED, 0.0]


def tidied(*fractions: float) -> Cells:
    """Bodies of 2 and 8 kg/m^3 with 10 J/kg in the cell (3, 3), whose vertices move at 3 m/s along z."""
    cells = Cells(bodies=2)
    cells.vof[:, 3, 3], cells.q[RHO, :, 3, 3], cells.q[E, :, 3, 3] = fractions, (2.0, 8.0), 10.0
    cells.v[...] = 3.0
    cells.mixed_count[3], cells.mixed[3, 0] = 1, 3
    cells.call(remap.tidy, cutoff=1e-3, dj=1, di=0, second=True)
    return cells


def test_a_body_below_the_cutoff_is_removed_with_all_its_contents():
    cells = tidied(0.5, 5e-4)
    assert cells.vof[:, 3, 3].tolist() == [0.5, 0.0]
    assert not cells.q[:, 1, 3, 3].any()
    mass = 5e-4 * 8
    assert cells.removed[:, 3] == pytest.approx([10 * mass, 0.5 * mass * 9, 3 * mass, 0, 0, mass])
    assert cells.cell_mass[0, 3, 3] == 1.0
    assert cells.mixed_count[3] == 1


def test_void_below_the_cutoff_closes_and_a_full_cell_is_no_longer_mixed():
    cells = tidied(0.9995, 0.0)
    assert cells.vof[:, 3, 3].tolist() == [1.0, 0.0]
    assert cells.q[RHO, 0, 3, 3] == pytest.approx(2 * 0.9995)
    assert cells.removed[3, 3] == pytest.approx(5e-4)
    assert cells.mixed_count[3] == 0


# ---------------------------------------------------------------------------------------------------------- momentum


def swept(advection: int, dj: int, di: int, pushing=None, component: int = 1) -> Cells:
    """Cells of 1 kg through which 0.2 kg flow; a mass at rest follows the one that moves along z at 1 m/s."""
    cells = Cells(nr=8, nz=8)
    cells.cell_mass[...] = cells.mass[...] = 1.0
    cells.flux_mass[...] = 0.2
    step = (np.arange(13) > 6).astype(float)
    cells.velocity0[component, 0] = step[:, None] if dj else step[None, :]
    cells.call(momentum.sweep_momentum, dj=dj, di=di, advection=advection, ke_bound=2.0,
               **({} if pushing is None else {"pushing": pushing}), edge_velocity=np.zeros(8))
    return cells


@pytest.mark.parametrize(("dj", "di"), [(0, 1), (1, 0)], ids=["r", "z"])
@pytest.mark.parametrize(("advection", "after"), [(MOMENTUM, 0.8), (KE, np.sqrt(0.8)), (BOTH, 0.8)])
def test_flow_into_a_vertex_brings_the_velocity_of_its_origin(dj, di, advection, after):
    """Momentum 1 + 0.2 (0 - 1) kg m/s and kinetic energy (1 + 0.2 (0 - 1))/2 J of 1 kg."""
    cells = swept(advection, dj, di)
    along = cells.v[0, :, 6] if dj else cells.v[0, 6, :]
    assert along[4:10] == pytest.approx([0, 0, 0, after, 1, 1])
    assert not cells.u.any()
    missed = 0.4 - 0.32 if advection == BOTH else 0.0
    assert (cells.deficit[0, 7, 6] if dj else cells.deficit[0, 6, 7]) == pytest.approx(missed)


@pytest.mark.parametrize("side", [0, 1], ids=["low", "high"])
@pytest.mark.parametrize(("dj", "di"), [(0, 1), (1, 0)], ids=["r", "z"])
def test_flow_beyond_an_edge_that_only_pushes_stops_there(dj, di, side):
    """The vertex where 0.2 kg come in moves at 0.8 m/s: into the mesh from its low edge, and beyond its high one."""
    pushing = np.full(4, -1)
    pushing[2 * dj + side] = 7
    cells = swept(MOMENTUM, dj, di, pushing, component=dj)
    along = cells.v[0, :, 6] if dj else cells.u[0, 6, :]
    assert along[7] == pytest.approx(0.0 if side else 0.8)
    assert (cells.momentum_sums[4, 7] > 0.5) == bool(dj and side)


def test_vertices_where_nothing_flows_keep_every_bit():
    cells = Cells(nr=8, nz=8)
    cells.cell_mass[...] = cells.mass[...] = 1.0
    cells.velocity0[...] = np.random.default_rng(5).random(cells.velocity0.shape)
    cells.call(momentum.sweep_momentum, dj=0, di=1, advection=KE, ke_bound=2.0, edge_velocity=np.zeros(8))
    inside = (slice(None), slice(None), slice(2, 11), slice(2, 11))
    assert (cells.velocity[inside] == cells.velocity0[inside]).all()


def test_energy_of_a_vertex_is_given_to_the_group_in_the_cells_around():
    cells = Cells(bodies=2, group=[0, 1])
    cells.vof[:, 2:6, 2:6], cells.cell_mass[0], cells.cell_mass[1] = 0.5, 3.0, 5.0
    cells.deficit[1, 4, 4] = 4.0
    cells.call(momentum.deposit, ranges=cells.active_range)
    assert cells.q[E, 1, 3:5, 3:5].tolist() == [[1, 1], [1, 1]]
    assert cells.q[E, 1].sum() == 4.0
    assert not cells.q[E, 0].any()
    assert cells.deposited.sum() == 20.0
