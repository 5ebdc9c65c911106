"""How long a run still takes."""

import io
from types import SimpleNamespace

import pytest

from hydro2d.output.history import Columns
from hydro2d.running import ending, progress
from hydro2d.running.progress import PACE_SECONDS, Clock, result


class Pace:
    """A run of `cycles` cycles whose cycles take what it is told; the first compiles for ten minutes."""

    def __init__(self, cycles=10_000):
        self.now, self.sim = 0.0, SimpleNamespace(time=0.0, cycle=0)
        self.clock = Clock(SimpleNamespace(time=None, cycles=cycles), clock=lambda: self.now)
        self.step(600.0)
        self.clock.begin(self.sim)

    def step(self, seconds):
        self.now += seconds
        self.sim.cycle += 1
        return self.clock.look(self.sim).left


def test_compilation_does_not_count():
    pace = Pace()
    assert pace.step(0.01) == pytest.approx(0.01 * (10_000 - 2))


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


def test_the_end_is_that_which_status_foresees():
    """A rod that slows by 2e6 m/s2 from 1000 m/s is below 10 m/s at 495 us, long before the end time."""
    stop = {"time": 1e-3, "cycles": None, "body": "rod", "speed_below": 10.0, "rebound": False}
    columns, now, clock = Columns(), 0.0, None
    sim = SimpleNamespace(time=0.0, cycle=0)
    clock = Clock(SimpleNamespace(**stop), columns, lambda: now)
    clock.begin(sim)
    for number in range(41):
        sim.time, sim.cycle, now = number * 2.5e-6, 50 * number, 2.0 * number
        columns.append({"time": sim.time, "cycle": sim.cycle, "rod_core_velocity_m_s": 1000.0 - 2e6 * sim.time})
        found = clock.look(sim)
        if number == 2:  # too few rows
            assert progress.how_far(sim, found) == "5.000 us of 1000.000 us (0.5 %)"
    assert progress.how_far(sim, found) == "100.000 us of about 495.000 us (20.2 %; speed below 10 m/s as it slows now)"
    assert found.left == pytest.approx(395.0 / 1.25)
    assert found.end == next(iter(sorted(ending.ends(stop, columns.arrays()), key=lambda each: each.time)))


def test_the_number_of_cycles_counts_where_it_comes_first():
    clock = Clock(SimpleNamespace(time=1.0, cycles=10), clock=lambda: 0.0)
    sim = SimpleNamespace(time=0.1, cycle=5)
    assert progress.how_far(sim, clock.look(sim)) == "100.000 ms (50.0 % of the cycles)"
    sim.time = 0.9
    assert progress.how_far(sim, clock.look(sim)).endswith("of 1000.000 ms (90.0 %)")


def test_the_table_is_whole_on_a_narrow_terminal(tmp_path):
    """What does not fit on a line goes on in the next."""
    from rich.console import Console

    report, cause = progress.Live(io.StringIO(), quiet=False), "sound at r = 123.456 mm, z = -123.456 mm, in the rod (ramp)"
    sim = SimpleNamespace(time=1e-6, cycle=7, dt=1e-9, dt_cause=cause, projectile="ball",
                          diagnostics=lambda: {}, conservation=lambda: {"mass": {}, "axial_momentum": 0.0, "total_energy": 0.0})
    run = SimpleNamespace(sim=sim, clock=Clock(SimpleNamespace(time=1e-3, cycles=None)))
    console = Console(width=40, file=io.StringIO())
    console.print(report._picture(run))
    shown = "".join(line.strip() for line in console.file.getvalue().splitlines())
    assert cause.replace(" ", "") in shown.replace(" ", "")


def closing(**changes):
    """The last lines of a bar that was 25.4 mm long, with a gauge and a derived quantity."""
    body = {"velocity_m_s": 0.0, "kinetic_energy_J": 0.0, "initial_length_m": 25.4e-3, "length_m": 17.43e-3, "r_max_m": 6.6e-3,
            "outflow_kg": 0.0, "radius_at_z_min_m": 6.6e-3, "radius_at_z_max_m": 3.81e-3}  # fmt: skip
    station = {"peak_pressure_Pa": 3.21e9, "peak_pressure_time_s": 1.5e-6, "peak_speed_m_s": 190.0}
    return result({
        "status": "done", "stop_reason": "end time", "faults": [], "cycles": 9, "time_s": 6e-5, "wall_s": 3.0,
        "ns_per_cell_cycle": None, "penetration_depth_m": None, "projectile": None, "bodies": {"bar": body},
        "stations": {"gauge_wall": station}, "derived": {"P/L": 0.5, "hole_m": None},
        "conservation": {"mass": {"bar": 0.0}, "axial_momentum": 0.0, "total_energy": 0.0}, **changes,
    })  # fmt: skip


