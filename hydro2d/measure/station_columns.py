"""Quantities that tracers and gauges record, and the columns of their arrays; the kernels in `tracers.py` fill them."""

from __future__ import annotations

from math import inf, nan

#: quantities at a point, in the order of the columns of `sample`, and their meanings
QUANTITIES = {
    "velocity_r_m_s": "radial velocity",
    "velocity_z_m_s": "axial velocity",
    "density_kg_m3": "mass of all bodies per volume of the cell",
    "pressure_Pa": "sum of volume fraction times pressure, positive in compression",
    "stress_rr_Pa": "total radial stress, tension positive",
    "stress_zz_Pa": "total axial stress, tension positive",
    "stress_tt_Pa": "total hoop stress, tension positive",
    "stress_rz_Pa": "shear stress",
    "von_mises_Pa": "sqrt(3/2 s:s) of the stress deviator",
    "temperature_K": "temperature, mean by mass over the bodies",
    "plastic_strain": "equivalent plastic strain, mean by mass",
    "damage": "0 intact, 1 failed; mean by mass",
}
U, V, DENSITY, PRESSURE, S_RR, S_ZZ, S_TT, S_RZ, MISES, TEMPERATURE, STRAIN, FAILED = range(len(QUANTITIES))
#: extreme values at a point since the start, updated in every cycle
PEAKS = {
    "peak_pressure_Pa": "largest pressure since the start",
    "peak_pressure_time_s": "time of the largest pressure",
    "least_pressure_Pa": "smallest pressure since the start, negative in tension",
    "peak_speed_m_s": "largest speed since the start",
    "peak_von_mises_Pa": "largest von Mises stress since the start",
    "peak_temperature_K": "largest temperature since the start",
    "peak_plastic_strain": "largest plastic strain since the start",
}
#: their values before the first update
NO_PEAKS = (-inf, nan, inf, -inf, -inf, -inf, -inf)
