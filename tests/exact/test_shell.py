"""Shells that stop by plastic work against printed speeds, and against the balance of energy shell by shell."""

import numpy as np
import pytest

from problems.verification.exact.shell import Shell

#: dimension, radius of the stop in m, speed of the inner face in m/s; beryllium of 1845 kg/m^3 and 0.33 GPa, 80 to 100 mm
PRINTED = [(3, 0.04, 619.787), (3, 0.05, 545.145), (2, 0.04, 490.299), (2, 0.05, 417.079)]


@pytest.mark.parametrize(("j", "stop", "speed"), PRINTED)
def test_printed_speeds(j, stop, speed):
    shell = Shell(j, 0.08, 0.1, 1845.0, 0.33e9)
    assert shell.speed(stop) == pytest.approx(speed, abs=6e-4)
    assert shell.stop(speed) == pytest.approx(stop, abs=1e-7)


@pytest.mark.parametrize("j", [2, 3])
def test_energy_by_layers(j):
    """Kinetic energy of thin layers, and the yield stress times the equivalent strain of each at the stop."""
    shell = Shell(j, 0.08, 0.1, 1845.0, 0.33e9)
    edges = np.linspace(0.08, 0.1, 4001)
    r = 0.5 * (edges[1:] + edges[:-1])
    volume = np.diff(edges**j) / j
    speed = shell.speed(0.045) * (0.08 / r) ** (j - 1)
    end = (r**j - 0.08**j + 0.045**j) ** (1.0 / j)
    strain = {2: 2.0 / np.sqrt(3.0), 3: 2.0}[j] * np.log(r / end)
    assert np.sum(volume * 0.5 * 1845.0 * speed**2) == pytest.approx(np.sum(volume * 0.33e9 * strain), rel=1e-6)


def test_a_shell_that_closes():
    with pytest.raises(ValueError, match="closes"):
        Shell(3, 0.08, 0.1, 1845.0, 0.33e9).stop(2000.0)


@pytest.mark.parametrize(("j", "speed"), [(3, 619.787), (2, 490.299)])
def test_the_path(j, speed):
    """It begins with the speed and ends at the stop; in the middle the remaining energy is kinetic."""
    shell = Shell(j, 0.08, 0.1, 1845.0, 0.33e9)
    time, radius = shell.path(speed)
    assert (radius[0] - radius[5]) / (time[5] - time[0]) == pytest.approx(speed, rel=5e-3)
    assert radius[-1] == pytest.approx(0.04, abs=1e-7)
    k = len(time) // 2
    now = (radius[k - 1] - radius[k + 1]) / (time[k + 1] - time[k - 1])
    inner, outer = radius[k], (radius[k] ** j + 0.1**j - 0.08**j) ** (1.0 / j)
    rest = Shell(j, inner, outer, 1845.0, 0.33e9)
    assert rest.stop(now) == pytest.approx(0.04, abs=1e-6)
