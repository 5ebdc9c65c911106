"""Remaining time of a run."""

import fcntl
import io
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from contextlib import suppress
from types import SimpleNamespace

import pytest

from hydro2d.measure.summary import Summary
from hydro2d.output import ending
from hydro2d.output.history import Columns
from hydro2d.running import progress
from hydro2d.running.progress import FIRST_SECONDS, PACE_SECONDS, Clock, result


class Pace:
    """A run of `cycles` cycles that take the given times; the first compiles for ten minutes."""

    def __init__(self, cycles=10_000):
        self.now, self.sim = 0.0, SimpleNamespace(time=0.0, cycle=0, dt=0.0)
        self.clock = Clock(SimpleNamespace(time=None, cycles=cycles), clock=lambda: self.now)
        self.step(600.0)
        self.clock.begin(self.sim)

    def step(self, seconds):
        self.now += seconds
        self.sim.cycle += 1
        return self.clock.look(self.sim).left


def test_compilation_does_not_count():
    pace = Pace()
    assert pace.step(FIRST_SECONDS) == pytest.approx(FIRST_SECONDS * (10_000 - 2))


def test_the_short_steps_of_the_first_cycles_predict_no_long_run():
    """A hundred cycles per second, whose steps grow from 0.01 ns to 10 ns within 150 cycles: 100 us take 100 s, not days."""
    sim, now = SimpleNamespace(time=0.0, cycle=0, dt=1e-11), 0.0
    clock = Clock(SimpleNamespace(time=1e-4, cycles=None), clock=lambda: now)
    clock.begin(sim)
    for _ in range(1000):
        assert clock.look(sim).left is None or now >= FIRST_SECONDS
        now, sim.time, sim.cycle, sim.dt = now + 0.01, sim.time + sim.dt, sim.cycle + 1, min(1.05 * sim.dt, 1e-8)
        if now >= FIRST_SECONDS:
            assert clock.look(sim).left == pytest.approx((1e-4 - sim.time) / 1e-8 * 0.01, rel=1e-6)


def test_the_pace_is_that_of_the_last_minute():
    pace = Pace()
    for _ in range(100):
        pace.step(1.0)
    for _ in range(round(2.0 * PACE_SECONDS / 0.1)):
        left = pace.step(0.1)
    assert left == pytest.approx(0.1 * (10_000 - pace.sim.cycle), rel=0.01)


def test_without_an_end_time_nothing_is_known():
    clock = Clock(SimpleNamespace(time=None, cycles=None))
    clock.begin(SimpleNamespace(time=1.0, cycle=5))
    assert clock.look(SimpleNamespace(time=2.0, cycle=10)) == (None, None, None)


def test_before_the_first_cycle_is_over_nothing_is_known():
    clock = Clock(SimpleNamespace(time=1.0, cycles=None))
    assert clock.look(SimpleNamespace(time=0.1, cycle=1)).left is None


def test_the_end_is_the_one_predicted_by_status():
    """A rod that slows by 2e6 m/s2 from 1000 m/s is below 10 m/s at 495 us, long before the end time."""
    stop = {"time": 1e-3, "cycles": None, "body": "rod", "speed_below": 10.0, "rebound": False}
    columns, now, clock = Columns(), 0.0, None
    sim = SimpleNamespace(time=0.0, cycle=0, dt=0.0)
    clock = Clock(SimpleNamespace(**stop), columns, lambda: now)
    clock.begin(sim)
    for number in range(41):
        sim.time, sim.cycle, now = number * 2.5e-6, 50 * number, 2.0 * number
        columns.append({"time": sim.time, "cycle": sim.cycle, "rod_core_velocity_m_s": 1000.0 - 2e6 * sim.time})
        predicted = clock.look(sim)
        if number == 2:  # too few rows
            assert progress.how_far(sim, predicted) == "5.000 us of 1000.000 us (0.5 %)"
    assert progress.how_far(sim, predicted) == "100.000 us of about 495.000 us (20.2 %; speed below 10 m/s)"
    assert predicted.left == pytest.approx(395.0 / 1.25)
    assert predicted.end == next(iter(sorted(ending.ends(stop, columns.arrays()), key=lambda each: each.time)))


def test_the_number_of_cycles_counts_where_it_comes_first():
    clock = Clock(SimpleNamespace(time=1.0, cycles=10), clock=lambda: 0.0)
    sim = SimpleNamespace(time=0.1, cycle=5)
    assert progress.how_far(sim, clock.look(sim)) == "100.000 ms (50.0 % of the cycles)"
    sim.time = 0.9
    assert progress.how_far(sim, clock.look(sim)).endswith("of 1000.000 ms (90.0 %)")


