"""What a shot came to: perforated or not, how deep, how fast behind the target; decided here and nowhere else."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from hydro2d.measure.regime import LEFT
from hydro2d.measure.result import Number, Result, result

if TYPE_CHECKING:
    from hydro2d.measure.penetrator import Projectile
    from hydro2d.measure.summary import Summary

DONE = "done"
#: stop reasons of runs that were cut short, and the share of the impact velocity above which a projectile still moves
CUT, MOVING = ("end time", "number of cycles"), 0.01
#: speeds from here on are told as whole numbers, m/s
WHOLE_SPEED = 10.0
#: beginnings of the stop reasons of projectiles at rest
RESTED = ("speed of", "rebound of")
#: what a depth, or its error, is
COMPUTED, EXACT, AT_LEAST, AT_MOST, NONE = "computed", "exact", "at least", "at most", "none"


class Outcome(Result):
    """A shot with a projectile and targets at its end, by which runs are compared. SI."""

    perforated: bool | None = result(
        "whether the projectile is through the last target and has not come to rest or turned back since")
    final: bool | None = result(
        "whether the run ended by its own condition, or with the projectile at rest, through or out of the mesh: it would "
        "not go deeper")
    depth_m: Number = result(
        "depth of penetration: the largest depth of the projectile below the first face; once it has perforated, the thickness "
        "of all targets with the gaps between them, if the last one has a rear")
    depth_is: str | None = result("computed, or at least: the projectile has perforated or left the mesh")
    residual_velocity_m_s: Number = result(
        "axial velocity of what is left of the projectile behind the last target or at the edge of the mesh; 0 if it has "
        "stopped; null while neither is known")
    length_ratio: Number = result("length of the projectile over that at the start")
    radius_ratio: Number = result("its largest radius over that at the start")
    mass_ratio: Number = result("its mass in the mesh over that at the start")
    energy_dropped: Number = result("energy that the remap of velocities discarded, over the energy at the start")
    depth_error_m: Number = result("depth minus that of the experiment; null without one, before the end, between two bounds")
    depth_error_percent: Number = result("this error in per cent of the depth of the experiment")
    depth_error_is: str | None = result(
        "exact; at least or at most, if one of the two depths is a lower bound; none, if the run has reached a lower bound")
    residual_error_m_s: Number = result("residual velocity minus that of the experiment")


def ratio(value: float | None, reference: float | None) -> float | None:
    """A value over its reference; None if either is missing, or the reference is zero."""
    return None if value is None or not reference else value / reference


def cut(stop_reason: str | None, speed: float | None) -> str:
    """'end time, still moving at 763 m/s': how a run ended that was cut short; speed : of the core of the projectile, m/s"""
    speed = abs(speed or 0.0)
    return f"{stop_reason}, still moving at {f'{speed:.0f}' if speed >= WHOLE_SPEED else f'{speed:.3g}'} m/s"


def so_far(summary: Summary) -> bool:
    """Whether the projectile could have gone deeper when the run ended."""
    return summary.outcome is not None and summary.outcome.final is False


def ended_by(summary: Summary) -> str | None:
    """The stop reason of a run; with the speed of a projectile that still moved at its end."""
    moves = summary.status == DONE and so_far(summary)
    return cut(summary.stop_reason, summary.rod_core_velocity_m_s) if moves else summary.stop_reason


def beyond(targets: Iterable[str], nose: str) -> str:
    """'plate; nose 1.47 cm beyond its front face', of perforated targets."""
    first, *more = targets
    return f"{', '.join((first, *more))}; nose {nose} beyond {f'the front face of {first}' if more else 'its front face'}"


def rested(stop_reason: str | None) -> bool:
    """Whether a run ended because its projectile was at rest or had turned back."""
    return (stop_reason or "").startswith(RESTED)


def depth_error(depth: float, at_least: bool, measured: float, qualifier: str | None) -> tuple[float | None, str]:
    """Depth of a run minus a measured one, m, and what this error is: EXACT, AT_LEAST, AT_MOST or NONE.

    at_least : whether the depth is a lower bound;  qualifier : of the experiment, whose "at least" is one

    There is no error if both are bounds, or if the run is at least as deep as a bound.
    """
    bound = qualifier == AT_LEAST
    if bound and (at_least or depth >= measured):
        return None, NONE
    return depth - measured, AT_MOST if bound else AT_LEAST if at_least else EXACT


def of(measured: Projectile, *, status: str, stop_reason: str, impact_velocity: float, thickness: float | None,
       dropped: float | None, experiment=None) -> Outcome:
    """The outcome of a shot.

    measured : its projectile at the end;  impact_velocity : m/s
    thickness : from the face of the first target to the rear of the last, m; None if that has no rear
    dropped : energy that the remap of velocities discarded over that at the start
    experiment : of the deck, with `penetration`, `qualifier` and `residual_velocity`, or None
    """
    perforated = measured.exit_time_s is not None and not rested(stop_reason)
    at_least = perforated or measured.regime == LEFT
    moves = abs(measured.rod_core_velocity_m_s or 0.0) > MOVING * impact_velocity
    final = status == DONE and (at_least or not (stop_reason in CUT and moves))
    depth = thickness if perforated and thickness is not None else measured.penetration_depth_m
    residual = 0.0 if final and not at_least else measured.rod_residual_velocity_m_s
    error, kind, error_of_residual = None, None, None
    if experiment is not None and final:
        if experiment.penetration and depth is not None:
            error, kind = depth_error(depth, at_least, experiment.penetration, experiment.qualifier)
        if experiment.residual_velocity is not None and residual is not None:
            error_of_residual = residual - experiment.residual_velocity
    return Outcome(
        perforated=perforated, final=final, depth_m=depth, depth_is=AT_LEAST if at_least else COMPUTED,
        residual_velocity_m_s=residual,
        length_ratio=ratio(measured.rod_length_m, measured.rod_initial_length_m),
        radius_ratio=ratio(measured.rod_max_radius_m, measured.rod_initial_radius_m),
        mass_ratio=ratio(measured.rod_mass_kg, measured.rod_initial_mass_kg), energy_dropped=dropped,
        depth_error_m=error, depth_error_percent=None if error is None else 100.0 * error / experiment.penetration,
        depth_error_is=kind, residual_error_m_s=error_of_residual)
