"""Typical mistakes that a deck may contain: what is warned of, what is refused, and what is said of it."""

import pytest

import hydro2d
from hydro2d.deck import deck as decks
from hydro2d.deck.mistakes import mistakes
from hydro2d.deck.warnings import warnings
from hydro2d.files import toml


def said(*overrides, deck="problems/templates/rod.toml"):
    return list(mistakes(decks.load(deck, overrides)))


@pytest.mark.parametrize(("overrides", "words"), [
    (('body.rod.velocity="-2.07 km/s"',), 'body "rod": flies away from "block", at -2070 m/s along z; turn the sign'),
    (('sliding.hard=["block"]',), 'sliding.hard: "block" yields at 1.21 GPa and "rod", which is not hard, at 3.53 GPa'),
    (('body.rod.strength_factor=0.3',), '"rod" yields at 1.06 GPa and "block", which is not hard, at 1.21 GPa'),
    (('body.rod.velocity="50 km/s"', 'stop.time="5 us"'), "an impact at 50 km/s vaporises solids, and mie-grueneisen, of"),
    (('stop.time="200 s"',), "stop.time: in 200 s a body at 2070 m/s flies 4.14e+05 m, and the deck is 0.208 m long; look at"),
])
def test_what_is_hardly_meant_is_warned_of(overrides, words):
    (message,) = said(*overrides)
    assert words in message
    assert "\n" not in message
    assert message in warnings(decks.load("problems/templates/rod.toml", overrides))


@pytest.mark.parametrize("overrides", [
    (), ('body.rod.velocity="9 km/s"',), ('stop.time="1 ms"',), ('sliding.hard=["rod"]', 'body.block.strength_factor=2'),
])
def test_what_may_be_meant_is_not(overrides):
    assert said(*overrides) == []


def test_a_rod_without_sliding_is_tied_unless_the_deck_says_so(tmp_path):
    text = "\n".join(line for line in open("problems/templates/rod.toml", encoding="utf-8").read().splitlines()
                     if not line.startswith(("[sliding]", 'method = "contact"', 'hard = ["rod"]')))
    deck = tmp_path / "tied.toml"
    deck.write_text(text)
    (message,) = said(deck=deck)
    assert message.startswith('sliding: is not given, so that "rod" and "block" are tied where they touch; method = "contact"')
    assert said('sliding.method="none"', deck=deck) == []
    resolved = tmp_path / "resolved.toml"
    resolved.write_text(decks.load(deck).to_toml())
    assert said(deck=resolved) == []


@pytest.mark.parametrize("shot", ["classic/long_rod", "validation/jet_cu_cu_3", "hypervelocity/benchmark", "perforation/sphere",
                                  "verification/plate_impact_melting", "cth_nose_shape/hemi_5083_1086", "ceramics/tile"])
def test_shipped_decks_have_none(shot):
    assert said(deck=f"problems/{shot}.toml") == []


@pytest.mark.parametrize("cells", ["0.1", "0.99"])
def test_less_than_a_cell_is_refused(cells):
    with pytest.raises(hydro2d.DeckError, match=rf"mesh.cells_across: must lie between 1 and 1e\+06, is {cells}"):
        said(f"mesh.cells_across={cells}")


@pytest.mark.parametrize(("name", "family", "other"), [
    ("aluminium", ["Al2024_T351", "Al6061_T6", "Al_tillotson"], "aluminium_nitride"), ("Aluminum", ["Al5083"], "alumina"),
    ("copper", ["copper_OFHC", "Cu_tillotson"], "steel"), ("steel", ["steel_1006", "steel_RHA"], "Al"),
])
def test_the_name_of_a_metal_is_answered_with_its_materials(name, family, other):
    with pytest.raises(hydro2d.DeckError) as error:
        said(f'body.block.material="{name}"')
    message = str(error.value)
    assert f'unknown material "{name}"; of this kind are ' in message
    assert all(each in message for each in family)
    assert other not in message.partition("of this kind are")[2]


@pytest.mark.parametrize(("line", "words"), [
    ("title = Tungsten rod", 'a text needs quotation marks: title = "Tungsten rod"'),
    ("velocity = 2.07 km/s  # fast", 'a text needs quotation marks: velocity = "2.07 km/s"'),
    ("time = 120us", 'a text needs quotation marks: time = "120us"'),
    ("hard = [rod]", 'a text needs quotation marks: hard = ["rod"]'),
    ("tensile = “material”", 'a text needs quotation marks: tensile = "material"'),
    ('title = "Tungsten rod', "title: the text has no closing quotation mark"),
    ("title = ", "invalid value"),
    ("a = [1, 2", "unclosed array"),
    ("a = 1e5\na = 1e6", "cannot overwrite a value"),
])
def test_a_text_without_quotation_marks_is_recognised(line, words):
    with pytest.raises(hydro2d.DeckError, match="not valid TOML") as error:
        toml.parse(f"# a deck\n{line}\n", "deck.toml")
    assert str(error.value).startswith("deck.toml:")
    assert words in str(error.value)
    assert "\n" not in str(error.value)
