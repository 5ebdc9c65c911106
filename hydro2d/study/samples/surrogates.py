"""A surrogate of a result of a sample: a Gaussian process over the unit cube of the inputs, with its error.

Numbers enter by their cumulative probability. A choice enters by a coordinate for each level, 1 for the chosen one and 0 for
the others (one-hot), with one length scale: all of its levels are equally far apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from hydro2d.base.terminal import several
from hydro2d.study.plan import joint
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import CHOICE, Distribution
from hydro2d.study.samples import gaussian

#: most rows by which the numbers of the covariance are found; fewest rows of a surrogate beyond one for each input
MOST_FITTED, FEWEST = 400, 5
#: a result whose relative standard deviation is smaller than this is the same in every row but for round-off
SAME = 1e-9


@dataclass(frozen=True)
class Surrogate:
    """A Gaussian process through the rows of a sample.

    Attributes
    ----------
    inputs : the inputs of the sample
    rows : number of rows with a result
    q2, rmse : share of the variance of a row that the others predict, and the standard error of this prediction in the unit of
        the result: leave-one-out, with the length scales of all rows
    noise : standard deviation, in this unit, of what the inputs do not explain: chance
    """

    inputs: tuple[Distribution, ...]
    rows: int
    q2: float
    rmse: float
    noise: float
    _process: gaussian.Process = field(repr=False)
    _theta: np.ndarray = field(repr=False)
    _root: np.ndarray = field(repr=False)
    _shift: float = field(repr=False)
    _unit: float = field(repr=False)

    @property
    def words(self) -> str:
        """Its error in words."""
        return f"{self.rows} rows, Q2 = {self.q2:.3f}, leave-one-out error {self.rmse:.3g}, unexplained {self.noise:.2g}"

    def __call__(self, cube: np.ndarray) -> np.ndarray:
        """The mean of the result at points of the unit cube, float64[n] from float64[n, d]."""
        return self._shift + self._unit * self._process.mean(coordinates(self.inputs, cube))

    def draws(self, cube: np.ndarray, number: int, seed: int = 0) -> np.ndarray:
        """Functions that the rows allow, at points of the unit cube, float64[number, n], without chance.

        Five sets of numbers of the covariance, as probable as the rows make them, have a fifth of the functions each.
        """
        generator, x = np.random.default_rng(seed), coordinates(self.inputs, cube)
        functions = []
        with gaussian.one_thread():
            for share in np.array_split(np.arange(number), gaussian.SETS):
                theta = self._theta + self._root @ generator.standard_normal(len(self._theta))
                process = gaussian.Process(self._process.x, self._process.y, theta)
                functions.append(process.draws(x, len(share), generator).T)
        return self._shift + self._unit * np.vstack(functions)


def coordinates(inputs: Sequence[Distribution], cube: np.ndarray) -> list[np.ndarray]:
    """The coordinates of each input at points of the unit cube, float64[n, d]: float64[n, 1], or a column for each level."""
    columns = np.asarray(cube, dtype=float).T
    return [np.eye(len(each.levels))[each.level_of(points)] if each.kind == CHOICE else points[:, None]
            for each, points in zip(inputs, columns, strict=True)]


def fit(inputs: Sequence[Distribution], cube: np.ndarray, values: np.ndarray) -> Surrogate:
    """The surrogate of a result: values float64[n] at points of the unit cube float64[n, d].

    Raises StudyError for too few rows, or a result that does not vary.
    """
    x, values = coordinates(inputs, cube), np.asarray(values, dtype=float)
    if len(values) < len(inputs) + FEWEST:
        count = several(len(inputs), "input")
        raise StudyError(f"a surrogate of {count} needs at least {len(inputs) + FEWEST} rows with a result, and there are "
                         f"{len(values)}")
    shift, unit = float(values.mean()), float(values.std())
    if not vary(values):
        raise StudyError("the result is the same in every row: no input decides it")
    y = (values - shift) / unit
    with gaussian.one_thread():
        theta, root = gaussian.most_probable([each[:MOST_FITTED] for each in x], y[:MOST_FITTED])
        process = gaussian.Process(x, y, theta)
        missed = process.missed()
    alone = y * len(y) / (len(y) - 1.0)  # each row minus the mean of the others
    return Surrogate(tuple(inputs), len(y), float(1.0 - missed @ missed / (alone @ alone)),
                     float(unit * np.sqrt(np.mean(missed**2))), float(unit * np.sqrt(process.numbers.c)), process, theta, root,
                     shift, unit)


def vary(values: np.ndarray) -> bool:
    """Whether values, float64[n], differ by more than round-off."""
    return len(values) > 1 and bool(values.std() > SAME * abs(values.mean()))


def middle(inputs: Sequence[Distribution]) -> np.ndarray:
    """The point of the cube with all inputs at their medians, choices at their most frequent level, float64[d]."""
    return np.array([each.points(each.levels)[int(np.argmax(each.weights))] if each.kind == CHOICE else 0.5 for each in inputs])


def along(inputs: Sequence[Distribution], number: int, points: np.ndarray) -> np.ndarray:
    """Points of the cube along an input, the other ones as in `middle`; those of its joint distribution follow it."""
    cube = np.tile(middle(inputs), (len(points), 1))
    cube[:, number] = points
    return joint.follow(inputs, cube, number)
