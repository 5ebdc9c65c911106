"""The materials of a run as two blocks that kernels read.

``models[m, k]``, int64: the ids of the models of body m, in the columns EOS, STRENGTH and DAMAGE, in MEMORY the row of
State.q in which the internal variables of its equation of state begin, and in RECORD that of its `FAILURE_RECORD`, 0 for none.
``materials[m, k]``, float64: the parameter rows of the strength and the damage model, from STRENGTH_AT and DAMAGE_AT on, then

    TENSILE         the tension at which the body fractures, Pa, positive; inf if it never does
    CUTOFF_DENSITY  the density at and below which it is no longer a solid, kg/m^3
    FACTOR          factor on its flow stress
    GAS             1 for a gas compared with the other bodies, else 0
    FADES           1 where the tension falls with damage, to 0 in crushed material, else 0
    CRACKS          the tension at which cracks open, Pa, of a body whose damage model opens them, else 0; its TENSILE is inf
    MOST_STRESS     the largest principal stress that it bears, Pa; beyond that it fails for good; inf if it never does
    MELTING_AT      from here on the melting line of the material (strength/melting.py)

and from EOS_AT to the end the row of the equation of state, followed by zeros if that of another body is longer.
"""

from __future__ import annotations

import numpy as np

from strength.layout import DAMAGE_ROW
from strength.layout import ROW as STRENGTH_ROW
from strength.melting import ROW as LINE

EOS, STRENGTH, DAMAGE, MEMORY, RECORD = range(5)

STRENGTH_AT, DAMAGE_AT = 0, STRENGTH_ROW
TENSILE = DAMAGE_AT + DAMAGE_ROW
CUTOFF_DENSITY, FACTOR, GAS, FADES, CRACKS, MOST_STRESS, MELTING_AT = range(TENSILE + 1, TENSILE + 8)
EOS_AT = MELTING_AT + LINE


def packed(table, cutoff_density, factor) -> tuple[np.ndarray, np.ndarray]:
    """(models, materials) of a MaterialTable; cutoff_density (kg/m^3) and factor are float64[m]."""
    models = np.stack([table.eos_model, table.strength_model, table.damage_model, table.memory, table.record], axis=1)
    from strength.dispatch import WEAKENS

    fades = np.isin(table.strength_model, WEAKENS).astype(float)
    numbers = (table.fracture_pressure, cutoff_density, factor, table.gases().astype(float), fades, table.cracking,
               table.fracture_stress)
    own = np.stack(numbers, axis=1)
    return models, np.concatenate([table.strength_par, table.damage_par, own, table.melting, table.eos_par], axis=1)


def tension(models, materials) -> np.ndarray:
    """Tension that each body carries, Pa, float64[m]: the least of its limits, 0 without strength."""
    cracks, most = materials[:, CRACKS], np.minimum(materials[:, TENSILE], materials[:, MOST_STRESS])
    return np.where(models[:, STRENGTH] != 0, np.where(cracks > 0.0, np.minimum(cracks, most), most), 0.0)
