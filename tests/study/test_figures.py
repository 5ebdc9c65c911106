"""Figures show what they say."""

import numpy as np
import pytest

from hydro2d.study import drawing, layout, rods, series, theory
from hydro2d.study.contents import collect
from tests.study import fake


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    axes = {
        "velocity": fake.velocities(1086, 1200, 1296),
        "advection": {"ke": ("numerics.advection=ke",), "momentum": ("numerics.advection=momentum",)},
    }
    return collect(layout.load(fake.write_study(tmp_path_factory.mktemp("figures") / "study", axes)))


@pytest.fixture(scope="module")
def setup(contents):
    return next(iter(contents.groups))


@pytest.fixture(scope="module")
def groups(contents, setup):
    return series.grouped(contents.groups[setup], contents.study.axes)


def lines(axes):
    return {line.get_label(): line for line in axes.lines}


def test_series_are_what_the_velocity_does_not_tell_apart(groups, contents, setup):
    assert [(each.label, [record.velocity for record in each.records]) for each in groups] == [
        ("ke", [1086, 1200, 1296]), ("momentum", [1086, 1200, 1296])]  # fmt: skip
    by_decks = series.grouped(contents.groups[setup], ())
    assert [each.label for each in by_decks] == ["advection ke", "advection momentum"]


def test_a_variant_for_each_velocity_makes_no_series(tmp_path):
    shots = {f"shot {number}": (f"body.rod.velocity={speed} m/s",) for number, speed in (("4344", 1086), ("4345", 1200))}
    study = fake.write_study(tmp_path / "study", {"shot": shots, "courant": {"0.5": (), "0.4": ("numerics.courant=0.4",)}})
    for case, speed in (("shot4345_0.5", 1200), ("shot4345_0.4", 1200)):
        (study / "cases" / case / "deck.toml").write_text(fake.deck_text(f"body.rod.velocity={speed} m/s"))
    found = collect(layout.load(study))
    groups = series.grouped(found.records, found.study.axes)
    assert [each.label for each in groups] == ["courant 0.5", "courant 0.4"]


def test_styles_differ_in_colour_and_in_marker():
    styles = [series.style(number) for number in range(24)]
    assert len({(style.colour, style.marker) for style in styles}) == 24
    for one, two in zip(styles, styles[1:], strict=False):
        assert one.colour != two.colour
        assert one.marker != two.marker
        assert one.dash != two.dash


def test_runs_are_hollow_experiments_filled_and_the_rear_is_marked(contents, setup, groups):
    curves = theory.curves(contents.records[0].shot, 1000.0, 1300.0)
    figure = drawing.depths(setup, groups, contents.measurements[setup], curves)
    found = lines(figure.axes[0])
    np.testing.assert_allclose(found["ke"].get_xydata(), [[1086, 35.0], [1200, 34.8], [1296, 34.6]])
    assert found["ke"].get_markerfacecolor() == "white"
    np.testing.assert_allclose(found["experiment"].get_xydata(), [[1086, 44.8], [1200, 20.0], [1296, 21.6]])
    assert found["experiment"].get_markerfacecolor() == "black"
    assert found["rear of the target"].get_ydata()[0] == pytest.approx(53.34)
    for title in ("Forrestal's rigid rod", "Tate-Alekseevskii", "Walker-Anderson", "Hydrodynamic theory"):
        assert title in found
    assert {text.get_text() for text in figure.legends[0].get_texts()} == set(found)


def test_models_are_those_of_the_command(contents):
    """Tate's depth as `hydro2d model` gives it; a model without its inputs is a reason, not a line."""
    from hydro2d.analytic import models

    shot = contents.records[0].shot
    curves = {curve.name: curve for curve in theory.curves(shot, 900.0, 1300.0)}
    request = models.Request(rod=shot.rod, target=shot.target, geometry=shot.values)
    expected = models.resolve(models.named("tate"), request).rows([900.0, 1300.0])
    np.testing.assert_allclose(curves["tate"].depth[[0, -1]], [row["depth"] for row in expected])
    assert not curves["anderson-riegel"].drawable
    assert "target.effective_flow_stress" in curves["anderson-riegel"].note
    assert all(curve.drawable or curve.note for curve in curves.values())


