"""THE table of quantities that are written and drawn: name in files, unit, meaning, and how it follows from the state.

Names are for ever the same. All are cell values without ghosts, in SI units. A quantity of the mixture has shape
(nz, nr) or, for a vector (r, z, 0), (nz, nr, 3); a quantity per body has shape (m, nz, nr) and is written once for
every body. Where there is no material the value is zero.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from hydro2d.errors import unknown
from hydro2d.mesh.fields import INTERNAL, Field
from strength.dispatch import STRENGTH_MODULES

TINY = 1e-300


class FieldError(Exception):
    """A field that there is not; the message is for the user."""


def _sum_of_products(weights: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Sum over bodies of weights times values, arrays (m, nz, nr)."""
    total = weights[0] * values[0]
    for weight, value in zip(weights[1:], values[1:], strict=True):
        total += weight * value
    return total


class Cells:
    """The state of a simulation cell by cell, without ghosts: arrays (m, nz, nr), zero where the body is not."""

    def __init__(self, sim):
        self._sim = sim
        self.vof = np.ascontiguousarray(sim.grid.interior(sim.state.vof))
        self._there = self.vof > 0

    def __getattr__(self, name: str) -> np.ndarray:
        """rho, e, srr, szz, srz, ep or dmg of the state; computed once."""
        values = np.where(self._there, self._sim.grid.interior(getattr(self._sim.state, name)), 0.0)
        setattr(self, name, values)
        return values

    def internal(self, name: str) -> np.ndarray:
        """An internal variable of strength models, by the name of its field; zero for bodies whose model has none such."""
        values = np.zeros_like(self.vof)
        for m, own in enumerate(self._sim.table.internal):
            for k, field in enumerate(own):
                if field.name == name:
                    values[m] = np.where(self._there[m], self._sim.grid.interior(self._sim.state.q[INTERNAL + k, m]), 0.0)
        return values

    @functools.cached_property
    def _thermal(self) -> tuple[np.ndarray, np.ndarray]:
        from hydro2d.materials import thermal

        return thermal.of(self._sim)

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
        """Mass per volume of every body, and of all of them, which is nowhere zero."""
        mass = self.vof * self.rho
        return mass, np.maximum(np.sum(mass, axis=0), TINY)

    def by_volume(self, values: np.ndarray) -> np.ndarray:
        """Sum over bodies of volume fraction times value, shape (nz, nr): a stress of the cell."""
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
        """Mean of the four vertices, and with two body groups the mean of both weighted by mass; shape (nz, nr, 3)."""
        rest = self._vertex_mean(0)
        if self._sim.state.groups == 1:
            return rest
        mass, total = self._mass
        share = (np.sum(mass[self._sim.state.group == 1], axis=0) / total)[..., None]
        return np.where(share > 0, (1 - share) * rest + share * self._vertex_mean(1), rest)

    def group_velocity(self, b: int) -> np.ndarray:
        """Mean of the four vertices of body group b, zero where nothing of the group is; shape (nz, nr, 3)."""
        return np.where(self.group_share(b)[..., None] > 0, self._vertex_mean(b), 0.0)

    def group_share(self, b: int) -> np.ndarray:
        """Share of the cell that the bodies of group b fill, shape (nz, nr)."""
        return np.sum(self.vof[self._sim.state.group == b], axis=0)

    def _vertex_mean(self, b: int) -> np.ndarray:
        """Mean velocity of the four vertices in the field of body group b, shape (nz, nr, 3)."""
        w = self._sim.grid.interior_vertices(np.stack([self._sim.state.u[b], self._sim.state.v[b]]))
        u, v = 0.25 * ((w[:, :-1, :-1] + w[:, 1:, 1:]) + (w[:, :-1, 1:] + w[:, 1:, :-1]))
        return np.stack([u, v, np.zeros_like(u)], axis=-1)

    def contact_pressure(self) -> np.ndarray:
        """Normal pressure at the interface of a contact in cells that hold it, else zero; Pa."""
        return self._sim.grid.interior(self._sim.state.contact_pressure).copy()

    def material(self) -> np.ndarray:
        """1 + index of the body with the largest volume fraction; 0 where there is more void than anything else."""
        largest = 1 - np.sum(self.vof, axis=0)
        number = np.zeros(largest.shape, dtype=np.int32)
        for m, share in enumerate(self.vof):
            number[share > largest] = m + 1
            np.maximum(largest, share, out=largest)
        return number


@dataclass(frozen=True)
class Quantity:
    """A row of the table. `title` holds {body} where the quantity is one of every body; one of `contact` is written only
    where there are two body groups, an `internal` one only for bodies whose strength model has the variable."""

    key: str
    title: str
    unit: str
    meaning: str
    evaluate: Callable[[Cells], np.ndarray]
    contact: bool = False
    internal: bool = False

    @property
    def per_body(self) -> bool:
        return "{body}" in self.title

    def name(self, body: str | None = None) -> str:
        """Name in files, with the unit: "Pressure [Pa]"; a number without unit has none."""
        title = self.title.format(body=body) if self.per_body else self.title
        return f"{title} [{self.unit}]" if self.unit else title


def _internal(field: Field) -> Quantity:
    """The row of an internal variable of a strength model: back_stress_rr is "Back Stress rr of ..."."""
    words = [word if len(word) < 3 else word.capitalize() for word in field.name.split("_")]
    return Quantity(field.name, f"{' '.join(words)} of {{body}}", "" if field.unit == "1" else field.unit, field.meaning,
                    functools.partial(Cells.internal, name=field.name), internal=True)


