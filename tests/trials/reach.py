"""Bounds on the states that the bodies of a deck can reach, independent of the method.

The bounds follow from the deck and the equations of state alone. Closing speed V: the largest difference between the velocities
of two bodies, walls and edges included, and the speeds at which matter under pressure at the start expands; an explosive has
burnt at once. A body is shocked by a jump of V, or to the pressure that the other side bears, then squeezed on its isentrope to
the largest pressure of any collision; this covers reflections, and gas between closing walls. The bounds on density and energy
are those of that state. After that it expands, which gives speeds. Plastic work, friction and the margins come on top. Nothing
has less energy than its isentrope through the start, because entropy does not fall.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hydro2d.materials.starts import body_state, body_velocity, slot_of
from strength import SHEAR
from tests.trials.shocks import Material

#: factors on the results of shock and squeeze: energy and density for reflections, convergence and the dissipation of the
#: method; speeds for jets; the share that energy may fall below the start
ENERGY, DENSITY, SPEED, LEAST = 3.0, 2.0, 2.0, 0.25
#: density that elastic waves and rounding may add
ELASTIC = 0.05
#: share of the largest kinetic energy at the start allowed for bodies that hit nothing, and of the speed of sound
REST, NOISE = 0.05, 1e-3
#: plastic strain beyond which more work is not credited, and the share of the shear modulus that no flow stress exceeds
STRAIN, YIELDS = 10.0, 0.1
#: share of the density of the densest body below which a body is a gas beside solids
LIGHT = 0.01


@dataclass(frozen=True)
class Limits:
    """Bounds of a body. rho: at the start; shear: the work of a plastic strain of 1, J/kg; warm: it starts above 0 K."""

    rho: float
    most_rho: float
    least_e: float
    most_e: float
    speed: float
    shear: float
    warm: bool


class Reach:
    """The bounds of a simulation that has not yet begun.

    fastest : largest speed at the start, m/s;  closing : closing speed V, m/s;  pressure : of the strongest collision, Pa
    materials, bodies : Material and Limits by slot;  friction : heat of friction, J/(m^3 s)
    """

    def __init__(self, simulation):
        table, self.deck, grid = simulation.table, simulation.deck, simulation.grid
        self.materials = [Material(int(table.eos_model[m]), table.eos_par[m], table.spent(m)) for m in range(len(table))]
        speeds = _speeds(simulation)
        self.fastest = float(np.hypot(*speeds.T).max())
        self.closing = max(float(np.hypot(*(speeds - one).T).max()) for one in speeds)
        self.converges = any(body.flow is not None or body.velocity[0] != 0.0 for body in self.deck.body)
        starts: list[list] = [[] for _ in self.materials]
        for body, m in zip(self.deck.body, slot_of(self.deck, table), strict=True):
            starts[m].append(body_state(body, table, m))
        self.pressure, self._jumps = self._collision(starts)
        self.bodies = [self._limits(m, each, table) for m, each in enumerate(starts)]
        finest = min(float(np.diff(edges).min()) for edges in (grid.r_edges, grid.z_edges))
        self.friction = self.deck.sliding.friction * self.pressure * self.closing / finest

    def _collision(self, starts) -> tuple[float, list[float]]:
        """The pressure of the strongest collision, and the jump of every slot.

        The jump of a dense body is V, and what the pressure of light ones adds; that of a light one includes its own expansion.
        A collision of two bodies makes no more pressure than the softer of them bears at V; with a wall, or itself, each may.
        """
        densest = max(rho for each in starts for rho, _ in each)
        light = [max(rho for rho, _ in each) < LIGHT * densest for each in starts]
        released = [max(row.released(*one) for one in each) for row, each in zip(self.materials, starts, strict=True)]
        dense = [speed for speed, is_light in zip(released, light, strict=True) if not is_light]
        jumps = [self.closing + sum(sorted(released if is_light else dense)[-2:]) for is_light in light]
        pressures = [self._strongest(*each) for each in zip(self.materials, starts, jumps, strict=True)]
        of_light = max((p for p, is_light in zip(pressures, light, strict=True) if is_light), default=0.0)
        for m, row in enumerate(self.materials):
            if not light[m] and of_light > 0.0:
                jumps[m] += max(of_light / (rho * max(row.sound(rho, e), 1.0)) for rho, e in starts[m])
                pressures[m] = self._strongest(row, starts[m], jumps[m])
        return sorted(pressures)[-1 if len(starts) == 1 or self._meets_itself() else -2], jumps

    @staticmethod
    def _strongest(row: Material, starts, jump: float) -> float:
        """The largest pressure behind a shock with this jump."""
        return max(row.pressure(*row.shocked(*one, jump)) for one in starts)

    def _meets_itself(self) -> bool:
        """Whether a body may meet a wall, an edge with a velocity, the axis, or parts of itself."""
        edge = self.deck.boundaries
        edged = any(getattr(edge, key) in ("wall", "velocity", "piston") for key in ("r_min", "r_max", "z_min", "z_max"))
        return edged or self.converges or any(body.join is not None for body in self.deck.body)

    def _limits(self, m: int, starts, table) -> Limits:
        row = self.materials[m]
        after = [row.shocked(*one, self._jumps[m], max(self.pressure, row.pressure(*one))) for one in starts]
        ends = [row.squeezed(*one, self.pressure) for one in after]
        (rho, e), (most_rho, most_e) = (np.max(states, axis=0) for states in (starts, ends))
        if self.converges:
            most_rho *= max(one[0] / first[0] for one, first in zip(after, starts, strict=True)) ** 2
        rest = REST * 0.5 * self.fastest**2 + (NOISE * max(row.sound(*one) for one in starts)) ** 2 + 1e-300
        heat = max(ENERGY * (most_e - e), self._jumps[m] ** 2)
        return Limits(
            rho=float(rho), most_rho=float(rho * (1.0 + ELASTIC + DENSITY * (most_rho / rho - 1.0))),
            least_e=float(min(np.min(starts, axis=0)[1], 0.0) - LEAST * (most_e - e) - rest),
            most_e=float(max(e, 0.0) + heat + rest), speed=max(row.released(*one) + NOISE * row.sound(*one) for one in ends),
            shear=YIELDS * float(table.strength_par[m, SHEAR]) / float(rho) if table.strength_model[m] else 0.0,
            warm=all(row.temperature(*one) > 0.0 for one in starts))


def _speeds(simulation) -> np.ndarray:
    """Velocities [n, 2] of all bodies, of walls, of edges with a velocity and of pistons, m/s."""
    grid, edges = simulation.grid, simulation.engine.method.boundaries
    rows, columns = grid.inside
    r, z = np.meshgrid(grid.rc[columns], grid.zc[rows])
    speeds = [(0.0, 0.0)] if any(edges.having("constrains")) else []
    for body in simulation.deck.body:
        u, v = body_velocity(body, r, z)
        speeds += [(x, y) for x in (u.min(), u.max()) for y in (v.min(), v.max())]
    for n, edge in enumerate(edges.edges):
        speeds += [(speed, 0.0) if n < 2 else (0.0, speed) for speed in edge.speeds() if speed]
    return np.array(speeds)
