"""Whether the walls hold in runs of these decks, compared with the shots and with a ballistic limit equation.

    python -m problems.whipple.read RUN [RUN ...]     a row for each run, as CSV
    python -m problems.whipple.read [--figure PATH]   the tables of the README, from the rows kept in results

A row has the set-up of a run, the cells across the radius of the ball, whether the wall has a hole at the end, and the mass
that has left its rear. The wall has a hole if cells that it fills by less than half lead from its front to its rear.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import hydro2d
from problems import kept as results

HERE = Path(__file__).parent
SHOTS, KEPT, VELOCITIES = HERE / "shots.csv", HERE / "results" / "walls.csv", HERE / "results" / "wall_velocities.csv"
CHOICES = HERE / "results" / "choices.csv"
COLUMNS = ("case", "velocity_km_s", "bumper_mm", "gap_mm", "wall_mm", "cells", "hole", "behind_mg", "trusted", "method")
#: columns of shots.csv
TOLD = ("shot", "report", "velocity_km_s", "bumper_mm", "gap_mm", "wall_mm", "perforated", "half")
#: shots by which the set-up was chosen, and those run after that
HALVES = {"A": "chosen by", "B": "not looked at before"}
#: diameter in cm and density in g/cm^3 of the ball, density of the bumper in g/cm^3, yield stress of the wall in ksi
BALL, BALL_DENSITY, BUMPER_DENSITY, YIELD = 0.318, 2.8, 2.7, 40.0
#: velocities in km/s between which the limit of the equation is interpolated
SLOW, FAST = 3.0, 7.0
#: mass of the ball, mg
BALL_MASS = 1e3 * BALL_DENSITY * np.pi / 6.0 * BALL**3


def limit(velocity: float, bumper: float, gap: float, wall: float, density: float = BALL_DENSITY) -> float:
    """Diameter of the smallest aluminium ball that defeats a shield of 6061-T6 at normal incidence, cm.

    Christiansen, Int. J. Impact Engng 14 (1993) 145, for Whipple shields; the constants were read in pyBLOSSUM
    (shannonjryan/pyBLOSSUM), which adds a factor for thin bumpers and a variable SLOW that the paper does not have.

    velocity : km/s;  bumper, gap, wall : cm;  density : of the ball, g/cm^3
    """
    v = min(velocity, SLOW)
    slow = ((wall * (YIELD / 40.0) ** 0.5 + bumper) / (0.6 * density**0.5 * v ** (2 / 3))) ** (18 / 19)
    v = max(velocity, FAST)
    fast = 3.918 * wall ** (2 / 3) * gap ** (1 / 3) * (YIELD / 70.0) ** (1 / 3)
    fast /= density ** (1 / 3) * BUMPER_DENSITY ** (1 / 9) * v ** (2 / 3)
    share = min(max((velocity - SLOW) / (FAST - SLOW), 0.0), 1.0)
    return slow + share * (fast - slow)


def needed(gap: float) -> float:
    """Thickness of the wall in mm that just holds at 7 km/s behind a bumper of 0.84 mm, by the equation; gap : mm."""
    walls = np.geomspace(0.1, 30.0, 2000)
    return float(walls[np.argmax([limit(FAST, 0.084, 0.1 * gap, 0.1 * wall) >= BALL for wall in walls])])


def predicted(row: dict[str, str]) -> bool:
    """Whether the wall of a row is defeated by the equation; a row has the columns of shots.csv."""
    bumper, gap, wall = (0.1 * float(row[name]) for name in ("bumper_mm", "gap_mm", "wall_mm"))
    return limit(float(row["velocity_km_s"]), bumper, gap, wall) < BALL


def open_through(wall: np.ndarray) -> bool:
    """Whether a wall has a hole: cells filled by less than half lead from its front to its rear, over faces of cells.

    wall : volume fraction of the wall, float64[j, i], from the front on; the wall is whole in the outermost column
    """
    from scipy import ndimage

    labels, _ = ndimage.label(wall < 0.5)
    return bool(labels[0, -1] == labels[-1, -1])


def of_run(directory: Path) -> tuple:
    """The row of a run, in the order of COLUMNS. Raises ValueError if the run has not ended."""
    run = hydro2d.open_run(directory)
    if run.summary.stop_reason != "end time":
        raise ValueError("the run has not ended")
    ball, bumper, wall = run.deck.body
    size = float(np.diff(run.deck.edges()[0]).min())
    fraction = run.fields.volume_fraction.isel(time=-1).sel(body=wall.name).transpose("z", "r").values
    behind = run.summary.targets[wall.name].debris.mass_kg
    gap = wall.z_front - bumper.thickness - bumper.z_front
    lengths = (f"{1e3 * each:.4g}" for each in (bumper.thickness, gap, wall.thickness))
    hole = "yes" if open_through(fraction) else "no"
    return (directory.name, f"{1e-3 * ball.velocity[1]:g}", *lengths, round(ball.radius / size), hole, f"{1e6 * behind:.2f}",
            *results.standing(run.summary))


def defeated(row: dict[str, str], share: float = 1.0) -> bool:
    """Whether the wall of a run is defeated: more than this share of the ball's mass has left its rear, debris included."""
    return float(row["behind_mg"]) > share * BALL_MASS


