"""Colour scales of figures: the range of a field, how much of it is clipped, linear or logarithmic, and the colour map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hydro2d.base.errors import Error, unknown

#: largest number of powers of ten on a logarithmic scale, unless its range is given
DECADES = 6


class FigureError(Error):
    """A figure that cannot be drawn; the message is for the user."""


def balanced(low: float, high: float) -> tuple[float, float]:
    """A colour range, symmetric about zero if it has negative values."""
    largest = max(-low, high)
    return (-largest, largest) if low < 0.0 else (low, high)


@dataclass(frozen=True)
class Scale:
    """How values become colours.

    clip : per cent of the cells whose values may lie beyond each end of the range
    log : a logarithmic scale; values that are not positive have no colour
    colours : name of a colour map of matplotlib; None: viridis, and blue to red for fields with negative values

    Raises FigureError for a clip that leaves nothing, and for an unknown colour map.
    """

    clip: float = 0.0
    log: bool = False
    colours: str | None = None

    def __post_init__(self) -> None:
        if not 0.0 <= self.clip < 50.0:
            raise FigureError(f"clip {self.clip:g}: must lie between 0 and 50 per cent")
        if self.colours is not None:
            from matplotlib import colormaps

            if self.colours not in colormaps:
                raise FigureError(unknown("colour map", self.colours, list(colormaps)))

    def limits(self, fields: Sequence[np.ndarray]) -> tuple[float, float]:
        """One range for several fields with NaN in void, symmetric about zero if there are negative values."""
        values = np.concatenate([each[np.isfinite(each)] for each in fields])
        if self.log:
            values = values[values > 0.0]
            if not values.size:
                raise FigureError("a logarithmic scale needs positive values, and the field has none")
        if not values.size:
            return 0.0, 1.0
        low, high = (float(end) for end in np.percentile(values, (self.clip, 100.0 - self.clip)))
        if self.log:
            low = max(low, high * 10.0**-DECADES)
            return (low, high) if high > low else (0.5 * low, 2.0 * low)
        low, high = balanced(low, high)
        return (low, high) if high > low else (low, low + 1.0)

    def drawn(self, limits: tuple[float, float]) -> dict:
        """Arguments `cmap` and `norm` of a matplotlib artist for a range. Raises FigureError if a range has no logarithm."""
        from matplotlib.colors import LogNorm, Normalize

        if self.log and limits[0] <= 0.0:
            raise FigureError(f"a logarithmic scale begins above 0, not at {limits[0]:g}")
        diverging = limits[0] < 0.0 and limits[0] == -limits[1]
        return {"cmap": self.colours or ("RdBu_r" if diverging else "viridis"),
                "norm": (LogNorm if self.log else Normalize)(*limits)}


LINEAR = Scale()
