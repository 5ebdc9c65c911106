"""Equations of state with memory during a step: the values that they receive, and the changes of their variables."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.kernels import eos_memory
from hydro2d.mesh.fields import DMG, EP, INTERNAL, SRR, SZZ
from hydro2d.output import derived_quantities
from hydro2d.solver.simulation import Simulation
from tests.kernels.cells import handle
from tests.kernels.test_lagrangian import BLOCK
from tests.restarts import restarted

PORES = """
[materials.metal.eos]
model = "p-alpha"
solid = "mie-grueneisen"
reference_density = 2000.0
solid_density = 2700.0
elastic_sound_speed = 4110.0
elastic_pressure = "0.08 GPa"
crush_pressure = "0.70 GPa"
sound_speed = 5350.0
hugoniot_slope = 1.34
grueneisen = 2.0
specific_heat = 890.0
"""
POROUS = BLOCK.replace("[materials.metal.strength]", f"{PORES}[materials.metal.strength]")
#: next to a body without memory, whose strength model has variables of its own
TWO = POROUS.replace("z = [0.0, 5.0]", "z = [0.0, 0.33]") + """
[[body]]
name = "upper"
material = "hardening"
shape = "box"
z = [0.33, 5.0]
[materials.hardening]
based_on = "Al6061_T6"
[materials.hardening.strength]
model = "kinematic-hardening"
shear_modulus = "26 GPa"
yield_stress = "0.3 GPa"
hardening_modulus = "5 GPa"
"""


def simulation(text=POROUS, *overrides):
    return Simulation(deck.loads(text, ['mesh.geometry="planar"', *overrides]))


def test_a_model_receives_the_changes_of_a_step(monkeypatch):
    """Density, strain and damage before and after; work is stress times strain; damage weakens nothing here."""
    received = {}

    def update(model, rho0, rho, e, dep, work, damage0, damage, released, time, dt, par, internal):
        received[len(received)] = rho0, rho, e, dep, work, damage0, damage, released, time, dt
        internal[0] = 1.25

    s = (sim := simulation()).state
    e = sim.engine
    monkeypatch.setitem(eos_memory.update_memory.source.__globals__, "update", update)
    j, i = 4, 3
    names = handle(**{**e.given.handle.values, "parts": np.array([j, j + 1]), "time": 3e-6, "dt": 1e-8})
    s.body_range[0, j] = i, i + 1
    s.rho[0, j, i], s.q[SRR, 0, j, i], s.q[SZZ, 0, j, i] = 2000.0, 1e8, -2e8
    eos_memory.remember.source(0, names)
    s.rho[0, j, i], s.e[0, j, i], s.q[EP, 0, j, i], s.q[DMG, 0, j, i] = 2100.0, 7e3, 0.02, 0.3
    s.q[SRR, 0, j, i], s.q[SZZ, 0, j, i] = 0.5e8, -1e8
    eos_memory.update_memory.source(0, names)
    stress = np.sqrt(3.0 * (1.0 - 2.0 + 4.0)) * 1e8
    expected = (2000.0, 2100.0, 7e3, 0.02, 0.5 * stress * 0.02, 0.0, 0.3, 0.0, 3e-6, 1e-8)
    assert received[0] == pytest.approx(expected, rel=1e-12)
    assert len(received) == 1
    assert s.q[INTERNAL, 0, j, i] == 1.25


MOVES = f"""
numbers = "SI"
[mesh]
geometry = "planar"
r = [{{ to = 0.2, cells = 4 }}]
z = [{{ to = 2.0, cells = 80 }}]
[boundaries]
r_max = "wall"
[[body]]
name = "block"
material = "metal"
shape = "box"
z = [0.2, 0.9]
velocity = 100.0
[materials.metal]
{PORES}
[stop]
time = 1.0
"""


def test_pores_travel_with_the_body():
    """In free flight the distention moves with the body unchanged; crushed material keeps its share of the mass."""
    sim = simulation(MOVES)
    s, g = sim.state, sim.grid
    half = (g.zc < 0.5)[:, None] & np.ones(g.shape, dtype=bool)
    s.q[INTERNAL, 0][half] = 1.1
    s.rho[0][half] *= 1.35 / 1.1  # at zero pressure

    def crushed():
        mass = g.interior(s.vof * s.rho * g.volume)[0]
        return np.sum(mass * g.interior(s.q[INTERNAL, 0]))

    sim.engine.audit = None
    sim.engine.prepare()
    before = crushed()
    for _ in range(60):
        sim.engine.advance()
    assert crushed() == pytest.approx(before, rel=1e-12)
    there = g.interior(s.vof[0]) > 0.0
    distention = g.interior(s.q[INTERNAL, 0])[there]
    assert distention.min() >= 1.1 - 1e-12
    assert distention.max() <= 1.35 + 1e-12
    assert (distention < 1.1 + 1e-6).any()
    assert (distention > 1.35 - 1e-6).any()


def test_it_is_written_for_the_body_that_has_it():
    written = derived_quantities.evaluate(simulation(TWO), ("distention", "back_stress_rr"))
    assert written["Distention of block"].max() == 1.35
    assert "Distention of upper" not in written
    assert "Back Stress rr of upper [Pa]" in written


def test_a_restart_keeps_the_bits():
    first = simulation(MOVES, "body.block.z=[0.0, 0.9]", 'boundaries.z_min="wall"', "body.block.velocity=-300.0")
    for _ in range(20):
        first.step()
    assert first.restart_arrays()["q"][INTERNAL].min() < 1.3
    second = restarted(first)
    for _ in range(10):
        first.step()
        second.step()
    np.testing.assert_array_equal(first.grid.interior(first.state.q), second.grid.interior(second.state.q))


def test_a_failure_record_lies_between_the_variables_of_the_models():
    """And changes none of them: a porous body beside one whose strength model has variables of its own."""
    can_fail = [f"materials.{name}.fracture_pressure='0.5 GPa'" for name in ("metal", "hardening")]
    can_fail.append("failure.tensile='material'")
    noted, plain = (simulation(TWO, *can_fail, f"failure.record={word}") for word in ("true", "false"))
    for each in (noted, plain):
        for _ in range(20):
            each.step()
    assert noted.table.record.tolist() == [INTERNAL, INTERNAL + 3]
    assert noted.table.memory.tolist() == [INTERNAL + 1, INTERNAL + 4]
    assert plain.table.record.tolist() == [0, 0]
    for m, names in enumerate(noted.table.internal):
        kept = [k for k in range(INTERNAL + len(names)) if k != noted.table.record[m]]
        np.testing.assert_array_equal(noted.state.q[kept, m], plain.state.q[:len(kept), m])
