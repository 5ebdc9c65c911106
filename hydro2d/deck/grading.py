"""Cells that a mesh graded along its rod saves: the lines of `hydro2d check` on `mesh.fine`."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import ValidationError

from hydro2d.deck.checks import room
from hydro2d.deck.generated_mesh import with_segments
from hydro2d.deck.identity import cells_to
from hydro2d.deck.layout import edges, extent
from hydro2d.deck.mesh import MeshError, body
from hydro2d.deck.mesh_sections import Mesh
from hydro2d.deck.sections import Deck
from hydro2d.files import toml

#: `mesh.fine` that is proposed, and the least share of the cells that it must save
ENOUGH, WORTH = "7 radii", 0.1
#: cells whose sizes differ by less than this fraction are of one size
ALIKE = 1e-6


def lines(deck: Deck) -> list[str]:
    """What `mesh.fine` saves, or would save; nothing where a mesh follows no rod, gains little or has been graded by hand."""
    written, name = getattr(deck, "_tables", {}).get("mesh", {}), deck.mesh.follow
    if written.get("fine", "none") != "none":
        return [f"mesh.fine grades the mesh along it: {_cells(deck)} cells instead of {_cells(deck, written, fine=None)}"]
    if name is None or not body(deck, name).is_slender or not _is_even_along(deck, name):
        return []
    keys: dict[str, Any] = {"fine": ENOUGH}
    if by_hand := written.get("reach", "none") == "none":
        radius = body(deck, name).own_radius
        keys |= {"cells_across": float(f"{cells_to(deck, radius):.4g}"),
                 "reach": f"{room(deck, edges(deck)[1])[0] / radius:.4g} radii"}
    graded, cells = _cells(deck, written, z=(), **keys), _cells(deck)
    if graded is None or graded > (1.0 - WORTH) * cells:
        return []
    said = ", ".join(f"mesh.{key} = {toml.inline(value)}" for key, value in keys.items())
    return [f"if it stays whole, a mesh graded along it would have {graded} instead of {cells} cells:",
            said + " instead of mesh.z" * by_hand]


def _cells(deck: Deck, written: dict | None = None, **keys) -> int | None:
    """Number of cells of a deck, or of its mesh as it was written, with other keys; None if these make no mesh."""
    try:
        if written is not None:
            deck = deck.model_copy(update={"mesh": Mesh.model_validate(written | keys)})
            deck._tables = {}
        r, z = edges(with_segments(deck))
    except (MeshError, ValidationError):
        return None
    return (len(r) - 1) * (len(z) - 1)


def _is_even_along(deck: Deck, name: str) -> bool:
    """Whether all cells along a body have one size."""
    z, (low, high) = edges(deck)[1], extent(body(deck, name), deck, "z")
    sizes = np.diff(z)[(z[:-1] >= low) & (z[1:] <= high)]
    return len(sizes) > 0 and float(np.ptp(sizes)) < ALIKE * float(sizes.max())
