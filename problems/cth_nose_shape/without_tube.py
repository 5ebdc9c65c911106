"""Whether the tube of eroded rod that lies along the shank slows it: shots with the tube, and with it taken away as it forms.

    python -m problems.cth_nose_shape.without_tube [--deck DECK ...] [--keep FILE]

An eroding rod turns inside out: what leaves its head flows back between the shank and the wall of the hole. Rod and tube are
one body with one velocity field, so that they are welded where they touch. Every ten cycles the second run of each deck takes
away what lies beside the shank: more than 0.1 mm beyond its radius, further than 2.7 radii behind the nose, and slower than
three quarters of the tail. What is taken is accounted for as outflow. The law of the rod is that of the sintered alloy. The
table has the depth, the mass that was taken and the time of flight.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import hydro2d
from problems import kept

HERE = Path(__file__).parent
DECKS = [HERE / "hemi_5083_1296.toml", HERE / "hemi_7039_1248.toml"]
LAW = ('body.rod.material="rod_alloy"', 'materials.rod_alloy.based_on="W_sintered"', 'failure.damage="none"',
       'materials.rod_alloy.eos.reference_density="18.16 g/cm^3"')
COLUMNS = ("deck", "tube", "depth_cm", "taken_g", "time_us", "cycles")
#: cycles between two looks; how far the tube is from the shank (m), from the nose (radii), and how slow it is, of the tail
EVERY, BESIDE, BEHIND, SLOW = 10, 1e-4, 2.7, 0.75


class Knife:
    """Takes the tube from a rod, as a callback of `Simulation.run`; `taken` is its mass, kg."""

    def __init__(self, radius: float):
        self.radius, self.taken = radius, 0.0

    def __call__(self, sim) -> None:
        state, grid, m = sim.state, sim.grid, sim.table.names.index(sim.projectile)
        rod, axial = state.vof[m], state.velocity[1, state.group[m]]
        rows = np.nonzero((rod > 0.5).any(axis=1))[0]
        speed = 0.25 * (axial[:-1, :-1] + axial[1:, :-1] + axial[:-1, 1:] + axial[1:, 1:])
        nose, tail = grid.z[rows[-1] + 1], speed[rows[0] + 3, grid.g + 1]
        tube = (rod > 0.0) & (grid.rc > self.radius + BESIDE) & (grid.zc < nose - BEHIND * self.radius)[:, None]
        tube &= speed < SLOW * tail
        if not tube.any():
            return
        before = sim.totals()
        rod[tube] = 0.0
        sim.engine.prepare()
        after = sim.totals()
        lost = before.mass - after.mass
        sim.audit.add("outflow", mass=lost, momentum=before.momentum - after.momentum, energy=before.energy - after.energy)
        self.taken += float(2.0 * np.pi * lost[m])


def shots(files: list[Path]) -> list[dict]:
    """A row for each deck with its tube, and one without."""
    rows = []
    for file in files:
        deck = hydro2d.Deck.from_file(file, LAW)
        for with_tube in (True, False):
            sim = hydro2d.Simulation(deck)
            radius = 0.5 * deck.body_named(sim.projectile).diameter
            knife = Knife(radius)
            sim.run(callbacks=() if with_tube else [hydro2d.every(EVERY, knife)])
            told = sim.diagnostics()
            depth, taken, time = 1e2 * told["penetration_depth_m"], 1e3 * knife.taken, 1e6 * sim.time
            row = file.stem, "kept" if with_tube else "taken", round(depth, 2), round(taken, 1), round(time), sim.cycle
            rows.append(dict(zip(COLUMNS, row, strict=True)))
            print(", ".join(f"{name} {value}" for name, value in rows[-1].items()), flush=True)
    return rows


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--deck", type=Path, nargs="+", default=DECKS)
    parser.add_argument("--keep", type=Path, metavar="FILE", help="write the table to a CSV file")
    given = parser.parse_args(arguments)
    rows = shots(given.deck)
    if given.keep:
        kept.write(given.keep, COLUMNS, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
