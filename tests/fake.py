"""A simulation without a solver: a rod that advances into a plate, on a real mesh, for tests of the files written."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

import eos
from hydro2d.base.errors import UnphysicalState
from hydro2d.deck.mesh_sections import Mesh, Segment
from hydro2d.deck.sections import Boundaries, Failure, Sliding
from hydro2d.materials import library
from hydro2d.measure import outcome
from hydro2d.measure.penetrator import Projectile
from hydro2d.mesh.fields import BODY
from hydro2d.mesh.grid import Grid

ROD, PLATE = "rod", "plate"
RADIUS, LENGTH, SPEED, STOP = 4e-3, 20e-3, 1000.0, 20e-6


class FakeDeck:
    """The part of a deck that run.py uses; a real one has the same names."""

    _layout = None
    setup, cells_across = "0123456789ab", 2.5

    def __init__(self, **output):
        self.name, self.title = "fake", "a rod that meets a plate"
        self.output = SimpleNamespace(
            **{"directory": "runs/fake", "vtk_interval": 5e-6, "history_interval": 1e-6, "restart_interval": 300.0,
               "fields": ("standard",)} | output
        )
        self.stop = SimpleNamespace(time=STOP, cycles=None)
        self.experiment = SimpleNamespace(penetration=0.0121, qualifier="measured", residual_velocity=None,
                                          source="a laboratory")
        self.courant = 0.5
        r, z = Segment(to=12e-3, cells=12), Segment(to=30e-3, cells=55)
        self.mesh, self.body, self.materials = Mesh(r=(r,), z_start=-25e-3, z=(z,)), (), {}
        self.sliding, self.failure, self.boundaries = Sliding(), Failure(), Boundaries(r_min="axis")
        self.source, self.result, self.penetration = (), {}, None

    def to_toml(self) -> str:
        return f"""\
