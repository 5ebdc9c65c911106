"""Kernels of the step, each by itself, for the whole active box of an engine in one part."""

from __future__ import annotations

import numpy as np

from hydro2d.kernels import acceleration, boundaries, column_ranges, contact_motion, remap


def rows(engine) -> np.ndarray:
    """The rows of the active box as one part."""
    return np.array(engine.box[:2], dtype=np.int64)


def ghost_vertices(engine) -> None:
    """Velocities beyond the edges of the mesh."""
    s, g, (_, _, i0, i1) = engine.state, engine.grid, engine.box
    low_r, high_r, low_z, high_z = engine.method.boundaries.having("mirrors")
    boundaries.ghost_vertices_r(0, rows(engine), g.nr, low_r, high_r, s.u, s.v)
    boundaries.ghost_vertices_z(0, rows(engine), i0, i1, g.nz, low_z, high_z, s.u, s.v)


def constrain(engine) -> None:
    """The given normal velocities of axis, walls and edges."""
    s = engine.state
    boundaries.constrain(0, rows(engine), engine.constrained, engine.pushing, engine.method.boundaries.velocity, s.mass, s.u0,
                         s.v0, s.u, s.v, s.walls)


def keep_one(engine) -> None:
    """The one velocity of vertices that one of two groups has: both groups of the state are given it."""
    s, (_, _, i0, i1) = engine.state, engine.box
    contact_motion.keep_one(0, rows(engine), i0, i1, s.group_ranges, s.mass, s.u, s.v)


def sweep_faces(engine) -> None:
    """Volumes that the faces sweep in a step, by the velocities at both of its ends."""
    s, g, (_, _, i0, i1) = engine.state, engine.grid, engine.box
    acceleration.swept_volumes(0, rows(engine), i0, i1, engine.dt, g.metrics, g.dz, s.group_ranges, s.u0, s.v0, s.u, s.v, s.fr,
                               s.fz)


def tidy(engine) -> None:
    """Tidies cells, mixed ones as they are now, as after the second sweep of a step."""
    s, g, method = engine.state, engine.grid, engine.method
    column_ranges.list_mixed(0, rows(engine), s.active_range, s.vof, s.mixed_count, s.mixed, s.scratch)
    remap.tidy(0, rows(engine), method.cutoff, g.metrics, g.volume, s.group, s.mixed_count, s.mixed, s.pre, 0, 1, s.fr, s.fz,
               True, s.u, s.v, s.vof, s.q, s.cell_mass, s.removed, s.centroid)
