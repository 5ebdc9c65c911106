"""The conservation audit: every total, and every named sink through which a quantity left the mesh or the balance."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from hydro2d.mesh.sinks import SINKS
from hydro2d.mesh.sums import body_totals, vertex_totals

#: the sinks that are clips: limits of the method that take from material still in the mesh
CLIPS = {name: SINKS[name] for name in ("cutoff", "ke_bound", "speed_limit")}

#: the sinks through which energy comes in from outside, in addition to those of sources
BRINGS = ("inflow", "walls", "transmitted")

#: remedies for large clips, where runs have shown them (problems/classic/README.md)
REMEDIES = {"ke_bound": 'try numerics.advection = "both"'}

#: transfers of a contact within the balance: axial momentum from the hard bodies to the soft ones, and the heat produced
CONTACT_TRANSFERS = {
    "contact": "the impulse along the normal, and along the tangent, at contact nodes, where hard and soft bodies meet",
    "friction": "heat of the impulse along the tangent",
    "under-filled nodes": "heat of material that moves with its master nodes because there is too little of it",
}


def _number(place: int, meaning: str) -> property:
    """A number of a row."""
    return property(lambda self: float(self._row[place]), lambda self, value: self._row.__setitem__(place, value), doc=meaning)


class Transfer:
    """Axial momentum and heat that two groups have exchanged in one way; per radian (per unit depth in planar geometry).

    row : float64[2], where the numbers are
    """

    def __init__(self, row: np.ndarray):
        self._row = row

    momentum, energy = _number(0, "Axial momentum, N s."), _number(1, "Energy, J.")

    def saved(self) -> dict:
        """Data for a restart file."""
        return {"momentum": self.momentum, "energy": self.energy}


class Sink(Transfer):
    """Losses under one name: axial momentum, energy, mass per body; per radian (per unit depth in planar geometry).

    row : float64[2 + m], where the numbers are

    Attributes
    ----------
    mass : float64[m], kg
    """

    def __init__(self, row: np.ndarray):
        super().__init__(row)
        self.mass = row[2:]

    def saved(self) -> dict:
        """Data for a restart file."""
        return {"mass": self.mass.tolist(), **super().saved()}


@dataclass
class Totals:
    """Sums over the mesh: mass and internal energy per body [m], axial momentum, kinetic energy; per radian."""

    mass: np.ndarray
    momentum: float
    internal_of: np.ndarray
    kinetic: float

    @property
    def internal(self) -> float:
        return float(self.internal_of.sum())

    @property
    def energy(self) -> float:
        return self.internal + self.kinetic


def totals(state) -> Totals:
    """Totals of a state, with the interior cells and vertices only."""
    grid = state.grid
    size = grid.g, grid.nz, grid.nr
    bodies, vertices = np.zeros((state.bodies, 2)), np.zeros(2)
    for m in range(state.bodies):
        body_totals(*size, m, grid.volume, state.vof, state.rho, state.e, bodies[m])
    vertex_totals(*size, state.mass, state.u, state.v, vertices)
    momentum, kinetic = vertices.tolist()
    return Totals(mass=bodies[:, 0].copy(), momentum=momentum, internal_of=bodies[:, 1].copy(), kinetic=kinetic)


class Audit:
    """The totals at the start and the sinks since.

    Parameters
    ----------
    start : Totals
    noise : energy below which all sums are round-off of the stresses, J per radian: the last bit of m c^2, c the speed of sound
    names : of the sinks
    contact : whether there is a contact

    Attributes
    ----------
    amounts : float64[sinks, 2 + m], momentum, energy and mass of every body, which the books of a cycle add to
    exchanged : float64[3, 2], momentum and energy of the transfers of a contact
    sinks : name -> Sink
    contact_transfers : name -> Transfer, empty without contact
    """

    def __init__(self, start: Totals, noise: float, names: Iterable[str], contact: bool):
        self.start, self.noise, names = start, noise, list(names)
        self.amounts, self.exchanged = np.zeros((len(names), 2 + len(start.mass))), np.zeros((len(CONTACT_TRANSFERS), 2))
        self.sinks = dict(zip(names, map(Sink, self.amounts), strict=True))
        self.contact_transfers = dict(zip(CONTACT_TRANSFERS, map(Transfer, self.exchanged), strict=True)) if contact else {}

    @classmethod
    def open(cls, state, speeds: np.ndarray, own: Iterable[str] = ()) -> Audit:
        """An audit that begins with the state as it is.

        speeds : of sound in every body at rest, m/s, float64[m];  own : names of the sinks of its edges and sources, in
        addition to SINKS
        """
        start = totals(state)
        return cls(start, _noise(start, speeds), (*SINKS, *own), state.groups > 1)

    def add(self, name: str, mass: np.ndarray | None = None, momentum: float = 0.0, energy: float = 0.0) -> None:
        """Adds to a sink a loss from the totals; mass per body [m]."""
        sink = self.sinks[name]
        if mass is not None:
            sink.mass += mass
        sink.momentum += momentum
        sink.energy += energy

    @property
    def came(self) -> float:
        """Energy that edges and sources have brought since the start, J per radian."""
        return self._brought((*BRINGS, *(name for name in self.sinks if name not in SINKS)))

    @property
    def worked(self) -> float:
        """Work of edges and energy of sources since the start, J per radian: all incoming energy except inflow."""
        return self.came - self._brought(("inflow",))

    def _brought(self, names: Iterable[str]) -> float:
        """Energy that has come in through sinks, J per radian."""
        return -sum(min(self.sinks[name].energy, 0.0) for name in names)

    @property
    def scale(self) -> float:
        """Energy at the start plus incoming energy since, at least `noise`, J per radian."""
        return max(abs(self.start.energy), self.start.kinetic, self.noise) + self.came

    def _unexplained(self, now: Totals) -> tuple[np.ndarray, float, float]:
        """Relative changes of the mass of every body, of momentum and of energy that no sink explains."""
        lost = {kind: sum(getattr(sink, kind) for sink in self.sinks.values()) for kind in ("mass", "momentum", "energy")}
        whole = np.maximum(self.start.mass - self.sinks["inflow"].mass, 1e-300)
        return ((now.mass + lost["mass"] - self.start.mass) / whole,
                (now.momentum + lost["momentum"] - self.start.momentum) / (2.0 * self.start.mass.sum() * self.scale) ** 0.5,
                (now.energy + lost["energy"] - self.start.energy) / self.scale)

    def unexplained(self, now: Totals) -> dict[str, float]:
        """Relative changes that no sink explains, by name: of momentum, of energy, and the largest of mass."""
        mass, momentum, energy = self._unexplained(now)
        return {"mass": float(mass[np.argmax(np.abs(mass))]), "axial momentum": momentum, "energy": energy}

    def balance(self, state) -> dict:
        """Relative changes that no sink explains, and the sinks; SI, full circumference in cylindrical geometry."""
        now, around = totals(state), 2 * np.pi if state.grid.cylindrical else 1.0
        mass, momentum, energy = self._unexplained(now)
        return {
            "mass": mass,
            "axial_momentum": momentum,
            "total_energy": energy,
            "internal_energy_J": now.internal * around,
            "kinetic_energy_J": now.kinetic * around,
            "start_energy_J": self.start.energy * around,
            "sinks": {
                name: {
                    "mass_kg": float(sink.mass.sum() * around),
                    "momentum_N_s": sink.momentum * around,
                    "energy_J": sink.energy * around,
                }
                for name, sink in self.sinks.items()
            },
            "contact_transfers": {
                name: {"momentum_N_s": entry.momentum * around, "energy_J": entry.energy * around}
                for name, entry in self.contact_transfers.items()
            },
        }

    def saved(self) -> dict:
        """Data for a restart file."""
        return {
            "start": {**vars(self.start), "mass": self.start.mass.tolist(), "internal_of": self.start.internal_of.tolist()},
            "sinks": {name: sink.saved() for name, sink in self.sinks.items()},
            "contact_transfers": {name: entry.saved() for name, entry in self.contact_transfers.items()},
        }

    @classmethod
    def resume(cls, saved: dict, speeds: np.ndarray) -> Audit:
        """The audit that `saved` described; speeds as for `open`."""
        arrays = {name: np.array(saved["start"][name]) for name in ("mass", "internal_of")}
        start = Totals(**{**saved["start"], **arrays})
        audit = cls(start, _noise(start, speeds), saved["sinks"], bool(saved["contact_transfers"]))
        for name, entry in saved["sinks"].items():
            audit.add(name, np.array(entry["mass"]), entry["momentum"], entry["energy"])
        for name, entry in saved["contact_transfers"].items():
            audit.contact_transfers[name].momentum, audit.contact_transfers[name].energy = entry["momentum"], entry["energy"]
        return audit


def _noise(start: Totals, speeds: np.ndarray) -> float:
    """The last bit of the sum of m c^2 over the bodies, J per radian; speeds : of sound, m/s, float64[m]."""
    return float(np.finfo(float).eps * np.sum(start.mass * speeds**2))
