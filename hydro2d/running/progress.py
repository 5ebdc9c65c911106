"""Progress reports of a run: a bar and a table on a terminal, a line every few seconds elsewhere, and always log.txt.

The report in a notebook is in `notebook.py`; `reporting.py` chooses among them.
"""

from __future__ import annotations

import re
import shlex
import sys
import time as clock
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from datetime import datetime
from typing import Any, NamedTuple, TypeVar

from hydro2d.base.formats import in_shell, one_line
from hydro2d.base.interrupt import lose_output
from hydro2d.base.moving import LINE_SECONDS
from hydro2d.base.terminal import duration, moment, number, say, several
from hydro2d.measure import outcome
from hydro2d.measure.outcome import EXACT, Outcome
from hydro2d.measure.result import unit
from hydro2d.measure.summary import Conservation, Summary, Target
from hydro2d.measure.wall_damage import NO_DAMAGE
from hydro2d.output import ending
from hydro2d.output.ending import End
from hydro2d.output.history import Columns

T = TypeVar("T")

#: seconds between refreshes of the table
TABLE_SECONDS = 0.5
#: bodies with more than this share of the largest kinetic energy are listed as moving at the end, at most this many
SHOWN, MOST_SHOWN = 1e-3, 6
#: no length is printed for bodies whose length has changed by less than this share; largest number of printed stations
SAME_LENGTH, MOST_STATIONS = 1e-3, 12
AS_LONG = 1e-2  # projectiles whose length and diameter differ by less than this share are as long as they are thick
#: a residual velocity counts as still changing if it has changed by more than this share
SETTLED = 1e-3
#: costs of a run in addition to its cycles, by key of the summary; times below this many seconds are not printed
OTHER_COSTS, LEAST_COST = {"compilation": "compilation_s", "set-up": "set_up_s", "outputs": "outputs_s"}, 0.05
#: lines with commands and paths, which the terminal itself wraps, so that they can be copied; others break at words
WHOLE = re.compile(r"\bhydro2d [a-z]|results in |\S/\S+/")
#: seconds over which the pace is measured, at most and at least
PACE_SECONDS, FIRST_SECONDS = 60.0, 2.0


def worst_mass(conservation: Conservation | dict) -> float:
    """The largest relative change of mass of a body, with its sign."""
    return max(conservation["mass"].values(), key=abs, default=0.0)


def counted(items: Sequence[T], what: str, quiet: bool = False) -> Iterator[T]:
    """Yields the items; if this takes long, a line on stderr every few seconds says how many are done.

    For example "decks read: 512 of 3000"; nothing if ``quiet``.
    """
    last = clock.monotonic()
    for done, item in enumerate(items):
        if not quiet and clock.monotonic() - last >= LINE_SECONDS:
            last = clock.monotonic()
            say(f"{what}: {done} of {len(items)}", file=sys.stderr, flush=True)
        yield item


class Outlook(NamedTuple):
    """The likely end of a run. end : None if not known;  share : of the run that is done, 0 to 1;  left : seconds"""

    end: End | None = None
    share: float | None = None
    left: float | None = None


class Clock:
    """Predicts how a run will end, how much of it is done, and how long the rest will take.

    The end is that of `status`, see `ending.ends`; until the history has enough rows, the end time or the number of cycles of
    the deck. The pace is that of the last minute, so compilation and the small time steps after an impact affect it only for so
    long. Where the steps have grown since, the present one counts. In the first seconds no time is predicted.

    Parameters
    ----------
    stop : the deck's section
    columns : of the history; None: there is none
    clock : returns seconds
    """

    def __init__(self, stop, columns: Columns | None = None, clock: Callable[[], float] = clock.perf_counter):
        self._stop = {key: getattr(stop, key, None) for key in ("time", "cycles", "body", "speed_below", "rebound")}
        self._columns, self._clock = columns, clock
        self._marks: deque[tuple[float, float, int]] = deque()

    def begin(self, sim) -> None:
        """To be called after the first cycle, in which the kernels are compiled or loaded."""
        self._marks.append((self._clock(), sim.time, sim.cycle))

    def look(self, sim) -> Outlook:
        """The likely end of a simulation at present."""
        columns = self._columns.some(ending.needed(self._stop)) if self._columns is not None else {}
        end, (by_time, by_cycle) = ending.first(self._stop, columns), self._pace(sim)
        cycles = self._stop["cycles"]
        if cycles and (end is None or end.reason == ending.END_TIME):  # the history is too short to predict its time
            share = sim.cycle / cycles
            if end is None or share > sim.time / end.time:
                return Outlook(None, min(share, 1.0), (cycles - sim.cycle) / by_cycle if by_cycle else None)
        if end is None:
            return Outlook()
        return Outlook(end, min(sim.time / end.time, 1.0) if end.time > 0.0 else 1.0,
                       max(end.time - sim.time, 0.0) / by_time if by_time else None)

    def _pace(self, sim) -> tuple[float, float]:
        """Simulated seconds, and cycles, per second in the last minute; zeros if not known."""
        now = self._clock()
        if not self._marks:
            return 0.0, 0.0
        if now - self._marks[-1][0] >= PACE_SECONDS / 60:
            self._marks.append((now, sim.time, sim.cycle))
        while len(self._marks) > 2 and now - self._marks[1][0] >= PACE_SECONDS:
            self._marks.popleft()
        then, time, cycle = self._marks[0]
        if now - then < FIRST_SECONDS or sim.cycle == cycle:
            return 0.0, 0.0
        by_cycle = (sim.cycle - cycle) / (now - then)
        return by_cycle * max((sim.time - time) / (sim.cycle - cycle), sim.dt), by_cycle


