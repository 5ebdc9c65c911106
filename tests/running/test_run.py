"""Runs end, are interrupted, and continue to the same bits."""

import json
import os
import socket
import time
from contextlib import nullcontext
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from hydro2d import jit
from hydro2d.base.interrupt import Interrupt
from hydro2d.deck.sections import Sliding
from hydro2d.files.locks import LockError
from hydro2d.jit import compilation
from hydro2d.output import history, snapshot, vtk
from hydro2d.output.directory import RunError
from hydro2d.running.run import exit_status, run
from hydro2d.solver.due import Due
from tests import fake
from tests.locks import held


def test_due_at_first_cycle_at_or_after_each_time():
    due = Due(1.0)
    assert [time for time in (0.0, 0.5, 0.99, 1.0, 1.2, 3.7, 3.9, 4.0) if due(time)] == [0.0, 1.0, 3.7, 4.0]


@pytest.mark.parametrize("interval", [0.1, 1e-7, 3e-6])
def test_due_survives_rounding(interval):
    due = Due(interval)
    assert all(due(k * interval) and not due(k * interval) for k in range(2000))


def test_run_directory(simulation, tmp_path):
    summary = run(fake.FakeDeck(), tmp_path / "a", quiet=True)
    assert summary["status"] == "done"
    assert exit_status(summary) == 0
    names = {path.name for path in (tmp_path / "a").iterdir()}
    assert {"deck.toml", "summary.json", "history.h5", "restart.h5", "log.txt", "series.pvd", "vtk"} <= names
    assert not [name for name in names if "tmp" in name]
    with h5py.File(tmp_path / "a" / "history.h5") as file:
        assert (tmp_path / "a" / "deck.toml").read_text().endswith(file.attrs["deck"])
        assert "[penetration]" in file.attrs["deck"]
        assert file.attrs["version"].startswith("hydro2d ")
        assert file.attrs["title"] == fake.FakeDeck().title
    stored = json.loads((tmp_path / "a" / "summary.json").read_text())
    for key in ("deck", "version", "stop_reason", "time_s", "cycles", "wall_s", "ns_per_cell_cycle", "cells",
                "penetration_depth_m", "nose_depth_m", "rod_length_m", "rod_mass_kg", "rod_max_plastic_strain",
                "rod_tail_velocity_m_s", "regime", "conservation"):
        assert key in stored
    assert stored["conservation"]["total_energy"] is None  # not finite, and still JSON


def test_a_run_begins_with_the_warnings(simulation, tmp_path, capsys):
    deck = fake.FakeDeck()
    run(deck, tmp_path / "a")
    assert "warning" not in capsys.readouterr().out
    deck.sliding = Sliding(method="slip-layer", hard=("rod",))
    run(deck, tmp_path / "b")
    for text in (capsys.readouterr().out, (tmp_path / "b" / "log.txt").read_text()):
        assert text.count('warning: sliding.yield_factor is "off"') == 1
        assert text.index("warning") < text.index("done: ")


def test_a_doubt_is_reported_when_it_is_found(simulation, tmp_path, capsys):
    """Once, also where the run is continued, and again at the end."""
    found = {10: 'cycle 10, time 1e-06 s: body "rod" is too hot', 120: 'cycle 120, time 1e-05 s: body "plate" is too cold'}
    simulation.doubts = lambda self: [doubt for cycle, doubt in found.items() if self.cycle >= cycle]
    run(fake.FakeDeck(), tmp_path, interrupt=interrupt_after(50, simulation))
    run(fake.FakeDeck(), tmp_path, restart=True)
    for text in (capsys.readouterr().out, (tmp_path / "log.txt").read_text()):
        for doubt in found.values():
            assert text.count(f"NOT TRUSTWORTHY from here on: {doubt}") == 1
        assert text.index(found[10]) < text.index("interrupted at") < text.index(found[120]) < text.index("done: ")


def test_existing_run_is_kept_without_overwrite(simulation, tmp_path):
    run(fake.FakeDeck(), tmp_path, quiet=True)
    with pytest.raises(RunError, match="--restart"):
        run(fake.FakeDeck(), tmp_path, quiet=True)
    (tmp_path / "mine.txt").write_text("not of a run")
    run(fake.FakeDeck(), tmp_path, overwrite=True, quiet=True)
    assert (tmp_path / "mine.txt").exists()


