"""`hydro2d info WORD`: the words that people use, and names that do not exist."""

import re
from pathlib import Path

import pytest

from hydro2d.base.errors import DeckError
from hydro2d.cli import info, words
from hydro2d.cli.main import call

DOCS = Path(__file__).resolve().parents[2] / "docs"
#: a word, and what its page must say
SAID = {
    "spall": "fracture_pressure", "anvil": 'z_min = "anvil"', "rigid": "No body can be declared rigid", "gap": "void",
    "erosion": "No cell is ever deleted", "debris": "--kind debris", "cavitation": "failure.tensile", "gravity": "-9.81 m/s^2",
    "concrete": "There is no material", "segmented": "`join`", "detonator": 'kind = "detonation"',
    "restitution": "no coefficient to set",
    "units": 'numbers = "SI"', "Us-up": "mie-grueneisen", "principal": "fracture_stress",
    "BLINT": 'sliding.method = "slip-layer"',
}


@pytest.mark.parametrize("word", SAID)
def test_a_word_says_what_it_is_called_here(word, capsys):
    assert call(["info", word]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith(f"{word} (a word): ")
    assert SAID[word] in shown


@pytest.mark.thorough
@pytest.mark.parametrize("word", words.WORDS)
def test_targets_of_words_exist(word):
    entry = words.WORDS[word]
    for name in entry.names:
        assert "(a word)" not in (text := info.page(name)) or "\n\n" in text
    for place in entry.pages:
        file, _, anchor = place.partition("#")
        headings = re.findall(r"^#+ (.*)$", (DOCS / file).read_text(encoding="utf-8"), flags=re.M)
        slugs = {re.sub(r"[^a-z0-9]+", "-", heading.lower()).strip("-") for heading in headings}
        assert not anchor or anchor in slugs
    assert len(info.page(word).split("\n")[0]) < 400


def test_other_forms_lead_to_known_words():
    assert set(words.ALSO.values()) <= set(words.WORDS)
    assert not set(words.ALSO) & set(words.WORDS)
    for word in ("Spallation", "segmented rod", "us_up", "Us up", "ballistic-limit", "V50"):
        assert words.page(word) is not None
    assert words.page("numerics") is None


def test_a_word_that_is_also_a_key_says_both(capsys):
    """`cavity` is a model, `units` only a word; a key of a deck keeps its page."""
    assert "(deck key)" in info.page("rebound")
    assert info.page("cavity").startswith("cavity")


@pytest.mark.parametrize(("name", "nearest"), [
    ("presure", 'did you mean "pressure", '), ("reference_densty", 'did you mean "reference_density"'),
    ("spal", 'did you mean "spall"'), ("W_aloy", 'did you mean "W_alloy"? '),
])
def test_an_unknown_name_gets_the_nearest_ones(name, nearest):
    with pytest.raises(DeckError) as caught:
        info.page(name)
    said = str(caught.value)
    assert said.startswith(f'unknown name "{name}"; ')
    assert nearest in said
    assert said.endswith("`hydro2d info` lists all names")
    assert said.count(",") <= info.MOST_NEAR


def test_a_name_near_nothing_gets_no_list():
    with pytest.raises(DeckError, match=r'^unknown name "qqqqqq"; `hydro2d info` lists all names$'):
        info.page("qqqqqq")


@pytest.mark.parametrize(("name", "first"), [
    ("pmma", "PMMA: "), ("Air", "air: "), ("LEXAN", "Lexan: "), ("VISAR", "VISAR (a word): "), ("Ejecta", "Ejecta (a word): "),
    ("hole", "hole (a word): "), ("water", "water: ")])
def test_names_that_people_try(name, first):
    assert info.page(name).startswith(first)


def test_water_says_what_each_of_it_is_for():
    assert "for boiling take water_tillotson" in info.page("water")
    assert "for shocks, jets and impact below 1 km/s take water" in info.page("water_tillotson")


def test_the_overview_has_the_words(capsys):
    assert call(["info"]) == 0
    shown = capsys.readouterr().out
    for word in words.WORDS:
        assert f"\n  {word} " in shown
