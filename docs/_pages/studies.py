"""The studies in the gallery: a chart of the results that `problems` keeps, beside the experiments of their decks."""

from __future__ import annotations

import csv
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

import figures as pictures

from _pages.kinds import spoken
from hydro2d.files.shipped import problems_folder
from hydro2d.files.toml import is_study
from hydro2d.results import figures
from hydro2d.study.plan import cases

#: columns of kept results that are no axes begin with the first of these
FIRST = ("slenderness", "cells_across", "status", "member", "nose")
#: columns of what a run gave, and what the axis of the chart says
VALUES = {"depth_m": "depth [cm]", "depth_cm": "depth [cm]",
          "depth_over_length": "depth / length", "value": "number of the shot / its median",
          "force_GPa": "force over the section [GPa]"}
#: most labels of a chart
TICKS = 16
LIMITS = ("limits.png", "python -m problems.perforation.limits --figure limits.png")
#: studies whose picture is another page's: (picture, the command that draws it)
OTHERS = {
    **dict.fromkeys(("holes_psaap", "limits_ap_core", "limits_cone", "limits_psaap"), LIMITS),
    "weldox_velocities": ("weldox.png", "python -m problems.perforation.residual runs/weldox_velocities --figure weldox.png"),
    "whipple_shots": ("whipple_shots.png", "python -m problems.whipple.read --figure whipple_shots.png"),
    "drag": ("contact_skin.png", "hydro2d plot runs/drag/cases/contact_8.5 -o contact_skin.png --field plastic_strain --mirror "
             "velocity:z --time '200 us' --window '170 mm,205 mm,10 mm'"),
    "uncertain_shots": ("uncertain_shots.png", "python -m problems.cth_nose_shape.probability --figure uncertain_shots.png"),
    "copper_bars": ("fit_constants.png", "# the program of docs/how-to/fit-constants.md draws the picture"),
}
HEADING = """## Studies

Each study is one file, which `hydro2d sweep` runs, or `hydro2d transition` where it is a search. The charts show the results
that the repository keeps, filled marks, beside the depths that were measured, open diamonds. Times are the sum over all runs,
each on one core. The page of the folder says what came out.
"""


@dataclass(frozen=True)
class Study:
    """A study of `problems`; results : the rows that are kept, each with the names of its axes; empty if there are none.

    plan : None for a study of parts
    """

    file: Path
    title: str
    plan: cases.Plan | None
    results: list[dict[str, str]]

    @property
    def name(self) -> str:
        return self.file.stem

    @property
    def picture(self) -> str | None:
        """The picture in docs/_static."""
        return f"gallery_{self.name}.png" if self.has_chart else OTHERS.get(self.name, (None,))[0]

    @property
    def has_chart(self) -> bool:
        """Whether its kept results are drawn; those of a sample are not, since its inputs are no axes."""
        return bool(self.results) and self.name not in OTHERS

    def axes(self) -> list[str]:
        """The columns of the kept results that are axes."""
        names = list(self.results[0])
        return names[: next(names.index(name) for name in FIRST if name in names)]

    def most_runs(self) -> int:
        """Number of runs, of a search the largest; 0 for a study of parts."""
        if self.plan is None:
            return 0
        search, count = self.plan.search, len(self.plan.cases)
        return count // len(search.labels) * search.budget.runs if search and search.budget else count

    def minutes(self) -> float | None:
        """Sum of the minutes of all runs; None where the time of a run is not kept."""
        times = [row.get("minutes") or (float(row["wall_s"]) / 60.0 if row.get("wall_s") else None) for row in self.results]
        return sum(map(float, times)) if times and None not in times else None


def studies() -> list[Study]:
    """All studies, by folder and name."""
    files = sorted(file for file in problems_folder().rglob("*.toml") if file.parent.name != "materials")
    tables = {file: tomllib.loads(file.read_text(encoding="utf-8")) for file in files}
    return [Study(file, data["title"], None if "part" in data else cases.plan(file, quiet=True), _kept(file))
            for file, data in tables.items() if is_study(data)]


