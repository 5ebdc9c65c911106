"""Cells that a surface cuts: positions of their surfaces, the traction at which bodies meet, resulting volumes and energies."""

import numpy as np
import pytest

from hydro2d.kernels import cut_cells
from hydro2d.kernels.cut_cells import BESIDE_GAS, FREE_SURFACE, INTERFACE, JOINT, KIND, MOST_TIED, NORMAL_R, NORMAL_Z, WHOLE
from hydro2d.kernels.mixed_scratch import ACROSS, ALONG, BESIDE, FLOW, GROWTH, MODULUS, SIZE
from hydro2d.mesh.fields import INTERNAL, RHO, E
from hydro2d.mesh.grid import CM_IN, CM_OUT, VOL_R
from hydro2d.physics import contents, traction
from tests.kernels.cells import handle

common_traction = cut_cells.common_traction.source
pull_of = contents.pull_of.py_func
cut_pressure = cut_cells.cut_pressure.source
traction_of_change = cut_cells.traction_of_change.source
fill_cut_cell = cut_cells.fill_cut_cell.source
pressure_with_gas = cut_cells.pressure_with_gas.source

RIGID = 1e6  # a yield stress, in units of the modulus, that nothing reaches


class Cell:
    """One cut cell with bodies (share, pressure, modulus, shear modulus), in units of a modulus; normal along r."""

    def __init__(self, *bodies, kind=INTERFACE, weight=1.0, flow=RIGID, gas=None):
        f, p, bulk, shear = np.transpose(bodies)
        self.number = len(f)
        self.gases = np.zeros(len(f), dtype=bool)
        if gas is not None:
            self.gases[gas] = True
        self.vof, self.pm, self.km = (x[:, None, None].copy() for x in (f, p, bulk))
        self.q, self.skin = np.zeros((INTERNAL, self.number, 1, 1)), np.zeros((3, 1, 1))
        self.mix = np.zeros((1, 14, self.number))
        self.q[RHO, :, 0, 0] = 2.0 + np.arange(self.number)
        self.mix[0, MODULUS], self.mix[0, FLOW] = shear, flow
        self.skin[NORMAL_R], self.skin[KIND] = np.sqrt(weight), kind
        self.void, self.solid = max(1.0 - f.sum(), 0.0), np.full((1, 1), f.sum())
        self.borne = np.zeros((1, 1))

    def strained(self, along, beside):
        """The bodies after strain along the surface: n . s . n, of uniaxial deviators, and its trace."""
        self.mix[0, ALONG], self.mix[0, BESIDE] = along, beside
        self.mix[0, SIZE] = 1.5 * np.square(along)
        return self

    def common(self):
        return common_traction(0, 0, handle(skin=self.skin, vof=self.vof, q=self.q, pm=self.pm, km=self.km))

    def meet(self, change: float) -> float:
        p, bulk = (np.full((1, 1), x) for x in self.common())
        return traction_of_change(0, 0, change, self.names(p=p, bulk=bulk, solid=self.solid))

    def names(self, **more):
        return handle(skin=self.skin, vof=self.vof, pm=self.pm, km=self.km, mix=self.mix, gases=self.gases, borne=self.borne,
                      **more)

    @property
    def grown(self) -> float:
        """Growth of the bodies, as a share of the cell."""
        return float(self.vof[:, 0, 0] @ self.mix[0, GROWTH])

    def normal_pressures(self):
        """Minus the normal stress of every body after the step, where nothing flows."""
        s_nn = self.mix[0, ALONG] + 4.0 / 3.0 * self.mix[0, MODULUS] * self.mix[0, ACROSS]
        return self.pm[:, 0, 0] - self.km[:, 0, 0] * self.mix[0, GROWTH] - s_nn


STEEL, ALUMINIUM = (1.0, 0.5), (0.45, 0.17)  # bulk and shear modulus


# ------------------------------------------------------------------------------------------------------- traction


@pytest.mark.parametrize("change", [0.0, 0.01, -0.01])
def test_a_fluid_next_to_void_goes_to_the_pressure_that_it_bears_and_void_takes_the_rest(change):
    cell = Cell((0.7, 0.006, 1.0, 0.0), kind=FREE_SURFACE).strained(0.0, 0.0)
    cell.borne[...] = 0.002
    assert cell.meet(change) == 0.002
    assert cell.mix[0, GROWTH, 0] == pytest.approx(0.004, rel=1e-12)
    one = np.ones((1, 1))
    names = handle(dt=0.1, skin=cell.skin, p=0.002 * one, bulk=one, solid=cell.solid, borne=cell.borne)
    assert cut_pressure(0, 0, 0.0, names) == pytest.approx(0.7 * 0.002)


