"""Formulas of a deck: their terms, their units, and what is refused."""

import math

import pytest

from hydro2d.base.units import to_si
from hydro2d.deck.expressions import DIMENSIONS, SPELLED, ExpressionError, in_words, parse

KNOWN = {"depth": "m", "length0": "m", "u": "m/s", "energy": "J", "mass": "kg", "body_front plate_mass_kg": "kg", "ratio": "1"}
NUMBERS = dict(zip(KNOWN, (0.03, 0.06, 800.0, 4.0, 2.0, 0.5, 3.0), strict=True))


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("depth / length0", "1", 0.5),
        ("-depth + 2 * length0", "m", 0.09),
        ("depth - '8 mm'", "m", 0.022),
        ("energy / '2 cm' ** 3", "Pa", 4.0 / 8e-6),
        ("sqrt(2 * energy / mass)", "m/s", 2.0),
        ("u**2 / 2", "J/kg", 3.2e5),
        ("'body_front plate_mass_kg' * u", "N s", 400.0),
        ("max(depth, length0, '1 cm')", "m", 0.06),
        ("exp(-ratio) + cos(pi)", "1", math.exp(-3.0) - 1.0),
        ("2 ** ratio", "1", 8.0),
        ("(depth * length0) ** 0.5", "m", math.sqrt(0.0018)),
    ],
)
def test_values_and_units(text, unit, value):
    formula = parse(text, KNOWN)
    assert in_words(formula.dimension) == unit
    assert formula.evaluate(NUMBERS) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("depth + u", "the units are m and m/s"),
        ("min(depth, u)", "the units are m and m/s"),
        ("exp(depth)", "exp takes a plain number, not one in m"),
        ("ratio ** depth", "an exponent is a plain number"),
        ("depth ** ratio", "with a unit must be a number"),
        ("depht / length0", 'did you mean "depth"'),
        ("depth /", "is not a formula"),
        ("sqr(depth)", 'unknown function "sqr"'),
        ("max(depth)", "takes two or more numbers"),
        ("sqrt(depth, u)", "takes one number"),
        ("depth - '8 mn'", "is not a quantity"),
        ("True * depth", "is not a number"),
        ("1j", "is not a number"),
        ("depth.real", "a formula has numbers, names"),
        ("depth[0]", "a formula has numbers, names"),
        ("depth if ratio else u", "a formula has numbers, names"),
        ("(lambda: depth)()", "unknown function"),
        ("__import__('os').system('true')", "unknown function"),
        ("[depth for depth in ()]", "a formula has numbers, names"),
        ("abs(x=depth)", "unknown function"),
        ("1" + "+1" * 400, "is longer than"),
        ("-" * 60 + "1", "brackets nested more than"),
        ("0" * 20 + "1", "is not a formula"),
    ],
)
def test_refused_formulas(text, said):
    with pytest.raises(ExpressionError, match=None) as refused:
        parse(text, KNOWN)
    assert said in str(refused.value)


@pytest.mark.parametrize("text", ["depth / (ratio - 3)", "log(ratio - 3)", "sqrt(ratio - 4)", "9 ** 9 ** 9",
                                  "exp(ratio * 1000)", "1e999", "1e308 * 10", "(ratio - 4) ** 0.5"])
def test_formulas_without_a_value(text):
    assert parse(text, KNOWN).evaluate(NUMBERS) is None


def test_names_not_known_yet():
    assert parse("depth / length0", KNOWN).evaluate({**NUMBERS, "length0": None}) is None
    assert parse("depth / length0", KNOWN).evaluate({"depth": 1.0}) is None


def test_every_unit_has_its_dimension():
    """A number in each unit has the same dimension as a name in it."""
    for (name, dimension), spelled in zip(DIMENSIONS.items(), SPELLED, strict=True):
        assert to_si(f"1 {spelled}" if spelled != "1" else 1.0, spelled) == 1.0
        if name not in ("1", "rad"):
            assert parse(f"x - '1 {spelled}'", {"x": name}).dimension == dimension
