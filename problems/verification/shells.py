"""Bodies of a deck for Coggeshall's flows: a tube as thick as a cell is a body, with its mean density and pressure.

All tubes are joined to the innermost. Spheres would do as well in r-z, but a deck of a hundred of them takes minutes to set up.
"""

from __future__ import annotations

from problems.verification.exact.coggeshall import Free, Slowed, shell_mean


def tubes(flow: Free | Slowed, outer: float, cell: float, high: float) -> list[dict[str, object]]:
    """Concentric tubes of gas about the axis, at the start of a flow."""
    made = []
    rho, _, p = (float(each) for each in flow.sample(1.0, 0.0))
    for n in range(round(outer / cell)):
        name = {"name": f"shell_{n}", "join": "gas"} if n else {"name": "gas"}
        ends = [n * cell, (n + 1) * cell]
        made.append({**name, "material": "gas", "shape": "box", "r": ends, "z": [0.0, high],
                     "density": rho * shell_mean(flow.b, *ends, flow.k),
                     "pressure": p * shell_mean(flow.pressure_power, *ends, flow.k),
                     "flow": {"pattern": "cylindrical", "speed": flow.rate, "exponent": -1.0}})
    return made
