"""The base of all kinds of edges of the mesh."""

from __future__ import annotations

from typing import Any, ClassVar

from hydro2d.base.parameters import Parameter

#: the edges of the mesh, in the order of every array over them
EDGES = ("r_min", "r_max", "z_min", "z_max")

#: kinds of ghost cells beyond an edge: images of the cells inside, or copies of the last one
IMAGES, COPIES = "images", "copies"
#: flow through an edge: none; bodies leave and void comes in; bodies leave and the material next to the edge comes in
NOTHING, OUT, BOTH_WAYS = "", "out", "both ways"
#: forces on the vertices of an edge from beyond: none, those of an endless plate, a contact that only pushes, or a pressure
FREE, DASHPOTS, PUSH, PRESSURE = "", "dashpots", "push", "pressure"


class Edge:
    """One edge of the mesh. A kind overrides what differs from an open edge that constrains nothing.

    Parameters
    ----------
    values : of its keys in the deck, in SI, by their names; None for a key that the deck leaves out

    Attributes
    ----------
    place : str, which of `EDGES` it is
    """

    #: its word in decks, the edges that may be of this kind, its meaning, and its keys: boundaries.EDGE_NAME for each
    name: ClassVar[str]
    edges: ClassVar[tuple[str, ...]] = EDGES
    meaning: ClassVar[str]
    keys: ClassVar[tuple[Parameter, ...]] = ()
    #: the edge in a message
    in_words: ClassVar[str] = "an open edge"
    #: its sink in the audit, and the meaning of that sink if hydro2d.mesh.sinks does not have it
    sink: ClassVar[str] = "outflow"
    sink_meaning: ClassVar[str] = ""

    def __init__(self, **values: Any):
        self.values, self.place = values, ""

    @classmethod
    def ghost(cls) -> str:
        """The kind of its ghost cells, IMAGES or COPIES."""
        return COPIES

    @classmethod
    def flow(cls) -> str:
        """The flow through it, NOTHING, OUT or BOTH_WAYS."""
        return OUT

    @classmethod
    def traction(cls) -> str:
        """The forces on its vertices from beyond, FREE, DASHPOTS, PUSH or PRESSURE."""
        return FREE

    def constrain(self, time: float) -> float | None:
        """The normal velocity of its vertices at a time, m/s, towards higher r or z; None if they are free."""
        return None

    @classmethod
    def constrains(cls) -> bool:
        """Whether the normal velocity of its vertices is given."""
        return cls.constrain is not Edge.constrain

    def slide(self) -> float | None:
        """The velocity of its vertices along it, m/s, towards higher z or r; None if they slip freely."""
        return None

    def pressure(self, time: float) -> float:
        """The pressure from beyond on what lies at it, at a time in s, in Pa."""
        return 0.0

    def pressures(self) -> tuple[float, ...]:
        """The pressures from beyond that it may have, Pa, including the least and the greatest."""
        return ()

    def presses(self) -> bool:
        """Whether there ever is a pressure from beyond."""
        return any(self.pressures())

    def fastest(self, start: float, end: float) -> float:
        """The largest speed that it prescribes from one time to another, s, in m/s; 0 if it prescribes none."""
        return max((abs(velocity) for velocity in self.speeds()), default=0.0)

    def speeds(self) -> tuple[float, ...]:
        """The normal velocities that it may have, m/s, including the least and the greatest."""
        return ()
