"""The conditions that end a run, [stop] of a deck: each is an object that knows its reason and keeps a state of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from hydro2d.measure.penetrator import WATCH_EVERY

if TYPE_CHECKING:
    from hydro2d.solver.simulation import Simulation

#: a body that is slower than this, m/s, has not moved yet
MOVES = 1e-3


class Stop:
    """A condition that ends a run.

    sim : Simulation
    """

    #: cycles between two looks
    every = WATCH_EVERY

    def __init__(self, sim: Simulation):
        self.sim, self.stop = sim, sim.deck.stop

    def reason(self) -> str | None:
        """Why the run is over, or None."""
        return self.now() if self.sim.cycle % self.every == 0 else None

    def now(self) -> str | None:
        """`reason` in a cycle in which it is looked at."""
        raise NotImplementedError

    def saved(self) -> dict[str, Any]:
        """Data for a restart file."""
        return {}

    def resume(self, saved: dict[str, Any]) -> None:
        """Continues from the result of `saved`."""


class EndTime(Stop):
    """The time is reached."""

    every = 1

    def now(self) -> str | None:
        return "end time" if self.sim.time >= self.stop.time else None


class Cycles(Stop):
    """The number of cycles is reached."""

    every = 1

    def now(self) -> str | None:
        return "number of cycles" if self.sim.cycle >= self.stop.cycles else None


class Perforated(Stop):
    """The projectile is through the last target, its tail as well if that is asked for."""

    def now(self) -> str | None:
        penetrator = self.sim.penetrator
        through = penetrator.perforates() and (self.stop.perforation != "tail" or penetrator.cleared())
        return f"perforation of {self.sim.deck.penetration.targets[-1]}" if through else None


class ProjectileGone(Stop):
    """The projectile has left the mesh."""

    def now(self) -> str | None:
        return f"{self.sim.deck.penetration.rod} left the mesh" if self.sim.penetrator.gone else None


class BodyGone(Stop):
    """The body that is watched has left the mesh."""

    def now(self) -> str | None:
        return f"{self.stop.body} left the mesh" if self.sim.has_left(self.sim.table.names.index(self.stop.body)) else None


class Slowed(Stop):
    """The body that is watched is slower than a speed, after it was faster."""

    def __init__(self, sim: Simulation):
        super().__init__(sim)
        self._m = sim.table.names.index(self.stop.body)
        self._moved = False

    def velocity(self) -> float | None:
        """Axial velocity of the body, m/s, of a projectile that of its core or tail; None if nothing of it is left."""
        penetrator = self.sim.penetrator
        return penetrator.speed() if penetrator is not None and penetrator.m == self._m else self.sim.mean_velocity(self._m)

    def now(self) -> str | None:
        velocity = self.velocity()
        if velocity is None:
            return None
        slow = abs(velocity) < self.stop.speed_below
        self._moved = self._moved or not slow
        return f"speed of {self.stop.body} below {self.stop.speed_below:g} m/s" if slow and self._moved else None

    def saved(self) -> dict[str, Any]:
        return {"body": self.stop.body, "moved": self._moved}

    def resume(self, saved: dict[str, Any]) -> None:
        if saved["body"] == self.stop.body:  # else a different one is watched from here on
            self._moved = saved["moved"]


class Rebound(Slowed):
    """The body that is watched flies back."""

    def __init__(self, sim: Simulation):
        super().__init__(sim)
        self._sign: float | None = None

    def now(self) -> str | None:
        velocity = self.velocity()
        if velocity is None:
            return None
        if self._sign is None and abs(velocity) > MOVES:
            self._sign = 1.0 if velocity > 0.0 else -1.0
        return f"rebound of {self.stop.body}" if velocity * (self._sign or 0.0) < 0.0 else None

    def saved(self) -> dict[str, Any]:
        return {"body": self.stop.body, "sign": self._sign}

    def resume(self, saved: dict[str, Any]) -> None:
        if saved["body"] == self.stop.body:
            self._sign = saved["sign"]


def of(sim: Simulation) -> list[Stop]:
    """The conditions of a simulation's deck, in the order in which they are looked at."""
    stop, shot = sim.deck.stop, sim.penetrator is not None
    slows = stop.speed_below is not None or stop.rebound
    watches_rod = shot and stop.body == sim.projectile
    kinds = {
        EndTime: stop.time is not None, Cycles: stop.cycles is not None, Perforated: shot and stop.perforation,
        ProjectileGone: shot and (stop.perforation or (watches_rod and slows)), BodyGone: stop.body and slows,
        Rebound: stop.body and stop.rebound, Slowed: stop.body and stop.speed_below is not None,
    }
    return [kind(sim) for kind, wanted in kinds.items() if wanted]


def resume(stops: list[Stop], scalars: dict[str, Any]) -> None:
    """Continues from what a restart file has of each kind of condition, by its name; version 0.3 has one table for all."""
    saved = scalars["stops"] if "stops" in scalars else {type(stop).__name__: scalars["watch"] for stop in stops}
    for stop in stops:
        if type(stop).__name__ in saved:
            stop.resume(saved[type(stop).__name__])
