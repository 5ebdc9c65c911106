"""An open end, and one that transmits waves."""

from __future__ import annotations

from hydro2d.mesh.edges.base import BOTH_WAYS, DASHPOTS, Edge


class Outflow(Edge):
    """Copies beyond it, free vertices, and bodies that leave."""

    name = "outflow"
    meaning = "an open end: bodies leave as if the mesh continued, and only void comes in"


class Transmit(Edge):
    """Copies beyond it, and on its vertices what a body without end beyond would do; the material next to it may come back."""

    name = "transmit"
    meaning = ("the cut through a body without end: it lets waves out, resists their pressure, and keeps the pressure and the "
               "velocity with which the body starts; other bodies leave as through an open end")
    sink = "transmitted"

    @classmethod
    def flow(cls) -> str:
        return BOTH_WAYS

    @classmethod
    def traction(cls) -> str:
        return DASHPOTS
