"""The Riemann solver against Toro's tables and against the jump conditions."""

import numpy as np
import pytest

from problems.verification.exact.riemann import Gas, sod, solve

# p*, u*, rho*L, rho*R: Toro, table 4.3 (tests 1 to 3), to the digits an independent iteration agrees in.
TORO = {
    "sod": (Gas(1, 0, 1, 1.4), Gas(0.125, 0, 0.1, 1.4), 0.303130, 0.927453, 0.426319, 0.265574),
    "two rarefactions": (Gas(1, -2, 0.4, 1.4), Gas(1, 2, 0.4, 1.4), 0.001894, 0.0, 0.021852, 0.021852),
    "strong shock": (Gas(1, 0, 1000, 1.4), Gas(1, 0, 0.01, 1.4), 460.894, 19.5975, 0.575062, 5.99924),
    "two gammas": (Gas(1, 0, 1, 1.4), Gas(0.125, 0, 0.1, 1.67), 0.314517, 0.901104, 0.437697, 0.237259),
}
WATER_GAS = (Gas(1000.0, 0.0, 1e9, 4.4, 6e8), Gas(50.0, 0.0, 1e5, 1.4))


@pytest.mark.parametrize("name", TORO)
def test_star_states(name):
    left, right, p, u, rho_left, rho_right = TORO[name]
    solution = solve(left, right)
    assert solution.p == pytest.approx(p, rel=4e-4 if p < 0.01 else 2e-6)
    assert solution.u == pytest.approx(u, rel=3e-6, abs=1e-9)
    assert solution.rho_left == pytest.approx(rho_left, rel=1e-5)
    assert solution.rho_right == pytest.approx(rho_right, rel=1e-5)


def test_wave_speeds_of_sod():
    solution = sod()
    assert solution.left_wave == pytest.approx((-1.183216, -0.070273), abs=1e-6)
    assert solution.right_wave == pytest.approx((1.752156, 1.752156), abs=1e-6)


def test_water_drives_gas():
    solution = solve(*WATER_GAS)
    assert solution.p == pytest.approx(1.4190e7, rel=1e-4)
    assert solution.u == pytest.approx(482.61, rel=1e-5)
    assert solution.rho_left == pytest.approx(804.44, rel=1e-5)
    assert solution.rho_right == pytest.approx(288.17, rel=1e-5)
    assert solution.right_wave[0] == pytest.approx(583.93, rel=1e-5)


@pytest.mark.parametrize("pair", [*(value[:2] for value in TORO.values()), WATER_GAS])
def test_conservation_over_the_fan(pair):
    """d/dt of mass and momentum in a box that contains all waves is the flux through its ends."""
    left, right = pair
    solution = solve(left, right)
    edge = 1.1 * max(abs(solution.left_wave[0]), abs(solution.right_wave[0]))
    xi = np.linspace(-edge, edge, 400_001)
    xi = 0.5 * (xi[1:] + xi[:-1])
    rho, u, p = solution.sample(xi)
    width = xi[1] - xi[0]
    mass = edge * (left.rho + right.rho) + left.rho * left.u - right.rho * right.u
    push = left.p + left.rho * left.u**2 - right.p - right.rho * right.u**2
    momentum = edge * (left.rho * left.u + right.rho * right.u) + push
    assert rho.sum() * width == pytest.approx(mass, rel=3e-5)
    assert (rho * u).sum() * width == pytest.approx(momentum, rel=1e-4, abs=1e-9 * edge * left.rho * edge)


def test_mirror():
    left, right = TORO["strong shock"][:2]
    one, other = solve(left, right), solve(right, left)
    assert (other.p, other.u) == pytest.approx((one.p, -one.u), rel=1e-13)


def test_vacuum_is_refused():
    with pytest.raises(ValueError, match="vacuum"):
        solve(Gas(1, -20, 0.4, 1.4), Gas(1, 20, 0.4, 1.4))
