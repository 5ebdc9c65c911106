"""Guderley's imploding shock: near the axis or the point the radius of a strong shock is a power of the time left.

R = R1 ((t_c - t)/t_c)^alpha. The exponent is such that the flow behind the shock passes through its singular point. With

    u = r/t V(xi),  c^2 = (r/t)^2 C(xi)

and j = 2, 3 for cylindrical and spherical symmetry the flow obeys one equation dC/dV from the strong shock,

    V = 2 alpha/(gamma + 1),  C = 2 gamma (gamma - 1) alpha^2/(gamma + 1)^2,

to the singular point, where C = (V - alpha)^2.

Source: Guderley, Luftfahrtforschung 19 (1942) 302; equation (3.1) of Chisnell, J. Fluid Mech. 354 (1998) 357; exponents in
Lazarus, SIAM J. Numer. Anal. 18 (1981) 316.
"""

from __future__ import annotations

import math
from functools import cache

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

#: adiabatic indices from which on the flow passes through the other of the two singular points (Lazarus)
OTHER_ROOT = {2: 1.9092084, 3: 1.8697680}


def _slope(v: float, c: float, a: float, gamma: float, j: int) -> float:
    """dC/dV, equation (3.1) of Chisnell."""
    gap = (v - a) ** 2 - c
    q = j * v * (v - a) + 2.0 / gamma * (1.0 - a) * (a - v) - v * (v - 1.0)
    above = c * (2.0 * gap * (a - v + (1.0 - a) / gamma) + (gamma - 1.0) * (a - v) * q)
    return above / (gap * (j * v - 2.0 * (1.0 - a) / gamma) * (a - v) + (a - v) ** 2 * q)


def _misses(a: float, gamma: float, j: int) -> float:
    """Amount by which the flow from the shock misses the singular point, in C."""
    root = 8.0 * (a - 1.0) * a * gamma * (j - 1.0) + (2.0 - gamma + a * (gamma * j - 2.0)) ** 2
    side = -1.0 if gamma >= OTHER_ROOT[j] else 1.0
    v = (2.0 - 2.0 * a - gamma + a * gamma * j + side * math.sqrt(max(root, 0.0))) / (2.0 * gamma * (j - 1.0))
    start, c = 2.0 * a / (gamma + 1.0), 2.0 * gamma * (gamma - 1.0) * a**2 / (gamma + 1.0) ** 2
    path = solve_ivp(lambda v, c: [_slope(v, c[0], a, gamma, j)], (start, v), [c], method="DOP853", rtol=1e-10, atol=1e-12)
    return (v - a) ** 2 - float(path.y[0, -1])


@cache
def exponent(j: int = 3, gamma: float = 1.4) -> float:
    """alpha of an imploding shock, for 1.2 <= gamma <= 6."""
    pull = math.sqrt(2.0) * gamma * math.sqrt(gamma / (gamma - 1.0))
    estimate = (2.0 + gamma + pull) / (2.0 + pull + gamma * j)  # Chisnell's, from the pressure behind the shock
    least = estimate
    if gamma <= 2.0 + math.sqrt(3.0):  # below, the singular point is not real
        numerator = 4.0 + 2.0 * math.sqrt(2.0) * math.sqrt(gamma**3 * (j - 1.0) ** 2) + gamma * (-6.0 + (2.0 + gamma) * j)
        least = numerator / (4.0 + gamma * (-8.0 + j * (4.0 + gamma * j))) + 1e-6
    return float(brentq(_misses, least, 1.05 * estimate, args=(gamma, j), xtol=1e-11))
