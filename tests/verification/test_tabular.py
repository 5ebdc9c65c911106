"""A table in place of the equation of state that it was made from: the impact of two plates, and its state at rest."""

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


@functools.cache
def text(number):
    return sesame.write(tabulate.of_material(MATERIAL, tabulate.points(0.9 * REST, REST, 1.9 * REST, number),
                                             tabulate.temperatures(298.0, 12000.0, number)))


@functools.cache
def plateau(velocity, number=None):
    """Mean pressure and density between the shocks of two plates, from a table of so many points or the model; audit."""
    given = {"mesh.z": [{"to": "7 mm", "size": "0.05 mm"}], "mesh.z_start": "-6 mm", "body.flyer.velocity": velocity,
             "body.flyer.thickness": "5 mm", "body.flyer.z_front": "-5 mm", "stop.time": "0.5 us"}
    if number:
        given |= {"materials.al": {"eos": {"model": "tabular", "table_data": text(number), "table_from": "al.301",
                                           "reference_density": REST}}, "body.flyer.material": "al", "body.target.material": "al"}
    simulation = finish(decks.load("problems/verification/plate_impact_vapour.toml", given))
    line, u = Line(simulation), 0.5 * velocity
    inside = between(line.x, u * 0.5e-6 - 0.8e-3, u * 0.5e-6 + 0.8e-3)
    density = line.body("rho", 0) * line.body("vof", 0) + line.body("rho", 1) * line.body("vof", 1)
    return line.pressure[inside].mean(), density[inside].mean(), simulation.conservation()


@pytest.mark.parametrize("velocity", [1000.0, 3000.0])
@pytest.mark.parametrize("number", [11, 41])
def test_a_run_with_a_table_misses_the_model_by_what_the_interpolation_does(velocity, number):
    """The pressure between the shocks, against the exact Hugoniots of the table and of the model."""
    model, values = eos.MODELS["tillotson"], MATERIAL.eos.values
    row = tabular.row({"reference_density": REST}, sesame.read(text(number)))
    exact = [shocked(*each, 0.5 * velocity) for each in ((tabular, row), (model, model.row(values)))]
    with_table, with_model = plateau(velocity, number), plateau(velocity)
    assert with_table[0] / with_model[0] - 1.0 == pytest.approx(exact[0] / exact[1] - 1.0, abs=1.5e-3)
    assert with_table[0] == pytest.approx(exact[0], rel=5e-3)
    assert with_table[2]["total_energy"] == pytest.approx(0.0, abs=1e-12)
    assert with_table[2]["axial_momentum"] == pytest.approx(0.0, abs=1e-12)


def test_a_body_at_rest_stays_at_rest_to_the_last_bit():
    given = {"body.flyer.velocity": 0.0, "body.flyer.material": "al", "body.target.material": "al", "stop.time": "0.05 us",
             "mesh.z": [{"to": "7 mm", "size": "0.1 mm"}], "materials.al": {"eos": {
                 "model": "tabular", "table_data": text(41), "table_from": "al.301", "reference_density": REST}}}
    simulation = finish(decks.load("problems/verification/plate_impact_vapour.toml", given))
    assert not np.any(simulation.state.v)
    assert not np.any(simulation.state.e)