def test_the_table_is_whole_on_a_narrow_terminal(tmp_path):
    """Text that does not fit on a line continues on the next."""
    from rich.console import Console

    report, cause = progress.Live(io.StringIO(), quiet=False), "sound at r = 123.456 mm, z = -123.456 mm, in the rod (ramp)"
    sim = SimpleNamespace(time=1e-6, cycle=7, dt=1e-9, dt_cause=cause, projectile="ball",
                          diagnostics=lambda: {}, conservation=lambda: {"mass": {}, "axial_momentum": 0.0, "total_energy": 0.0})
    run = SimpleNamespace(sim=sim, clock=Clock(SimpleNamespace(time=1e-3, cycles=None)))
    console = Console(width=40, file=io.StringIO())
    console.print(report._picture(run))
    shown = "".join(line.strip() for line in console.file.getvalue().splitlines())
    assert cause.replace(" ", "") in shown.replace(" ", "")


#: two states of a run, and a line that moves, on a terminal
ON_A_TERMINAL = """
import io, sys, time
from types import SimpleNamespace
from hydro2d.output import ending
from hydro2d.running import progress
progress.TABLE_SECONDS = 0.0
sim = SimpleNamespace(time=1.23e-5, cycle=1234567, dt=1.234e-9, dt_cause="rod at r = 1.3 mm: sound", projectile="rod",
                      diagnostics=lambda: {}, conservation=lambda: {"mass": {}, "axial_momentum": 0.0, "total_energy": 0.0})
look = progress.Outlook(ending.End("speed below 12.5 m/s at its present deceleration", 123.456e-6), 0.2, 1000.0)
run = SimpleNamespace(sim=sim, clock=SimpleNamespace(look=lambda sim: look))
report = progress.Live(io.StringIO(), quiet=False)
report._last = 1e9
report.move("compiling kernels: 1 of 3, 2 s", 0.3)
time.sleep(0.4)
report.rest("")
for _ in range(2):
    report.update(run)
    time.sleep(0.4)
report.move("compiling kernels: 2 of 3, 3 s", 0.6)
time.sleep(0.4)
report.close()
"""


def recorded(code, columns):
    """The lines that a program writes to a terminal of so many columns, without cursor movements."""
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    about = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES", "NO_COLOR")}
    child = subprocess.Popen([sys.executable, "-c", code], stdin=follower, stdout=follower, stderr=follower,
                             env=about | {"TERM": "xterm"})
    os.close(follower)
    data = b""
    with suppress(OSError):  # the terminal is gone with the last process that uses it
        while more := os.read(leader, 65536):
            data += more
    os.close(leader)
    assert child.wait(60) == 0
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", data.decode())
    return [line for part in text.split("\n") for line in part.split("\r") if line.strip()]


@pytest.mark.parametrize("columns", [80, 120])
def test_bar_and_rows_have_lines_of_their_own_on_a_terminal(columns):
    lines = recorded(ON_A_TERMINAL, columns)
    bars = [line for line in lines if "━" in line]
    assert bars
    assert {len(line.rstrip()) for line in bars} == {60}
    times = {line.rstrip() for line in lines if line.startswith("time ")}
    assert times == {"time      12.300 us of about 123.456 us (20.0 %; speed below 12.5 m/s)"}
    assert "compiling kernels: 1 of 3, 2 s" in [line.rstrip() for line in lines]
    assert "compiling kernels: 2 of 3, 3 s" in [line.rstrip() for line in lines]
    assert max(map(len, lines)) <= columns


#: a closing line and a command that are longer than a line
LONG = """
import io
from hydro2d.running import progress
report = progress.Live(io.StringIO(), quiet=False)
report.line("450 cycles to 12.249 us in 1.2 s (535.1 ns per cell and cycle, cycles alone); "
            "compilation 6 min 30 s, outputs 1.4 s")
report.line("interrupted at 26.800 us; continue with: hydro2d run problems/perforation/sphere.toml --out runs/ball --restart")
report.close()
"""


def test_lines_break_at_words_on_a_terminal_and_commands_stay_whole():
    lines = recorded(LONG, 80)
    assert [line.rstrip() for line in lines[:2]] == [
        "450 cycles to 12.249 us in 1.2 s (535.1 ns per cell and cycle, cycles alone);",
        "compilation 6 min 30 s, outputs 1.4 s"]
    assert lines[2].endswith("hydro2d run problems/perforation/sphere.toml --out runs/ball --restart")


