"""Acceleration: a force per mass along the axis over time, on a body or a part of it, as of gravity or of a magnetic field."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import ANY, REQUIRED, Parameter
from hydro2d.base.tables import CONSTANT_OR_OVER_TIME, integral
from hydro2d.sources.base import Source, declared


@declared
class Acceleration(Source):
    """Accelerates a body, or what of it lies within reach of the source, along z."""

    word = "acceleration"
    meaning = "a force per mass along the axis, constant or over time"
    keys = (
        Parameter("axial", "s, m/s^2", REQUIRED, "acceleration towards +z: a constant, or a table of [time, acceleration], "
                  "straight between its rows, zero before the first and after the last", sign=ANY, example="-9.81 m/s^2",
                  table=CONSTANT_OR_OVER_TIME),
    )

    def push(self, grid, time: float, dt: float) -> np.ndarray:
        """The integral of the acceleration over the step times the share of a cell that lies within reach."""
        given = self.axial * dt if isinstance(self.axial, float) else integral(self.axial, time, time + dt)
        axial = given * self.share(grid)
        return np.stack([np.zeros_like(axial), axial])
