"""An edge that holds what lies at it: its vertices have both components of a velocity, without slip."""

from __future__ import annotations

from hydro2d.base.parameters import ANY, Parameter
from hydro2d.mesh.edges.velocity import Velocity

#: components of a velocity, in the order of r and z
COMPONENTS = ("radial", "axial")


class Held(Velocity):
    """Vertices at rest, or at the velocity that the deck gives; a body that lies there cannot slip along it."""

    name = "held"
    in_words = "a held edge"
    meaning = ("clamped: what lies at the edge sticks to it, at rest or at the velocity that the deck gives; a velocity across "
               "the edge lets material through, as that of `velocity`")
    keys = tuple(Parameter(name, "m/s", 0.0, f"{name} velocity (0 if not given)", sign=ANY, example="100 m/s")
                 for name in COMPONENTS)

    def _component(self, axis: int) -> float:
        """A component of its velocity, m/s; axis : 0 radial, 1 axial."""
        return self.values.get(COMPONENTS[axis]) or 0.0

    def constrain(self, time: float) -> float:
        return self._component(self.place.startswith("z"))

    def slide(self) -> float:
        return self._component(not self.place.startswith("z"))

    def speeds(self) -> tuple[float, ...]:
        return (self.constrain(0.0),)
