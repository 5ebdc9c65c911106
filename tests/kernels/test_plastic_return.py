"""One body in one cell returns to its yield surface, or to the flow stress of its cell."""

import numpy as np
import pytest

from hydro2d.kernels import plastic_return
from hydro2d.materials.rows import DAMAGE_AT, FACTOR, GAS, RECORD, STRENGTH_AT, TENSILE
from hydro2d.mesh.fields import BY_DAMAGE, BY_TENSION, DMG, EP, FAILED, INTERNAL, RHO
from strength import DAMAGE_MODELS as DAMAGES
from strength import STRENGTH_MODELS
from tests.kernels.cells import handle

flow, return_to_surface = plastic_return.flow.source, plastic_return.return_to_surface.source

HARDENS, PLAIN = STRENGTH_MODELS["kinematic-hardening"], STRENGTH_MODELS["elastic-plastic"]


class Cell:
    """One cell of one body; the model hardens, or is perfectly plastic at 0.3 GPa, and breaks at a strain of 0.5."""

    def __init__(self, model, row, deviator=(0.0, 0.0, 0.0)):
        self.models = np.array([[0, model.ID, DAMAGES["johnson-cook"].ID, 0, 0]])
        self.materials = np.zeros((1, GAS + 1))
        self.materials[0, STRENGTH_AT:DAMAGE_AT] = row
        self.materials[0, DAMAGE_AT:TENSILE] = DAMAGES["johnson-cook"].row({"D1": 0.5})
        self.materials[0, FACTOR] = 1.0
        self.q = np.zeros((INTERNAL + 4, 1, 1, 1))
        self.q[RHO] = 2700.0
        self.deviator, self.internal = deviator, np.zeros(4)
        self.pm, self.tm = np.zeros((1, 1, 1)), np.full((1, 1, 1), 300.0)

    def back(self, own=True, cell_yield=0.0):
        return return_to_surface(0, 0, 0, *self.deviator, 26e9, own, cell_yield, handle(
            internal=self.internal[None], **self.names()))

    def names(self):
        return {"dt": 1e-6, "models": self.models, "materials": self.materials, "pm": self.pm, "tm": self.tm, "q": self.q,
                "dr": np.full(1, 2e-4), "dz": np.full(1, 5e-5)}


PLASTIC = PLAIN.row({"shear_modulus": 26e9, "yield_stress": 3e8})


@pytest.mark.parametrize(("exponent", "faster"), [(0.0, 1.0), (0.5, 0.5), (1.0, 0.25)])
def test_damage_grows_by_the_size_of_the_cell(exponent, faster):
    """A cell of 0.2 by 0.05 mm, a quarter of the reference cell of 0.4 mm."""
    cell = Cell(PLAIN, PLASTIC)
    given = {"D1": 0.5, "reference_cell": 4e-4, "cell_exponent": exponent}
    cell.materials[0, DAMAGE_AT:TENSILE] = DAMAGES["johnson-cook"].row(given)
    flow(0, 0, 0, 0.1, 3e8, handle(**cell.names()))
    assert cell.q[DMG, 0, 0, 0] == pytest.approx(0.2 * faster)


@pytest.mark.parametrize("row", [0, INTERNAL])
def test_a_cell_that_damage_breaks_is_noted_once(row):
    """If there is a record: what was noted before it broke is replaced, what comes after is not."""
    cell = Cell(PLAIN, PLASTIC)
    cell.models[0, RECORD] = row
    cell.q[INTERNAL] = BY_TENSION
    for _ in range(4):
        flow(0, 0, 0, 0.1, 3e8, handle(**cell.names()))
    assert cell.q[INTERNAL, 0, 0, 0] == BY_TENSION
    flow(0, 0, 0, 0.2, 3e8, handle(**cell.names()))
    assert cell.q[INTERNAL, 0, 0, 0] == (BY_DAMAGE if row else BY_TENSION)
    assert (cell.q[RHO], cell.q[DMG]) == (2700.0, FAILED)


@pytest.mark.parametrize(("own", "cell_yield"), [(True, 0.0), (False, 3e8)])
def test_within_the_surface_nothing_flows(own, cell_yield):
    cell = Cell(PLAIN, PLASTIC, (-1e7, 2e7, 3e7))
    assert cell.back(own, cell_yield)[:4] == (-1e7, 2e7, 3e7, 0.0)
    assert cell.q[EP, 0, 0, 0] == cell.q[DMG, 0, 0, 0] == 0.0


def test_a_stress_that_is_no_number_stays_one():
    cell = Cell(PLAIN, PLASTIC, (np.nan, 1e9, 0.0))
    assert np.isnan(cell.back()[3])
    assert np.isnan(cell.q[EP, 0, 0, 0])
