"""A pure cell in a step: pressure, sound, viscosity, the step that it allows, and work."""

import numpy as np
import pytest

from eos import ideal_gas
from eos.layout import ROW
from hydro2d.kernels import deformation, mixed, thermodynamics
from hydro2d.kernels.cut_cells import KIND, WHOLE
from hydro2d.materials.rows import EOS, EOS_AT, TENSILE
from hydro2d.mesh.fields import RHO, E
from tests.kernels.cells import Cells

GAMMA = 1.5
AT = (3, 3)
VISCOSITY = {"viscosity_linear": 0.5, "viscosity_quadratic": 2.0}


def gas(**given) -> Cells:
    """A gas of 2 kg/m^3 with 10 J/kg in one cell of void: p = 10 Pa, K = 15 Pa, c^2 = 7.5 m^2/s^2."""
    cells = Cells()
    models, materials = np.zeros((1, 5), dtype=np.int64), np.zeros((1, EOS_AT + ROW))
    models[0, EOS], materials[0, TENSILE] = ideal_gas.ID, np.inf
    materials[0, EOS_AT:] = ideal_gas.row({"adiabatic_index": GAMMA, "reference_density": 1.0})
    cells.vof[0, *AT], cells.q[RHO, 0, *AT], cells.q[E, 0, *AT], cells.skin[KIND] = 1.0, 2.0, 10.0, WHOLE
    cells.known |= {"models": models, "materials": materials, "group": np.array([0])}
    return cells


def limit(cells: Cells) -> None:
    cells.call(thermodynamics.limit_step, courant=0.5, shock_courant=0.5, advective_courant=1.0, mesh_speed=0.0, hourglass=0.1,
               **VISCOSITY)


def closed(cells: Cells, **given) -> Cells:
    cells.call(mixed.close_cells, max_opening=0.5, smallest_tension=False, **VISCOSITY, **({"dt": 0.0} | given))
    assert (cells.row_step[2:6] == 1e300).all()
    limit(cells)
    return cells


@pytest.mark.thorough
def test_a_gas_at_rest():
    cells = closed(gas())
    values = [getattr(cells, name)[AT] for name in ("p", "bulk", "rhobar", "solid", "cl", "qr", "qz")]
    assert values == pytest.approx([10.0, 15.0, 2.0, 1.0, np.sqrt(7.5), 0.0, 0.0])
    assert cells.hg_coefficient[AT] == pytest.approx(0.25 * 0.1 * 2.0 * np.sqrt(7.5))
    assert cells.row_step[2:6] == pytest.approx([1e300, 0.5 / np.sqrt(7.5), 1e300, 1e300])
    assert not cells.bad.any()
    assert not cells.p[2].any()


def test_a_cell_has_the_linear_viscosity_that_its_last_step_carries():
    """Sound crosses 0.7 of the cell of 1 m in it: (0.75 - 0.49)/1.4 instead of 0.5."""
    cells = gas()
    cells.v[0, 4:] = -2.0
    closed(cells, dt=0.7 / np.sqrt(7.5))
    assert cells.qz[AT] == pytest.approx(2.0 * (2.0 * 4.0 + 0.26 / 1.4 * np.sqrt(7.5) * 2.0))


def test_an_oblique_shock_meets_the_same_viscosity_as_one_along_the_mesh():
    """The velocity along n = (1, 1)/sqrt 2 falls by 2 m/s in 1 m along n, half as steeply beside: psi = 1/2, du = -2 m/s."""
    cells = gas()
    j, i = np.indices(cells.u[0].shape)
    cells.u[0] = cells.v[0] = -2.0 / np.sqrt(2.0) * np.clip((i + j - 6) / np.sqrt(2.0), 0.0, np.sqrt(2.0))
    closed(cells)
    jump = 2.0
    q = 0.5 * 2.0 * (2.0 * jump * jump + 0.5 * np.sqrt(7.5) * jump)
    assert (cells.qr[AT], cells.qz[AT], cells.qrz[AT]) == pytest.approx((q / 2, q / 2, q / 2))
    assert cells.qt[AT] == 0.0


def test_cells_that_are_not_finite_are_counted():
    cells = gas()
    cells.q[E, 0, *AT], cells.u[0, 3, 3] = np.nan, np.inf
    closed(cells)
    assert cells.bad[3].tolist() == [1, 3, 0, 1]


@pytest.mark.thorough
def test_pressure_does_work_on_what_is_pressed_together():
    """The left face moves at 1 m/s for 0.1 s against 10 Pa: 1 J for 2 kg in 0.9 m^3."""
    cells = gas()
    cells.u0[0, 3:5, 3] = cells.u[0, 3:5, 3] = 1.0
    cells.fr[AT] = 0.1
    cells.sig_rr[AT] = cells.sig_zz[AT] = cells.sig_tt[AT] = -10.0
    cells.call(deformation.deform, dt=0.1)
    assert cells.q[[RHO, E], 0, *AT] == pytest.approx([2.0 / 0.9, 10.5])