def _kept(file: Path) -> list[dict[str, str]]:
    kept = file.parent / "results" / f"{file.stem}.csv"
    if not kept.is_file():
        return []
    with kept.open(encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def _measured(study: Study) -> dict[str, float]:
    """Measured depth in cm of every case whose deck has one, by the name of the case and by the label of its shot."""
    found = {}
    for case in study.plan.cases:
        experiment = tomllib.loads(case.text or "").get("experiment", {})
        if experiment.get("penetration"):
            found[case.name] = found[case.values.get("shot", case.name)] = experiment["penetration"] * 100
    return found


def _value(row: dict[str, str], scale: dict[str, float]) -> float | None:
    name = next(name for name in VALUES if name in row)
    if not row[name]:
        return None
    return float(row[name]) * (100.0 if name == "depth_m" else 1.0) / scale.get(row.get("shot", ""), 1.0)


def chart(study: Study):
    """Depth, or the number of the study, against the shot or the velocity; colours are the other axes.

    Velocities of a search have their place on the axis, all else has the next one.
    """
    axes = study.axes()
    across = next((name for name in ("shot", "velocity") if name in axes), axes[-1])
    others, measured = [name for name in axes if name != across], _measured(study)
    value = next(name for name in VALUES if name in study.results[0])
    scale = _medians(study.results) if value == "value" else {}
    labels, search = sorted({row[across] for row in study.results}, key=_order), bool(study.plan and study.plan.search)
    at = {label: _order(label)[1] if search else number for number, label in enumerate(labels)}
    figure, ((place,),) = figures.new_figure(8.0, 4.2, 1, 1)
    groups = list(dict.fromkeys(tuple(row[name] for name in others) for row in study.results))
    for number, group in enumerate(groups):
        rows = [row for row in study.results if tuple(row[name] for name in others) == group]
        shift = 0.0 if search else 0.5 * (number + 0.5) / len(groups) - 0.25
        points = [(at[row[across]] + shift, found) for row in rows if (found := _value(row, scale)) is not None]
        place.plot([x for x, _ in points], [y for _, y in points], "os^vDP*X"[number % 8], markersize=4,
                   label=figures.verbatim(", ".join(group)) or None, color=f"C{number % 10}")
    keys = [(row[across], row.get("case", row.get("shot"))) for row in study.results]
    shots = {(at[label], measured[key]) for label, key in keys if key in measured}
    if shots:
        place.plot([x for x, _ in shots], [y for _, y in shots], "D", markersize=9, markerfacecolor="none", color="black",
                   label="measured")
    if search:
        place.set_xlabel("velocity [m/s]", fontsize=8)
        place.tick_params(axis="x", labelsize=7)
    else:
        some = range(0, len(labels), -(-len(labels) // TICKS))
        place.set_xticks(some, [figures.verbatim(labels[n]) for n in some], fontsize=7, rotation=30, ha="right")
    place.set_ylabel(VALUES[value], fontsize=8)
    if scale:
        place.set_ylim(0.8, 1.2)  # a block that is stuck in its hole, or not, lies outside
    place.tick_params(axis="y", labelsize=7)
    place.grid(alpha=0.3)
    if 0 < len(groups) <= 16:
        place.legend(fontsize=6, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _medians(rows: list[dict[str, str]]) -> dict[str, float]:
    found: dict[str, list[float]] = {}
    for row in rows:
        if row["value"]:
            found.setdefault(row["shot"], []).append(float(row["value"]))
    return {shot: sorted(values)[len(values) // 2] for shot, values in found.items()}


def _order(label: str) -> tuple:
    """Velocities by their number, all else by the alphabet."""
    first = label.split(" ")[0]
    return (0, float(first), label) if first.replace(".", "", 1).isdecimal() else (1, 0.0, label)


def draw(folder: Path) -> None:
    """Draws the charts of all studies with kept results."""
    for study in studies():
        if study.has_chart:
            with tempfile.TemporaryDirectory() as place:
                file = Path(place) / study.picture
                figures.save_figure(chart(study), file)
                pictures.shrink(file, folder / study.picture)
            print(f"{study.name}: {study.picture}", flush=True)


def sections() -> list[str]:
    """The part of the page on the studies."""
    parts = [HEADING]
    for study in studies():
        path = f"problems/{study.file.relative_to(problems_folder())}"
        search = study.plan.search if study.plan else None
        verb = "transition" if search else "sweep"
        minutes, count = study.minutes(), study.most_runs()
        told = f"At most {count} runs" if search else f"{count} runs" if count else "Several of the studies here"
        if study.plan and (study.plan.sample or search) and 0 < len(study.results) < count:
            told += f", of which {len(study.results)} are kept"
        told += f", {spoken(60.0 * minutes)} in all" if minutes else ""
        page = f"`{Path(path).parent}/README.md` says what came out"
        lines = [f"### {study.name}", "", f"{study.title}. {told}; {page}.", ""]
        if study.picture:
            lines += [f"![{study.title}](_static/{study.picture})", ""]
        lines += ["```text", f"hydro2d {verb} {path}"]
        lines += [OTHERS[study.name][1]] if study.name in OTHERS else []
        parts.append("\n".join([*lines, "```", ""]))
    return parts
