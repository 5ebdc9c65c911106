"""Bias and scatter of computed values, for each kind of shot of which results with measured values are kept.

    python -m problems.validation.experience [--check]

Prints the tables of docs/explanation/experience.md, and writes them there and into results/experience.csv, which `hydro2d
report` and `hydro2d model` read. With --check nothing is written, and the status is 1 if a file would change.

A shot has a ratio of computed to measured value for each of its kept runs: members of an ensemble and meshes of one set-up. Its
own ratio is their median, and their spread is the numerical uncertainty. Rods are sorted by the regime in which most of a
shot's runs end. Analytic models are evaluated with the inputs that the decks of the shots and the library give; those that
need more have no row. Their rods are sorted by how they ended in the experiment.
"""

from __future__ import annotations

import argparse
import io
import math
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from functools import cache
from pathlib import Path
from statistics import median

import hydro2d
from problems import kept
from problems.cth_nose_shape import heads, rigid_rod
from problems.explosives import read as of_explosives
from problems.long_rods import depths
from problems.perforation import limits
from problems.validation import against_experiments as against
from problems.validation import copper_bars
from problems.whipple import read as whipple

HERE = Path(__file__).parent
PROBLEMS = HERE.parent
FILE = HERE / "results" / "experience.csv"
PAGE = PROBLEMS.parent / "docs" / "explanation" / "experience.md"
SHOTS = ("series", "deck", "rod", "velocity_m_s", "depth_mm", "width_mm", "ended")

RUNS, DEPTH, HOLE, RESIDUAL, PERFORATION = "hydro2d", "depth", "hole diameter", "residual velocity", "perforation"
LIMIT = "ballistic limit"
STAYED_RIGID, ERODED = "stayed rigid", "eroded"
#: sets that against_experiments does not have, and whether something was chosen by looking at results
HARDNESS = "tungsten into 4340 steel of four hardnesses"
SHIELDS, SHIELDS_CHOSEN = "Whipple shields, half B", "Whipple shields, half A"
CHOSEN = {each.name: not each.predicted for each in against.SETS} | {
    HARDNESS: False, SHIELDS: False, SHIELDS_CHOSEN: True}
#: relative standard deviation of measurements where a source gives it
ERRORS = {each.name: each.error for each in against.SETS} | {HARDNESS: against.ODERMATT}
#: materials of the rods of twelve_shots.toml, and of rods and targets of rigid_steel_rods.toml and steel_rods_fitted.toml
RODS = {**rigid_rod.LAWS, "1.6 GPa": "steel_4340_rod", "fit, Rc 38": "steel_4340_Rc38"}
PLATE = "Al6061_T6"
#: armour of hardness.toml
ARMOUR = {**{f"BHN {hardness}": "steel_4340" for hardness in (230, 270, 300, 350)},
          "fit Rc 32": "steel_4340_Rc32", "fit Rc 38": "steel_4340_Rc38"}
#: significant digits of a number in the file
DIGITS = 4
#: regime of rows that do not say whether the nose was kept
REGIMES = {"rigid or deforming": "deforming"}
#: regimes of analytic models in which their depth is not the final one
UNFINISHED = ("perforated", "reaches stage two")


@dataclass(frozen=True)
class Shot:
    """A shot of one set beside its runs, or beside an analytic model.

    set : its set;  quantity, impact, ended : its kind
    ratios : computed over measured value of every run; empty if one of the two is missing
    right : whether most runs perforate, or do not, as measured; None if nobody asks
    missed : whether there is no ratio since the runs perforate although the measured projectile stopped; of a residual
        velocity, since they stop although it perforated
    velocity : of impact, m/s;  cells : across the radius, of each run;  fit : whether the measured value is a fit's
    of : "hydro2d" or the model
    """

    set: str
    quantity: str
    impact: hydro2d.Impact
    ended: str
    ratios: tuple[float, ...]
    right: bool | None = None
    missed: bool = False
    velocity: float | None = None
    cells: tuple[float, ...] = ()
    fit: bool = False
    of: str = RUNS

    @property
    def key(self) -> tuple:
        """Shots with the same key are in one row; a set for which something was chosen has rows of its own."""
        own = self.set if CHOSEN.get(self.set) else ""
        return own, self.of, self.quantity, self.impact, self.ended, self.fit


