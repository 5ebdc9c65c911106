"""The largest stable time step: with it noise dies away, and with one a fifth longer it grows."""

import numpy as np
import pytest

import hydro2d
from hydro2d.physics.waves import STABLE
from hydro2d.solver.cycle import Cycle

#: m/s; so small that nothing yields
NOISE = 1.0
CYCLES = 150


def block(name: str, material: str, r: tuple[float, float], z: tuple[float, float]) -> str:
    return f"""
    [[body]]
    name = "{name}"
    material = "{material}"
    shape = "box"
    r = ["{r[0]} mm", "{r[1]} mm"]
    z = ["{z[0]} mm", "{z[1]} mm"]
    """


BLOCKS = {
    "block": block("a", "Al5083", (0, 14), (0, 14)),
    "free surfaces": block("a", "Al5083", (0, 10.3), (2.3, 11.7)),
    "bonded": block("a", "W_alloy", (0, 6.4), (0, 14)) + block("b", "Al5083", (6.4, 14), (0, 14)),
    "contact": block("a", "W_alloy", (0, 6.4), (3.4, 11.4)) + block("b", "Al5083", (6.4, 14), (0, 14)),
}


def energy_left(monkeypatch, name: str, linear: float, share: float) -> float:
    """Kinetic energy of random velocities in the second half of the cycles, at most, over that after the first cycle.

    share : of the largest stable step
    """
    sliding = '[sliding]\nmethod = "contact"\nhard = ["a"]' if name == "contact" else ""
    simulation = hydro2d.Simulation(hydro2d.Deck.from_toml(f"""
    title = "noise"
    [mesh]
    r = [{{ to = "14 mm", cells = 14 }}]
    z = [{{ to = "14 mm", cells = 14 }}]
    [boundaries]
    r_max = "wall"
    z_min = "wall"
    z_max = "wall"
    [numerics]
    active_region = false
    ramp_cycles = 0
    initial_dt_factor = 1.0
    viscosity_linear = {linear}
    [failure]
    tensile = "none"
    [stop]
    time = "1 ms"
    {sliding}
    {BLOCKS[name]}"""))
    engine = simulation.engine
    engine.watches.clear()  # noise that grows is what is wanted
    state, (j0, j1, i0, i1) = engine.state, engine.mesh_box
    random = np.random.default_rng(1)
    for component, fixed in ((state.u, np.s_[:, :, [i0, i1]]), (state.v, np.s_[:, [j0, j1]])):
        component[...] = np.where(state.mass > 0.0, NOISE * random.normal(size=component[:1].shape), 0.0)
        component[fixed] = 0.0
    engine.given.handle.update(courant=1.0)
    choose = Cycle.choose_step

    def shorter(cycle):
        choose(cycle)
        dt = share / STABLE * cycle.dt
        cycle.given.set(dt=dt, time=cycle.time + dt)

    monkeypatch.setattr(Cycle, "choose_step", shorter)
    left = []
    for _ in range(CYCLES):
        engine.advance()
        left.append(float((state.mass * (state.u**2 + state.v**2)).sum()))
    return max(left[CYCLES // 2 :]) / left[0]


@pytest.mark.parametrize(("name", "linear"), [pytest.param(name, linear, marks=pytest.mark.xfail(
    strict=True, reason="0.515 of the energy is left, 0.5 is wanted") if (name, linear) == ("bonded", 0.1) else ())
    for name in BLOCKS for linear in (0.1, 0.5, 2.0)])
def test_noise_dies_away_in_the_largest_step(monkeypatch, name, linear):
    assert energy_left(monkeypatch, name, linear, 1.0) < 0.5


def test_noise_grows_in_a_step_that_is_a_fifth_longer(monkeypatch):
    with np.errstate(all="ignore"):
        assert not energy_left(monkeypatch, "block", 0.0, 1.2) < 1e3


@pytest.mark.parametrize("linear", [0.5, 1.0])
def test_a_cell_has_no_more_viscosity_than_a_longer_step_carries(monkeypatch, linear):
    """The largest step is that of the deck's linear coefficient; a fifth beyond it, the coefficient of a cell is smaller."""
    assert energy_left(monkeypatch, "block", linear, 1.2) < 0.5
