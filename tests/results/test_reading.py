"""Reading a run back: history as tables, sections in the caller's axes, its description, directories that are not runs."""

import re

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import hydro2d
from hydro2d.output import history, vtk
from hydro2d.results import figures
from hydro2d.results.reading import ResultsError
from hydro2d.running.run import run as start
from hydro2d.study.records import study_directory
from tests import fake


@pytest.fixture
def shot(finished):
    return hydro2d.open_run(finished)


def own_axes(columns=1):
    figure = Figure()
    FigureCanvasAgg(figure)
    return figure.subplots(1, columns)


def test_a_section_goes_into_the_axes_that_are_given(shot):
    left, right = own_axes(2)
    assert shot.section("pressure", mirror="velocity", time=5e-6, axes=left) is left
    assert left.get_title() == f"shot  t = {shot.dump(5e-6).time * 1e6:.2f} µs"
    assert not right.has_data()
    bars = [axes.get_ylabel() for axes in left.figure.axes[2:]]
    assert bars == ["Upper half: Pressure [GPa]", "Lower half: Velocity [m/s]"]


def test_a_section_is_the_one_that_figures_draws(shot):
    own = shot.section("velocity:z", axes=own_axes())
    drawn = figures.sections([shot], "velocity:z").axes[0]
    for one, other in zip(own.collections, drawn.collections, strict=True):
        assert (one.get_array() is None) == (other.get_array() is None)
        if one.get_array() is not None:
            np.testing.assert_array_equal(one.get_array(), other.get_array())
            assert one.get_clim() == other.get_clim()
    assert (own.get_xlim(), own.get_ylim(), own.get_title()) == (drawn.get_xlim(), drawn.get_ylim(), drawn.get_title())
    assert [line.get_xdata()[0] for line in own.lines] == [line.get_xdata()[0] for line in drawn.lines]
    assert any(line.get_xdata()[0] == pytest.approx(12.1) for line in own.lines)


def test_limits_window_and_no_bar(shot):
    axes = own_axes()
    shot.section("density", axes=axes, limits={"density": (1.0, 20.0)}, window=(-5e-3, 5e-3, 4e-3), colour_bar=False)
    assert axes.collections[0].get_clim() == (1.0, 20.0)
    assert axes.get_xlim() == pytest.approx((-5, 5))
    assert axes.get_ylim() == pytest.approx((-4, 4))
    assert len(axes.figure.axes) == 1


def test_a_section_has_a_figure_of_its_own_where_none_is_given(shot):
    from matplotlib import pyplot

    before = pyplot.get_backend()
    pyplot.switch_backend("agg")
    try:
        axes = shot.section("material")
        assert axes.figure.number in pyplot.get_fignums()
        assert axes.figure is not shot.section("material").figure
    finally:
        pyplot.close("all")
        pyplot.switch_backend(before)


def test_pandas_has_units_and_the_regime_in_words(shot):
    pytest.importorskip("pandas")
    frame = shot.to_pandas()
    assert frame.index.name == "time"
    assert frame.index[-1] == shot.history["time"][-1]
    assert frame["penetration_depth_m"].iloc[-1] == shot.history["penetration_depth_m"][-1]
    assert frame.attrs["units"]["rod_tail_velocity_m_s"] == "m/s"
    assert set(frame.attrs["units"]) == {"time", *frame.columns}
    assert list(frame["regime"].iloc[[0, -1]]) == ["rigid", "deforming"]


def test_a_regime_that_was_not_known_is_missing(tmp_path, shot):
    pytest.importorskip("pandas")
    columns = history.History(shot.directory / "history.h5", rows=2)
    columns.append({"time": 1.0})
    columns.write()
    assert hydro2d.open_run(shot.directory).to_pandas()["regime"].isna().tolist() == [False, False, True]


def test_xarray_has_units(shot):
    pytest.importorskip("xarray")
    data = shot.to_xarray()
    assert data["rod_length_m"].dims == ("time",)
    assert (data["rod_length_m"].attrs["units"], data["time"].attrs["units"]) == ("m", "s")
    assert data["regime"].attrs["flag_meanings"] == "rigid deforming eroding left_the_mesh"


def test_a_run_says_what_it_is(shot):
    text = shot._repr_html_()
    for said in ("a rod that meets a plate", "the stop time was reached at 20.", "20.0 mm long, deforming", "12.1 mm",
                 "5, the last at 20.", "<table>"):
        assert said in text
    assert str(shot.directory.parent) not in text
    assert re.fullmatch(rf"<Results {shot.label}: the stop time was reached at 20\.\d\d µs, depth 20\.0 mm>", repr(shot))


