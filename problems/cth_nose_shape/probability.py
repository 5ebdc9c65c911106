"""The hemispherical shots with uncertain inputs: how probable is what was seen, which law explains it, which input decides?

    python -m problems.cth_nose_shape.probability [--figure PATH]

prints tables in Markdown from the rows that `uncertain_shots.toml` keeps in results/uncertain_shots.csv, and draws the depths.

A rod is held if two thirds of its length are left. The probability that it is, p(x), is a logistic function of the inputs x of
a row, one function for each plate, fitted to the rows of its three shots by maximum likelihood with Firth's correction:

    logit (1 - p) = b_0 + b_v ln v + b_law + b_f ln f + b_p ln f_plate + b_mu mu                                   (1)

with the impact velocity v, a constant for each law, the factors f on the strengths and the friction mu. Its width is chance,
and all else that the inputs do not explain. Given x, the outcomes of shots are independent; the law, f and mu are the same for
all shots, f_plate for all shots into a plate, and the error of v is that of a shot. So

    L(law) = mean over x of prod_shots p_shot(outcome that was seen; x)                                            (2)

is the probability that a law gives all outcomes together, and p(x) of (2) weighs points x after the experiments (Bayes). The
coefficients of (1) are known to within the error of their fit; the intervals are those of draws from it.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import hydro2d
from problems.cth_nose_shape import rigid_rod
from problems.cth_nose_shape.members import finish
from problems.cth_nose_shape.rigid_rod import ALLOYS, COLOURS, PLATE, Shot

HERE = Path(__file__).parent
STUDY = HERE / "uncertain_shots.toml"
#: the inputs as columns
VELOCITY, LAW, FACTOR = "body.rod.velocity (difference) [m/s]", "body.rod.material", "body.rod.strength_factor"
PLATE_FACTOR, FRICTION = "body.plate.strength_factor", "sliding.friction"
NAMES = {VELOCITY: "velocity", LAW: "law", FACTOR: "factor of the rod", PLATE_FACTOR: "factor of the plate",
         FRICTION: "friction"}  # fmt: skip
#: flow stress in MPa at plastic strains, 1e4 per second, heated by the plastic work: `hydro2d curve W_alloy W_sintered ...`
STRAINS = (0.1, 0.5, 1.0)
STRENGTH = {"Steinberg-Guinan": (1991.0, 2157.0, 2170.0), "JC-sintered": (2100.0, 1967.0, 1547.0),
            "JC-90W": (1777.0, 1430.0, 1072.0), "JC-Y925": (1755.0, 1528.0, 1190.0)}  # fmt: skip
#: draws of the inputs for each law, and of the coefficients; the seed of both
DRAWS, FITS, SEED = 2000, 200, 1
#: probability of intervals, their ends, and those of a spread
ENDS, SPREAD = (0.05, 0.95), (0.1, 0.9)
#: standard deviation of a logistic variable of scale 1
LOGISTIC = np.pi / np.sqrt(3.0)
#: velocity at which the terms of (1) vanish, m/s
USUAL = 1100.0


def samples(cells: float = 5.5, nose: str = rigid_rod.NOSES["hemi"]) -> dict[Shot, hydro2d.Samples]:
    """The rows of every shot of rods with this nose, on so many cells across the radius. Raises StudyError, OSError."""
    by_shot = {Shot.named(each.labels[rigid_rod.SHOTS]): each for each in hydro2d.kept_samples(STUDY)
               if float(each.labels[rigid_rod.CELLS]) == cells}  # fmt: skip
    return {shot: each for shot, each in by_shot.items() if shot is not None and shot.nose == nose}


def held(sample: hydro2d.Samples) -> np.ndarray:
    """Whether two thirds of the length of the rod are left, bool[runs], of runs that are done."""
    return sample.columns["length_ratio"][sample.ended] >= hydro2d.LEAST_KEPT_LENGTH


def reach(sample: hydro2d.Samples) -> np.ndarray:
    """Depths in cm, float64[runs], of runs that are done; the thickness of the plate for rods that perforate."""
    through = sample.columns["perforated"][sample.ended] == "yes"
    return np.where(through, PLATE, 1e2 * sample.columns["depth_m"][sample.ended])


def column(sample: hydro2d.Samples, name: str) -> np.ndarray:
    """An input of the runs that are done."""
    return sample.columns[name][sample.ended]


# ---------------------------------------------------------------------------------------------------- the logistic function


@dataclass(frozen=True)
class Points:
    """Values of the inputs, arrays (n,): velocity in m/s, number of the law, factors, friction."""

    velocity: np.ndarray
    law: np.ndarray
    factor: np.ndarray
    plate: np.ndarray
    friction: np.ndarray

    def terms(self, laws: int) -> np.ndarray:
        """The terms of (1) without the first, that of the velocity first, float64[n, 4 + laws]: a column for each law."""
        return np.column_stack([np.log(self.velocity / USUAL), np.eye(laws)[self.law], np.log(self.factor), np.log(self.plate),
                                self.friction])  # fmt: skip


@dataclass(frozen=True)
class Fit:
    """The logistic function of a plate: its coefficients, float64[k], and draws from their error, float64[FITS, k]."""

    best: np.ndarray
    draws: np.ndarray


def logistic(terms: np.ndarray, outcome: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients, float64[k], and their covariance, of logit P(outcome) = terms @ coefficients; terms float64[n, k].

    Maximises the likelihood with Firth's correction, which keeps it finite where the outcomes do not overlap: Biometrika 80
    (1993) 27. Raises ValueError if it does not converge.
    """
    b = np.zeros(terms.shape[1])
    for _ in range(500):
        p = 1.0 / (1.0 + np.exp(-terms @ b))
        weighted = terms * (p * (1.0 - p))[:, None]
        covariance = np.linalg.inv(terms.T @ weighted)
        leverage = np.einsum("ij,jk,ik->i", weighted, covariance, terms)
        step = covariance @ (terms.T @ (outcome - p + leverage * (0.5 - p)))
        b = b + step * min(1.0, 2.0 / np.abs(step).max())
        if np.abs(step).max() < 1e-8:
            return b, covariance
    raise ValueError("the logistic regression does not converge")