def interrupt_after(cycles, simulation):
    stop, step = Interrupt(), simulation.step

    def counted(self):
        step(self)
        if self.cycle == cycles:
            stop("SIGTERM")

    simulation.step = counted
    return stop


@pytest.mark.parametrize("cycles", [1, 37, 100])
def test_restart_gives_the_same_bits(simulation, tmp_path, cycles):
    run(fake.FakeDeck(), tmp_path / "whole", quiet=True)
    interrupt = interrupt_after(cycles, simulation)
    first = run(fake.FakeDeck(), tmp_path / "parts", quiet=True, interrupt=interrupt)
    assert first["status"] == "interrupted"
    assert exit_status(first) == 143
    assert first["cycles"] == cycles
    run(fake.FakeDeck(), tmp_path / "parts", restart=True, quiet=True)
    whole, parts = (tmp_path / name for name in ("whole", "parts"))
    one, two = (snapshot.read(path / "restart.h5") for path in (whole, parts))
    assert one.arrays["e"].tobytes() == two.arrays["e"].tobytes()
    assert one.scalars == two.scalars
    one, two = (history.read(path / "history.h5") for path in (whole, parts))
    assert one.keys() == two.keys()
    assert all(one[name].tobytes() == two[name].tobytes() for name in one)
    assert vtk.read_series(whole / "series.pvd") == vtk.read_series(parts / "series.pvd")
    for file in (whole / "vtk").iterdir():
        assert file.read_bytes() == (parts / "vtk" / file.name).read_bytes()


def test_restart_drops_rows_and_dumps_after_the_restart_point(simulation, tmp_path):
    """A run that went on after its last restart file, and was killed: later rows and dumps are written again."""
    run(fake.FakeDeck(), tmp_path, quiet=True, interrupt=interrupt_after(87, simulation))
    early = (tmp_path / "restart.h5").read_bytes()
    run(fake.FakeDeck(), tmp_path, restart=True, quiet=True)
    before = vtk.read_series(tmp_path / "series.pvd")
    (tmp_path / "restart.h5").write_bytes(early)
    (tmp_path / "summary.json").unlink()
    run(fake.FakeDeck(), tmp_path, restart=True, quiet=True)
    assert vtk.read_series(tmp_path / "series.pvd") == before
    times = history.read(tmp_path / "history.h5")["time"]
    assert np.all(np.diff(times) > 0)


def test_one_process_at_a_time(simulation, tmp_path):
    with held(tmp_path / "run.lock"), pytest.raises(LockError, match=f"in use by process {os.getppid()} on "):
        run(fake.FakeDeck(), tmp_path, quiet=True)
    (tmp_path / "run.lock").write_text("elsewhere 1")
    with pytest.raises(LockError, match="on elsewhere"):
        run(fake.FakeDeck(), tmp_path, quiet=True)
    (tmp_path / "run.lock").write_text(f"{socket.gethostname()} {os.getpid()}")  # left behind, and the number is in use again
    assert run(fake.FakeDeck(), tmp_path, quiet=True)["status"] == "done"
    assert not (tmp_path / "run.lock").exists()


def test_restart_refuses_another_deck(simulation, tmp_path):
    run(fake.FakeDeck(), tmp_path, quiet=True)
    other = fake.FakeDeck()
    other.courant = 0.4
    with pytest.raises(RunError, match="numerics"):
        run(other, tmp_path, restart=True, quiet=True)


def test_restart_may_extend_the_stop_time(simulation, tmp_path):
    run(fake.FakeDeck(), tmp_path, quiet=True)
    longer = fake.FakeDeck()
    longer.stop.time = 2 * fake.STOP
    assert run(longer, tmp_path, restart=True, quiet=True)["time_s"] >= 2 * fake.STOP


def test_due_continues_where_the_interval_has_changed():
    before, after = Due(1.0), Due(0.5)
    assert before(2.5)
    after.resume(before.saved(), 2.5)
    assert [time for time in (2.6, 3.0, 3.2, 3.6) if after(time)] == [3.0, 3.6]


