"""`body.NAME.strength_factor`: the flow stress of a body times a number, whatever its law."""

import numpy as np
import pytest

from hydro2d.analytic import model_deck
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck as decks
from hydro2d.deck import identity
from hydro2d.solver.simulation import Simulation

QUICK = "problems/cth_nose_shape/hemi_5083_1086_quick.toml"
SOFT = ["body.rod.material=own", "materials.own.based_on=W_alloy", "materials.own.strength.model=elastic-plastic",
        "materials.own.strength.shear_modulus=160 GPa", "materials.own.strength.hardening_modulus=0 Pa"]
CYCLES = 40


def after(*overrides):
    """Deviators of the rod after some cycles: it yields before."""
    simulation = Simulation(decks.load(QUICK, [*SOFT, *overrides]))
    for _ in range(CYCLES):
        simulation.step()
    state = simulation.state
    assert state.ep[0].max() > 0.0
    return np.array([state.srr[0], state.szz[0], state.ep[0]])


def test_a_factor_is_the_same_as_a_stronger_material():
    plain, factor = "materials.own.strength.yield_stress=1 GPa", "body.rod.strength_factor=0.5"
    assert np.array_equal(after("materials.own.strength.yield_stress=0.5 GPa"), after(plain, factor))
    assert not np.array_equal(after(plain), after(plain, factor))


def test_without_a_factor_nothing_changes():
    plain = decks.load(QUICK)
    assert "strength_factor" not in plain.to_toml()
    assert identity.setup(plain) != identity.setup(decks.load(QUICK, ["body.rod.strength_factor=1.1"]))
    assert decks.strength_factors(plain).tolist() == [1.0, 1.0]
    assert decks.strength_factors(decks.load(QUICK, ["body.plate.strength_factor=0.9"])).tolist() == [1.0, 0.9]


@pytest.mark.parametrize(("overrides", "said"), [
    (["body.rod.strength_factor=0"], "must be positive"),
    (["body.rod.material=own", "materials.own.based_on=W_alloy", "materials.own.strength.model=hydrodynamic",
      "body.rod.strength_factor=1.1"], "own has no strength to scale"),
    ([*SOFT[:2], "materials.own.strength.model=kinematic-hardening", "materials.own.strength.shear_modulus=160 GPa",
      "materials.own.strength.yield_stress=1 GPa", "body.rod.strength_factor=1.1"],
     "the back stress of kinematic-hardening would not be scaled"),
])
def test_refusals(overrides, said):
    with pytest.raises(DeckError, match=said):
        decks.load(QUICK, overrides)


def test_analytic_models_say_that_they_do_not_know_it():
    with pytest.raises(DeckError, match='scales that of "plate"'):
        model_deck.shot(decks.load(QUICK, ["body.plate.strength_factor=0.9"]))
