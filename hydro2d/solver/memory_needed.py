"""The memory that a deck needs, before any of it is allocated."""

from __future__ import annotations

import psutil

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.materials import library
from hydro2d.mesh.grid import GHOSTS
from hydro2d.mesh.state import bytes_needed

#: doubles per cell and body that filling the mesh needs in addition to the state
FILLING = 12


def needed(deck) -> int:
    """Memory of the state of a deck, bytes."""
    table = library.resolve(deck)
    nr, nz = (len(edges) - 1 for edges in decks.edges(deck))
    groups = max(decks.body_groups(deck)) + 1
    internal = max(len(own) for own in table.internal)
    return bytes_needed(nz + 2 * GHOSTS, nr + 2 * GHOSTS, len(table), groups, internal, table.remembers)


def refuse_too_large(deck) -> None:
    """Raises DeckError if the machine does not have the memory to start the deck."""
    nr, nz = (len(edges) - 1 for edges in decks.edges(deck))
    whole = needed(deck) + 8 * FILLING * nr * nz * len(deck.body)
    there = psutil.virtual_memory().total
    if whole > there:
        raise DeckError(f"mesh: {nr} x {nz} cells need about {whole / 2**30:.3g} GiB of memory; this machine has "
                        f"{there / 2**30:.3g} GiB")
