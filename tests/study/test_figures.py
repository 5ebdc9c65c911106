"""Figures show their subject."""

from dataclasses import replace

import numpy as np
import pytest

from hydro2d.output.outlines import Filling
from hydro2d.study.ensemble.contents import collect
from hydro2d.study.records import responses, study_directory
from hydro2d.study.report import charts, panels, rods, run_series, theory
from tests.study import fake


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    axes = {
        "velocity": fake.velocities(1086, 1200, 1296),
        "advection": {"ke": ("numerics.advection=ke",), "momentum": ("numerics.advection=momentum",)},
    }
    return collect(study_directory.load(fake.write_study(tmp_path_factory.mktemp("figures") / "study", axes)))


@pytest.fixture(scope="module")
def panel(contents):
    return panels.panels(contents, choose(contents))[0]


def choose(contents, **options):
    return responses.choose(contents.study, contents.records, **options)


def grouped(contents, axes, **options):
    return run_series.grouped(contents.records, axes, choose(contents, **options))


def drawn(contents, panel, y="penetration_depth_m", curves=(), **options):
    """The traces of a figure by their names."""
    choice = choose(contents, y=(y,), **options)
    figure = charts.response(panel.setup, panel.series, choice.x, choice.y[0], contents.belonging, panel.shots, curves, ())
    return {(trace.name or trace.meta): trace for trace in figure.data}


def lines(axes):
    return {line.get_label(): line for line in axes.lines}


def test_series_are_cases_that_differ_in_more_than_velocity(panel, contents):
    assert [(each.label, [record.velocity for record in each.records]) for each in panel.series] == [
        ("ke", [1086, 1200, 1296]), ("momentum", [1086, 1200, 1296])]
    assert [each.label for each in grouped(contents, ())] == ["advection ke", "advection momentum"]
    by = grouped(contents, contents.study.axes, by=("velocity",))
    assert [(each.label, len(each.records)) for each in by] == [(f"impact velocity {v}", 2) for v in (1086, 1200, 1296)]


def test_a_variant_for_each_velocity_makes_no_series(tmp_path):
    shots = {f"shot {number}": (f"body.rod.velocity={speed} m/s",) for number, speed in (("4344", 1086), ("4345", 1200))}
    study = fake.write_study(tmp_path / "study", {"shot": shots, "courant": {"0.5": (), "0.4": ("numerics.courant=0.4",)}})
    for case, speed in (("shot4345_0.5", 1200), ("shot4345_0.4", 1200)):
        (study / "cases" / case / "deck.toml").write_text(fake.deck_text(f"body.rod.velocity={speed} m/s"))
    collected = collect(study_directory.load(study))
    groups = grouped(collected, collected.study.axes)
    assert [each.label for each in groups] == ["courant 0.5", "courant 0.4"]


def test_styles_differ_in_colour_and_in_marker():
    styles = [run_series.style(number) for number in range(24)]
    assert len({(style.colour, style.marker) for style in styles}) == 24
    for one, two in zip(styles, styles[1:], strict=False):
        assert one.colour != two.colour
        assert one.marker != two.marker
        assert one.dash != two.dash