# ---------------------------------------------------------------------------------------------------- beside a gas


def film(share: float, change: float, p: float = 1e-6) -> Cell:
    """Steel and a gas, K = 1.4 p, that meet a change of volume."""
    cell = Cell((1.0 - share, p, *STEEL), (share, p, 1.4 * p, 0.0), gas=1)
    cell.target = cell.meet(change)
    return cell


def test_the_room_of_a_gas_is_filled_from_anywhere():
    for start in (0.0, 1e-6, 1.0):
        cell = Cell((0.5, 1e-6, *STEEL), (0.5, 1e-6, 1.4e-6, 0.0), gas=1)
        pressure_with_gas(0, 0, -0.2, start, cell.names(p=np.full((1, 1), 1e-6)))
        assert cell.grown == pytest.approx(-0.2, abs=1e-13)


@pytest.mark.parametrize("share", [0.5, 0.1, 0.01])
def test_a_gas_has_the_energy_of_its_isentrope_and_a_film_less(share):
    """p = 0.4 rho e after the step as well; energy is conserved."""
    cell = film(share, -0.9 * share)
    cell.q[RHO, 1], cell.q[E, :, 0, 0] = 1e-6, (0.0, 1.0 / 0.4)
    before = cell.vof[:, 0, 0] * cell.q[RHO, :, 0, 0]
    e = cell.q[E, :, 0, 0].copy()
    change = -0.9 * share
    fill_cut_cell(0, 0, change, 1.0, cell.target, 0.01, cell.names(q=cell.q))
    after = cell.vof[:, 0, 0] * cell.q[RHO, :, 0, 0] * (1.0 + change)
    assert after == pytest.approx(before, rel=1e-12)
    assert before @ (cell.q[E, :, 0, 0] - e) == pytest.approx(0.01, rel=1e-9)
    left = cell.q[E, 1, 0, 0] - 0.01 / before.sum()  # the rest of the work is shared by mass
    assert 0.4 * cell.q[RHO, 1, 0, 0] * left == pytest.approx(cell.target, rel=1e-3)


# ------------------------------------------------------------------------------------------------ where surfaces are

SIZE_OF_MESH = 9
MESH_BOX = np.array([2, SIZE_OF_MESH - 2, 2, SIZE_OF_MESH - 2])


def surfaces(vof, group=(1, 0), hard=(False, False), dr=1.0, dz=1.0, gas=(False, False), strong=(True, True), tipton=True):
    """`skin` of a mesh of alike cells."""
    vof = np.array(vof, dtype=float)
    is_mixed = (vof > 0.0).any(axis=0) & (vof < 1.0).all(axis=0)
    count, mixed, skin = np.zeros(SIZE_OF_MESH, dtype=np.int64), np.zeros((SIZE_OF_MESH,) * 2, dtype=np.int64), np.full(
        (3, SIZE_OF_MESH, SIZE_OF_MESH), np.nan)
    for j in range(SIZE_OF_MESH):
        count[j] = is_mixed[j].sum()
        mixed[j, : count[j]] = np.nonzero(is_mixed[j])[0]
    cut_cells.find_surfaces(0, handle(parts=MESH_BOX[:2], i0=2, i1=SIZE_OF_MESH - 2, mesh_box=MESH_BOX,
                            dr=np.full(SIZE_OF_MESH, dr), dz=np.full(SIZE_OF_MESH, dz), tipton=tipton, group=np.array(group),
                            hard_bodies=np.array(hard), threshold=0.5, strong=np.array(strong), gases=np.array(gas),
                            mixed_count=count, mixed=mixed, vof=vof, skin=skin))
    return skin


