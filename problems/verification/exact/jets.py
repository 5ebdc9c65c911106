"""Two plane sheets of a liquid that meet: a slug forward and a jet back.

In the frame in which the point where they meet rests, each sheet of thickness h comes along itself at the speed v and at the
angle beta to the plane of symmetry. Both streams leave at v, because the pressure on their surfaces is the same. By the balance
of momentum along the plane, v^2 h cos(beta) = v^2 (forward - back), the half plane of one sheet has

    forward = h (1 + cos(beta))/2,    back = h (1 - cos(beta))/2.

If the sheets rather move at right angles to themselves at w, as the liners of shaped charges do, the point runs along the plane
at w/sin(beta), v = w/tan(beta), and the jet has v + w/sin(beta) = w/tan(beta/2).

Source: Birkhoff, MacDougall, Pugh and Taylor, J. Appl. Phys. 19 (1948) 563. Angles in radians.
"""

from __future__ import annotations

import math


def forward(beta: float) -> float:
    """Thickness of the stream that goes on, over that of the sheet."""
    return 0.5 * (1.0 + math.cos(beta))


def back(beta: float) -> float:
    """Thickness of the stream that goes back, over that of the sheet."""
    return 0.5 * (1.0 - math.cos(beta))


def jet_speed(beta: float) -> float:
    """Speed of the jet over that of sheets that move at right angles to themselves."""
    return 1.0 / math.tan(0.5 * beta)
