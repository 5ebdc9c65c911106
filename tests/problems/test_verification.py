"""Problems with exact solutions: how they are measured, the kept results, and the page that shows them."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.solver.simulation import Simulation
from problems import kept
from problems.verification import accuracy, figures, table
from problems.verification.accuracy import BY_NAME, PROBLEMS, Quantity
from problems.verification.cells import Cells
from tests.rules import source

FOLDER = source.PROBLEMS / "verification"
NUMBERS = kept.rows(table.NUMBERS, table.COLUMNS)
CURVES = kept.rows(table.CURVES, table.CURVE_COLUMNS)
PLANNED = [(problem.name, variant, str(cells)) for problem in PROBLEMS for variant in problem.variants
           for cells in problem.cells]


def test_every_run_is_kept():
    assert list(dict.fromkeys((row["problem"], row["variant"], row["cells"]) for row in NUMBERS)) == PLANNED


def test_every_curve_is_kept():
    assert list(dict.fromkeys((row["problem"], row["cells"]) for row in CURVES)) == [
        (problem.name, str(cells)) for problem in PROBLEMS for cells in problem.cells]


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name)
def test_the_table_of_the_page_is_that_of_the_kept_numbers(problem):
    page = (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()
    rows = table.table(problem, NUMBERS)
    assert len(rows) > 4
    assert [row for row in rows if row not in page] == []


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name)
def test_the_error_that_is_kept_is_that_of_the_numbers(problem):
    for row in NUMBERS:
        if row["problem"] == problem.name and row["quantity"] and float(row["exact"]) != 0.0:
            error = 100.0 * (float(row["found"]) / float(row["exact"]) - 1.0)
            assert float(row["error_percent"]) == pytest.approx(error, abs=2e-3 * abs(error) + 2e-3)


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name)
def test_every_deck_can_be_refined_and_names_its_advection(problem):
    for variant in problem.variants:
        for cells in problem.cells:
            deck = decks.load(str((accuracy.FOLDER / problem.deck).resolve()), problem.overrides(variant, cells))
            assert deck.numerics.advection == variant


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name)
def test_a_figure_has_every_mesh_and_the_exact_curve(problem):
    axes = figures.draw(problem, CURVES).axes[0]
    labels = [line.get_label() for line in axes.lines]
    assert labels == [*(f"{cells} cells {problem.resolution}" for cells in problem.cells), "exact"]
    *runs, exact = (np.asarray(line.get_ydata(), dtype=float) for line in axes.lines)
    assert all(np.isfinite(line).all() and len(line) >= 3 for line in runs)
    assert np.isfinite(exact).any()


def test_errors_and_orders():
    assert Quantity("", "", 2.0, 2.1).error == pytest.approx(5.0)
    assert Quantity("", "", 0.0, 0.1, 4.0).error == pytest.approx(2.5)
    assert table.order([50, 100, 200], [8.0, 3.9, 2.0]) == "1.0"
    assert table.order([50, 100, 200], [8.0, 3.9, -2.0]) == ""
    assert [table.shown(each) for each in ("-12.345", "0.1234", "-1e-13")] == ["-12.3", "+0.12", "0.00"]


def test_the_exponent_of_an_implosion_is_found():
    time = np.linspace(0.0, 1.2, 400)
    radius = np.where(time < 1.0, 1.1 * np.maximum(1.0 - time, 0.0) ** 0.7171745, np.nan)
    radius[time > 1.01] = 0.2  # the reflected shock
    assert accuracy.implosion_fit(time, radius)[2] == pytest.approx(0.7171745, abs=1e-5)


def test_extrema_give_period_and_decay():
    time = np.linspace(0.0, 29e-6, 600)
    times, values = accuracy.extrema(time, np.exp(-time / 1e-4) * np.cos(2.0 * np.pi * time / 3.5e-6))
    assert np.diff(times) == pytest.approx(1.75e-6, rel=2e-3)
    assert np.polyfit(times, np.log(np.abs(values)), 1)[0] == pytest.approx(-1e4, rel=2e-3)


@pytest.fixture(scope="module")
def collapse():
    problem = BY_NAME["collapse"]
    return Cells(Simulation(decks.load(str(accuracy.FOLDER / problem.deck), problem.overrides("both", 20))))


def test_rays_and_shells(collapse):
    """A field equal to the distance is the distance along every ray and in every shell."""
    for angle in (0.0, 30.0, 90.0):
        distance, values = collapse.ray(collapse.distance, angle)
        inside = (distance > 2.0 * collapse.size) & (distance < 0.9)
        np.testing.assert_allclose(values[inside], distance[inside], atol=0.1 * collapse.size)
    radius, mean = collapse.shells(collapse.distance, 0.9)
    np.testing.assert_allclose(mean, radius, atol=0.25 * collapse.size)
    assert float(collapse.volume.sum()) == pytest.approx(0.5, rel=1e-12)
    far = (collapse.r > 0.3) & (collapse.distance < 0.9)  # next to the axis a vertex has the mean over its share of both cells
    np.testing.assert_allclose(collapse.outward[far], -1e3 * collapse.distance[far], rtol=0.01)
