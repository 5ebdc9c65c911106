"""Figures show their subject, or a message says why they cannot."""

from dataclasses import replace

import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.output.outlines import Filling
from hydro2d.output.vtk import Dump
from hydro2d.results import figures
from hydro2d.results.reading import Results
from hydro2d.results.scales import FigureError
from hydro2d.running.check import check
from tests import fake
from tests.decks import box, mesh, stop, table


@pytest.fixture
def dump():
    sim = fake.Simulation(fake.FakeDeck())
    for _ in range(60):
        sim.step()
    return Dump.of(sim)


def test_a_section_is_mirrored_and_in_readers_units(dump):
    figure = figures.draw_sections([[(dump, "", 0.0121)]], "pressure")
    axes = figure.axes[0]
    upper, lower = (mesh.get_array() for mesh in axes.collections[:2])
    np.testing.assert_array_equal(upper, lower)
    assert axes.get_ylim() == pytest.approx((-12, 12))
    assert figure.axes[-1].get_ylabel() == "Pressure [GPa]"
    shown = figures.chosen(dump, "pressure").values
    filled = dump.fields["Material"] > 0
    np.testing.assert_allclose(shown[filled], dump.fields["Pressure [Pa]"][filled] * 1e-9)
    assert np.isnan(shown[~filled]).all()


def pixel(axes, z_mm, r_mm):
    """The colour that a drawn figure has at a place, as a matplotlib colour."""
    axes.figure.canvas.draw()
    picture = np.asarray(axes.figure.canvas.buffer_rgba())
    column, row = axes.transData.transform((z_mm, r_mm)).astype(int)
    return tuple(picture[len(picture) - 1 - row, column, :3] / 255.0)