@cache
def impact(deck: str, *changes: str) -> hydro2d.Impact:
    """What strikes what in a deck of `problems` with changes, such as 'body.rod.material="W_alloy"'."""
    known = hydro2d.impact_of(hydro2d.Deck.from_file(PROBLEMS / deck, list(changes)))
    assert known is not None, deck
    return known


def _of(body: str, material: str) -> str:
    """The change of a deck that gives one of its bodies a material of the library."""
    return f'body.{body}.material="{material}"'


def shots() -> list[dict[str, str]]:
    """The rows of shots.csv."""
    return kept.rows(HERE / "shots.csv", SHOTS)


def _ended(runs: Sequence[rigid_rod.Result]) -> str:
    """The regime in which most runs end; of two, the one of faster rods."""
    order = ("rigid", "deforming", "eroding")
    counts = Counter(REGIMES.get(run.regime, run.regime) for run in runs)
    return max(counts, key=lambda regime: (counts[regime], order.index(regime)))


def _cells(runs: Sequence[rigid_rod.Result]) -> tuple[float, ...]:
    return tuple(float(run.labels[rigid_rod.CELLS]) for run in runs)


def _grouped(runs: Iterable[rigid_rod.Result], label: Callable[[rigid_rod.Result], object]) -> dict:
    groups: dict[object, list[rigid_rod.Result]] = {}
    for run in runs:
        groups.setdefault(label(run), []).append(run)
    return groups


def _deck(shot: rigid_rod.Shot) -> str:
    """The deck of one of the twelve shots."""
    return f"{'ogive' if shot.nose == 'ogival' else 'hemi'}_{shot.alloy}_{shot.velocity:g}.toml"


def twelve() -> list[Shot]:
    """Depths of the twelve shots with every law, and whether they perforate, on all meshes."""
    measured, compared = rigid_rod.experiments(), []
    runs = rigid_rod.read(PROBLEMS / "cth_nose_shape/results/twelve_shots.csv")
    for (law, shot), members in _grouped(runs, lambda run: (run.labels["law"], run.shot)).items():
        stopped = [run for run in members if run.depth is not None]
        through, experiment = 2 * len(stopped) <= len(members), measured[shot]
        what = impact(f"cth_nose_shape/{_deck(shot)}", _of("rod", RODS[law]))
        perforated = experiment.kind == "at least"
        ratios = () if through or perforated else tuple(1e-2 * run.reach / experiment.depth for run in members)
        about = {"velocity": shot.velocity, "cells": _cells(members)}
        name = against.LAWS[law]
        compared.append(Shot(name, DEPTH, what, _ended(members), ratios, missed=through and not perforated, **about))
        compared.append(Shot(name, PERFORATION, what, "", (), right=through == perforated, **about))
    return compared


def eroding() -> list[Shot]:
    """Depths and holes of Luk and Piekutowski's rods, which fail by their fracture pressure.

    The hole is the mean diameter of the run over the largest one that was measured.
    """
    compared, measured = [], {(row["deck"], float(row["velocity_m_s"])): row for row in shots()}
    runs = [run for run in rigid_rod.read(HERE / "results/eroded_heads.csv") if run.labels["failure"] == "fracture pressure"]
    for label, members in _grouped(runs, lambda run: run.labels["shot"]).items():
        deck = heads.SHOTS[label][1]
        velocity = float(label.rpartition("-")[2])
        row, what = measured[deck.stem, velocity], impact(f"validation/{deck.name}")
        about = {"velocity": velocity, "cells": _cells(members)}
        ended = _ended(members)
        compared.append(Shot("eroding rods", DEPTH, what, ended,
                          tuple(10.0 * run.depth / float(row["depth_mm"]) for run in members), **about))
        widths = (20.0 * math.sqrt(run.hole / (math.pi * run.depth)) for run in members)
        compared.append(Shot("eroding rods", HOLE, what, ended, tuple(w / float(row["width_mm"]) for w in widths), **about))
    return compared


