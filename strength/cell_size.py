"""The size of the cell in a fracture strain: what several damage models share.

Plastic strain that localises does so in a band of one or two cells, whose strain grows as the cells shrink. A fracture strain
that grows likewise keeps what the band takes from depending on the mesh (explanation/fracture, equation 7a).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from hydro2d.base.parameters import POSITIVE, Parameter
from hydro2d.jit import point, power

PARAMETERS = (
    Parameter("reference_cell", "m", math.inf, "size of the cells to which the fracture strain belongs", "h0", POSITIVE,
              example="0.25 mm"),
    Parameter("cell_exponent", "", 0.0, "m of ef ~ (h/h0)^-m, h = sqrt(dr dz) of the cell; 0: the cell does not matter", "m",
              example=0.5),
)

#: the largest exponent: a band of one cell then takes the same displacement on any mesh
MOST = 1.0


@point
def faster(area, inverse_area, half_exponent):
    """Factor on the increment of damage in a cell of this ``area``, m^2: (h/h0)^m, explanation/fracture, (7a); 1 if m = 0.

    ``inverse_area`` is 1/h0^2, 1/m^2, and ``half_exponent`` is m/2.
    """
    return power(area * inverse_area, half_exponent) if half_exponent > 0.0 else 1.0


def packed(model: str, given: Mapping[str, float]) -> tuple[float, float]:
    """(inverse_area, half_exponent) of a model's parameters.

    Raises ValueError for an exponent above MOST, and for one without a reference cell.
    """
    reference, exponent = given["reference_cell"], given["cell_exponent"]
    if exponent > MOST:
        raise ValueError(f"{model}: cell_exponent = {exponent:g}: must be at most {MOST:g}, at which a band of one cell fails "
                         "at the same displacement on any mesh")
    if exponent > 0.0 and math.isinf(reference):
        raise ValueError(f"{model}: cell_exponent needs reference_cell, the size of the cells to which the fracture strain "
                         'belongs, such as reference_cell = "0.25 mm"')
    return (0.0 if math.isinf(reference) else reference**-2), 0.5 * exponent
