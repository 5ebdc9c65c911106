"""Classic shots run as shipped: no deck of problems/classic sets a key of the method, and every run is trusted."""

import tomllib

import pytest

import hydro2d
from hydro2d.base.errors import UnphysicalState
from hydro2d.deck import deck as decks
from hydro2d.deck.sections import Numerics
from hydro2d.solver.simulation import Simulation
from problems.classic import table
from tests.verification.running import advection

FOLDER = "problems/classic"
#: a little more than the cycles after which `ke` fails in crater and bumper
SHORT = 150


def shot(name: str, *overrides: str):
    return decks.load(f"{FOLDER}/{name}.toml", list(overrides))


def begin(name: str, *overrides: str) -> Simulation:
    simulation = Simulation(shot(name, *overrides))
    while simulation.cycle < SHORT and simulation.time < simulation.deck.stop.time:
        simulation.step()
    return simulation


@pytest.mark.parametrize("name", table.MEASURES)
def test_a_shot_begins_with_all_defaults(name):
    text = decks.find(f"{FOLDER}/{name}.toml").read_text(encoding="utf-8")
    assert {"include", "numerics"}.isdisjoint(tables := tomllib.loads(text))
    assert tables.get("sliding", {"method": "none"}) == {"method": "none"}  # the default, said
    simulation = begin(name)
    simulation.refuse_nonsense()
    assert simulation.faults() + simulation.doubts() == []
    assert abs(simulation.conservation()["total_energy"]) < 1e-11


def test_a_slip_layer_beside_two_hard_bodies_conserves_energy():
    """Core and jacket share cells: in each, force and work belong to the same one of them."""
    simulation = begin("jacketed_rod", "sliding.method=slip-layer", 'sliding.hard=["core", "jacket"]',
                       "sliding.boundary_layer=2", "sliding.slip_layer=2", "sliding.yield_factor=radius")
    core, jacket, _ = simulation.array("volume_fraction")
    assert (core.clip(max=jacket) >= simulation.deck.sliding.threshold).any(), "no cell has enough of both"
    assert abs(simulation.conservation()["total_energy"]) < 1e-13


@pytest.mark.parametrize("name", ["crater", "bumper"])
def test_the_scheme_that_clips_fails_and_the_message_names_the_remedy(name):
    with pytest.raises(UnphysicalState, match='ke_bound has removed .*; try numerics.advection = "both"'):
        begin(name, advection("ke"))


@pytest.mark.slow
@pytest.mark.parametrize("name", table.MEASURES)
def test_a_whole_shot_is_trusted_and_gives_the_number_of_the_table(name, tmp_path):
    run = hydro2d.run(shot(name), tmp_path / name, quiet=True)
    assert run.summary["trustworthy"]
    kept = next(result for result in table.read(decks.find(f"{FOLDER}/{name}.toml").parent / "results" / "methods.csv")
                if (result.shot, result.sliding, result.advection) == (name, "none", Numerics().advection))
    assert table.MEASURES[name].of(run) == pytest.approx(kept.value, rel=0.02)
