"""The bounds of the time step in a cell, each from the arrays around it."""

import numpy as np
import pytest

from hydro2d.kernels.thermodynamics import step_limits
from hydro2d.mesh.grid import AZ_IN, AZ_OUT, FACE_R, VOL_R
from hydro2d.physics.waves import CAUSES
from tests.kernels.cells import handle, source

#: a slow cell of 1 by 2 mm: the first and the last vertex of a row belong to other cells
CELL = {
    "ub": [9e9, 1.0, 1.0, 9e9],
    "ut": [9e9, 1.0, 1.0, 9e9],
    "vb": [9e9, 1.0, 1.0, 9e9],
    "vt": [9e9, 1.0, 1.0, 9e9],
    "courant": 0.5,
    "shock_courant": 0.5,
    "advective_courant": 0.4,
    "viscosity_linear": 0.0,
    "viscosity_quadratic": 1.0,
    "mesh_speed": 0.0,
    "h": 2e-3,
    "rho": 8000.0,
    "cl": 5000.0,
    "q": 0.0,
}


def limits(**changed) -> dict[str, float]:
    """Bounds by cause of the middle one of three cells in a row, with some of CELL changed."""
    cell = CELL | changed
    dr, rows = np.array([9e-9, 1e-3, 9e-9]), {name: np.full((1, 3), cell[name]) for name in ("rho", "cl", "q")}
    metrics = np.zeros((8, 4))
    metrics[FACE_R], metrics[VOL_R, :3], metrics[AZ_IN, :3], metrics[AZ_OUT, :3] = 1.0, dr, 0.5 * dr, 0.5 * dr
    u, v = np.array([[cell["ub"], cell["ut"]]]), np.array([[cell["vb"], cell["vt"]]])
    numbers = {name: value for name, value in cell.items() if "courant" in name or "viscosity" in name or name == "mesh_speed"}
    w = handle(u=u, v=v, dr=dr, dz=np.array([cell["h"]]), metrics=metrics, rhobar=rows["rho"], cl=rows["cl"], qr=rows["q"],
               qz=0.5 * rows["q"], **numbers)
    return dict(zip(CAUSES, source(step_limits)(0, 1, w), strict=True))


def changed_by(**changed) -> set[str]:
    """The bounds that differ from those of CELL."""
    before, after = limits(), limits(**changed)
    return {cause for cause in before if after[cause] != before[cause]}


def row(first: float, last: float) -> list[float]:
    return [9e9, first, last, 9e9]


# ---------------------------------------------------------------------------------------------------------- sound


def test_the_height_counts_where_it_is_the_smaller_side():
    assert limits(h=0.25e-3)["sound"] == pytest.approx(0.25e-7)


# ------------------------------------------------------------------------------------------------------- velocity


@pytest.mark.parametrize("speed", [800.0, -800.0])
@pytest.mark.parametrize("name", ["ub", "ut"])
@pytest.mark.parametrize("end", [0, 1])
def test_the_fastest_vertex_may_cross_two_fifths_of_the_width(speed, name, end):
    changed = {name: row(*((speed, 1.0) if end == 0 else (1.0, speed)))}
    assert limits(**changed)["radial velocity"] == pytest.approx(0.4 * 1e-3 / 800.0)
    assert changed_by(**changed) - {"volume change"} == {"radial velocity"}


@pytest.mark.parametrize(("name", "end"), [("vb", 0), ("vb", 1), ("vt", 0), ("vt", 1)])
def test_along_the_axis_only_the_motion_through_the_mesh_counts(name, end):
    """Three vertices go with the mesh, one is 200 m/s slower."""
    moving = {"vb": row(1000.0, 1000.0), "vt": row(1000.0, 1000.0)}
    moving[name] = row(*((800.0, 1000.0) if end == 0 else (1000.0, 800.0)))
    assert limits(mesh_speed=1000.0, **moving)["axial velocity"] == pytest.approx(0.4 * 2e-3 / 200.0)
    assert limits(mesh_speed=1000.0, **moving)["radial velocity"] == limits()["radial velocity"]
