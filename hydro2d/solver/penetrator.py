"""What one measures of a rod in a target: depth, length, radius, speeds, plastic strain, and the regime by stated rules."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hydro2d.deck import deck as decks
from hydro2d.mesh import sums
from hydro2d.mesh.boundary_conditions import BY_NAME
from hydro2d.mesh.sums import HALF
from hydro2d.solver import bodies
from hydro2d.solver.targets import Target

#: the rod is rigid while it has lost less than this share of its length and its radius has grown by less than that
RIGID_LENGTH, RIGID_RADIUS = 0.02, 0.10
#: it is eroding once more than this share of its mass has left its core
ERODED_MASS = 0.10
#: it has left the mesh once more than this share of its mass has flowed out since its core reached an open edge
LEFT_MASS = 0.01
#: cycles between looks at whether it is through the target, at what ends a run, and at whether the state makes sense
WATCH_EVERY = 10
#: the regime of such a rod
LEFT = "left the mesh"


#: what `measure` gives, and its meaning
QUANTITIES = {
    "penetration_depth_m": "from the target's original surface to the deepest rod material on or near the axis",
    "rod_length_m": "of the longest run of intact rod on the axis",
    "rod_initial_length_m": "the same at the start",
    "rod_mass_kg": "mass of the rod in the mesh",
    "rod_core_mass_kg": "mass of what is intact and hangs together from the axis outward",
    "rod_failed_mass_kg": "mass of the rod that has failed by damage",
    "target_failed_mass_kg": "mass of the target that has failed by damage",
    "rod_max_radius_m": "largest radius of a solid section with the area of the rod in a row of cells",
    "rod_initial_radius_m": "radius of the rod in the deck",
    "rod_max_plastic_strain": "largest plastic strain of the cells that the rod fills by half",
    "rod_mean_velocity_m_s": "mean axial velocity of all of the rod",
    "rod_core_velocity_m_s": "the same of its core",
    "rod_nose_velocity_m_s": "axial velocity of the rod on the axis at its nose",
    "rod_tail_velocity_m_s": "the same at its tail",
    "rod_kinetic_energy_J": "kinetic energy of the rod, of the radial motion as well",
    "rod_residual_velocity_m_s": "axial velocity of the core of a rod that has perforated the target or left the mesh",
    "rod_residual_mass_kg": "mass of that core",
    "rod_residual_length_m": "length of a rod that has perforated the target",
    "exit_time_s": "when the nose was the radius of the rod beyond the rear of the last target; null before",
    "regime": "rigid, deforming, eroding or left the mesh",
}

#: those that `bodies.QUANTITIES` has of every body: of the rod, and of the first target
OF_EVERY_BODY = {
    "rod_mass_kg": "mass_kg", "rod_mean_velocity_m_s": "velocity_m_s", "rod_kinetic_energy_J": "kinetic_energy_J",
    "rod_failed_mass_kg": "failed_mass_kg", "target_failed_mass_kg": "failed_mass_kg",
}  # fmt: skip
#: those that a projectile of any shape has in a summary, by their key there
PROJECTILE = {key: key.removeprefix("rod_") for key in QUANTITIES if key.startswith("rod_") and key not in OF_EVERY_BODY}

#: what `passages` gives of each target, and its meaning; null while the rod is not through it
PASSAGE = {
    "exit_time_s": "when the nose was the radius of the rod beyond the rear of this target",
    "exit_velocity_m_s": "axial velocity of the rod's core then",
    "exit_mass_kg": "mass of that core",
    "exit_length_m": "of the longest run of intact rod on the axis then",
}


class Exit(NamedTuple):
    """A rod as its core reached an open edge of the mesh: core's velocity in m/s and mass in kg, depth in m, and the mass of
    the rod that had flowed out of the mesh before, kg."""

    velocity: float
    mass: float
    depth: float
    outflow: float


class Passage(NamedTuple):
    """A rod when it was found to be through a target: time in s, velocity in m/s and mass in kg of its core, length in m."""

    time: float
    velocity: float
    mass: float
    length: float


class Penetrator:
    """Measures a rod in a simulation.

    Lengths are taken along the axis, from runs of cells that the rod fills by half or more, so that fragments behind the
    tail do not count: the depth from the deepest run in the columns within half a radius of the axis, failed or not, the rod's
    length from the longest run on the axis that has not failed. Its core is what has not failed and hangs together from the
    axis outward, row by row, along that run: debris behind the tail and a skirt of turned-back material do not belong to it.
    The regime is "rigid" while the rod has lost less than 2 % of its length and no section has swollen beyond 1.1 of its
    radius, "eroding" once more than 10 % of its mass has left the core, else "deforming".

    A rod can leave the mesh through an open edge in z. Its core has reached the edge when it fills half of the edge's cell on
    the axis and moves outwards there, as the mesh sees it. When more than 1 % of the rod's mass has flowed out since, the
    regime is "left the mesh" for good, and the depth stays what it was when the core reached the edge. Debris that leaves
    through any edge changes nothing as long as the core is inside. The edge behind the rod of a mesh that follows it does not
    count: what flows out there is debris, even where it fills the hole up to the axis and so hangs together with the core.

    Parameters
    ----------
    sim : Simulation
    deck : its deck, which names the rod
    targets : what the rod is to go through, in the order in which it meets them; the depth is that below the first one's face
    direction : of its flight along z, 1 or -1
    """

    def __init__(self, sim, deck, targets: list[Target], direction: float):
        self.sim = sim
        body = decks.body(deck, deck.penetration.rod)
        slots = decks.slots(deck)
        self.m = slots.index(body.join or body.name)
        self.targets, self.surface = targets, targets[0].surface
        self.radius = getattr(body, "rod_radius", None) or self._largest_radius(slice(None))
        self._around = 2 * np.pi if sim.grid.cylindrical else 1.0
        self.direction = direction
        grid = sim.grid
        self.columns = max(1, int(np.searchsorted(grid.r_edges[1:], 0.5 * self.radius)))
        self.length = self._length()[0]
        self._rears = [self.direction * (target.rear - self.surface) for target in targets]
        self.mass = float(sim.body_sums(self.m)[0].sum()) * self._around
        self.exit: Exit | None = None
        self.passed: list[Passage] = []
        self._offset = grid.offset
        ends = (deck.boundaries.z_min, (0, -1.0)), (deck.boundaries.z_max, (grid.nz, 1.0))
        behind = -self.direction if deck.mesh.follow == body.name else 0.0
        self._open = [end for kind, end in ends if BY_NAME[kind].opens and end[1] != behind]

    def _fraction(self) -> np.ndarray:
        """Volume fraction of the rod in the cells [j, i]."""
        return self.sim.grid.interior(self.sim.state.vof)[self.m]

    def _intact(self, rows: slice, columns=slice(None)) -> np.ndarray:
        """The same in some rows and columns, zero where the rod has failed."""
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
        """Length, lower and upper end of the longest run on the axis, m; zeros where there is none."""
        column = self._intact(slice(None), 0)
        ends = [self._ends(column, run) for run in self._runs(column)]
        if not ends:
            return 0.0, 0.0, 0.0
        low, high = max(ends, key=lambda pair: pair[1] - pair[0])
        return high - low, low, high

    def depth(self) -> float:
        """Deepest rod material near the axis, from the original surface, m; 0 before impact.

        Of a rod that has left the mesh, what it was when its core reached the edge.
        """
        if self.left:
            return self.exit.depth
        fraction, deepest = self._fraction(), -np.inf
        for i in range(self.columns):
            column = fraction[:, i]
            for run in self._runs(column):
                low, high = self._ends(column, run)
                deepest = max(deepest, (high if self.direction > 0 else -low))
        return float(max(deepest - self.direction * self.surface, 0.0)) if np.isfinite(deepest) else 0.0

    def _largest_radius(self, rows: slice) -> float:
        """Largest radius of a solid section with the rod's area in a row, m."""
        grid = self.sim.grid
        area = np.sum(self._intact(rows) * grid.vol_r[grid.inside[1]], axis=1)
        return float(np.max(np.sqrt(2.0 * area) if grid.cylindrical else area, initial=0.0))

    def _axis_velocity(self, z: float) -> float:
        """Axial velocity of the rod's body group on the axis at z, m/s."""
        return float(self.sim.velocity_at(np.array([[0.0, z]]), self.sim.state.group[self.m])[0, 1])

    def _largest_strain(self, rows: np.ndarray) -> float:
        """Largest plastic strain of the cells that the rod fills by half or more; rows are those that hold some of it."""
        if len(rows) == 0:
            return 0.0
        rows = slice(rows[0], rows[-1] + 1)
        strain = self.sim.grid.interior(self.sim.state.ep)[self.m][rows]
        return float(np.max(strain, where=self._fraction()[rows] >= HALF, initial=0.0))

    def _core(self, rows: slice) -> tuple[float, float]:
        """Mass in kg and axial momentum in N s of the cells that hang together from the axis outward in the given rows.

        The first cell that the rod does not fill by half ends a row, and still counts, unless it is the one on the axis.
        """
        g, s, found = self.sim.grid, self.sim.state, np.zeros(2)
        sums.core_sums(g.g, g.nr, g.g + rows.start, g.g + rows.stop, self.m, HALF, g.volume, s.vof, s.dmg, s.rho,
                       s.v[s.group[self.m]], found)
        mass, momentum = (found * self._around).tolist()
        return mass, momentum

    def _rows(self, low: float, high: float) -> slice:
        """The rows from z = low to high, and what is cut by either end."""
        first, last = np.searchsorted(self.sim.grid.z_edges, (low, high))
        return slice(max(int(first) - 1, 0), min(int(last) + 1, self.sim.grid.nz))

    def velocity(self) -> float:
        """Mean axial velocity of the core, m/s, so that what flies back from an eroding rod does not count; of all that is left
        of the rod where nothing is left of its core."""
        velocity, mass = self._whole_core()
        return velocity if mass > 0.0 else self.sim.mean_velocity(self.m)

    def _whole_core(self) -> tuple[float, float]:
        """Mean axial velocity in m/s and mass in kg of the core; zeros where nothing is left of it."""
        _, low, high = self._length()
        mass, momentum = self._core(self._rows(low, high))
        return (momentum / mass, mass) if mass > 0.0 else (0.0, mass)

    # ------------------------------------------------------------------------------------------------ leaving the mesh

    def watch(self) -> None:
        """After a cycle: remembers the rod as it is when its core reaches an open edge, and as it is through each target."""
        while len(self.passed) < len(self.targets) and self.sim.cycle % WATCH_EVERY == 0 and self._near_exit():
            if not self._through(self.depth(), len(self.passed)):
                break
            self.passed.append(Passage(self.sim.time, *self._whole_core(), self._length()[0]))
        grid, dt = self.sim.grid, self.sim.dt
        drift = (grid.offset - self._offset) / dt if dt > 0.0 else 0.0
        self._offset = grid.offset
        if self.left:
            return
        if not any(self._reaches(vertex, sign, drift) for vertex, sign in self._open):
            self.exit = None
        elif self.exit is None:
            self.exit = Exit(*self._whole_core(), self.depth(), self._outflow())

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
        """Whether nothing of the core of a rod that has left the mesh is in it any more."""
        return self.left and self._length()[0] == 0.0

    def saved(self) -> dict:
        """What a restart file keeps of it."""
        return {"exit": self.exit and self.exit._asdict(), "offset": self._offset, "passed": self.passed}

    def resume(self, saved: dict) -> None:
        """Continues from what was saved."""
        self.exit = Exit(**saved["exit"]) if saved["exit"] else None
        self._offset, self.passed = saved["offset"], [Passage(*one) for one in saved["passed"]]

    # ------------------------------------------------------------------------------------------------ what is known

    def _failed_mass(self, m: int) -> float:
        """Mass of a body's material that has failed by damage, kg, whole circumference."""
        g, s = self.sim.grid, self.sim.state
        failed = g.interior(s.dmg)[m] >= 1.0
        return float(np.sum((g.interior(s.vof)[m] * g.interior(s.rho)[m] * g.volume[g.inside])[failed]) * self._around)

    def _near_exit(self) -> bool:
        """Whether the rod fills half of a cell in the row before the one that its nose has to reach to be through the next
        target: quick to tell."""
        g, s = self.sim.grid, self.sim.state
        rear = self._rears[len(self.passed)]
        j = int(np.searchsorted(g.z_edges, self.surface + self.direction * (rear + self.radius))) - 1
        j -= int(self.direction)
        return 0 <= j < g.nz and any(s.vof[self.m, g.g + j, g.g + i] >= HALF for i in range(self.columns))

    def perforates(self) -> bool:
        """Whether the nose is the rod's radius beyond the rear of the last target."""
        return self._through(self.depth())

    def cleared(self) -> bool:
        """Whether the tail is beyond the original rear of the last target; false where no intact rod is on the axis."""
        length, low, high = self._length()
        tail = self.direction * ((low if self.direction > 0 else high) - self.surface)
        return length > 0.0 and tail >= self._rears[-1]

    def _through(self, depth: float, number: int = -1) -> bool:
        return depth >= self._rears[number] + self.radius

    def passages(self) -> list[dict[str, float | None]]:
        """The rod as it was through each target, in their order; None for those it is not through."""
        missing = [(None,) * len(PASSAGE)] * (len(self.targets) - len(self.passed))
        return [dict(zip(PASSAGE, one, strict=True)) for one in (*self.passed, *missing)]

    def _residual(self, depth: float, core: float, momentum: float) -> tuple[float | None, float | None]:
        """Velocity in m/s and mass in kg of what flies on, from the depth and the core's mass and momentum: of a rod that has
        left the mesh, those at its edge; of one that has perforated the last target, those of now; else None."""
        if self.left:
            return self.exit.velocity, self.exit.mass
        if core > 0.0 and self._through(depth):
            return momentum / core, core
        return None, None

    def regime(self, length: float, radius: float, core: float) -> str:
        """"rigid", "deforming", "eroding" or "left the mesh"; length and largest radius in m, mass of the core in kg."""
        if self.left:
            return LEFT
        if core < (1.0 - ERODED_MASS) * self.mass:
            return "eroding"
        if length > (1.0 - RIGID_LENGTH) * self.length and radius < (1.0 + RIGID_RADIUS) * self.radius:
            return "rigid"
        return "deforming"

    def measure(self) -> dict:
        """The keys of summary.json that concern the rod; SI, whole circumference."""
        length, low, high = self._length()
        tail, nose = (low, high) if self.direction > 0 else (high, low)
        rows = self._rows(low, high)
        radius = self._largest_radius(rows)
        core, core_momentum = self._core(rows)
        mass_of_rows, momentum_of_rows = self.sim.body_sums(self.m)
        mass = float(mass_of_rows.sum())
        mean = float(momentum_of_rows.sum()) / mass if mass > 0.0 else 0.0
        mass *= self._around
        depth = self.depth()
        residual_velocity, residual_mass = self._residual(depth, core, core_momentum)
        return {
            "penetration_depth_m": depth,
            "rod_length_m": length,
            "rod_initial_length_m": self.length,
            "rod_mass_kg": mass,
            "rod_core_mass_kg": core,
            "rod_failed_mass_kg": self._failed_mass(self.m),
            "target_failed_mass_kg": self._failed_mass(self.targets[0].m),
            "rod_max_radius_m": radius,
            "rod_initial_radius_m": self.radius,
            "rod_max_plastic_strain": self._largest_strain(np.nonzero(mass_of_rows)[0]),
            "rod_mean_velocity_m_s": mean,
            "rod_core_velocity_m_s": core_momentum / core if core > 0.0 else 0.0,
            "rod_nose_velocity_m_s": self._axis_velocity(nose) if length else 0.0,
            "rod_tail_velocity_m_s": self._axis_velocity(tail) if length else 0.0,
            "rod_kinetic_energy_J": bodies.motion(self.sim, self.m)[2],
            "rod_residual_velocity_m_s": residual_velocity,
            "rod_residual_mass_kg": residual_mass,
            "rod_residual_length_m": length if residual_mass is not None and not self.left else None,
            "exit_time_s": self.passages()[-1]["exit_time_s"],
            "regime": self.regime(length, radius, core),
        }
