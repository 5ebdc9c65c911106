"""A piston: an edge whose normal velocity is a table over time."""

from __future__ import annotations

from hydro2d.base.parameters import ANY, REQUIRED, Parameter
from hydro2d.base.tables import OVER_TIME, at
from hydro2d.mesh.edges.velocity import Velocity


class Piston(Velocity):
    """The velocity is linear between the rows of the table, and constant before the first and after the last one."""

    name = "piston"
    in_words = "a piston"
    meaning = "the normal velocity is a table over time; material crosses the edge as at a constant velocity"
    keys = (Parameter("piston", "s, m/s", REQUIRED, "normal velocity over time", sign=ANY, table=OVER_TIME,
                      example=[["0 us", "0 m/s"], ["1 us", "100 m/s"]]),)
    sink = "piston"
    sink_meaning = "momentum that pistons take, and the work that they do (negative)"

    def constrain(self, time: float) -> float:
        return at(self.values["piston"], time)

    def fastest(self, start: float, end: float) -> float:
        between = [velocity for time, velocity in self.values["piston"] if start < time < end]
        return max(abs(velocity) for velocity in (self.constrain(start), *between, self.constrain(end)))

    def speeds(self) -> tuple[float, ...]:
        return tuple(velocity for _, velocity in self.values["piston"])
