"""Measurements of a rod in a target: depth, length, radius, speeds, plastic strain, and the regime by stated rules."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hydro2d.measure import bodies
from hydro2d.measure.regime import ERODED_MASS, LEFT, regime
from hydro2d.measure.result import Number, Result, result
from hydro2d.measure.shot import Flight, Target
from hydro2d.mesh import sums
from hydro2d.mesh.sums import HALF

#: a rod has left the mesh once more than this share of its mass has flowed out since its core reached an open edge
LEFT_MASS = 0.01
#: material slower than the axis by more than half of its speed plus this share of the first speed is debris, not core
DEBRIS_SPEED = 0.05
#: a core whose speed relative to a target is below this share of the first speed stays in it
LEAVING_SPEED = 0.01
#: cycles between checks of perforation, of the ends of a run, and of whether the state makes sense
WATCH_EVERY = 10


class Projectile(Result):
    """What a projectile of any shape has done; the names say rod. SI, whole circumference."""

    penetration_depth_m: Number = result(
        "largest depth so far, from the target's original surface to its deepest part near the axis", short="depth")
    nose_depth_m: Number = result(
        "present depth, less than the largest once a projectile has rebounded; in a summary, at the end")
    penetration_over_length: Number = result("the largest depth over the projectile's length at the start: P/L")
    interface_velocity_m_s: Number = result(
        "axial velocity on the axis at the nose: u of the theory of penetration, whose v is of the tail", short="u")
    rod_length_m: Number = result(
        "length of the longest run of intact material on the axis, in proportion to its length at the start", short="length")
    rod_initial_length_m: Number = result(
        "length in the deck of a rod or ball that lies wholly in the mesh; else its length at the start", short="length0")
    rod_mass_kg: Number = result("mass of the projectile in the mesh", short="mass")
    rod_initial_mass_kg: Number = result("mass of the projectile in the mesh at the start", short="mass0")
    rod_initial_kinetic_energy_J: Number = result("kinetic energy of the projectile at the start", short="energy0")
    rod_core_mass_kg: Number = result(
        "mass of intact material that is connected to the axis and keeps up with it", short="core_mass")
    rod_failed_mass_kg: Number = result("mass of the projectile that has failed by damage")
    target_failed_mass_kg: Number = result("mass of the target that has failed by damage")
    rod_max_radius_m: Number = result(
        "largest radius of a solid section with the area of the projectile in a row of cells", short="radius")
    rod_initial_radius_m: Number = result("radius of the projectile in the deck", short="radius0")
    rod_max_plastic_strain: Number = result("largest plastic strain of the cells that the projectile fills by half")
    rod_mean_velocity_m_s: Number = result("mean axial velocity of the whole projectile", short="velocity")
    rod_core_velocity_m_s: Number = result("mean axial velocity of its core")
    rod_nose_velocity_m_s: Number = result("axial velocity of the projectile on the axis at its leading end")
    rod_tail_velocity_m_s: Number = result("axial velocity of the projectile on the axis at its tail", short="v")
    rod_kinetic_energy_J: Number = result("kinetic energy of the projectile, including the radial motion", short="energy")
    rod_residual_velocity_m_s: Number = result(
        "axial velocity of the core of a projectile that has perforated the target or left the mesh; of all that was left "
        "if it was in pieces")
    rod_residual_mass_kg: Number = result("mass that has this velocity")
    rod_residual_length_m: Number = result("length of a projectile that has perforated the target")
    exit_time_s: Number = result("time at which its leading end was its radius beyond the rear of the last target; null before")
    regime: str | None = result(
        "rigid, deforming, eroding or left the mesh: what became of the projectile itself, whether it went through or not")


class Passage(Result):
    """The projectile as it was through a target; None until then. SI."""

    exit_time_s: Number = result("time at which the projectile's leading end was its radius beyond the rear of this target")
    exit_velocity_m_s: Number = result("axial velocity of its core then, or of all that was left if it was in pieces")
    exit_mass_kg: Number = result("mass that had this velocity")
    exit_length_m: Number = result("length of the longest run of intact material on the axis then")


class Exit(NamedTuple):
    """A rod as its core, or the first of its pieces, reached an open edge of the mesh: velocity in m/s and mass in kg of the
    core or the pieces, depth in m, and the mass of the rod that had flowed out of the mesh before, kg."""

    velocity: float
    mass: float
    depth: float
    outflow: float
    pieces: bool = False


class Penetrator:
    """Measures a rod in a simulation.

    Lengths are taken along the axis, from runs of cells that the rod fills by half or more, so that fragments behind the
    tail do not count: the depth from the deepest run in the columns within half a radius of the axis, failed or not, the rod's
    length from the longest run on the axis that has not failed. Its core is intact material that is connected from the axis
    outward, row by row, along that run, as far as it keeps up with the axis: debris behind the tail, a skirt of turned-back
    material and debris that flies back against the flank do not belong to it.
    The reported depth is the largest so far, of every tenth cycle and of now; the present depth of its deepest part, as of a
    ball that has rebounded, is the depth of its nose.
    A rod or a ball that lies wholly in the mesh has the length of the deck at the start. Its cells show less: the tip of an
    ogive is thinner than half a cell. Later lengths are scaled in the same proportion, so that a rod that keeps its shape
    keeps its length, and losses are shares of the length that the cells showed at first. If the head has become blunt this
    overestimates the length, by less than the tip was short, and by less the shorter the rod is.

    The regime is that of `measure/regime.py`, from the length, the largest radius and the mass of the core.

    A rod can leave the mesh through an open edge in z. Its core has reached the edge when it fills half of the edge's cell on
    the axis and moves outwards there, relative to the mesh. When more than 1 % of the rod's mass has flowed out since, the
    regime is "left the mesh" for good, and the nose stays where it was when the core reached the edge. Debris that leaves
    through any edge changes nothing as long as the core is inside. The edge behind the rod of a mesh that follows it does not
    count: material flowing out there is debris, even if it fills the hole up to the axis and so is connected to the core.
    A core is through a target when its nose is its radius beyond the rear and it flies away from the target. One that the last
    target carries along is not, even if it was before. A rod in pieces, with no cell on the axis half full, is through a target
    when most of it is beyond the rear; behind the last target it has left the mesh by the same 1 %, and is gone when at most a
    tenth is left.

    Depths, rears and exits are measured from where the targets would be if nothing had touched them: the face of a target that
    flies at the rod moves with its own velocity. Velocities are in the frame of the mesh.

    Parameters
    ----------
    sim : Simulation
    flight : the rod as the deck has it
    targets : those that the rod is to go through, in the order in which it meets them; depths are below the first one's face

    Attributes
    ----------
    impact_energy, impact_momentum : kinetic energy, J, and momentum along its flight, N s, at the start, relative to the first
        target
    leaving : velocity relative to a target below which a core stays in it, m/s
    """

    def __init__(self, sim, flight: Flight, targets: list[Target]):
        self.sim = sim
        self.m, self.direction, self._targets = flight.m, flight.direction, targets
        self.radius = flight.radius or self._largest_radius(slice(None))
        self._around = 2 * np.pi if sim.grid.cylindrical else 1.0
        grid = sim.grid
        self.columns = max(1, int(np.searchsorted(grid.r_edges[1:], 0.5 * self.radius)))
        shown = self._length()[0]
        self.length = flight.length or shown
        self._stretch = self.length / shown if shown > 0.0 else 1.0
        self.mass = float(sim.body_sums(self.m)[0].sum()) * self._around
        _, momentum, self.energy, *_ = bodies.motion(sim, self.m)
        self._against = targets[0].velocity
        self.impact_energy = self.energy - self._against * momentum + 0.5 * self.mass * self._against**2
        self.impact_momentum = self.direction * (momentum - self._against * self.mass)
        self._run = np.zeros(2, dtype=np.int64)
        speed = self._speed = abs((sim.mean_velocity(self.m) or 0.0) - self._against)
        self._slack, self.leaving = DEBRIS_SPEED * speed, LEAVING_SPEED * speed
        self._ringing = _ringing(sim, self.m)
        self.exit: Exit | None = None
        self.passed: list[Passage] = []
        self._deepest = 0.0
        self._open = [(0 if end < 0 else grid.nz, float(end)) for end in flight.exits]
        edge_cells = [grid.g + vertex - (sign > 0.0) for vertex, sign in self._open]
        sim.engine.given.set(rod=self.m, rod_exits=np.array(edge_cells, dtype=np.int64))

    @property
    def targets(self) -> list[Target]:
        """The targets as they would be now if nothing had touched them."""
        return [target.at(self.sim.time) for target in self._targets]

    @property
    def surface(self) -> float:
        """Axial position, m, from which depths are measured: that of the first target's face if nothing had touched it."""
        return self._targets[0].at(self.sim.time).surface

    @property
    def _rears(self) -> list[float]:
        """Depths of the rears of the targets below that face, m."""
        surface = self.surface
        return [self.direction * (target.rear - surface) for target in self.targets]

    def _fraction(self) -> np.ndarray:
        """Volume fraction of the rod in the cells [j, i]."""
        return self.sim.grid.interior(self.sim.state.vof)[self.m]

    def _intact(self, rows: slice, columns=slice(None)) -> np.ndarray:
        """Volume fraction of the rod in some rows and columns, zero where the rod has failed."""
        damage = self.sim.grid.interior(self.sim.state.dmg)[self.m]
        return np.where(damage[rows, columns] < 1.0, self._fraction()[rows, columns], 0.0)

    def _runs(self, column: np.ndarray) -> list[tuple[int, int]]:
        """(first, one past last) of the runs of cells filled by half or more, in the direction of flight."""
        inside = np.concatenate([[False], column >= HALF, [False]])
        change = np.nonzero(inside[1:] != inside[:-1])[0]
        return list(zip(change[0::2].tolist(), change[1::2].tolist(), strict=True))

    def _ends(self, column: np.ndarray, run: tuple[int, int]) -> tuple[float, float]:
        """Lower and upper end of a run, m; the partly filled cells at both ends count by their share."""
        edges, dz = self.sim.grid.z_edges, np.diff(self.sim.grid.z_edges)
        first, last = run
        low, high = edges[first], edges[last]
        if first > 0:
            low -= column[first - 1] * dz[first - 1]
        low += (1.0 - column[first]) * dz[first]
        if last < len(dz):
            high += column[last] * dz[last]
        high -= (1.0 - column[last - 1]) * dz[last - 1]
        return float(low), float(high)

    def _length(self) -> tuple[float, float, float]:
        """Length, lower and upper end of the longest run on the axis as its cells show it, m; zeros if there is none."""
        column = self._intact(slice(None), 0)
        ends = [self._ends(column, run) for run in self._runs(column)]
        if not ends:
            return 0.0, 0.0, 0.0
        low, high = max(ends, key=lambda pair: pair[1] - pair[0])
        return high - low, low, high

    def _without_debris(self, low: float, high: float) -> tuple[float, float]:
        """The ends of a run on the axis without the material behind it that flies back, out of the target and from the nose.

        A rod that has eroded and stopped may touch such debris, which is no part of its length.
        """
        s, grid = self.sim.state, self.sim.grid
        within = (grid.z_edges > low) & (grid.z_edges < high)
        edges = grid.z_edges[within][:: int(self.direction)]
        speed = self.direction * grid.interior_vertices(s.v)[s.group[self.m]][within, 0][:: int(self.direction)]
        slower = speed < min(self.direction * self._against, speed[-1] if len(speed) else 0.0) - self._slack
        if not slower.any():
            return low, high
        tail = float(edges[np.flatnonzero(slower)[-1]])
        return (tail, high) if self.direction > 0 else (low, tail)

    def nose(self) -> float:
        """Depth of the deepest rod material near the axis, from the original surface, now, m; 0 before impact.

        For a rod in pieces that fill no cell near the axis by half, the depth that a hundredth of their mass has reached. For a
        rod that has left the mesh, the depth when it reached the edge.
        """
        return self.exit.depth if self.left else max(self._front(), 0.0)

    @property
    def has_struck(self) -> bool:
        """Whether the rod has been deeper than the first target's face, or has lost half of its velocity: one that rebounds
        without a dent may never be seen below the face."""
        if self._deepest > 0.0 or self.nose() > 0.0:
            return True
        velocity = self.sim.mean_velocity(self.m)
        return velocity is not None and self.direction * (velocity - self._against) < 0.5 * self._speed

    def _front(self) -> float:
        """Depth of the nose of a rod in the mesh, m; negative before impact."""
        fraction, deepest = self._fraction(), -np.inf
        for i in range(self.columns):
            column = fraction[:, i]
            for run in self._runs(column):
                low, high = self._ends(column, run)
                deepest = max(deepest, (high if self.direction > 0 else -low))
        return float(deepest - self.direction * self.surface) if np.isfinite(deepest) else self._front_of_pieces()

    def _masses(self) -> tuple[np.ndarray, np.ndarray]:
        """Depth of every row of cells below the original surface, m, and mass of the rod in it, kg; the deepest row first."""
        depth = self.direction * (self.sim.grid.zc[self.sim.grid.inside[0]] - self.surface)
        mass = self.sim.body_sums(self.m)[0] * self._around
        return (depth[::-1], mass[::-1]) if self.direction > 0 else (depth, mass)

    def _front_of_pieces(self) -> float:
        """Depth that the share LEFT_MASS of the remaining rod has reached, m; 0 if nothing is left."""
        depth, mass = self._masses()
        whole = float(mass.sum())
        return float(depth[np.searchsorted(np.cumsum(mass), LEFT_MASS * whole)]) if whole > 0.0 else 0.0

    def _largest_radius(self, rows: slice) -> float:
        """Largest radius of a solid section with the rod's area in a row, m."""
        grid = self.sim.grid
        area = np.sum(self._intact(rows) * grid.vol_r[grid.inside[1]], axis=1)
        return float(np.max(np.sqrt(2.0 * area) if grid.cylindrical else area, initial=0.0))

    def _axis_velocity(self, z: float) -> float:
        """Axial velocity of the rod's body group on the axis at z, m/s."""
        return float(self.sim.velocity_at(np.array([[0.0, z]]), self.sim.state.group[self.m])[0, 1])

    def _largest_strain(self, rows: np.ndarray) -> float:
        """Largest plastic strain of the cells that the rod fills by half or more; rows are those that contain some of it."""
        if len(rows) == 0:
            return 0.0
        rows = slice(rows[0], rows[-1] + 1)
        strain = self.sim.grid.interior(self.sim.state.ep)[self.m][rows]
        return float(np.max(strain, where=self._fraction()[rows] >= HALF, initial=0.0))

    def _core(self, rows: slice) -> tuple[float, float]:
        """Mass in kg and axial momentum in N s of the core in the given rows, see `sums.core_sums`."""
        g, s, totals = self.sim.grid, self.sim.state, np.zeros(2)
        sums.core_sums(g.g, g.nr, g.g + rows.start, g.g + rows.stop, self.m, HALF, self.direction, self._slack, self._against,
                       g.volume, s.vof, s.dmg, s.rho, s.v[s.group[self.m]], totals)
        mass, momentum = (totals * self._around).tolist()
        return mass, momentum

    def _rows(self, low: float, high: float) -> slice:
        """The rows from z = low to high, including those that either end cuts."""
        first, last = np.searchsorted(self.sim.grid.z_edges, (low, high))
        return slice(max(int(first) - 1, 0), min(int(last) + 1, self.sim.grid.nz))

    def velocity(self) -> float | None:
        """Mean axial velocity of the core, m/s, so that debris flying back from an eroding rod does not count; None if nothing
        of the rod is left.

        Without a core, only the momentum of pieces flying forward counts, over the mass of all.
        """
        velocity, mass = self._whole_core()
        if mass > 0.0:
            return velocity
        mass_of_rows, momentum = self.sim.body_sums(self.m)
        mass = float(mass_of_rows.sum())
        if mass * self._around <= LEFT_MASS * self.mass:
            return None
        onward = np.maximum(self.direction * (momentum - self._against * mass_of_rows), 0.0)
        return self._against + self.direction * float(onward.sum()) / mass

    def speed(self) -> float | None:
        """Axial velocity, m/s, by which a run ends: of the core, or of the tail while it outruns the core.

        A tail that is faster than its core by more than twice the velocity of a wave at the yield stress, 2 Y/(rho c), does not
        ring: it still feeds the head, however slow the head and the mean are. None if nothing of the rod is left.
        """
        velocity, (length, low, high) = self.velocity(), self._length()
        if velocity is None or length == 0.0:
            return velocity
        tail = self._axis_velocity(low if self.direction > 0 else high)
        return tail if self.direction * (tail - velocity) > self._ringing else velocity

    def _whole_core(self) -> tuple[float, float]:
        """Mean axial velocity in m/s and mass in kg of the core; zeros if nothing is left of it."""
        _, low, high = self._length()
        mass, momentum = self._core(self._rows(low, high))
        return (momentum / mass, mass) if mass > 0.0 else (0.0, mass)

    def _whole(self) -> tuple[float, float]:
        """Mean axial velocity in m/s and mass in kg of the remaining rod."""
        mass, momentum = (float(rows.sum()) for rows in self.sim.body_sums(self.m))
        return (momentum / mass if mass > 0.0 else 0.0), mass * self._around

    def _in_pieces(self) -> bool:
        """Whether no cell on the axis is filled by half with intact rod."""
        g, s = self.sim.grid, self.sim.state
        sums.axis_run(g.g, g.nz, self.m, HALF, g.z, s.vof, s.dmg, self._run)
        return bool(self._run[0] == self._run[1])

    def _share_beyond(self, rear: float) -> float:
        """Share of the remaining rod that is deeper than the rear of a target."""
        depth, mass = self._masses()
        whole = float(mass.sum())
        return float(mass[depth > rear].sum()) / whole if whole > 0.0 else 0.0

    def _pieces_through(self, number: int = -1) -> bool:
        """Whether the rod is in pieces, has not left the mesh, and most of the pieces are beyond the rear of a target."""
        return not self.left and self._in_pieces() and self._share_beyond(self._rears[number]) > HALF

    # ------------------------------------------------------------------------------------------------ leaving the mesh

    def watch(self) -> None:
        """Records the rod when its core reaches an open edge, and when it is through each target.

        Called every few cycles, and after each in which the rod fills half of a cell on the axis at an open edge or has reached
        that edge (`hydro2d.kernels.between.judgements`).
        """
        looks = self.sim.cycle % WATCH_EVERY == 0
        if looks and len(self.passed) == len(self.targets) and not (self.left or self._flies_from()):
            self.passed.pop()
        while looks and len(self.passed) < len(self.targets) and self._is_through(len(self.passed)):
            flying = self._whole() if self._in_pieces() else self._whole_core()
            self.passed.append(Passage(exit_time_s=self.sim.time, exit_velocity_m_s=flying[0], exit_mass_kg=flying[1],
                                       exit_length_m=self._stretch * self._length()[0]))
        self._watch_edges(looks)
        self.sim.engine.given.handle.update(rod_leaves=self.exit is not None and not self.left)

    def _watch_edges(self, looks: bool) -> None:
        """Records the rod when its core reaches an open edge; looks : whether its pieces and its depth are looked at, too."""
        if self.left:
            return
        drift = self.sim.engine.given.handle.mesh_speed
        if any(self._reaches(vertex, sign, drift) for vertex, sign in self._open):
            self.exit = self.exit or Exit(*self._whole_core(), self.nose(), self._outflow())
        elif self.exit and not self.exit.pieces:
            self.exit = None
        if looks and self._open and (self.exit is None or self.exit.pieces):
            self._watch_pieces()
        if looks and self.exit is None:
            self._deepest = max(self._deepest, self.nose())

    def _is_through(self, number: int) -> bool:
        """Whether the rod, or most of its pieces, is through a target; quick if it is far from that."""
        out = self._near_exit() and self._through(self.nose(), number) and self._flies_from(number)
        return out or self._pieces_through(number)

    def _flies_from(self, number: int = -1) -> bool:
        """Whether the core moves away from a target, by the mean velocity of what is left of both; a rod in pieces does."""
        velocity, mass = self._whole_core()
        target = self.sim.mean_velocity(self._targets[number].m)
        return mass == 0.0 or target is None or self.direction * (velocity - target) > self.leaving

    def _watch_pieces(self) -> None:
        """Records a rod in pieces behind the last target, until the first of them flows out."""
        if self._pieces_through() and (self.exit is None or self.exit.outflow == self._outflow()):
            self.exit = Exit(*self._whole(), self.nose(), self._outflow(), pieces=True)

    def _reaches(self, vertex: int, sign: float, drift: float) -> bool:
        """Whether the core fills half of the edge's cell on the axis and moves out of a mesh that drifts, m/s, along z."""
        s, g, edges = self.sim.state, self.sim.grid.g, self.sim.grid.z_edges
        j = g + vertex - (sign > 0.0)
        if s.vof[self.m, j, g] < HALF or s.dmg[self.m, j, g] >= 1.0:
            return False
        if sign * (s.v[s.group[self.m], g + vertex, g] - drift) <= 0.0:
            return False
        _, low, high = self._length()
        return high > edges[-2] if sign > 0.0 else low < edges[1]

    def _outflow(self) -> float:
        """Mass of the rod that has left through open edges, kg."""
        return float(self.sim.audit.sinks["outflow"].mass[self.m]) * self._around

    @property
    def left(self) -> bool:
        """Whether the rod has left the mesh, by the rule above."""
        return self.exit is not None and self._outflow() - self.exit.outflow > LEFT_MASS * self.mass

    @property
    def gone(self) -> bool:
        """Whether a rod that has left the mesh has no core in it any more, or at most a tenth of its pieces."""
        if not self.left or not self._in_pieces():
            return False
        return not self.exit.pieces or self._whole()[1] <= ERODED_MASS * self.mass

    def saved(self) -> dict:
        """Data for a restart file."""
        return {"exit": self.exit and self.exit._asdict(), "deepest": self._deepest,
                "passed": [list(one.model_dump().values()) for one in self.passed]}

    def resume(self, saved: dict) -> None:
        """Continues from the result of `saved`."""
        self.exit = Exit(**saved["exit"]) if saved["exit"] else None
        self.sim.engine.given.handle.update(rod_leaves=self.exit is not None)
        self.passed = [Passage(**dict(zip(Passage.model_fields, one, strict=True))) for one in saved["passed"]]
        self._deepest = saved["deepest"]

    # ------------------------------------------------------------------------------------------------ results

    def _failed_mass(self, m: int) -> float:
        """Mass of a body's material that has failed by damage, kg, whole circumference."""
        g, s = self.sim.grid, self.sim.state
        failed = g.interior(s.dmg)[m] >= 1.0
        return float(np.sum((g.interior(s.vof)[m] * g.interior(s.rho)[m] * g.volume[g.inside])[failed]) * self._around)

    def _near_exit(self) -> bool:
        """Whether the rod fills half of a cell in the row before the one that its nose has to reach to be through the next
        target: a quick check."""
        g, s = self.sim.grid, self.sim.state
        rear = self._rears[len(self.passed)]
        j = int(np.searchsorted(g.z_edges, self.surface + self.direction * (rear + self.radius))) - 1
        j -= int(self.direction)
        return 0 <= j < g.nz and any(s.vof[self.m, g.g + j, g.g + i] >= HALF for i in range(self.columns))

    def perforates(self) -> bool:
        """Whether the nose is the rod's radius beyond the rear of the last target, from which the core flies away, or most of a
        rod in pieces is behind it."""
        return (self._through(self.nose()) and self._flies_from()) or len(self.passed) == len(self.targets)

    def cleared(self) -> bool:
        """Whether the tail is beyond the original rear of the last target; of a rod in pieces, nine tenths of them."""
        length, low, high = self._length()
        if length == 0.0:
            return self._share_beyond(self._rears[-1]) > 1.0 - ERODED_MASS
        tail = self.direction * ((low if self.direction > 0 else high) - self.surface)
        return tail >= self._rears[-1]

    def _through(self, nose: float, number: int = -1) -> bool:
        return nose >= self._rears[number] + self.radius

    def passages(self) -> list[Passage]:
        """The rod as it was through each target, in their order; None for those it is not through."""
        return self.passed + [Passage()] * (len(self.targets) - len(self.passed))

    def _residual(self, nose: float, core: float, momentum: float) -> tuple[float | None, float | None]:
        """Residual velocity in m/s and mass in kg, from the nose's depth and the core's mass and momentum: for a rod that has
        left the mesh, those at its edge; for one that has perforated the last target, those of now; else None. For a rod in
        pieces, those of all of it."""
        if self.left:
            return self.exit.velocity, self.exit.mass
        if core > 0.0 and self._through(nose) and self._flies_from():
            return momentum / core, core
        if core == 0.0 and len(self.passed) == len(self.targets):
            return self._whole()
        return None, None

    def regime(self, length: float, radius: float, core: float) -> str:
        """"rigid", "deforming", "eroding" or "left the mesh"; length and largest radius in m, mass of the core in kg."""
        if self.left:
            return LEFT
        return regime(_share(length, self.length), _share(radius, self.radius), _share(core, self.mass))

    def measure(self) -> Projectile:
        """What the rod has done until now."""
        _, low, high = self._length()
        rows = self._rows(low, high)
        low, high = self._without_debris(low, high)
        tail, nose = (low, high) if self.direction > 0 else (high, low)
        length = self._stretch * (high - low)
        radius = self._largest_radius(rows)
        core, core_momentum = self._core(rows)
        mass_of_rows, momentum_of_rows = self.sim.body_sums(self.m)
        mass = float(mass_of_rows.sum())
        mean = float(momentum_of_rows.sum()) / mass if mass > 0.0 else None
        mass *= self._around
        front = self._front()
        nose_depth = self.exit.depth if self.left else max(front, 0.0)
        depth = max(self._deepest, nose_depth)
        residual_velocity, residual_mass = self._residual(nose_depth, core, core_momentum)
        return Projectile(
            penetration_depth_m=depth,
            nose_depth_m=nose_depth,
            penetration_over_length=depth / self.length if self.length > 0.0 else None,
            interface_velocity_m_s=None if self.left or mass == 0.0 else
            self._axis_velocity(self.surface + self.direction * front),
            rod_length_m=length,
            rod_initial_length_m=self.length,
            rod_mass_kg=mass,
            rod_initial_mass_kg=self.mass,
            rod_initial_kinetic_energy_J=self.energy,
            rod_core_mass_kg=core,
            rod_failed_mass_kg=self._failed_mass(self.m),
            target_failed_mass_kg=self._failed_mass(self.targets[0].m),
            rod_max_radius_m=radius,
            rod_initial_radius_m=self.radius,
            rod_max_plastic_strain=self._largest_strain(np.nonzero(mass_of_rows)[0]),
            rod_mean_velocity_m_s=mean,
            rod_core_velocity_m_s=core_momentum / core if core > 0.0 else None,
            rod_nose_velocity_m_s=self._axis_velocity(nose) if length else None,
            rod_tail_velocity_m_s=self._axis_velocity(tail) if length else None,
            rod_kinetic_energy_J=bodies.motion(self.sim, self.m)[2],
            rod_residual_velocity_m_s=residual_velocity,
            rod_residual_mass_kg=residual_mass,
            rod_residual_length_m=length if residual_mass is not None and not self.left else None,
            exit_time_s=self.passages()[-1].exit_time_s,
            regime=self.regime(length, radius, core),
        )


def _share(now: float, first: float) -> float:
    """The remaining share of the amount at the start; 0 if there was none."""
    return now / first if first > 0.0 else 0.0


def _ringing(sim, m: int) -> float:
    """Twice the velocity of an elastic wave that brings body m to its first yield stress, 2 Y/(rho c), m/s."""
    t = sim.table
    speed = t.sound_speeds()[m]
    if not speed > 0.0:
        return 0.0
    p, _, _, temperature = t.evaluate(m, t.rho0[m], t.e0[m])
    stress = sim.engine.method.yield_factor[m] * t.flow_stress(m, 0.0, 0.0, temperature, p)
    return float(2.0 * stress / (t.rho0[m] * speed))
