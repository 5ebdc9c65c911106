"""Debris behind a target: its mass, momentum and speeds, the angles of its flight, and its fragments."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hydro2d.measure.result import Number, Result, result
from hydro2d.mesh.sums import HALF
from hydro2d.physics.centroids import CRUMB

#: results for each fragment with their units
FRAGMENTS = ("mass_kg", "r_m", "z_m", "velocity_r_m_s", "velocity_z_m_s")
#: bins of the axial speed, and of the angle to the axis, 5 degrees each
SPEEDS, ANGLES = 40, 36
#: the share of the mass that flies within the cone, and the share that is faster than the leading velocity
CONE, LEADING = 0.9, 0.01


class Cloud(Result):
    """Everything that flies behind a target, the projectile included. SI, whole circumference."""

    mass_kg: Number = result("mass of all bodies")
    momentum_N_s: Number = result(
        "axial momentum along the flight of the projectile, relative to the undisturbed target, as all below")
    kinetic_energy_J: Number = result("kinetic energy, including the radial motion")
    velocity_m_s: Number = result("mean axial velocity, by mass; null if there is no debris")
    leading_velocity_m_s: Number = result("axial velocity that a hundredth of the mass exceeds")
    cone_angle_rad: Number = result("angle to the axis within which nine tenths of the mass fly")
    fragments: int | None = result(
        "number of pieces, each of connected cells that are filled by half, or by less if it is narrower than a cell; one "
        "off the axis is a ring")
    largest_fragment_kg: Number = result("mass of the heaviest of them")
    dust_kg: Number = result("mass in none of them: in cells next to them that are filled by less than half, and crumbs")


class Debris(NamedTuple):
    """Debris behind a target. Arrays by body have a column for each name in ``bodies``; SI, whole circumference.

    bodies : those that it is made of
    speeds, by_speed : edges of the bins of axial speed along the flight (n + 1,), and the mass in them (n, bodies)
    angles, by_angle : edges of the bins of the angle to the axis, rad (n + 1,), and the mass in them (n, bodies)
    fragments : FRAGMENTS of each, (k, 5), the heaviest first;  kinds : number in ``bodies`` of the main body of each, (k,)
    totals : sums over all of it
    """

    bodies: list[str]
    speeds: np.ndarray
    by_speed: np.ndarray
    angles: np.ndarray
    by_angle: np.ndarray
    fragments: np.ndarray
    kinds: np.ndarray
    totals: Cloud

    @property
    def momentum(self) -> float:
        """Axial momentum along the flight, N s, whole circumference."""
        return self.totals.momentum_N_s or 0.0


def find(sim, crater, later: list[int]) -> Debris:
    """Debris behind the target of a crater, including the projectile, except in and next to cells of the target's pieces.

    crater : Crater of the target
    later : indices of the targets that the projectile meets after it; they are not debris

    Each cell has the velocity of its body group, the mean of its four vertices. Momentum, energy, speeds and angles
    are relative to the target as it would move if nothing had touched it; fragments have velocities in the frame of the mesh.
    They are those of `_pieces`, in cylindrical geometry rings unless they reach the axis. Bodies that touch are one fragment.
    """
    grid, state, table = sim.grid, sim.state, sim.table
    around = 2.0 * np.pi if grid.cylindrical else 1.0
    chosen = [m for m in range(len(table.names)) if m not in later]
    behind = crater.beyond()
    fraction = np.where(behind, grid.interior(state.vof)[chosen], 0.0)
    fraction[chosen.index(crater.m)] *= ~crater.pieces()
    mass = fraction * np.where(fraction > 0.0, grid.interior(state.rho)[chosen], 0.0) * (grid.volume[grid.inside] * around)
    u, v = (np.stack([grid.vertex_mean(field[state.group[m]]) for m in chosen]) for field in (state.u, state.v))
    axial = crater.direction * (v - crater.target.velocity)
    present = [k for k in range(len(chosen)) if mass[k].any()]
    mass, u, v, axial, fraction = mass[present], u[present], v[present], axial[present], fraction[present]
    labels, count = _pieces(fraction.sum(axis=0)) if present else (np.zeros((grid.nz, grid.nr), dtype=int), 0)
    fragments, kinds = _fragments(grid, labels, count, mass, u, v)
    top = float(axial.max(where=mass > 0.0, initial=0.0))
    speeds = np.linspace(float(axial.min(where=mass > 0.0, initial=0.0)), top if top > 0.0 else 1.0, SPEEDS + 1)
    angles = np.linspace(0.0, np.pi, ANGLES + 1)
    angle = np.arctan2(np.abs(u), axial)
    return Debris(
        [table.names[chosen[k]] for k in present], speeds, _binned(axial, mass, speeds), angles, _binned(angle, mass, angles),
        fragments, kinds, _totals(mass, u, axial, angle, fragments),
    )


def _pieces(filled: np.ndarray) -> tuple[np.ndarray, int]:
    """Number of the fragment of each cell (nz, nr), 0 in none, and the number of fragments; filled : by debris, shape (nz, nr).

    A fragment is a set of cells, joined by faces, that are filled by half or more. One that is narrower than a cell may have
    no such cell: a set of cells filled by CRUMB or more, none of them by half, is a fragment as well.
    """
    from scipy import ndimage

    labels, thick = ndimage.label(filled >= HALF)
    loose, count = ndimage.label(filled >= CRUMB)
    most = ndimage.maximum(filled, loose, np.arange(1, count + 1))
    thin = np.nonzero(np.asarray(most) < HALF)[0] + 1
    numbers = np.zeros(count + 1, dtype=labels.dtype)
    numbers[thin] = thick + 1 + np.arange(len(thin))
    return np.where(labels > 0, labels, numbers[loose]), thick + len(thin)


def _binned(values: np.ndarray, mass: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Mass of each body in bins of a quantity, (n, bodies)."""
    histograms = [np.histogram(one.ravel(), edges, weights=weight.ravel())[0] for one, weight in zip(values, mass, strict=True)]
    return np.stack(histograms, axis=1) if histograms else np.zeros((len(edges) - 1, 0))


