"""The segments of a mesh that a deck describes by two keys: cells across a body, and how far the mesh reaches.

Fine square cells cover the body, everything that moves with it and its path ahead; beyond them each cell is a tenth larger
than the one before. A third key ends the fine cells some way behind the nose of a rod. The deck then has these segments, as if
its author had written them.
"""

from __future__ import annotations

import math

from hydro2d.base import units
from hydro2d.base.errors import unknown
from hydro2d.deck.checks import heading
from hydro2d.deck.layout import extent
from hydro2d.deck.mesh import MeshError, body
from hydro2d.deck.mesh_sections import GENERATED, Mesh, as_text, radii
from hydro2d.deck.sections import Deck

#: ratio of the size of a cell to that of the one before, beyond the fine cells
GROWTH = 1.1
#: fine cells next to the bodies, ahead of the one that the mesh follows, behind; then growing cells behind. All as multiples
#: of the length that `cells_across` divides
BESIDE, AHEAD, BEHIND, TRAIL = 1.5, 5.0, 0.5, 3.0
#: more cells along a direction than fit on any machine
MOST = 1_000_000
#: largest cell along a rod behind `mesh.fine`, in fine cells
COARSEST = 4.0
#: a length counts as a whole number of cells if it is longer by no more than this fraction of a cell
ROUNDING = 1e-6


def with_segments(deck: Deck) -> Deck:
    """The deck with the segments that its `mesh.cells_across` and `mesh.reach` stand for; the same deck without these keys.

    Raises MeshError.
    """
    mesh = deck.mesh
    if mesh.reach is None:
        return deck
    entry = _measured(deck)
    size = entry.resolved_width(mesh.r_start) / mesh.cells_across
    moving = [entry, *(other for other in deck.body if other is not entry and _moves(other))]
    reach = _length(entry, deck, "reach")
    outer = max((end for each in moving if math.isfinite(end := extent(each, deck, "r")[1])), default=0.0)
    low, high = min(extent(each, deck, "z")[0] for each in moving), max(extent(each, deck, "z")[1] for each in moving)
    start, along = _along(deck, entry, size, (low, high), reach)
    whole = {key: value for key, value in mesh.model_dump().items() if value is not None and key not in GENERATED}
    whole |= {"z_start": start, "z": along}
    if not mesh.r:
        whole["r"] = _aside(mesh.r_start, outer, size, size * mesh.cells_across, reach)
    return deck.model_copy(update={"mesh": Mesh.model_validate(whole)})


def as_segments(deck: Deck, written: dict) -> dict[str, object]:
    """Overrides by key that give a deck the segments of its resolved mesh; empty if its author wrote segments.

    written : the tables of the deck as its author wrote them
    """
    if written.get("mesh", {}).get("reach") in (None, "none"):
        return {}
    mesh = deck.mesh.model_dump(exclude_none=True)
    return {"mesh.reach": "none", "mesh.z_start": units.exact(mesh["z_start"], "m"),
            "mesh.r": [as_text(each) for each in mesh["r"]], "mesh.z": [as_text(each) for each in mesh["z"]]}


def _moves(entry) -> bool:
    return entry.velocity != (0.0, 0.0) or entry.flow is not None


def _measured(deck: Deck):
    """The body across which cells are counted."""
    names, given = [entry.name for entry in deck.body], deck.mesh.across
    if given is not None and given not in names:
        raise MeshError(("mesh", "across"), unknown("body", given, names))
    chosen = given or deck.mesh.follow or (deck.penetration.rod if deck.penetration else None)
    if chosen in names:
        return body(deck, chosen)
    return next((entry for entry in deck.body if _moves(entry)), deck.body[0])


def _length(entry, deck: Deck, key: str) -> float:
    """The length in m that a key gives, perhaps as a number of radii of a body."""
    value = getattr(deck.mesh, key)
    count = radii(value)
    if count is None:
        return float(value)
    radius = entry.reach_radius(deck.mesh.r_start)
    if not math.isfinite(radius):
        raise MeshError(("mesh", key), f'"{entry.name}" has no radius; give a length, such as "20 mm"')
    return count * radius


