"""A summary of a deck before it runs: mesh, masses, cells across rods and balls, memory, time; and its picture."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hydro2d.base.errors import DeckError
from hydro2d.base.formats import one_line
from hydro2d.base.terminal import duration, several
from hydro2d.deck import deck as decks
from hydro2d.deck import grading
from hydro2d.materials import library, quantities
from hydro2d.mesh.edges.base import EDGES
from hydro2d.mesh.edges.registry import halved, made
from hydro2d.mesh.grid import Grid
from hydro2d.output.vtk import Dump
from hydro2d.physics.waves import STABLE
from hydro2d.solver import insertion, memory_needed, sources

#: motion of a body at rest
AT_REST = (0.0, 0.0), None
#: largest number of names of bodies in a line
LISTED = 5
#: nanoseconds per cell and cycle on one thread, as a first estimate; `hydro2d bench` measures the machine
NANOSECONDS = 250.0
#: that with two velocities in contact, where cells of the surface take half of the time
IN_CONTACT = 450.0
#: seconds to start the program and to load compiled kernels
START = 2.5
#: number of cells at which threads share half of the work of a cycle (explanation/speed, Measured)
HALF_SHARED = 150e3
#: a body cut off by the mesh by less than this fraction counts as whole
ROUNDING = 1e-9
#: a deck that needs more cycles is treated as a mistake
MOST_CYCLES = 1e10


@dataclass(frozen=True)
class Check:
    """A deck on its mesh.

    dump : the part of the initial state that pictures need;  masses : kg by body, full circle;  memory : bytes;
    cycles, seconds : estimates; the seconds are those of the cycles on one thread
    """

    deck: object
    grid: Grid
    table: object
    dump: Dump
    masses: dict[str, float]
    memory: int
    cycles: int
    seconds: float
    warnings: list[str]

    def lines(self, threads: int) -> list[str]:
        """The lines of the report."""
        grid, deck = self.grid, self.deck
        lines = [f"{deck.name}: {one_line(deck.title)}" if deck.title else deck.name, ""]
        lines += [f"mesh      {grid.nr} x {grid.nz} = {grid.cells} cells, {grid.geometry}; "
                  + ("the axis is r = 0" if grid.cylindrical and grid.r_edges[0] == 0 else "no axis")]
        lines += [f"          {_axis(name, edges)}" for name, edges in (("r", grid.r_edges), ("z", grid.z_edges))]
        lines += [f"          boundaries: {', '.join(self._edge(key) for key in EDGES)}", ""]
        for m, body in enumerate(self.table.names):
            entry, material = decks.body(deck, body), self.table.materials[m]
            lines.append(f"body      {body}: {material.name}, {_mass(self.masses[body], grid)}, v = {_speed(entry)}")
            lines.append(f"          {self._across(entry)}")
            lines += [f"          {each.name} joins it: {self._across(each)}" for each in deck.body if each.join == body]
            lines.append(f"          eos {material.eos.title}, strength {material.strength.name}")
        lines += self._follow() if deck.mesh.follow else self._crosses()
        lines += ["", f"sliding   {_sliding(deck)}", *(f"          {text}" for text in self._tied())]
        lines += [f"stop      {_stop(deck.stop)}"]
        time = f"{duration(self.wall(threads))} on {several(threads, 'thread')} (a guess)"
        lines += [f"cost      about {several(self.cycles, 'cycle')}, {time}, "
                  f"{self.memory / 2**20:.0f} MiB of memory, at most {self.disk / 2**20:.0f} MiB on disk with "
                  f"{several(self.dumps, 'dump')}"]
        return lines + [f"warning   {text}" for text in self.warnings]

    @property
    def dumps(self) -> int:
        """Largest number of dumps."""
        stop, interval = self.deck.stop.time, self.deck.output.vtk_interval
        return math.ceil(stop / interval) + 1 if stop and interval else 2

    @property
    def disk(self) -> int:
        """Largest size of dumps and restart files, before compression, bytes."""
        keys = [quantities.BY_KEY[key] for key in quantities.expand(self.deck.output.fields)]
        contact = self.deck.sliding.method == "contact"
        values = sum((len(self.table) if each.per_body else 1) * (3 if each.unit == "m/s" else 1) for each in keys
                     if not each.internal and (contact or not each.contact) and (self.table.records or not each.recorded))
        return 4 * values * self.dumps * self.grid.cells + 2 * self.memory

    def wall(self, threads: int) -> float:
        """Estimated seconds of a run alone on the machine. Threads share the cells but not kernel calls (Amdahl's law)."""
        shared = self.grid.cells / (self.grid.cells + HALF_SHARED)
        return START + self.seconds * (1.0 - shared + shared / threads)

    def _edge(self, key: str) -> str:
        """The boundary condition at an edge, with its velocity or pressure, or the range of it, if it has its own."""
        kind = getattr(self.deck.boundaries, key)
        edge = made(key, self.deck.boundaries.model_dump())
        values, unit = (edge.pressures(), "Pa") if edge.presses() else (edge.speeds() if edge.keys else (), "m/s")
        shown = " to ".join(f"{value:g}" for value in sorted({min(values), max(values)})) if values else ""
        along = f", {edge.slide():g} m/s along it" if edge.slide() else ""
        return f"{key} {kind}" + (f" {shown} {unit}" if shown else "") + along

    def _tied(self) -> list[str]:
        """Lines on contacts that resist tension: walls, and bodies of one velocity field that start differently."""
        deck, names = self.deck, self.table.names
        hard = deck.sliding.hard if deck.sliding.method == "contact" else ()
        cure = "" if hard else '; sliding.method = "contact" lets them part'
        limits = np.minimum(self.table.fracture_pressure, self.table.fracture_stress)
        motions = [_motion(decks.body(deck, name)) for name in names]
        lines = []
        for number, name in enumerate(names):
            others = [m for m, other in enumerate(names) if (name in hard) == (other in hard) and motions[m] != motions[number]
                      and (m > number or motions[m] == AT_REST)]
            if others and motions[number] != AT_REST:
                bears = float(min(limits[m] for m in (number, *others)))
                until = f"until one of them fractures, at {bears * 1e-9:.3g} GPa of tension" if bears < math.inf else "always"
                lines.append(f"{name} is tied to {_listed([names[m] for m in others])} where they touch, {until}{cure}")
        walls = [key for key in EDGES if getattr(deck.boundaries, key) == "wall" and key != "r_min"]
        wall_line = (f'a wall ({", ".join(walls)}) also resists tension: it holds a body that touches it; an "anvil" only '
                     'pushes. It is smooth: the body slides along it; a "held" edge clamps it')
        return lines + [wall_line] * bool(walls)

    def _follow(self) -> list[str]:
        """Lines on the reach of a travelling mesh and on the bodies that will enter it."""
        deck, z = self.deck, self.grid.z_edges
        entry, direction = decks.body(deck, deck.mesh.follow), decks.travel(deck)
        ahead, behind = decks.room(deck, z)
        radius = decks.extent(entry, deck, "r")[1]
        radii = f" ({ahead / radius:.3g} radii)" if np.isfinite(radius) else ""
        lines = ["", f"follow    {entry.name}: the mesh reaches {ahead * 1e3:.4g} mm{radii} ahead of it and "
                     f"{behind * 1e3:.4g} mm behind"]
        lines += [f"          {text}" for text in grading.lines(deck)]
        edge = z[-1] if direction > 0 else z[0]
        for other in deck.body:
            ends = sorted(direction * (end - edge) for end in decks.extent(other, deck, "z"))
            if ends[1] > 0:
                first = max(ends[0], 0.0)
                begin = first / abs(entry.velocity[1])
                lines.append(f"          {other.name} enters the mesh from {begin * 1e6:.4g} us on, over "
                             f"{(ends[1] - first) * 1e3:.4g} mm of its travel")
        return lines

    def _crosses(self) -> list[str]:
        """Lines on the flight of the projectile through a fixed mesh, and whether the mesh could follow it instead."""
        deck = self.deck
        if deck.penetration is None:
            return []
        entry = decks.body(deck, deck.penetration.rod)
        radius, speed = decks.extent(entry, deck, "r")[1], entry.velocity[1]
        way = speed * (deck.stop.time if deck.stop.time is not None else math.inf)
        if speed == 0.0 or not 2.0 * radius < abs(way):
            return []
        low, high = decks.extent(entry, deck, "z")
        tip = high if speed > 0.0 else low
        cells = decks.cells_between(self.grid.z_edges, *sorted((tip, tip + way)))
        crossed = f"up to {cells:.0f} cells of the fixed mesh"
        bars = decks.bars_to_follow(deck, entry.name)
        advice = (f"the mesh cannot follow it: {bars[0]}" if bars else
                  f'if it stays whole, its results scatter less with mesh.follow = "{entry.name}"')
        return ["", f"crosses   {entry.name}: {crossed};", f"          {advice}"]

    def _across(self, entry) -> str:
        """Number of cells across a body: its radius and its length, or its thickness."""
        parts = []
        for axis, edges in (("r", self.grid.r_edges), ("z", self.grid.z_edges)):
            low, high = decks.extent(entry, self.deck, axis)
            what = entry.extent_word
            if axis == "r":
                what = "radius" if low <= 0.0 and self.grid.cylindrical else "width"
            low = max(low, 0.0) if axis == "r" and self.grid.cylindrical else low
            inside = min(high, edges[-1]) - max(low, edges[0])
            if what == "radius" and entry.is_target and inside < high - low:
                continue  # it extends beyond the edge of the mesh
            cut = f", of which {inside * 1e3:.4g} mm lie in the mesh" if inside < (1.0 - ROUNDING) * (high - low) else ""
            size = f" of {(high - low) * 1e3:.4g} mm" if math.isfinite(high - low) else ""
            cells = f"{decks.cells_between(edges, low, high):.3g}"
            parts.append(f"{several(cells, 'cell')} across the {what}{size}{cut}")
        return ", ".join(parts)


def check(deck) -> Check:
    """Puts a deck on its mesh. Raises DeckError for mistakes that show only then, and for a mesh too large for the memory."""
    memory_needed.refuse_too_large(deck)
    grid = Grid(*decks.edges(deck), deck.mesh.geometry)
    table = library.resolve(deck)
    start = insertion.initial_state(deck, grid, table)
    full = 2 * math.pi if grid.cylindrical else 1.0
    mass = full * np.sum(start["vof"] * start["rho"] * grid.interior(grid.volume), axis=(1, 2))
    empty = [f'body "{body}" fills no part of the mesh' for body, m in zip(table.names, mass, strict=True)
             if m == 0 and deck.mesh.follow is None]
    dark = _sources(deck, grid, table, start)
    cycles = _cycles(deck, grid, table, start)
    pace = IN_CONTACT if deck.sliding.method == "contact" else NANOSECONDS
    return Check(
        deck=deck, grid=grid, table=table, dump=_dump(grid, table, start, deck.boundaries.r_min),
        masses=dict(zip(table.names, mass.tolist(), strict=True)),
        memory=memory_needed.needed(deck), cycles=cycles,
        seconds=cycles * grid.cells * pace * 1e-9, warnings=empty + decks.warnings(deck) + dark,
    )


def _sources(deck, grid, table, start) -> list[str]:
    """Warnings of the sources on the mesh. Raises DeckError for one that does not fit its body there."""
    slots = [table.names.index(entry.body) for entry in deck.source]
    variables = {m: np.stack([np.full((grid.nz, grid.nr), value) for value in table.initial[m]])
                 for m in set(slots) if len(table.initial[m])}
    return sources.begin(deck.source, slots, grid, table, start["vof"], start["rho"], variables)


def _dump(grid, table, start, r_min: str) -> Dump:
    vof = start["vof"]
    shares = np.concatenate([1 - vof.sum(axis=0, keepdims=True), vof])
    fields = {quantities.BY_KEY["volume_fraction"].name(body): vof[m] for m, body in enumerate(table.names)}
    fields |= {
        "Material": np.argmax(shares, axis=0),
        "Density [kg/m3]": np.sum(vof * start["rho"], axis=0),
        "Velocity [m/s]": np.stack([start["u_cell"][0], start["v_cell"][0], np.zeros(vof.shape[1:])], axis=-1),
    }
    return Dump(grid.r_edges, grid.z_edges, fields, 0.0, halved(grid.geometry, grid.r_edges[0], r_min))


def _cycles(deck, grid, table, start) -> int:
    """Number of cycles to the end, at the time step that the fastest elastic wave allows in the smallest cell."""
    fastest = 0.0
    for m in range(len(table)):
        rho, e = (float(start[name][m].flat[np.argmax(start["vof"][m])]) for name in ("rho", "e"))
        fastest = max(fastest, math.sqrt(table.sound_speed_squared(m, rho, e) + 4 * table.shear[m] / (3 * rho)))
    smallest = min(np.diff(grid.r_edges).min(), np.diff(grid.z_edges).min())
    mesh_speed = decks.body(deck, deck.mesh.follow).velocity[1] if deck.mesh.follow else 0.0
    speed = float(np.max(np.hypot(start["u_cell"], start["v_cell"] - mesh_speed)))
    numerics = deck.numerics
    half = 0.5 * numerics.viscosity_linear
    courant = min(numerics.courant, STABLE / (half + math.sqrt(1.0 + half * half)))  # `waves.sound_step` without a shock
    dt = smallest / max(fastest / courant, speed / numerics.advective_courant, 1e-30)
    if dt < numerics.dt_min:
        raise DeckError(f"the first time step would be {dt:.3g} s, below numerics.dt_min = {numerics.dt_min:g} s: "
                        f"the smallest cell is {smallest:.3g} m wide")
    by_time = deck.stop.time / dt if deck.stop.time else math.inf
    cycles = min(by_time, deck.stop.cycles or math.inf)
    if cycles > MOST_CYCLES:
        raise DeckError(f"the run would take {cycles:.3g} cycles at a time step of {dt:.3g} s, and never end")
    return math.ceil(cycles)


def _axis(name: str, edges: np.ndarray) -> str:
    sizes = np.diff(edges) * 1e3
    spread = f"{sizes.min():.4g}" if np.ptp(sizes) < 1e-9 * sizes.max() else f"{sizes.min():.4g} to {sizes.max():.4g}"
    return f"{name} from {edges[0] * 1e3:.6g} to {edges[-1] * 1e3:.6g} mm, cells of {spread} mm"


def _mass(mass: float, grid) -> str:
    return f"{mass * 1e3:.6g} g" if grid.cylindrical else f"{mass:.6g} kg/m"


def _speed(entry) -> str:
    radial, axial = entry.velocity
    return f"{axial:g} m/s" + (f" (radial {radial:g} m/s)" if radial else "") + (" and a flow" if entry.flow else "")


def _motion(entry) -> tuple:
    return entry.velocity, entry.flow


def _listed(names: list[str]) -> str:
    """Up to LISTED names, and the number of further ones."""
    more = len(names) - LISTED
    return ", ".join(names[:LISTED]) + (f" and {more} more" if more > 0 else "")


def _sliding(deck) -> str:
    slide = deck.sliding
    if slide.method == "none":
        return slide.method
    return (f"{slide.method}; hard: {', '.join(slide.hard)}; friction {slide.friction:g}, "
            f"yield factor {decks.yield_factor(deck):.5g}")


def _stop(stop) -> str:
    parts = [f"t = {stop.time * 1e6:.6g} us"] if stop.time else []
    parts += [f"{stop.cycles} cycles"] if stop.cycles else []
    parts += [f"speed of {stop.body} below {stop.speed_below:g} m/s"] if stop.speed_below else []
    parts += [f"rebound of {stop.body}"] if stop.rebound else []
    parts += [{True: "perforation", "tail": "tail of the projectile through"}[stop.perforation]] if stop.perforation else []
    return ", or ".join(parts)
