"""The kinds of edges: their descriptions, and the numbers that kernels get."""

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.mesh.boundary_conditions import BoundaryConditions
from hydro2d.mesh.edges.base import EDGES
from hydro2d.mesh.edges.registry import BY_NAME, made
from tests.sources.test_heating import TEXT

PISTON = ((0.0, 0.0), (1e-6, 100.0), (3e-6, -50.0))


def of(kind, **values):
    """Conditions with this kind at every edge that allows it, and walls elsewhere."""
    return BoundaryConditions(tuple(BY_NAME[kind if edge in BY_NAME[kind].edges else "wall"](**values) for edge in EDGES))


def test_a_piston_moves_by_its_table():
    conditions = of("piston", piston=PISTON)
    assert conditions.velocity.tolist() == [0.0] * 8
    velocity = conditions.velocity[:4]
    for time, speed in ((0.5e-6, 50.0), (1e-6, 100.0), (2e-6, 25.0), (9e-6, -50.0)):
        conditions.drive(time)
        assert velocity == pytest.approx([speed] * 4, rel=1e-12)
    assert conditions.sinks == ["piston"]
    assert of("wall").sinks == []
    assert made("z_min", {"z_min": "piston", "z_min_piston": PISTON}).speeds() == (0.0, 100.0, -50.0)


def test_a_held_edge_has_a_velocity_across_and_along_it():
    boundaries = {edge: "held" for edge in EDGES} | {f"{edge}_radial": 1.0 for edge in EDGES} | {
        f"{edge}_axial": None if edge == "z_max" else 2.0 for edge in EDGES}
    conditions = BoundaryConditions.of(boundaries)
    assert conditions.velocity.tolist() == [1.0, 1.0, 2.0, 0.0, 2.0, 2.0, 1.0, 1.0]
    assert conditions.sinks == []
    assert not of("held").having("drives")[0]  # at rest


def test_a_pressure_is_constant_or_follows_its_table():
    constant, table = of("pressure", pressure=2e5), of("pressure", pressure=((0.0, 0.0), (1e-6, 4e5)))
    for conditions, then in ((constant, 2e5), (table, 1e5)):
        assert not conditions.pressure.any()
        conditions.drive(0.25e-6)
        assert conditions.pressure == pytest.approx([then] * 4)
    assert constant.sinks == ["pressure"]
    assert not of("pressure", pressure=0.0).having("drives")[0]


def test_matter_that_moves_with_an_edge_crosses_the_cell_next_to_it():
    """The piston is at 50 m/s after 0.5 us, at 75 m/s after 1.33 us, and at 100 m/s in between; widths of 1 to 4 mm."""
    widths, still = [3e-3, 2e-3, 1e-3, 4e-3], of("wall")
    assert still.least_crossing(widths, 0.0, 1.0)[0] == np.inf
    assert of("velocity", velocity=-20.0).least_crossing(widths, 0.0, 1e-9) == (1e-3 / 20.0, "z_min")
    assert not of("velocity", velocity=0.0).having("drives")[0]
    piston = of("piston", piston=PISTON)
    assert piston.least_crossing(widths, 0.0, 0.5e-6) == (pytest.approx(1e-3 / 50.0), "z_min")
    assert piston.least_crossing(widths, 0.5e-6, 4e-6 / 3.0) == (pytest.approx(1e-3 / 100.0), "z_min")
    assert piston.least_crossing(widths, 4e-6 / 3.0, 1.4e-6)[0] == pytest.approx(1e-3 / 75.0)


@pytest.mark.parametrize(("overrides", "words"), [
    (['boundaries.z_min="piston"'], "a piston needs z_min_piston"),
    (['boundaries.z_min="velocity"'], "an edge with a velocity needs z_min_velocity"),
    (["boundaries.z_min_piston=[[0, 0], ['1 s', '1 m/s']]"], 'has no meaning without z_min = "piston"'),
    (['boundaries.z_min="velocity"', "boundaries.z_min_velocity=1 m/s", "boundaries.z_min_piston=[[0, 0], ['1 s', '1 m/s']]"],
     'z_min_piston: has no meaning without z_min = "piston"'),
    (['boundaries.z_min="piston"', 'boundaries.z_min_piston=[[0, 0], ["1 us", "1e7 m/s"]]'], "row 1: is 1e[+]07 m/s, beyond"),
    (['boundaries.z_min="axis"'], "unknown value .axis."),
    (['boundaries.z_min="pressure"'], "an edge with a pressure needs z_min_pressure"),
    (['boundaries.z_min="pressure"', 'boundaries.z_min_pressure=[[0, 0], ["1 us", "1 m"]]'], "row 1"),
    (["boundaries.z_min_pressure=1 kPa"], 'has no meaning without z_min = "pressure"'),
    (["boundaries.z_min_axial=1 m/s"], 'has no meaning without z_min = "held"'),
    (['boundaries.z_min="held"', "boundaries.z_min_axial=30 m/s", 'boundaries.z_max="wall"'],
     "z_min and z_max move the bodies between them into each other, at 30 m/s"),
    (['boundaries.r_max="held"', "boundaries.r_max_radial=-30 m/s"],  # r_min is left out: a wall
     "r_min and r_max move the bodies between them into each other, at 30 m/s"),
    (['boundaries.z_min="held"', "boundaries.z_min_axial=30 m/s", 'boundaries.z_max="piston"',
      'boundaries.z_max_piston=[[0, "30 m/s"], ["1 us", "20 m/s"]]'],
     "z_min and z_max move the bodies between them into each other, at 10 m/s"),
    (['boundaries.z_min="held"', "boundaries.z_min_radial=30 m/s", 'boundaries.r_max="anvil"'],
     "a held edge that moves along itself has no corner with an anvil, here r_max"),
])
def test_wrong_edges(overrides, words):
    with pytest.raises(DeckError, match=words):
        deck.loads(TEXT, overrides)


def test_the_words_of_a_deck_become_edges():
    loaded = deck.loads(TEXT, ['boundaries.z_min="piston"', 'boundaries.z_min_piston=[[0, 0], ["1 us", "0.1 km/s"]]'])
    conditions = BoundaryConditions.of(loaded.boundaries.model_dump())
    assert [edge.name for edge in conditions.edges] == ["wall", "wall", "piston", "outflow"]
    conditions.drive(0.25e-6)
    np.testing.assert_allclose(conditions.velocity, [0.0, 0.0, 25.0, 0.0, 0.0, 0.0, 0.0, 0.0], rtol=1e-12)
