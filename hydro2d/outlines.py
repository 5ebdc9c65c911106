"""Outlines of the bodies: lines along which a body fills half of a cell."""

from __future__ import annotations

import numpy as np


def outlines(r_edges: np.ndarray, z_edges: np.ndarray, vof: np.ndarray) -> list[np.ndarray]:
    """Contours of vof = 1/2 through the cell centres.

    r_edges (nr + 1,), z_edges (nz + 1,) in m, vof (nz, nr). The outermost values are carried on to the edges of the
    mesh, so that lines reach the axis and the boundary. Returns arrays (n, 2) of r, z.
    """
    import contourpy

    r, z = (np.concatenate([e[:1], 0.5 * (e[1:] + e[:-1]), e[-1:]]) for e in (r_edges, z_edges))
    return contourpy.contour_generator(r, z, np.pad(vof, 1, mode="edge")).lines(0.5)
