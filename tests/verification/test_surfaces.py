"""Surfaces that cut cells: bars and rings of exact solutions, with the surface at any place between two lines of the mesh.

Numbers in the docstrings are the present errors, for the worst position of the surface.
"""

import functools
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import optimize, special

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.decks import box, contact, entry, material, mesh, stop, table
from tests.kernels.pieces import ghost_vertices, keep_one

DENSITY, BULK, SHEAR = 18160.0, 18160.0 * 4030.0**2, 145e9
YOUNG, POISSON = 9 * BULK * SHEAR / (3 * BULK + SHEAR), (3 * BULK - 2 * SHEAR) / (6 * BULK + 2 * SHEAR)
YIELD = 0.5e9
CRUMB = 1e-3  # share of the fluid allowed in a full cell
SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
SLOW_BARS = {"elastic": (5e-4, 12e-6), "plastic": (6e-3, 30e-6)}  # strain and the time it takes, many periods of breathing





def simulation(shape: dict, wide: float, high: float, around: str = "void", *, strong: float = 100.0,
               geometry: str = "cylindrical", **edges: str) -> Simulation:
    """A body of the metal, elastic by default.

    around : "void"; "tube", a fluid in which it slides without friction; "glue", the fluid, but bonded to it; or "gas"
    """
    text = (
        mesh((f"{wide} mm", "0.5 mm"), (f"{high} mm", "0.5 mm"), geometry=geometry)
        + table("boundaries", **{"r_min": "axis", "r_max": "wall", "z_min": "wall", "z_max": "wall", **edges})
        + material("metal", "W_alloy", fracture_pressure="100 GPa",
                   strength={"model": "elastic-plastic", "shear_modulus": "145 GPa", "yield_stress": f"{strong} GPa"})
        + entry("body", name="bar", material="metal", **shape)
        + stop("1 s")
    )
    if around == "gas":
        air = {"model": "ideal-gas", "reference_density": 1.2, "adiabatic_index": 1.4, "specific_heat": 700.0}
        text += table("materials.fluid", eos=air)
    elif around != "void":
        text += material("fluid", "Al5083",
                         strength={"model": "elastic-plastic", "shear_modulus": "1 MPa", "yield_stress": "1 Pa"})
    if around != "void":
        text += box("tube", "fluid", r=[0.0, f"{wide} mm"], z=[0.0, f"{high} mm"])
    if around == "tube":
        text += contact("bar", friction=0.0)
    return Simulation(decks.loads(text))


# ---------------------------------------------------------------------------------------------------- bars, slowly strained


