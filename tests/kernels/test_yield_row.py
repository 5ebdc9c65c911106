"""A row of pure cells: those that yield, and no others, return as each would alone."""

import math

import numpy as np
import pytest

from hydro2d.kernels.deformation import yield_row
from hydro2d.materials.rows import DAMAGE, DAMAGE_AT, FACTOR, GAS, STRENGTH, STRENGTH_AT
from hydro2d.mesh.fields import DMG, EP, FAILED, INTERNAL, LANE_ROWS, LANES, RHO, SRR, SRZ, SZZ, E
from hydro2d.physics.stress import von_mises
from strength import DAMAGE_MODELS, STRENGTH_MODELS
from strength.radial_return import plastic_increment
from tests.contract.test_models import DAMAGE_CASES, STRENGTH_CASES
from tests.kernels.cells import handle

FIRST, BESIDE = 2, 3
FACTORED, DT, T, P, DENSITY = 1.5625, 1e-8, 400.0, 1e9, 2750.0
CELL = 2.5e-5
DEVIATOR = (SRR, SZZ, SRZ)


class Row:
    """A row of cells with deviators of random direction and size, from below to ten times the flow stress."""

    def __init__(self, name: str, columns: int, seed: int = 1):
        random = np.random.default_rng(seed)
        self.module, self.par = STRENGTH_MODELS[name], STRENGTH_MODELS[name].row(STRENGTH_CASES[name])
        damage = DAMAGE_MODELS["johnson-cook"]
        self.damage, self.damage_par = damage, damage.row(DAMAGE_CASES["johnson-cook"])
        self.columns = columns
        self.models, self.materials = np.zeros((1, 5), dtype=np.int64), np.zeros((1, GAS + 1))
        self.models[0, STRENGTH], self.models[0, DAMAGE] = self.module.ID, damage.ID
        self.materials[0, STRENGTH_AT:STRENGTH_AT + self.par.size] = self.par
        self.materials[0, DAMAGE_AT:DAMAGE_AT + self.damage_par.size] = self.damage_par
        self.materials[0, FACTOR] = FACTORED
        cells = FIRST + columns + BESIDE
        self.q = np.zeros((INTERNAL, 1, 1, cells))
        self.q[RHO], self.q[E], self.q[EP] = DENSITY, 1.0, random.uniform(0.0, 0.3, cells)
        for k in DEVIATOR:
            self.q[k] = random.uniform(-1.0, 1.0, cells) * 10.0 ** random.uniform(8.0, 9.5, cells)
        self.pm, self.tm = np.full((1, 1, cells), P), np.full((1, 1, cells), T)
        self.scratch = np.zeros((4, 1, cells + 1))
        self.scratch[0] = 26e9
        self.scratch[1, 0, :cells] = von_mises_of(*(self.q[k, 0, 0] for k in DEVIATOR))

    def yields(self) -> np.ndarray:
        """q [k, i] after yield_row."""
        q = self.q.copy()
        yield_row(0, 0, 0, handle(dt=DT, models=self.models, materials=self.materials, pm=self.pm, tm=self.tm,
                  scratch=self.scratch, q=q, lanes=np.zeros((1, LANE_ROWS * LANES)),
                  dr=np.full(q.shape[-1], CELL), dz=np.full(1, CELL),
                  body_range=np.array([[[FIRST, FIRST + self.columns]]])))
        return q[:, 0, 0]

    def alone(self) -> np.ndarray:
        """`yields`, cell by cell."""
        q = self.q[:, 0, 0].copy()
        for i in range(FIRST, FIRST + self.columns):
            size, t, p = abs(self.scratch[1, 0, i]), self.tm[0, 0, i], self.pm[0, 0, i]
            dep, stress = plastic_increment(
                self.module.ID, size, q[EP, i], DT, t, p, q[RHO, i], self.scratch[0, 0, i], FACTORED, self.par, 0.0)
            if dep > 0.0:
                q[DEVIATOR, i] *= stress / size
                q[EP, i] += dep
                faster = self.damage.size_factor(CELL * CELL, self.damage_par)
                damage = q[DMG, i] + faster * self.damage.damage_increment(dep, dep / DT, t, p, stress, self.damage_par)
                q[DMG, i] = damage if damage < 1.0 else FAILED
        return q


von_mises_of = np.vectorize(von_mises)


@pytest.mark.thorough
@pytest.mark.parametrize("name", sorted(set(STRENGTH_CASES) - {"hydrodynamic", "kinematic-hardening", "johnson-holmquist"}))
@pytest.mark.parametrize("columns", [1, 8, 33, 75])
def test_a_row_is_its_cells(name, columns):
    row = Row(name, columns)
    row.scratch[1, 0, FIRST::5] = 0.0  # cells that the body does not fill
    row.scratch[1, 0, FIRST + 1::7] *= -1.0  # cells of low density
    row.tm[0, 0, FIRST + 2::6] = 2500.0  # melted cells
    row.scratch[0, 0, FIRST + 3::9] = 0.0  # cells without a modulus
    result, expected = row.yields(), row.alone()
    np.testing.assert_allclose(result, expected, rtol=1e-9, atol=1e-300)
    assert columns < 8 or (result[EP] > row.q[EP, 0, 0]).sum() > columns // 4
    np.testing.assert_array_equal(result[EP] > row.q[EP, 0, 0], expected[EP] > row.q[EP, 0, 0])


@pytest.mark.parametrize("what", ["trial", "strain", "T"])
def test_a_nan_reaches_the_stress_of_its_cell_alone(what):
    row, clean = Row("johnson-cook", 20), Row("johnson-cook", 20).yields()
    place = {"trial": row.scratch[1, 0], "strain": row.q[EP, 0, 0], "T": row.tm[0, 0]}[what]
    i = FIRST + int(np.argmax(row.scratch[1, 0, FIRST:FIRST + 20]))
    place[i] = math.nan
    result = row.yields()
    assert np.isnan(result[DEVIATOR, i]).all()
    assert np.isnan(result[EP, i])
    others = np.arange(result.shape[1]) != i
    np.testing.assert_array_equal(result[:, others], clean[:, others])