def test_histories_are_thinned(contents, groups):
    figure = drawing.histories(groups)
    assert len(figure.axes) == 3
    assert [len(axes.lines) for axes in figure.axes] == [6, 6, 6]
    line = figure.axes[0].lines[0]
    assert len(line.get_xdata()) <= 300
    assert line.get_xdata()[-1] == pytest.approx(600.0)
    assert line.get_ydata()[-1] == pytest.approx(35.0)
    assert len({(line.get_color(), str(line.get_linestyle())) for line in figure.axes[0].lines}) == 6


def patches(axes):
    """Extents in cm of the rod as it began and as it ended: r_min, z_min, r_max, z_max."""
    return [patch.get_path().get_extents().extents for patch in axes.patches]


def test_rods_are_mirrored_at_their_depths_at_one_scale(contents):
    figure = rods.draw(contents.records, {}, contents.records)
    before, after = patches(figure.axes[0])
    radius, length = fake.RADIUS * 101.0, fake.LENGTH * 99.0  # 1 % thicker and shorter, in cm
    np.testing.assert_allclose(after, [-radius, 35.0 - length, radius, 35.0])
    np.testing.assert_allclose(before[[1, 3]], [35.0 - fake.LENGTH * 100.0, 35.0])
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in figure.axes}) == 1
    assert figure.axes[0].get_aspect() == 1.0
    assert figure.axes[0].yaxis_inverted()
    assert figure.axes[0].get_title() == "1086 m/s\nke\n35.0 cm"
    assert figure.get_supylabel() == "depth [cm]"


def test_rods_far_apart_stand_tip_beside_tip(contents):
    measured = {contents.records[0].case.name: contents.belonging[contents.records[0].case.name]}
    assert rods.at_their_depths(contents.records, measured)
    assert lines(rods.draw(contents.records, measured, contents.records).axes[0])  # the experiment
    figure = rods.draw(contents.records, contents.belonging, contents.records)
    assert [patches(axes)[1][3] for axes in figure.axes] == pytest.approx([0.0] * 6, abs=1e-9)
    assert not any(axes.lines for axes in figure.axes)


def test_a_page_holds_eighteen_rods(contents):
    assert [len(part) for part in rods.pages(contents.records * 4)] == [18, 6]


def test_a_hole_in_a_rod_stays_a_hole():
    """Lines of opposite sense: the outer edge of a rod and a void in it, off the axis."""
    from hydro2d.output.outlines import outlines

    r, z = np.linspace(0.0, 1.0, 41), np.linspace(0.0, 3.0, 121)
    rr, zz = np.meshgrid((r[1:] + r[:-1]) / 2, (z[1:] + z[:-1]) / 2)
    inside = (rr < 0.6) & (zz > 0.5) & (zz < 2.5) & (np.hypot(rr - 0.3, zz - 1.5) > 0.15)
    path = rods._path(outlines(r, z, inside.astype(float)), 0.0)
    points = 100.0 * np.array([[0.0, 1.0], [0.3, 1.0], [-0.3, 1.0], [0.3, 1.5], [-0.3, 1.5], [0.8, 1.0]])
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import PathPatch

    figure = Figure(figsize=(4, 6), dpi=50)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_xlim(-100, 100)
    axes.set_ylim(0, 300)
    axes.axis("off")
    axes.add_patch(PathPatch(path, facecolor="black"))
    canvas.draw()
    shown = np.asarray(canvas.buffer_rgba())[..., 0]
    pixels = axes.transData.transform(points).astype(int)
    assert [bool(shown[300 - y, x] < 128) for x, y in pixels] == [True, True, True, False, False, False]
