"""Parameters of models: what is accepted, what is refused, and the messages."""

import math

import pytest

import eos
import strength
from hydro2d.base.parameters import ANY, POSITIVE, REQUIRED, Parameter, collect

PARAMETERS = (
    Parameter("stiffness", "Pa", REQUIRED, "a stiffness", "k", POSITIVE),
    Parameter("limit", "Pa", math.inf, "an upper bound"),
    Parameter("shift", "", 0.5, "a number of any sign", sign=ANY),
)


def test_defaults_are_filled_in():
    assert collect("spring", PARAMETERS, {"stiffness": 3}) == {"stiffness": 3.0, "limit": math.inf, "shift": 0.5}
    assert collect("spring", PARAMETERS, {"stiffness": 3, "shift": -2})["shift"] == -2.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, r"spring: parameter 'stiffness' is missing \(a stiffness, Pa\)"),
        ({"stifness": 1.0}, r'unknown parameter "stifness"; did you mean "stiffness"\?'),
        ({"stiffness": 0.0}, "spring: stiffness = 0: must be positive"),
        ({"stiffness": math.inf}, "not a finite number"),
        ({"stiffness": 1.0, "limit": -1.0}, "must be non-negative"),
        ({"stiffness": 1.0, "shift": math.nan}, "not a finite number"),
    ],
)
def test_impossible_values_are_refused(values, message):
    with pytest.raises(ValueError, match=message):
        collect("spring", PARAMETERS, values)


def test_shared_names_are_those_of_the_equation_of_state():
    """A parameter taken from the equation of state exists there under the same name, with the same unit."""
    known = {parameter.name: parameter for module in eos.MODELS.values() for parameter in module.PARAMETERS}
    shared = [
        parameter
        for module in strength.STRENGTH_MODELS.values()
        for parameter in module.PARAMETERS
        if parameter.from_eos
    ]
    assert shared
    for parameter in shared:
        assert parameter.unit == known[parameter.name].unit


def test_the_table_of_a_description():
    rows = {row[0]: row for row in eos.describe("mie-grueneisen").table()}
    assert rows["sound_speed"][:4] == ("sound_speed", "c0", "m/s", "required")
    assert rows["hugoniot_slope"][2] == "1"
    assert rows["reference_temperature"][3] == "298"