def test_restart_without_a_file_is_one_clear_error(simulation, tmp_path):
    with pytest.raises(snapshot.SnapshotError, match="no restart file"):
        run(fake.FakeDeck(), tmp_path, restart=True, quiet=True)


def test_damaged_restart_falls_back_and_says_so(simulation, tmp_path):
    run(fake.FakeDeck(restart_interval=1e-9), tmp_path, quiet=True)
    (tmp_path / "restart.h5").write_bytes(b"\x89HDF nonsense")
    summary = run(fake.FakeDeck(), tmp_path, restart=True, quiet=True)
    assert summary["status"] == "done"
    assert "continuing from the one before" in (tmp_path / "log.txt").read_text()


def test_unphysical_state(simulation, tmp_path):
    simulation.fail_at = 7
    summary = run(fake.FakeDeck(), tmp_path, quiet=True)
    assert exit_status(summary) == 3
    assert "density -1" in summary["stop_reason"]
    assert snapshot.read(tmp_path / "restart.h5").scalars["cycle"] == 0


def test_plain_lines(simulation, tmp_path, capsys):
    run(fake.FakeDeck(), tmp_path)
    shown = capsys.readouterr().out
    assert "experiment          1.21 cm" in shown
    assert "rod at r = 0.5 mm" in shown
    assert "r is x" in shown


@pytest.mark.parametrize(("threads", "second", "helped"), [(1, None, False), (2, None, True), (1, True, True)])
def test_a_run_on_one_thread_compiles_in_one_process(simulation, tmp_path, monkeypatch, threads, second, helped):
    """A study asks for the second process, because its other workers wait meanwhile."""
    processes = []

    def announced(place, helped=None):
        processes.append(helped)
        return nullcontext()

    monkeypatch.setattr("hydro2d.jit.threads", lambda: threads)
    monkeypatch.setattr("hydro2d.jit.compilation.announced", announced)
    monkeypatch.setattr("hydro2d.running.run.Run", lambda *args, **named: SimpleNamespace(execute=lambda interrupt: {}))
    run(fake.FakeDeck(), tmp_path / "a", quiet=True, second=second)
    assert [deck is not None for deck in processes] == [helped]


def test_the_parts_of_a_runs_time_are_named(simulation, tmp_path, monkeypatch):
    """Each cycle takes 2 ms; the first waits another 50 ms for a kernel that another process compiles; a restart adds.

    The clock is moved by the waits alone, so that the times do not depend on what else the machine does.
    """
    now, step = [0.0], fake.Simulation.step
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])
    monkeypatch.setattr(compilation, "BEAT", 0.02)

    def slow(self):
        if self.cycle in (0, 100):
            with compilation.events.trigger_event(jit.FIRST_CALL, data={"kernel": "a"}):
                now[0] += 0.05
                while not compilation._listening[-1].happened:
                    time.sleep(0.001)
        now[0] += 0.002
        step(self)

    def stop(sim):
        now[0] += 0.001
        return _stop(sim, interrupt)

    monkeypatch.setattr(fake.Simulation, "step", slow)
    interrupt, deck = Interrupt(), fake.FakeDeck()
    first = run(deck, tmp_path / "a", quiet=True, interrupt=interrupt, columns={"x": stop})
    cycles, rows = first["cycles"], len(history.read(tmp_path / "a" / "history.h5")["time"])
    spent = {"compilation_s": 0.05, "cycles_s": 0.002 * cycles, "outputs_s": 0.001 * rows, "set_up_s": 0.0}
    assert {name: first[name] for name in spent} == pytest.approx(spent)
    assert first["wall_s"] == pytest.approx(sum(spent.values()))
    assert 1e-9 * first["ns_per_cell_cycle"] * first["cells"] == pytest.approx(0.002)
    last = run(deck, tmp_path / "a", quiet=True, restart=True, columns={"x": lambda sim: 0.0})
    assert last["cycles_s"] == pytest.approx(0.002 * last["cycles"])
    assert last["compilation_s"] == pytest.approx(0.05 * (1 + (cycles <= 100 < last["cycles"])))
    assert last["wall_s"] == pytest.approx(last["cycles_s"] + last["compilation_s"] + last["outputs_s"])


def _stop(sim, interrupt):
    if sim.cycle > 40:
        interrupt("SIGINT")
    return 0.0
