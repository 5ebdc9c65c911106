"""The version of the method belongs to the numbers: where these move, it must be raised, and kept rows become stale."""

import pytest

from hydro2d.base.method_version import METHOD
from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation

QUICK = "problems/cth_nose_shape/hemi_5083_1086_quick.toml"
#: the mesh that the deck had when these numbers were made: a change of decks is none of the method
MESH = ["mesh.reach=none", "mesh.z_start=-104.423273 mm",
        'mesh.z=[{to=0.0, cells=170}, {cells=37, across="rod", cells_across=5.5}, {to="101.352 mm", ratio=1.12}]']
LAYER = ["sliding.method=slip-layer", "sliding.boundary_layer=2", "sliding.slip_layer=2", "sliding.yield_factor=radius"]
CYCLES = 60
#: round-off on other processors and libraries, after so few cycles
SAME = 1e-9
#: time in s, internal energy in J and length of the rod in m after these cycles, with this version
OF = "2026-11-29.4"
NUMBERS = {
    "contact": ([], 9.738946566485498e-07, 35.08843092467121, 0.09768019375663717),
    "welded, both": (["sliding.method=none", "numerics.advection=both"],
                     9.592567614552601e-07, 66.5401876761526, 0.09761846318997441),
    "slip layer, momentum": ([*LAYER, "numerics.advection=momentum"],
                             9.65611174832738e-07, 48.43101082146654, 0.09763461097362161),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_numbers_of_this_version(name):
    overrides, time, energy, length = NUMBERS[name]
    simulation = Simulation(decks.load(QUICK, [*MESH, *overrides]))
    for _ in range(CYCLES):
        simulation.step()
    numbers = simulation.time, simulation.conservation()["internal_energy_J"], simulation.diagnostics()["rod_length_m"]
    why = "the numbers of a run have moved: give hydro2d/base/method_version.py the day of the change, this test the numbers"
    assert numbers == pytest.approx((time, energy, length), rel=SAME), why
    assert METHOD == OF, "the numbers of a run are as before: leave METHOD, or give this test its new numbers"