def luminance(colour):
    parts = [int(colour[n : n + 2], 16) / 255 for n in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(share * part for share, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def test_colours_are_seen_on_light_and_on_dark():
    for colour in run_series.COLOURS:
        for paper in ("#ffffff", "#14181c"):
            low, high = sorted((luminance(colour), luminance(paper)))
            assert (high + 0.05) / (low + 0.05) > 3.0, (colour, paper)


def test_runs_experiments_rear_and_models_are_drawn(contents, panel):
    curves = theory.curves(contents.records[0].shot, 1000.0, 1300.0)
    traces = drawn(contents, panel, curves=curves)
    assert list(traces["ke"].x) == [1086, 1200, 1296]
    assert list(traces["ke"].y) == pytest.approx([35.0, 34.8, 34.6])
    assert traces["ke"].mode == "lines+markers"
    assert "1086m-s_ke" in traces["ke"].text[0]
    assert "depth [cm]: 35" in traces["ke"].text[0]
    assert list(zip(traces["experiment"].x, traces["experiment"].y, strict=True)) == [
        (1086, pytest.approx(44.8)), (1200, 20.0), (1296, pytest.approx(21.6))]
    assert traces["rear of the target"].y[0] == pytest.approx(53.34)
    for title in ("Forrestal's rigid rod", "Tate-Alekseevskii", "Walker-Anderson", "Hydrodynamic theory"):
        assert title in traces


#: the label of a run that ended before its projectile stopped
CUT = "reached its end time, still moving at 80 m/s"


def test_unfinished_runs_are_open_and_bounds_stand_in_a_triangle(tmp_path):
    runs = tmp_path / "runs"
    fake.write_run(runs / "a", 1086.0, 0.30)
    fake.write_run(runs / "b", 1200.0, 0.31, stop_reason="end time", rod_core_velocity_m_s=80.0)
    fake.write_run(runs / "c", 1296.0, 0.54)
    collected = collect(study_directory.load(runs))
    assert [each.unfinished for each in collected.records] == ["", CUT, ""]
    traces = drawn(collected, panels.panels(collected, choose(collected))[0])
    assert list(traces["hydro2d"].x) == [1086, 1296]
    assert (list(traces["unfinished"].x), traces["unfinished"].marker.symbol) == ([1200], "circle-open")
    assert CUT in traces["unfinished"].text[0]
    assert "open: unfinished, as far as it went" in traces
    assert list(next(trace for trace in traces.values() if trace.meta == "bound").x) == [1296]
    assert [error is None for error in collected.table["depth_error_m"]] == [False, True, False]


def test_words_stand_below_in_the_order_of_the_study(contents, panel):
    traces = drawn(contents, panel, x="advection", by=("velocity",))
    choice = choose(contents, x="advection")
    assert choice.x.order == ("ke", "momentum")
    assert [each.label for each in panels.panels(contents, choice)[0].series] == ["velocity 1086 m/s", "velocity 1200 m/s",
                                                                                 "velocity 1296 m/s"]
    assert list(traces["ke"].x) == ["ke"] * 3
    assert set(traces["experiment"].x) == {"ke", "momentum"}
    assert "rear of the target" not in traces


def test_legends_are_short_enough_for_a_phone():
    name = "a rather long name of a series, which goes on and on, and on"
    figure = charts._figure()
    for _ in range(30):
        figure.add_scatter(x=[1], y=[1], name=name)
    charts._finished(figure)
    assert [trace.showlegend for trace in figure.data].count(False) == 30 - charts.MOST_ENTRIES
    assert max(len(line) for line in figure.data[0].name.split("<br>")) <= charts.LETTERS
    assert figure.layout.height > charts.PANEL + 2 * charts.MOST_ENTRIES * charts.LINE


def test_models_are_those_of_the_command(contents):
    """Tate's depth is that of `hydro2d model`; a model without its inputs gives a reason, not a line."""
    from hydro2d.analytic import models

    shot = contents.records[0].shot
    curves = {curve.name: curve for curve in theory.curves(shot, 900.0, 1300.0)}
    request = models.Request(rod=shot.rod, target=shot.target, geometry=shot.values)
    expected = models.resolve(models.named("tate"), request).rows([900.0, 1300.0])
    np.testing.assert_allclose(curves["tate"].depth[[0, -1]], [row["depth"] for row in expected])
    assert not curves["anderson-riegel"].drawable
    assert "target.effective_flow_stress" in curves["anderson-riegel"].note
    assert all(curve.drawable or curve.note for curve in curves.values())


def test_histories_are_thinned(panel):
    figure = charts.histories(panel.series)
    titles = [axis.title.text for axis in figure.select_yaxes()]
    assert titles == ["depth<br>[cm]", "tail velocity<br>[m/s]", "projectile length<br>[cm]"]
    assert len(figure.data) == 18
    line = figure.data[0]
    assert len(line.x) <= 300
    assert line.x[-1] == pytest.approx(600.0)
    assert line.y[-1] == pytest.approx(35.0)
    assert len({(line.line.color, line.line.dash) for line in figure.data}) == 6
    assert sum(line.showlegend for line in figure.data) == 6


def patches(axes):
    """Extents in cm of the rod at the start and at the end: r_min, z_min, r_max, z_max."""
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


def test_a_rod_in_a_planar_mesh_with_both_sides_is_drawn_as_it_is(contents):
    deck = {**contents.records[0].deck, "mesh": {"geometry": "planar", "r_start": -0.02}}
    rod = [line + [-0.002, 0.0] for line in contents.records[0].rod]
    record = replace(contents.records[0], deck=deck, rod=rod)
    after = patches(rods.draw([record], {}, [record]).axes[0])[1]
    radius = fake.RADIUS * 101.0
    np.testing.assert_allclose(after[[0, 2]], [-0.2, radius - 0.2])


def test_rods_far_apart_are_drawn_tip_to_tip(contents):
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
    r, z = np.linspace(0.0, 1.0, 41), np.linspace(0.0, 3.0, 121)
    rr, zz = np.meshgrid((r[1:] + r[:-1]) / 2, (z[1:] + z[:-1]) / 2)
    inside = (rr < 0.6) & (zz > 0.5) & (zz < 2.5) & (np.hypot(rr - 0.3, zz - 1.5) > 0.15)
    path = rods._path(Filling(r, z, inside.astype(float)).outlines(), 0.0)
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
