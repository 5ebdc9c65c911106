"""Spall of a plate by a triangular pulse: depth of the spall plane and pull-back of the free surface."""

import functools

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from problems.verification.exact.impact import AL_5083, AL_7039, TUNGSTEN, Solid, pull_back
from tests.verification.running import ADVECTION, Line, advection, finish

CELL, LENGTH, FRONT, REAR = 0.025e-3, 16e-3, 17e-3, 18e-3

# material of the library, its solid, fracture pressure, peak velocity in the pulse, time to look at, printed pull-back
CASES = {
    "Al5083": (AL_5083, 0.45e9, 150.0, 0.9e-6, 63.4),
    "Al7039": (AL_7039, 0.50e9, 150.0, 1.0e-6, 69.4),
    "W_alloy": (TUNGSTEN, 3.5e9, 200.0, 1.3e-6, 95.6),
}


def pulse(material: str, solid: Solid, peak: float) -> str:
    """A plate with a wave in it that runs to its rear: velocity rises linearly to its front, as a simple wave does.

    Every slab is as thick as a cell; density and energy are those of acoustics, rho0 (1 + v/c0) and v^2/2.
    """
    box = '[[body]]\nname = "{}"\n{}material = "metal"\nshape = "box"\nz = [{:.9g}, {:.9g}]\n'
    join = 'join = "plate"\n'
    text = f"""
        numbers = "SI"
        [mesh]
        r = [{{ cells = 2, size = {CELL} }}]
        z_start = -1e-3
        z = [{{ to = 20e-3, size = {CELL} }}]
        [boundaries]
        r_max = "wall"
        [materials.metal]
        based_on = "{material}"
        strength.model = "hydrodynamic"
        [stop]
        time = 1.6e-6
        """
    text += box.format("plate", "", 0.0, FRONT - LENGTH) + box.format("ahead", join, FRONT, REAR)
    n = round(LENGTH / CELL)
    for k in range(n):
        v, z = peak * (k + 0.5) / n, FRONT - LENGTH
        text += box.format(f"slab{k}", join, z + k * CELL, z + (k + 1) * CELL)
        text += f"velocity = {v}\nenergy = {v * v / 2}\ndensity = {solid.rho0 * (1 + v / solid.c0)}\n"
    return text


def shoot(material: str, choice: str, peak: float, end: float):
    """Time, free-surface velocity and position [n, 3], and depth of the first void below the free surface, or None."""
    history, depth = [], []

    def watch(simulation):
        line = Line(simulation)
        filled = line.filled
        full = np.nonzero(filled > 1 - 1e-9)[0][-1]
        surface = line.xv[full + 1] + CELL * filled[full + 1 :].sum()
        history.append((simulation.time, line.velocity[full], surface))
        torn = (filled < 1 - 1e-6) & (line.x > 2e-3) & (line.x < line.x[full] - 2 * CELL)
        if torn.any() and not depth:
            depth.append(surface - line.x[np.argmin(np.where(torn, filled, 1.0))])

    text = pulse(material, CASES[material][0], peak)
    simulation = finish(decks.loads(text, [f"stop.time={end}", advection(choice)]), watch)
    return simulation, np.array(history), depth[0] if depth else None


@functools.cache
def pulled(material, choice):
    """(top and lowest velocity of the surface, the velocities after it, depth of the crack).

    The peak is the line through the falling velocity, back to where the smeared shock arrived.
    """
    _, _, peak, end, _ = CASES[material]
    _, history, depth = shoot(material, choice, peak, end + 0.2e-6)
    time, velocity = history[:, 0], history[:, 1]
    arrival = time[np.argmax(velocity > peak)]
    early = (time > arrival + 0.1e-6) & (time < arrival + 0.4e-6)
    _, top = np.polyfit(time[early] - arrival, velocity[early], 1)
    lowest = velocity[(time > arrival + 0.1e-6) & (time < end)].min()
    return top, lowest, velocity[time > time[velocity == lowest][0]], depth


@pytest.mark.thorough
@pytest.mark.parametrize("material", CASES)
@pytest.mark.parametrize("choice", ["ke", "both"])
def test_pull_back(material, choice):
    """The surface slows by 2 p_cut/(rho0 c0) (acoustics, 10 %)."""
    top, lowest, _, _ = pulled(material, choice)
    assert top - lowest == pytest.approx(CASES[material][4], rel=0.1)


@pytest.mark.thorough
@pytest.mark.parametrize("choice", ["ke", "both"])
@pytest.mark.parametrize("material", CASES)
def test_the_wave_of_the_spall_catches_the_surface(material, choice):
    solid, p_cut, peak, _, expected = CASES[material]
    assert pull_back(solid, p_cut) == pytest.approx(expected, abs=0.05)
    top, lowest, late, depth = pulled(material, choice)
    assert top == pytest.approx(2 * peak, rel=0.02)
    assert late.max() - lowest > 0.4 * expected
    # tension under a free surface grows with depth by 2 dp/dz: the pulse has p_peak over its length
    p_peak = solid.rho0 * (solid.c0 + solid.s * peak) * peak
    assert depth == pytest.approx(LENGTH * p_cut / (2 * p_peak), abs=3 * CELL)


@pytest.mark.thorough
@pytest.mark.parametrize("choice", ADVECTION)
def test_open_cell_carries_no_tension(choice):
    """No cell is below the threshold, and a crack that has opened by a tenth of a cell is free of pressure."""
    simulation, _, _ = shoot("Al5083", choice, 150.0, 0.7e-6)
    line = Line(simulation)
    crack = (line.filled < 0.9) & (line.x > 2e-3) & (line.x < 18e-3)
    assert crack.any()
    assert np.max(np.abs(line.pressure[crack])) < 0.05 * 0.45e9
    assert line.pressure.min() > -0.45e9 * (1 + 1e-12)


def test_weak_pulse_does_not_fracture():
    """Below half the fracture pressure at its peak, nothing fails."""
    _, history, depth = shoot("Al5083", "ke", 15.0, 1.2e-6)
    assert depth is None
    assert history[:, 1].max() == pytest.approx(30.0, rel=0.05)
