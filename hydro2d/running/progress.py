"""Progress reports of a run: a bar and a table on a terminal, a line every few seconds elsewhere, and always log.txt.

The report in a notebook is in `notebook.py`; `reporting.py` chooses among them.
"""

from __future__ import annotations

import sys
import time as clock
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from datetime import datetime
from typing import TypeVar

from hydro2d.interrupt import lose_output
from hydro2d.terminal import one_line, say

T = TypeVar("T")

#: seconds between lines, and between refreshes of the table
LINE_SECONDS, TABLE_SECONDS = 5.0, 0.5
#: bodies with more than this share of the largest kinetic energy are told to move at the end, and this many of them
SHOWN, MOST_SHOWN = 1e-3, 6
#: seconds over which the pace is measured
PACE_SECONDS = 60.0


def duration(seconds: float) -> str:
    """'1 h 02 min', '3 min 20 s', '12 s'."""
    seconds = round(seconds)
    if seconds >= 3600:
        return f"{seconds // 3600} h {seconds % 3600 // 60:02d} min"
    if seconds >= 60:
        return f"{seconds // 60} min {seconds % 60:02d} s"
    return f"{seconds} s"


def moment(seconds: float) -> str:
    """A time of the simulation in microseconds, or in a larger unit for longer times."""
    for unit, scale in (("s", 1.0), ("ms", 1e3)):
        if seconds * scale >= 10:
            return f"{seconds * scale:.3f} {unit}"
    return f"{seconds * 1e6:.3f} us"


def number(value, scale: float, form: str, unit: str) -> str:
    """A quantity in the reader's unit; "-" if there is no value."""
    if value is None or value != value:
        return "-"
    return f"{value * scale:{form}} {unit}"


def worst_mass(conservation: dict) -> float:
    """The largest relative change of mass of a body, with its sign."""
    return max(conservation["mass"].values(), key=abs, default=0.0)


def counted(items: Sequence[T], what: str, quiet: bool = False) -> Iterator[T]:
    """The items; if they take long, a line on stderr every few seconds says how many are done.

    Such as "decks read: 512 of 3000"; nothing if ``quiet``.
    """
    last = clock.monotonic()
    for number, item in enumerate(items):
        if not quiet and clock.monotonic() - last >= LINE_SECONDS:
            last = clock.monotonic()
            say(f"{what}: {number} of {len(items)}", file=sys.stderr, flush=True)
        yield item


class Clock:
    """How much of a run is done, by the end time and the number of cycles in the deck, and how long the rest will take.

    The pace is that of the last minute, so compilation and the small time steps after an impact affect it no longer than that.

    Parameters
    ----------
    stop : the deck's section
    clock : gives seconds
    """

    def __init__(self, stop, clock: Callable[[], float] = clock.perf_counter):
        self._stop, self._clock = stop, clock
        self._marks: deque[tuple[float, float | None]] = deque()

    def begin(self, sim) -> None:
        """To be called after the first cycle, in which the kernels are compiled or loaded."""
        self._marks.append((self._clock(), self.done(sim)))

    def done(self, sim) -> float | None:
        """Fraction of the run that is done, 0 to 1; None if the deck has neither an end time nor a number of cycles."""
        shares = [sim.time / self._stop.time] if self._stop.time else []
        shares += [sim.cycle / self._stop.cycles] if self._stop.cycles else []
        return min(max(shares), 1.0) if shares else None

    def left(self, sim) -> float | None:
        """Seconds to the end at the pace of the last minute; None if it is not known."""
        done, now = self.done(sim), self._clock()
        if done is None or not self._marks:
            return None
        if now - self._marks[-1][0] >= PACE_SECONDS / 60:
            self._marks.append((now, done))
        while len(self._marks) > 2 and now - self._marks[1][0] >= PACE_SECONDS:
            self._marks.popleft()
        then, before = self._marks[0]
        return (now - then) * (1 - done) / (done - before) if done > before else None

    def words(self, sim) -> str:
        """'12.300 us of 200.000 us (6.2 %)'."""
        end = f" of {moment(self._stop.time)}" if self._stop.time else ""
        done = self.done(sim)
        return f"{moment(sim.time)}{end}" + ("" if done is None else f" ({100 * done:.1f} %)")


