"""A simulation: a deck made into a mesh, a state and a cycle, with the results after every step."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import numpy as np

from hydro2d import jit
from hydro2d.base import units
from hydro2d.base.errors import UnphysicalState, unknown
from hydro2d.base.interrupt import Interrupt, signals
from hydro2d.deck import deck as decks
from hydro2d.deck import formulas, targets
from hydro2d.deck.layout import body_at
from hydro2d.jit import compilation
from hydro2d.kernels import between_phases
from hydro2d.materials import library, quantities
from hydro2d.measure import bodies, debris, outcome, reach, wall_damage
from hydro2d.measure.audit import Audit, Totals, totals
from hydro2d.measure.bodies import Body
from hydro2d.measure.crater import Crater
from hydro2d.measure.debris import Debris
from hydro2d.measure.ejecta import Ejecta, Ejected
from hydro2d.measure.outcome import Outcome
from hydro2d.measure.penetrator import LEFT_MASS, WATCH_EVERY, Penetrator
from hydro2d.measure.sanity import TRUSTED, discards, doubts, faults
from hydro2d.measure.summary import Target
from hydro2d.mesh import fields, sums
from hydro2d.mesh.boundary_conditions import BoundaryConditions
from hydro2d.mesh.edges.base import PUSH
from hydro2d.mesh.grid import Grid
from hydro2d.mesh.state import State
from hydro2d.solver import far_field, insertion, stops
from hydro2d.solver.first_cycle import calls_of_a_cycle, kernels
from hydro2d.solver.following import FixedMesh, FollowingMesh, UndisturbedSpace
from hydro2d.solver.memory_needed import refuse_too_large
from hydro2d.solver.recorder import Recorder
from hydro2d.solver.sources import Sources
from hydro2d.solver.time_step import Steps

if TYPE_CHECKING:
    import pandas
    import pyvista
    import xarray
    from numpy.typing import ArrayLike

    from hydro2d.solver.method import Method


#: the longest time in one call of compiled code, s, after which an interrupt is seen
AT_ONCE = 0.1
#: share of the time in which the fastest possible wave crosses the smallest cell, below which no sound run has a time step
SOUND_STEP = 0.01


class Simulation:
    """A deck in memory, to be stepped and inspected. It writes no files: `hydro2d.run` does.

    While kernels are compiled, a line on the error output or below the cell of a notebook shows the progress.

    Parameters
    ----------
    deck : Deck

    Attributes
    ----------
    columns : dict of functions of the simulation, by name
        Further columns of the history, each a number. The ending of a name gives its unit: ``_m``, ``_m_s``, ``_Pa``, ``_K``.
    formulas : dict of Expression by name
        Those that [derived] of the deck defines.
    own_results : dict of OwnResult by name
        The files that [result] of the deck names.
    lengths : dict of float by name
        Extent of every body along the axis at the start, m; None for one that filled no cell by half.
    grid, state, table, audit : the mesh, the fields, the materials, the conserved quantities
    stations : the tracers and gauges
    penetrator : measures the projectile; None for a deck without projectile and target
    craters : measure the hole in each target, in the order in which the projectile meets them; empty without both

    Raises DeckError if the machine does not have the memory for the mesh.
    """

    def __init__(self, deck: decks.Deck):
        from hydro2d.measure.stations import Stations
        from hydro2d.solver.cycle import Cycle  # these load kernels, after which no model can be added
        from hydro2d.solver.method import Method

        refuse_too_large(deck)
        compilation.expect(kernels(deck), lambda: calls_of_a_cycle(lambda: Simulation(deck)))
        self.deck = deck
        self.grid = Grid(*decks.edges(deck), deck.mesh.geometry)
        self.table = library.resolve(deck)
        slots = decks.slots(deck)
        method = Method.from_deck(deck, slots, decks.sliding_widths(deck), decks.yield_factor(deck))
        self.state = State(self.grid, len(slots), method.group, self.table.internal, self.table.initial,
                           self.table.remembers)
        self._insert(method.boundaries)
        far_field.place(deck, self.state, self.table, method.boundaries)
        self.sources = Sources(deck.source, self.state, self.table, [slots.index(entry.body) for entry in deck.source])
        #: warnings of the sources about the deck on its mesh, one sentence each
        self.warnings = self.sources.begin()
        speed = reach.speed_of_all(deck, self.table, self.grid)
        self.engine = Cycle(self.state, self.table, method, self._mesh(slots, method), self.sources, speed)
        self.engine.prepare()
        self._reach = reach.of(deck, self.table, self.state, self.audit.start)
        self._doubts: dict[str, str] = {}
        self._notes: dict[str, str] = {}
        self._steps, self._counted = Steps(), 0
        self.engine.given.set(looks_every=WATCH_EVERY)
        self.engine.watches.append(self._look_at_state)
        self.stations = Stations(self, deck, [body_at(deck, entry.r, entry.z) for entry in deck.tracer])
        self._rows, self._pace = np.zeros((2, self.grid.shape[0])), 0.0
        self.penetrator, self.craters = self._penetration()
        self._ejecta = self._ejecta_of()
        if self.penetrator:
            self.engine.watches.append(self._look_at_shot)
        #: the conditions of [stop] that end a run, see `solver.stops`
        self.stops = stops.of(self)
        self.columns: dict[str, Callable[[Simulation], float]] = {}
        self.lengths = bodies.lengths(self)
        self.formulas, self.own_results = formulas.expressions(deck), formulas.own_results(deck)
        assert deck.output.history_interval is not None, "a resolved deck has one"
        self._recorder = Recorder(deck.output.history_interval)

    def _penetration(self) -> tuple[Penetrator | None, list[Crater]]:
        """The measurements of the projectile and of the holes in its targets."""
        if self.deck.penetration is None:
            return None, []
        penetrated, flying = targets.targets(self.deck), targets.flight(self.deck)
        next_rows = np.zeros((len(penetrated), 1))
        self.engine.given.set(crater_rows=next_rows[:, 0])
        craters = [Crater(self, target, flying.direction, own) for target, own in zip(penetrated, next_rows, strict=True)]
        return Penetrator(self, flying, penetrated), craters

    def _ejecta_of(self) -> list[Ejecta]:
        """The measurements of what flies back from the targets."""
        if self.penetrator is None:
            return []
        rod, gone = self.penetrator.m, np.zeros((len(self.craters), 3))
        fronts = [(each.direction, each.target.surface, each.rear, each.target.velocity) for each in self.craters]
        self.engine.given.set(ejecta=np.array(fronts, dtype=float), ejecta_gone=gone,
                              ejecta_bodies=np.array([(each.m, rod) for each in self.craters], dtype=np.int64))
        return [Ejecta(self, each, rod, own) for each, own in zip(self.craters, gone, strict=True)]

    def _mesh(self, slots: list[str], method: Method) -> FixedMesh | FollowingMesh:
        """The motion of the mesh."""
        name = self.deck.mesh.follow
        if name is None:
            return FixedMesh()
        direction = float(np.sign(decks.body(self.deck, name).velocity[1]))
        space = UndisturbedSpace(self.deck, self.table, self.grid)
        inner, outer, *_ = method.boundaries.having("mirrors")
        return FollowingMesh(self.state, space, slots.index(name), direction, (inner, outer))

    def _insert(self, conditions: BoundaryConditions) -> None:
        """Fills the mesh.

        Vertex velocities of a body group are the mass-weighted means of its own in the cells around; where there is none of
        it, those of the other group.
        """
        s, g = self.state, self.grid
        first = insertion.initial_state(self.deck, g, self.table, s.group)
        for name in ("vof", "centroid", "rho", "e"):
            g.interior(getattr(s, name))[...] = first[name]
        mass, dual = np.zeros((s.groups, *g.shape)), np.zeros((s.groups, *g.vertex_shape))
        for b in range(s.groups):
            own = s.group == b
            g.interior(mass)[b] = np.sum(first["vof"][own] * first["rho"][own], axis=0) * g.volume[g.inside]
        for cell, vertex in ((first["u_cell"], s.u), (first["v_cell"], s.v)):
            momentum = np.zeros_like(mass)
            g.interior(momentum)[...] = cell * g.interior(mass)
            self._gather(momentum, vertex)
        self._gather(mass, dual)
        for vertex in (s.u, s.v):
            np.divide(vertex, dual, out=vertex, where=dual > 0)
            vertex[...] = np.where(dual > 0, vertex, vertex[::-1])
        ends = (g.g, g.g + g.nr, g.g, g.g + g.nz)
        for edge, (at, kind, velocity) in enumerate(zip(ends, conditions.edges, conditions.velocity[4:], strict=True)):
            if kind.slide() is not None:
                (s.v[..., at] if edge < 2 else s.u[:, at])[...] = velocity
        for edge, (at, kind, velocity) in enumerate(zip(ends, conditions.edges, conditions.velocity[:4], strict=True)):
            normal = s.u[..., at] if edge < 2 else s.v[:, at]
            if kind.constrains():
                normal[...] = velocity
            elif kind.traction() == PUSH:
                (np.maximum if edge % 2 == 0 else np.minimum)(normal, 0.0, out=normal)

    def _gather(self, cell: np.ndarray, vertex: np.ndarray) -> None:
        """Adds the corner shares of a cell quantity to the vertices."""
        inner, outer = cell * self.grid.cm_in, cell * self.grid.cm_out
        vertex[..., :-1, :-1] += inner
        vertex[..., 1:, :-1] += inner
        vertex[..., :-1, 1:] += outer
        vertex[..., 1:, 1:] += outer

    # ------------------------------------------------------------------------------------------------ running

    @property
    def time(self) -> float:
        """Time since the start, s."""
        return self.engine.time

    @property
    def cycle(self) -> int:
        """Number of cycles done."""
        return self.engine.number

    @property
    def dt(self) -> float:
        """The last time step, s."""
        return self.engine.dt

    @property
    def dt_cause(self) -> str:
        """The place and reason of the limit on the time step, in words."""
        return self.engine.cause

    @property
    def audit(self) -> Audit:
        """Conserved quantities, and losses from the mesh or by the method."""
        assert self.engine.audit is not None, "it is opened when the cycle is prepared"
        return self.engine.audit

    def run(self, until: float | str | Callable[[Simulation], bool] | None = None,
            callbacks: Iterable[Callable[[Simulation], object]] = ()) -> str:
        """Steps until a condition ends the run, and returns that condition. Call it again to continue.

        Parameters
        ----------
        until : float, str or function of the simulation
            A time in s or text such as ``"50 us"``, which the last cycle reaches or passes; or a function that is true at the
            end. None: the [stop] of the deck, which is ignored otherwise.
        callbacks : functions of the simulation
            Each is called after every cycle; `hydro2d.every` makes one that is called at intervals.

        Adds a row to `history` at every ``output.history_interval`` of the deck, and at the end.

        Raises UnphysicalState, ColumnError for a column that fails, and KeyboardInterrupt, after which `run` can continue: an
        interrupt waits for the end of the cycle.
        """
        ended, last, callbacks, interrupt = *self._end(until), tuple(callbacks), Interrupt()
        most = 1 if callbacks or callable(until) else None
        self._recorder(self)
        with signals(interrupt):
            while (reason := ended()) is None and not interrupt.reason:
                self.advance(min(last, self._recorder.due.next), most)
                for each in callbacks:
                    each(self)
                self._recorder(self)
        if reason is None:
            raise KeyboardInterrupt(f"{self!r} was interrupted ({interrupt.reason})")
        self.refuse_nonsense()
        self._recorder.last(self)
        return reason

    @property
    def last_time(self) -> float:
        """The time at which the [stop] of the deck ends a run, s; inf without one."""
        return math.inf if self.deck.stop.time is None else self.deck.stop.time

    def _end(self, until: float | str | Callable[[Simulation], bool] | None) -> tuple[Callable[[], str | None], float]:
        """A function that gives the reason why `run` is over, or None; and the time at which it is, s, inf if none is set."""
        if until is None:
            return self.stop_reason, self.last_time
        if callable(until):
            return lambda: "as asked" if until(self) else None, math.inf
        time = units.to_si(until, "s")
        return lambda: "end time" if self.time >= time else None, time

    @property
    def history(self) -> dict[str, np.ndarray]:
        """Columns of the history that `run` has recorded, by name, shapes (rows,); empty before the first run."""
        return self._recorder.columns.arrays()

    def to_pandas(self) -> pandas.DataFrame:
        """The history as a pandas.DataFrame over the time in s; ``attrs["units"]`` has the unit of every column."""
        from hydro2d.output import history

        return history.frame(self.history)

    def __repr__(self) -> str:
        where = f"{1e6 * self.time:.2f} us, cycle {self.cycle}, {self.grid.nr} x {self.grid.nz} cells"
        return f"<Simulation {self.deck.name}: {where}>"

    def step(self) -> None:
        """One cycle. Raises UnphysicalState."""
        self.engine.advance()
        self._count_steps()

    def advance(self, until: float = math.inf, cycles: int | None = None) -> int:
        """Cycles in one call of compiled code, at least one, and returns their number.

        until : time in s that the last one reaches or passes, unless another reason comes first
        cycles : the most; by default, up to the next look at the whole state or the last cycle, or as many as take AT_ONCE

        Raises UnphysicalState.
        """
        before, began = self.cycle, clock.perf_counter()
        last = self.deck.stop.cycles
        most = min(WATCH_EVERY - before % WATCH_EVERY, max(last - before, 1) if last else WATCH_EVERY)
        if self._pace > 0.0:
            most = max(min(most, int(AT_ONCE / self._pace)), 1)
        self.engine.play(until, before + min(most, cycles or most))
        self._count_steps()
        done = self.cycle - before
        self._pace = (clock.perf_counter() - began) / done
        return done

    def _count_steps(self) -> None:
        """Looks at the steps that have been taken since the last call."""
        handle = self.engine.given.handle
        for number in range(self._counted, self.cycle):
            here = number % len(handle.lengths)
            self._refuse_collapse(number + 1, float(handle.lengths[here]), bool(handle.grown[here]))
        self._counted = self.cycle

    def _look_at_state(self, given: jit.Conductor) -> None:
        """Every few cycles, looks for faults of the state."""
        given.ask(between_phases.is_time_to_look, self.refuse_nonsense)

    def _look_at_shot(self, given: jit.Conductor) -> None:
        """Every few cycles, and when they may have to be, looks at the projectile and the craters."""
        given.ask(between_phases.watch_shot, self._watch_shot)

    def _watch_shot(self) -> None:
        assert self.penetrator is not None, "only a shot is watched"
        self.penetrator.watch()
        for crater in self.craters:
            crater.record()

    def velocity_at(self, points: ArrayLike, group: int | None = None) -> np.ndarray:
        """Velocity (u, v) at points (r, z), shape [n, 2], m/s: of a body group, or of the group that the cell moves with.

        Raises ValueError for points of another shape.
        """
        from hydro2d.measure import tracers

        return tracers.velocity_at(self.grid, self.state, points, group)

    def body_sums(self, m: int) -> tuple[np.ndarray, np.ndarray]:
        """Mass and axial momentum of body m by row, shape (nz,); per radian (per unit depth in planar geometry)."""
        g, s = self.grid, self.state
        sums.body_sums(g.g, g.nz, g.nr, m, g.cm_in, g.cm_out, g.volume, s.vof, s.rho, s.v[s.group[m]], self._rows)
        mass, momentum = self._rows[:, g.inside[0]]
        return mass, momentum

    def mean_velocity(self, m: int) -> float | None:
        """Axial velocity of the centre of mass of body m, m/s; None if there is none of it."""
        mass, momentum = (float(rows.sum()) for rows in self.body_sums(m))
        return momentum / mass if mass > 0.0 else None

    def has_left(self, m: int) -> bool:
        """Whether body m has left through open edges, except for a hundredth of its mass."""
        sinks = self.audit.sinks
        whole = self.audit.start.mass[m] - sinks["inflow"].mass[m]
        return bool(sinks["outflow"].mass[m] > (1.0 - LEFT_MASS) * whole > 0.0)

    def stop_reason(self) -> str | None:
        """Why the run is over, or None."""
        return next((reason for stop in self.stops if (reason := stop.reason()) is not None), None)

    # ------------------------------------------------------------------------------------------------ results

    def of_targets(self) -> dict[str, Target]:
        """Each target by name: the passage of the projectile, damage, hole, debris behind and ejecta before it."""
        if not self.penetrator:
            return {}
        results, debris = {}, self.debris()
        for target, passage, crater, front in zip(self.penetrator.targets, self.penetrator.passages(), self.craters,
                                                  self._ejecta, strict=True):
            hole, behind = crater.measure(), debris[target.name]
            damage = wall_damage.classify(self, crater, hole, front.lost)
            results[target.name] = Target(**passage, damage_class=damage, crater=hole, debris=behind.totals,
                                          ejecta=front.measure(damage, behind.momentum))
        return results

    def ejecta(self) -> Ejected | None:
        """What flies back from the first target; None without projectile and target."""
        return next((target.ejecta for target in self.of_targets().values()), None)

    def outcome(self, status: str, stop_reason: str) -> Outcome | None:
        """What the shot has come to if the run ends now; None without projectile and target."""
        if self.penetrator is None:
            return None
        audit, taken = self.audit, self.audit.sinks.get("advection")
        dropped = outcome.ratio(taken.energy if taken else None, audit.start.energy)
        return outcome.of(self.penetrator.measure(), status=status, stop_reason=stop_reason, dropped=dropped,
                          impact_velocity=decks.impact_velocity(self.deck), thickness=targets.thickness(self.deck),
                          experiment=self.deck.experiment)

    def debris(self) -> dict[str, Debris]:
        """Debris behind each target, by the target's name; empty without projectile and target."""
        targets = self.penetrator.targets if self.penetrator else []
        return {target.name: debris.find(self, crater, [later.m for later in targets[number + 1 :]])
                for number, (target, crater) in enumerate(zip(targets, self.craters, strict=True))}

    def holes(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Axial positions and radii of the hole in each target, m, shapes (n,), by the target's name."""
        names = self.deck.penetration.targets if self.deck.penetration else ()
        return {name: crater.profile() for name, crater in zip(names, self.craters, strict=True)}

    def diagnostics(self) -> dict:
        """Depth, length, speeds and strain of a projectile; empty for a deck without one. SI."""
        return dict(self.penetrator.measure()) if self.penetrator else {}

    @property
    def projectile(self) -> str | None:
        """Name of the body that is measured as the projectile; None without one."""
        return self.table.names[self.penetrator.m] if self.penetrator else None

    def of_bodies(self) -> dict[str, Body]:
        """Mass, motion and extent of every body by name."""
        return bodies.measure(self)

    def conservation(self) -> dict:
        """Relative changes that no sink explains: mass per body, axial momentum, total energy; and every sink by name.

        In addition, for each body, how far its centre of mass was off its course at the last check (`courses.Courses`).
        """
        result = self.audit.balance(self.state)
        result["mass"] = dict(zip(self.table.names, (float(x) for x in result["mass"]), strict=True))
        off = np.abs(self.engine.courses.apart).max(axis=1).tolist()
        result["off_course_cells"] = dict(zip(self.table.names, off, strict=True))
        return result

    def totals(self) -> Totals:
        """Sums over the mesh, per radian (per unit depth in planar geometry).

        It has ``mass`` and ``internal_of`` of each body, shapes (bodies,), axial ``momentum``, ``internal``, ``kinetic`` and
        the sum of both as ``energy``.
        """
        return totals(self.state)

    def faults(self, share: float = TRUSTED) -> list[str]:
        """Reasons not to trust the state, see `sanity.faults`; empty if there are none."""
        return faults(self.state, self.audit, self.table.names, self._reach, share)

    def not_finite(self) -> str | None:
        """The first number of the state that is not finite and its place, in words; None if all are."""
        return self.engine.refusals.not_finite()

    def doubts(self) -> list[str]:
        """Reasons not to trust the run: when a body was first too hot or too cold in some cell, or off its course."""
        return list(self._doubts.values())

    def notes(self) -> list[str]:
        """What was beyond a bound and decides nothing, with the reason, as `doubts`."""
        return [sentence for what, sentence in self._notes.items() if what not in self._doubts]

    def _given(self) -> np.ndarray:
        """The most energy that sources and the work of edges have given to a cell of each body so far, J/kg, float64[m]."""
        return self.sources.given + reach.CELL_HOTTER * self._reach.given_by(self.audit.worked)

    def _refuse_collapse(self, number: int, dt: float, grown: bool) -> None:
        """Raises UnphysicalState if the time steps have collapsed, to what no motion that the shot can have explains.

        number, dt : of the cycle and its step, s;  grown : whether the step has only grown from the one before
        """
        engine = self.engine
        if number <= engine.method.numerics.ramp_cycles or not self._steps.collapse(dt, grown):
            return
        size = min(widths[inside].min() for widths, inside in zip((self.grid.dz, self.grid.dr), self.grid.inside, strict=True))
        hottest = float(np.max(self._reach.cell_highest + self._given()))
        speed = self._reach.speed + float(engine.sound_speeds.max()) + (2.0 * hottest) ** 0.5
        if dt < SOUND_STEP * size / speed:
            engine.refusals.collapsed_step(self._steps.median)

    def refuse_nonsense(self) -> None:
        """Raises UnphysicalState with the first fault of the state, if it has any, and records doubts and notes."""
        self.engine.courses.look(self.time, keep=self.cycle % WATCH_EVERY == 0)
        doubtful = doubts(self.state, self.table, self.time, self._reach, self._given(), self.audit)
        for doubt in (*doubtful, *discards(self.audit, self._reach), *self.engine.courses.parted(self.table.names)):
            said = f"cycle {self.cycle}, time {self.time:.6g} s: {doubt.sentence}"
            if doubt.harmless:
                self._notes.setdefault(doubt.what, f"{said}; {doubt.harmless}")
            else:
                self._doubts.setdefault(doubt.what, said)
        if faults := self.faults(self.deck.numerics.clip_limit):
            raise UnphysicalState(f"cycle {self.cycle}, time {self.time:.6g} s: {faults[0]}")

    # ------------------------------------------------------------------------------------------------ fields

    def array(self, name: str) -> np.ndarray:
        """A field of the solver as a read-only view without ghost cells, which later cycles change.

        name : name or symbol in the table of fields, such as "density" or "rho"

        Shape (bodies, nz, nr) for fields of the bodies, (nz, nr) for those of cells, (groups, nz + 1, nr + 1) for those of
        vertices, with one group unless there is contact. In cells without a body its fields have no meaning. Raises FieldError.
        """
        field = next((each for each in fields.FIELDS if name in (each.name, each.symbol)), None)
        if field is None:
            now = quantities.DEVIATORS.get(name)
            raise quantities.FieldError(f"{name} is now called {now}" if now else
                                        unknown("field", name, (each.name for each in fields.FIELDS)))
        values = getattr(self.state, field.symbol)
        inner = self.grid.interior_vertices(values) if field.centring == "vertex" else self.grid.interior(values)
        inner.flags.writeable = False
        return inner

    def field(self, key: str, body: str | None = None) -> np.ndarray:
        """A quantity as it is written and drawn, computed now: shape (nz, nr), or (nz, nr, 3) for a vector (r, z, 0).

        key : of the table of quantities, such as "pressure", "velocity", "body_density"
        body : name of the body, for a quantity that every body has

        Raises FieldError.
        """
        from hydro2d.output import derived_quantities as fields_now

        quantity = quantities.BY_KEY.get(key)
        if quantity is None:
            raise quantities.FieldError(unknown("field", key, quantities.BY_KEY))
        if quantity.per_body and body not in self.table.names:
            raise quantities.FieldError(f"{key} is one of every body; " + unknown("body", str(body), self.table.names))
        values = fields_now.evaluate(self, (key,)).get(quantity.name(body))
        if values is None:
            raise quantities.FieldError(f"{key}: the simulation has none" + (f" for {body}" if body else ""))
        return values

    @property
    def fields(self) -> xarray.Dataset:
        """All present quantities over z and r, in SI units; computed anew at every call."""
        from hydro2d.output import datasets, vtk

        return datasets.of_state(vtk.Dump.of(self))

    def to_pyvista(self) -> pyvista.RectilinearGrid:
        """All present quantities, as cell data of a pyvista.RectilinearGrid with x = r, y = z."""
        from hydro2d.output import derived_quantities as fields_now
        from hydro2d.output import vtk

        return vtk.pyvista_of(self.grid.r_edges, self.grid.z_edges, fields_now.evaluated(self), self.time)

    # ------------------------------------------------------------------------------------------------ restart

    def restart_arrays(self) -> dict[str, np.ndarray]:
        """All arrays that a restart needs, by name."""
        return {**self.state.restartable(), "stations": self.stations.places, "peaks": self.stations.peaks}

    def load_restart_arrays(self, arrays: dict[str, np.ndarray]) -> None:
        """Takes the arrays of a restart file; ValueError if one is missing or differs in shape or type."""
        for name, array in self.restart_arrays().items():
            stored = arrays.get(name)
            kinds = ["nothing" if each is None else f"{each.dtype}{list(each.shape)}" for each in (stored, array)]
            if kinds[0] != kinds[1]:
                raise ValueError(f"{name} is {kinds[0]} in the restart file and {kinds[1]} in the deck")
        for name, array in self.restart_arrays().items():
            array[...] = arrays[name]

    def restart_scalars(self) -> dict:
        """Data that a restart needs in addition to the arrays; JSON keeps every bit of them."""
        e = self.engine
        return {"time": e.time, "dt": e.dt, "cycle": e.number, "cause": e.cause, "box": [int(x) for x in e.box],
                "mesh_offset": self.grid.offset, "speed_limit": e.speed_limit,
                "stops": {type(stop).__name__: stop.saved() for stop in self.stops}, "doubts": self._doubts,
                "notes": self._notes, "audit": self.audit.saved(), "courses": e.courses.saved(), "steps": self._steps.saved(),
                "sources": self.sources.saved(), "penetrator": self.penetrator and self.penetrator.saved(),
                "craters": [crater.saved() for crater in self.craters], "ejecta": [each.saved() for each in self._ejecta]}

    def load_restart_scalars(self, scalars: dict) -> None:
        """Continues from the result of `restart_scalars`; after `load_restart_arrays`."""
        e = self.engine
        e.time, e.dt, e.number, e.cause = (scalars[name] for name in ("time", "dt", "cycle", "cause"))
        e.active.box, e.speed_limit = list(scalars["box"]), scalars["speed_limit"]
        stops.resume(self.stops, scalars)
        self.grid.move(scalars["mesh_offset"])
        self._doubts, self._notes = dict(scalars["doubts"]), dict(scalars.get("notes", {}))  # files of earlier versions lack it
        e.audit = Audit.resume(scalars["audit"], e.sound_speeds)
        e.courses.resume(scalars["courses"])
        self.sources.resume(scalars.get("sources", 0.0))  # files of earlier versions, without sources, lack it
        self._steps.resume(scalars.get("steps") or self._steps.saved())  # as do those before the steps were watched
        if self.penetrator:
            self.penetrator.resume(scalars["penetrator"])
            for crater, saved in zip(self.craters, scalars["craters"], strict=True):
                crater.resume(saved)
            for front, saved in zip(self._ejecta, scalars.get("ejecta", ()), strict=False):  # likewise
                front.resume(saved)
        self._counted = e.number
        e.prepare()