def rigid() -> list[Shot]:
    """Depths of Forrestal and Piekutowski's rods, in the runs that against_experiments has."""
    compared = []
    measured = {float(row["velocity_m_s"]): float(row["depth_mm"]) for row in shots() if row["series"] == "rigid steel"}
    sets = (("steel rods, 1.6 GPa", "rigid_steel_rods.csv", {"target": "Steinberg-Guinan", "rod": "1.6 GPa"}),
            ("steel rods, fitted law", "steel_rods_fitted.csv", {"rod": "fit, Rc 38"}))
    for name, file, labels in sets:
        runs = [run for run in rigid_rod.read(HERE / "results" / file) if labels.items() <= run.labels.items()]
        for velocity, members in _grouped(runs, lambda run: float(run.labels["shot"])).items():
            if velocity in measured:
                what = impact("validation/rigid_6061_967.toml", _of("rod", RODS[labels["rod"]]), _of("plate", PLATE))
                ratios = tuple(10.0 * run.depth / measured[velocity] for run in members)
                compared.append(Shot(name, DEPTH, what, _ended(members), ratios, velocity=velocity, cells=_cells(members)))
    return compared


def long_rods() -> list[Shot]:
    """Depths of tungsten rods in steel against Odermatt's fit: velocities and meshes of one set-up, and four hardnesses."""
    folder, members = PROBLEMS / "long_rods" / "results", {}
    for name, file in (("tungsten into armour steel", "velocities.csv"), ("tungsten into armour steel", "meshes.csv"),
                       (HARDNESS, "hardness.csv")):
        for run in depths.read(folder / file):
            fit = depths.odermatt(run.velocity, run.slenderness, depths.brinell(run), *depths.DENSITIES)
            point = (name, run.slenderness, run.velocity, run.labels.get("steel"))
            if run.cells not in {cells for _, cells in members.get(point, ())}:
                members.setdefault(point, []).append((run.ratio / fit, run.cells))
    return [Shot(name, DEPTH, impact(f"long_rods/{depths.DECKS[slenderness]}", *_armour(steel)), "eroding",
                 tuple(ratio for ratio, _ in runs), velocity=velocity, cells=tuple(cells for _, cells in runs), fit=True)
            for (name, slenderness, velocity, steel), runs in members.items()]


def _armour(steel: str | None) -> list[str]:
    """The change of a deck that gives it the steel of a run of hardness.toml; None leaves its own."""
    return [] if steel is None else [_of("armour", ARMOUR[steel])]


def weldox() -> list[Shot]:
    """Residual velocities behind plates of Weldox 460 E, and whether the rods perforate."""
    folder, compared = PROBLEMS / "perforation", []
    measured = {(row["nose"], float(row["striking_m_s"])): float(row["residual_m_s"])
                for row in kept.rows(folder / "weldox_460e.csv", ("nose", "striking_m_s", "residual_m_s"))}
    for _, run in hydro2d.runs(folder / "results" / "weldox.csv").iterrows():
        velocity, through = hydro2d.to_si(run["velocity"], "m/s"), bool(run["perforated"])
        left = measured[run["nose"], velocity]
        what, about = impact("perforation/weldox_hemispherical.toml"), {
            "velocity": velocity, "cells": (run[rigid_rod.CELLS],)}
        ratios = (run["residual_velocity_m_s"] / left,) if through and left else ()
        compared.append(Shot(against.WELDOX, RESIDUAL, what, "", ratios, missed=left > 0.0 and not through, **about))
        compared.append(Shot(against.WELDOX, PERFORATION, what, "", (), right=through == (left > 0.0), **about))
    return compared


def ballistic() -> list[Shot]:
    """Ballistic limits, on every mesh, and holes of balls."""
    compared = []
    for each in limits.measured():
        meshes = limits.meshes(each.deck)
        compared.append(Shot(against.BALLS if each.fit else against.LIMITS, LIMIT, impact(f"perforation/{each.deck}.toml"), "",
                             tuple(mesh.limit / each.limit for mesh in meshes), velocity=round(each.limit),
                             cells=tuple(mesh.cells for mesh in meshes), fit=each.fit))
    for hole in limits.holes():
        what = impact("perforation/psaap.toml", f'body.plate.thickness="{hole.thickness} mm"')
        compared.append(Shot(against.BALLS, HOLE, what, "", (math.sqrt(hole.computed / hole.measured),),
                             velocity=round(1e3 * hole.velocity), cells=(hole.cells,), fit=True))
    return compared