def points(shot: Shot, sample: hydro2d.Samples, laws: list[str]) -> Points:
    """The inputs of the runs of a shot that are done."""
    number = np.array([laws.index(law) for law in column(sample, LAW)])
    return Points(shot.velocity + column(sample, VELOCITY), number, column(sample, FACTOR), column(sample, PLATE_FACTOR),
                  column(sample, FRICTION))  # fmt: skip


def laws_of(found: dict[Shot, hydro2d.Samples]) -> list[str]:
    """The laws of a study in its order."""
    inputs = next(iter(found.values())).inputs
    return list(next(each.levels for each in inputs if each.head == LAW))


def fitted(found: dict[Shot, hydro2d.Samples], alloy: str) -> Fit:
    """The function (1) of a plate, from all shots into it."""
    laws = laws_of(found)
    there = {shot: sample for shot, sample in found.items() if shot.alloy == alloy}
    terms = np.vstack([points(shot, sample, laws).terms(len(laws)) for shot, sample in there.items()])
    lost = np.concatenate([~held(sample) for sample in there.values()])
    best, covariance = logistic(terms, lost.astype(float))
    return Fit(best, np.random.default_rng(SEED).multivariate_normal(best, covariance, FITS, method="cholesky"))


def drawn(found: dict[Shot, hydro2d.Samples]) -> tuple[Points, np.ndarray]:
    """Points of the inputs without an error of the velocity, DRAWS for each law; and that error for each shot, m/s."""
    sample = next(iter(found.values()))
    by_head = {each.head: each for each in sample.inputs}
    generator = np.random.default_rng(SEED)
    number = DRAWS * len(laws_of(found))
    factor, plate, friction = (by_head[name].quantiles(generator.random(number)) for name in (FACTOR, PLATE_FACTOR, FRICTION))
    law = np.repeat(np.arange(len(laws_of(found))), DRAWS)
    errors = by_head[VELOCITY].quantiles(generator.random((len(found), number)))
    return Points(np.full(number, USUAL), law, factor, plate, friction), errors