def test_the_last_lines_give_the_length_and_the_ends_of_a_bar():
    said = closing()
    assert "bar length            17.43 mm of 25.40 mm, 0.686; radius 6.60 mm at the wider end, 3.81 mm at the other" in said
    same = {"bar": {"velocity_m_s": 0.0, "kinetic_energy_J": 0.0, "initial_length_m": 25.4e-3, "length_m": 25.399e-3,
                    "outflow_kg": 0.0, "r_max_m": 3e-3, "radius_at_z_min_m": 3e-3, "radius_at_z_max_m": 3e-3}}  # fmt: skip
    assert not any("wider" in line for line in closing(bodies=same))
    short = {"tube": same["bar"] | {"length_m": 9e-3}}
    assert any("wider" in line for line in closing(bodies=short))
    short["tube"]["outflow_kg"] = 1e-6  # some of it has left the mesh
    assert not any("wider" in line for line in closing(bodies=short))


def test_the_last_lines_tell_a_ball_from_a_rod_and_a_depth_from_a_hole():
    """P/D of a ball, P/L of a rod; behind the last target there is no depth."""
    ball = {"body": "ball", "length_m": 9e-3, "initial_length_m": 9.98e-3, "initial_radius_m": 5e-3, "max_plastic_strain": 0.4}
    shot = {"penetration_depth_m": 14.7e-3, "nose_depth_m": 14.7e-3, "penetration_over_length": 1.473, "experiment": None,
            "regime": "deforming", "projectile": ball | {"tail_velocity_m_s": None},
            "targets": {"first": {"exit_time_s": None}}}  # fmt: skip
    assert "penetration depth     1.47 cm, P/D 1.473" in closing(**shot)
    assert "penetration depth     1.47 cm, P/D 1.473; 0.81 cm at the end" in closing(**shot | {"nose_depth_m": 8.1e-3})
    rod = shot | {"projectile": shot["projectile"] | {"initial_length_m": 50e-3}}
    assert "penetration depth     1.47 cm, P/L 1.473" in closing(**rod)
    through = {"exit_time_s": 1e-6, "exit_velocity_m_s": 9.0, "exit_mass_kg": 1e-3}
    one = closing(**shot | {"targets": {"first": through, "second": {"exit_time_s": None}}})
    assert any(line.startswith("penetration depth") for line in one)
    both = closing(**shot | {"nose_depth_m": 14.6e-3, "targets": {"first": through, "second": through}})
    assert "gone through          first, second; nose 1.46 cm behind the first face" in both
    assert not any(line.startswith("penetration depth") for line in both)


def test_the_last_lines_give_peaks_and_derived_quantities():
    said = closing()
    assert "P/L                   0.5" in said
    assert "hole_m                - m" in said
    assert "gauge wall            peak pressure 3.21 GPa at 1.500 us, peak speed 190 m/s" in said
    many = {f"gauge_{n}": {"peak_pressure_Pa": 1.0, "peak_pressure_time_s": 0.0, "peak_speed_m_s": 0.0} for n in range(15)}
    assert "3 more tracers and gauges are in summary.json" in closing(stations=many)


@pytest.mark.parametrize(("quiet", "seconds", "said"), [
    (False, 2.0, "decks read: 2 of 6\ndecks read: 5 of 6\n"), (True, 2.0, ""), (False, 0.1, "")])
def test_what_takes_long_is_counted_on_stderr(monkeypatch, capsys, quiet, seconds, said):
    now = (seconds * n for n in range(1000))
    monkeypatch.setattr(progress.clock, "monotonic", lambda: next(now))
    assert list(progress.counted(range(6), "decks read", quiet)) == list(range(6))
    assert capsys.readouterr().err == said


def test_the_last_lines_say_what_moves():
    """The fastest by energy first; what stands still is left out."""
    known = {"plate": (3.0, 40.0), "rod": (3.5, 900.0), "wall": (1e-9, 1e-15), "gone": (None, 0.0)}
    bodies = {name: {"velocity_m_s": speed, "kinetic_energy_J": energy} for name, (speed, energy) in known.items()}
    said = progress._moving({"bodies": bodies, "projectile": {"body": "rod", "tail_velocity_m_s": 355.2}})
    assert said == "rod 3.5 m/s, 900 J; plate 3.0 m/s, 40 J; tail of the rod 355.2 m/s"
    assert progress._moving({"bodies": {"wall": {"velocity_m_s": 0.0, "kinetic_energy_J": 0.0}},
                             "projectile": None}) == ""
