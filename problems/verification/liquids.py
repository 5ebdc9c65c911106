"""Problems with exact solutions of liquids: waves on a surface, the instability of an interface, and sheets that meet."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

import hydro2d
from problems.verification.cells import Cells
from problems.verification.exact import jets
from problems.verification.exact.waves import Interface
from problems.verification.layers import Layers, override
from problems.verification.measures import Curve, Problem, Quantity, advection, cells_of, extrema

# Waves, half a wavelength wide

WIDTH = 0.1
BASIN, SURFACE = Layers(WIDTH, 0.1, 2e-3, 1e4, 1000.0), Interface(1e4, math.pi / WIDTH, 1000.0, 0.1)
BOX = Layers(WIDTH, 0.1, 1e-3, 1e4, 1000.0, 3000.0, 0.1, 20e6)
UNSTABLE = Interface(1e4, math.pi / WIDTH, 1000.0, 0.1, 3000.0, 0.1)


def _height(simulation: hydro2d.Simulation) -> float:
    """a of the lower liquid's surface, a cos(k r), by the filling of the columns, m."""
    cells = Cells(simulation)
    filled = cells.vof[0].sum(axis=0) * cells.size
    return float(2.0 * np.mean((filled - filled.mean()) * np.cos(math.pi * cells.columns / WIDTH)))


def _wave_refine(layers: Layers, high: float, cells: int) -> list[str]:
    """A mesh with this number of cells on a wavelength, and its rows of liquid."""
    size = 2.0 * WIDTH / cells
    return [f"mesh.r=[{{to={WIDTH}, cells={cells // 2}}}]", f"mesh.z=[{{to={high}, cells={round(high / size)}}}]",
            override(layers.bodies(size))]


def nodes(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Times at which a record changes its sign, interpolated."""
    n = np.nonzero(values[:-1] * values[1:] < 0.0)[0]
    return time[n] - values[n] * (time[n + 1] - time[n]) / (values[n + 1] - values[n])


def _standing_wave(run: hydro2d.Results, cells: int) -> list[Quantity]:
    time, height = run.history["time"], run.history["height_m"]
    between = np.diff(nodes(time, height))
    return [
        Quantity("period", "ms", 1e3 * SURFACE.period, 2e3 * float(between.mean())),
        Quantity("height after a period", "mm", 1e3 * BASIN.amplitude, 1e3 * float(extrema(time, height)[1][1])),
    ]


def _rayleigh_taylor(run: hydro2d.Results, cells: int) -> list[Quantity]:
    time, growth = run.history["time"], run.history["height_m"] / BOX.amplitude
    scaled = UNSTABLE.growth * time
    here = (scaled > 0.5) & (scaled < 2.0)
    rate = np.polyfit(time[here], np.arccosh(np.maximum(growth[here], 1.0)), 1)[0]
    return [
        Quantity("rate of growth n", "1/s", UNSTABLE.growth, float(rate)),
        Quantity("growth at n t = 2", "", math.cosh(2.0), float(np.interp(2.0, scaled, growth))),
    ]


def _height_curve(run: hydro2d.Results) -> Curve:
    return 1e3 * run.history["time"], 1e3 * run.history["height_m"]


# Sheets that meet

SHEET, SHEET_SPEED, MEET = 0.01, 100.0, math.radians(60.0)
#: windows (z from, z to, r to) where the slug and the jet have become parallel, m
SLUG, JET = (0.025, 0.04, 0.02), (-0.045, -0.025, 0.008)


def _force(simulation: hydro2d.Simulation) -> float:
    """Force on the plane of symmetry by the pressure next to it, N/m."""
    cells = Cells(simulation)
    return float(cells.mean_pressure[:, 0].sum()) * cells.size


def _jets(run: hydro2d.Results, cells: int) -> list[Quantity]:
    state, history = cells_of(run), run.history
    mass, steady = state.vof[0] * state.rho[0], history["time"] > 0.5 * run.summary.time_s
    quantities = []
    for name, (low, high, top), share, way in (("slug", SLUG, jets.forward(MEET), 1.0), ("jet", JET, jets.back(MEET), -1.0)):
        here = (state.z > low) & (state.z < high) & (state.r < top)
        thickness = float(np.sum(state.vof[0][here])) / np.count_nonzero(here.any(axis=1)) * state.size
        speed = way * float(np.sum((mass * state.v)[here]) / np.sum(mass[here]))
        quantities += [Quantity(f"thickness of the {name}", "mm", 1e3 * SHEET * share, 1e3 * thickness),
                       Quantity(f"speed of the {name}", "m/s", SHEET_SPEED, speed)]
    force = 1e-3 * 1000.0 * SHEET_SPEED**2 * SHEET * math.sin(MEET)
    return [*quantities, Quantity("mean force on the plane", "kN/m", force, 1e-3 * float(history["force_n_m"][steady].mean()))]


def _jets_curve(run: hydro2d.Results) -> Curve:
    """Height of the liquid above the plane of symmetry, below 10 mm and the sheet."""
    state = cells_of(run)
    low = (state.columns < SHEET)[None, :]
    return 1e3 * state.rows, 1e3 * np.sum(state.vof[0] * low, axis=1) * state.size


PROBLEMS = (
    Problem("standing_wave", "A standing wave", "standing_wave.toml", "on a wavelength", (32, 64, 128),
            partial(_wave_refine, BASIN, 0.125), _standing_wave, _height_curve,
            lambda x: 1e3 * BASIN.amplitude * SURFACE.amplitude(1e-3 * x), ("time [ms]", "height at the wall [mm]"),
            advection("both"), {"height_m": _height}),
    Problem("rayleigh_taylor", "The instability of Rayleigh and Taylor", "rayleigh_taylor.toml", "on a wavelength",
            (32, 64, 128), partial(_wave_refine, BOX, 0.2), _rayleigh_taylor, _height_curve,
            lambda x: 1e3 * BOX.amplitude * UNSTABLE.amplitude(1e-3 * x), ("time [ms]", "amplitude [mm]"),
            advection("both"), {"height_m": _height}),
    Problem("jets", "Two sheets of a liquid that meet", "jets.toml", "across a sheet", (5, 10, 20),
            lambda cells: [f"mesh.r=[{{to=0.12, cells={12 * cells}}}]",
                           f"mesh.z=[{{to=0.06, cells={14 * cells}}}]"],
            _jets, _jets_curve,
            lambda x: np.where(x > 10.0, 7.5, np.where(x < -10.0, 2.5, np.nan)),
            ("z [mm]", "thickness next to the plane of symmetry [mm]"), advection("both"), {"force_n_m": _force}),
)