def driven() -> list[Shot]:
    """Velocities of metal driven by an explosive: walls of cylinder tests as measured, final ones by Gurney's formula.

    The points of the formula are those of a tube and of plates in planar decks, and count for tubes alone.
    """
    compared = []
    for row in of_explosives.kept():
        if "velocity" in row["quantity"]:
            what = impact("explosives/cylinder.toml", _of("charge", row["explosive"]))
            fit = row["quantity"] == "final velocity"
            compared.append(Shot("driven by an explosive" if fit else "cylinder test", row["quantity"], what, "",
                              (float(row["obtained"]) / float(row["expected"]),), fit=fit))
    return compared


def bars() -> list[Shot]:
    """The lengths of Taylor bars of copper."""
    what = impact("classic/taylor_bar.toml")
    return [Shot(against.BAR, "length", what, "", tuple(each / bar.measured for each in bar.computed), velocity=bar.velocity,
                 cells=bar.cells) for bar in copper_bars.bars()]


def shields() -> list[Shot]:
    """Whether walls of Whipple shields are defeated, by the criterion that half A chose."""
    names = {"A": SHIELDS_CHOSEN, "B": SHIELDS}
    wall = 'body.wall.thickness="{wall_mm} mm"'
    return [Shot(names[shot["half"]], PERFORATION, impact("whipple/shield.toml", wall.format(**shot)), "", (),
                 right=whipple.computed(shot) == whipple.measured(shot), velocity=1e3 * float(shot["velocity_km_s"]),
                 cells=(float(shot["computed"][0]["cells"]),))
            for shot in whipple.shots()]


def of_runs() -> list[Shot]:
    """All shots with kept runs."""
    return [*twelve(), *eroding(), *rigid(), *long_rods(), *weldox(), *ballistic(), *driven(), *bars(), *shields()]


@dataclass(frozen=True)
class Measured:
    """A measured depth for analytic models: the deck, the impact velocity in m/s, the depth in m, and how the rod ended."""

    set: str
    deck: hydro2d.Deck
    velocity: float
    depth: float
    ended: str
    fit: bool = False


def measured_depths() -> list[Measured]:
    """All measured depths, and the points of Odermatt's fit at which there are runs in armour steel."""
    measured = []
    for shot, told in rigid_rod.experiments().items():
        if told.kind != "at least":
            deck = hydro2d.Deck.from_file(PROBLEMS / "cth_nose_shape" / _deck(shot))
            measured.append(Measured("tungsten into aluminium", deck, shot.velocity, told.depth,
                                  STAYED_RIGID if told.rigid else ERODED))
    for row in shots():
        deck = hydro2d.Deck.from_file(HERE / f"{row['deck']}.toml", {"body.rod.material": row["rod"]})
        measured.append(Measured(row["series"], deck, float(row["velocity_m_s"]), 1e-3 * float(row["depth_mm"]), row["ended"]))
    decks = {ratio: hydro2d.Deck.from_file(PROBLEMS / "long_rods" / name) for ratio, name in depths.DECKS.items()}
    for run in depths.read(PROBLEMS / "long_rods" / "results" / "velocities.csv"):
        deck = decks[run.slenderness]
        fit = depths.odermatt(run.velocity, run.slenderness, depths.BRINELL, *depths.DENSITIES) * deck.body_named("rod").length
        measured.append(Measured("tungsten into armour steel", deck, run.velocity, fit, ERODED, True))
    return measured


def of_models(names: Iterable[str] | None = None) -> list[Shot]:
    """The measured depths beside those of analytic models with inputs from the decks and the library alone."""
    compared = []
    for each in measured_depths():
        what = hydro2d.impact_of(each.deck)
        for name in hydro2d.penetration_models() if names is None else names:
            try:
                case = hydro2d.penetration_model(name, each.deck)
                if case.borrowed or "depth" not in {output.name for output in case.model.outputs}:
                    continue
                (row,) = case.rows([each.velocity])
            except ValueError:  # the model says that it does not apply to the shot, or lacks an input
                continue
            if row.get("regime") not in UNFINISHED and row["depth"]:
                compared.append(Shot(each.set, DEPTH, what, each.ended, (row["depth"] / each.depth,), velocity=each.velocity,
                                  fit=each.fit, of=name))
    return compared


