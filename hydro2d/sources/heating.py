"""Heating: a power per mass over time, in a part of a body, as of a beam, a current or radiation that the body absorbs."""

from __future__ import annotations

import numpy as np

from hydro2d.base.parameters import ANY, REQUIRED, Parameter
from hydro2d.base.tables import OVER_TIME, integral
from hydro2d.sources.base import Source, declared


@declared
class Heating(Source):
    """Heats a body, or what of it lies within reach of the source; the energy per mass is the exact integral of the table."""

    word = "heating"
    meaning = "a power per mass over time"
    keys = (
        Parameter("power", "s, W/kg", REQUIRED, "table of [time, power per mass], straight between its rows, zero before the "
                  "first and after the last", sign=ANY, example=[["0 us", "1e11 W/kg"], ["5 us", "1e11 W/kg"]],
                  table=OVER_TIME),
    )

    def heat(self, grid, time: float, dt: float) -> np.ndarray:
        """The integral of the power over the step times the share of a cell that lies within reach, J/kg, float64[nz, nr]."""
        return integral(self.power, time, time + dt) * self.share(grid)
