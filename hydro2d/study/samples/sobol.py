"""Sobol indices of a surrogate, with intervals that contain its own uncertainty and that of the estimate.

The first-order index of an input is the share of the variance of the result that it explains alone, the total one its share
with all interactions. They are estimated for many functions that the rows allow (draws of the Gaussian process), each with a
bootstrap of the points of the estimate: Le Gratiet, Cannamela & Iooss, SIAM/ASA J. Uncertainty Quantification 2 (2014) 336.
The estimators are those of Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, as SciPy has them. Inputs of one joint
distribution have the indices of their group, which is independent of the others: Jacques, Lavergne & Devictor, Reliab. Engng
Syst. Saf. 91 (2006) 1126.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hydro2d.study.plan import joint
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.samples.surrogates import Surrogate

#: draws of the surrogate; points of an estimate; probability that an interval covers an index
DRAWS, POINTS, LEVEL = 200, 1024, 0.9
#: least Q2 for indices at all, and Q2 below which they are doubtful
POOR, FAIR = 0.5, 0.8
#: about inputs that go along with each other
GROUPED = "Inputs that go along with each other have no shares of their own, but one of their group"


@dataclass(frozen=True)
class Index:
    """The indices of an input, or of the group of inputs of a joint distribution, each with its 90 % interval."""

    input: str
    first: float
    first_low: float
    first_high: float
    total: float
    total_low: float
    total_high: float


@dataclass(frozen=True)
class Indices:
    """The Sobol indices of a result by input, and the surrogate that they come from."""

    result: str
    inputs: tuple[Index, ...]
    surrogate: Surrogate

    @property
    def grouped(self) -> str:
        """A sentence where inputs go along with each other; empty otherwise."""
        return GROUPED if any(each.joint for each in self.surrogate.inputs) else ""

    @property
    def doubt(self) -> str:
        """A warning where the surrogate predicts little; empty otherwise."""
        if self.surrogate.q2 >= FAIR:
            return ""
        return (f"the surrogate of {self.result} predicts {100 * self.surrogate.q2:.0f} % of the variance of a row that it "
                "does not know, so that the indices are rough")

    def __getitem__(self, key: str) -> Index:
        """The indices of an input, or of its group, by its deck key, or by its head with the unit. Raises KeyError."""
        for each, group in zip(self.inputs, joint.groups(self.surrogate.inputs), strict=True):
            if any(key in (of.key, of.head) for of in (self.surrogate.inputs[number] for number in group)):
                return each
        raise KeyError(key)


def indices(result: str, surrogate: Surrogate, seed: int = 0) -> Indices:
    """The indices of a surrogate. Raises StudyError if it predicts less than half of the variance."""
    if surrogate.q2 < POOR:
        raise StudyError(f"{result}: no indices, since its surrogate predicts {100 * max(surrogate.q2, 0.0):.0f} % of the "
                         f"variance of a row that it does not know (Q2 = {surrogate.q2:.2f}; at least {POOR} is needed). More "
                         "rows, fewer inputs or members of each row help")
    from scipy.stats import qmc, sobol_indices

    inputs, groups = len(surrogate.inputs), joint.groups(surrogate.inputs)
    cube = qmc.Sobol(2 * inputs, scramble=True, seed=np.random.default_rng(seed)).random(POINTS)
    a, b = cube[:, :inputs], cube[:, inputs:]
    mixed = [np.where(np.isin(np.arange(inputs), group), b, a) for group in groups]
    points = joint.correlated(surrogate.inputs, np.vstack([a, b, *mixed]))
    values = surrogate.draws(points, DRAWS, seed).reshape(DRAWS, len(groups) + 2, POINTS)
    chosen = np.random.default_rng(seed + 1).integers(POINTS, size=(DRAWS, POINTS))
    values = np.take_along_axis(values, chosen[:, None, :], axis=2)
    functions = {"f_A": values[:, 0], "f_B": values[:, 1], "f_AB": values[:, 2:].transpose(1, 0, 2)}
    estimate = sobol_indices(func=functions, n=POINTS)
    first, total = (each.reshape(DRAWS, len(groups)) for each in (estimate.first_order, estimate.total_order))
    ends = 0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL
    names = [" with ".join(surrogate.inputs[number].head for number in group) for group in groups]
    rows = [Index(name, float(first[:, n].mean()), *map(float, np.quantile(first[:, n], ends)),
                  float(total[:, n].mean()), *map(float, np.quantile(total[:, n], ends)))
            for n, name in enumerate(names)]
    return Indices(result, tuple(rows), surrogate)
