"""The shots with uncertain inputs: how probable is what was seen, which law explains it, which input decides?

    python -m problems.cth_nose_shape.probability [--figure PATH]

prints tables in Markdown from the rows that `uncertain_shots.toml` keeps in results/uncertain_shots.csv, and draws the depths.
Ogival rods are held at every point that was run, so that probabilities are those of the hemispherical shots.

A rod is held if two thirds of its length are left; the rod of an experiment is held if it went deeper than the hydrodynamic
limit. The probability p that it is not held is a logistic function of the impact velocity v and the other inputs x of a row,

    logit p = (ln v - m(x)) / s,    m(x) = m_law + c_f ln f + c_p ln f_plate + c_l l + c_mu mu,                    (1)

with a constant for each law, the factors f on the strengths, whether the law of the plate is one that was fitted to measured
flow stresses, l = 1, or the published one, l = 0, and the friction mu. Half of the rods are held at the velocity
exp m. The width s is chance, and all else that the inputs do not explain. Each plate has a function of its own, from the rows
of the three shots into it: its numbers are drawn from their likelihood, between wide bounds, within which each of them, and
ln s, is as probable everywhere. Where rows next to each other do not have both outcomes, they only bound s from above.

Given x, the outcomes of shots are independent; the law, f and mu are the same for all shots, f_plate and l for all shots into
a plate, and the error of v is that of a shot. So

    L(law) = mean over x of prod_shots p_shot(outcome that was seen; x)                                            (2)

is the probability that a law gives all outcomes together, and the product weighs points x after the experiments (Bayes).
Intervals are those of the draws.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas

import hydro2d
from problems.cth_nose_shape import rigid_rod
from problems.cth_nose_shape.members import finish
from problems.cth_nose_shape.rigid_rod import ALLOYS, COLOURS, Shot

HERE = Path(__file__).parent
STUDY = HERE / "uncertain_shots.toml"
#: the inputs as columns
VELOCITY, LAW, FACTOR = "body.rod.velocity (difference) [m/s]", "materials.rod_alloy.based_on", "body.rod.strength_factor"
DENSITY = "materials.rod_alloy.eos.reference_density (factor)"
PLATE_LAW, PLATE_FACTOR, FRICTION = "body.plate.material", "body.plate.strength_factor", "sliding.friction"
NAMES = {VELOCITY: "velocity", LAW: "law", FACTOR: "factor of the rod", DENSITY: "density", PLATE_LAW: "law of the plate",
         PLATE_FACTOR: "factor of the plate", FRICTION: "friction"}
#: the law of the plate that is not a fit, and the plate that has fits
PUBLISHED, FITTED = "published", "5083"
#: flow stress in MPa at plastic strains, 1e4 per second, heated by the plastic work: `hydro2d curve W_alloy W_sintered ...`
STRAINS = (0.1, 0.5, 1.0)
STRENGTH = {"W_alloy": (1991.0, 2157.0, 2170.0), "W_sintered": (2100.0, 1967.0, 1547.0),
            "W_90_7_3": (1777.0, 1430.0, 1072.0), "W_Y925": (1755.0, 1528.0, 1190.0)}
#: the laws as results/twelve_shots.csv names them
MEMBERS = {material: law for law, material in rigid_rod.LAWS.items()}
#: draws of the inputs for each law, and of the numbers of (1); the seed of both; walkers and their steps, half to settle
DRAWS, FITS, SEED, WALKERS, STEPS = 2000, 200, 1, 50, 2000
#: bounds of the numbers of (1): s, from 0.3 to 5 % of the velocity as a standard deviation; m_law; c_f; c_p; c_l; c_mu
CHANCE, LAWS_WITHIN = (0.003, 0.05), (-0.4, 0.4)
BOUNDS = ((0.0, 3.0), (-3.0, 0.0), (-0.4, 0.4), (-20.0, 20.0))
#: and of what a finer mesh adds to m
MESH_WITHIN = (-0.2, 0.2)
#: cells across the radius of the tables, and of those with which they are compared
USUAL_CELLS, FINER = 5.5, 8.5
#: probability of intervals, their ends, and those of a spread
ENDS, SPREAD = (0.05, 0.95), (0.1, 0.9)
#: standard deviation of a logistic variable of scale 1
LOGISTIC = np.pi / np.sqrt(3.0)
#: unit of velocities in (1), m/s
USUAL = 1100.0


def samples(cells: float = USUAL_CELLS, nose: str = rigid_rod.NOSES["hemi"]) -> dict[Shot, hydro2d.Samples]:
    """The rows of every shot of rods with this nose, on so many cells across the radius. Raises StudyError, OSError."""
    named = {Shot.named(each.labels[rigid_rod.SHOTS]): each for each in hydro2d.kept_samples(STUDY)
             if float(each.labels[rigid_rod.CELLS]) == cells}
    return {shot: each for shot, each in named.items() if shot is not None and shot.nose == nose}


def held(sample: hydro2d.Samples) -> np.ndarray:
    """Whether two thirds of the length of the rod are left, bool[runs], of runs that are done."""
    return sample.table["length_ratio"][sample.ended].to_numpy() >= hydro2d.LEAST_KEPT_LENGTH


def reach(sample: hydro2d.Samples) -> np.ndarray:
    """Depths in cm, float64[runs], of runs that are done: the thickness of the plate for rods that perforate."""
    return 1e2 * column(sample, "depth_m")


def column(sample: hydro2d.Samples, name: str) -> np.ndarray:
    """An input of the runs that are done."""
    return sample.table[name][sample.ended].to_numpy()


# ---------------------------------------------------------------------------------------------------- the logistic function


@dataclass(frozen=True)
class Points:
    """Inputs, arrays (n,): velocity in m/s, number of the law, factors, whether the law of the plate is a fit, friction."""

    velocity: np.ndarray
    law: np.ndarray
    factor: np.ndarray
    plate: np.ndarray
    fit: np.ndarray
    friction: np.ndarray

    def terms(self, laws: int, finer: bool | None = None) -> np.ndarray:
        """The terms of m, float64[n, laws + 4]: a column for each law, ln f, ln f_plate, l, mu.

        finer : whether the points are on the finer of two meshes, for a last column, which is 1 there; None: there is one mesh
        """
        mesh = [] if finer is None else [np.full(len(self.law), float(finer))]
        factors = np.log(self.factor), np.log(self.plate)
        return np.column_stack([np.eye(laws)[self.law], *factors, self.fit, self.friction, *mesh])


def walk(density: Callable[[np.ndarray], np.ndarray], low: np.ndarray, high: np.ndarray, seed: Sequence[int]) -> np.ndarray:
    """Points drawn from a density between bounds, float64[FITS, k], by walkers that step along lines through one another.

    density : the logarithm of the density at points, float64[n], from float64[n, k];  low, high : bounds, float64[k]

    The walkers begin at the best of many points between the bounds. The size and the directions of their steps follow from the
    places of the others: Goodman and Weare, Comm. App. Math. Comp. Sci. 5 (2010) 65.
    """
    generator, dimensions = np.random.default_rng(seed), len(low)

    def logarithm(places: np.ndarray) -> np.ndarray:
        within = np.all((places > low) & (places < high), axis=1)
        return np.where(within, density(np.clip(places, low, high)), -np.inf)

    tried = low + generator.random((20 * WALKERS, dimensions)) * (high - low)
    places = tried[np.argsort(logarithm(tried))[-WALKERS:]]
    here, drawn, half = logarithm(places), [], WALKERS // 2
    for step in range(STEPS):
        for moving, others in ((slice(half), slice(half, None)), (slice(half, None), slice(half))):
            partners = places[others][generator.integers(half, size=half)]
            stretch = 0.5 * (1.0 + generator.random(half)) ** 2  # between 1/2 and 2, as often as 1/sqrt of it
            there = partners + stretch[:, None] * (places[moving] - partners)
            at = logarithm(there)
            taken = np.log(generator.random(half)) < (dimensions - 1) * np.log(stretch) + at - here[moving]
            places[moving] = np.where(taken[:, None], there, places[moving])
            here[moving] = np.where(taken, at, here[moving])
        if step >= STEPS // 2:
            drawn.append(places.copy())
    return np.concatenate(drawn[:: WALKERS * len(drawn) // FITS])[:FITS]


def points(shot: Shot, sample: hydro2d.Samples, laws: list[str]) -> Points:
    """The inputs of the runs of a shot that are done."""
    number = np.array([laws.index(law) for law in column(sample, LAW)])
    return Points(shot.velocity + column(sample, VELOCITY), number, column(sample, FACTOR), column(sample, PLATE_FACTOR),
                  _is_fit(shot.alloy, column(sample, PLATE_LAW)), column(sample, FRICTION))


def _is_fit(alloy: str, laws: np.ndarray) -> np.ndarray:
    """Whether laws of a plate are fits to measured flow stresses, as 0 or 1, float64[n]."""
    return (laws != PUBLISHED).astype(float) * (alloy == FITTED)


def _words(law: str) -> str:
    """The name of a law of the rod in tables."""
    return MEMBERS.get(law, law)


def laws_of(by_shot: dict[Shot, hydro2d.Samples]) -> list[str]:
    """The laws of a study in its order."""
    inputs = next(iter(by_shot.values())).inputs
    return list(next(each.levels for each in inputs if each.head == LAW))


def fitted(by_shot: dict[Shot, hydro2d.Samples], alloy: str, fine: dict[Shot, hydro2d.Samples] | None = None) -> np.ndarray:
    """Draws of the numbers of (1) for a plate, from all shots into it, float64[FITS, 1 + laws + 4]: ln s and those of m.

    fine : the shots on a finer mesh, for which a further number is added to m
    """
    laws, meshes = laws_of(by_shot), [(by_shot, None if fine is None else False), (fine or {}, True)]
    there = [(points(shot, sample, laws), finer, ~held(sample)) for mesh, finer in meshes for shot, sample in mesh.items()
             if shot.alloy == alloy]
    terms = np.vstack([at.terms(len(laws), finer) for at, finer, _ in there])
    speed = np.concatenate([np.log(at.velocity / USUAL) for at, *_ in there])
    sign = np.where(np.concatenate([lost for *_, lost in there]), -1.0, 1.0)
    widths = np.log(np.array(CHANCE) / LOGISTIC)
    low, high = np.array([widths, *[LAWS_WITHIN] * len(laws), *BOUNDS, *([] if fine is None else [MESH_WITHIN])]).T

    def density(numbers: np.ndarray) -> np.ndarray:
        return -np.logaddexp(0.0, sign * (speed - numbers[:, 1:] @ terms.T) * np.exp(-numbers[:, :1])).sum(axis=1)

    return walk(density, low, high, (SEED, ALLOYS.index(alloy)))


def drawn(by_shot: dict[Shot, hydro2d.Samples]) -> tuple[Points, np.ndarray]:
    """Points of the inputs without an error of the velocity, DRAWS for each law; and that error for each shot, m/s."""
    sample = next(iter(by_shot.values()))
    by_head = {each.head: each for each in sample.inputs}
    generator = np.random.default_rng(SEED)
    number = DRAWS * len(laws_of(by_shot))
    factor, plate, friction = (by_head[name].quantiles(generator.random(number)) for name in (FACTOR, PLATE_FACTOR, FRICTION))
    law = np.repeat(np.arange(len(laws_of(by_shot))), DRAWS)
    fit = _is_fit(FITTED, np.array(by_head[PLATE_LAW].values(generator.random(number))))
    errors = by_head[VELOCITY].quantiles(generator.random((len(by_shot), number)))
    return Points(np.full(number, USUAL), law, factor, plate, fit, friction), errors


def logistic(logit: np.ndarray) -> np.ndarray:
    """The probability p of ln p/(1 - p)."""
    return 1.0 / (1.0 + np.exp(np.clip(-logit, -500.0, 500.0)))


@dataclass(frozen=True)
class Inference:
    """The probabilities of the outcomes that were seen, at points drawn from the inputs, for each draw of the numbers of (1).

    laws : in the order of their numbers;  at : points of the inputs, those of a law one after another
    seen : probability of the outcome of each shot at each point, float64[FITS, n] by shot
    half : velocity at which half of the rods are held, m/s, float64[FITS, n] by alloy
    chance : standard deviation of the velocity of the change of a rod by chance, as a fraction, float64[FITS] by alloy
    numbers : the draws of the numbers of (1), float64[FITS, k] by alloy: ln s and those of m
    """

    laws: list[str]
    at: Points
    seen: dict[Shot, np.ndarray]
    half: dict[str, np.ndarray]
    chance: dict[str, np.ndarray]
    numbers: dict[str, np.ndarray]

    @functools.cached_property
    def together(self) -> np.ndarray:
        """Probability of all outcomes together at each point, for each draw, float64[FITS, n]."""
        return functools.reduce(np.multiply, self.seen.values())

    def of_law(self, values: np.ndarray) -> np.ndarray:
        """Means over the points of each law, float64[FITS, laws], of float64[FITS, n]."""
        return values.reshape(FITS, len(self.laws), -1).mean(axis=2)


def inferred(by_shot: dict[Shot, hydro2d.Samples], fine: dict[Shot, hydro2d.Samples] | None = None) -> Inference:
    """Fits (1) and evaluates it at points drawn from the distributions of the inputs; on the finer mesh, if one is given."""
    laws, measured = laws_of(by_shot), rigid_rod.experiments()
    at, errors = drawn(by_shot)
    seen, half, chance, numbers = {}, {}, {}, {}
    # the plates are of two alloys, whose factors are independent of each other: the second takes them in another order
    orders = {alloy: np.roll(at.plate, number) for number, alloy in enumerate(ALLOYS)}
    for alloy in ALLOYS:
        numbers[alloy] = fitted(by_shot, alloy, fine)
        there = Points(at.velocity, at.law, at.factor, orders[alloy], at.fit * (alloy == FITTED), at.friction)
        terms = there.terms(len(laws), None if fine is None else True)
        middle, width = numbers[alloy][:, 1:] @ terms.T, np.exp(numbers[alloy][:, :1])
        half[alloy], chance[alloy] = USUAL * np.exp(middle), LOGISTIC * width[:, 0]
        for number, shot in enumerate(by_shot):
            if shot.alloy == alloy:
                speed = np.log((shot.velocity + errors[number]) / USUAL)
                lost = logistic((speed - middle) / width)
                seen[shot] = 1.0 - lost if measured[shot].rigid else lost
    return Inference(laws, at, {shot: seen[shot] for shot in by_shot}, half, chance, numbers)


# ---------------------------------------------------------------------------------------------------- tables


def outcomes(by_shot: dict[Shot, hydro2d.Samples]) -> list[str]:
    """Lines of Markdown: depth and outcome of every shot, and how often each law gives the outcome that was seen."""
    laws, measured = laws_of(by_shot), rigid_rod.experiments()
    heads = ("shot", "experiment", "depth: median, 10 to 90 %", "as seen", *map(_words, laws))
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for shot, sample in by_shot.items():
        right = held(sample) == measured[shot].rigid
        law = column(sample, LAW)
        by_law = [f"{right[law == each].sum()} of {(law == each).sum()}" for each in laws]
        low, median, high = np.quantile(reach(sample), (SPREAD[0], 0.5, SPREAD[1]))
        share = hydro2d.wilson(int(right.sum()), len(right))
        lines.append(f"| {shot} | {measured[shot]} | {median:.1f} cm, {low:.1f} to {high:.1f} cm | {share.words} "
                     f"| {' | '.join(by_law)} |")
    return lines


def likelihoods(inference: Inference) -> list[str]:
    """Lines of Markdown: the probability of all outcomes together by law, and of the laws after the experiments."""
    together = inference.of_law(inference.together)
    alone = {shot: inference.of_law(each) for shot, each in inference.seen.items()}
    after = together / together.sum(axis=1, keepdims=True)
    lines = ["| law | all outcomes together | shot that is least probable | probability of the law after the experiments |",
             "|---" * 4 + "|"]
    for number, law in enumerate(inference.laws):
        worst = min(alone, key=lambda shot: alone[shot][:, number].mean())
        lines.append(f"| {_words(law)} | {_interval(together[:, number], 3)} | {worst.alloy}, {worst.velocity:g} m/s: "
                     f"{alone[worst][:, number].mean():.2f} | {_interval(after[:, number], 2)} |")
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
        lines.append(f"| factor of {_words(law)} | {_before_and_after(inference.at.factor[chosen], weights[chosen], 2)} |")
    return lines


def _before_and_after(values: np.ndarray, weights: np.ndarray, digits: int, unit: str = "") -> str:
    """Two cells: median and range of values without and with their weights."""
    cells = [_quantiles(values, each) for each in (np.ones_like(weights), weights)]
    return " | ".join(f"{middle:.{digits}f}{unit}, {low:.{digits}f} to {high:.{digits}f}" for low, middle, high in cells)


def halves(inference: Inference) -> list[str]:
    """Lines of Markdown: the velocity of the change for each plate, with its uncertainties by cause, m/s.

    u_num : chance, median and 5 to 95 % of the draws;  u_input : of all inputs, and of those besides the law
    u_fit : of the median, by the number of rows
    after : median and 5 to 95 % with the points weighed by the probability of what was seen
    """
    heads = ("plate", "experiments", "half of the rods", "u_num", "u_input", "u_input with one law", "u_fit",
             "after the experiments")
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for alloy in ALLOYS:
        rods = sorted((shot.velocity, told.rigid) for shot, told in rigid_rod.experiments().items()
                      if shot.alloy == alloy and shot in inference.seen)
        bracket = f"{max(at for at, rigid in rods if rigid):g} to {min(at for at, rigid in rods if not rigid):g} m/s"
        half = inference.half[alloy]
        middle = float(np.median(half))
        low, chance, high = middle * np.quantile(inference.chance[alloy], (ENDS[0], 0.5, ENDS[1]))
        of_inputs = np.median(_width(half, axis=1))
        within = np.median(_width(half.reshape(FITS, len(inference.laws), -1), axis=2))
        least, after, most = _quantiles(half.ravel(), inference.together.ravel())
        lines.append(f"| {alloy} | {bracket} | {middle:.0f} m/s | {chance:.0f} ({low:.0f} to {high:.0f}) | {of_inputs:.0f} "
                     f"| {within:.0f} | {_width(np.median(half, axis=1), axis=0):.0f} "
                     f"| {after:.0f} m/s, {least:.0f} to {most:.0f} |")
    return lines


def halves_by_law(by_shot: dict[Shot, hydro2d.Samples], inference: Inference) -> list[str]:
    """Lines of Markdown: the velocity of the change with each law; a bound where none of its rods held."""
    lines = [f"| law | {' | '.join(f'{alloy}: median, 5 to 95 %' for alloy in ALLOYS)} |", "|---" * (1 + len(ALLOYS)) + "|"]
    for number, law in enumerate(inference.laws):
        cells = []
        for alloy in ALLOYS:
            there = {shot: held(sample)[column(sample, LAW) == law] for shot, sample in by_shot.items() if shot.alloy == alloy}
            low, middle, high = np.quantile(inference.half[alloy][:, inference.at.law == number], (ENDS[0], 0.5, ENDS[1]))
            some = any(kept.any() for kept in there.values())
            cells.append(f"{middle:.0f} m/s, {low:.0f} to {high:.0f}" if some
                         else f"below {min(shot.velocity for shot in there):.0f} m/s")
        lines.append(f"| {_words(law)} | {' | '.join(cells)} |")
    return lines


def slopes(inference: Inference) -> list[str]:
    """Lines of Markdown: by how much the factors and the friction move the velocity of the change, m/s."""
    steps = (np.log(1.01), np.log(1.01), 1.0, 0.05)
    heads = ("plate", "1 % more strength of the rod", "1 % more strength of the plate", "the plate's law as measured",
             f"a friction of {steps[-1]:g}")
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for alloy in ALLOYS:
        first = 1 + len(inference.laws)
        moved = np.median(inference.half[alloy]) * np.array(steps) * inference.numbers[alloy][:, first : first + len(steps)]
        cells = [f"{middle:+.0f} m/s ({low:+.0f} to {high:+.0f})" for low, middle, high
                 in np.quantile(moved, (ENDS[0], 0.5, ENDS[1]), axis=0).T]
        cells[2] = cells[2] if alloy == FITTED else "one law"
        lines.append(f"| {alloy} | {' | '.join(cells)} |")
    return lines


def _width(values: np.ndarray, axis: int) -> np.ndarray:
    """Half of the range that holds 68 % of values, along an axis: the standard deviation of normal ones."""
    low, high = np.quantile(values, (0.16, 0.84), axis=axis)
    return 0.5 * (high - low)


def foretold(by_shot: dict[Shot, hydro2d.Samples]) -> list[str]:
    """Lines of Markdown: what each half of the rows says of the probability of all outcomes, and of the outcomes of the others.

    An outcome is foretold if the function of the other half calls it the more probable one.
    """
    last = max(int(sample.table["row"].max()) for sample in by_shot.values())
    halves_of = {f"1 to {last // 2}": (0, last // 2), f"{last // 2 + 1} to {last}": (last // 2, last)}
    lines = ["| rows | all outcomes together | foretold of the other rows | probability of what happened: geometric mean |",
             "|---|---|---|---|"]
    for words, (first, end) in halves_of.items():
        known, others = ({shot: _rows(sample, sample.table["row"].between(first + 1, end), within)
                          for shot, sample in by_shot.items()} for within in (True, False))
        inference = inferred(known)
        happened = np.concatenate([_probabilities(others, alloy, inference.numbers[alloy]) for alloy in ALLOYS])
        lines.append(f"| {words} | {_interval(inference.together.mean(axis=1), 2)} "
                     f"| {(happened > 0.5).sum()} of {len(happened)} | {np.exp(np.log(happened).mean()):.2f} |")
    return lines


def _rows(sample: hydro2d.Samples, chosen: pandas.Series, within: bool) -> hydro2d.Samples:
    """The chosen rows of a sample, bool[n], or the others."""
    return hydro2d.Samples(sample.title, sample.inputs, sample.table[chosen == within], labels=sample.labels)


def _probabilities(by_shot: dict[Shot, hydro2d.Samples], alloy: str, numbers: np.ndarray) -> np.ndarray:
    """The probability of the outcome of each row into a plate, mean over the draws of the numbers of (1)."""
    laws, parts = laws_of(by_shot), []
    for shot, sample in by_shot.items():
        if shot.alloy == alloy:
            at = points(shot, sample, laws)
            logit = (np.log(at.velocity / USUAL) - numbers[:, 1:] @ at.terms(len(laws)).T) * np.exp(-numbers[:, :1])
            lost = logistic(logit)
            parts.append(np.where(held(sample), 1.0 - lost, lost).mean(axis=0))
    return np.concatenate(parts)


def shares(by_shot: dict[Shot, hydro2d.Samples], result: str = "depth_m") -> list[str]:
    """Lines of Markdown: the Sobol indices of a result for each shot, with interactions, and the error of the surrogate."""
    lines = [f"| shot | {' | '.join(NAMES.values())} | Q2 |", "|---" * (2 + len(NAMES)) + "|"]
    for shot, sample in by_shot.items():
        cells, rough = [""] * len(NAMES), ""
        with contextlib.suppress(hydro2d.StudyError):  # the surrogate is too poor for indices
            indices = sample.indices(result)
            of_inputs = [indices[name] for name in NAMES]
            cells = [f"{each.total:.2f} ({each.total_low:.2f} to {each.total_high:.2f})" for each in of_inputs]
            rough = ", rough" if indices.doubt else ""
        lines.append(f"| {shot} | {' | '.join(cells)} | {sample.surrogate(result).q2:.2f}{rough} |")
    return lines


def compared(coarse: dict[Shot, hydro2d.Samples], fine: dict[Shot, hydro2d.Samples]) -> list[str]:
    """Lines of Markdown: the same points of the inputs on two meshes, whose places on the mesh are not the same."""
    measured, of_shots = rigid_rod.experiments(), [np.zeros((0, 3), dtype=bool)]
    heads = ("shot", "points", *(f"as seen, {cells:g} cells" for cells in (USUAL_CELLS, FINER)), "same outcome",
             "change of the depth: median, 10 to 90 %")
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for shot, sample in fine.items():
        one, other = _by_row(coarse[shot]), _by_row(sample)
        rows = sorted(one.keys() & other.keys())
        if not rows:
            continue
        right = np.array([[one[row][0], other[row][0]] for row in rows]) == measured[shot].rigid
        flags = np.column_stack([right, right[:, 0] == right[:, 1]])
        low, middle, high = np.quantile([other[row][1] - one[row][1] for row in rows], (SPREAD[0], 0.5, SPREAD[1]))
        lines.append(f"| {shot} | {_counted(flags)} | {middle:+.1f} cm, {low:+.1f} to {high:+.1f} cm |")
        of_shots.append(flags)
    return [*lines, f"| all | {_counted(np.vstack(of_shots))} | |"]


def refined(coarse: dict[Shot, hydro2d.Samples], fine: dict[Shot, hydro2d.Samples]) -> list[str]:
    """Lines of Markdown: by how much a finer mesh moves the change, and the probability of all outcomes together on it.

    The finer mesh adds one number to m, for each plate; all other numbers are those of both meshes.
    """
    inference = inferred(coarse, fine)
    lines = [f"| | {USUAL_CELLS:g} to {FINER:g} cells |", "|---|---|"]
    for alloy, numbers in inference.numbers.items():
        moved = np.median(inference.half[alloy]) * numbers[:, -1]
        low, high = np.quantile(moved, ENDS)
        lines.append(f"| change of the velocity in {alloy} | {np.median(moved):+.0f} m/s ({low:+.0f} to {high:+.0f}) |")
    return [*lines, "", *likelihoods(inference), "", *strengths(inference)]


def _by_row(sample: hydro2d.Samples) -> dict[int, tuple[bool, float]]:
    """Whether the rod of each row is held, and its depth in cm, of runs that are done."""
    return dict(zip(column(sample, "row").astype(int).tolist(), zip(held(sample), reach(sample), strict=True), strict=True))


def _counted(flags: np.ndarray) -> str:
    """Cells: the number of rows, and how often each of their flags is set."""
    return " | ".join(str(number) for number in (len(flags), *flags.sum(axis=0)))


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


def draw(by_shot: dict[Shot, hydro2d.Samples]):
    """A matplotlib Figure: the depths of the rows of every shot by law, their 10 to 90 %, and the experiments."""
    figure, panels = hydro2d.new_figure(9.6, 4.6, 1, len(ALLOYS), sharey=True)
    measured, laws = rigid_rod.experiments(), laws_of(by_shot)
    for alloy, axes in zip(ALLOYS, panels[0], strict=True):
        there = {shot: sample for shot, sample in by_shot.items() if shot.alloy == alloy}
        for number, law in enumerate(laws):
            dots = [(shot.velocity + 7.0 * (number - 1.5), depth) for shot, sample in there.items()
                    for depth in reach(sample)[column(sample, LAW) == law]]
            axes.plot(*zip(*dots, strict=True), "o", color=COLOURS[number], markersize=4, alpha=0.6, label=_words(law))
        for shot, sample in there.items():
            low, high = np.quantile(reach(sample), SPREAD)
            axes.fill_between([shot.velocity - 18.0, shot.velocity + 18.0], low, high, color="black", alpha=0.08, linewidth=0)
        axes.plot(*zip(*((shot.velocity, 1e2 * measured[shot].depth) for shot in there), strict=True), "s", color="black",
                  markersize=9, markerfacecolor="none", label="experiment")
        axes.set_title(f"hemispherical nose, {alloy} aluminium", fontsize="medium")
        axes.grid(alpha=0.3)
    finish(figure, panels, 5)
    return figure


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--figure", type=Path, help="also draws the depths")
    given = parser.parse_args(arguments)
    try:
        by_shot, ogival = samples(), samples(nose=rigid_rod.NOSES["ogive"])
        inference = inferred(by_shot)
        for lines in (outcomes(by_shot), outcomes(ogival), likelihoods(inference), foretold(by_shot), strengths(inference),
                      halves(inference), halves_by_law(by_shot, inference), slopes(inference), shares(by_shot | ogival)):
            print("\n".join([*lines, ""]))
        if fine := samples(FINER):
            print("\n".join([*compared(by_shot, fine), "", *refined(by_shot, fine), ""]))
        if given.figure:
            hydro2d.save_figure(draw(by_shot), given.figure)
    except (hydro2d.Error, OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
