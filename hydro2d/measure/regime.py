"""The regime of a rod: one rule, for runs, searches, reports and studies."""

from __future__ import annotations

#: regimes in the order of impact velocity
GROWING = RIGID, DEFORMING, ERODING = "rigid", "deforming", "eroding"
#: that of a rod that has left the mesh and is not judged further
LEFT = "left the mesh"
#: all regimes by their number in a history
REGIMES = (*GROWING, LEFT)

#: a rod is rigid while it has lost less than this share of its length and its radius has grown by less than that
RIGID_LENGTH, RIGID_RADIUS = 0.05, 0.10
#: it is eroding once it has lost more than this share of its length, or more than that of its mass has left its core
ERODED_LENGTH, ERODED_MASS = 1.0 / 3.0, 0.10
#: least share of its length that a rod keeps if it does not erode; erosion leaves less, perhaps a needle or two
LEAST_KEPT_LENGTH = 1.0 - ERODED_LENGTH

#: the rule in words
RULE = {
    RIGID: f"less than {100 * RIGID_LENGTH:g} % of the length lost, and the nose kept: no section beyond "
           f"{1 + RIGID_RADIUS:g} of the radius",
    ERODING: f"more than a third of the length lost, or {100 * ERODED_MASS:g} % of the mass lost from the core",
    DEFORMING: "between the two",
}


def regime(length: float, radius: float, core: float) -> str:
    """"rigid", "deforming" or "eroding", by the rule above.

    length, radius, core : length, largest radius and mass of the core, each over its value at the start
    """
    if length < LEAST_KEPT_LENGTH or core < 1.0 - ERODED_MASS:
        return ERODING
    return RIGID if length > 1.0 - RIGID_LENGTH and radius < 1.0 + RIGID_RADIUS else DEFORMING
