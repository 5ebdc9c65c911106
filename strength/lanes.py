"""Where the numbers of cells that are solved together stand in one array, float64[LANE_ROWS LANES].

Each name is the place of a number of the first cell; that of the next cell follows it. The distances are constants, from
which the compiler sees that the rows do not overlap, and the number of cells is a multiple of `WIDTH`, so that no cell is
left over after the last vector.
"""

from __future__ import annotations

from hydro2d.mesh.fields import LANES

#: cells come in multiples of this number: doubles in the widest vector
WIDTH = 8

#: what a cell brings: its column, trial stress, plastic strain, temperature, pressure, density and shear modulus times 3
COLUMN, TRIAL, STRAIN, HEAT, PRESSURE, DENSITY, STIFFNESS = range(0, 7 * LANES, LANES)
#: plastic strain at which the flow stress is asked for, its rate, and the flow stress
HARDENED, RATE, FLOW = range(7 * LANES, 10 * LANES, LANES)
#: the increment of plastic strain, tried or found, and the flow stress of the trial before, or that found
INCREMENT, STRESS = range(10 * LANES, 12 * LANES, LANES)
#: logarithm of the increment that is tried and of the one before, the bracket, and the size of the residual before: -1 where
#: the increment is found
LOGARITHM, BEFORE, LOW, HIGH, RESIDUAL = range(12 * LANES, 17 * LANES, LANES)
