"""Computes the written and drawn quantities (`materials/quantities.py`) from the state.

A quantity of the mixture has shape (nz, nr) or, for a vector (r, z, 0), (nz, nr, 3). A quantity per body has shape (m, nz, nr)
and is written once for each body. Values are zero where there is no material.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator

import numpy as np

from hydro2d.materials.quantities import BY_KEY, expand
from hydro2d.mesh.fields import INTERNAL
from strength.layout import INTACT, TENSION

TINY = 1e-300


def _sum_of_products(weights: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Sum over bodies of weights times values, arrays (m, nz, nr)."""
    total = weights[0] * values[0]
    for weight, value in zip(weights[1:], values[1:], strict=True):
        total += weight * value
    return total


class Cells:
    """The state of a simulation cell by cell, without ghost cells: arrays (m, nz, nr), zero where a body is absent."""

    def __init__(self, sim):
        self._sim = sim
        self.vof = np.ascontiguousarray(sim.grid.interior(sim.state.vof))
        self._there = self.vof > 0

    def __getattr__(self, name: str) -> np.ndarray:
        """rho, e, srr, szz, srz, ep or dmg of the state, computed once."""
        values = np.where(self._there, self._sim.grid.interior(getattr(self._sim.state, name)), 0.0)
        setattr(self, name, values)
        return values

    def internal(self, name: str) -> np.ndarray:
        """An internal variable of models, by the name of its field; zero for bodies whose model does not have it."""
        values = np.zeros_like(self.vof)
        for m, own in enumerate(self._sim.table.internal):
            for k, field in enumerate(own):
                if field.name == name:
                    values[m] = np.where(self._there[m], self._sim.grid.interior(self._sim.state.q[INTERNAL + k, m]), 0.0)
        return values

    @functools.cached_property
    def _thermal(self) -> tuple[np.ndarray, np.ndarray]:
        from hydro2d.materials import pressure_temperature

        return pressure_temperature.of(self._sim)

    @property
    def p(self) -> np.ndarray:
        """Pressure, Pa."""
        return self._thermal[0]

    @property
    def t(self) -> np.ndarray:
        """Temperature, K."""
        return self._thermal[1]

    @functools.cached_property
    def _mass(self) -> tuple[np.ndarray, np.ndarray]:
        """Mass per volume of each body, and of all bodies together; the latter is nowhere zero."""
        mass = self.vof * self.rho
        return mass, np.maximum(np.sum(mass, axis=0), TINY)

    def by_volume(self, values: np.ndarray) -> np.ndarray:
        """Sum over bodies of volume fraction times value, shape (nz, nr), as for a stress of the cell."""
        return _sum_of_products(self.vof, values)

    def by_mass(self, values: np.ndarray) -> np.ndarray:
        """Mean over bodies weighted by mass, shape (nz, nr)."""
        mass, total = self._mass
        return _sum_of_products(mass, values) / total

    def von_mises(self) -> np.ndarray:
        """sqrt(3/2 s:s) of the cell's deviator, hoop component included."""
        rr, zz, rz = (self.by_volume(s) for s in (self.srr, self.szz, self.srz))
        return np.sqrt(1.5 * (rr**2 + zz**2 + (rr + zz) ** 2 + 2 * rz**2))

    def velocity(self) -> np.ndarray:
        """Mean of the four vertices; with two body groups, the mass-weighted mean of both. Shape (nz, nr, 3)."""
        rest = self._vertex_mean(0)
        if self._sim.state.groups == 1:
            return rest
        mass, total = self._mass
        share = (np.sum(mass[self._sim.state.group == 1], axis=0) / total)[..., None]
        return np.where(share > 0, (1 - share) * rest + share * self._vertex_mean(1), rest)

    def group_velocity(self, b: int) -> np.ndarray:
        """Mean of the four vertices for body group b, zero where the group is absent; shape (nz, nr, 3)."""
        return np.where(self.group_share(b)[..., None] > 0, self._vertex_mean(b), 0.0)

    def group_share(self, b: int) -> np.ndarray:
        """Volume fraction of the bodies of group b, shape (nz, nr)."""
        return np.sum(self.vof[self._sim.state.group == b], axis=0)

    def _vertex_mean(self, b: int) -> np.ndarray:
        """Mean of the four vertices in the velocity field of body group b, shape (nz, nr, 3)."""
        u, v = self._sim.grid.vertex_mean(np.stack([self._sim.state.u[b], self._sim.state.v[b]]))
        return np.stack([u, v, np.zeros_like(u)], axis=-1)

    def centroid_r(self) -> np.ndarray:
        """Offset along r of the centroid of each body from that of the cell, m; 0 where it fills all or nothing."""
        grid, inner, outer = self._sim.grid, self._sim.grid.r_edges[:-1], self._sim.grid.r_edges[1:]
        offset = grid.interior(self._sim.state.centroid)[0]
        if not grid.cylindrical:
            return np.where(self._in_part, offset * (outer - inner), 0.0)
        square = 0.5 * (inner**2 + outer**2)
        off = np.sqrt(np.maximum(square + offset * (outer**2 - inner**2), 0.0)) - np.sqrt(square)
        return np.where(self._in_part, off, 0.0)

    def centroid_z(self) -> np.ndarray:
        """Offset along z of the centroid of each body from that of the cell, m; 0 where it fills all or nothing."""
        offset = self._sim.grid.interior(self._sim.state.centroid)[1]
        return np.where(self._in_part, offset * np.diff(self._sim.grid.z_edges)[:, None], 0.0)

    @functools.cached_property
    def _in_part(self) -> np.ndarray:
        return self._there & (self.vof < 1.0)

    def contact_pressure(self) -> np.ndarray:
        """Normal pressure at the contact interface in the cells that contain it, and zero elsewhere; Pa."""
        return self._sim.grid.interior(self._sim.state.contact_pressure).copy()

    @functools.cached_property
    def failed_by(self) -> np.ndarray:
        """What has ended the strength of each body (strength/layout.py), shape (m, nz, nr); 0 where it has strength.

        Of material that has failed the larger part counts: that which tension has broken, or that which damage has. Material
        that has not failed counts as broken by tension where half of its mass has parted.
        """
        table, inner = self._sim.table, self._sim.grid.interior
        causes = np.zeros(self.vof.shape, dtype=np.int32)
        for m, row in enumerate(table.record):
            if row:
                record, failed = inner(self._sim.state.q[row, m]), self.dmg[m] >= 1.0
                by_tension = np.where(failed, record > 0.0, record >= 0.5)
                causes[m] = np.where(by_tension, TENSION, np.where(failed, table.criterion[m], INTACT))
        return np.where(self._there, causes, INTACT)

    def failed_by_most(self) -> np.ndarray:
        """`failed_by` of the body that fills most of the cell; 0 where the void does. Shape (nz, nr)."""
        number = self.material()
        return np.where(number > 0, np.take_along_axis(self.failed_by, np.maximum(number - 1, 0)[None], axis=0)[0], INTACT)

    def material(self) -> np.ndarray:
        """1 + index of the body with the largest volume fraction; 0 where the void has the largest."""
        largest = 1 - np.sum(self.vof, axis=0)
        number = np.zeros(largest.shape, dtype=np.int32)
        for m, share in enumerate(self.vof):
            number[share > largest] = m + 1
            np.maximum(largest, share, out=largest)
        return number


