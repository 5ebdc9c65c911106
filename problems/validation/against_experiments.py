"""Comparison of kept runs with every experiment, in the words of ASME V&V 20-2009: the file validation.csv, and the tables of
docs/explanation/validation.md.

    python -m problems.validation.against_experiments [--check]

All numbers come from the files in `results` next to the studies. Prints the tables, and writes them into the page and every
shot into validation.csv. With --check nothing is written, and the status is 1 if a file would change.
"""

from __future__ import annotations

import argparse
import io
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from statistics import median, stdev

import hydro2d
from problems import kept
from problems.cth_nose_shape import heads, members, rigid_rod
from problems.explosives import read as of_explosives
from problems.handbook import compare
from problems.long_rods import depths
from problems.perforation import limits, residual
from problems.validation import copper_bars

HERE = Path(__file__).parent
PROBLEMS = HERE.parent
FILE = HERE / "validation.csv"
PAGE = PROBLEMS.parent / "docs" / "explanation" / "validation.md"
#: first line of the file
NAMES = f"# Made for the method {hydro2d.METHOD}; the column method has that of the runs of each row"
COLUMNS = ("set", "shot", "quantity", "unit", "source", "predicted", "measured", "ended", "computed", "runs_ended", "E",
           "u_num", "u_num_from", "u_input", "u_input_from", "u_D", "u_D_from", "u_val", "within", "runs", "least", "most",
           "digits", "method")
#: the source of a set that is that of the set before it
SAME = "the same"
#: relative standard deviation of a measurement of which the source gives none, and how a row says so
ASSUMED, NOT_GIVEN = 0.05, "not given; 5 % assumed"
#: what a row has where a part of u_val is missing, and where the version of the method was not kept
NOT_SAMPLED, NOT_KNOWN, UNKNOWN = "not sampled", "not known", "unknown"
#: verdicts: whether |E| < 2 u_val, where u_val is not known at all, and whether runs without a value end as measured
YES, NO, OPEN, ALIKE, OTHERWISE = VERDICTS = ("yes", "no", "open", "ended alike", "ended otherwise")
#: what to do about a file that is not as it would be made
REMEDY = "python -m problems.validation.against_experiments makes it anew"
#: significant digits of a number in the file
DIGITS = 6
#: how a rod ends that leaves no value
PERFORATED, STOPPED = "perforated", "stopped"


@dataclass(frozen=True)
class Set:
    """Experiments of one kind: name, source, the choices made, the command, whether nothing was chosen, whether its runs
    count in experience.py, and the relative standard deviation of the measured values; None if the source gives none."""

    name: str
    source: str
    chosen: str
    command: str
    predicted: bool = True
    studied: bool = True
    error: float | None = None