def test_titles_are_escaped(shot):
    shot.tables["title"] = "<b>1 & 2</b>"
    assert "&lt;b&gt;1 &amp; 2&lt;/b&gt;" in shot._repr_html_()


@pytest.mark.parametrize(("directory", "label"), [
    ("1086m-s", "1086 m/s"), ("1086 m-s", "1086 m/s"), ("1.3km-s_soft", "1.3 km/s_soft"), ("ke_1086m-s-2", "ke_1086 m/s-2"),
    ("m-s", "m-s"), ("5083-1086", "5083-1086"), ("12m-seconds", "12m-seconds"), ("form-s", "form-s")])
def test_velocities_in_names_of_directories_have_their_slash_back(shot, directory, label):
    shot.directory = shot.directory.parent / directory
    assert shot.label == label


def test_a_run_that_has_not_ended_says_so(shot):
    (shot.directory / "summary.json").unlink()
    (shot.directory / "series.pvd").unlink()
    opened = hydro2d.open_run(shot.directory)
    assert repr(opened) == f"<Results {shot.label}: has not ended>"
    assert "<th>dumps</th><td>none</td>" in opened._repr_html_()
    assert "<th>depth</th>" not in opened._repr_html_()


def test_a_name_that_no_result_has_is_an_error(shot):
    """Never a silent None: as an attribute, as a key, within a table, and before the run has ended."""
    assert shot.summary["outcome"]["depth_m"] == shot.summary.outcome.depth_m
    assert shot.summary["provenance"]["models"] == []
    for summary in (shot.summary, hydro2d.Summary()):
        with pytest.raises(KeyError, match='unknown result "penetration_dept_m"; did you mean "penetration_depth_m"'):
            summary["penetration_dept_m"]
        for wrong in ("penetration_dept_m", "get"):
            with pytest.raises(AttributeError, match=wrong):
                getattr(summary, wrong)
        assert "penetration_dept_m" not in summary
        assert "penetration_depth_m" in summary
    with pytest.raises(KeyError, match="depth_mm"):
        shot.summary["outcome"]["depth_mm"]
    with pytest.raises(KeyError, match="plat"):
        shot.summary.bodies["plat"]


def test_a_run_that_has_not_ended_has_a_summary_that_is_false(shot):
    assert shot.summary
    (shot.directory / "summary.json").unlink()
    assert not hydro2d.open_run(shot.directory).summary
    assert hydro2d.open_run(shot.directory).summary.penetration_depth_m is None


def test_a_deck_without_a_rod_says_nothing_of_one(shot):
    nothing = dict.fromkeys(("penetration_depth_m", "rod_length_m", "regime"))
    shot.summary = shot.summary.model_copy(update=nothing)
    assert "<th>rod</th>" not in shot._repr_html_()
    assert "depth" not in repr(shot)


def test_the_message_on_a_study_names_its_reader(simulation, tmp_path):
    for name in ("a", "b"):
        start(fake.FakeDeck(), tmp_path / "folder" / name, quiet=True)
    with pytest.raises(ResultsError, match="it has no deck.toml; it holds runs: a, b$"):
        hydro2d.open_run(tmp_path / "folder")
    (tmp_path / "folder" / study_directory.STUDY).write_text("{}")
    with pytest.raises(ResultsError, match="it is a study, whose runs are in .*/cases; .*hydro2d.open_study reads it"):
        hydro2d.open_run(tmp_path / "folder")
    with pytest.raises(ResultsError, match="it has no deck.toml$"):
        hydro2d.open_run(tmp_path / "nothing")


def test_a_dump_has_middles_and_outlines(shot):
    dump = shot.dump(0.0)
    assert dump.r_centres[:2] == pytest.approx([0.5e-3, 1.5e-3])
    assert dump.z_centres.shape == dump.fields["Material"].shape[:1]
    (line,) = dump.outlines("rod")
    assert line[:, 0].max() == pytest.approx(fake.RADIUS, abs=1e-6)
    assert np.ptp(line[:, 1]) == pytest.approx(fake.LENGTH, abs=1e-6)
    with pytest.raises(vtk.VtkError, match='did you mean "rod"'):
        dump.outlines("rot")