@dataclass(frozen=True)
class Inference:
    """What the rows say of the outcomes that were seen.

    laws, alloys : in the order of the arrays;  at : points of the inputs
    seen : probability of the outcome of each shot at each point, for each draw of the coefficients, dict of float64[FITS, n]
    half : velocity at which half of the rods are held, m/s, float64[alloys, FITS, n];  chance : its standard deviation by
    chance, as a fraction of it, float64[alloys]
    """

    laws: list[str]
    at: Points
    seen: dict[Shot, np.ndarray]
    half: dict[str, np.ndarray]
    chance: dict[str, float]

    @functools.cached_property
    def together(self) -> np.ndarray:
        """Probability of all outcomes together at each point, for each draw of the coefficients, float64[FITS, n]."""
        return functools.reduce(np.multiply, self.seen.values())

    def of_law(self, values: np.ndarray) -> np.ndarray:
        """Means over the points of each law, float64[FITS, laws], of float64[FITS, n]."""
        return values.reshape(FITS, len(self.laws), -1).mean(axis=2)


def inferred(found: dict[Shot, hydro2d.Samples]) -> Inference:
    """Fits (1) and evaluates it at points drawn from the distributions of the inputs."""
    laws, measured = laws_of(found), rigid_rod.experiments()
    at, errors = drawn(found)
    seen, half, chance = {}, {}, {}
    # the plates are of two alloys, whose factors are independent of each other: the second takes them in another order
    orders = {alloy: np.roll(at.plate, number) for number, alloy in enumerate(ALLOYS)}
    for alloy in ALLOYS:
        fit = fitted(found, alloy)
        own = Points(at.velocity, at.law, at.factor, orders[alloy], at.friction)
        others = own.terms(len(laws))[:, 1:]
        load = fit.draws[:, 1:] @ others.T
        half[alloy] = USUAL * np.exp(np.clip(-load / fit.draws[:, :1], -1.0, 1.0))
        chance[alloy] = float(LOGISTIC / fit.best[0])
        for number, shot in enumerate(found):
            if shot.alloy == alloy:
                velocity = np.log((shot.velocity + errors[number]) / USUAL)
                lost = 1.0 / (1.0 + np.exp(-(fit.draws[:, :1] * velocity + load)))
                seen[shot] = 1.0 - lost if measured[shot].rigid else lost
    return Inference(laws, at, {shot: seen[shot] for shot in found}, half, chance)


# ---------------------------------------------------------------------------------------------------- tables


def outcomes(found: dict[Shot, hydro2d.Samples]) -> list[str]:
    """Lines of Markdown: depth and outcome of every shot, and how often each law gives the outcome that was seen."""
    laws, measured = laws_of(found), rigid_rod.experiments()
    heads = ("shot", "experiment", "depth: median, 10 to 90 %", "as seen", *laws)
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for shot, sample in found.items():
        right = held(sample) == measured[shot].rigid
        law = column(sample, LAW)
        by_law = [f"{right[law == each].sum()} of {(law == each).sum()}" for each in laws]
        low, median, high = np.quantile(reach(sample), (SPREAD[0], 0.5, SPREAD[1]))
        share = hydro2d.wilson(int(right.sum()), len(right))
        lines.append(f"| {shot} | {measured[shot]} | {median:.1f} cm, {low:.1f} to {high:.1f} cm | {share.words} "
                     f"| {' | '.join(by_law)} |")  # fmt: skip
    return lines


