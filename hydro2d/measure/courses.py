"""The course of every body: whether its centre of mass goes where its momentum takes it.

Momentum and velocities can be exact while the body itself moves at another speed, as a body narrower than a cell does if its
place in the cell is not known. No total shows this (explanation/sanity).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hydro2d.measure.doubt import Doubt
from hydro2d.mesh import sums

#: cells by which the centre of mass of a body may be off, and the share of its way, the larger of both
PARTED, PARTED_OF_WAY = 0.1, 0.02
#: share of the mass of a body in cells that it does not fill from which it is a film or a spray, and times its specific volume
#: at the start from which it is a cloud
FILM, CLOUD = 0.5, 10.0
FILM_SAID = "most of its mass is in cells that it does not fill"
CLOUD_SAID = f"it has more than {CLOUD:g} times the volume of the start"
AXES = "r", "z"
#: attributes of `Courses` in a restart file
KEPT = ("_start", "moved", "_momentum", "_way", "whole", "_thick", "_film", "_cloud", "_specific", "apart")
#: those that had other names in files of earlier versions
RENAMED = {"moved": "_moved", "whole": "_whole"}


class Courses:
    """The distance that every body's momentum has moved it since the start, compared with that of its centre of mass.

    The first moment of a body's mass changes by its momentum and by the material that crosses an edge of the mesh:
    d(sum m x)/dt = sum m v + (what comes in) x (where it comes in). The place of a body in a cell that it shares is its
    centroid, and it moves there with the interpolated velocity of the vertices. Its momentum is integrated by the
    trapezoidal rule from look to look.

    Parameters
    ----------
    state : State, as it is at the start

    Attributes
    ----------
    moved, whole : float64[m, 2] and [m], change of the first moments of each body's mass, and all of it that has been in the
        mesh, which the books of a cycle change by what crosses the edges (`hydro2d.kernels.between.books`)
    columns : float64[i], mean radii of the columns, m
    apart : float64[m, 2], offset of the centre of mass along r and z, in cells of the mean size where the body is; of all the
        mass of the body that has been in the mesh
    film, cloud : bool[m], which bodies have become a film or a spray, and a cloud

    A body that began at least three cells thick, and has less than half of its mass in cells that it fills, has become a film
    or a spray, and one with ten times its volume a cloud, for good: its place is that of its slivers, or of all that it has
    met, and no depth or velocity of a projectile follows from it.
    """

    def __init__(self, state):
        self.state, grid = state, state.grid
        g, n = grid.g, state.bodies
        inner, outer = grid.r[:-1], grid.r[1:]
        self._middle = 0.25 * (inner**2 + outer**2) if grid.cylindrical else grid.rc
        self.columns = np.sqrt(2.0 * self._middle) if grid.cylindrical else grid.rc
        self._sums = np.zeros((n, 9))
        self._shape = g, grid.nz, grid.nr, grid.cylindrical
        self._last = 0.0
        self._momentum = np.zeros((n, 2))
        self._start, self.moved, self._way, self.apart = (np.zeros((n, 2)) for _ in range(4))
        self.whole, self._begun = np.zeros(n), False
        self._thick, self._film, self._cloud = (np.zeros(n, dtype=bool) for _ in range(3))
        self.film, self.cloud, self._specific = self._film, self._cloud, np.zeros(n)

    def look(self, time: float, keep: bool = True) -> None:
        """Finds how far every body is off its course, from its momentum since the last look; first at the start.

        keep : whether later looks continue from this one. That at the end of a run is not kept, or a continued run would end
            with other sums than one without an interruption.
        """
        s, grid = self.state, self.state.grid
        for m in range(s.bodies):
            b = s.group[m]
            sums.body_course(*self._shape, m, self._middle, grid.vol_r, grid.zc, grid.dr, grid.dz, grid.cm_out,
                             grid.volume, s.vof, s.rho, s.centroid, s.u[b], s.v[b], self._sums[m])
        mass, moment, momentum, sizes = self._sums[:, :1], self._sums[:, 1:3], self._sums[:, 3:5], self._sums[:, 5:7]
        shared = self._sums[:, 7] > FILM * mass[:, 0]
        specific = np.divide(self._sums[:, 8], mass[:, 0], out=np.zeros(s.bodies), where=mass[:, 0] > 0.0)
        if not self._begun:
            self._start, self._begun = moment.copy(), True
            self.whole[:] = mass[:, 0]
            self._thick, self._specific = np.array([self._has_core(m) for m in range(s.bodies)]), specific
        else:
            step = 0.5 * (time - self._last) * (self._momentum + momentum)
            moved = self.moved + step
            there = (mass > 0.0) & np.ones(2, dtype=bool)  # a body that has left keeps its scale
            way = self._way + np.divide(np.abs(step), sizes, out=np.zeros_like(step), where=there)
            scale = self.whole[:, None] * np.divide(sizes, mass, out=np.ones_like(sizes), where=there)
            np.divide(moment - self._start - moved, scale, out=self.apart, where=there)
            self.film = self._film | (self._thick & shared)
            self.cloud = self._cloud | (specific > CLOUD * self._specific)
            if not keep:
                return
            self.moved[:] = moved
            self._way, self._film, self._cloud = way, self.film, self.cloud
        self._last, self._momentum = time, momentum.copy()

    def _has_core(self, m: int) -> bool:
        """Whether body m fills a cell and its four neighbours, those beyond the mesh included: it is three cells thick."""
        full = np.pad(self.state.grid.interior(self.state.vof)[m] == 1.0, 1, mode="edge")
        return bool((full[1:-1, 1:-1] & full[:-2, 1:-1] & full[2:, 1:-1] & full[1:-1, :-2] & full[1:-1, 2:]).any())

    def parted(self, names) -> Iterator[Doubt]:
        """A doubt for each body that is too far off its course, a note if it has become a film, a spray or a cloud."""
        for m, name in enumerate(names):
            for axis, off, way in zip(AXES, self.apart[m].tolist(), self._way[m].tolist(), strict=True):
                if abs(off) > max(PARTED, PARTED_OF_WAY * way):
                    yield Doubt(f"{name} off", (
                        f'body "{name}" is {abs(off):.2g} cells {"ahead of" if off > 0.0 else "behind"} where its momentum has '
                        f"taken its centre of mass along {axis}, after a way of {way:.3g} cells"),
                        FILM_SAID if self.film[m] else CLOUD_SAID if self.cloud[m] else "")

    def saved(self) -> dict:
        """Data for a restart file."""
        return {name: getattr(self, name).tolist() for name in KEPT} | {"last": self._last}

    def resume(self, saved: dict) -> None:
        """Continues from the result of `saved`."""
        for name in KEPT:
            stored = saved.get(name, saved.get(RENAMED.get(name, "")))
            if stored is None:  # files of earlier versions do not know films and clouds
                continue
            if name in RENAMED:
                getattr(self, name)[...] = stored
            else:
                setattr(self, name, np.array(stored))
        self.film, self.cloud = self._film, self._cloud
        self._last, self._begun = saved["last"], True