#: the internal variables that strength models declare, each name once
_INTERNAL = {field.name: _internal(field) for module in STRENGTH_MODULES for field in getattr(module, "INTERNAL", ())
             if field.written}

TABLE: tuple[Quantity, ...] = (
    Quantity("pressure", "Pressure", "Pa", "sum of volume fraction times pressure; positive in compression",
             lambda c: c.by_volume(c.p)),
    Quantity("density", "Density", "kg/m3", "mass of all bodies per volume of the cell", lambda c: c.by_volume(c.rho)),
    Quantity("velocity", "Velocity", "m/s", "mean of the four vertices, as the vector (r, z, 0); mean by mass of both "
             "velocities of a contact", Cells.velocity),
    Quantity("energy", "Specific Internal Energy", "J/kg", "mean by mass over the bodies", lambda c: c.by_mass(c.e)),
    Quantity("temperature", "Temperature", "K", "mean by mass over the bodies", lambda c: c.by_mass(c.t)),
    Quantity("von_mises", "Von Mises Stress", "Pa", "sqrt(3/2 s:s) of the stress deviator of the cell",
             Cells.von_mises),
    Quantity("stress_rr", "Deviatoric Stress rr", "Pa", "sum of volume fraction times deviator, radial",
             lambda c: c.by_volume(c.srr)),
    Quantity("stress_zz", "Deviatoric Stress zz", "Pa", "the same, axial", lambda c: c.by_volume(c.szz)),
    Quantity("stress_rz", "Deviatoric Stress rz", "Pa", "the same, shear", lambda c: c.by_volume(c.srz)),
    Quantity("stress_tt", "Deviatoric Stress tt", "Pa", "the same, hoop: minus the sum of rr and zz",
             lambda c: -c.by_volume(c.srr + c.szz)),
    Quantity("plastic_strain", "Plastic Strain", "", "equivalent plastic strain, mean by mass over the bodies",
             lambda c: c.by_mass(c.ep)),
    Quantity("damage", "Damage", "", "0 intact, 1 failed; mean by mass over the bodies", lambda c: c.by_mass(c.dmg)),
    Quantity("material", "Material", "", "number of the body, from 1, that fills most of the cell; 0: void",
             Cells.material),
    Quantity("velocity_hard", "Velocity of Hard Bodies", "m/s", "that of the hard bodies in a contact, as the vector (r, z, 0)",
             lambda c: c.group_velocity(1), contact=True),
    Quantity("velocity_rest", "Velocity of the Rest", "m/s", "that of the other bodies in a contact, as the vector (r, z, 0)",
             lambda c: c.group_velocity(0), contact=True),
    Quantity("hard_share", "Share of Hard Bodies", "", "share of the cell that the hard bodies of a contact fill",
             lambda c: c.group_share(1), contact=True),
    Quantity("contact_pressure", "Contact Pressure", "Pa", "normal pressure at the interface of a contact, in its cells",
             Cells.contact_pressure, contact=True),
    Quantity("volume_fraction", "Volume Fraction for {body}", "", "share of the cell that the body fills",
             lambda c: c.vof),
    Quantity("body_density", "Density of {body}", "kg/m3", "mass per volume of the body itself", lambda c: c.rho),
    Quantity("body_pressure", "Pressure of {body}", "Pa", "pressure in the body", lambda c: c.p),
    Quantity("body_energy", "Specific Internal Energy of {body}", "J/kg", "specific internal energy of the body",
             lambda c: c.e),
    Quantity("body_temperature", "Temperature of {body}", "K", "temperature of the body", lambda c: c.t),
    Quantity("body_plastic_strain", "Plastic Strain of {body}", "", "equivalent plastic strain of the body",
             lambda c: c.ep),
    Quantity("body_damage", "Damage of {body}", "", "0 intact, 1 failed", lambda c: c.dmg),
    *_INTERNAL.values(),
)  # fmt: skip

BY_KEY = {quantity.key: quantity for quantity in TABLE}

#: always written: without them a file shows no bodies
ALWAYS = ("volume_fraction", "material")

#: words that stand for several quantities
GROUPS = {
    "all": tuple(BY_KEY),
    "standard": tuple(key for key in BY_KEY if key not in ("body_pressure", "body_energy", "body_damage", *_INTERNAL)),
}


def expand(keys) -> tuple[str, ...]:
    """Keys of TABLE for keys and words of GROUPS, with ALWAYS, each once. Raises FieldError for an unknown one."""
    expanded: list[str] = []
    for key in keys:
        if key not in GROUPS and key not in BY_KEY:
            raise FieldError(unknown("field", key, (*GROUPS, *BY_KEY)))
        expanded += GROUPS[key] if key in GROUPS else [key]
    return tuple(dict.fromkeys((*expanded, *ALWAYS)))


def evaluated(sim, keys=("all",)) -> Iterator[tuple[str, np.ndarray]]:
    """File name and values, one after the other, of the quantities `keys` and of those that are always written.

    Shapes (nz, nr) or (nz, nr, 3). Those of a contact are left out where there is none. Raises FieldError.
    """
    cells = Cells(sim)
    for quantity in (BY_KEY[key] for key in expand(keys)):
        if quantity.contact and sim.state.groups == 1:
            continue
        values = quantity.evaluate(cells)
        if quantity.per_body:
            yield from ((quantity.name(body), values[m]) for m, body in enumerate(sim.table.names)
                        if not quantity.internal or quantity.key in {field.name for field in sim.table.internal[m]})
        else:
            yield quantity.name(), values


def evaluate(sim, keys=("all",)) -> dict[str, np.ndarray]:
    """The same, all at once, by file name."""
    return dict(evaluated(sim, keys))