def likelihoods(inference: Inference) -> list[str]:
    """Lines of Markdown: the probability of all outcomes together by law, and of the laws after the experiments."""
    together = inference.of_law(inference.together)
    alone = {shot: inference.of_law(each) for shot, each in inference.seen.items()}
    after = together / together.sum(axis=1, keepdims=True)
    lines = ["| law | all outcomes together | shot that is least probable | probability of the law after the experiments |",
             "|---" * 4 + "|"]  # fmt: skip
    for number, law in enumerate(inference.laws):
        worst = min(alone, key=lambda shot: alone[shot][:, number].mean())
        lines.append(f"| {law} | {_interval(together[:, number], 3)} | {worst.alloy}, {worst.velocity:g} m/s: "
                     f"{alone[worst][:, number].mean():.2f} | {_interval(after[:, number], 2)} |")  # fmt: skip
    lines.append(f"| all, each a quarter | {_interval(together.mean(axis=1), 3)} | | |")
    return lines


def strengths(inference: Inference) -> list[str]:
    """Lines of Markdown: the flow stress of the rod at three strains before and after the experiments."""
    weights = inference.together.mean(axis=0)
    stress = np.array([STRENGTH[law] for law in inference.laws])[inference.at.law] * inference.at.factor[:, None]
    lines = ["| | before: median, 5 to 95 % | after: median, 5 to 95 % |", "|---|---|---|"]
    for strain, values in zip(STRAINS, stress.T, strict=True):
        lines.append(f"| flow stress at a plastic strain of {strain:g} | {_before_and_after(values, weights, 0, ' MPa')} |")
    for number, law in enumerate(inference.laws):
        chosen = inference.at.law == number
        lines.append(f"| factor of {law} | {_before_and_after(inference.at.factor[chosen], weights[chosen], 2)} |")
    return lines


def _before_and_after(values: np.ndarray, weights: np.ndarray, digits: int, unit: str = "") -> str:
    """Two cells: median and range of values without and with their weights."""
    cells = [_quantiles(values, each) for each in (np.ones_like(weights), weights)]
    return " | ".join(f"{middle:.{digits}f}{unit}, {low:.{digits}f} to {high:.{digits}f}" for low, middle, high in cells)


def halves(inference: Inference) -> list[str]:
    """Lines of Markdown: the velocity of the change for each plate, with its uncertainty by cause."""
    heads = ("plate", "experiments", "half of the rods", "u_num, m/s", "u_input, m/s", "u_input with one law, m/s", "u_fit, m/s")
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for alloy in ALLOYS:
        rods = sorted((shot.velocity, told.rigid) for shot, told in rigid_rod.experiments().items()
                      if shot.alloy == alloy and shot in inference.seen)  # fmt: skip
        bracket = f"{max(at for at, rigid in rods if rigid):g} to {min(at for at, rigid in rods if not rigid):g} m/s"
        half = inference.half[alloy]
        middle = float(np.median(half))
        of_inputs, within = half.std(axis=1).mean(), half.reshape(FITS, len(inference.laws), -1).std(axis=2).mean()
        lines.append(f"| {alloy} | {bracket} | {middle:.0f} m/s | {inference.chance[alloy] * middle:.0f} | {of_inputs:.0f} "
                     f"| {within:.0f} | {half.mean(axis=1).std():.0f} |")  # fmt: skip
    return lines


def shares(found: dict[Shot, hydro2d.Samples], result: str = "depth_m") -> list[str]:
    """Lines of Markdown: the Sobol indices of a result for each shot, with interactions, and the error of the surrogate."""
    lines = [f"| shot | {' | '.join(NAMES.values())} | Q2 |", "|---" * (2 + len(NAMES)) + "|"]
    for shot, sample in found.items():
        cells = [""] * len(NAMES)
        with contextlib.suppress(hydro2d.StudyError):  # the surrogate is too poor for indices
            indices = sample.indices(result)
            of_inputs = [indices[name] for name in NAMES]
            cells = [f"{each.total:.2f} ({each.total_low:.2f} to {each.total_high:.2f})" for each in of_inputs]
        lines.append(f"| {shot} | {' | '.join(cells)} | {sample.surrogate(result).q2:.2f} |")
    return lines


