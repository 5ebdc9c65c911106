"""Results of tracers and gauges, and the columns of their arrays; the kernels in `tracers.py` fill them."""

from __future__ import annotations

from math import inf, nan

from hydro2d.measure.result import Number, Result, result


class Place(Result):
    """Where a point is."""

    r_m: Number = result("radial position")
    z_m: Number = result("axial position")


class Point(Place):
    """The state at a point, in the order of the columns of `sample`."""

    velocity_r_m_s: Number = result("radial velocity")
    velocity_z_m_s: Number = result("axial velocity")
    density_kg_m3: Number = result("mass of all bodies per volume of the cell")
    pressure_Pa: Number = result("sum of volume fraction times pressure, positive in compression")
    stress_rr_Pa: Number = result("total radial stress, tension positive")
    stress_zz_Pa: Number = result("total axial stress, tension positive")
    stress_tt_Pa: Number = result("total hoop stress, tension positive")
    stress_rz_Pa: Number = result("shear stress")
    von_mises_Pa: Number = result("sqrt(3/2 s:s) of the stress deviator")
    temperature_K: Number = result("temperature, mean by mass over the bodies")
    plastic_strain: Number = result("equivalent plastic strain, mean by mass")
    damage: Number = result("0 intact, 1 failed; mean by mass")


class Station(Point):
    """A tracer or a gauge: its state, and extreme values since the start, updated in every cycle. SI."""

    peak_pressure_Pa: Number = result("largest pressure since the start")
    peak_pressure_time_s: Number = result("time of the largest pressure")
    least_pressure_Pa: Number = result("smallest pressure since the start, negative in tension")
    peak_speed_m_s: Number = result("largest speed since the start")
    peak_von_mises_Pa: Number = result("largest von Mises stress since the start")
    peak_temperature_K: Number = result("largest temperature since the start")
    peak_plastic_strain: Number = result("largest plastic strain since the start")


PLACES = Place.meanings()
QUANTITIES = {name: meaning for name, meaning in Point.meanings().items() if name not in PLACES}
PEAKS = {name: meaning for name, meaning in Station.meanings().items() if name not in Point.model_fields}
U, V, DENSITY, PRESSURE, S_RR, S_ZZ, S_TT, S_RZ, MISES, TEMPERATURE, STRAIN, FAILED = range(len(QUANTITIES))
#: values of PEAKS before the first update
NO_PEAKS = (-inf, nan, inf, -inf, -inf, -inf, -inf)