def _fine_behind(entry, deck: Deck, size: float) -> float | None:
    """Length behind the nose of the body that has fine cells, m; None if all of it has. Raises MeshError."""
    mesh = deck.mesh
    if mesh.fine is None:
        return None

    def wrong(message: str) -> MeshError:
        return MeshError(("mesh", "fine"), message)

    if mesh.geometry == "planar":
        raise wrong("is for a rod on the axis of a cylindrical mesh; leave it out in planar geometry")
    if not entry.is_slender:
        raise wrong(f'is for a body of shape "rod"; "{entry.name}" is a {entry.shape}: leave fine out')
    if mesh.follow is not None and mesh.follow not in (names := [other.name for other in deck.body]):
        raise MeshError(("mesh", "follow"), unknown("body", mesh.follow, names))
    if mesh.follow != entry.name:
        raise wrong(f'the nose of "{entry.name}" leaves the fine cells of a mesh that does not follow it; add follow = '
                    f'"{entry.name}" or leave fine out')
    if others := [other.name for other in deck.body if other is not entry and _moves(other)]:
        raise wrong(f'is for a rod that flies alone; "{others[0]}" moves as well: leave fine out, or write r and z')
    if heading(entry) * entry.velocity[1] < 0.0:
        raise wrong(f'"{entry.name}" flies tail first; give it direction = {-heading(entry)}, or leave fine out')
    length = _length(entry, deck, "fine")
    if length < size:
        raise wrong(f"is {length:g} m, less than one cell of {size:.4g} m; 7 radii are enough for a rod that stays whole")
    if length >= entry.length:
        raise wrong(f'is {length:g} m, and "{entry.name}" is {entry.length:g} m long; give less, or leave fine out for '
                    "fine cells along all of it")
    return length


def _count(length: float, size: float, key: str) -> int:
    """Cells of this size that cover a length."""
    if length / size > MOST:
        raise MeshError(("mesh", key), f"would need {length / size:.3g} cells of {size:.3g} m")
    return max(math.ceil(length / size - ROUNDING), 0)


def _growing(length: float, size: float, largest: float = math.inf) -> tuple[int, int]:
    """Cells that cover a length, each larger than the one before, the first larger than ``size``; then cells like the last.

    No cell is larger than ``largest``, m.
    """
    if length <= 0.0:
        return 0, 0
    count = math.ceil(math.log1p(length / size * (GROWTH - 1.0) / GROWTH) / math.log(GROWTH) - ROUNDING)
    if size * GROWTH**count <= largest:
        return count, 0
    count = int(math.log(largest / size) / math.log(GROWTH))
    return count, math.ceil((length - _length_of(count, size)) / (size * GROWTH**count) - ROUNDING)


def _length_of(count: int, size: float) -> float:
    """Length of growing cells, the first larger than ``size``, m."""
    return sum(size * GROWTH ** (number + 1) for number in range(count))


def _grown(count: int, alike: int, size: float) -> list[dict]:
    """Segments of growing cells, and of cells like the last of them."""
    return [{"cells": count, "ratio": GROWTH}] * bool(count) + [{"cells": alike, "size": size * GROWTH**count}] * bool(alike)


def _aside(start: float, outer: float, size: float, width: float, reach: float) -> list[dict]:
    """The segments from the axis outward: fine cells to beyond the bodies, then growing ones."""
    fine = max(_count(outer + min(BESIDE * width, reach) - start, size, "reach"), 1)
    return [{"cells": fine, "size": size}, *_grown(*_growing(outer + reach - start - fine * size, size), size)]


def _along(deck: Deck, entry, size: float, ends: tuple[float, float], reach: float) -> tuple[float, list[dict]]:
    """The lower end of the mesh and its segments along z. A tip of the body lies on an edge between cells."""
    width, (low, high) = size * deck.mesh.cells_across, ends
    sign = heading(entry) if entry.velocity[1] != 0.0 else 0
    near = min(AHEAD * width, reach) if deck.mesh.follow is not None else reach
    ahead, behind = (near, reach - near), (BEHIND * width, TRAIL * width)
    below, above = {1: (behind, ahead), -1: (ahead, behind), 0: ((reach, 0.0), (reach, 0.0))}[sign]
    tip = low if sign < 0 else high
    fine, largest = [tip - low + below[0], high + above[0] - tip], [math.inf, math.inf]
    if (length := _fine_behind(entry, deck, size)) is not None:
        back = 0 if sign > 0 else 1
        fine[back], largest[back] = length, COARSEST * size
    upper = _count(fine[1], size, "reach")
    grown = _grown(*_growing(high + sum(above) - tip - upper * size, size, largest[1]), size)
    beyond = [{"cells": upper, "size": size}, *grown] if upper else grown
    given = "z_start" in deck.mesh.model_fields_set
    far = tip - deck.mesh.z_start if given else tip - low + sum(below)
    lower = _count(fine[0], size, "reach")
    count, alike = _growing(far - lower * size, size, largest[0])
    first, near = size * GROWTH**count, tip - lower * size
    if alike:  # with the ends of segments, which a mesh of other cells keeps (`study.plan.meshes`)
        to = near - _length_of(count, size)
        graded = [{"to": to, "cells": alike}, {"to": near, "first": first, "ratio": 1.0 / GROWTH}, {"to": tip, "cells": lower}]
        return deck.mesh.z_start if given else to - alike * first, [*graded, *beyond]
    if given:
        lower = _count(far, size, "z_start")
        return deck.mesh.z_start, [*([{"to": tip, "cells": lower}] if far > 0.0 else []), *beyond]
    start = near - _length_of(count, size)
    shrinking = [{"cells": count, "first": first, "ratio": 1.0 / GROWTH}] if count else []
    return start, [*shrinking, {"to": tip, "cells": lower}, *beyond]
