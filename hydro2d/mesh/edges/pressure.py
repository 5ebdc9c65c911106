"""An edge with a pressure from beyond."""

from __future__ import annotations

from hydro2d.base.parameters import ANY, REQUIRED, Parameter
from hydro2d.base.tables import CONSTANT_OR_OVER_TIME, Rows, at
from hydro2d.mesh.edges.base import BOTH_WAYS, PRESSURE, Edge


class Pressure(Edge):
    """Copies beyond it and free vertices, on which a pressure acts wherever a body lies at the edge."""

    name = "pressure"
    in_words = "an edge with a pressure"
    meaning = ("a pressure from beyond, constant or a table over time, acts on the bodies at the edge; they may leave, and "
               "where they go inward more of them comes in")
    keys = (Parameter("pressure", "s, Pa", REQUIRED, "pressure from beyond, a number or a table over time", sign=ANY,
                      table=CONSTANT_OR_OVER_TIME, example="100 kPa"),)
    sink = "pressure"
    sink_meaning = "momentum that edges with a pressure take (negative: give), and the work that they do (negative)"

    @classmethod
    def flow(cls) -> str:
        return BOTH_WAYS

    @classmethod
    def traction(cls) -> str:
        return PRESSURE

    def pressure(self, time: float) -> float:
        given: float | Rows = self.values["pressure"]
        return at(given, time) if isinstance(given, tuple) else given

    def pressures(self) -> tuple[float, ...]:
        given: float | Rows = self.values["pressure"]
        return tuple(value for _, value in given) if isinstance(given, tuple) else (given,)