#: relative scatter of the shots about Odermatt's fit, 2 to 3 % (problems/long_rods/README.md)
ODERMATT = 0.03
#: sets of which other files speak
WELDOX, BAR = "steel rods through Weldox 460 E", "Taylor bar"
LIMITS, BALLS = "ballistic limits of aluminium plates", "440C balls in 304 steel"
SETS = (
    Set("tungsten into aluminium", "Scheffler, CTH nose-shape study, Table 2",
        "nothing: Steinberg and Guinan's law for the study's alloy, its fracture pressures, no friction, 5.5 cells",
        "sweep problems/cth_nose_shape/twelve_shots.toml"),
    Set("tungsten into aluminium, sintered alloy", SAME,
        "the rod's law: that of another alloy, one of four that were tried; density of the shots' rods",
        "sweep problems/cth_nose_shape/twelve_shots.toml", predicted=False),
    Set("tungsten into aluminium, 90W-7Ni-3Fe", SAME, "the same, another of the four",
        "sweep problems/cth_nose_shape/twelve_shots.toml", predicted=False),
    Set("tungsten into aluminium, Y925", SAME, "the same, the last of the four",
        "sweep problems/cth_nose_shape/twelve_shots.toml", predicted=False),
    Set("eroding rods", "Luk & Piekutowski, Int. J. Impact Engng 11 (1991) 323",
        "nothing: contact, the rod's fracture pressure, 6 cells", "sweep problems/validation/eroded_heads.toml"),
    Set("steel rods, 1.6 GPa", "Forrestal & Piekutowski, Int. J. Impact Engng 24 (2000) 57, as tabled by others",
        "the rod's yield stress, 1.6 GPa without hardening, and the plate's law, Steinberg and Guinan's, one of four",
        "sweep problems/validation/rigid_steel_rods.toml", predicted=False),
    Set("steel rods, fitted law", SAME,
        "nothing: the rod's law fitted to flow stresses of 4340, Rc 38, without looking at depths; Johnson and Cook's for 6061",
        "sweep problems/validation/steel_rods_fitted.toml"),
    Set("tungsten into armour steel", "Odermatt's fit to many shots, BHN 270, read in a public source",
        "nothing: 6.5 cells", "sweep problems/long_rods/velocities.toml", error=ODERMATT),
    Set(WELDOX, "Borvik and others, Int. J. Impact Engng 27 (2002) 19, recalled",
        "nothing: 20.5 cells, one run each", "sweep problems/perforation/weldox_velocities.toml"),
    Set(BAR, "Johnson & Cook (1983) and Gust (1982), as B. Banerjee tabulates them",
        "nothing: Johnson and Cook's constants as published; one bar with every advection, 8 and 16 cells, the others by the "
        "surrogate of a sample, 8 cells", "sweep problems/validation/copper_bars.toml"),
    Set("cylinder test", "Dobratz & Crawford, UCRL-52997 (1985), recalled", "nothing", "run problems/explosives/cylinder.toml"),
    Set("driven by an explosive", "Gurney's formula with the energies of the same handbook, recalled: a fit to many shots",
        "nothing", "run problems/explosives/sandwich.toml"),
    Set("blast in air", "Kingery and Bulmash's fit to many blasts in Swisdak's form, recalled",
        "nothing: cells of 25 mm, one run", "run problems/explosives/air_blast.toml", studied=False),
    Set("craters of aluminium balls", "NASA's equation, a fit to many shots (Cour-Palais 1987), with a Brinell hardness of 95",
        "nothing that is recorded: laws of the library, 8.5 cells, one run each", "run problems/hypervelocity/crater.toml",
        studied=False),
    Set("cone through 20 mm", "Borvik and others 2004, recalled: a limit of 249 m/s, with Recht and Ipson's formula",
        "nothing that is recorded: laws of the library, 10.5 cells, one run each", "run problems/perforation/cone.toml",
        studied=False),
    Set("striker bar", "elastic waves, exact", "nothing: contact, 5 cells, one run",
        "run problems/verification/striker_bar.toml", studied=False, error=0.0),
    Set(LIMITS, "Forrestal and others 2014, in the REL database; Borvik and others 2004, recalled",
        "nothing: 8.5 and 10.5 cells, one run for each velocity; the damage of the plate of 6082 is that of 6061",
        "sweep problems/perforation/limits_ap_core.toml"),
    Set(BALLS, "surrogate model of the Caltech PSAAP centre: a formula fitted to shots",
        "nothing by looking at results: the law of the ball is borrowed, the fracture strain of the plate, 1.2, is that of a "
        "recalled reduction of area; 10.5 cells", "sweep problems/perforation/limits_psaap.toml"),
    Set("handbooks", "fits to experiments and theories: problems/handbook/results/expected.csv, written before the first run",
        "nothing: one run each", "run problems/handbook/bumper.toml", studied=False),
    Set("handbooks, decks changed", SAME,
        "after the first run: an empty bubble, four cells across the tube, a heavier wedge",
        "run problems/handbook/slam.toml", predicted=False, studied=False),
)

#: sets of which single_runs.csv has the shots
SINGLE = ("blast in air", "craters of aluminium balls", "cone through 20 mm", "striker bar")

#: sets of the twelve shots by the law of the rod
LAWS = {"Steinberg-Guinan": "tungsten into aluminium", "Johnson-Cook, sintered": "tungsten into aluminium, sintered alloy",
        "Johnson-Cook, 90W": "tungsten into aluminium, 90W-7Ni-3Fe", "Johnson-Cook, Y925": "tungsten into aluminium, Y925"}
#: the law of the rod of convergence.toml
CONVERGED = "Steinberg-Guinan"
#: inputs of uncertain_shots.toml by its heads
MATERIAL, DEPTH = "materials.rod_alloy.based_on", "depth_m"