title = "{self.title}"
[numerics]
courant = {self.courant}
[stop]
time = {self.stop.time}
[experiment]
penetration = {self.experiment.penetration}
[penetration]
rod = "rod"
target = "plate"
surface = 0.0
[[body]]
name = "rod"
"""


class Simulation:
    """Linear motion; every step multiplies the energy, so that a lost bit shows."""

    fail_at: int | None = None

    def __init__(self, deck):
        self.deck = deck
        self.grid = Grid(np.linspace(0, 12e-3, 13), np.linspace(-25e-3, 30e-3, 56))
        shape, vertices = self.grid.shape, self.grid.vertex_shape
        body, vertex = (lambda: np.zeros((2, *shape))), (lambda: np.zeros((1, *vertices)))
        q = np.zeros((len(BODY), 2, *shape))
        self.state = SimpleNamespace(
            vof=body(), q=q, **{field.symbol: row for field, row in zip(BODY, q, strict=True)},
            centroid=np.zeros((2, 2, *shape)), u=vertex(), v=vertex(), mass=vertex() + 1.0,
            group=np.zeros(2, dtype=np.int64), groups=1,
        )
        rows = [library.load(name) for name in ("W_alloy", "Al5083")]
        self.table = SimpleNamespace(
            names=(ROD, PLATE), internal=((), ()),
            eos_model=np.array([eos.MODELS[material.eos.name].ID for material in rows]),
            eos_par=np.stack([eos.MODELS[material.eos.name].row(material.eos.values) for material in rows]),
            memory=np.full(2, len(BODY)), records=False,
        )
        self.time, self.cycle, self.dt, self.dt_cause = 0.0, 0, 1e-7, "rod at r = 0.5 mm, z = 0.5 mm: sound"
        places = np.array([[0.0, 0.0], [1e-3, 5e-3]])
        where = {f"tracer_{name}": {"r_m": r, "z_m": z} for name, (r, z) in zip(("nose", "deep"), places.tolist(), strict=True)}
        self.columns, self.formulas, self.own_results, self.warnings = {}, {}, {}, []
        self.stations = SimpleNamespace(tracers=places, measure=lambda: where)
        self._place()

    def _place(self) -> None:
        s, depth = self.state, SPEED * self.time
        z, r = np.meshgrid(self.grid.zc, self.grid.rc, indexing="ij")
        s.vof[0] = (np.abs(r) < RADIUS) & (z < depth) & (z > depth - LENGTH)
        s.vof[1] = (z > 0) & (s.vof[0] == 0)
        s.rho[0], s.rho[1] = 18160.0, 2660.0 * (1 + 0.02 * np.sin(z * 100))
        s.srr[:], s.szz[:], s.srz[:] = 1e8, -3e8, 2e8
        s.ep[0] = self.time * 1e5
        s.v[:] = SPEED
        s.u[:] = 7.0

    def step(self) -> None:
        if self.fail_at is not None and self.cycle >= self.fail_at:
            raise UnphysicalState("cell (3, 4), rod, cycle 7: density -1 kg/m3")
        self.dt = 1e-7 * (1 + 0.3 * np.sin(self.cycle))
        self.time += self.dt
        self.cycle += 1
        self.state.e += 1.0
        self.state.e *= 1 + self.dt * 1e4 / 3
        self._place()

    @property
    def last_time(self) -> float:
        return np.inf if self.deck.stop.time is None else self.deck.stop.time

    def advance(self, until: float = np.inf, cycles: int | None = None) -> int:
        """One cycle at a time."""
        self.step()
        return 1

    def of_targets(self):
        return {}

    def outcome(self, status, stop_reason):
        return outcome.of(Projectile(**self.diagnostics()), status=status, stop_reason=stop_reason, impact_velocity=SPEED,
                          thickness=None, dropped=None)

    def holes(self):
        return {}

    def debris(self):
        return {}

    def diagnostics(self) -> dict:
        return {
            "penetration_depth_m": SPEED * self.time, "nose_depth_m": SPEED * self.time,
            "penetration_over_length": SPEED * self.time / LENGTH,
            "rod_length_m": LENGTH, "rod_mass_kg": 0.06,
            "rod_max_plastic_strain": float(self.state.ep.max()), "rod_tail_velocity_m_s": SPEED,
            "rod_nose_velocity_m_s": SPEED, "rod_mean_velocity_m_s": SPEED, "rod_kinetic_energy_J": 3e4,
            "rod_initial_length_m": LENGTH, "rod_max_radius_m": RADIUS, "rod_initial_radius_m": RADIUS,
            "regime": "rigid" if self.time < STOP / 2 else "deforming",
        }

    projectile = ROD

    def of_bodies(self) -> dict:
        return {ROD: {"mass_kg": 0.06, "velocity_m_s": SPEED, "kinetic_energy_J": 3e4}}

    def faults(self, share: float = 0.02) -> list[str]:
        return []

    def doubts(self) -> list[str]:
        return []

    def notes(self) -> list[str]:
        return []

    def not_finite(self) -> str | None:
        return None

    def refuse_nonsense(self) -> None:
        pass

    def conservation(self) -> dict:
        sinks = {"outflow": {"mass_kg": 0.0, "momentum_N_s": 0.0, "energy_J": 1e-3 * self.time}}
        mass = {ROD: 1e-16, PLATE: -2e-16}
        totals = {"axial_momentum": 3e-15, "total_energy": float("nan"), "internal_energy_J": 1, "kinetic_energy_J": 2}
        return {"mass": mass, "sinks": sinks, **totals}

    def stop_reason(self) -> str | None:
        return "the stop time was reached" if self.time >= self.deck.stop.time else None

    def restart_arrays(self) -> dict[str, np.ndarray]:
        return {"e": self.state.e}

    def load_restart_arrays(self, arrays) -> None:
        self.state.e[:] = arrays["e"]

    def restart_scalars(self) -> dict:
        return {"time": self.time, "cycle": self.cycle, "dt": self.dt}

    def load_restart_scalars(self, scalars) -> None:
        self.time, self.cycle, self.dt = scalars["time"], scalars["cycle"], scalars["dt"]
        self._place()
