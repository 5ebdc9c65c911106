"""The slip layer, the step of a row and its cause, and the energies farthest out of range: on cells made by hand."""

import numpy as np
import pytest

from eos import ideal_gas
from hydro2d.kernels import sliding, thermodynamics
from hydro2d.kernels.sliding import BOUNDARY_LAYER, FLUID, HARD, OUTSIDE, SHEAR, SLIP_LAYER
from hydro2d.mesh.fields import EP, INTERNAL, RHO, SRR, SRZ, SZZ, E
from hydro2d.physics.waves import CAUSES
from tests.kernels.cells import Cells

#: of the default deck
VISCOSITY = {"viscosity_linear": 0.5, "viscosity_quadratic": 1.3}


def zoned() -> Cells:
    """A hard body in columns 2 and 3, with a boundary layer and a slip layer of 1 m each next to it."""
    cells = Cells(nr=6, nz=4, bodies=2)
    cells.vof[1, :, 2:4], cells.vof[0, :, 4:8] = 1.0, 1.0
    cells.call(sliding.slip_zones, width_bl=1.0, width_sl=1.0, threshold=0.5, hard_bodies=np.array([False, True]),
               normal=cells.normal)
    return cells


def test_zones_follow_the_distance_from_the_face_of_a_full_cell():
    cells = zoned()
    assert cells.distance[3, 4:6].tolist() == [0.5, 1.5]
    assert cells.zone[3, 2:8].tolist() == [HARD, HARD, BOUNDARY_LAYER, SLIP_LAYER, OUTSIDE, OUTSIDE]
    assert cells.normal[:, 3, 5].tolist() == [1.0, 0.0]


def test_the_surface_in_a_mixed_cell_lies_where_its_fraction_says():
    """Column 4 is filled by 0.25: its surface is at 2.25 m, a quarter of a metre before its middle."""
    cells = zoned()
    cells.vof[1, :, 4] = 0.25
    cells.call(sliding.slip_zones, width_bl=1.0, width_sl=1.0, threshold=0.5, hard_bodies=np.array([False, True]),
               normal=cells.normal)
    assert cells.distance[3, 4:6] == pytest.approx([0.25, 1.25])
    assert cells.zone[3, 4:7].tolist() == [BOUNDARY_LAYER, SLIP_LAYER, OUTSIDE]


@pytest.mark.parametrize(("treatment", "rz", "after"), [(FLUID, 50.0, (0, 0, 0)), (SHEAR, 50.0, (-20, 5, 12)),
                                                        (SHEAR, -50.0, (-20, 5, -12)), (SHEAR, 3.0, (-20, 5, 3))])
def test_soft_material_of_the_slip_layer_loses_its_shear(treatment, rz, after):
    """Friction of 0.1 bears 0.1 (100 + 20) Pa of the shear next to a wall along z."""
    cells = zoned()
    cells.q[SRR], cells.q[SZZ], cells.q[SRZ], cells.pm[...] = -20.0, 5.0, rz, 100.0
    cells.call(sliding.cut_shear, shear=treatment, friction=0.1,
               hard_bodies=np.array([False, True]))
    assert cells.q[[SRR, SZZ, SRZ], 0, 3, 5] == pytest.approx(after)
    for column in (3, 4, 6):
        assert cells.q[[SRR, SZZ, SRZ], 0, 3, column].tolist() == [-20, 5, rz]


def test_the_viscosity_of_the_slip_layer_transmits_no_shear():
    """A q of 8 Pa along (1, 1)/sqrt 2 acts in all directions there, and nowhere else."""
    cells = zoned()
    cells.qr[...], cells.qz[...], cells.qrz[...] = 4.0, 4.0, 4.0
    cells.call(sliding.cut_viscosity)
    assert [a[3, 5] for a in (cells.qr, cells.qz, cells.qt, cells.qrz)] == [8.0, 8.0, 8.0, 0.0]
    for column in (3, 4, 6):
        assert [a[3, column] for a in (cells.qr, cells.qz, cells.qt, cells.qrz)] == [4.0, 4.0, 0.0, 4.0]


