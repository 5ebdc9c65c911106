"""Vertices outside of the full cells of a body: by what they are held, what that keeps, and what cut cells bear."""

import numpy as np
import pytest

from hydro2d.kernels import cut_cells, outer_vertices, vertex_forces
from hydro2d.mesh.fields import RHO
from tests.kernels.cells import Cells

RADIAL, AXIAL = 0, 1


def layer(share: float, along: int = AXIAL, sign: int = 1) -> Cells:
    """Three full rows or columns between walls, from low to high or from high to low, and a share of the next one."""
    cells = Cells(nr=6, nz=6)
    f = np.zeros((6, 6))
    f[:3], f[3] = 1.0, share
    f = f[::sign] if along == AXIAL else f[::sign].T
    cells.grid.interior(cells.vof)[0], cells.grid.interior(cells.solid)[...] = f, f
    cells.q[RHO] = 2.0
    cells.cell_mass[0] = cells.vof[0] * 2.0 * cells.grid.volume
    low, past_z, first, past_r = cells.mesh_box
    walls, strong = np.array([first, past_r, low, past_z, -1, -1, -1, -1]), np.zeros(1, dtype=bool)
    cells.known |= {"constrained": walls, "edge_velocity": np.zeros(8), "group": np.zeros(1, dtype=int), "strong": strong,
                    "hard_bodies": strong, "threshold": 1.0, "tipton": True, "dt": 1 / 3,
                    "tension": np.zeros(1), "fades": np.zeros(1)}
    cells.call(vertex_forces.vertex_masses)
    for j in range(low, past_z):
        cut = np.nonzero((cells.solid[j] > 0.0) & (cells.solid[j] < 1.0))[0]
        cells.mixed_count[j], cells.mixed[j, :len(cut)] = len(cut), cut
    cells.call(cut_cells.find_surfaces)
    cells.call(outer_vertices.find_held)
    return cells


def held(cells: Cells) -> np.ndarray:
    return cells.grid.interior_vertices(cells.held)


@pytest.mark.parametrize("along", [RADIAL, AXIAL])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("share", [1e-3, 0.5, 0.9])
def test_the_outer_row_of_vertices_is_held(share, sign, along):
    found = held(layer(share, along, sign))
    found = (found if along == AXIAL else found.T)[::sign]
    assert found[4] == pytest.approx(1.0)
    assert np.all(np.delete(found, 4, axis=0) == 0.0)


@pytest.mark.parametrize("along", [RADIAL, AXIAL])
@pytest.mark.parametrize("sign", [1, -1])
def test_what_sinks_is_held_momentum_is_kept_and_motion_becomes_heat(sign, along):
    """Outer vertices that have just begun to sink at 1 m/s, over a body at rest; at the start of the step they sank as fast."""
    cells = layer(0.5, along, sign)
    mass = cells.mass[0]
    v, v0 = (cells.v, cells.v0) if along == AXIAL else (cells.u, cells.u0)
    v[0] = v0[0] = np.where(cells.held > 0.0, -float(sign), 0.0)
    before, energy = (mass * v[0]).sum(), 0.5 * (mass * v[0] ** 2).sum()
    cells.call(outer_vertices.hold_vertices)
    assert (mass * v[0]).sum() == pytest.approx(before, rel=1e-14)
    outer = v[0][cells.held > 0.0]
    assert outer == pytest.approx(-sign / 4, rel=1e-12)  # a quarter of a cell at the outer vertices, three at their anchors
    cells.call(outer_vertices.heat_held_vertices)
    assert (mass * cells.held_heat)[cells.held > 0.0].sum() == pytest.approx(energy - 0.5 * (mass * v[0] ** 2).sum(), rel=1e-12)


@pytest.mark.parametrize("along", [RADIAL, AXIAL])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("limit", "left"), [(1e9, 0.25), (1.0, 0.5), (0.0, 1.0)])
def test_a_body_takes_its_layer_along_as_far_as_its_tensile_strength_goes(limit, left, sign, along):
    """Outer vertices that part at 1 m/s, a quarter of the mass: 1 Pa takes 2/3 m/s from the layer of 0.5 kg/m^2 in 1/3 s."""
    cells = layer(0.5, along, sign)
    v = cells.v if along == AXIAL else cells.u
    v[0] = np.where(cells.held > 0.0, float(sign), 0.0)
    before = (cells.mass[0] * v[0]).sum()
    cells.call(outer_vertices.hold_vertices, tension=np.array([limit]), km=np.full(cells.vof.shape, 1e12))
    assert (cells.mass[0] * v[0]).sum() == pytest.approx(before, rel=1e-14)
    assert v[0][cells.held > 0.0] * sign == pytest.approx(left, rel=1e-12) if limit else np.all(cells.held == 0.0)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_cut_cell_bears_half_of_its_own_weight(share):
    """Beneath it lies a full cell under the weight of the share and half of its own."""
    cells = layer(share)
    cells.p[...] = np.where(cells.solid == 1.0, share + 0.5, 0.0)
    cells.call(outer_vertices.bear)
    assert cells.grid.interior(cells.borne)[3] == pytest.approx(0.5 * share)
    cells.call(outer_vertices.bear, strong=np.ones(1, dtype=bool))
    assert np.all(cells.borne == 0.0)
