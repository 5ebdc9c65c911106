"""Quantities in, quantities out."""

import subprocess
import sys

import pytest

from hydro2d.base import units


@pytest.mark.parametrize(
    ("value", "unit", "si"),
    [
        (3, "m", 3.0),
        (0.25, "1", 0.25),
        ("0.422275 mm", "m", 4.22275e-4),
        ("53.34 cm", "m", 0.5334),
        ("1086 m/s", "m/s", 1086.0),
        ("4.03 km/s", "m/s", 4030.0),
        ("18.16 g/cm^3", "kg/m^3", 18160.0),
        ("18.16 g/cm3", "kg/m^3", 18160.0),
        ("18.16 g/cc", "kg/m^3", 18160.0),
        ("0.45 GPa", "Pa", 0.45e9),
        ("1.03 /Mbar", "1/Pa", 1.03e-11),
        ("20 degC", "K", 293.15),
        ("143 J/kg/K", "J/(kg*K)", 143.0),
        ("10 us", "s", 1e-5),
        ("10 µs", "s", 1e-5),
        ("1e-6s", "s", 1e-6),
        ("-120mm", "m", -0.12),
        ("180 deg", "rad", 3.14159265358979),
        ("150 %", "1", 1.5),
        ("1.5", "1", 1.5),
    ],
)
def test_to_si_gives_the_decimal_that_was_meant(value, unit, si):
    assert units.to_si(value, unit) == si


@pytest.mark.parametrize(
    ("value", "unit", "message"),
    [
        ("5 GPa", "m", '"5 GPa" is a pressure; expected a length: a number in m or a string such as "1.5 m"'),
        ("5", "m", '"5" has no unit; expected a length'),
        ("fast", "m/s", '"fast" is not a number with a unit; expected a velocity'),
        ("5 furlongz", "m", '"furlongz" is not a unit; expected a length'),
        ("3 m", "1", '"3 m" is a length; expected a plain number'),
        (True, "m", "True is not a quantity"),
        ([1.0], "m", "[1.0] is not a quantity"),
        (float("nan"), "m", "nan is not finite"),
        (float("inf"), "s", "inf is not finite"),
        ("1e999 m", "m", "is not finite"),
    ],
)
def test_the_message_on_a_wrong_quantity_names_the_expected_one(value, unit, message):
    with pytest.raises(ValueError, match="expected") as caught:
        units.to_si(value, unit)
    assert message in str(caught.value)


def test_out_is_the_inverse_of_in():
    assert units.from_si(units.to_si("44.8 cm", "m"), "m", "cm") == pytest.approx(44.8, rel=1e-15)
    assert units.from_si(2.5, "m", "m") == 2.5


def test_show():
    assert units.show(0.448, "m", "cm") == "44.8 cm"
    assert units.show(0.25, "1") == "0.25"
    assert units.show(1234.5678, "m/s", digits=6) == "1234.57 m/s"


def test_numbers_do_not_need_pint():
    script = "import sys; from hydro2d.base import units; units.to_si(3.0, 'm'); print('pint' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


@pytest.mark.parametrize("name", units.COMMON)
def test_the_table_of_common_units_agrees_with_pint(name):
    unit, _ = units.COMMON[name]
    for number in (1.0, 8.12, 0.422275, 1086.0, 5.25e-4):
        si = units.to_si(f"{number!r} {name}", unit)
        assert si == float(f"{units._by_pint('', number, name, unit):.15g}")


@pytest.mark.parametrize(
    ("text", "unit", "si"),
    [("1086m/s", "m/s", 1086.0), ("0", "m", 0.0), ("-2 cm", "m", -0.02), ("0.5", "1", 0.5), ("1e4 /s", "1/s", 1e4)],
)
def test_an_argument_has_its_unit(text, unit, si):
    assert units.of_argument(text, unit) == si


@pytest.mark.parametrize(
    ("text", "unit", "said"),
    [
        ("1086", "m/s", '1086 has no unit; write "1086 m/s"'),
        ("1.2", "m/s", '1.2 has no unit; write "1.2 km/s" (or "1.2 m/s", if that is meant)'),
        ("1000", "1/s", '1000 has no unit; write "1000 /s"'),
        ("inf", "m/s", "inf is not finite; expected a velocity"),
    ],
)
def test_an_argument_without_its_unit_gets_a_suggestion(text, unit, said):
    with pytest.raises(ValueError, match="has no unit|not finite") as caught:
        units.of_argument(text, unit)
    assert str(caught.value).startswith(said)