#: metal that an explosive drives, by the deck of problems/explosives
DRIVEN = {"cylinder": "tube", "plate_push": "plate on a charge", "sandwich": "two plates around a charge"}


@dataclass(frozen=True)
class Row:
    """A shot beside its runs.

    name, shot : its set and its name
    measured, unit : the measured value; None for an outcome, which `ended` says
    computed : the values of its runs;  said : how they ended, if not with a value
    around : values of all runs of the shot by the same method, on every mesh, and the number of meshes
    sampled : values of runs with other values of the uncertain inputs, and the version of their method
    method : version of the method of the runs
    """

    name: str
    shot: str
    measured: float | None
    unit: str
    computed: tuple[float, ...]
    said: str = ""
    digits: int = 1
    quantity: str = "depth"
    ended: str = ""
    around: tuple[tuple[float, ...], int] = ((), 1)
    sampled: tuple[tuple[float, ...], str] = ((), "")
    method: str = UNKNOWN

    def record(self, of: Set, source: str = "") -> dict[str, str]:
        """The row of the file: E, its uncertainties and the verdict, as ASME V&V 20-2009 has them."""
        values, meshes = self.around
        sample, method = self.sampled
        about = dict.fromkeys(COLUMNS, "") | {
            "set": self.name, "shot": self.shot, "quantity": self.quantity, "unit": self.unit, "source": source,
            "predicted": "yes" if of.predicted else "no", "measured": _text(self.measured), "ended": self.ended,
            "runs_ended": self.said, "runs": str(len(self.computed)), "digits": str(self.digits), "method": self.method}
        if self.said or self.measured is None:
            alike = bool(self.said) and self.measured is None and self.said.startswith(self.ended)
            return about | self._computed() | {"within": ALIKE if alike else OTHERWISE}
        error = of.error if of.error is not None else ASSUMED
        parts = {"u_num": stdev(values) if len(values) > 1 else None, "u_input": stdev(sample) if len(sample) > 1 else None,
                 "u_D": error * abs(self.measured)}
        u_val = math.sqrt(sum(part**2 for part in parts.values() if part is not None))
        difference = median(self.computed) - self.measured
        return about | self._computed() | {name: _text(part) for name, part in parts.items()} | {
            "E": _text(difference), "u_val": _text(u_val),
            "within": OPEN if not u_val else YES if abs(difference) < 2.0 * u_val else NO,
            "u_num_from": f"{len(values)} runs, {meshes} mesh{'es' * (meshes > 1)}" if len(values) > 1 else NOT_KNOWN,
            "u_input_from": f"{len(sample)} samples of {method}" if len(sample) > 1 else NOT_SAMPLED,
            "u_D_from": NOT_GIVEN if of.error is None else f"{100.0 * of.error:g} %, stated" if of.error else "exact"}

    def _computed(self) -> dict[str, str]:
        """The median of the runs, and their least and largest value if there are several; nothing of runs without a value."""
        values = () if self.said else self.computed
        ends = {"least": min(values), "most": max(values)} if len(values) > 1 else {}
        middle = {"computed": median(values)} if values else {}
        return {name: _text(value) for name, value in (middle | ends).items()}


def _text(value: float | None) -> str:
    return "" if value is None else f"{value:.{DIGITS}g}"


def twelve(name: str, law: str) -> list[Row]:
    """The twelve shots with one law; of one law there are members on several meshes as well."""
    folder = PROBLEMS / "cth_nose_shape/results"
    file = folder / "twelve_shots.csv"
    measured, rows, samples = rigid_rod.experiments(), [], _samples(rigid_rod.LAWS[law])
    all_of = members.grouped(rigid_rod.read(file)).get(law, {})
    if law == CONVERGED:
        all_of |= members.grouped(rigid_rod.read(folder / "convergence.csv"))[""]
    by_shot = members.grouped(rigid_rod.read(file, heads.CELLS)).get(law, {})
    for shot, runs in sorted(by_shot.items()):
        experiment, versions = measured[shot], {run.method for run in runs}
        through = sum(run.depth is None for run in runs)
        said = f"{PERFORATED} in {through} of {len(runs)} runs" if through else ""
        others = [run for run in all_of[shot] if run.method in versions]
        rows.append(Row(
            name, str(shot), None if experiment.kind == "at least" else 1e2 * experiment.depth, "cm",
            tuple(run.reach for run in runs), said, ended=PERFORATED if experiment.kind == "at least" else "",
            around=(tuple(run.reach for run in others), len({run.labels[rigid_rod.CELLS] for run in others})),
            sampled=samples.get(shot, ((), "")), method=_of(versions)))
    return rows


