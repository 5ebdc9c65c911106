"""Cracks during a step: opened, summed across the crack, and turned into void where they bear nothing."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.kernels import cracks
from hydro2d.materials.rows import MEMORY
from hydro2d.mesh.fields import DMG, FAILED, INTERNAL, RHO, SRR
from hydro2d.physics.fracture import crack_opening
from hydro2d.solver.simulation import Simulation
from tests.decks import box, material, mesh, stop, table, walls
from tests.kernels.cells import handle

TENSION, OPENING, SIZE = 1.2e9, 20e-6, 50e-6
TEXT = (mesh((4 * SIZE, 4), (12 * SIZE, 12), geometry="planar") + walls("r_max", "z_min", "z_max")
        + box("block", "metal", z=[0.0, 1.0])
        + material("metal", "Al6061_T6", fracture_pressure=TENSION, damage={"model": "cochran-banner", "opening": OPENING})
        + table("failure", damage="material") + table("numerics", active_region=False) + stop(1e-6))
#: rows of the crack volume and of whether it grows
WIDE, GROWING = INTERNAL, INTERNAL + 1
#: a cell in the middle, with ghosts
J, I = 8, 3


class Block:
    """A block at rest, and the two kernels called as in a step."""

    def __init__(self):
        self.simulation = Simulation(deck.loads(TEXT))
        self.state, self.engine = self.simulation.state, self.simulation.engine
        find = self.engine.given.handle.values.get
        self.models, self.materials, self.mesh_box = find("models"), find("materials"), find("mesh_box")
        self.parts = np.array([2, 14], dtype=np.int64)
        self.q, self.vof = self.state.q, self.state.vof

    def open(self):
        s = self.state
        cracks.open_cracks(0, handle(parts=self.parts, body_range=s.body_range, models=self.models, materials=self.materials,
                           vof=s.vof, q=s.q))

    def damage(self):
        s, g = self.state, self.simulation.grid
        cracks.damage_by_cracks(0, handle(parts=self.parts, mesh_box=self.mesh_box, dr=g.dr, dz=g.dz, group=s.group,
                                body_range=s.body_range, models=self.models, materials=self.materials, u=s.u, v=s.v,
                                vof=s.vof, q=s.q))

    def pressure(self):
        from eos.dispatch import evaluate

        s = self.state
        return evaluate(self.models[0, 0], s.q[RHO, 0, J, I], s.e[0, J, I], s.q[self.models[0, MEMORY]:, 0, J, I],
                        self.simulation.table.eos_par[0])[0]


@pytest.fixture
def block():
    return Block()


@pytest.mark.parametrize("damage", [0.0, 0.125])
def test_a_cell_opens_to_what_it_bears(block, damage):
    block.q[RHO, 0, J, I] *= 0.97
    block.q[DMG, 0, J, I] = damage
    block.q[SRR, 0, J, I] = 1e8
    block.open()
    assert block.pressure() == pytest.approx(-TENSION * (1.0 - damage ** (2 / 3)), rel=1e-9)
    assert np.argwhere(block.q[GROWING, 0]).tolist() == [[J, I]]
    assert not block.q[SRR, 0].any()
    block.open()
    assert not block.q[GROWING].any()
    assert np.argwhere(block.q[WIDE, 0]).tolist() == [[J, I]]


@pytest.mark.parametrize("along", ["z", "r"])
def test_the_damage_is_the_opening_however_the_remap_has_spread_the_crack(block, along):
    """5 um of cracks in one cell, or over three in the direction of opening: D = 5/20. Cracks to the side do not count."""
    (block.state.v if along == "z" else block.state.u)[0] = np.indices(block.state.u[0].shape)[int(along == "r")]
    for shares in ((0.0, 1.0, 0.0), (0.2, 0.5, 0.3)):
        block.q[WIDE], block.q[DMG] = 0.0, 0.0
        for step, share in zip((-1, 0, 1), shares, strict=True):
            at = (J + step, I) if along == "z" else (J, I + step)
            block.q[WIDE, 0][at] = share * 5e-6 / (SIZE * block.q[RHO, 0][at])
        beside = (J, I + 1) if along == "z" else (J + 1, I)
        if shares[1] == 1.0:
            block.q[WIDE, 0][beside] = 1e-5
        block.q[GROWING, 0, J, I] = 1.0
        block.damage()
        assert block.q[DMG, 0, J, I] == pytest.approx(0.25, rel=1e-12)
        assert np.count_nonzero(block.q[DMG]) == 1, "cells in which nothing has opened keep theirs"


def test_opening_a_crack_takes_two_fifths_of_tension_times_opening(block):
    """A cell pulled apart a little in every step: the work of its tension on its crack, per area."""
    work, last = 0.0, 0.0
    while block.q[DMG, 0, J, I] < 1.0:
        block.q[RHO, 0, J, I] *= 1.0 - 2e-4
        block.open()
        crack = crack_opening(1.0, block.q[RHO, 0, J, I], block.q[WIDE, 0, J, I], SIZE)
        work, last = work - block.pressure() * (crack - last), crack
        block.damage()
    assert work == pytest.approx(0.4 * TENSION * OPENING, rel=0.01)


def test_cracks_that_fill_half_of_a_cell_have_joined(block):
    block.q[RHO, 0, J, I] *= 0.45
    block.open()
    assert block.q[DMG, 0, J, I] == FAILED
    assert block.vof[0, J, I] < 0.5
