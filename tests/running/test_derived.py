"""Derived quantities of a deck: refusals, with the line, and their values in the history and the summary."""

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.results.reading import Results
from hydro2d.running.run import run
from hydro2d.solver.simulation import Simulation

DECK = """
[mesh]
r = [{ to = "8 mm", cells = 16 }]
z_start = "-12 mm"
z = [{ to = "10 mm", cells = 44 }]
[[body]]
name = "ball"
material = "W_alloy"
shape = "sphere"
centre = "-5.1 mm"
radius = "5 mm"
velocity = "900 m/s"
[[body]]
name = "back plate"
material = "Al5083"
shape = "plate"
z_front = 0.0
thickness = "8 mm"
[[gauge]]
name = "rear"
r = 0.0
z = "8 mm"
surface = "back plate"
[stop]
cycles = 40
[output]
history_interval = "0.2 us"
vtk_interval = "1 s"
[derived]
"""


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('"P/L" = "depth / lengh0"', 'derived.P/L: unknown name "lengh0"; did you mean "length0"'),
        ('"P/L" = "depth + u"', "the units are m and m/s"),
        ('deep = "depth * 2"', 'is in m; call it "deep_m"'),
        ('deep_m_s = "depth * 2"', "is in m; the ending of the name says m/s"),
        ('deep_m = "depth / length"', "is a plain number, and the ending of the name says m"),
        ('odd = "depth ** 5"', "is in m^5, a unit that no quantity of a run has"),
        ('rod_length_m = "depth"', "is the name of another quantity"),
        ('time = "depth / u"', "is the name of another quantity"),
        ('"" = "depth / length"', "a name has 1 to 60 printable characters"),
        ('"/a" = "depth / length"', "is not allowed as the name"),
        ('crater = "depth / length"', "is not allowed as the name"),
        ('gauge_rear_x = "depth / length"', "is the name of another quantity"),
        ('"a/b" = "depth / length"\na_per_b = "1"', "is the name of another quantity"),
        ('a = "eval(1)"', 'unknown function "eval"'),
        ('a = 3', "string"),
    ],
)
def test_a_formula_that_is_wrong_is_refused_with_its_line(line, said):
    with pytest.raises(DeckError) as refused:
        decks.loads(DECK + line)
    assert said in str(refused.value)
    assert "deck.toml:3" in str(refused.value)


def test_without_a_projectile_there_is_no_depth():
    text = DECK.replace('"sphere"\ncentre = "-5.1 mm"\nradius = "5 mm"', '"box"\nr = [0.0, "5 mm"]\nz = ["-5 mm", "-1 mm"]')
    with pytest.raises(DeckError, match="where there is a projectile and a target short ones such as depth"):
        decks.loads(text + '"P/L" = "depth / length0"')
    assert decks.loads(text + "a_s = \"'body_back plate_z_max_m' / gauge_rear_velocity_z_m_s\"").derived


def test_the_values(tmp_path):
    lines = ('"P/L" = "depth / length0"', 'hole_m3 = "crater_volume_m3"', '"v/u" = "v / u"', 'never = "time / (time - time)"',
             'rear_m = "gauge_rear_z_m - \'8 mm\'"', "share = \"'body_back plate_kinetic_energy_J' / energy0\"")
    summary = run(decks.loads(DECK + "\n".join(lines)), tmp_path / "run", quiet=True)
    columns, results = Results(tmp_path / "run").history, summary["derived"]
    assert list(results) == ["P/L", "hole_m3", "v/u", "never", "rear_m", "share"]
    assert results["never"] is None
    assert np.isnan(columns["never"]).all()
    assert results["P/L"] == summary["penetration_depth_m"] / summary["projectile"]["initial_length_m"]
    assert results["P/L"] == summary["penetration_over_length"]
    assert results["hole_m3"] == summary["crater"]["volume_m3"] > 0.0
    start = summary["projectile"]["initial_kinetic_energy_J"]
    assert results["share"] == summary["bodies"]["back plate"]["kinetic_energy_J"] / start
    np.testing.assert_array_equal(columns["P/L"], columns["penetration_depth_m"] / columns["rod_initial_length_m"])
    assert columns["v/u"][-1] == pytest.approx(results["v/u"])
    assert Results(tmp_path / "run").to_pandas().attrs["units"]["hole_m3"] == "m3"


def test_the_efficiency_of_the_crater():
    sim = Simulation(decks.loads(DECK))
    for _ in range(60):
        sim.step()
    crater, ball = sim.of_targets()["back plate"]["crater"], sim.penetrator
    assert crater["efficiency"] == pytest.approx(crater["volume_m3"] * 2660.0 / ball.mass)
    assert crater["volume_per_energy_m3_J"] == pytest.approx(crater["volume_m3"] / (0.5 * ball.mass * 900.0**2), rel=1e-9)


def test_u_is_the_rate_of_the_depth():
    sim, depths, speeds, times = Simulation(decks.loads(DECK)), [], [], []
    while sim.time < 3e-6:
        sim.step()
        diagnostics = sim.diagnostics()
        depths.append(diagnostics["penetration_depth_m"])
        speeds.append(diagnostics["interface_velocity_m_s"])
        times.append(sim.time)
    begun = np.array(times) > 0.5e-6
    way = np.sum((np.array(speeds) * np.diff(times, prepend=0.0))[begun])
    assert way == pytest.approx(depths[-1] - depths[int(np.argmax(begun))], rel=0.03)
    assert 0.3 * 900.0 < speeds[-1] < diagnostics["rod_tail_velocity_m_s"]


def test_a_restart_may_change_derived_quantities(tmp_path):
    run(decks.loads(DECK, ["stop.cycles=20"]), tmp_path / "run", quiet=True)
    summary = run(decks.loads(DECK + '"P/L" = "depth / length0"'), tmp_path / "run", quiet=True, restart=True)
    assert summary["derived"]["P/L"] > 0.0