class Bar:
    """A bar with prescribed axial motion, uniform strain at the end of every step, and free motion across.

    Along z it is a cylinder of 2.5 mm and a share of a cell; inclined it is a band in plane strain, with twice that width.
    """

    def __init__(self, around: str, share: float, angle: float, law: str):
        half = 2.5 + 0.5 * share
        strong = YIELD / 1e9 if law == "plastic" else 100.0
        self.along = np.array([np.sin(angle), np.cos(angle)])
        self.across = np.array([self.along[1], -self.along[0]])
        if angle:  # long enough in the mesh for ends that yield, and far from its corners
            wide, high, centre, reach = 24.0, 16.0, np.array([12.0, 8.0]), 2.5e-3
            corners = [centre + x * half * self.across + 40.0 * y * self.along for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
            points = [[f"{r:.9f} mm", f"{z:.9f} mm"] for r, z in corners]
            edges = {"geometry": "planar", "r_min": "outflow", "r_max": "outflow"}
            shape = {"shape": "polygon", "points": points}
        else:
            wide, high, centre, reach = 4.0 if around == "void" else 6.0, 16.0, np.array([0.0, 8.0]), 1.5e-3
            edges, shape = {}, {"shape": "box", "r": [0.0, f"{half} mm"], "z": [0.0, f"{high} mm"]}
        self.simulation = simulation(shape, wide, high, around, z_min="outflow", z_max="outflow", strong=strong, **edges)
        grid, self.planar, self.law = self.simulation.grid, bool(angle), law
        self.place = self._along(grid.r, grid.z, 1e-3 * centre)
        self.rows = np.abs(grid.interior(self._along(grid.rc, grid.zc, 1e-3 * centre))) < reach
        self.strain, self.plan = 0.0, None
        self.simulation.engine.watches.clear()  # no audit explains what is given
        self.forces, self.simulation.engine.accelerate = self.simulation.engine.accelerate, self._accelerate

    def _along(self, r, z, centre):
        return self.along[0] * (r[None, :] - centre[0]) + self.along[1] * (z[:, None] - centre[1])

    def _accelerate(self) -> None:
        """Velocities from the forces, then the given axial ones: work and strain of the step are those of the plan."""
        engine, state = self.simulation.engine, self.simulation.state
        self.forces()
        strain = self.plan(engine.time + engine.dt)
        rate, self.strain, group = (strain - self.strain) / engine.dt, strain, state.groups - 1
        lack = -rate * self.place - (state.u[group] * self.along[0] + state.v[group] * self.along[1])
        lack[state.mass[group] == 0.0] = 0.0
        state.u[group] += lack * self.along[0]
        state.v[group] += lack * self.along[1]
        if state.groups > 1:
            keep_one(engine)  # of the other group where the bar is alone
        ghost_vertices(engine)

    def compress(self, strain: float, time: float) -> None:
        """Continues by a strain: softly to rest if elastic, at an even rate at the end if plastic."""
        start, first, engine = self.simulation.time, self.strain, self.simulation.engine

        def plan(now: float) -> float:
            x = min((now - start) / time, 1.0)
            if self.law == "plastic":
                return first + strain * (2.5 * x * x if x < 0.2 else x - 0.1) / 0.9
            return first + strain * (x - np.sin(2 * np.pi * x) / (2 * np.pi))

        self.plan = plan
        while self.simulation.time < start + time:
            engine.advance()

    def measured(self) -> SimpleNamespace:
        """Means over the middle of the bar: stresses along and across, by kind of cell; force from the forces of the cells."""
        grid, state = self.simulation.grid, self.simulation.state
        srr, szz, srz, p, f, rho, e = (grid.interior(x[0]) for x in (state.srr, state.szz, state.srz, state.pm, state.vof,
                                                                      state.rho, state.e))
        cell = [grid.interior(x) for x in (state.sig_rr, state.sig_zz, state.sig_rz)]
        volume = grid.interior(grid.volume)

        def component(n, rr, zz, rz):
            return n[0] ** 2 * rr + n[1] ** 2 * zz + 2 * n[0] * n[1] * rz

        along, across = (component(n, srr, szz, srz) - p for n in (self.along, self.across))
        here = self.rows & (f > 0.0)
        full = self.rows & (f > 1.0 - CRUMB)
        cut = here & ~full
        outer = full & beside(cut)
        inner = full & ~outer
        assert cut.sum() > 5
        assert outer.sum() > 5
        assert inner.sum() > 20

        def mean(x, where):
            return float((x * f * volume)[where].sum() / (f * volume)[where].sum())

        exerted = (component(self.along, *cell) * volume)[here].sum() / (f * volume)[here].sum()
        means = {name: mean(along, where) for name, where in (("inner", inner), ("outer", outer), ("cut", cut))}
        return SimpleNamespace(force=mean(along, here), exerted=float(exerted), across=mean(across, here), **means,
                               energy=mean(rho * e, here) / mean(rho, here), strain=self.strain)


def beside(cells: np.ndarray) -> np.ndarray:
    """The neighbours of cells."""
    neighbours = np.zeros_like(cells)
    neighbours[1:] |= cells[:-1]
    neighbours[:-1] |= cells[1:]
    neighbours[:, 1:] |= cells[:, :-1]
    neighbours[:, :-1] |= cells[:, 1:]
    return neighbours


@functools.cache
def loaded(around: str, share: float, angle: int, law: str, cycles: int = 0):
    """Measurements of a bar under load, and again at rest after each cycle of unloading."""
    bar = Bar(around, share, np.radians(angle), law)
    strain, time = SLOW_BARS[law]
    bar.compress(strain, time)
    under_load, at_rest = bar.measured(), []
    for cycle in range(cycles):
        if cycle:
            bar.compress(strain, time)
        bar.compress(-strain, time)
        at_rest.append(bar.measured())
    return under_load, at_rest


def expected(measured: SimpleNamespace, angle: int, law: str) -> float:
    """Axial stress by the law under the measured lateral stress, which the fluid of a tube exerts."""
    if law == "plastic":
        return measured.across - YIELD * (2 / np.sqrt(3) if angle else 1.0)
    if angle:
        return POISSON / (1 - POISSON) * measured.across - YOUNG / (1 - POISSON**2) * measured.strain
    return 2 * POISSON * measured.across - YOUNG * measured.strain


def held(around: str, share: float, angle: int, law: str, cycles: int, force: float, stress: float) -> None:
    """Force of the section, and stress of the cut and of the outermost full cells, within shares of their exact values."""
    measured, _ = loaded(around, share, angle, law, cycles)
    assert measured.force == pytest.approx(expected(measured, angle, law), rel=force)
    assert measured.exerted == pytest.approx(expected(measured, angle, law), rel=force)
    assert measured.outer == pytest.approx(measured.inner, rel=stress)
    assert measured.cut == pytest.approx(measured.inner, rel=stress)


@pytest.mark.thorough
@pytest.mark.parametrize("share", SHARES)
def test_elastic_bar(share):
    """Along z in void: force E A eps within 0.03 %, stress of the cut row and of the outermost full one within 0.25 %."""
    held("void", share, 0, "elastic", 10, 0.001, 0.005)


@pytest.mark.thorough
@pytest.mark.parametrize("share", SHARES)
def test_elastic_bar_in_a_tube(share):
    """Along z in a tube without friction: 0.04 % and 0.02 %, but 0.55 % in the cut row with a share of 0.05."""
    held("tube", share, 0, "elastic", 10, 0.001, 0.008 if share == 0.05 else 0.001)


@pytest.mark.parametrize("share", SHARES)
def test_plastic_bar(share):
    """Along z in void: force Y A within 0.25 %, stress within 1.1 %, due to the remaining oscillation of the bar."""
    held("void", share, 0, "plastic", 0, 0.005, 0.015)


@pytest.mark.parametrize("share", SHARES)
def test_plastic_bar_in_a_tube(share):
    """Along z in a tube without friction: 0.11 % and 0.42 %, but 1.84 % in the cut row with a share of 0.05."""
    held("tube", share, 0, "plastic", 0, 0.002, 0.02 if share == 0.05 else 0.008)


@pytest.mark.parametrize("share", SHARES)
def test_elastic_bar_in_gas(share):
    """Along z in air: force within 0.13 %, stress within 0.5 %; with one pressure in a cell 1 to 13 % and 57 %."""
    held("gas", share, 0, "elastic", 0, 0.002, 0.006)


@pytest.mark.parametrize("share", SHARES)
def test_elastic_bar_that_is_glued_in(share):
    """Along z, bonded to a fluid: stress of the cut row within 1 %; with one pressure in a cell 5 to 36 %."""
    measured, _ = loaded("glue", share, 0, "elastic")
    assert measured.outer == pytest.approx(measured.inner, rel=0.001)
    assert measured.cut == pytest.approx(measured.inner, rel=0.012)


@pytest.mark.parametrize("share", SHARES)
def test_plastic_bar_in_gas(share):
    """Along z in air: force within 0.6 %, stress within 2.1 %; with one pressure in a cell 2 to 16 % and up to 98 %."""
    held("gas", share, 0, "plastic", 0, 0.008, 0.025)


INCLINED = [(angle, law) for angle in (15, 30, 45) for law in ("elastic", "plastic")]


@pytest.mark.parametrize(("angle", "law"), [
    pytest.param(*case, marks=pytest.mark.xfail(strict=True, reason=f"{missed} %; 0.8 is wanted") if missed else ())
    for case, missed in zip(INCLINED, ("", "", "", "0.95", "", "1.80"), strict=True)])
def test_inclined_bar(angle, law):
    """In void, by E/(1 - nu^2) and 2 Y/sqrt(3) of plane strain: force within 0.1 %, elastic stress within 0.13 %.

    The plastic stress of the cut cells was within 0.43 % before the layer moved with the bar.
    """
    held("void", 0.25, angle, law, 3 if law == "elastic" else 0, 0.002, 0.008)


@pytest.mark.parametrize("angle", [15, 30, 45])
def test_inclined_bar_in_gas(angle):
    """In air: force within 0.1 %, stress within 0.5 %."""
    held("gas", 0.25, angle, "elastic", 0, 0.002, 0.008)


@pytest.mark.thorough
@pytest.mark.parametrize(("angle", "law"), INCLINED)
def test_inclined_bar_in_a_tube(angle, law):
    """In a tube without friction: force within 0.06 %, stress within 0.13 %, and 0.5 % of a plastic bar at 45 degrees."""
    held("tube", 0.25, angle, law, 3 if law == "elastic" else 0, 0.001, 0.004 if (angle, law) != (45, "plastic") else 0.006)


def left_over(around: str, share: float, angle: int, cycles: int) -> float:
    """Largest energy per mass of the bar at rest after a cycle, as a share of that under load."""
    under_load, at_rest = loaded(around, share, angle, "elastic", cycles)
    return max(abs(rest.energy) for rest in at_rest) / under_load.energy


@pytest.mark.thorough
@pytest.mark.parametrize("share", SHARES)
def test_energy_of_ten_cycles(share):
    """Loaded and unloaded ten times in void: 2.4e-5 to 4.8e-5 of the elastic energy remain."""
    assert left_over("void", share, 0, 10) < 1e-3


@pytest.mark.thorough
@pytest.mark.xfail(strict=True, reason="5.7e-3 to 7.5e-3 of the elastic energy are left, 6e-4 to 8e-4 more after every cycle, "
                                       "nearly all in the outermost full row")
@pytest.mark.parametrize("share", SHARES)
def test_energy_of_ten_cycles_in_a_tube(share):
    """As in void, but in a tube without friction."""
    assert left_over("tube", share, 0, 10) < 1e-3


@pytest.mark.parametrize("angle", [*(pytest.param(angle, marks=pytest.mark.xfail(strict=True, reason=f"{left} are left"))
                                     for angle, left in ((15, "1.7e-3"), (30, "2.1e-3"))), 45])
def test_energy_of_three_cycles_inclined(angle):
    """Inclined in void, at 45 degrees 1.5e-4; where the outer vertices were not held, 1.9e-4, 2.6e-4 and 2.6e-3.

    The normal of a surface at 15 or 30 degrees is not exact, so that the prescribed axial motion does work against its hold.
    """
    assert left_over("void", 0.25, angle, 3) < 1e-3


@pytest.mark.thorough
@pytest.mark.xfail(strict=True, reason="9.8e-3, 1.3e-2 and 9.5e-3 are left, a third of it after every cycle")
@pytest.mark.parametrize("angle", [15, 30, 45])
def test_energy_of_three_cycles_inclined_in_a_tube(angle):
    """Inclined in a tube without friction."""
    assert left_over("tube", 0.25, angle, 3) < 1e-3


# ---------------------------------------------------------------------------------------------------- a bar that is braked


@functools.cache
def braked(share: float, transits: int = 20, length: float = 20.0, strain: float = 1e-3):
    """(mean of the differences from the four neighbours, mean size) of the pressure of full cells, means over time, Pa.

    The bar stands on a wall, seen from the wall: a body force per mass that rises softly over a transit of the bar wave, and
    would finally strain it by `strain` at the wall; its waves then run to and fro.
    """
    bar = simulation({"shape": "box", "r": [0.0, f"{2.5 + 0.5 * share} mm"], "z": [0.0, f"{length} mm"]}, 4.0, length + 2.0)
    engine, state, grid = bar.engine, bar.state, bar.grid
    transit = 1e-3 * length / np.sqrt(YOUNG / DENSITY)
    force, forces, sums = strain * YOUNG / DENSITY / (1e-3 * length), engine.accelerate, []

    def accelerate() -> None:
        forces()
        x = min((engine.time + 0.5 * engine.dt) / transit, 1.0)
        pushed = state.mass[0, grid.g + 1:] > 0.0
        state.v[0, grid.g + 1:] -= force * engine.dt * (x - np.sin(2 * np.pi * x) / (2 * np.pi)) * pushed

    engine.accelerate = accelerate
    engine.watches.clear()  # no audit explains the force
    while bar.time < transits * transit:
        engine.advance()
        p, full = (np.pad(x, 1, mode="edge") for x in (grid.interior(state.pm[0]), grid.interior(state.vof[0]) == 1.0))
        around = [(slice(2, None), slice(1, -1)), (slice(-2), slice(1, -1)), (slice(1, -1), slice(2, None)),
                  (slice(1, -1), slice(-2))]
        here = full[1:-1, 1:-1] & np.all([full[x] for x in around], axis=0)
        apart = p[1:-1, 1:-1] - np.mean([p[x] for x in around], axis=0)
        sums.append((np.abs(apart[here]).mean(), np.abs(p[1:-1, 1:-1][here]).mean()))
    return np.mean(sums[len(sums) // transits:], axis=0)


@pytest.mark.thorough
@pytest.mark.parametrize("share", SHARES)
def test_no_checkerboard_in_a_braked_bar(share):
    """Over 20 transits, its flank anywhere in a cell: 0.09 % of the pressure; 0.4 to 1.7 % without hold of outer vertices."""
    apart, size = braked(share)
    assert apart < 0.003 * size


# ---------------------------------------------------------------------------------------------------- a ring that breathes


def breathing(inner: float, outer: float) -> float:
    """Frequency of the breathing of a long elastic tube without axial strain, 1/s: both surfaces free of traction."""
    stiff = BULK + 4 * SHEAR / 3
    speed = np.sqrt(stiff / DENSITY)

    def traction(zero, one, k, r):
        return stiff * k * zero(k * r) - 2 * SHEAR * one(k * r) / r

    def mismatch(omega):
        k = omega / speed
        (a, b), (c, d) = ([traction(zero, one, k, r) for zero, one in ((special.j0, special.j1), (special.y0, special.y1))]
                          for r in (inner, outer))
        return a * d - b * c

    thin = np.sqrt(YOUNG / (1 - POISSON**2) / DENSITY) / (0.5 * (inner + outer))
    return float(optimize.brentq(mismatch, 0.9 * thin, 1.1 * thin))


@pytest.mark.parametrize("share", SHARES)
def test_period_of_a_ring(share):
    """Two cells thick, both surfaces in void: five periods are 0.08 to 0.31 % short on average, single ones up to 0.6 %."""
    inner = 10.0 + 0.5 * share
    ring = simulation({"shape": "box", "r": [f"{inner} mm", f"{inner + 1.0} mm"], "z": [0.0, "2 mm"]}, 14.0, 2.0)
    period, state, inside = 2 * np.pi / breathing(1e-3 * inner, 1e-3 * (inner + 1.0)), ring.state, ring.grid.g + 1
    state.u[0, :, inside:], ring.engine.audit = 2.0, None
    ring.engine.prepare()
    times, speeds = [], []
    while ring.time < 5.3 * period:
        ring.step()
        mass = state.mass[0, :, inside:]
        times.append(ring.time)
        speeds.append((mass * state.u[0, :, inside:]).sum() / mass.sum())
    t, u = np.array(times), np.array(speeds)
    k = np.nonzero(u[:-1] * u[1:] < 0.0)[0]
    crossings = t[k] - u[k] * (t[k + 1] - t[k]) / (u[k + 1] - u[k])
    assert len(crossings) >= 10
    assert 2 * np.diff(crossings).mean() == pytest.approx(period, rel=0.005)
    assert 2 * np.diff(crossings) == pytest.approx(period, rel=0.008)
    assert np.abs(u[t > 4.3 * period]).max() > 0.97 * 2.0