def closing(theory=(), **changes):
    """The last lines for a bar that was 25.4 mm long, with a gauge and a derived quantity."""
    body = {"velocity_m_s": 0.0, "kinetic_energy_J": 0.0, "initial_length_m": 25.4e-3, "length_m": 17.43e-3, "r_max_m": 6.6e-3,
            "outflow_kg": 0.0, "radius_at_z_min_m": 6.6e-3, "radius_at_z_max_m": 3.81e-3}
    station = {"peak_pressure_Pa": 3.21e9, "peak_pressure_time_s": 1.5e-6, "peak_speed_m_s": 190.0}
    return result(Summary(**{
        "status": "done", "stop_reason": "end time", "faults": [], "cycles": 9, "time_s": 6e-5, "wall_s": 3.0,
        "cycles_s": 2.5, "compilation_s": 0.0, "outputs_s": 0.01, "set_up_s": 0.0,
        "ns_per_cell_cycle": None, "penetration_depth_m": None, "projectile": None, "bodies": {"bar": body},
        "stations": {"gauge_wall": station}, "derived": {"P/L": 0.5, "hole_m": None},
        "conservation": {"mass": {"bar": 0.0}, "axial_momentum": 0.0, "total_energy": 0.0}, **changes,
    }), theory)


def test_the_last_lines_name_compilation_cycles_and_outputs_separately():
    """The pace is that of the cycles; parts that took no time are not named."""
    assert closing()[:2] == ["done: end time", "9 cycles to 60.000 us in 2.5 s"]
    costs = {"cycles": 450, "time_s": 26.8e-6, "cycles_s": 3.14, "compilation_s": 77.2, "outputs_s": 0.41, "set_up_s": 151.0,
             "ns_per_cell_cycle": 31.24}
    assert closing(**costs)[1] == (
        "450 cycles to 26.800 us in 3.1 s (31.2 ns per cell and cycle, cycles alone); "
        "compilation 1 min 17 s, set-up 2 min 31 s, outputs 0.4 s")


@pytest.mark.parametrize(("command", "again"), [
    ("hydro2d run shot.toml --out 'a b' --set x=1 --overwrite", "hydro2d run shot.toml --out 'a b' --set x=1 --restart"),
    ("python -m hydro2d run shot.toml --restart", "python -m hydro2d run shot.toml --restart"),
    ("python shot.py", "hydro2d.run(..., restart=True)"), ("pytest run", "hydro2d.run(..., restart=True)")])
def test_the_last_lines_of_an_interrupted_run_say_how_it_continues(command, again):
    said = closing(status="interrupted", stop_reason="interrupted (SIGINT)", time_s=26.8e-6, provenance={"command": command})
    assert said[0] == f"interrupted at 26.800 us (SIGINT); continue with: {again}"
    full = "history.h5: No space left on device"
    assert closing(status="interrupted", stop_reason=full)[0] == f"interrupted: {full}"


def test_the_last_lines_give_the_length_and_the_ends_of_a_bar():
    said = closing()
    assert "bar length            17.43 mm of 25.40 mm, 0.686; radius 6.60 mm at the wider end, 3.81 mm at the other" in said
    same = {"bar": {"velocity_m_s": 0.0, "kinetic_energy_J": 0.0, "initial_length_m": 25.4e-3, "length_m": 25.399e-3,
                    "outflow_kg": 0.0, "r_max_m": 3e-3, "radius_at_z_min_m": 3e-3, "radius_at_z_max_m": 3e-3}}
    assert not any("wider" in line for line in closing(bodies=same))
    short = {"tube": same["bar"] | {"length_m": 9e-3}}
    assert any("wider" in line for line in closing(bodies=short))
    short["tube"]["outflow_kg"] = 1e-6  # some of it has left the mesh
    assert not any("wider" in line for line in closing(bodies=short))