def _of(versions: set[str]) -> str:
    return "; ".join(sorted(versions))


@cache
def _samples(law: str) -> dict[rigid_rod.Shot, tuple[tuple[float, ...], str]]:
    """Depths (cm) of the hemispherical shots with one law of the rod, a material, at values of the other uncertain inputs.

    Of the meshes that were run, that with the most rows counts.
    """
    found: dict[rigid_rod.Shot, tuple[tuple[float, ...], str]] = {}
    for sample in hydro2d.kept_samples(PROBLEMS / "cth_nose_shape/uncertain_shots.toml"):
        own = sample.table[(sample.table[MATERIAL] == law) & sample.ended]
        shot = rigid_rod.Shot.named(sample.labels[rigid_rod.SHOTS])
        if shot and len(own) > len(found.get(shot, ((), ""))[0]):
            found[shot] = tuple(1e2 * own[DEPTH]), _of(set(own["method"]))
    return found


def eroding(name: str) -> list[Row]:
    """Luk and Piekutowski's rods, which fail by their fracture pressure."""
    return [Row(name, heads.SHOTS[run.labels["shot"]][0], heads.measured(run.labels["shot"]), "cm", (run.depth,),
                method=run.method)
            for run in rigid_rod.read(HERE / "results/eroded_heads.csv")
            if run.labels["failure"] == "fracture pressure" and run.depth is not None]


def steel(name: str, file: str, **labels: str) -> list[Row]:
    """Forrestal and Piekutowski's rods, of the runs with these labels."""
    measured = {round(experiment.velocity): 1e2 * experiment.penetration for path in sorted(HERE.glob("rigid_6061_*.toml"))
                if (experiment := hydro2d.Deck.from_file(path).experiment)}
    runs = [run for run in rigid_rod.read(HERE / "results" / file)
            if all(run.labels.get(axis) == label for axis, label in labels.items())]
    return [Row(name, f"{run.labels['shot']} m/s", measured[int(run.labels["shot"])], "cm", (run.depth,), method=run.method)
            for run in sorted(runs, key=lambda run: int(run.labels["shot"]))
            if int(run.labels["shot"]) in measured and run.depth is not None]


def armour(name: str) -> list[Row]:
    """Long rods, depth over length, against the fit."""
    rows, folder = [], PROBLEMS / "long_rods/results"
    meshes = depths.read(folder / "meshes.csv")
    for run in sorted(depths.read(folder / "velocities.csv"), key=lambda run: (int(run.labels["L/D"]), run.velocity)):
        fit = depths.odermatt(run.velocity, float(run.labels["L/D"]), 270.0, *depths.DENSITIES)
        same = [run, *(other for other in meshes if other.cells != run.cells and (
            other.slenderness, other.velocity, other.method) == (run.slenderness, run.velocity, run.method))]
        rows.append(Row(name, f"L/D {run.labels['L/D']}, {run.velocity:g} m/s", fit, "L", (run.ratio,), digits=2,
                        around=(tuple(each.ratio for each in same), len(same)), method=run.method))
    return rows


def weldox(name: str) -> list[Row]:
    """Steel rods with a hemispherical nose: the velocity left behind a plate."""
    measured, rows = residual.experiments(), []
    for _, run in hydro2d.runs(PROBLEMS / "perforation/results/weldox.csv").iterrows():
        velocity, through = hydro2d.to_si(run["velocity"], "m/s"), bool(run["perforated"])
        left = measured[run["nose"], velocity]
        rows.append(Row(name, f"{run['nose']}, {velocity:g} m/s", left or None, "m/s",
                        (run["residual_velocity_m_s"],) if through else (), "" if through else STOPPED, 0, "residual velocity",
                        "" if left else STOPPED, method=run["method"]))
    return rows


def ballistic(name: str, fit: bool) -> list[Row]:
    """Ballistic limits that were measured, or those of a formula; the meshes of a shot are its runs."""
    rows = []
    for each in (one for one in limits.measured() if one.fit == fit):
        meshes = limits.meshes(each.deck)
        rows.append(Row(name, each.shot, each.limit, "m/s", (meshes[0].limit,), digits=0, quantity="ballistic limit",
                        around=(tuple(mesh.limit for mesh in meshes), len(meshes)), method=meshes[0].method))
    return rows


