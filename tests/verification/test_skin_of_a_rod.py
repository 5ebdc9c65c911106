"""The load of a rod's skin, where void or nothing touches it, on meshes that cut the flank anywhere in its cells.

From 28 to 29 November 2026 a rule that closes void between the groups of a contact stretched the skin of every rod in its hole,
by a fifth to two fifths of its load, and no test looked at it. What a ring of full cells bears, at the surface and one cell
farther in, must agree: the rod is a bar, and its stress is that of a bar. The meshes were drawn at random.
"""

import functools

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.mesh.fields import SRR, SZZ
from hydro2d.solver.simulation import Simulation

RADIUS, LENGTH = 3.3784, 97.79  # mm
#: cells across the radius: the flank at 0.18 to 0.95 of its cell, and on the coarsest and the finest of the study's meshes
MESHES = (4.73, 5.5, 6.18, 7.35, 8.05)
#: with this one the plate touches the shank from 27 mm behind the tip on, from 40 us on, and leaves hoop tension of 0.3 GPa
TOUCHED = 5.87
UNDEFORMABLE = (
    'body.rod.material="W_undeformable"',
    'materials.W_undeformable={based_on="W_alloy", fracture_pressure="100 GPa", strength={model="elastic-plastic", '
    'shear_modulus="145 GPa", yield_stress="100 GPa"}}',
)


def meshed(cells: float, shift: float = 0.0) -> list[str]:
    """Overrides of the quick deck: a mesh that follows the rod, with square cells around it, shifted by a part of a cell."""
    size = RADIUS / cells
    behind, ahead = round((LENGTH + 6.6) / size), round(6.7 * cells)
    return [
        "mesh.reach=none",
        f'mesh.r=[{{cells={round(2.5 * cells)}, across="rod", cells_across={cells}}}, {{to="80 mm", ratio=1.15}}]',
        f'mesh.z_start="{(shift - behind) * size} mm"',
        f'mesh.z=[{{to="{shift * size} mm", cells={behind}}}, {{cells={ahead}, across="rod", cells_across={cells}}}, '
        '{to="101.352 mm", ratio=1.12}]',
    ]


def shot(cells: float, velocity: int, *overrides: str, shift: float = 0.0) -> Simulation:
    return Simulation(decks.load("problems/cth_nose_shape/hemi_5083_1086_quick.toml", [
        *meshed(cells, shift), f'body.rod.velocity="{velocity} m/s"', 'stop.time="1 ms"', *overrides]))


def skin(simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Outermost ring of full cells against those inside it, row by row from 8 to 30 mm behind the tip: the axial stress, as a
    share of that inside, and the hoop stress, Pa."""
    grid, state = simulation.grid, simulation.state
    f, p, rr, zz = (grid.interior(x) for x in (state.vof[0], state.pm[0], state.q[SRR, 0], state.q[SZZ, 0]))
    z = grid.zc[grid.inside[0]]
    tip = z[np.flatnonzero(f[:, 0] > 0.5).max()]
    axial, hoop = [], []
    for j in np.flatnonzero((z < tip - 8e-3) & (z > tip - 30e-3)):
        n = int((f[j] > 0.999).cumprod().sum())
        inside = slice(1, n - 2) if n > 4 else slice(0, n - 1)
        assert n >= 3
        axial.append((zz - p)[j, n - 1] / (zz - p)[j, inside].mean() - 1.0)
        hoop.append(-(rr + zz + p)[j, n - 1] + (rr + zz + p)[j, inside].mean())
    assert len(axial) > 20
    return np.array(axial), np.array(hoop)


def skins(simulation: Simulation, *times: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """The skin at these times, in us."""
    found = []
    for time in times:
        while simulation.time < 1e-6 * time:
            simulation.step()
        found.append(skin(simulation))
    return found


@functools.cache
def undeformable(cells: float, velocity: int, *overrides: str):
    return skins(shot(cells, velocity, *UNDEFORMABLE, *overrides), 30, 60, 100)


@pytest.mark.thorough
@pytest.mark.parametrize("velocity", [781, 1086])
@pytest.mark.parametrize("cells", MESHES)
def test_the_skin_of_an_undeformable_rod_bears_its_share(cells, velocity):
    """Mean over 22 mm within 1 % of what the inside bears, every row within 9 %, where 6 % are wanted; at 30, 60 and 100 us."""
    for axial, _ in undeformable(cells, velocity):
        assert abs(axial.mean()) < 0.01
        assert np.abs(axial).max() < 0.09


@pytest.mark.thorough
@pytest.mark.xfail(strict=True, reason="-4.1 and -4.4 % in the mean at 60 and 100 us, worst row -14 %; 1 and 9 % are wanted")
def test_the_skin_bears_its_share_where_the_plate_touches_it():
    for axial, _ in undeformable(TOUCHED, 1086):
        assert abs(axial.mean()) < 0.01
        assert np.abs(axial).max() < 0.09


@pytest.mark.thorough
@pytest.mark.parametrize("velocity", [781, 1086])
@pytest.mark.parametrize("cells", MESHES)
def test_no_hoop_tension_stays_in_the_skin_of_an_undeformable_rod(cells, velocity):
    """Within 0.1 GPa on the mean and 0.25 GPa in every row; it was 7 to 14 GPa."""
    for _, hoop in undeformable(cells, velocity):
        assert abs(hoop.mean()) < 0.1e9
        assert np.abs(hoop).max() < 0.25e9


@pytest.mark.thorough
@pytest.mark.parametrize("cells", MESHES)
def test_the_skin_of_the_studys_alloy_bears_its_share(cells):
    """At 30 us and 1086 m/s, before the release from the tail comes back (2 L/c = 49 us)."""
    (axial, hoop), = skins(shot(cells, 1086), 30)
    assert abs(axial.mean()) < 0.03
    assert np.abs(axial).max() < 0.08
    assert np.abs(hoop).max() < 0.25e9


@pytest.mark.thorough
@pytest.mark.parametrize("changed", ["courant=0.3", "courant=0.7", 'advection="momentum"', 'advection="both"'])
def test_the_skin_bears_its_share_with_other_steps_and_advections(changed):
    for axial, hoop in skins(shot(5.3, 1086, *UNDEFORMABLE, f"numerics.{changed}"), 30, 60):
        assert abs(axial.mean()) < 0.03
        assert np.abs(axial).max() < 0.08
        assert np.abs(hoop).max() < 0.25e9


@pytest.mark.thorough
def test_members_of_a_shot_near_its_limit_lie_together():
    """Length after 150 us of the study's alloy at 1200 m/s, the mesh shifted by a quarter of a cell each time: within 1.8 mm.

    Six members have 89.4 mm and 1.1 mm of standard deviation on 5.5 cells; 91.3 and 0.9 on 8.5; 91.2 and 1.3 on 12.5.
    """
    lengths = []
    for shift in (0.0, 0.25, 0.5, 0.75):
        simulation = shot(5.5, 1200, shift=shift)
        while simulation.time < 150e-6:
            simulation.step()
        lengths.append(1e3 * simulation.diagnostics()["rod_length_m"])
    assert np.std(lengths, ddof=1) < 1.8
    assert np.median(lengths) == pytest.approx(89.5, abs=2.5)