def _fragments(grid, labels: np.ndarray, count: int, mass: np.ndarray, u: np.ndarray, v: np.ndarray):
    """FRAGMENTS of each label, the heaviest first, (count, 5), and the body that each is mostly made of, (count,)."""
    r, z = np.meshgrid(grid.rc[grid.inside[1]], grid.zc[grid.inside[0]])
    flat, whole = labels.ravel(), mass.sum(axis=0) if len(mass) else np.zeros(labels.shape)

    def total(weights: np.ndarray) -> np.ndarray:
        return np.bincount(flat, weights.ravel(), count + 1)[1:]

    own = total(whole)
    sums = [total(whole * r), total(whole * z), total((mass * u).sum(axis=0)), total((mass * v).sum(axis=0))]
    order = np.argsort(-own, kind="stable")
    fragments = np.column_stack([own, *(each / np.maximum(own, 1e-300) for each in sums)])[order]
    kinds = np.argmax([total(each) for each in mass], axis=0)[order] if len(mass) else np.zeros(0, dtype=int)
    return fragments.reshape(-1, len(FRAGMENTS)), kinds


def _totals(mass: np.ndarray, u: np.ndarray, axial: np.ndarray, angle: np.ndarray, fragments: np.ndarray) -> Cloud:
    """The sums over all debris."""
    total = float(mass.sum())
    momentum = float((mass * axial).sum())
    return Cloud(
        mass_kg=total,
        momentum_N_s=momentum,
        kinetic_energy_J=0.5 * float((mass * (u**2 + axial**2)).sum()),
        velocity_m_s=momentum / total if total > 0.0 else None,
        leading_velocity_m_s=_quantile(axial, mass, 1.0 - LEADING),
        cone_angle_rad=_quantile(angle, mass, CONE),
        fragments=len(fragments),
        largest_fragment_kg=float(fragments[0, 0]) if len(fragments) else None,
        dust_kg=total - float(fragments[:, 0].sum()),
    )


def _quantile(values: np.ndarray, mass: np.ndarray, share: float) -> float | None:
    """The value that this share of the mass does not exceed; None if there is no mass."""
    there = mass > 0.0
    if not there.any():
        return None
    values, mass = values[there], mass[there]
    order = np.argsort(values, kind="stable")
    below = np.cumsum(mass[order])
    return float(values[order][min(int(np.searchsorted(below, share * below[-1])), len(below) - 1)])