def balls(name: str) -> list[Row]:
    """The limit and the holes of balls in 304 steel."""
    return ballistic(name, fit=True) + [
        Row(name, f"hole in {hole.thickness:g} mm, {hole.velocity:g} km/s", hole.measured, "mm2", (hole.computed,), digits=2,
            quantity="area of the hole", method=hole.method) for hole in limits.holes()]


def bars(name: str) -> list[Row]:
    """Taylor bars of copper: the length that is left."""
    return [Row(name, f"{bar.name}, {bar.velocity:g} m/s", bar.measured, "mm", bar.computed, quantity="length", digits=2,
                around=(bar.computed, len(set(bar.cells))), method=bar.method) for bar in copper_bars.bars()]


def explosives(name: str) -> list[Row]:
    """Velocities of the wall of the cylinder test."""
    return [Row(name, f"{row['explosive']}, {row['quantity']}", *_of_explosive(row), digits=2, quantity=row["quantity"],
                method=row["method"])
            for row in of_explosives.kept() if row["quantity"].startswith("wall velocity")]


def gurney(name: str) -> list[Row]:
    """Final velocities of metal that an explosive drives."""
    return [Row(name, f"{DRIVEN[row['deck']]}, {row['explosive']}", *_of_explosive(row), digits=2, quantity=row["quantity"],
                method=row["method"])
            for row in of_explosives.kept() if row["quantity"] == "final velocity"]


def _of_explosive(row: dict[str, str]) -> tuple[float, str, tuple[float]]:
    """The expected value, its unit, and the value of the run."""
    return float(row["expected"]), row["unit"], (float(row["obtained"]),)


def single(name: str) -> list[Row]:
    """Shots that were run once."""
    columns = ("set", "shot", "unit", "measured", "computed", "digits", "method")
    return [Row(name, row["shot"], float(row["measured"]), row["unit"], (float(row["computed"]),), digits=int(row["digits"]),
                quantity=row["shot"], method=row["method"])
            for row in kept.rows(HERE / "single_runs.csv", columns) if row["set"] == name]


def handbooks(name: str, changed: bool) -> list[Row]:
    """The ten problems from handbooks: those whose deck was changed after the first run, or the others."""
    found = compare.obtained()
    return [Row(name, f"{row['deck']}, {row['quantity']}".replace("_", " "), float(row["expected"]), row["unit"],
                (float(of["obtained"]),), digits=2, quantity=row["quantity"], method=of["method"])
            for row in compare.expected() if (row["deck"] in compare.CHANGED) == changed
            for of in [found[row["deck"], row["quantity"]]]]


def rows() -> dict[str, list[Row]]:
    """The shots by set, in the order of SETS."""
    names = [each.name for each in SETS]
    others = names[len(LAWS):]
    sets = (*map(twelve, names, LAWS), eroding(others[0]),
            steel(others[1], "rigid_steel_rods.csv", target="Steinberg-Guinan", rod="1.6 GPa"),
            steel(others[2], "steel_rods_fitted.csv", rod="fit, Rc 38"), armour(others[3]), weldox(WELDOX), bars(BAR),
            explosives(others[6]), gurney(others[7]), *map(single, SINGLE), ballistic(LIMITS, fit=False),
            balls(BALLS), *map(handbooks, names[-2:], (False, True)))
    return dict(zip(names, sets, strict=True))


def records() -> list[dict[str, str]]:
    """The rows of the file, made from the kept results."""
    found, source, made = rows(), "", []
    for each in SETS:
        source = source if each.source == SAME else each.source
        made += [row.record(each, source) for row in found[each.name]]
    return made


def text(made: Sequence[Mapping[str, str]]) -> str:
    """The file of these rows."""
    out = io.StringIO(newline="")
    out.write(f"{NAMES}\n")
    kept.write_to(out, COLUMNS, made)
    return out.getvalue()