def _numerical(ratios: Sequence[Sequence[float]]) -> float | None:
    """Standard deviation of the logarithms within shots, over all of them; None if no shot has two runs."""
    logs = [[math.log(ratio) for ratio in each] for each in ratios]
    freedom = sum(len(each) - 1 for each in logs)
    squares = math.fsum((value - math.fsum(each) / len(each)) ** 2 for each in logs for value in each)
    return math.sqrt(squares / freedom) if freedom else None


def _rounded(value: float | None) -> float | None:
    """The value as the file has it."""
    return None if value is None else float(f"{value:.{DIGITS}g}")


def _listed(names: Iterable[str]) -> str:
    """Names, each once, in one text."""
    return "; ".join(sorted({name for name in names if name}))


def row(shots: Sequence[Shot]) -> hydro2d.Experience:
    """The experience of shots of one kind, its numbers with the digits of the file."""
    first = shots[0]
    own, of, quantity, what, ended, fit = first.key
    compared = [shot for shot in shots if shot.ratios or shot.missed or shot.right is not None]
    velocities = [shot.velocity for shot in compared if shot.velocity]
    cells = [each for shot in compared for each in shot.cells]
    thicknesses = [shot.impact.thickness for shot in compared if shot.impact.thickness is not None]
    about = {"of": of, "quantity": quantity, "projectile": what.projectile, "target": what.target, "ended": ended, "fit": fit,
             "chosen": bool(own), "sets": "; ".join(dict.fromkeys(shot.set for shot in compared)),
             "slowest": min(velocities, default=None), "fastest": max(velocities, default=None),
             "coarsest": min(cells, default=None), "finest": max(cells, default=None),
             "thinnest": _rounded(min(thicknesses, default=None)), "thickest": _rounded(max(thicknesses, default=None)),
             "projectile_materials": _listed(shot.impact.projectile_material for shot in compared),
             "target_materials": _listed(name for shot in compared for name in shot.impact.target_materials)}
    if first.right is not None:
        return hydro2d.Experience(**about, shots=len(shots), right=sum(bool(shot.right) for shot in shots))
    with_ratio = [shot for shot in shots if shot.ratios]
    missed = sum(shot.missed for shot in shots)
    if not with_ratio:
        return hydro2d.Experience(**about, shots=0, missed=missed)
    errors = {ERRORS.get(shot.set) for shot in with_ratio} if of == RUNS else {None}
    error = errors.pop() if len(errors) == 1 else None
    bias = hydro2d.bias_and_scatter([median(shot.ratios) for shot in with_ratio], error)
    numbers = {name: getattr(bias, name) for name in ("bias", "low", "high", "scatter", "factor", "least", "most", "model")}
    if fit:  # points of one formula are not independent
        numbers |= dict.fromkeys(("low", "high", "factor"))
    numbers["numerical"] = _numerical([shot.ratios for shot in with_ratio])
    return hydro2d.Experience(**about, **{name: _rounded(value) for name, value in numbers.items()}, shots=bias.count,
                              missed=missed, measurement=error)


def rows(shots: Iterable[Shot]) -> list[hydro2d.Experience]:
    """The experience of all kinds, of which some shot has a ratio or an outcome, or ends the other way."""
    groups: dict[tuple, list[Shot]] = {}
    for shot in shots:
        groups.setdefault(shot.key, []).append(shot)
    experiences = map(row, groups.values())
    return [each for each in experiences if each.shots or each.missed]


def text(experiences: Iterable[hydro2d.Experience]) -> str:
    """The file of the table."""
    names = [field.name for field in fields(hydro2d.Experience)]
    records = [{name: _text(value) for name, value in asdict(each).items()} for each in experiences]
    out = io.StringIO(newline="")
    kept.write_to(out, names, records)
    return out.getvalue()


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "" if value is None else f"{value:.{DIGITS}g}" if isinstance(value, float) else str(value)


def _per_cent(value: float | None) -> str:
    return "" if value is None else f"{100.0 * value:.0f} %" if value >= 0.1 else f"{100.0 * value:.1f} %"


