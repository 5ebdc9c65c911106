"""A run directory that no solver wrote: smooth fields with a little noise on a graded mesh that may travel, and stations."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from hydro2d.files.whole import write_json, write_text
from hydro2d.output import history, vtk
from hydro2d.output.directory import DECK, HISTORY, SUMMARY
from hydro2d.output.station_arrays import KEYS

BODIES = ("rod", "plate")
#: names and sizes of scalar fields, SI
SCALARS = {
    "Pressure [Pa]": 5e9, "Density [kg/m3]": 18e3, "Von Mises Stress [Pa]": 1e9, "Temperature [K]": 900.0,
    "Plastic Strain": 2.0, "Temperature of rod [K]": 700.0,
}
DECK_TEXT = """\
title = "A made shot"
[mesh]
geometry = "{geometry}"
[boundaries]
r_min = "axis"
[[body]]
name = "rod"
[[body]]
name = "plate"
[penetration]
rod = "rod"
target = "plate"
surface = 0.0
[experiment]
penetration = 0.030
"""


def edges(shape: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """r and z edges in m for (nz, nr) cells: even at first, then growing."""
    nz, nr = shape
    r = np.concatenate([np.linspace(0.0, 10e-3, nr // 2 + 1), 10e-3 * np.geomspace(1.1, 4.0, nr - nr // 2)])
    z = np.concatenate([np.linspace(-40e-3, 20e-3, nz - nz // 4 + 1), 20e-3 * np.geomspace(1.1, 4.0, nz // 4)])
    return r, z


def fields(r: np.ndarray, z: np.ndarray, time: float, noise: float, random: np.random.Generator,
           everywhere: bool = False) -> dict[str, np.ndarray]:
    """Fields at a time: a rod of radius 3 mm whose nose is at 1 km/s times the time, in a plate from z = 0 on.

    noise : share of each value; everywhere : fields are nowhere zero, so that there is noise in all cells
    """
    zc, rc = np.meshgrid(0.5 * (z[1:] + z[:-1]), 0.5 * (r[1:] + r[:-1]), indexing="ij")
    nose, size = 1e3 * time, np.diff(r)[None, :]
    rod = np.clip((3e-3 - rc) / size + 0.5, 0.0, 1.0) * np.clip((nose - zc) / 5e-4 + 0.5, 0.0, 1.0) * (zc > nose - 30e-3)
    plate = (1.0 - rod) * (zc > 0.0) * ((rc > 4e-3) | (zc > nose))
    wave = np.exp(-(((zc - nose) / 8e-3) ** 2) - (rc / 8e-3) ** 2)
    filled = rod + plate
    values = {"Volume Fraction for rod": rod, "Volume Fraction for plate": plate,
              "Material": np.where(rod > 0.5, 1, np.where(plate > 0.5, 2, 0)).astype(np.int32)}
    for number, (name, size) in enumerate(SCALARS.items()):
        rough = 1.0 + noise * random.standard_normal(wave.shape)
        shape = 0.2 * name.startswith(("Dens", "Temp")) + wave * np.cos(400 * rc * number)
        values[name] = size * rough * (1.0 + shape if everywhere else shape * filled)
        if "rod" in name:
            values[name] = np.where(rod > 0, values[name], 0.0)
    speed = 1e3 * rod * np.exp(-rc / 1e-2) + 200 * plate * wave
    values["Velocity [m/s]"] = np.stack([speed * 0.3 * np.sin(300 * zc), speed, np.zeros_like(speed)], axis=-1)
    return values


def write(directory: Path, *, shape=(55, 24), dumps: int = 5, noise: float = 0.0, travels: bool = False, stations: bool = True,
          names=None, geometry: str = "cylindrical", ended: bool = True, everywhere: bool = False,
          time: float = 40e-6) -> Path:
    """Writes the run; names : fields in addition to volume fractions and material, default all. Returns its directory."""
    (directory / vtk.FOLDER).mkdir(parents=True)
    write_text(directory / DECK, DECK_TEXT.format(geometry=geometry))
    random, (r, z) = np.random.default_rng(1), edges(shape)
    times, entries = np.linspace(0.0, time, dumps), []
    for number, when in enumerate(times):
        here = z + (500.0 * when if travels else 0.0)
        arrays = fields(r, here, when, noise, random, everywhere)
        kept = {name: values for name, values in arrays.items()
                if names is None or name in names or name == "Material" or name.startswith("Volume")}
        name = f"{vtk.FOLDER}/dump_{number:06d}.vtr"
        vtk.write_grid(directory / name, r, here, kept.items(), when)
        entries.append((when, name))
    vtk.write_series(directory / vtk.SERIES["dump"], entries)
    _write_history(directory / HISTORY, time, stations)
    if ended:
        write_json(directory / SUMMARY, {"time_s": time, "stop_reason": "the end time was reached"})
    return directory


def _write_history(path: Path, end: float, stations: bool) -> None:
    columns = history.History(path)
    for when in np.linspace(0.0, end, 81):
        row = {"time": when, "penetration_depth_m": 1e3 * when, "rod_length_m": 30e-3 - 100 * when, "regime": "rigid",
               "rod_tail_velocity_m_s": 1000.0 - 1e6 * when, "rod_max_plastic_strain": 1e4 * when}
        if stations:
            for kind, name, z in (("tracer", "tip", 1e3 * when - 1e-3), ("gauge", "deep", 12e-3)):
                row |= {f"{kind}_{name}_{key}": {"r_m": 1e-3, "z_m": z}.get(key, 5.0) for key in KEYS}
        columns.append(row)
    columns.write()

