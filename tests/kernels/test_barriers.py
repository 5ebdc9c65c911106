"""Between two barriers no part of the mesh touches what another one writes: every access of a step, watched in Python."""

import functools
import sys
import threading
from types import SimpleNamespace

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.kernels.contact import contact_motion, extension
from hydro2d.mesh import state
from hydro2d.solver.simulation import Simulation
from tests.kernels.cells import source
from tests.kernels.test_compiled_equals_source import CONTACT, LAYER, text_of
from tests.kernels.test_phases import PHASES

PARTS = 4
#: functions of several cells at once that are left compiled
PLAIN = ("exp", "log", "power")
DECKS = {"slip-layer": text_of("both", LAYER), "contact": text_of("both", CONTACT, tip="5 mm", follows=False),
         "following": text_of("ke", CONTACT)}


#: phases of every cycle of these decks
EVERY_CYCLE = {"close_cells", "accelerate", "deform", "deform_mixed", "carry_bodies", "carry_momentum"}


class Seen(threading.local):
    """The addresses that the running part has read and written since the last barrier."""

    def __init__(self):
        self.read, self.written = set(), set()


SEEN = Seen()


class Watched(np.ndarray):
    """An array that notes which of its elements are read and written."""

    def __array_finalize__(self, base):
        self.at = None

    def _address(self, key) -> int:
        if self.at is None:
            self.at = self.__array_interface__["data"][0]
        places = key if isinstance(key, tuple) else (key,)
        return self.at + sum(int(place) * step for place, step in zip(places, self.strides, strict=True))

    def __getitem__(self, key):
        item = super().__getitem__(key)
        if not isinstance(item, np.ndarray):
            SEEN.read.add(self._address(key))
        return item

    def __setitem__(self, key, value):
        SEEN.written.add(self._address(key))
        super().__setitem__(key, value)


class Races:
    """Runs the phases as Python, every part in a thread of its own, one after another from barrier to barrier.

    found : (phase, number of the interval between barriers, array) of elements written by one part and touched by another
    """

    def __init__(self, monkeypatch, without: tuple[str, int] | None = None):
        self.without, self.barriers = without, {}
        self.found, self.own, self.stopped = set(), threading.local(), threading.Semaphore(0)
        for module in list(sys.modules.values()):
            if module.__name__.startswith(("hydro2d.kernels", "hydro2d.physics", "eos", "strength", "hydro2d_")):
                for name, value in list(vars(module).items()):
                    if name in PLAIN or isinstance(value, jit.Phase):  # whose text must not be made of what stands here now
                        continue
                    if hasattr(getattr(value, "compiled", value), "py_func"):
                        monkeypatch.setattr(module, name, source(value))
        for module, name in PHASES:
            monkeypatch.setattr(module, name, functools.partial(self, getattr(module, name)))

    def _wait(self):
        self.own.waits += 1
        if self.without != (self.own.phase, self.own.waits):
            self._stop()

    def _stop(self):
        self.own.log.append((SEEN.read, SEEN.written))
        SEEN.read, SEEN.written = set(), set()
        self.stopped.release()
        self.own.turn.acquire()

    def __call__(self, phase, handle):
        number, failed = len(handle.parts) - 1, []
        turns, logs, running = [threading.Semaphore(0) for _ in range(number)], [[] for _ in range(number)], set(range(number))
        watched = SimpleNamespace(**{name: each.view(Watched) if isinstance(each, np.ndarray) else each
                                     for name, each in handle.values.items()})

        def work(place):
            self.own.turn, self.own.log = turns[place], logs[place]
            self.own.phase, self.own.waits = phase.__name__, 0
            turns[place].acquire()
            try:
                with np.errstate(all="ignore"):
                    phase.as_python(watched, place, self._wait)
            except BaseException as error:
                failed.append(error)
            running.discard(place)
            self.barriers[phase.__name__] = self.own.waits
            self._stop()

        for place in range(number):
            threading.Thread(target=work, args=(place,), daemon=True).start()
        while running:
            for turn in turns:
                turn.release()
                self.stopped.acquire()
                if failed:
                    raise failed[0]
        handle.update(**{name: value for name, value in vars(watched).items() if not isinstance(value, np.ndarray)})
        arrays = [(name, handle.values[name]) for name in phase.takes if isinstance(handle.values[name], np.ndarray)]
        for interval, touched in enumerate(zip(*logs, strict=True)):
            for one, (_, written) in enumerate(touched):
                for other, (read, also_written) in enumerate(touched):
                    for address in written & (read | also_written) if one != other else ():
                        self.found |= {(phase.__name__, interval, name) for name in owners(address, arrays)}
        for turn in turns:
            turn.release()


def owners(address: int, arrays: list) -> list[str]:
    """The names of the arrays that contain an address."""
    names = [name for name, array in arrays
             if 0 <= address - array.__array_interface__["data"][0] < array.nbytes]
    assert names, "an address of no array"
    return names


