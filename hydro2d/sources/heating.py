"""Heating: a power per mass over time, in a part of a body, as of a beam, a current or radiation that the body absorbs."""

from __future__ import annotations

from typing import Literal

import numpy as np
from pydantic import Field

from hydro2d.base.over_time import PowerOverTime, integral
from hydro2d.sources.base import Source


class Heating(Source):
    """Heats a body, or what of it lies within reach of the source; the energy per mass is the exact integral of the table."""

    kind: Literal["heating"] = Field(description="a power per mass over time")
    power: PowerOverTime = Field(
        description="table of [time, power per mass], straight between its rows, zero before the first and after the last",
        examples=[[["0 us", "1e11 W/kg"], ["5 us", "1e11 W/kg"]]],
    )

    def heat(self, grid, time: float, dt: float) -> np.ndarray:
        """The integral of the power over the step times the share of a cell that lies within reach, J/kg, float64[nz, nr]."""
        return integral(self.power, time, time + dt) * self.share(grid)
