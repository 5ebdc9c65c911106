"""Length, foot and plastic strain of a bar that hits a wall, from the dumps of run directories, against Lagrangian solutions.

    python -m problems.validation.bar RUN [RUN ...] [--body NAME] [--json]

The length is the part of the axis that the bar fills. The foot is the first row from the front in which the bar fills at least
half of the cell on the axis. Its radius is that of a disk with the same area as the bar has there. Runs need not have ended.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import hydro2d

#: smallest volume fraction at which a cell belongs to the bar
HALF = 0.5


@dataclass(frozen=True)
class Bar:
    """A bar at one time (s): length and radius of the foot in m, and largest plastic strain (None if unknown)."""

    time: float
    length: float
    foot: float
    strain: float | None = None


#: Lagrangian solutions by impact speed (m/s) and initial length (m). The first is by an axisymmetric code with 24 to 32 cells
#: across the radius, and at the end by Carina.jl of Cthonios, TET15-P1, 190 727 elements. The second is by the same
#: axisymmetric code, 24 cells across.
REFERENCES = {
    (227.0, 32.4e-3): (
        Bar(20e-6, 28.063e-3, 6.195e-3), Bar(40e-6, 24.556e-3, 7.139e-3), Bar(80e-6, 21.42e-3, 7.226e-3, 3.18),
    ),
    (190.0, 25.4e-3): (
        Bar(20e-6, 21.740e-3, 6.384e-3), Bar(40e-6, 18.900e-3, 7.178e-3), Bar(60e-6, 17.375e-3, 7.266e-3, 2.00),
    ),
}


def shape(r_edges: np.ndarray, z_edges: np.ndarray, fraction: np.ndarray, strain: np.ndarray, direction: float,
          time: float) -> Bar:
    """The bar at one time, from its volume fraction and plastic strain in every cell, arrays (nz, nr).

    direction : sign of the impact velocity; if it is negative, the foot is at the lower end
    """
    column = fraction[:, 0]
    inside = np.nonzero(column >= HALF)[0]
    if len(inside) == 0:
        raise hydro2d.ResultsError(f"the bar is nowhere on the axis at {time * 1e6:.3g} us")
    row = fraction[inside[0] if direction < 0 else inside[-1]]
    return Bar(
        time=time,
        length=float(np.sum(column * np.diff(z_edges))),
        foot=float(np.sqrt(np.sum(row * np.diff(r_edges**2)))),
        strain=float(np.max(strain, where=fraction >= HALF, initial=0.0)),
    )


def reference(speed: float, length: float) -> tuple[Bar, ...]:
    """The Lagrangian solution for an impact speed (m/s) and initial length (m); empty if there is none."""
    for (v, l), bars in REFERENCES.items():
        if abs(speed - v) < 1e-3 * v and abs(length - l) < 5e-3 * l:
            return bars
    return ()


def measure(directory: Path | str, name: str | None = None) -> dict:
    """The bar in every dump, and its comparison with the reference at its times; SI. Raises hydro2d.Error."""
    run = hydro2d.open_run(directory)
    bodies = {body["name"]: body for body in run.tables["body"]}
    name = name or next(iter(bodies))
    if name not in bodies:
        raise hydro2d.ResultsError(f'{directory} has no body "{name}"; its bodies are {", ".join(bodies)}')
    velocity = bodies[name]["velocity"][1]
    fields = [f"Volume Fraction for {name}", f"Plastic Strain of {name}"]
    bars = []
    for time, file in run.dumps:
        dump = run.dump(time)
        if any(field not in dump.fields for field in fields):
            raise hydro2d.ResultsError(f'{file} lacks one of {", ".join(fields)}: add "body_plastic_strain" to output.fields')
        bars.append(shape(dump.r_edges, dump.z_edges, *(dump.fields[field] for field in fields), velocity, dump.time))
    if not bars:
        raise hydro2d.ResultsError(f"{directory} has no fields: no dump was written yet")
    known = reference(abs(velocity), bars[0].length)
    return {
        "run": run.label, "ended": bool(run.summary), "body": name, "velocity": velocity,
        "bars": [asdict(bar) for bar in bars],
        "compared": [
            {"found": asdict(at(bars, one.time)), "reference": asdict(one)} for one in known if one.time <= last(bars)
        ],
    }


def last(bars: list[Bar]) -> float:
    """Time that the dumps reach, s, plus a margin, because the last dump of a run may lie just short of its end."""
    return bars[-1].time * (1.0 + 1e-3)


def at(bars: list[Bar], time: float) -> Bar:
    """The bar at a time (s), interpolated between the dumps."""
    times = [bar.time for bar in bars]
    values = (np.interp(time, times, [getattr(bar, key) for bar in bars]) for key in ("length", "foot", "strain"))
    return Bar(time, *map(float, values))


def table(run: dict) -> str:
    """The measurements as Markdown, at the times of the reference, or for every dump if there is no reference."""
    lines = [f"**{run['run']}**, {run['body']} at {run['velocity']:.0f} m/s{'' if run['ended'] else ', not ended'}", "",
             "| time, us | length, mm | reference | error | foot, mm | reference | error | plastic strain | reference |",
             "|---|---|---|---|---|---|---|---|---|"]
    pairs = [(pair["found"], pair["reference"]) for pair in run["compared"]] or [(bar, None) for bar in run["bars"]]
    for bar, known in pairs:
        cells = [f"{bar['time'] * 1e6:.1f}"]
        for key in ("length", "foot"):
            cells += [f"{bar[key] * 1e3:.3f}"]
            cells += [f"{known[key] * 1e3:.3f}", f"{100 * (bar[key] / known[key] - 1):+.2f} %"] if known else ["", ""]
        cells += [f"{bar['strain']:.2f}", f"{known['strain']:.2f}" if known and known["strain"] else ""]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """The command. Returns 2 if a directory holds no run with such a body."""
    parser = argparse.ArgumentParser(prog="python -m problems.validation.bar", description=__doc__.splitlines()[0])
    parser.add_argument("run", nargs="+", type=Path, help="a run directory, finished or not")
    parser.add_argument("--body", help="the body to measure (default: the first of the deck)")
    parser.add_argument("--json", action="store_true", help="print JSON with every dump, SI units")
    given = parser.parse_args(arguments)
    try:
        results = [measure(directory, given.body) for directory in given.run]
    except hydro2d.Error as error:
        print(error, file=sys.stderr)
        return 2
    print(json.dumps(results, indent=2) if given.json else "\n\n".join(map(table, results)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
