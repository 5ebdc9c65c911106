"""What every edge of the mesh has, whatever its kind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

#: the edges of the mesh, in the order of every array over them
EDGES = ("r_min", "r_max", "z_min", "z_max")

#: what ghost cells beyond an edge are: images of the cells inside, or copies of the last one
IMAGES, COPIES = "images", "copies"
#: what flows through an edge: nothing; bodies leave, and void comes in; bodies leave, and what stands beside comes in
NOTHING, OUT, BOTH_WAYS = "", "out", "both ways"
#: what holds the vertices of an edge from beyond: nothing, the dashpots of an endless plate, or what they cannot enter and may
#: leave
FREE, DASHPOTS, PUSH = "", "dashpots", "push"


@dataclass(frozen=True)
class Key:
    """A key of the deck that a kind needs: boundaries.EDGE_NAME, required where an edge is of the kind.

    ``over_time`` : a table [[time, value], ...] in the place of one value
    """

    name: str
    unit: str
    meaning: str
    example: Any
    over_time: bool = False


class Edge:
    """One edge of the mesh. A kind overrides what it does otherwise than an edge that is open and holds nothing.

    Parameters
    ----------
    values : what the deck gives for its keys, in SI, by their names
    """

    #: its word in decks, the edges that may be of this kind, what it is
    name: ClassVar[str]
    edges: ClassVar[tuple[str, ...]] = EDGES
    meaning: ClassVar[str]
    keys: ClassVar[tuple[Key, ...]] = ()
    #: the sink of the audit that what it takes goes to, and what that is where hydro2d.mesh.sinks has no such sink
    sink: ClassVar[str] = "outflow"
    sink_meaning: ClassVar[str] = ""

    def __init__(self, **values: Any):
        self.values = values

    @classmethod
    def ghost(cls) -> str:
        """What its ghost cells are, IMAGES or COPIES."""
        return COPIES

    @classmethod
    def flow(cls) -> str:
        """What flows through it, NOTHING, OUT or BOTH_WAYS."""
        return OUT

    @classmethod
    def traction(cls) -> str:
        """What holds its vertices from beyond, FREE, DASHPOTS or PUSH."""
        return FREE

    def constrain(self, time: float) -> float | None:
        """The normal velocity of its vertices at a time, m/s, towards higher r or z; None where they are free."""
        return None

    @classmethod
    def holds(cls) -> bool:
        """Whether the normal velocity of its vertices is given."""
        return cls.constrain is not Edge.constrain

    def fastest(self, start: float, end: float) -> float:
        """The greatest size of the velocity that it gives from one time to another, s, in m/s; 0 where it gives none."""
        return max((abs(velocity) for velocity in self.speeds()), default=0.0)

    def speeds(self) -> tuple[float, ...]:
        """The normal velocities that it may have, m/s, the least and the greatest of them among others."""
        return ()
