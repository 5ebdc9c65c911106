"""Lengths of Taylor bars of copper, measured and of the kept runs with Johnson and Cook's constants as they were published."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import hydro2d
from problems import kept
from problems.classic import table as classic

HERE = Path(__file__).parent
#: the bar of problems/classic in copper_bars.csv, and its length (mm) as Johnson & Cook (1983) give it
SAME_BAR, LENGTH = "Johnson-190", 16.2
#: cells across the radius of the runs of the sample, and of those in classic; yield stress and hardening as published, MPa
CELLS, CLASSIC = 8.0, {"methods.csv": 8.0, "methods_fine.csv": 16.0}
PUBLISHED = {"materials.copper.strength.yield_stress": (90.0,), "materials.copper.strength.hardening": (292.0,)}


class Bar(NamedTuple):
    """A bar: velocity, m/s; lengths, mm, measured and of its runs; their cells and the version of their method."""

    name: str
    velocity: float
    measured: float
    computed: tuple[float, ...]
    cells: tuple[float, ...]
    method: str


def bars() -> list[Bar]:
    """All bars: one with every advection on two meshes, the others by the surrogate of a sample, which stands for one run."""
    runs = [(run.value, cells, run.method) for name, cells in CLASSIC.items()
            for run in classic.read(HERE.parent / "classic" / "results" / name)
            if (run.shot, run.sliding, run.status) == ("taylor_bar", "none", "trusted")]
    lengths, meshes, methods = zip(*runs, strict=True)
    found = [Bar(SAME_BAR, 190.0, LENGTH, lengths, meshes, "; ".join(sorted(set(methods))))]
    measured = {row["bar"]: row for row in kept.rows(HERE / "copper_bars.csv", ("bar", "velocity_m_s", "final_length_mm"))}
    for sample in hydro2d.kept_samples(HERE / "copper_bars.toml"):
        row = measured[sample.labels["bar"]]
        if row["bar"] != SAME_BAR:
            length = float(sample.surrogate("bodies.bar.length_m")(sample.points(PUBLISHED))[0])
            found.append(Bar(row["bar"], float(row["velocity_m_s"]), float(row["final_length_mm"]), (1e3 * length,), (CELLS,),
                             "; ".join(sorted(set(sample.table["method"])))))
    return found
