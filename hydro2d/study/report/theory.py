"""Depth against impact velocity, and the motion in time, by the analytic models for the rod and target of a setup."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hydro2d.analytic import beside, model_deck, models
from hydro2d.analytic.catalogue import InputError, Motion

#: models of a rod into a thick target, from rigid to consumed
MODELS = ("forrestal", "tate", "walker-anderson", "anderson-riegel", "hydrodynamic")
POINTS = 31
#: models that give the motion of a rod in time; the first is for a rod that stays rigid
OF_RIGID, *OF_ERODING = MOVING = ("forrestal", "tate", "walker-anderson")


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


def motions(shot: model_deck.Shot, velocity: float, *, eroding: bool, thickness: float | None = None) -> dict[str, Motion]:
    """The motion at an impact velocity in m/s by every model of ``MOVING`` that applies, by its name in words.

    eroding : whether rods of the runs erode, so that the model of a rigid rod does not apply
    thickness : of the target, m; a motion ends when it reaches the rear, beyond which no model here applies
    """
    by_name = {}
    for name in OF_ERODING if eroding else MOVING:
        try:
            motion = models.named(name).moves(velocity, beside.case(name, shot).values)
        except InputError:
            continue
        motion = motion if thickness is None else _up_to(motion, thickness)
        if len(motion.time) > 1:
            by_name[_title(name)] = motion
    return by_name


def _up_to(motion: Motion, depth: float) -> Motion:
    """The part of a motion up to a depth in m."""
    if motion.depth[-1] <= depth:
        return motion
    last = int((motion.depth >= depth).argmax())
    share = (depth - motion.depth[last - 1]) / (motion.depth[last] - motion.depth[last - 1])

    def part(values: np.ndarray) -> np.ndarray:
        return np.append(values[:last], values[last - 1] + share * (values[last] - values[last - 1]))

    return Motion(*(part(each) for each in (motion.time, motion.velocity, motion.depth)),
                  None if motion.length is None else part(motion.length))


def _title(name: str) -> str:
    return models.named(name).title.split(":")[0]


def _curve(name: str, shot: model_deck.Shot, velocity: np.ndarray) -> Curve:
    title = _title(name)
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