def how_far(sim, outlook: Outlook) -> str:
    """'12.300 us of 200.000 us (6.2 %)', or '12.300 us of about 61.000 us (20.2 %; speed below 5 m/s)'."""
    said = moment(sim.time)
    if outlook.share is None:
        return said
    if outlook.end is None:
        return f"{said} ({100 * outlook.share:.1f} % of the cycles)"
    if outlook.end.reason == ending.END_TIME:
        return f"{said} of {moment(outlook.end.time)} ({100 * outlook.share:.1f} %)"
    reason = outlook.end.reason.removesuffix(f" {ending.AS_IT_SLOWS}")  # "about" says it
    return f"{said} of about {moment(outlook.end.time)} ({100 * outlook.share:.1f} %; {reason})"


def values(run, outlook: Outlook) -> dict[str, str]:
    """The displayed values of a run, by name."""
    sim = run.sim
    measured, conserved = sim.diagnostics(), sim.conservation()
    shown = {
        "time": how_far(sim, outlook),
        "left": "-" if outlook.left is None else duration(outlook.left),
        "cycle": str(sim.cycle),
        "dt": f"{sim.dt * 1e9:.4g} ns ({sim.dt_cause})",
    }
    if measured:  # a deck with a projectile and a target
        shown |= {
            "depth": number(measured["penetration_depth_m"], 1e3, ".2f", "mm"),
            "tail speed": number(measured["rod_tail_velocity_m_s"], 1, ".1f", "m/s"),
            "mean speed": number(measured["rod_mean_velocity_m_s"], 1, ".1f", "m/s"),
            f"{sim.projectile} length": number(measured["rod_length_m"], 1e3, ".2f", "mm"),
            "regime": measured["regime"],
        }
    return shown | {
        "mass": f"{worst_mass(conserved):+.1e}",
        "momentum": f"{conserved['axial_momentum']:+.1e}",
        "energy": f"{conserved['total_energy']:+.1e}",
    }


