"""Prints how rods dwell on or enter a ceramic in runs of dwell.toml: `python -m problems.ceramics.dwell RUN [RUN ...]`.

A row has the face, the velocity of impact, the pressure that Lundberg, Renstrom & Lundberg estimate at the interface, the
depths below the face of the ceramic at AT and the largest one, and the velocities of the interface and of the rod's tail while
the rod is worn from WORN[0] to WORN[1]. The rows that the README shows are kept in results/dwell.csv, those of the members in
results/members.csv.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from problems import kept as results
from problems.ceramics.read import ended

RESULTS = Path(__file__).parent / "results"
KEPT, MEMBERS = RESULTS / "dwell.csv", RESULTS / "members.csv"
#: times of three of the depths, us
AT = (10, 20, 30)
COLUMNS = ("face", "velocity_m_s", "pressure_GPa", *(f"depth_{each}_us_mm" for each in AT), "depth_mm", "u_m_s", "v_m_s",
           "trusted", "method")
#: wear of the rod between which the velocities are means, m
WORN = (10e-3, 20e-3)
#: the strength of intact boron carbide at its elastic limit, 1.5 (HEL - P_HEL), GPa
STRENGTH = 15.435
#: pressure at the interface over the strength of the ceramic, between which the transition is expected; both are recalled
BOUNDS = (1.05, 1.85)


def pressure(velocity: float, density: float, bulk_modulus: float, yield_stress: float) -> float:
    """Pressure in the middle of a face on which a rod dwells, Pa: q (1 + q/(2 K)) + 3.27 Y with q = rho v^2/2; SI.

    Lundberg, Renstrom & Lundberg, Int. J. Impact Engng 24 (2000) 259, recalled.
    """
    q = 0.5 * density * velocity**2
    return q * (1.0 + 0.5 * q / bulk_modulus) + 3.27 * yield_stress


def transition(factor: float, density: float, bulk_modulus: float, yield_stress: float) -> float:
    """Velocity at which the pressure is the factor times the strength of boron carbide, m/s; the rod in SI."""
    speeds = np.linspace(0.0, 3000.0, 30001)
    pressures = pressure(speeds, density, bulk_modulus, yield_stress)
    return float(np.interp(factor * STRENGTH * 1e9, pressures, speeds))


def rod_of(deck) -> tuple[float, float, float]:
    """Density, bulk modulus and yield stress of the rod, SI."""
    material = deck.materials[next(body for body in deck.body if body.name == "rod").material]
    density, sound = material.eos.values["reference_density"], material.eos.values["sound_speed"]
    return density, density * sound**2, material.strength.values["yield_stress"]


def of_run(directory: Path) -> tuple:
    """The row of a run, in the order of COLUMNS. Raises ValueError for a rod that is not worn by WORN[1]."""
    run = ended(directory)
    rod = next(body for body in run.deck.body if body.name == "rod")
    worn = run.history["rod_length_m"][0] - run.history["rod_length_m"]
    time, depth, tail = (run.history[name] for name in ("time", "penetration_depth_m", "rod_tail_velocity_m_s"))
    if worn.max() < WORN[1]:
        raise ValueError(f"the rod is worn by {worn.max() * 1e3:.1f} mm only")
    first, last = (int(np.argmax(worn >= each)) for each in WORN)
    u = (depth[last] - depth[first]) / (time[last] - time[first])
    v = tail[first:last + 1].mean()
    speed = abs(rod.velocity[1])
    estimate = pressure(speed, *rod_of(run.deck)) * 1e-9
    face = "bare" if rod.tip == 0.0 else "cover"
    depths = (*np.interp(np.array(AT) * 1e-6, time, depth), depth.max())
    return (face, round(speed), round(estimate, 2), *(round(float(each) * 1e3, 1) for each in depths), round(u), round(v),
            *results.standing(run.summary))


def kept(path: Path = KEPT) -> list[dict[str, str]]:
    """The rows of results/dwell.csv, or of MEMBERS."""
    return results.rows(path, COLUMNS)


def table(rows: list[dict[str, str]]) -> list[str]:
    """The rows of the kept file as lines of the README's table."""
    lines = ["| face | velocity | estimated pressure | over the strength | "
             + " | ".join(f"depth at {each} µs" for each in AT) + " | at the end | interface | tail |", "|---" * 10 + "|"]
    for row in rows:
        depths = " | ".join(f"{row[name]} mm" for name in COLUMNS[3:7])
        lines.append(f"| {row['face']} | {row['velocity_m_s']} m/s | {row['pressure_GPa']} GPa | "
                     f"{float(row['pressure_GPa']) / STRENGTH:.2f} | {depths} | {row['u_m_s']} m/s | {row['v_m_s']} m/s |")
    return lines


def members_table(rows: list[dict[str, str]]) -> list[str]:
    """The rows of MEMBERS as lines of the README's table: medians, the least and the largest."""
    lines = ["| face | velocity | members | depth at 20 µs, mm | depth at the end, mm | interface, m/s |", "|---" * 6 + "|"]
    for (face, velocity), members in results.grouped(rows, ("face", "velocity_m_s")).items():
        columns = " | ".join(results.told(members, name) for name in ("depth_20_us_mm", "depth_mm", "u_m_s"))
        lines.append(f"| {face} | {velocity} m/s | {len(members)} | {columns} |")
    return lines


def main(arguments: list[str]) -> int:
    """Prints the rows of the runs as CSV, and reports runs in which the rod is hardly worn."""
    results.show(COLUMNS, of_run, arguments)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
