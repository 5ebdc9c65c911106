"""Every shipped deck runs, and keeps the quantities that it must keep."""

import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from tests.rules import source

DECKS = [file for file in source.problems()[0] if not file.stem.startswith("_")]  # the others are parts
#: decks that `test_deck_ends` leaves out, by the beginning of folder/name, and why; times are those of one core
LONG = {
    "cth_nose_shape/": "one to five minutes each, 20 with the slip layer; twelve_shots.toml runs the shots",
    "validation/eroding_steel": "over a minute each; eroded_heads.toml runs them",
    "validation/copper_bar_32": "over a minute; the slow tests of tests/verification/test_copper_bar.py run it",
    "long_rods/rod_30": "about two minutes; velocities.toml runs it",
    "perforation/weldox": "six minutes and more each; weldox_velocities.toml is their study",
}
#: the first lines of a deck that is shipped to show how a run is ended
STATUS_3 = "ends with status 3"
QUICK = source.PROBLEMS / "cth_nose_shape" / "hemi_5083_1086_quick.toml"


def name_of(file) -> str:
    return f"{file.parent.name}/{file.stem}"


def left_out(file) -> bool:
    return file != QUICK and any(name_of(file).startswith(name) for name in LONG)


def test_there_are_decks():
    assert len(DECKS) > 8
    assert [name for name in LONG if not any(name_of(file).startswith(name) for file in DECKS)] == []
    assert sum(map(left_out, DECKS)) < len(DECKS) / 4


@pytest.mark.slow
@pytest.mark.parametrize("file", [file for file in DECKS if not left_out(file)], ids=name_of)
def test_deck_ends(file, tmp_path):
    """As shipped, by the command: it runs to its own end, unless its first lines say otherwise."""
    head = file.read_text(encoding="utf-8").split("\n\n")[0]
    status = call(["run", str(file), "--out", str(tmp_path / "run"), "--quiet"])
    assert status == (3 if STATUS_3 in head else 0)


@pytest.mark.thorough
@pytest.mark.parametrize("file", DECKS, ids=name_of)
def test_deck_runs(file):
    """Twenty cycles: no unphysical state, all losses in the audit, and no losses except through open edges."""
    simulation = Simulation(decks.load(file))
    for _ in range(20):
        simulation.step()
    s, g = simulation.state, simulation.grid
    vof = g.interior(s.vof)
    assert vof.min() >= 0.0
    assert vof.sum(axis=0).max() <= 1.0 + 1e-12
    assert np.all(g.interior(s.rho)[vof > 0] > 0.0)
    assert np.isfinite(g.interior_vertices(s.u)).all()
    assert np.isfinite(g.interior_vertices(s.v)).all()
    balance = simulation.conservation()
    assert max(abs(x) for x in balance["mass"].values()) < 1e-12
    assert abs(balance["axial_momentum"]) < 1e-12
    assert abs(balance["total_energy"]) < 1e-11
    # a deck that begins at rest has no energy at the start
    energy = balance["start_energy_J"] or balance["internal_energy_J"] + balance["kinetic_energy_J"]
    for name in ("cutoff", "speed_limit"):
        assert abs(balance["sinks"][name]["energy_J"]) < 1e-6 * energy, name


def test_quick_deck_begins_to_penetrate():
    """The quick deck on a rod and a plate cut short: the nose is in the plate, the rod as fast as before, nothing lost."""
    short = ["body.rod.length='20 mm'", "body.plate.thickness='40 mm'", "mesh.reach=none", "mesh.z_start='-24 mm'",
             "tracer=[]", "mesh.z=[{to=0.0, cells=42}, {cells=100, across='rod', cells_across=6}]"]
    simulation = Simulation(decks.load(QUICK, short))
    while simulation.time < 12e-6:
        simulation.step()
    diagnostics, balance = simulation.diagnostics(), simulation.conservation()
    assert 6e-3 < diagnostics["penetration_depth_m"] < 13e-3
    assert simulation.state.ep.max() > 0.5
    assert simulation.mean_velocity(0) > 800.0
    assert abs(balance["total_energy"]) < 1e-11
    assert max(abs(x) for x in balance["mass"].values()) < 1e-12
    assert abs(balance["sinks"]["advection"]["energy_J"]) < 0.05 * balance["start_energy_J"]
