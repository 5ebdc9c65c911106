"""THE table of quantities that are written and drawn: name in files, unit, meaning, and how it follows from the state.

Names are for ever the same. All are cell values without ghosts, in SI units. A quantity of the mixture has shape
(nz, nr) or, for a vector (r, z, 0), (nz, nr, 3); a quantity per body has shape (m, nz, nr) and is written once for
every body. Where there is no material the value is zero.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

TINY = 1e-300


@dataclass(frozen=True)
class Quantity:
    """A row of the table. `title` holds {body} where the quantity is one of every body."""

    key: str
    title: str
    unit: str
    meaning: str
    evaluate: Callable[[object], np.ndarray]

    @property
    def per_body(self) -> bool:
        return "{body}" in self.title

    def name(self, body: str | None = None) -> str:
        """Name in files, with the unit: "Pressure [Pa]"; a number without unit has none."""
        title = self.title.format(body=body) if self.per_body else self.title
        return f"{title} [{self.unit}]" if self.unit else title


def _vof(sim) -> np.ndarray:
    return sim.grid.interior(sim.state.vof)


def _present(sim, values: np.ndarray) -> np.ndarray:
    """Values [m, j, i] without ghosts, zero where the body is not."""
    return np.where(_vof(sim) > 0, sim.grid.interior(values), 0.0)


def _density(sim) -> np.ndarray:
    return np.sum(_vof(sim) * _present(sim, sim.state.rho), axis=0)


def _by_volume(sim, values: np.ndarray) -> np.ndarray:
    """Sum over bodies of volume fraction times value: a stress of the mixture."""
    return np.sum(_vof(sim) * _present(sim, values), axis=0)


def _by_mass(sim, values: np.ndarray) -> np.ndarray:
    """Mean over bodies weighted by mass."""
    mass = _vof(sim) * _present(sim, sim.state.rho)
    return np.sum(mass * _present(sim, values), axis=0) / np.maximum(np.sum(mass, axis=0), TINY)


def _von_mises(sim) -> np.ndarray:
    rr, zz, rz = (_by_volume(sim, s) for s in (sim.state.srr, sim.state.szz, sim.state.srz))
    return np.sqrt(1.5 * (rr**2 + zz**2 + (rr + zz) ** 2 + 2 * rz**2))


def _hoop(sim) -> np.ndarray:
    return -_by_volume(sim, sim.state.srr) - _by_volume(sim, sim.state.szz)


def _cell_mean(sim, vertex: np.ndarray) -> np.ndarray:
    """Mean of the four vertices; where vertices carry several groups, weighted by the groups' masses."""
    if len(vertex) == 1:
        single = vertex[0]
    else:
        mass = sim.state.mass
        single = np.sum(mass * vertex, axis=0) / np.maximum(np.sum(mass, axis=0), TINY)
    v = sim.grid.interior_vertices(single)
    return 0.25 * ((v[:-1, :-1] + v[1:, 1:]) + (v[:-1, 1:] + v[1:, :-1]))


def _velocity(sim) -> np.ndarray:
    u, v = _cell_mean(sim, sim.state.u), _cell_mean(sim, sim.state.v)
    return np.stack([u, v, np.zeros_like(u)], axis=-1)


def _material(sim) -> np.ndarray:
    """1 + index of the body with the largest volume fraction; 0 where there is more void than anything else."""
    vof = _vof(sim)
    shares = np.concatenate([1 - np.sum(vof, axis=0, keepdims=True), vof])
    return np.argmax(shares, axis=0).astype(np.int32)


TABLE: tuple[Quantity, ...] = (
    Quantity("pressure", "Pressure", "Pa", "pressure of the cell, positive in compression",
             lambda sim: sim.grid.interior(sim.state.p)),
    Quantity("density", "Density", "kg/m3", "mass of all bodies per volume of the cell", _density),
    Quantity("velocity", "Velocity", "m/s", "mean of the four vertices, as the vector (r, z, 0)", _velocity),
    Quantity("energy", "Specific Internal Energy", "J/kg", "mean by mass over the bodies",
             lambda sim: _by_mass(sim, sim.state.e)),
    Quantity("temperature", "Temperature", "K", "mean by mass over the bodies",
             lambda sim: _by_mass(sim, sim.state.tm)),
    Quantity("von_mises", "Von Mises Stress", "Pa", "sqrt(3/2 s:s) of the stress deviator of the mixture", _von_mises),
    Quantity("stress_rr", "Deviatoric Stress rr", "Pa", "sum of volume fraction times deviator, radial",
             lambda sim: _by_volume(sim, sim.state.srr)),
    Quantity("stress_zz", "Deviatoric Stress zz", "Pa", "the same, axial", lambda sim: _by_volume(sim, sim.state.szz)),
    Quantity("stress_rz", "Deviatoric Stress rz", "Pa", "the same, shear", lambda sim: _by_volume(sim, sim.state.srz)),
    Quantity("stress_tt", "Deviatoric Stress tt", "Pa", "the same, hoop: minus the sum of rr and zz", _hoop),
    Quantity("plastic_strain", "Plastic Strain", "", "equivalent plastic strain, mean by mass over the bodies",
             lambda sim: _by_mass(sim, sim.state.ep)),
    Quantity("damage", "Damage", "", "0 intact, 1 failed; mean by mass over the bodies",
             lambda sim: _by_mass(sim, sim.state.dmg)),
    Quantity("material", "Material", "", "number of the body, from 1, that fills most of the cell; 0: void", _material),
    Quantity("volume_fraction", "Volume Fraction for {body}", "", "share of the cell that the body fills", _vof),
    Quantity("body_density", "Density of {body}", "kg/m3", "mass per volume of the body itself",
             lambda sim: _present(sim, sim.state.rho)),
    Quantity("body_pressure", "Pressure of {body}", "Pa", "pressure in the body",
             lambda sim: _present(sim, sim.state.pm)),
    Quantity("body_energy", "Specific Internal Energy of {body}", "J/kg", "specific internal energy of the body",
             lambda sim: _present(sim, sim.state.e)),
    Quantity("body_temperature", "Temperature of {body}", "K", "temperature of the body",
             lambda sim: _present(sim, sim.state.tm)),
    Quantity("body_plastic_strain", "Plastic Strain of {body}", "", "equivalent plastic strain of the body",
             lambda sim: _present(sim, sim.state.ep)),
    Quantity("body_damage", "Damage of {body}", "", "0 intact, 1 failed", lambda sim: _present(sim, sim.state.dmg)),
)  # fmt: skip

BY_KEY = {quantity.key: quantity for quantity in TABLE}

#: always written: without them a file shows no bodies
ALWAYS = ("volume_fraction", "material")


def evaluate(sim, keys=None) -> dict[str, np.ndarray]:
    """Values by file name of the quantities `keys` (None: all) and of those that are always written.

    Shapes (nz, nr) or (nz, nr, 3). Raises KeyError for an unknown key.
    """
    wanted = tuple(BY_KEY) if keys is None else tuple(dict.fromkeys((*keys, *ALWAYS)))
    values = {}
    for quantity in (BY_KEY[key] for key in wanted):
        array = quantity.evaluate(sim)
        if quantity.per_body:
            values.update({quantity.name(body): array[m] for m, body in enumerate(sim.table.names)})
        else:
            values[quantity.name()] = array
    return values
