"""Recht-Ipson and Lambert-Jonas models for the residual velocities of a series of runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hydro2d.analytic.catalogue import InputError, lambert_jonas, recht_ipson
from hydro2d.study.records.record import Record
from hydro2d.study.records.responses import RESIDUAL, raw
from hydro2d.study.search import ballistic

if TYPE_CHECKING:
    import pandas

POINTS = 121
#: share of length and diameter of a projectile up to which a plate is thin enough for a plug
THIN = 0.5


@dataclass(frozen=True)
class Curve:
    """A model's residual velocity over the impact velocity, both (n,) in m/s; the colour of its series, or none."""

    title: str
    velocity: np.ndarray
    residual: np.ndarray
    colour: str = ""


def shots(records: Sequence[Record]) -> pandas.DataFrame:
    """The runs that have ended, sorted by impact velocity: ``velocity`` and ``residual`` in m/s, 0 for stopped projectiles."""
    import pandas

    pairs = [(record.velocity, raw(record, RESIDUAL)) for record in records if not record.unfinished]
    known = pandas.DataFrame(pairs, columns=["velocity", "residual"], dtype=float).dropna()
    return known.assign(residual=known["residual"].clip(lower=0.0)).sort_values(["velocity", "residual"])


def curves(records: Sequence[Record], low: float, high: float) -> tuple[list[Curve], list[str]]:
    """The models of a series between two impact velocities in m/s, and notes with their constants, or why one is missing."""
    ended, velocity = shots(records), np.linspace(low, high, POINTS)
    drawn, notes = [], []
    stopped, through = (ended["velocity"][side] for side in (ended["residual"] == 0.0, ended["residual"] > 0.0))
    if by_chance := _differ_by_chance(records):
        fit, why = ballistic.of_shots(ended["velocity"], ended["residual"])
        said = fit and f"ballistic limit {fit.in_words}, {fit.origin}"
    else:
        fit, why = _least_squares(ended["velocity"].tolist(), ended["residual"].tolist(), through.nunique() == 2)
        said = why
    if fit is None:
        notes.append(f"Lambert-Jonas is not drawn: {why}")
    else:
        left = [lambert_jonas.residual_velocity(v, limit_velocity=fit.limit_velocity, a=fit.a, p=fit.p) for v in velocity]
        drawn.append(Curve("Lambert-Jonas", velocity, np.array(left)))
        notes.append(f"Lambert-Jonas, fitted to these runs: {said}")
    if stopped.max() < through.min() and not (by_chance and fit):
        limit = 0.5 * (stopped.max() + through.min())
        origin = f"midway between {stopped.max():.0f} m/s, stopped, and {through.min():.0f} m/s, through"
    elif fit:
        limit, origin = fit.limit_velocity, "of the fit"
    else:
        reason = "needs a ballistic limit, from a run that is stopped and a faster one that goes through, or from the fit"
        return drawn, [*notes, f"Recht-Ipson is not drawn: it {reason}"]
    ratio, why = _plug(records[0])
    for name, mass_ratio in (("Recht-Ipson, plug", ratio), ("Recht-Ipson, no plug", 0.0)):
        if mass_ratio is not None:
            left = [recht_ipson.residual_velocity(v, limit_velocity=limit, plug_mass_ratio=mass_ratio) for v in velocity]
            drawn.append(Curve(name, velocity, np.array(left)))
    return drawn, [*notes, f"Recht-Ipson with a ballistic limit of {limit:.0f} m/s, {origin}; {why}"]


def _differ_by_chance(records: Sequence[Record]) -> bool:
    """Whether runs are shots of a search with a budget or members of an ensemble: their first time steps differ."""
    return len({(record.deck.get("numerics") or {}).get("initial_dt_factor") for record in records}) > 1


def _least_squares(velocities: Sequence[float], residuals: Sequence[float], two: bool) -> tuple[lambert_jonas.Fit | None, str]:
    """The fit and its constants in words, or None and the reason; with two perforations p is 2."""
    try:
        fit = lambert_jonas.fit(velocities, residuals, p=2.0 if two else None)
    except InputError as error:
        return None, str(error)
    fixed = " (p = 2 taken, there are two perforations)" if two else ""
    return fit, (f"a = {fit.a:.3f}, p = {fit.p:.3g}{fixed}, ballistic limit {fit.limit_velocity:.0f} m/s, "
                 f"standard error {fit.standard_error:.1f} m/s")


def _plug(record: Record) -> tuple[float | None, str]:
    """Mass of a plug as wide as the projectile, over the mass of the projectile; or None and the reason."""
    setup = record.setup
    mass = record.first.get("rod_mass_kg")
    if setup is None or setup.thickness is None or not mass:
        return None, "without a plug, since the masses of plug and projectile are not known"
    if not setup.thickness < THIN * min(setup.length, setup.diameter):
        return None, f"without a plug, which a plate thinner than {THIN:g} of the projectile's length and diameter has"
    if record.target_density is None:
        return None, "without a plug, since the projectile meets several plates"
    ratio = record.target_density * math.pi / 4.0 * setup.diameter**2 * setup.thickness / mass
    return ratio, f"the plug, as wide as the projectile, has {ratio:.2g} of its mass"
