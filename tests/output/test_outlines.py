"""Outlines of features narrower than a cell, in pictures, files and pages, next to those of wider ones."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.materials.quantities import BY_KEY
from hydro2d.output.outlines import Filling
from hydro2d.output.vtk import Dump
from hydro2d.results import figures
from hydro2d.solver.simulation import Simulation
from tests.decks import entry, mesh, stop

#: mm: a cell of the mesh
CELL = 0.5


def dumped(**keys) -> Dump:
    """A body "thin" on its own, on cells of 0.5 mm."""
    text = mesh(("20 mm", 40), ("-10 mm", "20 mm", 60)) + stop("1 us")
    return Dump.of(Simulation(deck.loads(text + entry("body", name="thin", material="Al5083", **keys))))


def area(line: np.ndarray) -> float:
    """Area within a closed line, mm^2."""
    r, z = 1e3 * line.T
    return 0.5 * abs(float(np.sum(r[:-1] * z[1:] - r[1:] * z[:-1])))


def ends(lines: list[np.ndarray], axis: int) -> tuple[float, float]:
    """Lowest and highest r (0) or z (1), mm."""
    every = 1e3 * np.concatenate(lines)[:, axis]
    return float(every.min()), float(every.max())


@pytest.mark.parametrize(("front", "thickness"), [(-6.13, 0.15), (-6.05, 0.15), (-6.3, 0.6)])
def test_a_foil_has_its_place_and_its_thickness(front, thickness):
    lines = dumped(shape="plate", radius="12.2 mm", z_front=f"{front} mm", thickness=f"{thickness} mm").outlines("thin")
    assert len(lines) == 1
    assert ends(lines, 1) == pytest.approx((front, front + thickness), abs=1e-9)
    assert ends(lines, 0) == pytest.approx((0.0, 12.2), abs=0.02)


def test_a_tube_is_outlined_in_place():
    lines = dumped(shape="box", r=["5.1 mm", "5.3 mm"], z=["3 mm", "9 mm"]).outlines("thin")
    assert len(lines) == 1
    assert ends(lines, 0) == pytest.approx((5.1, 5.3), abs=0.01)
    assert ends(lines, 1) == pytest.approx((3.0, 9.0), abs=1e-9)


@pytest.mark.parametrize("rise", [0.0, 1.0, 3.0, 6.0, -4.0, 12.0])
def test_an_oblique_strip_is_one_and_has_its_area(rise):
    points = [[f"{r} mm", f"{z} mm"] for r, z in ((3, 0), (15, rise), (15, rise + 0.3), (3, 0.3))]
    lines = dumped(shape="polygon", points=points).outlines("thin")
    assert len(lines) == 1
    assert area(lines[0]) == pytest.approx(12 * 0.3, rel=0.005)
    assert ends(lines, 0) == pytest.approx((3.0, 15.0), abs=0.25 * CELL)
    assert ends(lines, 1) == pytest.approx((min(rise, 0.0), max(rise, 0.0) + 0.3), abs=0.35 * CELL)


def test_a_shell_is_round_it_all():
    lines = dumped(shape="sphere", centre=["0 mm", "5 mm"], radius="4 mm", inner_radius="3.8 mm").outlines("thin")
    places = np.concatenate([1e3 * line for line in lines])
    distance = np.hypot(places[:, 0], places[:, 1] - 5.0)
    assert 3.8 - CELL < distance.min() < 3.9 < distance.max() < 4.0 + CELL
    assert sum(map(area, lines)) == pytest.approx(0.5 * np.pi * (4.0**2 - 3.8**2), rel=0.2)


def test_a_crumb_has_none():
    assert dumped(shape="box", r=["5.1 mm", "5.15 mm"], z=["3 mm", "3.04 mm"]).outlines("thin") == []


def test_a_thick_body_is_drawn_as_if_nothing_were_known_of_its_centroids():
    dump = dumped(shape="sphere", centre=["0 mm", "5 mm"], radius="4 mm")
    filling = dump.filling("thin")
    (line,) = Filling(filling.r_edges, filling.z_edges, filling.fraction).outlines()
    (mine,) = filling.outlines()
    np.testing.assert_array_equal(mine, line)
    assert not filling.thin.any()


def test_a_dump_of_an_older_version_has_outlines_of_thick_bodies_alone():
    dump = dumped(shape="plate", radius="12 mm", z_front="-6.13 mm", thickness="0.15 mm")
    for key in ("centroid_r", "centroid_z"):
        del dump.fields[BY_KEY[key].name("thin")]
    assert dump.outlines("thin") == []


def test_fields_of_what_is_thin_are_shown():
    dump = dumped(shape="plate", radius="12.2 mm", z_front="-6.13 mm", thickness="0.15 mm", velocity="200 m/s")
    values = figures.chosen(dump, "velocity:z").values
    assert np.nanmin(values) == pytest.approx(200.0)
    assert np.isfinite(values).sum() == 50  # it lies in two rows
    assert len(dump.filling().regions()) == 1


def test_two_bodies_together_lie_where_both_do():
    text = mesh(("20 mm", 40), ("-10 mm", "20 mm", 60)) + stop("1 us")
    both = [entry("body", name=name, material="Al5083", shape="plate", radius="12 mm", z_front=f"{z} mm", thickness="0.1 mm")
            for name, z in (("one", -6.4), ("two", -6.3))]
    dump = Dump.of(Simulation(deck.loads(text + "".join(both))))
    for body, place in (("one", (-6.4, -6.3)), ("two", (-6.3, -6.2)), (None, (-6.4, -6.2))):
        lines = dump.filling(body).outlines()
        assert ends(lines, 1) == pytest.approx(place, abs=1e-6)
