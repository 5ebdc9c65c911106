"""A table instead of the equation of state from which it was made: a shock from a wall, and the state at rest."""

import functools

import numpy as np
import pytest

import eos
from eos import tabular
from hydro2d.deck import deck as decks
from hydro2d.materials import library, sesame, tabulate
from tests.eos.test_tabular import shocked
from tests.verification.running import Line, between, finish

REST = 2700.0
MATERIAL = library.load("Al_tillotson")
DECK = """
title = "Aluminium onto a wall"
numbers = "SI"
[mesh]
r = [{ to = "0.2 mm", cells = 4 }]
z = [{ to = "5 mm", size = "0.05 mm" }]
[boundaries]
r_max = "wall"
z_max = "wall"
[[body]]
name = "bar"
material = "Al_tillotson"
shape = "plate"
z_front = 0.0
thickness = "5 mm"
[failure]
tensile = "none"
[numerics]
advection = "both"
[stop]
time = "0.4 us"
"""


@functools.cache
def text(number):
    return sesame.write(tabulate.of_material(MATERIAL, tabulate.points(0.9 * REST, REST, 1.9 * REST, number),
                                             tabulate.temperatures(298.0, 12000.0, number)))


@functools.cache
def behind(velocity, number=None):
    """Mean pressure behind the shock in a bar that hits a wall, Pa, from a table of so many points or the model; audit."""
    given = {"body.bar.velocity": velocity}
    if number:
        given |= {"body.bar.material": "al", "materials.al": {"eos": {
            "model": "tabular", "table_data": text(number), "table_from": "al.301", "reference_density": REST}}}
    simulation = finish(decks.loads(DECK, given))
    line = Line(simulation)
    return line.pressure[between(line.x, 4.0e-3, 4.6e-3)].mean(), simulation.conservation()


def exact(velocity, number=None):
    """The pressure behind it by the jump conditions, Pa."""
    if number is None:
        model = eos.MODELS["tillotson"]
        return shocked(model, model.row(MATERIAL.eos.values), velocity)
    return shocked(tabular, tabular.row({"reference_density": REST}, sesame.read(text(number))), velocity)


@pytest.mark.parametrize("velocity", [500.0, 1000.0, 1500.0])
@pytest.mark.parametrize("number", [11, 21, 41])
def test_a_run_with_a_table_misses_the_model_by_what_the_interpolation_does(velocity, number):
    """The pressure behind the shock, against the jump conditions with the table and with the model."""
    pressure, audit = behind(velocity, number)
    assert pressure == pytest.approx(exact(velocity, number), rel=2e-3)
    assert pressure / behind(velocity)[0] - 1.0 == pytest.approx(exact(velocity, number) / exact(velocity) - 1.0, abs=1e-3)
    assert audit["total_energy"] == pytest.approx(0.0, abs=1e-12)


def test_a_body_at_rest_stays_at_rest_to_the_last_bit():
    given = {"body.bar.material": "al", "stop.time": "0.1 us", "materials.al": {"eos": {
        "model": "tabular", "table_data": text(41), "table_from": "al.301", "reference_density": REST}}}
    simulation = finish(decks.loads(DECK, given))
    assert not np.any(simulation.state.v)
    assert not np.any(simulation.state.e)