#: the function that computes each quantity, by its key; internal variables of models are not listed
EVALUATE: dict[str, Callable[[Cells], np.ndarray]] = {
    "pressure": lambda c: c.by_volume(c.p),
    "density": lambda c: c.by_volume(c.rho),
    "velocity": Cells.velocity,
    "energy": lambda c: c.by_mass(c.e),
    "temperature": lambda c: c.by_mass(c.t),
    "von_mises": Cells.von_mises,
    "deviator_rr": lambda c: c.by_volume(c.srr),
    "deviator_zz": lambda c: c.by_volume(c.szz),
    "deviator_rz": lambda c: c.by_volume(c.srz),
    "deviator_tt": lambda c: -c.by_volume(c.srr + c.szz),
    "stress_rr": lambda c: c.by_volume(c.srr - c.p),
    "stress_zz": lambda c: c.by_volume(c.szz - c.p),
    "stress_tt": lambda c: -c.by_volume(c.srr + c.szz + c.p),
    "stress_rz": lambda c: c.by_volume(c.srz),
    "plastic_strain": lambda c: c.by_mass(c.ep),
    "damage": lambda c: c.by_mass(np.minimum(c.dmg, 1.0)),
    "failed_by": Cells.failed_by_most,
    "material": Cells.material,
    "velocity_hard": lambda c: c.group_velocity(1),
    "velocity_soft": lambda c: c.group_velocity(0),
    "hard_share": lambda c: c.group_share(1),
    "contact_pressure": Cells.contact_pressure,
    "volume_fraction": lambda c: c.vof,
    "centroid_r": Cells.centroid_r,
    "centroid_z": Cells.centroid_z,
    "body_density": lambda c: c.rho,
    "body_pressure": lambda c: c.p,
    "body_energy": lambda c: c.e,
    "body_temperature": lambda c: c.t,
    "body_plastic_strain": lambda c: c.ep,
    "body_damage": lambda c: np.minimum(c.dmg, 1.0),
    "body_failed_by": lambda c: c.failed_by,
}


def evaluated(sim, keys=("all",)) -> Iterator[tuple[str, np.ndarray]]:
    """Yields the name in the file and the values of each quantity in `keys`, and of those that are always written.

    Shapes are (nz, nr) or (nz, nr, 3). Contact quantities are omitted if there is no contact, and those of failure if the deck
    does not record it. Raises FieldError.
    """
    cells = Cells(sim)
    for quantity in (BY_KEY[key] for key in expand(keys)):
        if (quantity.contact and sim.state.groups == 1) or (quantity.recorded and not sim.table.records):
            continue
        values = cells.internal(quantity.key) if quantity.internal else EVALUATE[quantity.key](cells)
        if quantity.per_body:
            yield from ((quantity.name(body), values[m]) for m, body in enumerate(sim.table.names)
                        if not quantity.internal or quantity.key in {field.name for field in sim.table.internal[m]})
        else:
            yield quantity.name(), values


def evaluate(sim, keys=("all",)) -> dict[str, np.ndarray]:
    """All quantities of `evaluated` at once, by their names in the file."""
    return dict(evaluated(sim, keys))
