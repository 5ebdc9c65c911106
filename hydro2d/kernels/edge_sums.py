"""Fluxes through the edges of the mesh in a sweep, summed along each edge for the audit."""

from hydro2d.jit import serial
from hydro2d.kernels.column_ranges import outer_rows


@serial
def sum_outflow(w):
    """Energy and mass that went through either edge of a sweep, out and in.

    Reads    edge_flux [side, k, m, j or i], towards higher r or z
    Writes   outflow [side, way, 1 + m]: energy, and mass of every body; way 0 out, 1 in
    """
    j0, j1 = outer_rows(w.parts)
    first, last = (j0, j1) if w.di == 1 else (w.i0, w.i1)
    for side in range(2):
        for k in range(w.outflow.shape[2]):
            w.outflow[side, 0, k], w.outflow[side, 1, k] = 0.0, 0.0
        for m in range(w.edge_flux.shape[2]):
            for place in range(first, last):
                mass = w.edge_flux[side, 0, m, place] if side == 1 else -w.edge_flux[side, 0, m, place]
                if mass != 0.0:
                    way = 0 if mass > 0.0 else 1
                    w.outflow[side, way, 1 + m] += mass
                    w.outflow[side, way, 0] += w.edge_flux[side, 1, m, place] if side == 1 else -w.edge_flux[side, 1, m, place]


@serial
def sum_kinetic_outflow(w):
    """Momentum and kinetic energy that went through either edge of a sweep, out and in.

    Reads    edge_dual [b, side, k, j or i], towards higher r or z
    Writes   kinetic_outflow [side, way, 2]: axial momentum and kinetic energy; way 0 out, 1 in
    """
    j0, j1 = outer_rows(w.parts)
    first, last = (j0, j1 + 1) if w.di == 1 else (w.i0, w.i1 + 1)
    for side in range(2):
        sign = 1.0 if side == 1 else -1.0
        for way in range(2):
            w.kinetic_outflow[side, way, 0], w.kinetic_outflow[side, way, 1] = 0.0, 0.0
        for g in range(w.edge_dual.shape[0]):
            for place in range(first, last):
                mass = sign * w.edge_dual[g, side, 0, place]
                if mass != 0.0:
                    way = 0 if mass > 0.0 else 1
                    w.kinetic_outflow[side, way, 0] += sign * w.edge_dual[g, side, 2, place]
                    w.kinetic_outflow[side, way, 1] += sign * (w.edge_dual[g, side, 3, place] + w.edge_dual[g, side, 4, place])
