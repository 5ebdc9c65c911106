"""Depth against impact velocity by the analytic models, for the rod and target of a setup."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hydro2d.analytic import beside, model_deck, models
from hydro2d.penetration import tate
from hydro2d.penetration.model import InputError

#: models of a rod into a thick target, from rigid to consumed
MODELS = ("forrestal", "tate", "walker-anderson", "anderson-riegel", "hydrodynamic")
POINTS = 31


@dataclass(frozen=True)
class Curve:
    """The depth of a model in m at impact velocities in m/s; NaN where it has none, and ``note`` says why."""

    name: str
    title: str
    velocity: np.ndarray
    depth: np.ndarray
    note: str = ""

    @property
    def drawable(self) -> bool:
        return bool(np.isfinite(self.depth).any())


def curves(shot: model_deck.Shot, low: float, high: float) -> list[Curve]:
    """Every model of ``MODELS`` between two impact velocities in m/s, or at one if they are the same."""
    velocity = np.linspace(low, high, POINTS if high > low else 1)
    return [_curve(name, shot, velocity) for name in MODELS]


def motion(shot: model_deck.Shot, velocity: float) -> tate.Track | None:
    """The motion of Tate and Alekseevskii at an impact velocity in m/s; None where the deck does not give what it needs."""
    try:
        return tate.motion(velocity, **tate.MODEL.collect(beside.case(tate.MODEL.name, shot).values))
    except InputError:
        return None


def _curve(name: str, shot: model_deck.Shot, velocity: np.ndarray) -> Curve:
    title = models.named(name).title.split(":")[0]
    try:
        case = beside.case(name, shot)
    except InputError as error:
        return Curve(name, title, velocity, np.full(len(velocity), np.nan), str(error))
    depths, problems = zip(*(_depth(case, float(speed)) for speed in velocity), strict=True)
    return Curve(name, title, velocity, np.array(depths, dtype=float), _first_problem(velocity, problems))


def _depth(case: models.Case, velocity: float) -> tuple[float, str]:
    """Depth in m, or NaN and the reason."""
    try:
        return float(case.rows([velocity])[0]["depth"]), ""
    except InputError as error:
        return float("nan"), str(error)


def _first_problem(velocity: np.ndarray, problems: Sequence[str]) -> str:
    """The first reason for a missing depth, and the velocities without one."""
    missing = [(speed, problem) for speed, problem in zip(velocity, problems, strict=True) if problem]
    if not missing:
        return ""
    where = "" if len(missing) == len(velocity) else f"not from {missing[0][0]:.0f} to {missing[-1][0]:.0f} m/s: "
    return where + missing[0][1]