def test_the_last_lines_tell_a_ball_from_a_rod_and_a_depth_from_a_hole():
    """P/D of a ball, P/L of a rod; behind the last target no depth is given."""
    back = {"mass_kg": 2e-3, "momentum_N_s": 0.42, "momentum_multiplication": 1.21}
    stopped = {"exit_time_s": None, "damage_class": "none", "crater": {"hole_diameter_m": None}, "ejecta": back}
    ball = {"body": "ball", "length_m": 9e-3, "initial_length_m": 9.98e-3, "initial_radius_m": 5e-3, "max_plastic_strain": 0.4}
    shot = {"penetration_depth_m": 14.7e-3, "nose_depth_m": 14.7e-3, "penetration_over_length": 1.473, "experiment": None,
            "regime": "deforming", "projectile": ball | {"tail_velocity_m_s": None},
            "targets": {"first": stopped}, "outcome": {"perforated": False}}
    assert "penetration depth     1.47 cm, P/D 1.473" in closing(**shot)
    assert "penetration depth     1.47 cm, P/D 1.473; 0.81 cm at the end" in closing(**shot | {"nose_depth_m": 8.1e-3})
    short = shot | {"status": "done", "stop_reason": "end time", "rod_core_velocity_m_s": 763.2, "outcome": {"final": False}}
    assert {"done: end time, still moving at 763 m/s", "depth so far          1.47 cm, P/D 1.473"} <= set(closing(**short))
    theory = "analytic, at rest     Tate 1.83 cm"
    said = closing([theory], **shot)
    assert said[said.index(theory) - 1].startswith("penetration depth")
    rod = shot | {"projectile": shot["projectile"] | {"initial_length_m": 50e-3}}
    assert "penetration depth     1.47 cm, P/L 1.473" in closing(**rod)
    through = stopped | {"exit_time_s": 1e-6, "exit_velocity_m_s": 9.0, "exit_mass_kg": 1e-3}
    one = closing(**shot | {"targets": {"first": through, "second": stopped}})
    assert any(line.startswith("penetration depth") for line in one)
    both = closing(**shot | {"nose_depth_m": 14.6e-3, "targets": {"first": through, "second": through},
                             "outcome": {"perforated": True}})
    assert "perforated            first, second; nose 1.46 cm beyond the front face of first" in both
    assert "regime                deforming (shape of the ball, which went through)" in both
    assert "regime                deforming" in said
    assert not any(line.startswith("penetration depth") for line in both)
    assert "ejecta                2 g, 0.42 N s; momentum multiplication 1.210" in said
    assert not any(line.startswith("damage") for line in said)
    opened = stopped | {"damage_class": "perforated", "crater": {"hole_diameter_m": 6.4e-3},
                        "ejecta": back | {"momentum_multiplication": None}}
    holed = closing(**shot | {"targets": {"first": opened}})
    assert "damage of first       perforated, hole of 6.40 mm at its narrowest" in holed
    assert not any(line.startswith("ejecta") for line in holed)
    assert any(line.startswith("penetration depth") for line in holed)
    spalled = closing(**shot | {"targets": {"first": stopped | {"damage_class": "attached spall"}}})
    assert "damage of first       attached spall" in spalled


def test_the_last_lines_give_peaks_and_derived_quantities():
    said = closing()
    assert "P/L                   0.5" in said
    assert "hole_m                - m" in said
    assert "gauge wall            peak pressure 3.21 GPa at 1.500 us, peak speed 190 m/s" in said
    many = {f"gauge_{n}": {"peak_pressure_Pa": 1.0, "peak_pressure_time_s": 0.0, "peak_speed_m_s": 0.0} for n in range(15)}
    assert "3 more tracers and gauges are in summary.json" in closing(stations=many)


@pytest.mark.parametrize(("quiet", "seconds", "said"), [
    (False, 2.0, "decks read: 2 of 6\ndecks read: 5 of 6\n"), (True, 2.0, ""), (False, 0.1, "")])
def test_long_tasks_are_counted_on_stderr(monkeypatch, capsys, quiet, seconds, said):
    now = (seconds * n for n in range(1000))
    monkeypatch.setattr(progress.clock, "monotonic", lambda: next(now))
    assert list(progress.counted(range(6), "decks read", quiet)) == list(range(6))
    assert capsys.readouterr().err == said


def test_the_last_lines_say_what_moves():
    """The largest energy first; bodies at rest are left out."""
    known = {"plate": (-0.04, 40.0), "rod": (3.5, 900.0), "wall": (1e-9, 1e-15), "gone": (None, 0.0)}
    bodies = {name: {"velocity_m_s": speed, "kinetic_energy_J": energy} for name, (speed, energy) in known.items()}
    said = progress._moving(Summary(bodies=bodies, projectile={"body": "rod", "tail_velocity_m_s": 355.2}))
    assert said == "rod 3.5 m/s, 900 J; plate 0.0 m/s, 40 J; tail of the rod 355.2 m/s"
    assert progress._moving(Summary(bodies={"wall": {"velocity_m_s": 0.0, "kinetic_energy_J": 0.0}})) == ""