class Report:
    """Writes the log and, unless quiet, plain lines."""

    def __init__(self, log, quiet: bool, gone: Callable[[], None] = lambda: None):
        self._log, self._quiet, self._gone = log, quiet, gone
        self._last, self._moved = 0.0, float("-inf")

    def line(self, text: str) -> None:
        """Writes a line to the log and the screen."""
        text = one_line(text)
        self.note(f"{datetime.now().isoformat(timespec='seconds')}  {text}")
        self._show_safely(text)

    def _show_safely(self, text: str) -> None:
        if not self._quiet:
            try:
                self.show(text)
            except BrokenPipeError:
                lose_output()
                self._quiet = True
                self._gone()

    def note(self, text: str) -> None:
        """Writes a line to the log only. Raises OSError, which names the file."""
        try:
            self._log.write(one_line(text) + "\n")
            self._log.flush()
        except OSError as error:
            error.filename = self._log.name
            raise

    def show(self, text: str) -> None:
        say(text, flush=True)

    def move(self, text: str, share: float | None) -> None:
        """Shows the state of slow work; where it cannot be redrawn, as a line now and then. It is not logged."""
        now = clock.monotonic()
        if now - self._moved >= LINE_SECONDS:
            self._moved = now
            self._show_safely(text)

    def rest(self, text: str) -> None:
        """Stops showing the state."""

    def begin(self, run) -> None:
        grid, origin = run.sim.grid, run.provenance
        commit = ""
        if origin["git_commit"]:
            commit = f" ({origin['git_commit'][:10]}{', modified' if origin['git_dirty'] else ''})"
        self.line(f"hydro2d {origin['version']}{commit}: {run.deck.title or run.deck.name}")
        self.line(f"{origin['command']}")
        self.line(f"{origin['cpu']}, {several(origin['threads'], 'thread')}; results in {run.directory}")
        self.line(
            f"{grid.nr} x {grid.nz} cells ({grid.geometry}; r is x and the axis is r = 0, z is y), "
            f"interface order: {', '.join(run.sim.table.names)}"
        )
        if run.sim.cycle:
            self.line(f"continuing at cycle {run.sim.cycle}, t = {moment(run.sim.time)}")
        for text in run.warnings:
            self.line(f"warning: {text}")

    def update(self, run) -> None:
        """Called after every cycle; prints a line when one is due."""
        now = clock.perf_counter()
        if now - self._last >= LINE_SECONDS:
            self._last = now
            self.status(values(run, run.clock.look(run.sim)))

    def status(self, shown: dict[str, str]) -> None:
        flight = f"depth {shown['depth']}, tail {shown['tail speed']}, " if "depth" in shown else ""
        self.line(
            f"t {shown['time']}, {shown['left']} left, cycle {shown['cycle']}, dt {shown['dt']}, {flight}"
            f"changes of mass {shown['mass']}, momentum {shown['momentum']}, energy {shown['energy']}"
        )

    def end(self, run, summary: Summary) -> None:
        for text in result(summary, run.theory(summary)):
            self.line(text)

    def close(self) -> None:
        pass


class Live(Report):
    """The report on a terminal: a bar and a table that are redrawn in place."""

    def __init__(self, log, quiet: bool, gone: Callable[[], None] = lambda: None):
        from rich.live import Live as RichLive

        super().__init__(log, quiet, gone)
        self._live = RichLive(refresh_per_second=4, transient=True)
        self._drawn, self._table = 0.0, None

    def begin(self, run) -> None:
        super().begin(run)
        self._live.start()

    def move(self, text: str, share: float | None) -> None:
        self._live.start()
        self._live.update(self._with_line(one_line(text)))

    def rest(self, text: str) -> None:
        self._live.update(self._with_line(""))

    def _with_line(self, text: str):
        """The table, if there is one yet, with a line below it."""
        from rich.console import Group
        from rich.text import Text

        line = [Text(text, overflow="ellipsis", no_wrap=True)] if text else []
        return Group(*([self._table] if self._table else []), *line)

    def show(self, text: str) -> None:
        whole = bool(WHOLE.search(text))
        self._live.console.print(text, highlight=False, markup=False, soft_wrap=whole)

    def status(self, shown: dict[str, str]) -> None:
        show, self.show = self.show, lambda text: None  # the table shows it: only the log gets the line
        super().status(shown)
        self.show = show

    def update(self, run) -> None:
        super().update(run)
        now = clock.perf_counter()
        if now - self._drawn >= TABLE_SECONDS:
            self._drawn, self._table = now, self._picture(run)
            self._live.update(self._table)

    def _picture(self, run):
        from rich.console import Group
        from rich.padding import Padding
        from rich.progress_bar import ProgressBar
        from rich.table import Table
        from rich.text import Text

        table, outlook = Table.grid(padding=(0, 2)), run.clock.look(run.sim)
        for name, value in values(run, outlook).items():
            table.add_row(Text(one_line(name), no_wrap=True), Text(one_line(value), overflow="fold"))
        bar = ProgressBar(total=1.0, completed=outlook.share or 0.0, width=60, pulse=outlook.share is None)
        return Group(Padding(bar, 0, expand=False), table)  # a bar alone does not end its line

    def close(self) -> None:
        self._live.stop()

    def end(self, run, summary: Summary) -> None:
        self._live.stop()
        super().end(run, summary)


def result(summary: Summary, theory: Sequence[str] = ()) -> list[str]:
    """The closing lines: the result, compared with the experiment.

    theory : lines below the depth
    """
    conserved = summary.conservation
    lines = [
        _how_it_ended(summary),
        *(f"NOT TRUSTWORTHY: {fault}" for fault in summary.faults if fault not in summary.stop_reason),
        *(f"note: {note}" for note in summary.notes),
        _costs(summary),
    ]
    if summary.penetration_depth_m is not None:
        lines += _rod(summary, theory)
    else:
        lines += _bars(summary)
    lines += _derived(summary)
    lines += _peaks(summary)
    if moving := _moving(summary):
        lines.append(f"residual motion       {moving}")
    return [
        *lines,
        f"relative changes      mass {worst_mass(conserved):+.1e}, momentum {conserved.axial_momentum:+.1e}, "
        f"energy {conserved.total_energy:+.1e}",
    ]