def half_plane(angle: float, dr: float = 1.0, dz: float = 1.0):
    """Fractions of material on the side opposite to (cos, sin) of a line through the middle of the mesh."""
    inside = (np.arange(40) + 0.5) / 40
    x = ((np.arange(SIZE_OF_MESH)[:, None] + inside).ravel() - 0.5 * SIZE_OF_MESH) * dr
    below = x[None, :] * np.cos(angle) + x[:, None] * (dz / dr) * np.sin(angle) <= 0.0
    return below.reshape(SIZE_OF_MESH, 40, SIZE_OF_MESH, 40).mean(axis=(1, 3))


@pytest.mark.parametrize("degrees", [0, 20, 45, 70, 90, 160, 225, 300])
@pytest.mark.parametrize("dz", [1.0, 1.5])
def test_the_normal_of_a_flat_interface_is_found(degrees, dz):
    angle = np.radians(degrees)
    hard = half_plane(angle, dz=dz)
    skin = surfaces([hard, 1.0 - hard], dz=dz)
    middle = skin[:, SIZE_OF_MESH // 2, SIZE_OF_MESH // 2]
    assert middle[KIND] == INTERFACE
    assert middle[NORMAL_R] * np.cos(angle) + middle[NORMAL_Z] * np.sin(angle) > np.cos(np.radians(4.0))
    assert middle[NORMAL_R] ** 2 + middle[NORMAL_Z] ** 2 == pytest.approx(1.0)


@pytest.mark.parametrize("degrees", [20, 45, 70])
def test_a_surface_next_to_void_has_the_normal_of_its_group(degrees):
    body = half_plane(np.radians(degrees))
    with_void = surfaces([np.zeros_like(body), body])[:, 4, 4]
    with_other = surfaces([body, 1.0 - body])[:, 4, 4]
    assert with_void[KIND] == FREE_SURFACE
    assert with_void[:2] == pytest.approx(with_other[:2])


def test_a_mirrored_interface_has_the_mirrored_normal():
    random = np.random.default_rng(3)
    fractions = random.random((2, SIZE_OF_MESH, SIZE_OF_MESH))
    fractions /= fractions.sum(axis=0) * random.uniform(1.0, 2.0, fractions.shape[1:])
    skin, along_r, along_z = surfaces(fractions), surfaces(fractions[:, :, ::-1]), surfaces(fractions[:, ::-1])
    inside = np.s_[2:-2, 2:-2]
    for k in range(3):
        np.testing.assert_allclose(along_r[k][inside], (-1.0 if k == NORMAL_R else 1.0) * skin[k][inside][:, ::-1], atol=1e-14)
        np.testing.assert_allclose(along_z[k][inside], (-1.0 if k == NORMAL_Z else 1.0) * skin[k][inside][::-1], atol=1e-14)
    swapped = surfaces(fractions[::-1])
    np.testing.assert_allclose(swapped[:2, 2:-2, 2:-2], -skin[:2, 2:-2, 2:-2], atol=1e-14)
    assert np.abs(skin[:2, 2:-2, 2:-2]).max() > 0.5


def test_a_bubble_and_a_weak_gradient_have_no_weight():
    full = np.ones((SIZE_OF_MESH, SIZE_OF_MESH))
    full[4, 4] = 0.7
    skin = surfaces([np.zeros_like(full), full])
    assert skin[KIND, 4, 4] == FREE_SURFACE
    assert (skin[:2, 4, 4] == 0.0).all()
    sloping = np.broadcast_to(0.5 + 0.05 * (np.arange(SIZE_OF_MESH) - 4.0), full.shape)  # half of STEEP across a cell
    assert np.sum(surfaces([np.zeros_like(full), sloping])[:2, 4, 4] ** 2) == pytest.approx(0.5)


def test_kinds_of_cut_cells():
    half, none = np.full((SIZE_OF_MESH,) * 2, 0.5), np.zeros((SIZE_OF_MESH,) * 2)
    assert (surfaces([half, half])[KIND, 2:-2, 2:-2] == INTERFACE).all()
    assert (surfaces([half, half], group=(0, 0))[KIND, 2:-2, 2:-2] == JOINT).all()
    fluids = surfaces([half, half], group=(0, 0), strong=(False, False))  # they have one pressure
    assert (fluids[KIND, 2:-2, 2:-2] == WHOLE).all()
    assert (surfaces([half, half], group=(0, 0), tipton=False)[KIND, 2:-2, 2:-2] == WHOLE).all()
    assert (surfaces([half, half], group=(0, 0), hard=(True, False))[KIND, 2:-2, 2:-2] == WHOLE).all()
    assert (surfaces([half, none])[KIND, 2:-2, 2:-2] == FREE_SURFACE).all()
    assert (surfaces([none, none])[KIND, 2:-2, 2:-2] == WHOLE).all()


def test_the_hard_zone_of_a_slip_layer_has_no_normals():
    body = half_plane(0.3)
    skin = surfaces([body, 0.2 * (1.0 - body)], group=(0, 0), hard=(True, False))
    assert skin[KIND, 4, 4] == FREE_SURFACE
    assert (skin[:2, 4, 4] == 0.0).all()
    assert np.abs(surfaces([body, 0.2 * (1.0 - body)], group=(0, 0))[:2, 4, 4]).max() > 0.5


@pytest.mark.parametrize("degrees", [0, 30, 90, 180])
def test_a_surface_between_bodies_of_one_group_has_the_normal_of_a_free_one(degrees):
    body = half_plane(np.radians(degrees))
    with_void = surfaces([body, np.zeros_like(body)])[:, 4, 4]
    with_gas = surfaces([body, 1.0 - body], group=(1, 1), gas=(False, True), strong=(True, False))[:, 4, 4]
    with_solid = surfaces([body, 1.0 - body], group=(1, 1))[:, 4, 4]
    assert (with_gas[KIND], with_solid[KIND]) == (BESIDE_GAS, JOINT)
    assert with_gas[:2] == pytest.approx(with_void[:2])
    assert abs(with_solid[:2] @ with_void[:2]) == pytest.approx(1.0)


def test_the_share_of_a_body_in_vertices_in_a_gas_is_tied_to_it():
    """A cell of 3 m^2 per radian on r = 1 to 2 m, 2 m high, with 0.25 of 2 kg/m^3 beside gas, and a normal of (0.6, 0.8)."""
    cell = Cell((0.25, 0.0, 1.0, 0.5), (0.75, 0.0, 0.001, 0.0), kind=BESIDE_GAS)
    cell.skin[NORMAL_R], cell.skin[NORMAL_Z] = 0.6, 0.8
    metrics, gases = np.zeros((8, 2)), np.array([False, True])
    metrics[VOL_R, 0], metrics[CM_IN, 0], metrics[CM_OUT, 0] = 1.5, 2 / 9, 5 / 18
    u0 = np.array([[[1.0, 3.0], [6.0, 10.0]]])
    names = handle(metrics=metrics, dz=np.array([2.0]), skin=cell.skin, gases=gases, vof=cell.vof, q=cell.q, u0=u0,
                   v0=-2.0 * u0)
    at_a_vertex = 0.25 * 2.0 * 3.0 * 2 / 9
    by_r, by_z = cut_cells.ties.source(0, 0, names)
    assert (by_r, by_z) == pytest.approx((MOST_TIED * at_a_vertex * 0.36, MOST_TIED * at_a_vertex * 0.64))
    both = [cut_cells.pull_of_ties.source(0, j, i, 0, 0, by_r, by_z, names) for j in (0, 1) for i in (0, 1)]
    pulls = [radial for radial, _ in both]
    assert [axial for _, axial in both] == pytest.approx([-2.0 * radial for radial in pulls])
    assert pulls == pytest.approx([2 * by_r + 5 * by_z, -2 * by_r + 7 * by_z, 4 * by_r - 5 * by_z, -4 * by_r - 7 * by_z])
    after = u0[0] + np.reshape(pulls, (2, 2))  # on vertices of 1 kg
    lost = 0.5 * (u0**2).sum() - 0.5 * (after**2).sum()
    assert traction.tied_work.py_func(0, by_r, by_z, *u0[0], *after) == pytest.approx(lost)
    cell.skin[KIND] = JOINT
    assert cut_cells.ties.source(0, 0, names) == (0.0, 0.0)


def test_bodies_that_are_joined_hold_in_tension():
    cell = Cell((0.4, -0.002, 1.0, 0.5), (0.6, -0.002, 2.0, 0.1), kind=JOINT)
    assert pull_of(0, 0, 0.0, cell.skin) == 1.0
    target = cell.meet(0.001)
    assert target < -0.002
    assert cell.grown == pytest.approx(0.001, rel=1e-9)
    assert cell.normal_pressures() == pytest.approx([target] * 2, rel=1e-9)
