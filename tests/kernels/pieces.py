"""Kernels of the step, each by itself, over the whole active box of an engine in one part."""

from __future__ import annotations

import numpy as np

from hydro2d.kernels import boundaries, column_ranges, remap, vertex_forces
from hydro2d.kernels.contact import contact_motion
from tests.kernels.cells import handle


def rows(engine) -> np.ndarray:
    """The rows of the active box as one part."""
    return np.array(engine.box[:2], dtype=np.int64)


def ghost_vertices(engine) -> None:
    """Velocities beyond the edges of the mesh."""
    s, g, (_, _, i0, i1) = engine.state, engine.grid, engine.box
    low_r, high_r, low_z, high_z = engine.method.boundaries.having("mirrors")
    boundaries.ghost_vertices_r(0, handle(parts=rows(engine), nr=g.nr, mirror_r_min=low_r, mirror_r_max=high_r, u=s.u,
                                v=s.v))
    boundaries.ghost_vertices_z(0, handle(parts=rows(engine), i0=i0, i1=i1, nz=g.nz, mirror_z_min=low_z, mirror_z_max=high_z,
                                u=s.u, v=s.v))


def constrain(engine) -> None:
    """Sets the prescribed normal velocities of axis, walls and edges."""
    s = engine.state
    boundaries.constrain(0, handle(parts=rows(engine), constrained=engine.edges.constrained, pushing=engine.edges.pushing,
                         edge_velocity=engine.method.boundaries.velocity, mass=s.mass, u0=s.u0, v0=s.v0, u=s.u, v=s.v,
                         walls=s.walls))


def keep_one(engine) -> None:
    """At vertices where only one of two groups has a velocity, gives it to both groups of the state."""
    s, (_, _, i0, i1) = engine.state, engine.box
    contact_motion.keep_one(0, handle(parts=rows(engine), i0=i0, i1=i1, group_ranges=s.group_ranges, mass=s.mass, u=s.u,
                            v=s.v))


def sweep_faces(engine) -> None:
    """Volumes that the faces sweep in a step, from the velocities at its start and end."""
    s, g, (_, _, i0, i1) = engine.state, engine.grid, engine.box
    vertex_forces.swept_volumes(0, handle(parts=rows(engine), i0=i0, i1=i1, dt=engine.dt, metrics=g.metrics, dz=g.dz,
                               group_ranges=s.group_ranges, u0=s.u0, v0=s.v0, u=s.u, v=s.v, fr=s.fr, fz=s.fz))


def tidy(engine) -> None:
    """Tidies cells, mixed ones as they are now, as after the second sweep of a step."""
    s, g, numerics = engine.state, engine.grid, engine.method.numerics
    column_ranges.list_mixed(0, handle(parts=rows(engine), active_range=s.active_range, vof=s.vof, mixed_count=s.mixed_count,
                             mixed=s.mixed, scratch=s.scratch))
    remap.tidy(0, handle(parts=rows(engine), cutoff=numerics.cutoff, metrics=g.metrics, volume=g.volume, group=s.group,
               mixed_count=s.mixed_count, mixed=s.mixed, pre_sweep_volume=s.pre_sweep_volume, dj=0, di=1, fr=s.fr, fz=s.fz,
               second=True, u=s.u, v=s.v, vof=s.vof, q=s.q, cell_mass=s.cell_mass, removed=s.removed, centroid=s.centroid))