def read(file: Path, made: Sequence[Mapping[str, str]]) -> list[dict[str, str]]:
    """The rows of a file.

    made : the rows that the kept results give

    Raises StudyError for a file or a row that names another version of the method than that which made it.
    """
    with open(file, encoding="utf-8") as lines:
        if (first := lines.readline().rstrip()) != NAMES:
            raise hydro2d.StudyError(f'{file}:1: has "{first}", expected "{NAMES}"; {REMEDY}')
    methods = {(row["set"], row["shot"]): row["method"] for row in made}
    found = kept.rows(file, COLUMNS)
    for row in found:
        if row["method"] != (own := methods.get((row["set"], row["shot"]), "none")):
            raise hydro2d.StudyError(f"{file}: {row['set']}, {row['shot']}: names the method {row['method']}, and its runs are "
                                     f"of {own}; {REMEDY}")
    return found


HEADS = ("set", "shot", "measured", "computed", "E", "u_num", "u_input", "u_D", "u_val", "\\|E\\| < 2 u_val", "method")


def line(row: Mapping[str, str]) -> str:
    """A row of the file as a line of Markdown."""
    digits, unit = int(row["digits"]), row["unit"]

    def number(name: str) -> str:
        return f"{float(row[name]):.{digits}f}"

    computed = row["runs_ended"]
    if not computed and row["computed"]:
        spread = f" ({number('least')} to {number('most')}, {row['runs']} runs)" if row["least"] else ""
        computed = f"{number('computed')} {unit}".rstrip() + spread
    given = row["ended"] or f"{number('measured')} {unit}".rstrip()
    if not row["E"]:
        return f"| {' | '.join((row['set'], row['shot'], given, computed, *[''] * 5, row['within'], row['method']))} |"
    error = f"{float(row['E']):+z.{digits}f}, {100.0 * float(row['E']) / float(row['measured']):+z.0f} %"
    parts = [f"{float(row[name]):.2g} ({row[f'{name}_from']})" if row[name] else row[f"{name}_from"]
             for name in ("u_num", "u_input", "u_D")]
    least = "" if row["u_num"] and row["u_input"] else "at least "
    return (f"| {row['set']} | {row['shot']} | {given} | {computed} | {error} | {' | '.join(parts)} | "
            f"{least}{float(row['u_val']):.2g} | {row['within']} | {row['method']} |")


def tables(found: Sequence[Mapping[str, str]]) -> Mapping[str, Callable[[], list[str]]]:
    """The tables of the page, by name: the sets; the shots predicted; those for which something was chosen; the summary."""
    heads = [f"| {' | '.join(HEADS)} |", "|---" * len(HEADS) + "|"]
    return {
        "sets": lambda: ["| set | source | chosen | repeat with `hydro2d` |", "|---|---|---|---|",
                         *(f"| {each.name} | {each.source} | {each.chosen} | `{each.command}` |" for each in SETS)],
        "predicted": lambda: [*heads, *(line(row) for row in found if row["predicted"] == "yes")],
        "chosen": lambda: [*heads, *(line(row) for row in found if row["predicted"] == "no")],
        "verdicts": lambda: verdicts(found),
    }


def verdicts(found: Sequence[Mapping[str, str]]) -> list[str]:
    """Lines of Markdown: the number of shots by verdict, and the sets by the method of their rows."""
    lines = ["| shots | within 2 u_val | not within | open | ended alike | ended otherwise |", "|---" * 6 + "|"]
    for name, predicted in (("predicted", "yes"), ("something was chosen", "no")):
        own = [row["within"] for row in found if row["predicted"] == predicted]
        lines.append(f"| {name}: {len(own)} | {' | '.join(str(own.count(word)) for word in VERDICTS)} |")
    sets: dict[str, dict[str, None]] = {}
    for row in found:
        if row["method"] != hydro2d.METHOD:
            sets.setdefault(row["method"], {})[row["set"]] = None
    if sets:
        lines += ["", f"The present version of the method is {hydro2d.METHOD}. Rows of other versions:", "",
                  "| version | sets |", "|---|---|"]
    return lines + [f"| {method} | {'; '.join(names)} |" for method, names in sorted(sets.items())]


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; the status says whether a file would change")
    check = parser.parse_args(arguments).check
    made = records()
    if kept.renew(FILE, text(made), check) and check:
        return 1
    filled = tables(read(FILE, made))
    print("\n\n".join("\n".join(make()) for make in filled.values()))
    return kept.fill([PAGE], filled, check)


if __name__ == "__main__":
    sys.exit(main())