def test_void_has_a_colour_that_no_pressure_has(dump):
    """Of the mesh alone: beyond it a panel stays white, as a pressure of zero is drawn."""
    from matplotlib.colors import to_rgb

    z0, r1 = dump.z_edges[0], dump.r_edges[-1]
    axes = figures.draw_sections([[(dump, "", None)]], "pressure", window=(z0 - 5e-3, dump.z_edges[-1], r1 + 3e-3)).axes[0]
    empty = np.argwhere(~dump.filling(None).shown)
    j, i = empty[len(empty) // 2]
    for sign in (1, -1):
        assert pixel(axes, 1e3 * dump.z_centres[j], sign * 1e3 * dump.r_centres[i]) == pytest.approx(to_rgb(figures.VOID))
    assert pixel(axes, 1e3 * z0 - 3.0, 5.0) == pytest.approx((1.0, 1.0, 1.0))


def labels(dump, field, mirror):
    """Labels of the colour bars, and the title and place of the legend if there is one."""
    axes, *bars = figures.draw_sections([[(dump, "", None)]], field, mirror).axes
    legend = axes.get_legend()
    said = () if legend is None else (legend.get_title().get_text(), legend._loc)
    return [bar.get_ylabel() for bar in bars], *said


def test_a_colour_bar_says_which_half_it_belongs_to(dump):
    right = {"upper": 1, "lower": 4}
    assert labels(dump, "pressure", "velocity") == (["Upper half: Pressure [GPa]", "Lower half: Velocity [m/s]"],)
    assert labels(dump, "pressure", "material") == (["Upper half: Pressure [GPa]"], "Lower half", right["lower"])
    assert labels(dump, "material", "pressure") == (["Lower half: Pressure [GPa]"], "Upper half", right["upper"])
    assert labels(dump, "pressure", None) == (["Pressure [GPa]"],)
    assert labels(dump, "material", None) == ([], "", right["upper"])


def test_the_word_at_the_experiments_line_is_not_below_the_legend(dump):
    for field, mirror, place in (("pressure", None, "top"), ("pressure", "material", "top"), ("material", None, "bottom")):
        axes = figures.draw_sections([[(dump, "", 0.0121)]], field, mirror).axes[0]
        (word,) = axes.texts
        assert (word.get_text(), word.get_va()) == ("experiment", place)
        if legend := axes.get_legend():
            axes.figure.draw_without_rendering()
            assert not legend.get_window_extent().overlaps(word.get_window_extent())


@pytest.mark.parametrize("part", ["rr", "zz", "tt", "rz"])
def test_a_total_stress_that_was_not_written_is_made_of_deviator_and_pressure(dump, part):
    written = figures.chosen(dump, f"stress_{part}")
    del dump.fields[f"Stress {part} [Pa]"]
    made = figures.chosen(dump, f"stress_{part}")
    np.testing.assert_allclose(made.values, written.values, rtol=1e-6, atol=1e-3)
    assert made.label == written.label


@pytest.mark.parametrize("part", ["rr", "zz", "tt"])
def test_the_old_name_of_a_deviator_is_reported_where_the_total_stress_cannot_be_made(dump, part):
    del dump.fields[f"Stress {part} [Pa]"]
    del dump.fields["Pressure [Pa]"]
    with pytest.raises(FigureError, match=f"up to version 0.3, stress_{part} was the name of deviator_{part}"):
        figures.chosen(dump, f"stress_{part}")
    assert figures.chosen(dump, f"deviator_{part}").label.startswith(f"Deviatoric Stress {part} ")


@pytest.mark.parametrize(
    ("start", "inner", "mirrored"),
    [("0 mm", "wall", True), ("0 mm", "outflow", False), ("-6 mm", "wall", False), ("2 mm", "wall", False)],
)
def test_a_planar_section_is_mirrored_at_a_plane_of_symmetry_alone(tmp_path, start, inner, mirrored):
    text = (mesh((start, "12 mm", "1 mm"), ("30 mm", "1 mm"), geometry="planar") + table("boundaries", r_min=inner)
            + box("bar", "Al5083", r=["-3 mm", "4 mm"], z=["5 mm", "20 mm"]) + stop("1 us"))
    checked = check(decks.loads(text))
    axes = figures.draw_sections([[(checked.dump, "", None)]], "material").axes[0]
    low = -12.0 if mirrored else float(start.split()[0])
    assert axes.get_ylim() == pytest.approx((low, 12.0))
    *meshes, lines = axes.collections
    assert len(meshes) == (2 if mirrored else 1)
    assert len(lines.get_segments()) == (2 if mirrored else 1) * len(checked.dump.outlines("bar"))
    picture = tmp_path / "start.png"
    (tmp_path / "deck.toml").write_text(text)
    assert call(["check", str(tmp_path / "deck.toml"), "--picture", str(picture)]) == 0
    assert picture.read_bytes()[:4] == b"\x89PNG"


def test_both_sides_of_a_planar_mesh_are_seen_and_set_the_range(dump):
    whole = replace(dump, r_edges=dump.r_edges - 6e-3, mirrored=False)
    axes = figures.draw_sections([[(whole, "", None)]], "material", window=(0.0, 0.01, 4e-3)).axes[0]
    assert axes.get_ylim() == pytest.approx((-4.0, 4.0))
    part = figures.cropped(whole, (0.0, 0.01, 4e-3))
    np.testing.assert_allclose(part.r_edges[[0, -1]], [-4e-3, 4e-3])
    assert not part.mirrored
    with pytest.raises(FigureError, match="no second half"):
        figures.draw_sections([[(whole, "", None)]], "pressure", mirror="density")


def test_a_run_says_whether_it_is_mirrored_and_has_an_axis(finished, tmp_path, capsys):
    assert Results(finished).dump().mirrored
    deck = finished / "deck.toml"
    text = deck.read_text().partition("\n")[2]  # the first line is the checksum of the file as it was
    deck.write_text(text + '[mesh]\ngeometry = "planar"\nr_start = -0.01\n[boundaries]\nr_min = "wall"\n')
    assert not Results(finished).dump().mirrored
    assert call(["plot", str(finished), "-o", str(tmp_path / "x.png"), "--mirror", "density"]) == 2
    assert call(["plot", str(finished), "-o", str(tmp_path / "x.png"), "--kind", "cutaway"]) == 2
    assert "no axis" in capsys.readouterr().err
    assert not (tmp_path / "x.png").exists()


def test_the_experiment_is_a_line_at_its_depth(dump):
    axes = figures.draw_sections([[(dump, "", 0.0121)]], "pressure").axes[0]
    assert any(line.get_xdata()[0] == pytest.approx(12.1) for line in axes.lines)


def test_a_line_outside_of_the_window_does_not_stretch_the_figure(dump, tmp_path, recwarn):
    figures.save_figure(figures.draw_sections([[(dump, "", 0.5)]], "pressure", "velocity"), tmp_path / "x.png")
    assert not [each for each in recwarn if "layout" in str(each.message)]


def test_panels_share_their_colours(dump):
    other = Dump(dump.r_edges, dump.z_edges, {n: 2 * v for n, v in dump.fields.items()} | {
        n: v for n, v in dump.fields.items() if n.startswith("Vol") or n == "Material"}, 0.0)
    figure = figures.draw_sections([[(dump, "", None)], [(other, "", None)]], "von_mises")
    limits = {mesh.get_clim() for axes in figure.axes[:2] for mesh in axes.collections[:2]}
    assert len(limits) == 1


def test_a_window_decides_the_range(dump):
    whole = figures.draw_sections([[(dump, "", None)]], "pressure")
    part = figures.draw_sections([[(dump, "", None)]], "pressure", window=(0.0, 5e-3, 3e-3))
    assert part.axes[0].get_xlim() == (0, 5)
    assert part.axes[0].collections[0].get_clim() != whole.axes[0].collections[0].get_clim()
    with pytest.raises(FigureError, match="no part of the mesh"):
        figures.draw_sections([[(dump, "", None)]], "pressure", window=(1.0, 2.0, 1.0))


@pytest.mark.parametrize(
    "word", ["velocity", "velocity:z", "body_temperature:plate", "volume_fraction:rod", "material"]
)
def test_words(dump, word):
    figures.draw_sections([[(dump, "", None)]], word, mirror="density")


@pytest.mark.parametrize(
    ("word", "said"),
    [("presure", 'did you mean "pressure"'), ("body_density", "write body_density:NAME"), ("body_density:rd", '"rod"'),
     ("pressure:r", "only velocity"), ("velocity:x", "velocity:r")],
)
def test_wrong_words(dump, word, said):
    with pytest.raises(FigureError, match=said):
        figures.chosen(dump, word)


def test_a_field_that_was_not_written(dump):
    del dump.fields["Damage"]
    with pytest.raises(FigureError, match="output.fields"):
        figures.chosen(dump, "damage")


def test_runs_side_by_side(finished, tmp_path):
    runs = [Results(finished), Results(finished)]
    figure = figures.sections(runs, "density", mirror="material", times=[5e-6, None])
    assert len([axes for axes in figure.axes if axes.get_title()]) == 4
    figures.save_figure(figure, tmp_path / "x.png")
    assert (tmp_path / "x.png").read_bytes()[:4] == b"\x89PNG"


def test_histories(finished, tmp_path):
    figure = figures.histories([Results(finished)], ["penetration_depth_m", "rod_length_m", "dt"])
    depth = figure.axes[0].lines
    assert depth[0].get_ydata()[-1] == pytest.approx(20, rel=0.02)
    assert depth[1].get_ydata()[0] == pytest.approx(12.1)
    assert figure.axes[0].get_ylabel() == "penetration depth [mm]"
    with pytest.raises(FigureError, match='did you mean "rod_length_m"'):
        figures.histories([Results(finished)], ["rod_lenght_m"])


def test_formats(dump, tmp_path):
    figure = figures.draw_sections([[(dump, "", None)]], "density")
    figures.save_figure(figure, tmp_path / "x.pdf")
    assert (tmp_path / "x.pdf").read_bytes()[:4] == b"%PDF"
    with pytest.raises(FigureError, match="picture format"):
        figures.save_figure(figure, tmp_path / "x.docx")
    with pytest.raises(FigureError, match="no such directory"):
        figures.save_figure(figure, tmp_path / "none" / "x.png")


def test_outline_of_a_disc():
    edges = np.linspace(0, 1, 41)
    centres = 0.5 * (edges[1:] + edges[:-1])
    r, z = np.meshgrid(centres, centres - 0.5)
    (line,) = Filling(edges, edges, 1 / (1 + np.exp((np.hypot(r, z) - 0.3) * 50))).outlines()
    np.testing.assert_allclose(np.hypot(line[:, 0], line[:, 1] - 0.5), 0.3, atol=0.02)
    assert sorted(line[[0, -1], 0]) == [0, 0]


def test_closed_outline_follows_the_boundary():
    edges = np.linspace(0, 1, 11)
    (line,) = Filling(edges, edges, np.ones((10, 10))).outlines(closed=True)
    assert line[:, 0].max() == pytest.approx(1, abs=1e-5)
    assert (line[:, 1].min(), line[:, 1].max()) == pytest.approx((0, 1), abs=1e-5)
    assert Filling(edges, edges, np.ones((10, 10))).outlines() == []
