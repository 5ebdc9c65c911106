"""The hemispherical shots with each law of the plate and of the rod: tables of results/plate_laws.csv for the pages."""

from __future__ import annotations

from problems.cth_nose_shape import rigid_rod
from problems.cth_nose_shape.rigid_rod import Result, Shot

FILE = rigid_rod.EXPERIMENTS.with_name("results") / "plate_laws.csv"
#: the rod whose depth shows the drag of the plate
STIFF = "cannot yield"


def found(*alloys: str) -> dict[tuple[str, str], dict[Shot, Result]]:
    """The kept runs into plates of these alloys, by laws of plate and rod, and by shot."""
    runs: dict[tuple[str, str], dict[Shot, Result]] = {}
    for run in rigid_rod.read(FILE):
        if run.shot.alloy in alloys:
            runs.setdefault((run.labels["plate"], run.labels["rod"]), {})[run.shot] = run
    return runs


def as_measured(run: Result) -> bool:
    """Whether the rod of a run held or eroded as that of its shot did."""
    return run.held == rigid_rod.experiments()[run.shot].rigid


def table(alloy: str) -> list[str]:
    """Lines of Markdown: depth and length lost in a plate of this alloy, by law of the plate and of the rod."""
    runs = found(alloy)
    shots = sorted(next(iter(runs.values())), key=lambda shot: shot.velocity)
    measured = [rigid_rod.experiments()[shot] for shot in shots]
    heads = [f"{shot.velocity:g} m/s: {1e2 * each.depth:.1f} cm, {'rigid' if each.rigid else 'eroded'}"
             for shot, each in zip(shots, measured, strict=True)]
    lines = ["| plate | rod | " + " | ".join(heads) + " |", "|---" * (len(heads) + 2) + "|"]
    before = None
    for (plate, rod), cases in runs.items():
        cells = [f"**{cases[shot]}**" if rod != STIFF and as_measured(cases[shot]) else str(cases[shot]) for shot in shots]
        lines.append(f"| {plate if plate != before else ''} | {rod} | " + " | ".join(cells) + " |")
        before = plate
    return [*lines, *rigid_rod.notes([run for cases in runs.values() for run in cases.values()])]


def pairs() -> tuple[int, int]:
    """How many pairs of laws in 5083 end all three shots as measured, and how many pairs there are."""
    of_pairs = [cases for (_, rod), cases in found("5083").items() if rod != STIFF]
    return sum(all(map(as_measured, cases.values())) for cases in of_pairs), len(of_pairs)
