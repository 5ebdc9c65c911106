"""Outlines of the bodies: lines along which a body fills half of a cell."""

from __future__ import annotations

import numpy as np


def outlines(r_edges: np.ndarray, z_edges: np.ndarray, vof: np.ndarray, closed: bool = False) -> list[np.ndarray]:
    """Contours of vof = 1/2 through the cell centres.

    r_edges (nr + 1,), z_edges (nz + 1,) in m, vof (nz, nr). The outermost values are carried on to the edges of the
    mesh, so that lines reach the axis and the boundary; `closed` draws the lines on along the boundary, but for the
    inner one. Returns arrays (n, 2) of r, z.
    """
    import contourpy

    r, z = (np.concatenate([e[:1], 0.5 * (e[1:] + e[:-1]), e[-1:]]) for e in (r_edges, z_edges))
    values = np.pad(vof, 1, mode="edge")
    if closed:
        r, z = np.append(r, _beyond(r[-1], r[-2])), np.concatenate([[_beyond(z[0], z[1])], z, [_beyond(z[-1], z[-2])]])
        values = np.pad(values, ((1, 1), (0, 1)))
    return contourpy.contour_generator(r, z, values).lines(0.5)


def regions(r_edges: np.ndarray, z_edges: np.ndarray, vof: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Areas in which vof is 1/2 or more, bounded by `outlines` and the edges of the mesh.

    Each is an array (n, 2) of r, z and the codes (n,) of a matplotlib path: an outline, and those of its holes.
    """
    import contourpy

    r, z = (np.concatenate([e[:1], 0.5 * (e[1:] + e[:-1]), e[-1:]]) for e in (r_edges, z_edges))
    generator = contourpy.contour_generator(r, z, np.pad(vof, 1, mode="edge"), fill_type="OuterCode")
    points, codes = generator.filled(0.5, np.inf)
    return list(zip(points, codes, strict=True))


def _beyond(edge: float, inside: float) -> float:
    """A point a hair outside of the mesh."""
    return edge + 1e-6 * (edge - inside)
