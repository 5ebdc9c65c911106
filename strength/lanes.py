"""Layout of the array that holds the values of cells solved together, float64[LANE_ROWS LANES].

Each name is the index of a value of the first cell; that of the next cell follows it. The offsets are constants, so that the
compiler sees that the rows do not overlap. The number of cells is a multiple of `WIDTH`, so that no cell is left over after the
last vector.
"""

from __future__ import annotations

from hydro2d.mesh.fields import LANES

#: cells come in multiples of this number: doubles in the widest vector
WIDTH = 8

#: input of a cell: its column, trial stress, plastic strain, temperature, pressure, density and shear modulus times 3
COLUMN, TRIAL, STRAIN, HEAT, PRESSURE, DENSITY, STIFFNESS = range(0, 7 * LANES, LANES)
#: plastic strain and rate at which the flow stress is evaluated, and the flow stress
HARDENED, RATE, FLOW = range(7 * LANES, 10 * LANES, LANES)
#: increment of plastic strain, the trial or the solution; flow stress of the previous trial, or of the solution
INCREMENT, STRESS = range(10 * LANES, 12 * LANES, LANES)
#: logarithms of the trial increment and of the previous one, the bracket, and the size of the previous residual: -1 where
#: solved
LOGARITHM, BEFORE, LOW, HIGH, RESIDUAL = range(12 * LANES, 17 * LANES, LANES)