def shots() -> list[dict[str, str]]:
    """The rows of shots.csv, each with `computed`, its kept rows by number of cells: the coarsest first."""
    runs: dict[str, list[dict[str, str]]] = {}
    for row in sorted(results.rows(KEPT, COLUMNS), key=lambda row: int(row["cells"])):
        runs.setdefault(row["case"].split("-")[-1], []).append(row)
    return [{**shot, "computed": runs.get(shot["shot"], [])} for shot in results.rows(SHOTS, TOLD)]


def measured(shot: dict) -> bool:
    """Whether the wall of a shot was defeated."""
    return shot["perforated"] == "yes"


def right(cases: list[dict], verdict) -> str:
    """Number of shots that end as `verdict`, a function of a shot, predicts; of how many."""
    return f"{sum(verdict(shot) == measured(shot) for shot in cases)} of {len(cases)}"


def ends(cases: list[dict], verdict) -> str:
    """The thickest wall that is defeated and the thinnest that holds, mm."""
    lost = [float(shot["wall_mm"]) for shot in cases if verdict(shot)]
    intact = [float(shot["wall_mm"]) for shot in cases if not verdict(shot)]
    return ", ".join("none" if not each else f"{pick(each):g}" for each, pick in ((lost, max), (intact, min)))


def computed(shot: dict) -> bool:
    """Whether the wall of a shot is defeated in its run on the coarsest mesh."""
    return defeated(shot["computed"][0])


def lost_a_third(shot: dict) -> bool:
    """Whether more than a third of the ball's mass has left the rear of the wall in its run."""
    return defeated(shot["computed"][0], 1.0 / 3.0)


def has_hole(shot: dict) -> bool:
    """Whether the wall of a shot has a hole in its run on the coarsest mesh."""
    return shot["computed"][0]["hole"] == "yes"


def lost_a_crumb(shot: dict) -> bool:
    """Whether the wall of a shot has a hole in its run, or a hundredth of the ball's mass has left its rear."""
    return has_hole(shot) or defeated(shot["computed"][0], 0.01)


#: criteria for a wall being defeated
VERDICTS = {
    "more than the mass of the ball has left its rear, which was chosen": computed,
    "more than a third of that mass, the best by A now": lost_a_third,
    "it has a hole": has_hole,
    "it has a hole, or a hundredth of that mass has left its rear": lost_a_crumb,
    "the equation says so": predicted,
    "it is a wall": lambda shot: True,
}


def score(cases: list[dict]) -> list[str]:
    """Lines of Markdown: how often each of VERDICTS is right, by half."""
    halves = [[shot for shot in cases if shot["half"] == half] for half in HALVES] + [cases]
    heads = " | ".join(f"{half}, {words}" for half, words in HALVES.items())
    lines = [f"| a wall is defeated if | {heads} | all |", "|---|---|---|---|"]
    for words, verdict in VERDICTS.items():
        lines.append(f"| {words} | " + " | ".join(right(half, verdict) for half in halves) + " |")
    return lines


def by_gap(cases: list[dict]) -> list[str]:
    """Lines of Markdown: the thickest wall that fails and the thinnest that holds, by gap, and how often runs are right."""
    lines = ["| gap | shots | experiments | runs | equation, 7 km/s | runs right | equation right |", "|---" * 7 + "|"]
    for gap in dict.fromkeys(shot["gap_mm"] for shot in cases):
        here = [shot for shot in cases if shot["gap_mm"] == gap]
        walls = " | ".join(f"{ends(here, verdict)} mm" for verdict in (measured, computed))
        least = f"{needed(float(gap)):.2g} mm"
        lines.append(f"| {gap} mm | {len(here)} | {walls} | {least} | {right(here, computed)} | {right(here, predicted)} |")
    return lines