def everything_happens(monkeypatch) -> None:
    """Makes rare events happen everywhere: groups part in every cell next to them, every contact node is a slave."""
    for name in ("meeting", "is_separating"):
        monkeypatch.setattr(contact_motion, name, lambda *_: True)
    monkeypatch.setattr(extension, "sureness", lambda share: 0.0)
    viscosity = contact_motion.contact_viscosity

    def without_pressure(part, w):
        viscosity(part, SimpleNamespace(**{**vars(w), "p": np.zeros_like(w.p, subok=False)}))

    monkeypatch.setattr(contact_motion, "contact_viscosity", without_pressure)


def races(monkeypatch, case: str, without: tuple[str, int] | None = None) -> Races:
    """A cycle after two others, in which everything happens."""
    monkeypatch.setattr(state, "max_threads", lambda: PARTS)  # scratch memory for as many parts
    simulation = Simulation(deck.loads(DECKS[case]))
    for _ in range(2):
        simulation.step()
    monkeypatch.setattr(jit, "parts_at_once", lambda: PARTS)
    seen = Races(monkeypatch, without)
    everything_happens(monkeypatch)
    with np.errstate(all="ignore"):
        simulation.step()
    assert len(simulation.engine.rows) == PARTS + 1
    return seen


@pytest.mark.thorough
@pytest.mark.parametrize("case", DECKS)
def test_no_part_touches_what_another_one_writes(monkeypatch, case):
    seen = races(monkeypatch, case)
    assert seen.found == set()
    assert EVERY_CYCLE <= set(seen.barriers)


def barrier_before(phase: str, kernel: str) -> tuple[str, int]:
    """The last barrier in a phase before it calls a kernel: its number in the phase, from 1, with contact."""
    module = next(module for module, name in PHASES if name == phase)
    steps = [step if step == jit.WAIT else f"{step.kernel.__module__.split('.')[-1]}.{step.kernel.__name__}"
             for step in flat(getattr(module, phase).steps)]
    return phase, steps[: steps.index(kernel)].count(jit.WAIT)


def flat(steps):
    """The steps of a phase, with those of its branches in their places."""
    for step in steps:
        if hasattr(step, "steps"):
            yield from flat(step.steps)
        else:
            yield step


#: barriers without which bits rarely change, and the array that two parts then touch
RARE = [
    ("find_contact", "contact_motion.contact_viscosity", "vof"),
    ("carry_bodies", "contact_volumes.limit_fluxes", "flux_volume"),
    ("carry_momentum", "column_ranges.find_active_ranges", "occupied"),
]
#: all others that this deck needs
OFTEN = [
    ("close_cells", "mixed.close_cells", "u"), ("close_cells", "contact_geometry.number_nodes", "contact_node_count"),
    ("find_contact", "contact_geometry.face_apertures", "line"), ("find_contact", "extension.find_extensions", "firmly"),
    ("find_contact", "thermodynamics.least_step", "row_step"), ("accelerate", "vertex_forces.accelerate", "sig_rr"),
    ("accelerate", "contact_velocities.resolve_contact", "u"), ("accelerate", "boundaries.constrain", "u"),
    ("deform", "surface_volumes.heat_evened_cells", "even_z"), ("deform", "contact_volumes.contact_work", "checkerboard"),
    ("deform", "contact_checkerboard.damp_pressures", "room"), ("deform", "deformation.deform", "fz"),
    ("carry_bodies", "interfaces.interface_volumes", "flux_volume"), ("carry_bodies", "contact_volumes.contact_fluxes", "size"),
    ("carry_bodies", "remap.sweep_z", "flux"), ("carry_bodies", "audit_sums.sum_outflow", "edge_flux"),
    ("carry_momentum", "momentum.sweep_momentum", "flux_mass"), ("carry_momentum", "momentum.deposit", "deficit"),
    ("carry_momentum", "audit_sums.sum_kinetic_outflow", "cell_mass"),
    ("carry_momentum", "column_ranges.widen_ranges", "group_ranges"),
]
NEEDED = [*RARE, *(pytest.param(*each, marks=pytest.mark.slow) for each in OFTEN)]


@pytest.mark.thorough
@pytest.mark.parametrize(("phase", "kernel", "array"), NEEDED)
def test_a_barrier_that_is_missing_is_seen(monkeypatch, phase, kernel, array):
    seen = races(monkeypatch, "contact", barrier_before(phase, kernel))
    assert array in {touched for _, _, touched in seen.found}


def test_without_contact_sweeps_wait_for_the_volumes_of_mixed_cells(monkeypatch):
    """The third barrier reached; with contact it is the fifth, and `limit_fluxes` comes before it."""
    seen = races(monkeypatch, "slip-layer", ("carry_bodies", 3))
    assert "flux_volume" in {touched for _, _, touched in seen.found}