def _ratios(experiences: Iterable[hydro2d.Experience]) -> list[str]:
    """Lines of Markdown: bias and scatter of every kind."""
    heads = ("kind of shot", "shots", "bias (90 % interval)", "scatter", "range", "another shot", "within a shot",
             "measurement", "model alone")
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for each in experiences:
        if each.right is not None:
            continue
        name = f"{each.sets}: {each.kind}" if each.chosen else each.kind
        many = f"{each.shots}{', a fit' if each.fit else ''}{f', {each.missed} missed' if each.missed else ''}"
        bias = "" if each.bias is None else f"{each.bias:.2f}"
        interval = "" if each.low is None else f" ({each.low:.2f} to {each.high:.2f})"
        extent = "" if each.shots < 2 else f"{each.least:.2f} to {each.most:.2f}"
        factor = "" if each.factor is None else f"×÷ {each.factor:.2f}" if each.factor < 10.0 else f"×÷ {each.factor:.0f}"
        error = _per_cent(each.measurement) or "not given"
        lines.append(f"| {name} | {many} | {bias}{interval} | {_per_cent(each.scatter)} | {extent} | {factor} | "
                     f"{_per_cent(each.numerical)} | {error} | {_per_cent(each.model)} |")
    return lines


def _outcomes(experiences: Iterable[hydro2d.Experience]) -> list[str]:
    """Lines of Markdown: how many shots perforate, or do not, as measured."""
    lines = ["| set | shots | as measured | 90 % interval |", "|---|---|---|---|"]
    for each in experiences:
        if each.right is not None:
            share = hydro2d.wilson(each.right, each.shots)
            name = f"{each.sets}: something was chosen" if each.chosen else each.sets
            lines.append(f"| {name} | {each.shots} | {each.right} | {100 * share.low:.0f} to {100 * share.high:.0f} % |")
    return lines


def _models(experiences: Sequence[hydro2d.Experience]) -> list[str]:
    """Lines of Markdown: bias, scatter and number of shots of every analytic model, a column for each kind of shot."""
    kinds = sorted({(each.projectile, each.target, each.ended, each.fit) for each in experiences},
                   key=lambda kind: (kind[3], kind[2] == ERODED, kind))
    heads = [f"{rod}s in {target} that {ended}{', a fit' * fit}" for rod, target, ended, fit in kinds]
    lines = ["| model | " + " | ".join(heads) + " |", "|---" * (len(heads) + 1) + "|"]
    for name in dict.fromkeys(each.of for each in experiences):
        own = {(each.projectile, each.target, each.ended, each.fit): each for each in experiences if each.of == name}
        cells = []
        for kind in kinds:
            each = own.get(kind)
            scatter = f", {100 * each.scatter:.0f} %" if each and each.scatter is not None else ""
            cells.append(f"{each.bias:.2f}{scatter}, {each.shots}" if each else "")
        lines.append(f"| `{name}` | " + " | ".join(cells) + " |")
    return lines


def notes() -> list[str]:
    """Lines below the tables: runs with a fault in the audit, and of an older version of the method, of files that tell."""
    folders = ("cth_nose_shape/results/twelve_shots", "validation/results/eroded_heads", "validation/results/rigid_steel_rods",
               "validation/results/steel_rods_fitted", "perforation/results/weldox",
               *(f"perforation/results/limits_{each.deck}" for each in limits.measured()))
    told = hydro2d.runs(*(PROBLEMS / f"{name}.csv" for name in folders))
    doubtful = (~told["trustworthy"]).sum()
    faults = f"{doubtful} of {len(told)} runs of rods and balls had a fault in the audit, such as a cell that is too cold."
    method = hydro2d.method_note(told["method"])
    return [line for each in (faults if doubtful else "", method) if each for line in ("", each)]


def tables(runs: Sequence[hydro2d.Experience], models: Sequence[hydro2d.Experience]) -> Mapping[str, Callable[[], list[str]]]:
    """The tables of the page, by name."""
    return {
        "predicted": lambda: [*_ratios(each for each in runs if not each.chosen), *notes()],
        "chosen": lambda: _ratios(each for each in runs if each.chosen),
        "outcomes": lambda: _outcomes(runs),
        "models": lambda: _models(models),
    }


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; the status says whether a file would change")
    check = parser.parse_args(arguments).check
    runs, models = rows(of_runs()), rows(of_models())
    made = tables(runs, models)
    print("\n\n".join("\n".join(make()) for make in made.values()))
    changed = kept.renew(FILE, text([*runs, *models]), check)
    return max(kept.fill([PAGE], made, check), int(check and changed))


if __name__ == "__main__":
    sys.exit(main())
