"""Bodies of a deck for liquids in layers under their own weight: each row of cells is a body, with the pressure of its depth.

The lower liquid ends at z = depth + amplitude cos(pi r/width); what lies above it is void or a second liquid. The bodies of a
liquid are joined to the first of them.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass

import numpy as np

#: points of the interface within a row of cells
POINTS = 25


@dataclass(frozen=True)
class Layers:
    """Lengths in m, densities in kg/m^3, acceleration in m/s^2, pressure at the top in Pa; without `upper` void lies above."""

    width: float
    depth: float
    amplitude: float
    gravity: float
    lower: float
    upper: float = 0.0
    height: float = 0.0
    top: float = 0.0

    def pressure(self, z: float) -> float:
        """Pressure at rest with a flat interface, Pa; 0 in a void."""
        below, above = max(self.depth - z, 0.0), self.depth + self.height - max(z, self.depth)
        return self.top + self.gravity * (self.lower * below + self.upper * max(above, 0.0))

    def bodies(self, cell: float) -> list[dict[str, object]]:
        """The bodies for rows of cells of this height, the lower liquid first, because it takes the space of the upper one."""
        rows = math.ceil((self.depth + self.amplitude) / cell - 1e-9)
        shapes = [("lower", k, self._below(k * cell, (k + 1) * cell)) for k in range(rows)]
        if self.upper:
            first, last = int((self.depth - self.amplitude) / cell + 1e-9), round((self.depth + self.height) / cell)
            shapes += [("upper", k, {"shape": "box", "z": [k * cell, (k + 1) * cell]}) for k in range(first, last)]
        made, seen = [], set()
        for liquid, k, shape in shapes:
            joined = {"name": f"{liquid}_{k}", "join": liquid} if liquid in seen else {"name": liquid}
            seen.add(liquid)
            made.append({**joined, "material": liquid, **shape, "pressure": self.pressure((k + 0.5) * cell)})
        return made

    def _below(self, low: float, high: float) -> dict[str, object]:
        """The part of a row below the interface, as a box or a polygon."""
        if high <= self.depth - self.amplitude:
            return {"shape": "box", "z": [low, high]}
        ends = [min(max((z - self.depth) / self.amplitude, -1.0), 1.0) for z in (low, high)]
        angle = np.linspace(math.acos(ends[0]), math.acos(ends[1]), POINTS)
        surface = np.stack([angle * self.width / math.pi, self.depth + self.amplitude * np.cos(angle)], axis=1)
        below = [[self.width, low]] if ends[0] == -1.0 and low < self.depth - self.amplitude else []
        above = [[0.0, high]] if ends[1] < 1.0 else []
        return {"shape": "polygon", "points": [[0.0, low], *below, *surface.tolist(), *above]}


def override(bodies: list[dict[str, object]]) -> str:
    """Bodies as an override of a deck."""
    return f"body=[{', '.join(map(inline, bodies))}]"


def inline(value: object) -> str:
    """A table, a list, a text or a number of TOML on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}={inline(each)}" for key, each in value.items()) + "}"
    return json.dumps(value)
