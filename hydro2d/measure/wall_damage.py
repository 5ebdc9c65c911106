"""The damage of a target as that of a wall: perforated, spalled with the spall detached or attached, or none."""

from __future__ import annotations

import numpy as np

from hydro2d.measure.crater import Hole
from hydro2d.measure.penetrator import LEFT_MASS
from hydro2d.mesh.sums import HALF
from hydro2d.physics.centroids import CRUMB

#: classes of damage, the worst first
PERFORATED, DETACHED_SPALL, ATTACHED_SPALL, NO_DAMAGE = "perforated", "detached spall", "attached spall", "none"
#: a piece of fewer cells, filled by half or more, is debris and no spall
FEWEST_CELLS = 4
#: share of the thickness by which the rear of a sound wall may bulge
BULGE = 0.5
#: share of void from which a cell counts as cracked
OPEN = 0.05


def classify(sim, crater, hole: Hole, lost: float) -> str | None:
    """The class of the damage, see `summary.Target`; the first that applies:

    * perforated: the hole is open right through;
    * detached spall: a piece of the target of FEWEST_CELLS or more, not connected to the largest one, flies from it along the
      flight of the projectile, faster than what makes a core leave a target, and its middle is in the rear half or beyond;
    * attached spall: there is such a piece, but it does not fly; or in some column of cells there is void between cells of the
      target and no other body, deeper than the hole: half a cell of it or more, in cells of which OPEN or more is void; or the
      rear bulges by BULGE of the thickness or more;
    * none.

    None while the rear lies beyond the mesh, and where target of LEFT_MASS of the projectile has left the mesh behind it, which
    may have been spall.

    hole : the crater's measurements;  lost : mass of the target that has left the mesh behind it, kg
    """
    if not crater.has_rear():
        return None
    if hole.hole_diameter_m is not None:
        return PERFORATED
    flies = _pieces_that_fly(sim, crater)
    if any(flies):
        return DETACHED_SPALL
    if lost > LEFT_MASS * sim.penetrator.mass:
        return None
    attached = flies or crater.bulge() >= BULGE * crater.rear or _is_cracked(sim, crater, hole["depth_m"])
    return ATTACHED_SPALL if attached else NO_DAMAGE


def _pieces_that_fly(sim, crater) -> list[bool]:
    """Whether each piece of the target other than the largest one, in its rear half or beyond, flies from that."""
    from scipy import ndimage

    mass, velocity = crater.masses(crater.m, True)
    labels, count = ndimage.label(sim.grid.interior(sim.state.vof)[crater.m] >= HALF)
    if count < 2:
        return []
    numbers = np.arange(1, count + 1)
    cells, own, momentum, moment = (np.asarray(ndimage.sum_labels(each, labels, numbers))
                                    for each in (np.ones(labels.shape), mass, mass * velocity, mass * crater.depths()))
    wall, speed, depth = int(np.argmax(own)), momentum / own, moment / own
    off = (cells >= FEWEST_CELLS) & (depth > 0.5 * crater.rear) & (numbers != wall + 1)
    return (crater.direction * (speed[off] - speed[wall]) > sim.penetrator.leaving).tolist()


def _is_cracked(sim, crater, bottom: float) -> bool:
    """Whether there is void between two cells of the target in a column of cells, deeper than the bottom of the hole, m.

    The column at the rim of the target, which its surface may cut, is left out.
    """
    from scipy import ndimage

    fraction = sim.grid.interior(sim.state.vof)
    void, others = 1.0 - fraction.sum(axis=0), fraction.sum(axis=0) - fraction[crater.m] >= CRUMB
    labels, count = ndimage.label(fraction[crater.m] >= HALF)
    pieces = np.bincount(labels.ravel(), minlength=count + 1) >= FEWEST_CELLS
    pieces[0] = False
    own = pieces[labels]
    within = _after_one(own) & _after_one(own[::-1])[::-1] & (crater.depths() > bottom)
    within[:, :-1] &= within[:, 1:]
    within[:, -1] = False
    cavities, count = ndimage.label(void >= HALF)
    bordering = np.zeros(count + 1, dtype=bool)
    bordering[cavities[ndimage.binary_dilation(others)]] = True
    bordering[0] = False
    void = np.where(within & (void >= OPEN) & ~bordering[cavities], void, 0.0)
    alone = ~(within & others).any(axis=0)
    return bool((void.sum(axis=0)[alone] >= HALF).any())


def _after_one(cells: np.ndarray) -> np.ndarray:
    """Which cells have one of these before them in their column."""
    seen = np.logical_or.accumulate(cells, axis=0)
    return np.concatenate([np.zeros_like(seen[:1]), seen[:-1]])