def validation(found: dict[Shot, hydro2d.Samples], cells: float = 5.5) -> list[str]:
    """Lines of Markdown: how far the mean depth is from the measured one, and the uncertainties by cause, cm (ASME V&V 20).

    u_num : of the members of each law in results/twelve_shots.csv;  u_input : of the rows, without u_num
    """
    members = [run for run in rigid_rod.read(HERE / "results" / "twelve_shots.csv", cells) if run.shot in found]
    lines = ["| shot | measured | computed minus measured | u_num | u_input | over u_val |", "|---" * 6 + "|"]
    for shot, sample in found.items():
        by_law: dict[str, list[float]] = {}
        for run in members:
            if run.shot == shot:
                by_law.setdefault(run.column, []).append(run.reach)
        numerical = float(np.mean([np.var(depths, ddof=1) for depths in by_law.values() if len(depths) > 1]))
        of_rows = float(np.var(reach(sample), ddof=1))
        told = rigid_rod.experiments()[shot]
        error = float(reach(sample).mean()) - 1e2 * told.depth
        of_inputs = max(of_rows - numerical, 0.0)
        lines.append(f"| {shot} | {told} | {error:+.1f} cm | {numerical**0.5:.1f} | {of_inputs**0.5:.1f} "
                     f"| {error / (numerical + of_inputs) ** 0.5:+.1f} |")  # fmt: skip
    return lines


def _interval(values: np.ndarray, digits: int) -> str:
    low, high = np.quantile(values, ENDS)
    return f"{values.mean():.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


def _quantiles(values: np.ndarray, weights: np.ndarray) -> tuple[float, float, float]:
    """5 %, median and 95 % of values with weights."""
    order = np.argsort(values)
    rank = (np.cumsum(weights[order]) - 0.5 * weights[order]) / weights.sum()
    low, middle, high = np.interp((ENDS[0], 0.5, ENDS[1]), rank, values[order])
    return float(low), float(middle), float(high)


# ---------------------------------------------------------------------------------------------------- figure


def draw(found: dict[Shot, hydro2d.Samples]):
    """A matplotlib Figure: the depths of the rows of every shot by law, their 10 to 90 %, and the experiments."""
    figure, panels = hydro2d.new_figure(9.6, 4.6, 1, len(ALLOYS), sharey=True)
    measured, laws = rigid_rod.experiments(), laws_of(found)
    for alloy, axes in zip(ALLOYS, panels[0], strict=True):
        there = {shot: sample for shot, sample in found.items() if shot.alloy == alloy}
        for number, law in enumerate(laws):
            dots = [(shot.velocity + 7.0 * (number - 1.5), depth) for shot, sample in there.items()
                    for depth in reach(sample)[column(sample, LAW) == law]]  # fmt: skip
            axes.plot(*zip(*dots, strict=True), "o", color=COLOURS[number], markersize=4, alpha=0.6, label=law)
        for shot, sample in there.items():
            low, high = np.quantile(reach(sample), SPREAD)
            axes.fill_between([shot.velocity - 18.0, shot.velocity + 18.0], low, high, color="black", alpha=0.08, linewidth=0)
        axes.plot(*zip(*((shot.velocity, 1e2 * measured[shot].depth) for shot in there), strict=True), "s", color="black",
                  markersize=9, markerfacecolor="none", label="experiment")  # fmt: skip
        axes.set_title(f"hemispherical nose, {alloy} aluminium", fontsize="medium")
        axes.grid(alpha=0.3)
    finish(figure, panels, 5)
    return figure


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--figure", type=Path, help="also draws the depths")
    given = parser.parse_args(arguments)
    try:
        found = samples()
        inference = inferred(found)
        for lines in (outcomes(found), validation(found), likelihoods(inference), strengths(inference), halves(inference),
                      shares(found)):  # fmt: skip
            print("\n".join([*lines, ""]))
        if given.figure:
            hydro2d.save_figure(draw(found), given.figure)
    except (hydro2d.Error, OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
