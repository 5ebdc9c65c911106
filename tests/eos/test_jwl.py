"""Explosives: the Chapman-Jouguet state of every set, the mixture of unreacted solid and products, what burns when."""

import numpy as np
import pytest
from scipy.optimize import brentq

from eos import jwl
from hydro2d.base.errors import DeckError
from hydro2d.materials import library, slots

TNT = {"reference_density": 1630.0, "A": 371.2e9, "B": 3.231e9, "R1": 4.15, "R2": 0.95, "omega": 0.30,
       "detonation_energy": 7e9, "detonation_velocity": 6930.0, "cj_pressure": 21e9}
ROW = jwl.row(TNT)
BURNT = np.array([1.0, 0.0, 1e-7])

EXPLOSIVES = [(name, variant) for name in library.names() if library.load(name).eos.name == "jwl"
              for variant in (None, *library.load(name).variants)]


def pressure(volume, energy):
    """JWL in its printed form, with V = rho0/rho and E per initial volume; TNT."""
    first, second = (amplitude * (1.0 - 0.3 / (rate * volume)) * np.exp(-rate * volume)
                     for amplitude, rate in ((371.2e9, 4.15), (3.231e9, 0.95)))
    return first + second + 0.3 * energy / volume


@pytest.mark.parametrize(("name", "variant"), EXPLOSIVES)
def test_every_set_has_the_detonation_velocity_and_pressure_that_it_states(name, variant):
    values = library.load(name, variant).eos.values
    speed, pressure_cj, _ = jwl.cj_state(jwl.row(values))
    assert speed == pytest.approx(values["detonation_velocity"], rel=3.1e-3)  # nitromethane: 6261, not 6280 m/s
    assert pressure_cj == pytest.approx(values["cj_pressure"], rel=1.1e-3)


def test_the_state_is_that_of_the_least_speed_on_the_hugoniot():
    """Independently: of all Rayleigh lines from the initial state that meet the Hugoniot, the tangent has the least slope."""

    def hugoniot(volume):
        return brentq(lambda p: pressure(volume, 7e9 + 0.5 * p * (1.0 - volume)) - p, 1e9, 1e12, xtol=1.0)

    volumes = np.linspace(0.70, 0.76, 601)
    squares = np.array([hugoniot(volume) / (1.0 - volume) for volume in volumes]) / 1630.0
    speed, pressure_cj, volume = jwl.cj_state(ROW)
    assert speed == pytest.approx(np.sqrt(squares.min()), rel=1e-8)
    assert volume == pytest.approx(volumes[squares.argmin()], abs=1e-4)
    assert pressure_cj == pytest.approx(1630.0 * speed**2 * (1.0 - volume), rel=1e-12)
    # and the flow there is sonic: u + c = D
    rho = 1630.0 / volume
    p, dpdrho, dpde, _ = jwl.evaluate(rho, (7e9 + 0.5 * pressure_cj * (1.0 - volume)) / 1630.0, BURNT, ROW)
    assert p == pytest.approx(pressure_cj, rel=1e-12)
    assert pressure_cj / (1630.0 * speed) + np.sqrt(dpdrho + p * dpde / rho**2) == pytest.approx(speed, rel=1e-12)


@pytest.mark.parametrize("change", [
    {"B": 3.8e9}, {"R1": 4.10}, {"detonation_velocity": 7010.0}, {"cj_pressure": 21.3e9}, {"detonation_energy": 6e9}])
def test_constants_that_contradict_each_other(change):
    with pytest.raises(ValueError, match=r"contradict each other: .* are stated, [\d.e+]+ m/s and [\d.e+]+ Pa follow"):
        jwl.row(TNT | change)


def test_a_set_that_is_often_quoted_fails():
    """PBX-9404 with R1 = 4.55: 8915 m/s and 38.1 GPa."""
    values = library.load("PBX9404").eos.values
    with pytest.raises(ValueError, match=r"8800 m/s and cj_pressure = 3.7e\+10 Pa are stated, 89\d\d.* m/s and 3.8"):
        jwl.row(values | {"R1": 4.55})


def test_constants_without_any_detonation():
    with pytest.raises(ValueError, match="no Chapman-Jouguet state"):
        jwl.row(TNT | {"omega": 5.0})


def test_a_deck_hears_it():
    with pytest.raises(DeckError, match="material dud: jwl: the constants contradict each other"):
        slots._row("eos", jwl, library.Model("jwl", {name: library.Number(value, "", "", "deck") for name, value in
                                              (TNT | {"cj_pressure": 25e9}).items()}),
                   library.Material("dud", "", "", *[library.Model("none")] * 3, None, None))


def test_the_unreacted_solid():
    virgin = np.array([field.at_rest(ROW) for field in jwl.INTERNAL])
    rest, e0 = ROW[0], ROW[1]
    assert e0 == 7e9 / 1630.0
    assert jwl.evaluate(rest, e0, virgin, ROW) == (0.0, 2500.0**2, 0.0, 298.0)
    assert jwl.evaluate(1.1 * rest, 0.0, virgin, ROW)[0] == pytest.approx(0.1 * rest * 2500.0**2, rel=1e-12)


def test_tension_ends_within_the_first_hundredth_that_burns():
    def tension(burnt):
        p = jwl.evaluate(1500.0, 1e6, np.array([burnt, 0.0, 1.0]), ROW)[0]
        return p - burnt * jwl.products(1500.0, 1e6, ROW)[0]

    assert tension(0.005) == pytest.approx(0.5 * tension(0.0))
    assert tension(0.01) == pytest.approx(0.0, abs=1.0)


def burn(internal, time, rho=1630.0, row=ROW):
    internal = np.array(internal)
    jwl.update(rho, rho, ROW[1], 0.0, 0.0, 0.0, 0.0, 0.0, time, 1e-9, row, internal)
    return internal


def test_virgin_material_never_burns_and_by_compression_only_on_request():
    virgin = [field.at_rest(ROW) for field in jwl.INTERNAL]
    assert burn(virgin, 1.0)[0] == 0.0
    assert burn(virgin, 1e-6, rho=1630.0 / 0.8)[0] == 0.0
    squeezed = jwl.row(TNT | {"compression_burn": 1.0})
    volume = jwl.cj_state(ROW)[2]
    assert burn(virgin, 1e-6, rho=1630.0 / (0.5 + 0.5 * volume), row=squeezed)[0] == pytest.approx(0.5, rel=1e-12)
    assert burn(virgin, 1e-6, rho=1630.0 / 0.6, row=squeezed)[0] == 1.0
    assert burn(virgin, 1e-6, rho=1500.0, row=squeezed)[0] == 0.0