def _how_it_ended(summary: Summary) -> str:
    """'done: end time', or 'interrupted at 26.800 us (SIGINT); continue with: hydro2d run shot.toml --restart'."""
    why = re.fullmatch(r"interrupted \((.*)\)", summary.stop_reason)
    if summary.status != "interrupted" or why is None:
        return f"{summary.status}: {outcome.ended_by(summary)}"
    return (f"interrupted at {moment(summary.time_s)} ({why[1]}); "
            f"continue with: {continuing(summary.provenance.command)}")


def continuing(command: str) -> str:
    """The way to continue a run that a command began: the command with --restart, or the argument of `hydro2d.run`."""
    words = [word for word in shlex.split(command) if word not in ("--overwrite", "--restart")]
    start = 3 if words[:2] == ["python", "-m"] else 1
    if words[start - 1 : start + 1] != ["hydro2d", "run"]:
        return "hydro2d.run(..., restart=True)"
    return in_shell(*words, "--restart")


def _costs(summary: Summary) -> str:
    """'450 cycles to 26.800 us in 3.1 s (31.2 ns per cell and cycle, cycles alone); compilation 1 min 17 s, outputs 0.4 s'."""
    pace = summary.ns_per_cell_cycle
    others = [f"{name} {duration(summary[key], tenths=True)}" for name, key in OTHER_COSTS.items()
              if summary[key] >= LEAST_COST]
    return (f"{summary.cycles} cycles to {moment(summary.time_s)} in {duration(summary.cycles_s, tenths=True)}"
            + (f" ({pace:.1f} ns per cell and cycle, cycles alone)" if pace else "")
            + (f"; {', '.join(others)}" if others else ""))


def _bars(summary: Summary) -> list[str]:
    """Changed lengths of the bodies that were longer than wide at the start, with the radii of their ends.

    No length is reported once part of a body has left the mesh.
    """
    lines = []
    for name, body in summary.bodies.items():
        first, length, radius = body.initial_length_m, body.length_m, body.r_max_m
        if first is None or length is None or radius is None or first < radius or abs(length - first) <= SAME_LENGTH * first:
            continue
        if body.outflow_kg > 0.0:
            continue
        ends = [body[f"radius_at_z_{end}_m"] for end in ("min", "max")]
        lines.append(f"{f'{name} length':<21} {length * 1e3:.2f} mm of {first * 1e3:.2f} mm, {length / first:.3f}; "
                     f"radius {max(ends) * 1e3:.2f} mm at the wider end, {min(ends) * 1e3:.2f} mm at the other")
    return lines


def _derived(summary: Summary) -> list[str]:
    """Values of the quantities that [derived] of the deck defines."""
    return [f"{name:<21} {'-' if value is None else f'{value:.5g}'}" + (f" {unit(name)}" if unit(name) != "1" else "")
            for name, value in summary.derived.items()]


def _peaks(summary: Summary) -> list[str]:
    """The largest pressure and speed at tracers and gauges."""
    stations = {name: station for name, station in summary.stations.items() if station.peak_pressure_Pa is not None}
    lines = [f"{name.replace('_', ' ', 1):<21} peak pressure {stations[name].peak_pressure_Pa / 1e9:.3g} GPa at "
             f"{moment(stations[name].peak_pressure_time_s)}, peak speed {stations[name].peak_speed_m_s:.0f} m/s"
             for name in list(stations)[:MOST_STATIONS]]
    more = len(stations) - len(lines)
    return lines + ([f"{more} more tracers and gauges are in summary.json"] if more else [])


def _moving(summary: Summary) -> str:
    """Mean velocity and kinetic energy of the bodies that still move, the largest energy first; and the tail of the projectile,
    which may be faster than its mean."""
    energies = {name: body.kinetic_energy_J for name, body in summary.bodies.items()}
    least = SHOWN * max(energies.values(), default=0.0)
    names = [name for name in sorted(energies, key=lambda name: -energies[name]) if energies[name] > least][:MOST_SHOWN]
    said = [f"{name} {summary.bodies[name].velocity_m_s:z.1f} m/s, {energies[name]:.3g} J" for name in names]
    projectile = summary.projectile
    if projectile and projectile.tail_velocity_m_s is not None:
        said.append(f"tail of the {projectile.body} {projectile.tail_velocity_m_s:z.1f} m/s")
    return "; ".join(said)


