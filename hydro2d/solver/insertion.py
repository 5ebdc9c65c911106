"""Bodies put into the mesh: exact volume fractions and the state at time zero.

At every height z a body fills a few intervals of r. Intervals of earlier bodies of the deck are subtracted from those of later
ones. The share of a cell is the integral over its height of the clipped intervals, in r^2/2 for r-z and in r for planar
geometry: by Gauss quadrature between all heights at which a curve bends, meets an edge of the mesh or meets another
curve. In between the integrand is smooth, so that the result is exact to round-off.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from itertools import islice

import numpy as np

from hydro2d.deck.layout import layout
from hydro2d.deck.shapes.outlines import Outline, Slab
from hydro2d.materials.starts import body_state, body_velocity, refuse_unstable, slot_of

_SNAP = 1e-12
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_HALF_TURNS = 0.25 * math.pi * (_NODES + 1.0)
#: z = a + (b - a) sin^2(pi t/2) removes the square roots at the ends of arcs
_PLACES = np.sin(_HALF_TURNS) ** 2
_SHARES = _WEIGHTS * np.sin(2 * _HALF_TURNS)
_SHARES /= _SHARES.sum()


def fractions(outlines: list[Outline], r_edges: np.ndarray, z_edges: np.ndarray, cylindrical: bool) -> np.ndarray:
    """Share of every cell that each outline fills, as `shares_and_moments` finds it."""
    return shares_and_moments(outlines, r_edges, z_edges, cylindrical)[0]


def shares_and_moments(outlines: list[Outline], r_edges: np.ndarray, z_edges: np.ndarray,
                       cylindrical: bool) -> tuple[np.ndarray, np.ndarray]:
    """Share of every cell that each outline fills, and its first moments; where outlines overlap, the earlier takes the space.

    Parameters
    ----------
    outlines : list of Outline, length m
    r_edges, z_edges : float64, shapes (nr + 1,), (nz + 1,), in m
    cylindrical : bool

    Returns
    -------
    shares : float64, shape (m, nz, nr); exactly 0 and 1 in empty and full cells, sums over m never above 1
    moments : float64, shape (2, m, nz, nr), shares times the offsets of the centroids from the middle of the cell along r^2/2
        (planar: r) and z, in cells
    """
    result = np.zeros((3, len(outlines), len(z_edges) - 1, len(r_edges) - 1))
    area = _area_of(r_edges, cylindrical)
    full = np.diff(0.5 * r_edges**2 if cylindrical else r_edges)
    for j, (low, high) in enumerate(zip(z_edges, z_edges[1:], strict=False)):
        rows = [[slab for slab in entry.slabs if slab.high > low and slab.low < high] for entry in outlines]
        if not any(rows):
            continue
        breaks = _breaks(rows, low, high, r_edges)
        for a, b in zip(breaks, breaks[1:], strict=False):
            _integrate(result[:, :, j], rows, a, b, low, high, area)
        result[:, :, j] /= full
    return _snapped(result[0]), result[1:]


def _area_of(r_edges: np.ndarray, cylindrical: bool):
    """The function (a, b) -> area per height of the interval in every column, and that times its offset, in columns."""

    def along(r: np.ndarray) -> np.ndarray:
        return 0.5 * r**2 if cylindrical else r

    edges = along(r_edges)
    middle, width = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)

    def area(a: float, b: float) -> np.ndarray:
        clipped = along(np.clip(r_edges, a, b))
        size = np.diff(clipped)
        return np.stack([size, size * (0.5 * (clipped[1:] + clipped[:-1]) - middle) / width])

    return area


def _integrate(total: np.ndarray, rows: list[list[Slab]], a: float, b: float, low: float, high: float, area) -> None:
    """Adds to ``total`` [3, m, nr] the contribution of every body to the row from ``low`` to ``high`` between z = a and z = b.

    These are its mean area over the row, and its moments along r and z.
    """
    share = (b - a) / (high - low)
    middle = 0.5 * (a + b)
    active = [[slab for slab in slabs if slab.low <= middle <= slab.high] for slabs in rows]
    if not any(active):
        return
    if all(slab.inner.constant and slab.outer.constant for slabs in active for slab in slabs):
        places, weights = (middle,), (1.0,)
    else:
        places, weights = a + (b - a) * _PLACES, _SHARES
    for z, weight in zip(places, weights, strict=True):
        free = [(-math.inf, math.inf)]
        for m, slabs in enumerate(active):
            for slab in slabs:
                inner, outer = slab.inner.r(z), slab.outer.r(z)
                for piece in _common(free, inner, outer):
                    size = share * weight * area(*piece)
                    total[:2, m] += size
                    total[2, m] += size[0] * ((z - low) / (high - low) - 0.5)
                free = _without(free, inner, outer)


def _common(intervals: list[tuple[float, float]], low: float, high: float) -> list[tuple[float, float]]:
    cut = [(max(a, low), min(b, high)) for a, b in intervals]
    return [(a, b) for a, b in cut if a < b]


def _without(intervals: list[tuple[float, float]], low: float, high: float) -> list[tuple[float, float]]:
    if not low < high:
        return intervals
    return _common(intervals, -math.inf, low) + _common(intervals, high, math.inf)


def _breaks(rows: list[list[Slab]], low: float, high: float, r_edges: np.ndarray) -> list[float]:
    """Heights between ``low`` and ``high`` at which the integrand may bend, in order."""
    breaks = {low, high}
    curves = []
    for slabs in rows:
        for slab in slabs:
            a, b = max(slab.low, low), min(slab.high, high)
            breaks.update((a, b))
            for curve in (slab.inner, slab.outer):
                curves.append((a, b, curve))
                breaks.update(_crossings(curve, a, b, r_edges))
    levels = sorted(breaks)
    curves.sort(key=lambda curve: curve[0])
    for n, (a1, b1, first) in enumerate(curves):
        for a2, b2, second in islice(curves, n + 1, None):
            if a2 >= b1:
                break
            if not (first.constant and second.constant):
                breaks.update(_meetings(first, second, max(a1, a2), min(b1, b2), levels))
    return sorted(breaks)


def _crossings(curve, a: float, b: float, r_edges: np.ndarray) -> list[float]:
    """Heights at which a monotone curve crosses edges of the mesh."""
    if curve.constant:
        return []
    ends = sorted((curve.r(a), curve.r(b)))
    first, last = np.searchsorted(r_edges, ends[0], "right"), np.searchsorted(r_edges, ends[1], "left")
    return [curve.z_at(float(r), a, b) for r in r_edges[first:last]]


def _meetings(first, second, a: float, b: float, levels: list[float]) -> list[float]:
    """Heights from a to b at which two curves cross, one at most between neighbouring levels."""
    meetings = []
    inside = levels[bisect_left(levels, a) : bisect_right(levels, b)]
    for low, high in zip(inside, inside[1:], strict=False):
        left, right = first.r(low) - second.r(low), first.r(high) - second.r(high)
        if left * right < 0:
            for _ in range(100):
                middle = 0.5 * (low + high)
                if (first.r(middle) - second.r(middle)) * left > 0:
                    low = middle
                else:
                    high = middle
            meetings.append(0.5 * (low + high))
    return meetings


def _snapped(vof: np.ndarray) -> np.ndarray:
    """Fractions within round-off of 0 made 0, and sums within round-off of 1 made 1."""
    vof[np.abs(vof) < _SNAP] = 0.0
    total = vof.sum(axis=0)
    for j, i in zip(*np.nonzero((np.abs(total - 1.0) < _SNAP) & (total != 1.0)), strict=True):
        largest = int(np.argmax(vof[:, j, i]))
        vof[largest, j, i] = 0.0
        vof[largest, j, i] = 1.0 - vof[:, j, i].sum()
    return vof


def _body_shares(deck, grid) -> tuple[np.ndarray, np.ndarray]:
    outlines = [placed.outline for placed in layout(deck).bodies]
    return shares_and_moments(outlines, grid.r_edges, grid.z_edges, grid.cylindrical)


def insert(deck, grid, table) -> np.ndarray:
    """Volume fractions of the slots, float64[m, nz, nr] without ghosts. Earlier bodies take the space of later ones."""
    result = np.zeros((len(table), grid.nz, grid.nr))
    for m, share in zip(slot_of(deck, table), _body_shares(deck, grid)[0], strict=True):
        result[m] += share
    return np.minimum(result, 1.0)


def initial_state(deck, grid, table, group=None) -> dict[str, np.ndarray]:
    """The state at time zero, in interior cells.

    Parameters
    ----------
    group : int64[m], optional
        Body group b of every slot; without it there is one.

    Returns
    -------
    dict with float64 arrays
        ``vof``, ``rho`` (kg/m^3), ``e`` (J/kg), shape (m, nz, nr); density and energy also where there is none of a body.
        ``centroid``, shape (2, m, nz, nr): offsets from the middle of the cell along r^2/2 (planar: r) and z, in cells.
        ``u_cell``, ``v_cell`` (m/s), shape (b, nz, nr): momentum over mass of the group, 0 where there is none of it.

    Raises DeckError if a body has no speed of sound.
    """
    (shares, moments), slots = _body_shares(deck, grid), slot_of(deck, table)
    shape = (len(table), grid.nz, grid.nr)
    vof, mass, energy = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    rho, e, place = np.zeros(shape), np.zeros(shape), np.zeros((2, *shape))
    group = np.zeros(len(table), dtype=np.int64) if group is None else group
    momentum = np.zeros((2, int(group.max()) + 1, grid.nz, grid.nr))
    g = grid.g
    r, z = grid.rc[g : g + grid.nr][None, :], grid.zc[g : g + grid.nz][:, None]
    for m, moment in zip(slots, moments.swapaxes(0, 1), strict=True):
        place[:, m] += moment
    for body, m, share in reversed(list(zip(deck.body, slots, shares, strict=True))):
        refuse_unstable(body, table, m)
        density, heat = body_state(body, table, m)
        lone = vof[m] == 0
        both = ~lone & (share > 0)
        vof[m] += share
        mass[m] += share * density
        energy[m] += share * density * heat
        rho[m][lone], e[m][lone] = density, heat
        rho[m][both], e[m][both] = mass[m][both] / vof[m][both], energy[m][both] / mass[m][both]
        momentum[:, group[m]] += share * density * np.stack(body_velocity(body, r, z))
    total = np.stack([mass[group == b].sum(axis=0) for b in range(momentum.shape[1])])
    velocity = np.where(total > 0, momentum / np.where(total > 0, total, 1.0), 0.0)
    vof = np.minimum(vof, 1.0)
    cut = (vof > 0.0) & (vof < 1.0)
    place = np.where(cut, place / np.where(cut, vof, 1.0), 0.0)
    return {"vof": vof, "centroid": place, "rho": rho, "e": e, "u_cell": velocity[0], "v_cell": velocity[1]}
