"""Ejecta: what flies back from the front face of a target, and how much more momentum the target has from it."""

from __future__ import annotations

import numpy as np

from hydro2d.measure.result import Number, Result, result
from hydro2d.measure.wall_damage import DETACHED_SPALL, PERFORATED

#: share of the projectile's momentum that may fly behind the target without a momentum multiplication taking account of it
IGNORED = 0.01


class Ejected(Result):
    """What flies back from a target. SI, whole circumference."""

    mass_kg: Number = result(
        "mass of target and projectile before its original front face that moves away from it, or has left the mesh so")
    momentum_N_s: Number = result(
        "axial momentum of that mass, against the flight of the projectile and relative to the undisturbed target")
    velocity_m_s: Number = result("mean axial velocity, in the same sense; null if there are no ejecta")
    momentum_multiplication: Number = result(
        "beta: 1 + this momentum over that of the projectile at the start, relative to the target; null before the impact, "
        "for later targets, with a hole or detached spall, where debris behind has over a hundredth of the projectile's "
        "momentum, and once a travelling mesh has left the face behind")


class Ejecta:
    """Measures what flies back from a target.

    It consists of the material of the target and of the projectile in cells whose middle is before the target's original front
    face, where it moves away from the target as it would be if nothing had touched it: crater lip and rebounding projectile
    included. Material that has left the mesh there in such motion counts as well. Each cell has the velocity of its body group,
    the mean of its four vertices. The momentum counts against the flight of the projectile.

    Parameters
    ----------
    sim : Simulation
    crater : Crater of the target
    m : index of the projectile
    gone : float64[3], mass and momentum that have left the mesh before the face, and mass of the target behind its rear, which
        the books of a cycle add to (`hydro2d.kernels.between.books`)
    """

    def __init__(self, sim, crater, m: int, gone: np.ndarray):
        self.sim, self._crater = sim, crater
        self._bodies = (crater.m, m)
        self._gone = gone

    @property
    def lost(self) -> float:
        """Mass of the target that has left the mesh beyond its original rear face, kg, whole circumference."""
        return float(self._gone[2]) * self._around

    @property
    def _around(self) -> float:
        return 2.0 * np.pi if self.sim.grid.cylindrical else 1.0

    def measure(self, damage: str | None, behind: float) -> Ejected:
        """What flies back now; SI, whole circumference.

        damage : class of the target's damage;  behind : axial momentum of the debris behind it, N s
        """
        crater, totals = self._crater, self._gone[:2] * self._around
        for m in self._bodies:
            mass, velocity = crater.masses(m, crater.before())
            away = crater.direction * (crater.target.velocity - velocity)
            mass = np.where(away > 0.0, mass, 0.0)
            totals += mass.sum(), (mass * away).sum()
        mass, momentum = totals.tolist()
        whole = self._is_all(behind) and damage not in (PERFORATED, DETACHED_SPALL)
        multiplication = 1.0 + momentum / self.sim.penetrator.impact_momentum if whole else None
        return Ejected(mass_kg=mass, momentum_N_s=momentum, velocity_m_s=momentum / mass if mass > 0.0 else None,
                       momentum_multiplication=multiplication)

    def _is_all(self, behind: float) -> bool:
        """Whether the target has received the momentum of the projectile and that of the ejecta, and nothing else."""
        penetrator, crater = self.sim.penetrator, self._crater
        start, shows_face = penetrator.impact_momentum, crater.depth(self.sim.grid.z_edges).min() < 0.0
        if not (start > 0.0 and shows_face and penetrator.has_struck) or crater.m != penetrator.targets[0].m:
            return False
        return abs(behind) <= IGNORED * start

    def saved(self) -> list[float]:
        """Data for a restart file."""
        return self._gone.tolist()

    def resume(self, saved: list[float]) -> None:
        """Continues from the result of `saved`."""
        self._gone[:] = saved