def finer(cases: list[dict]) -> list[str]:
    """Lines of Markdown: the mass that has left the rear of walls computed on two meshes."""
    lines = ["| shot | gap | wall | the shot | left its rear, 8 cells | 16 cells |", "|---|---|---|---|---|---|"]
    for shot in cases:
        if len(shot["computed"]) > 1:
            ended = "defeated" if measured(shot) else "held"
            masses = " | ".join(f"{float(row['behind_mg']):.0f} mg" for row in shot["computed"])
            lines.append(f"| {shot['shot']} | {shot['gap_mm']} mm | {shot['wall_mm']} mm | {ended} | {masses} |")
    return lines


def by_velocity(rows: list[dict[str, str]]) -> list[str]:
    """Lines of Markdown: which walls hold, by velocity, in the runs and by the equation."""
    speeds = sorted({float(row["velocity_km_s"]) for row in rows})
    lines = ["| wall | by | " + " | ".join(f"{speed:g}" for speed in speeds) + " |", "|---" * (len(speeds) + 2) + "|"]
    for wall in dict.fromkeys(row["wall_mm"] for row in rows):
        here = {float(row["velocity_km_s"]): row for row in rows if row["wall_mm"] == wall}
        for words, verdict in (("run", defeated), ("equation", predicted)):
            outcomes = ["" if speed not in here else "fails" if verdict(here[speed]) else "holds" for speed in speeds]
            lines.append(f"| {wall} mm | {words} | " + " | ".join(outcomes) + " |")
    return lines


def chosen() -> list[str]:
    """Lines of Markdown: the mass that left the rear of the wall of one shot, for each choice in its runs, over members."""
    lines = ["| choice | runs | with a hole | left the rear, mg |", "|---|---|---|---|"]
    rows = [{**row, "case": row["case"].split("_m")[0]} for row in results.rows(CHOICES, COLUMNS)]
    for (choice,), members in results.grouped(rows, ["case"]).items():
        holes = sum(row["hole"] == "yes" for row in members)
        lines.append(f"| {choice} | {len(members)} | {holes} | {results.told(members, 'behind_mg')} |")
    return lines


def draw(cases: list[dict]):
    """A matplotlib Figure: walls by gap, with the outcomes of the shots, of their runs, and the limit by the equation."""
    figure, ((axes,),) = hydro2d.new_figure(6.4, 4.6)
    marks = {(False, measured): ("o", "none", "wall held"), (True, measured): ("o", "black", "wall defeated"),
             (False, computed): ("_", "#1f77b4", "run: held"), (True, computed): ("x", "#d62728", "run: defeated")}
    for (failed, verdict), (marker, colour, label) in marks.items():
        here = [shot for shot in cases if verdict(shot) == failed]
        gaps = [(1.0 if verdict is measured else 1.12) * float(shot["gap_mm"]) for shot in here]
        axes.plot(gaps, [float(shot["wall_mm"]) for shot in here], marker, color="black" if verdict is measured else colour,
                  markerfacecolor=colour, markersize=6, label=label)
    gaps = np.geomspace(5.0, 125.0, 20)
    axes.plot(gaps, [needed(gap) for gap in gaps], color="0.5", linewidth=0.8, label="equation, 7 km/s")
    axes.set(xscale="log", yscale="log", xlabel="gap [mm]", ylabel="thickness of the wall [mm]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    return figure


def main(arguments: list[str]) -> int:
    """Prints the rows of runs as CSV, and reports runs that have not ended; without runs, the tables."""
    parser = argparse.ArgumentParser(prog="read", description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="*", metavar="RUN", help="directory of a run")
    parser.add_argument("--figure", type=Path, metavar="PATH", help="also draws walls by gap, with their outcomes")
    given = parser.parse_args(arguments)
    if given.runs:
        results.show(COLUMNS, of_run, given.runs)
        return 0
    cases = shots()
    tables = score(cases), by_gap(cases), finer(cases), by_velocity(results.rows(VELOCITIES, COLUMNS)), chosen()
    print("\n\n".join("\n".join(each) for each in tables))
    if given.figure:
        hydro2d.save_figure(draw(cases), given.figure)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
