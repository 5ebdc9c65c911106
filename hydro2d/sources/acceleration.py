"""Acceleration: a force per mass along the axis over time, on a body or a part of it, as of gravity or of a magnetic field."""

from __future__ import annotations

from typing import Literal

import numpy as np
from pydantic import Field

from hydro2d.base.over_time import AccelerationOverTime, integral
from hydro2d.sources.base import Source


class Acceleration(Source):
    """Accelerates a body, or what of it lies within reach of the source, along z."""

    kind: Literal["acceleration"] = Field(description="a force per mass along the axis, constant or over time")
    axial: AccelerationOverTime = Field(
        description="acceleration towards +z: a constant, or a table of [time, acceleration], straight between its rows, zero "
                    "before the first and after the last",
        examples=["-9.81 m/s^2", [["0 us", "1e9 m/s^2"], ["20 us", "0 m/s^2"]]],
    )

    def push(self, grid, time: float, dt: float) -> np.ndarray:
        """The integral of the acceleration over the step times the share of a cell that lies within reach."""
        given = self.axial * dt if isinstance(self.axial, float) else integral(self.axial, time, time + dt)
        axial = given * self.share(grid)
        return np.stack([np.zeros_like(axial), axial])
