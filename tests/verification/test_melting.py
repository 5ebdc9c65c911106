"""A shock that melts, and one that does not: from the melting line on the deviator vanishes, with every strength model."""

import functools
import math

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.materials import pressure_temperature
from hydro2d.mesh.fields import INTERNAL
from hydro2d.solver.simulation import Simulation
from tests.contract.test_models import STRENGTH_CASES
from tests.verification.running import Line, between, run

#: Hugoniot pressure without strength, and impact velocity over two, m/s
MOLTEN, SOLID = (131.21e9, 4300.0), (76.75e9, 3000.0)
SLOW = 'body.flyer.velocity="6 km/s"'
#: strength models of their own without a melting temperature, or with one that does not end them here
LAWS = {
    "power-law": {},
    "elastic-plastic": {"shear_modulus": 26e9, "yield_stress": 0.3e9},
    **{name: {key: value for key, value in STRENGTH_CASES[name].items() if key != "melt_temperature"}
       for name in ("johnson-cook", "zerilli-armstrong", "voce", "steinberg-lund")},
    "preston-tonks-wallace": STRENGTH_CASES["preston-tonks-wallace"] | {"melt_temperature": 3000.0},
    "kinematic-hardening": STRENGTH_CASES["kinematic-hardening"],
    "steinberg-guinan": {"shear_modulus": 27.6e9, "yield_stress": 0.29e9},
    "johnson-holmquist": {**STRENGTH_CASES["johnson-holmquist"], "P_HEL": 1.08392e9},  # the value of this equation of state
}


def with_law(name: str) -> str:
    """The override that gives the aluminium a strength model."""
    values = ", ".join(f"{key} = {value!r}" for key, value in LAWS[name].items())
    return f'materials.aluminium={{based_on="Al6061_T651", strength={{model="{name}", {values}}}}}'


@functools.cache
def shocked(*overrides: str) -> tuple[Line, np.ndarray]:
    """A run, and the cells of the target that the shock has long passed."""
    pressure, u = SOLID if SLOW in overrides else MOLTEN
    line = Line(run("plate_impact_melting", *overrides))
    time = line.simulation.time
    return line, between(line.x, u * time, pressure / (2703.0 * u) * time, 0.25)


def von_mises(line: Line) -> np.ndarray:
    rr, zz, rz = (line.body(key, 1) for key in ("srr", "szz", "srz"))
    return np.sqrt(3.0 * (rr**2 + zz**2 + rr * zz + rz**2))


@pytest.mark.parametrize("law", [None, *(name for name in LAWS if name != "power-law")])
def test_a_melt_has_no_deviator(law):
    line, plateau = shocked(*([with_law(law)] if law else []))
    assert (von_mises(line)[plateau] == 0.0).all()
    assert line.pressure[plateau].mean() == pytest.approx(MOLTEN[0], rel=0.01)
    if law == "kinematic-hardening":
        back = line.simulation.grid.interior(line.simulation.state.q[INTERNAL:INTERNAL + 3, 1])[:, plateau]
        assert (back == 0.0).all()
    assert abs(line.simulation.conservation()["total_energy"]) < 1e-12


@pytest.mark.parametrize("law", [None, "elastic-plastic", "kinematic-hardening", "steinberg-guinan", "voce", "steinberg-lund",
                                 "preston-tonks-wallace"])
def test_below_the_line_the_deviator_stays(law):
    """A shock of 77 GPa; the cell in which the plates first meet is hotter, and its melt sends out a wave."""
    more = (SLOW, *([with_law(law)] if law else []))
    (line, plateau), (plain, _) = shocked(*more), shocked(*more, 'failure.melting="none"')
    with_line, without = von_mises(line)[plateau], von_mises(plain)[plateau]
    assert (with_line > 0.1e9).all()
    assert with_line.mean() == pytest.approx(without.mean(), rel=0.03)


@pytest.mark.parametrize("law", [None, "kinematic-hardening", "steinberg-guinan"])
def test_far_below_the_line_nothing_changes(law):
    """Plates that meet at 2 km/s have the same state with and without the line, to the last bit."""
    slow = 'body.flyer.velocity="2 km/s"', *([with_law(law)] if law else [])
    states = [run("plate_impact_melting", *slow, *more).state for more in ((), ('failure.melting="none"',))]
    np.testing.assert_array_equal(states[0].q, states[1].q)
    np.testing.assert_array_equal(states[0].v, states[1].v)


def test_without_the_line_the_same_shock_leaves_a_deviator():
    line, plateau = shocked('failure.melting="none"')
    assert von_mises(line)[plateau].min() > 0.3e9


def test_steinberg_and_guinans_own_melt_loses_its_deviator_too():
    """It has no modulus to return with: the deviator at the moment of melting would otherwise stay for ever."""
    line, plateau = shocked('materials.aluminium={based_on="Al6061_T6"}', 'failure.melting="none"')
    assert (von_mises(line)[plateau] == 0.0).all()


CORNER = """
numbers = "SI"
[mesh]
geometry = "planar"
r = [{ to = 1.0, cells = 6 }]
z = [{ to = 1.0, cells = 6 }]
[boundaries]
r_min = "wall"
r_max = "wall"
z_min = "wall"
z_max = "wall"
[[body]]
name = "metal"
material = "metal"
shape = "box"
r = [0.0, 0.75]
z = [0.0, 1.0]
[materials.metal]
based_on = "Al6061_T651"
[materials.metal.strength]
model = "kinematic-hardening"
shear_modulus = "26 GPa"
yield_stress = "0.3 GPa"
hardening_modulus = "5 GPa"
[failure]
tensile = "none"
strength_cutoff = 0.0
melting = "material"
[stop]
time = "1 us"
"""


def heated(energy: float, *overrides: str) -> Simulation:
    """A block of metal with a void next to it, at rest, with a deviator and a back stress, and heated, after one step."""
    simulation = Simulation(decks.loads(CORNER, list(overrides)))
    state = simulation.state
    there = state.vof[0] > 0.0
    for key, stress in (("srr", 1e8), ("szz", -2e8), ("srz", 5e7)):
        getattr(state, key)[0][there] = stress
    state.q[INTERNAL:INTERNAL + 3, 0][..., there] = 3e7
    state.e[0][there] = energy
    simulation.step()
    return simulation


@pytest.mark.parametrize("mixed", ["material", "volume", "max"])
def test_a_melt_forgets_its_stress_in_full_and_in_cut_cells(mixed):
    """At 1.5 MJ/kg aluminium is at 2000 K; at 0.3 MJ/kg it is solid."""
    choice = f'numerics.mixed_strength="{mixed}"'
    hot, warm = heated(1.5e6, choice), heated(0.3e6, choice)
    vof = hot.grid.interior(hot.state.vof[0])
    full, cut = vof == 1.0, (vof > 0.1) & (vof < 1.0)
    assert full.any()
    assert cut.any()
    assert [np.median(pressure_temperature.of(each)[1][0][full]) > 1400.0 for each in (hot, warm)] == [True, False]
    for key in ("srr", "szz", "srz"):
        melt, solid = (each.grid.interior(getattr(each.state, key)[0]) for each in (hot, warm))
        assert (melt[full | cut] == 0.0).all()
        assert (np.abs(solid[full]) > 1e7).all()
    back, kept = (each.grid.interior(each.state.q[INTERNAL:INTERNAL + 3, 0]) for each in (hot, warm))
    assert (back[:, full | cut] == 0.0).all()
    assert (np.abs(kept[:, full]) > 1e7).all()
    assert not math.isnan(hot.dt)