def _over_length(summary: Summary) -> str:
    """Depth over the length of the projectile, or over its diameter if it is as long as thick, such as a ball."""
    shape, ratio = summary.projectile, summary.penetration_over_length
    if ratio is None:
        return ""
    thick = 2.0 * shape.initial_radius_m
    return f", P/{'D' if abs(thick - shape.initial_length_m) < AS_LONG * thick else 'L'} {ratio:.3f}"


def _unsettled(shape: Any) -> str:
    """The change of the residual velocity if it is still changing."""
    change, over = shape.residual_velocity_change_m_s, shape.residual_velocity_change_over_s
    if change is None or not abs(change) > SETTLED * abs(shape.residual_velocity_m_s):
        return ""
    return f"; still changing, by {change:+.1f} m/s in the last {over * 1e6:.1f} us"


def _of_targets(targets: dict[str, Target]) -> Iterator[str]:
    """The ejecta of the first target, where they say how much momentum it has, and the damage of the last one."""
    for back in [target.ejecta for target in targets.values()][:1]:
        if back.momentum_multiplication is not None and back.mass_kg > 0.0:
            yield (f"ejecta                {number(back.mass_kg, 1e3, '.3g', 'g')}, {back.momentum_N_s:.3g} N s; "
                   f"momentum multiplication {back.momentum_multiplication:.3f}")
    for name, target in list(targets.items())[-1:]:
        if target.damage_class not in (None, NO_DAMAGE):
            hole = target.crater.hole_diameter_m
            width = "" if hole is None else f", hole of {number(hole, 1e3, '.2f', 'mm')} at its narrowest"
            yield f"{f'damage of {name}':<21} {target.damage_class}{width}"


def _error(of: Outcome) -> str:
    """The error of a depth, with the word for one that is a bound; empty without one."""
    if of.depth_error_m is None:
        return ""
    bound = "" if of.depth_error_is == EXACT else f"{of.depth_error_is} "
    return f" (error {bound}{of.depth_error_m * 1e2:+.2f} cm, {of.depth_error_percent:+.1f} %)"


def _rod(summary: Summary, theory: Sequence[str]) -> list[str]:
    from hydro2d.measure.regime import LEFT

    experiment, shape, came_to = summary.experiment, summary.projectile, summary.outcome
    body = shape.body
    bound = "at least " if summary.regime == LEFT else ""
    largest, at_end = (number(summary[name], 1e2, ".2f", "cm") for name in ("penetration_depth_m", "nose_depth_m"))
    if came_to.perforated:
        lines = [f"perforated            {outcome.beyond(summary.targets, at_end)}"]
    else:
        back = "" if at_end == largest else f"; {at_end} at the end"
        depth = "depth so far" if outcome.so_far(summary) else "penetration depth"
        lines = [f"{depth:<21} {bound}{largest}{_over_length(summary)}{back}"]
    if experiment and experiment.penetration_m:
        measured = experiment.penetration_m
        qualifier = "" if experiment.qualifier == "measured" else f"{experiment.qualifier} "
        lines.append(f"  experiment          {qualifier}{measured * 1e2:.2f} cm{_error(came_to)}  {experiment.source}")
    lines += theory
    if shape.residual_mass_kg is not None:
        velocity, mass = shape.residual_velocity_m_s, shape.residual_mass_kg
        lines.append(f"{f'residual {body}':<21} {number(velocity, 1, '.1f', 'm/s')}, {number(mass, 1e3, '.2f', 'g')}"
                     + _unsettled(shape))
    if experiment and experiment.residual_velocity_m_s is not None:
        measured = experiment.residual_velocity_m_s
        lines.append(f"  experiment          residual velocity {measured:.1f} m/s  {experiment.source}")
    for name, plate in summary.targets.items() if len(summary.targets) > 1 else ():
        if plate.exit_time_s is not None:
            velocity, mass = number(plate.exit_velocity_m_s, 1, ".1f", "m/s"), number(plate.exit_mass_kg, 1e3, ".2f", "g")
            lines.append(f"  through {name} at {moment(plate.exit_time_s)}: {velocity}, {mass}")
    return [
        *lines,
        *_of_targets(summary.targets),
        f"{f'{body} length':<21} {number(shape.length_m, 1e2, '.2f', 'cm')}",
        f"largest plastic strain of the {body} {shape.max_plastic_strain:.3g}",
        f"regime                {summary.regime}" + f" (shape of the {body}, which went through)" * bool(came_to.perforated),
    ]
