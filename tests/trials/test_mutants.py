"""Changed decks: `check` accepts them or refuses them in words, and accepted ones stay within reach, or say so."""

import json
import tomllib

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.files import toml
from hydro2d.mesh.fields import RHO, E
from hydro2d.solver.simulation import Simulation
from tests.trials import campaign, mutants
from tests.trials.reach import Reach
from tests.trials.screen import Screen

#: the bodies of the short trial, and a gas that is shocked to its limit
FLAT, NOH = "shapes/flat.toml", "verification/noh_planar.toml"


#: changes of decks, with those of other places, after which a state is out of reach; they have an expected failure below
KNOWN = {("verification/coggeshall_2.toml", "thermal: shell_22.pressure 1000000000.0")}


def failures(numbers):
    """Judges mutants; returns the counts and a line for each failure that is not known."""
    failed = []

    def note(line):
        if line["ended"] not in campaign.SOUND and not {(line["deck"], change) for change in line["changes"]} & KNOWN:
            failed.append(json.dumps({key: value for key, value in line.items() if key != "warnings"}))

    return campaign.run(numbers, note), failed


def test_a_mutant_follows_from_its_number():
    assert mutants.mutant(17) == mutants.mutant(17)
    assert len({mutants.mutant(number)[2] for number in (*range(20), 4382)}) == 21  # in the last, a body to join is missing


@pytest.mark.parametrize("name", ["cth_nose_shape/hemi_5083_1086_layer.toml", "verification/sod_z.toml"])
def test_unchanged_decks_reach_nothing_impossible(name):
    assert campaign.judged(mutants.unchanged(name)) | {"message": "", "warnings": []} == {
        "ended": "trusted", "message": "", "beyond": {}, "warnings": []}


def test_all_decks_are_accepted_when_cut_down():
    for name in mutants.shipped():
        r, z = decks.edges(decks.loads(mutants.unchanged(name)))
        assert 0 < (len(r) - 1) * (len(z) - 1) < 1.1 * mutants.CELLS, name


def test_shocks_are_those_of_the_textbook():
    """A strong shock in a cold gas compresses by (gamma + 1)/(gamma - 1); one in a metal obeys Us = c0 + s up."""
    gas = Reach(Simulation(decks.loads(mutants.unchanged(NOH)))).materials[0]
    rho, e = gas.shocked(1.0, 0.0, 1.0)
    assert (rho, e) == (pytest.approx(4.0, rel=1e-3), pytest.approx(0.5, rel=1e-3))
    shot = Simulation(decks.loads(mutants.unchanged("verification/plate_impact_al_on_al.toml")))
    metal, rho0 = Reach(shot).materials[0], float(shot.table.rho0[0])
    rho, e = metal.shocked(rho0, 0.0, 500.0)
    assert e == pytest.approx(0.5 * 500.0**2, rel=1e-6)
    assert metal.pressure(rho, e) == pytest.approx(3.7839e9 * 2 * (5690 + 1.34 * 250) / 5690, rel=0.01)
    assert metal.released(rho, e) == pytest.approx(500.0, rel=0.02)


@pytest.mark.parametrize(("bound", "spoil"), [
    ("energy", lambda s, j, i: np.add.at(s.q[E, 1], (j, i), 1e7)),
    ("least energy", lambda s, j, i: np.put(s.q[E, 1], np.ravel_multi_index((j, i), s.q[E, 1].shape), -1e6)),
    ("0 K", lambda s, j, i: np.put(s.q[E, 1], np.ravel_multi_index((j, i), s.q[E, 1].shape), -3e5)),
    ("density", lambda s, j, i: np.multiply.at(s.q[RHO, 1], (j, i), 2.0)),
    ("density 0", lambda s, j, i: np.multiply.at(s.q[RHO, 1], (j, i), -1.0)),
    ("finite", lambda s, j, i: np.multiply.at(s.q[E, 1], (j, i), np.nan)),
    ("fractions", lambda s, j, i: np.multiply.at(s.vof[0], (j, i), 0.0) or np.add.at(s.vof[0], (j, i), 0.1)),
    ("speed", lambda s, j, i: np.multiply(s.v, 20.0, out=s.v)),
    ("mass", lambda s, j, i: np.multiply(s.q[RHO, 1], 1 + 1e-7, out=s.q[RHO, 1])),
])
def test_states_out_of_reach_are_found(bound, spoil):
    simulation = Simulation(decks.loads(mutants.unchanged(FLAT)))
    screen = Screen(simulation)
    for _ in range(10):
        simulation.step()
    assert screen.beyond() == {}
    g = simulation.grid.g
    full = np.argwhere(simulation.grid.interior(simulation.state.vof)[1] == 1.0)
    spoil(simulation.state, *(full[0] + g))
    assert bound in screen.beyond()


@pytest.mark.thorough
def test_a_process_that_hangs_is_replaced(monkeypatch):
    watched = campaign.Watched()
    try:
        assert watched(mutants.unchanged(NOH))["ended"] != "hang"
        monkeypatch.setattr(campaign, "LIMIT", 0.0)
        assert watched(mutants.unchanged(NOH))["ended"] == "hang"
        monkeypatch.undo()
        assert watched(mutants.unchanged(NOH))["ended"] != "hang"
    finally:
        watched.end()


@pytest.mark.thorough
def test_mutants():
    count, failed = failures(range(20))
    assert failed == [], "\n".join(failed)
    assert count["trusted"] > 5


@pytest.mark.thorough
@pytest.mark.xfail(reason="at the foot of a shock into gas a billion times colder, `both` takes more heat than the gas has: "
                   "wanted e > 0, got -54 kJ/kg, 4e-5 of the heat behind the shock", strict=True)
def test_gas_at_the_foot_of_a_strong_shock_is_not_colder_than_0_kelvin():
    ((name, change),) = KNOWN
    data = tomllib.loads(mutants.unchanged(name))
    body = next(body for body in data["body"] if f" {body['name']}.pressure" in change)
    body["pressure"] = float(change.split()[-1])
    assert campaign.judged(toml.dumps(data))["ended"] in campaign.SOUND


@pytest.mark.slow
def test_five_thousand_mutants(tell):
    count, failed = failures(range(5000))
    tell(f"5000 changed decks: {', '.join(f'{count[how]} {how}' for how in sorted(count))}; {len(failed)} failures")
    for line in failed:
        tell(line)
    assert failed == []