def values(run, left: Clock) -> dict[str, str]:
    """The values shown for a run, by name."""
    sim = run.sim
    found, conserved = sim.diagnostics(), sim.conservation()
    seconds = left.left(sim)
    shown = {
        "time": left.words(sim),
        "left": "-" if seconds is None else duration(seconds),
        "cycle": str(sim.cycle),
        "dt": f"{sim.dt * 1e9:.4g} ns ({sim.dt_cause})",
    }
    if found:  # a deck with a rod and a target
        shown |= {
            "depth": number(found["penetration_depth_m"], 1e3, ".2f", "mm"),
            "tail speed": number(found["rod_tail_velocity_m_s"], 1, ".1f", "m/s"),
            "mean speed": number(found["rod_mean_velocity_m_s"], 1, ".1f", "m/s"),
            "rod length": number(found["rod_length_m"], 1e3, ".2f", "mm"),
            "regime": found["regime"],
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
        self._last = 0.0

    def line(self, text: str) -> None:
        """A line for the log and the screen."""
        text = one_line(text)
        self._log.write(f"{datetime.now().isoformat(timespec='seconds')}  {text}\n")
        self._log.flush()
        if not self._quiet:
            try:
                self.show(text)
            except BrokenPipeError:
                lose_output()
                self._quiet = True
                self._gone()

    def show(self, text: str) -> None:
        say(text, flush=True)

    def begin(self, run) -> None:
        grid, origin = run.sim.grid, run.provenance
        commit = ""
        if origin["git_commit"]:
            commit = f" ({origin['git_commit'][:10]}{', modified' if origin['git_dirty'] else ''})"
        self.line(f"hydro2d {origin['version']}{commit}: {run.deck.title or run.deck.name}")
        self.line(f"{origin['command']}")
        self.line(f"{origin['cpu']}, {origin['threads']} threads; results in {run.directory}")
        self.line(
            f"{grid.nr} x {grid.nz} cells ({grid.geometry}; r is x and the axis is r = 0, z is y), "
            f"bodies in the order of their interfaces: {', '.join(run.sim.table.names)}"
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
            self.status(values(run, run.clock))

    def status(self, shown: dict[str, str]) -> None:
        rod = f"depth {shown['depth']}, tail {shown['tail speed']}, " if "depth" in shown else ""
        self.line(
            f"t {shown['time']}, {shown['left']} left, cycle {shown['cycle']}, dt {shown['dt']}, {rod}"
            f"changes of mass {shown['mass']}, momentum {shown['momentum']}, energy {shown['energy']}"
        )

    def end(self, run, summary: dict) -> None:
        for text in result(summary):
            self.line(text)

    def close(self) -> None:
        pass


class Live(Report):
    """The same on a terminal: a bar and a table that are redrawn in place."""

    def __init__(self, log, quiet: bool, gone: Callable[[], None] = lambda: None):
        from rich.live import Live as RichLive

        super().__init__(log, quiet, gone)
        self._live = RichLive(refresh_per_second=4, transient=True)
        self._drawn = 0.0

    def begin(self, run) -> None:
        super().begin(run)
        self._live.start()

    def show(self, text: str) -> None:
        self._live.console.print(text, highlight=False, markup=False)

    def status(self, shown: dict[str, str]) -> None:
        show, self.show = self.show, lambda text: None  # the table shows it: only the log gets the line
        super().status(shown)
        self.show = show

    def update(self, run) -> None:
        super().update(run)
        now = clock.perf_counter()
        if now - self._drawn >= TABLE_SECONDS:
            self._drawn = now
            self._live.update(self._picture(run))

    def _picture(self, run):
        from rich.console import Group
        from rich.progress_bar import ProgressBar
        from rich.table import Table
        from rich.text import Text

        table = Table.grid(padding=(0, 2))
        for name, value in values(run, run.clock).items():
            table.add_row(name, Text(one_line(value)))
        done = run.clock.done(run.sim)
        return Group(ProgressBar(total=1.0, completed=done or 0.0, width=60, pulse=done is None), table)

    def close(self) -> None:
        self._live.stop()

    def end(self, run, summary: dict) -> None:
        self._live.stop()
        super().end(run, summary)


def result(summary: dict) -> list[str]:
    """The final lines: the result beside that of the experiment."""
    conserved = summary["conservation"]
    lines = [
        f"{summary['status']}: {summary['stop_reason']}",
        *(f"NOT TRUSTWORTHY: {fault}" for fault in summary["faults"] if fault not in summary["stop_reason"]),
        f"{summary['cycles']} cycles to {moment(summary['time_s'])} in {duration(summary['wall_s'])}"
        + (f", {summary['ns_per_cell_cycle']:.1f} ns per cell and cycle" if summary["ns_per_cell_cycle"] else ""),
    ]
    if summary["penetration_depth_m"] is not None:
        lines += _rod(summary)
    if moving := _moving(summary):
        lines.append(f"moving at the end     {moving}")
    return [
        *lines,
        f"relative changes      mass {worst_mass(conserved):+.1e}, momentum {conserved['axial_momentum']:+.1e}, "
        f"energy {conserved['total_energy']:+.1e}",
    ]


def _moving(summary: dict) -> str:
    """Which bodies still move, the one with the most kinetic energy first, with mean velocity and that energy; and the tail of
    a rod, which may outrun its mean."""
    energies = {name: body["kinetic_energy_J"] for name, body in summary["bodies"].items()}
    least = SHOWN * max(energies.values(), default=0.0)
    names = [name for name in sorted(energies, key=lambda name: -energies[name]) if energies[name] > least][:MOST_SHOWN]
    said = [f"{name} {summary['bodies'][name]['velocity_m_s']:.1f} m/s, {energies[name]:.3g} J" for name in names]
    projectile = summary["projectile"]
    if projectile and projectile["tail_velocity_m_s"] is not None:
        said.append(f"tail of the {projectile['body']} {projectile['tail_velocity_m_s']:.1f} m/s")
    return "; ".join(said)


def _rod(summary: dict) -> list[str]:
    from hydro2d.solver.penetrator import LEFT

    depth, experiment, shape = summary["penetration_depth_m"], summary["experiment"], summary["projectile"]
    body = shape["body"]
    bound = "at least " if summary["regime"] == LEFT else ""
    lines = [f"penetration depth     {bound}{number(depth, 1e2, '.2f', 'cm')}"]
    if experiment and experiment["penetration_m"]:
        measured = experiment["penetration_m"]
        error = f" (error {(depth - measured) * 1e2:+.2f} cm, {100 * (depth / measured - 1):+.1f} %)"
        qualifier = "" if experiment["qualifier"] == "measured" else f"{experiment['qualifier']} "
        lines.append(f"  experiment          {qualifier}{measured * 1e2:.2f} cm{error}  {experiment['source']}")
    if shape.get("residual_mass_kg") is not None:
        velocity, mass = (shape[f"residual_{name}"] for name in ("velocity_m_s", "mass_kg"))
        lines.append(f"{f'residual {body}':<21} {number(velocity, 1, '.1f', 'm/s')}, {number(mass, 1e3, '.2f', 'g')}")
    if experiment and experiment["residual_velocity_m_s"] is not None:
        measured = experiment["residual_velocity_m_s"]
        lines.append(f"  experiment          residual velocity {measured:.1f} m/s  {experiment['source']}")
    for name, found in summary["targets"].items() if len(summary["targets"]) > 1 else ():
        if found["exit_time_s"] is not None:
            velocity, mass = number(found["exit_velocity_m_s"], 1, ".1f", "m/s"), number(found["exit_mass_kg"], 1e3, ".2f", "g")
            lines.append(f"  through {name} at {moment(found['exit_time_s'])}: {velocity}, {mass}")
    return [
        *lines,
        f"{f'{body} length':<21} {number(shape['length_m'], 1e2, '.2f', 'cm')}",
        f"largest plastic strain of the {body} {shape['max_plastic_strain']:.3g}",
        f"regime                {summary['regime']}",
    ]