# --------------------------------------------------------------------------------------------------------- the step


@pytest.mark.parametrize(("u", "v", "cause"), [(1.0, 0.0, "sound"), (60.0, 0.0, "radial velocity"),
                                               (0.0, -60.0, "axial velocity")])
def test_causes_of_the_step(u, v, cause):
    """Sound of 10 m/s crosses half a cell in 0.05 s, 60 m/s a whole one in less; a uniform velocity changes no volume."""
    cells = Cells()
    cells.rhobar[3, 3:5], cells.cl[3, 3], cells.cl[3, 4] = 1.0, 9.0, 10.0
    cells.u[...], cells.v[...], cells.least_row[0] = u, v, 3
    cells.call(thermodynamics.step_cause, courant=0.5, shock_courant=0.5, advective_courant=1.0, mesh_speed=0.0, **VISCOSITY)
    assert CAUSES[cells.cause[0]] == cause
    assert cells.cause[1] == (4 if cause == "sound" else 3)


def test_a_cell_that_is_pressed_together_sets_the_step():
    cells = Cells()
    cells.rhobar[3, 3:5], cells.cl[3, 3:5] = 1.0, 10.0
    cells.v[0, 4:, 3], cells.least_row[0] = -20.0, 3
    cells.call(thermodynamics.step_cause, courant=0.5, shock_courant=0.5, advective_courant=5.0, mesh_speed=0.0, **VISCOSITY)
    assert (CAUSES[cells.cause[0]], cells.cause[1]) == ("volume change", 3)


def test_energies_that_are_farthest_beyond_reach():
    """A body may have -2 to 40 J/kg and 10 more for every unit of plastic strain."""
    cells, farthest = Cells(), np.zeros((2, 5))
    cells.vof[0, 3, 2:6] = 1.0, 1.0, 1.0, 0.001
    cells.q[E, 0, 3, 2:6], cells.q[EP, 0, 3, 2:6] = (45.0, 50.0, -5.0, 1e9), (0.0, 2.0, 0.0, 0.0)
    gas = ideal_gas
    given = {"m": 0, "sliver": 0.01, "lowest": -2.0, "highest": 40.0, "plastic": 10.0, "most_strain": 0.8, "model": gas.ID,
             "memory": INTERNAL, "shear": 0.0, "chill": 1.0,
             "par": gas.row({"adiabatic_index": 1.4, "reference_density": 1.0}), "worst": farthest}
    cells.q[RHO, 0, 3, 2:6], given["volume"] = 1.0, np.full(cells.vof.shape[1:], 0.5)
    cells.call(thermodynamics.worst_energies, warm=False, **given)
    elastic = 45.0 * 0.4 / (2 * 1.4)  # p^2/(2 K rho) of the gas, p = 0.4 rho e and K = 1.4 p
    assert farthest.tolist() == [[pytest.approx(5.0 - elastic), 3, 2, 0.0, 0.0], [3.0, 3, 4, 1.5, 0.5]]
    cells.call(thermodynamics.worst_energies, warm=True, **given)
    assert farthest[1, :3].tolist() == [5.0, 3, 4]  # it was warm at the start, and is at 0 K
    cells.q[E, 0, 3, 4] = -0.9
    cells.call(thermodynamics.worst_energies, warm=True, **given)
    assert farthest[1, 0] <= 0.0  # at most by `chill`
    cells.q[SRR, 0, 3, 3], given["shear"], cells.q[E, 0, 3, 2] = 20.0, 4.0, 0.0
    cells.q[E, 0, 3, 3] = 70.0  # 22 beyond, of which the stress in the cell is worth 10 + 50
    cells.call(thermodynamics.worst_energies, warm=True, **{**given, "shear": 4e9})
    assert farthest[0, 3:].tolist() == pytest.approx([0.5 * (22.0 - 10.0), 0.5])
    cells.call(thermodynamics.worst_energies, warm=True, **given)
    assert farthest[0, 0] == pytest.approx(22.0 - 70.0 * 0.4 / (2 * 1.4) - 3 * 20.0**2 / (6 * 4.0))
