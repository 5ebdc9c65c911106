"""Wilkins' flyer: the elastic precursor and the plastic shock behind it, in uniaxial strain."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from tests.verification.running import ADVECTION, FOLDER, Line, advection, between, crossing, finish, speed

# Solution of the piston at 400 m/s for Wilkins' aluminium, printed in tests/exact/test_elastic_plastic.py.
HEL, U_HEL, PRECURSOR = 0.63588e9, 35.178, 6490.43
STRESS, PRESSURE, DENSITY, SHOCK = 6.63588e9, 6.43588e9, 2985.63, 5908.52
YIELD = 0.3e9
RELEASE = 6903.5  # longitudinal sound speed behind the shock
END = 3e-6


@pytest.mark.parametrize("choice", ADVECTION)
def test_two_waves(choice):
    track = []

    def watch(simulation):
        if simulation.time > END / 3:
            line = Line(simulation)
            stress = line.axial_stress
            levels = HEL / 2, (HEL + STRESS) / 2
            track.append((simulation.time, *(crossing(line.x, stress, level) for level in levels)))

    simulation = finish(decks.load(f"{FOLDER}/elastic_precursor.toml", [f"stop.time={END}", advection(choice)]), watch)
    times, precursor, shock = np.array(track).T
    assert speed(times, precursor) == pytest.approx(PRECURSOR, rel=0.01)
    assert speed(times, shock) == pytest.approx(SHOCK, rel=0.005)

    line, time = Line(simulation), simulation.time
    shelf = (SHOCK * time, PRECURSOR * time)
    assert line.axial_stress[between(line.x, *shelf, 0.3)].mean() == pytest.approx(HEL, rel=0.01)
    assert line.velocity[between(line.xv, *shelf, 0.3)].mean() == pytest.approx(U_HEL, rel=0.01)

    # the release from the flyer's rear started only once the precursor was there, 5 mm away
    released = 400 * time + RELEASE * (time - 5e-3 / PRECURSOR) - 5e-3
    plateau = between(line.x, released, SHOCK * time)
    assert line.axial_stress[plateau].mean() == pytest.approx(STRESS, rel=0.005)
    assert line.pressure[plateau].mean() == pytest.approx(PRESSURE, rel=0.005)
    assert line.body("rho", 1)[plateau].mean() == pytest.approx(DENSITY, rel=0.001)
    assert line.body("szz", 1)[plateau].mean() == pytest.approx(-2 * YIELD / 3, rel=0.01)
    assert line.body("srr", 1)[plateau].mean() == pytest.approx(YIELD / 3, rel=0.01)


@pytest.mark.parametrize("choice", ADVECTION)
def test_yield_surface_and_symmetry(choice):
    """No stress beyond yield, no radial motion, and energy is kept.

    Round-off: a cell that the flyer's rear leaves contains a sliver down to the cutoff of 1e-8, whose density is a difference
    of numbers with 16 digits. So its pressure is known to 1e-8 of the bulk modulus, 1e3 Pa.
    """
    simulation = finish(decks.load(f"{FOLDER}/elastic_precursor.toml", ["stop.time=0.7e-6", advection(choice)]))
    s = simulation.state
    von_mises = np.sqrt(3 * (s.srr**2 + s.szz**2 + s.srr * s.szz + s.srz**2))
    assert von_mises.max() <= YIELD * (1 + 1e-9)
    assert np.max(np.abs(s.u)) < 1e-8 * 800
    assert abs(simulation.conservation()["total_energy"]) < 1e-12
