"""The section `[boundaries]` of a deck: the condition at each edge of the mesh, with the keys of each kind of edge."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from hydro2d.base.keys import Section, optional, with_keys
from hydro2d.mesh.edges.registry import KINDS, words

if TYPE_CHECKING:
    Inner = str
    Outer = str
    Lower = str
    Upper = str
else:
    Inner, Outer, Lower, Upper = (Literal[words(edge)] for edge in ("r_min", "r_max", "z_min", "z_max"))


class _Boundaries(Section):
    """Boundary conditions at the edges of the mesh; see the table of boundary conditions."""

    r_min: Inner | None = Field(
        None, description="the inner edge; default: axis where a cylindrical mesh starts at r = 0, else wall"
    )
    r_max: Outer = Field("outflow", description="the outer edge")
    z_min: Lower = Field("outflow", description="the lower edge")
    z_max: Upper = Field("outflow", description="the upper edge")


def _edge_keys() -> dict[str, tuple[Any, Any]]:
    """Type and field of the keys that each kind of edge brings, for every edge that can be of that kind."""
    return {
        f"{edge}_{key.name}": optional(key, f'{key.description} at {edge} = "{kind.name}"')
        for kind in KINDS for key in kind.keys for edge in kind.edges
    }


if TYPE_CHECKING:
    Boundaries = _Boundaries
else:
    Boundaries = with_keys(_Boundaries, _edge_keys())
