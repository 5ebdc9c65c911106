"""Internal variables of a strength model during a step: hardened, turned, carried, mirrored, cut, written."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.mesh.fields import INTERNAL
from hydro2d.output import derived_quantities
from hydro2d.solver.simulation import Simulation
from tests.decks import box, material, mesh, stop, table, walls
from tests.kernels.test_lagrangian import BLOCK, driven, engine
from tests.restarts import restarted

G, Y0, H = 26e9, 0.3e9, 5e9
RR, ZZ, RZ = range(INTERNAL, INTERNAL + 3)
HARDENS = BLOCK.replace("""model = "elastic-plastic"
shear_modulus = "26 GPa"
yield_stress = "1e6 GPa"
""", """model = "kinematic-hardening"
shear_modulus = "26 GPa"
yield_stress = "0.3 GPa"
hardening_modulus = "5 GPa"
isotropic_share = SHARE
""")
#: a block whose topmost row is cut by void, and one with a second body in place of the void
CUT = HARDENS.replace("z = [0.0, 5.0]", "z = [0.0, 0.33]")
BONDED = CUT + """
[[body]]
name = "upper block"
material = "metal"
shape = "box"
z = [0.33, 5.0]
"""


def block(share=0.0, text=HARDENS, *overrides):
    e = engine(text.replace("SHARE", str(share)), 'mesh.geometry="planar"', *overrides)
    e.first = e.state.q[:2].copy()
    return e, *np.meshgrid(e.grid.r - 0.4, e.grid.z - 0.5)


def uniform(e, k):
    """Row k of q in the block, equal in all cells that contain any of it."""
    inside = e.state.q[k, 0][e.state.vof[0] > 0]
    np.testing.assert_allclose(inside, inside[0], rtol=1e-9, atol=1e-3)
    return inside[0]


def from_the_centre(q):
    """von Mises stress from the centre of the yield surface."""
    rr, zz, rz = (q[k] - q[centre] for k, centre in ((2, RR), (3, ZZ), (4, RZ)))
    return np.sqrt(3 * (rr**2 + rr * zz + zz**2 + rz**2))


class Loop:
    """Pure shear there and back by arithmetic: deviator s_zz, its centre a_zz, and half the width of the elastic range."""

    def __init__(self, share):
        self.s, self.a, self.share, self.ep = 0.0, 0.0, share, 0.0

    def strain(self, step):
        sign, half = np.sign(step), (Y0 + self.share * H * self.ep) / np.sqrt(3)
        elastic = min((half - sign * (self.s - self.a)) / (2 * G), abs(step))
        flow = 2 * G * (abs(step) - elastic) / (2 * G + 2 / 3 * H)
        self.s += 2 * G * (step - sign * flow)
        self.a += 2 / 3 * (1 - self.share) * H * sign * flow
        self.ep += 2 / np.sqrt(3) * flow


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("cells", ["full cells", "mixed cells"])
def test_a_loop_of_pure_shear(share, cells):
    """The yield surface shifts, widens, or both: the less it widens, the earlier the way back yields.

    Mixed cells hold two bodies of one group and no void: they are strained with the cell, as full ones are.
    """
    e, r, z = block(share, HARDENS if cells == "full cells" else BONDED, 'numerics.mixed_strength="material"')
    assert ((0.1 < e.state.vof[0]) & (e.state.vof[0] < 0.9)).any() == (cells == "mixed cells")
    exact = Loop(share)
    for step in (2e-4, -2e-4, 2e-4):
        for _ in range(60 if step > 0 else 120):
            driven(e, -step / 1e-7 * r, step / 1e-7 * z, 1e-7, 1)
            exact.strain(step)
        assert uniform(e, 3) == pytest.approx(exact.s, rel=1e-9)
        assert uniform(e, ZZ) == pytest.approx(exact.a, rel=1e-9)
        assert uniform(e, RR) == pytest.approx(-exact.a, rel=1e-9)
        assert uniform(e, 5) == pytest.approx(exact.ep, rel=1e-9)


@pytest.mark.parametrize(("share", "rest"), [(0.0, 9e6), (0.4, 9e6), (1.0, 1e6)])
def test_a_loop_of_pure_shear_under_a_free_surface(share, rest):
    """Void cuts the topmost row, which the loop strains along the surface only: no normal stress remains across it.

    The row has another path than the full cells below, but flows at its own yield stress. The remaining normal stress is due
    to hardening within the step, and to the back stress, which the predicted strain across the surface leaves out.
    """
    e, r, z = block(share, CUT, 'numerics.mixed_strength="material"')
    s = e.state
    e.first = s.q[:2]  # density and heat evolve: they make the pressure that balances the deviator
    cut, full = (0.0 < s.vof[0]) & (s.vof[0] < 1.0), s.vof[0] == 1.0
    exact = Loop(share)
    for step in (2e-4, -2e-4, 2e-4):
        for _ in range(60 if step > 0 else 120):
            driven(e, -step / 1e-7 * r, step / 1e-7 * z, 1e-7, 1)
            exact.strain(step)
            e.close_cells()
            np.testing.assert_allclose(s.q[3, 0][cut] - s.pm[0][cut], 0.0, atol=rest)
        np.testing.assert_allclose(s.q[3, 0][full], exact.s, rtol=1e-9)
        np.testing.assert_allclose(s.q[ZZ, 0][full], exact.a, rtol=1e-9, atol=1e-3)
        assert np.all(np.sign(step) * s.q[3, 0][cut] > 100e6)
        np.testing.assert_allclose(from_the_centre(s.q[:, 0][:, cut]), Y0 + share * H * s.q[5, 0][cut], rtol=1e-9)


def test_the_back_stress_turns_with_the_block():
    e, r, z = block()
    for k, value in ((2, 100e6), (3, -100e6), (RR, 100e6), (ZZ, -100e6)):
        e.state.q[k, 0][e.grid.inside] = value
    rate = np.radians(30.0) / 30 / 1e-6
    driven(e, -rate * z, rate * r, 1e-6, 30)
    turned = np.array([uniform(e, k) for k in (RR, ZZ, RZ)])
    np.testing.assert_allclose(turned, [50e6, -50e6, 86.60e6], atol=0.1e6)
    np.testing.assert_allclose([uniform(e, k) for k in (2, 3, 4)], turned, rtol=1e-9)
    assert np.all(e.state.ep == 0.0)


def test_the_shared_yield_stress_of_a_cell_is_measured_from_each_centre():
    """Two halves of one cell, one of which was strained before: each returns to its own surface."""
    e, r, z = block(0.0, CUT, 'numerics.mixed_strength="volume"')
    e.state.q[ZZ, 0], e.state.q[RR, 0] = 80e6, -80e6
    for _ in range(100):
        driven(e, -2e-4 / 1e-7 * r, 2e-4 / 1e-7 * z, 1e-7, 1)
    there = e.state.vof[0] > 0
    np.testing.assert_allclose(from_the_centre(e.state.q[:, 0][:, there]), Y0, rtol=1e-6)


MOVES = (
    mesh((0.2, 4), (2.0, 80), geometry="planar")
    + walls("r_max")
    + box("block", "metal", z=[0.2, 0.9], velocity=100.0)
    + material("metal", "Al6061_T6")
    + table("materials.metal.strength", model="kinematic-hardening", shear_modulus="26 GPa", yield_stress="0.3 GPa",
            hardening_modulus="5 GPa")
    + stop(0.008)
)


def test_a_signed_variable_is_carried_and_not_cut_off():
    """A block flies over 0.8 m with a back stress that changes sign: its sum stays, and so do most of its extremes."""
    simulation = Simulation(deck.loads(MOVES))
    s, g = simulation.state, simulation.grid
    wave = 50e6 * np.sin(2 * np.pi * (g.zc - 0.2) / 0.7)[:, None]
    for k, sign in ((RR, 1.0), (ZZ, -1.0), (RZ, 1.0)):
        s.q[k, 0] = np.where(s.vof[0] > 0, sign * wave, 0.0)
    size = np.sum(s.vof[0] * np.abs(s.q[RR, 0]) * g.volume)
    sums = np.array([np.sum(s.vof[0] * s.q[k, 0] * g.volume) for k in (RR, ZZ, RZ)])
    while simulation.time < 8e-3:
        simulation.step()
    after = np.array([np.sum(s.vof[0] * s.q[k, 0] * g.volume) for k in (RR, ZZ, RZ)])
    there = s.vof[0] == 1.0
    np.testing.assert_allclose(after, sums, rtol=0, atol=1e-12 * size)
    for k in (RR, ZZ, RZ):
        assert -50e6 <= s.q[k, 0][there].min() < -40e6
        assert 40e6 < s.q[k, 0][there].max() <= 50e6
    assert np.all(s.ep == 0.0)


IMPACT = MOVES.replace('velocity = 100.0', 'velocity = 300.0') + """
[[body]]
name = "wall"
material = "Al6061_T6"
shape = "box"
z = [0.9, 2.0]
"""


def test_a_restart_goes_on_with_them():
    whole, first = (Simulation(deck.loads(IMPACT)) for _ in range(2))
    for _ in range(60):
        whole.step()
    for _ in range(30):
        first.step()
    second = restarted(first)
    for _ in range(30):
        second.step()
    assert np.abs(whole.state.q[ZZ, 0]).max() > 1e6
    np.testing.assert_array_equal(second.state.q, whole.state.q)


def test_they_are_written_of_the_bodies_that_have_them():
    simulation = Simulation(deck.loads(IMPACT))
    simulation.state.q[ZZ, 0] = 4e6
    fields = derived_quantities.evaluate(simulation)
    names = [f"Back Stress {part} of block [Pa]" for part in ("rr", "zz", "rz")]
    assert [name for name in fields if name.startswith("Back Stress")] == names
    filled = fields["Volume Fraction for block"] > 0
    np.testing.assert_array_equal(fields[names[1]], np.where(filled, 4e6, 0.0))
    assert not set(names) & set(derived_quantities.evaluate(simulation, ["standard"]))
