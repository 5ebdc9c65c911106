"""An edge with a prescribed normal velocity."""

from __future__ import annotations

from hydro2d.base.parameters import ANY, REQUIRED, Parameter
from hydro2d.mesh.edges.base import BOTH_WAYS, Edge


class Velocity(Edge):
    """Material crosses the edge at the velocity that the deck gives."""

    name = "velocity"
    in_words = "an edge with a velocity"
    meaning = "the normal velocity is prescribed; where it points inward, more of the material next to the edge comes in"
    keys = (Parameter("velocity", "m/s", REQUIRED, "normal velocity", sign=ANY, example="100 m/s"),)
    sink = "walls"

    @classmethod
    def flow(cls) -> str:
        return BOTH_WAYS

    def constrain(self, time: float) -> float:
        return self.values["velocity"]

    def speeds(self) -> tuple[float, ...]:
        return (self.values["velocity"],)
