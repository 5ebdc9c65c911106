"""Depths by analytic models, printed with the depth of a run."""

import pytest

from hydro2d.analytic import beside, model_deck, models
from hydro2d.deck import deck as decks
from hydro2d.measure.summary import Summary
from hydro2d.penetration.model import InputError

ROD = "problems/cth_nose_shape/hemi_5083_1086.toml"


def test_the_depths_are_those_of_the_command_model():
    deck = decks.load(ROD)
    shot = model_deck.read(ROD)
    request = models.Request(rod=shot.rod, target=shot.target, geometry=shot.values)
    for name, shown in beside.SHOWN.items():
        (row,) = models.resolve(models.named(name), request).rows([1086.0])
        assert beside.depths(deck)[shown] == row["depth"]
    assert beside.lines(deck, Summary(targets={"plate": {"exit_time_s": None}})) == [
        "analytic, at rest     Tate 27.54 cm, Walker-Anderson 35.87 cm, rigid 49.54 cm"]


def test_behind_a_target_nothing_is_said():
    assert beside.lines(decks.load(ROD), Summary(outcome={"perforated": True})) == []


@pytest.mark.parametrize("name", ["templates/jacketed", "ceramics/tile", "perforation/sphere", "templates/taylor"])
def test_only_a_rod_into_one_target_has_analytic_depths(name):
    assert beside.depths(decks.load(f"problems/{name}.toml")) == {}


def test_a_model_that_lacks_an_input_is_left_out():
    """A target without strength has no Young's modulus, and Tate's model asks for one."""
    deck = decks.load(ROD, ['body.plate.material="Al_fluid"', 'materials.Al_fluid.based_on="Al5083"',
                            'materials.Al_fluid.strength.model="hydrodynamic"'])
    with pytest.raises(InputError):
        beside.case("tate", model_deck.shot(deck))
    assert "Tate" not in beside.depths(deck)
