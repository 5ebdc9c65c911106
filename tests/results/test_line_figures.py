"""Line-outs, space-time diagrams, pictures of debris, and colour scales."""

import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.output.outlines import Filling
from hydro2d.results import figures, line_figures
from hydro2d.results.line_figures import Line
from hydro2d.results.reading import Results
from hydro2d.results.scales import FigureError, Scale
from tests.results import made_run


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return Results(made_run.write(tmp_path_factory.mktemp("lines") / "run", dumps=4))


def test_a_line_along_z_has_each_cell_once(run):
    dump = run.dump()
    *_, along, values = line_figures.curve(run, dump, "pressure", Line(1e-3, -1.0, 1e-3, 1.0))
    inside = (along > dump.z_edges[0]) & (along < dump.z_edges[-1])
    np.testing.assert_allclose(along[inside], 0.5 * (dump.z_edges[1:] + dump.z_edges[:-1]))
    column = int(np.searchsorted(dump.r_edges, 1e-3, "right")) - 1
    np.testing.assert_array_equal(values[inside], figures.chosen(dump, "pressure").values[:, column])
    assert np.isnan(values[~inside]).all()


def test_a_line_across_has_the_cells_that_it_crosses(run):
    dump = run.dump()
    line = Line(0.0, -5e-3, 4e-3, 5e-3)
    *_, along, curve = line_figures.curve(run, dump, "velocity:z", line)
    assert line.label == "distance"
    assert 0.0 < along[0] < along[-1] < np.hypot(4e-3, 10e-3)
    values = figures.chosen(dump, "velocity:z").values
    for share, value in zip(along / np.hypot(4e-3, 10e-3), curve, strict=True):
        j = int(np.searchsorted(dump.z_edges, -5e-3 + share * 10e-3, "right")) - 1
        i = int(np.searchsorted(dump.r_edges, share * 4e-3, "right")) - 1
        assert value == values[j, i] or np.isnan(value) and np.isnan(values[j, i])


def test_line_outs_have_a_curve_for_each_time(run):
    figure = line_figures.line_outs([run], "pressure", times=(0.0, 40e-6))
    (axes,) = figure.axes
    assert [line.get_label() for line in axes.lines] == ["0.00 µs", "40.00 µs"]
    assert axes.get_xlabel() == "z [mm]"
    assert axes.get_yscale() == "linear"
    assert line_figures.line_outs([run], "temperature", scale=Scale(log=True)).axes[0].get_yscale() == "log"


def test_a_diagram_of_place_and_time_follows_the_nose(run):
    """The nose is at 1 km/s times the time, so the slope of its outline is that velocity."""
    along, times, values, bodies, label = line_figures._panel(run, "pressure", Line(1e-3, -1e-3, 1e-3, 60e-3))
    assert values.shape == (4, line_figures.POINTS) == bodies[0].shape
    assert label == "Pressure [GPa]"
    noses = [along[np.nonzero(row >= 0.5)[0][-1]] if (row >= 0.5).any() else 0.0 for row in bodies[0]]
    np.testing.assert_allclose(noses, 1e3 * times, atol=2.5e-3)  # a cell there is 3 mm
    figure = line_figures.space_time([run], "pressure")
    assert len(figure.axes) == 2


def test_requests_that_cannot_be_drawn_are_reported(run, tmp_path):
    with pytest.raises(FigureError, match="misses the mesh"):
        line_figures.curve(run, run.dump(), "pressure", Line(1.0, 0.0, 1.0, 1.0))
    single = Results(made_run.write(tmp_path / "one", dumps=1))
    with pytest.raises(FigureError, match="has 1 dumps; a diagram of place and time needs at least two"):
        line_figures.space_time([single], "pressure")
    with pytest.raises(FigureError, match="no values of pressure lie on the line"):
        line_figures.space_time([run], "pressure", Line(1.0, 0.0, 1.0, 1.0))


def test_scales_clip_and_are_logarithmic():
    values = np.arange(1.0, 1001.0)
    assert Scale().limits([values]) == (1.0, 1000.0)
    assert Scale(clip=1.0).limits([values]) == (pytest.approx(10.99), pytest.approx(990.01))
    assert Scale().limits([np.array([-2.0, 1.0])]) == (-2.0, 2.0)
    assert Scale(log=True).limits([np.array([-2.0, 0.0, 1e-12, 10.0])]) == (pytest.approx(1e-5), 10.0)
    assert Scale().limits([np.array([np.nan])]) == (0.0, 1.0)
    assert Scale(log=True).drawn((1.0, 10.0))["norm"](10.0**0.5) == pytest.approx(0.5)
    for wrong, said in ((lambda: Scale(clip=50.0), "between 0 and 50"), (lambda: Scale(colours="jett"), 'did you mean "jet"'),
                        (lambda: Scale(log=True).limits([-values]), "has none"),
                        (lambda: Scale(log=True).drawn((-1.0, 1.0)), "begins above 0")):
        with pytest.raises(FigureError, match=said):
            wrong()


def test_regions_have_holes_and_reach_the_edges():
    r, z = np.linspace(0.0, 1.0, 41), np.linspace(0.0, 2.0, 81)
    zc, rc = np.meshgrid(0.5 * (z[1:] + z[:-1]), 0.5 * (r[1:] + r[:-1]), indexing="ij")
    distance = np.hypot(rc, zc - 1.0)
    ((points, codes),) = Filling(r, z, np.clip((distance - 0.3) / 0.05 + 0.5, 0.0, 1.0)).regions()
    from matplotlib.path import Path

    path = Path(points, codes)
    inside = path.contains_points(np.column_stack([rc.ravel(), zc.ravel()])).reshape(rc.shape)
    assert (inside == (distance > 0.3))[np.abs(distance - 0.3) > 0.03].all()
    assert Filling(r, z, np.zeros((80, 40))).regions() == []


def test_colours_end_at_the_outlines():
    """Half a cell beyond the outline is background, even where the cell next to it is filled by more than half."""
    r, z = np.linspace(0.0, 10e-3, 11), np.linspace(0.0, 20e-3, 21)
    fraction = np.zeros((20, 10))
    fraction[:10], fraction[10] = 1.0, 0.7
    dump = figures.Dump(time=0.0, r_edges=r, z_edges=z, mirrored=True, fields={
        "Volume Fraction for bar": fraction, "Material": (fraction >= 0.5).astype(int), "Pressure [Pa]": 1e9 * (fraction > 0)})
    axes = figures.own_axes(dump)
    (_, image), _ = figures.section(axes, dump, "pressure")
    path = image.get_clip_path().get_fully_transformed_path()
    edge = axes.transData.inverted().transform(path.vertices)[:, 0].max()
    assert 10.2 < edge < 11.0
    assert np.isfinite(np.ma.filled(image.get_array(), np.nan).reshape(10, 20)[:, 11]).all()  # drawn on, and cut


def test_pictures_have_no_empty_margin(tmp_path):
    from matplotlib.image import imread

    directory = made_run.write(tmp_path / "run", dumps=2, shape=(12, 40))
    assert call(["plot", str(directory), "-o", str(tmp_path / "a.png"), "--field", "material"]) == 0
    white = (imread(tmp_path / "a.png")[..., :3] > 0.99).all(axis=2)
    for empty in (white.all(axis=0), white.all(axis=1)):
        assert np.argmin(empty) < 40
        assert np.argmin(empty[::-1]) < 40


def test_debris_are_drawn(run, monkeypatch):
    """Mass in bins of speed and of angle, the last angle with mass, and one dot for each fragment."""
    debris = {"body": np.array(["rod", "plate"]), "speed_edges_m_s": np.linspace(0.0, 1000.0, 5),
              "mass_by_speed_kg": np.array([[0.0, 1e-3], [0.0, 2e-3], [0.0, 0.0], [5e-3, 0.0]]),
              "angle_edges_rad": np.linspace(0.0, np.pi, 5), "mass_by_angle_kg": np.array([[5e-3, 3e-3], *[[0.0, 0.0]] * 3]),
              "fragment_mass_kg": np.array([5e-3, 2e-3, 1e-3])}
    monkeypatch.setattr(Results, "debris", {"plate": debris})
    speed, angle, fragments = line_figures.debris([run]).axes
    assert [patch.get_data().values.sum() for patch in speed.patches] == [pytest.approx(5.0), pytest.approx(3.0)]
    assert angle.get_xlim() == (0.0, 45.0)
    assert fragments.lines[0].get_xydata().tolist() == [[5.0, 1.0], [2.0, 2.0], [1.0, 3.0]]
    monkeypatch.setattr(Results, "debris", {"plate": {**debris, "body": np.array([])}})
    with pytest.raises(FigureError, match="nothing flies behind a target"):
        line_figures.debris([run])


def test_the_command_draws_debris_and_refuses_options_of_other_kinds(run, tmp_path, capsys):
    for arguments, said in ((["--kind", "crater", "--log"], "are for --kind section, line and xt"),
                            (["--kind", "section", "--line", "0,0,0,1"], "--line is for --kind line and xt"),
                            (["--kind", "line", "--line", "0,0,0,0"], "expected two points"),
                            (["--kind", "xt", "--map", "nothing"], "unknown colour map"),
                            (["--kind", "debris"], "has no debris")):
        assert call(["plot", str(run.directory), "-o", str(tmp_path / "x.png"), *arguments]) == 2
        assert said in capsys.readouterr().err
    for kind in ("line", "xt"):
        assert call(["plot", str(run.directory), "-o", str(tmp_path / f"{kind}.png"), "--kind", kind, "--clip", "1", "--line",
                     "1 mm,-1 cm,1 mm,3 cm"]) == 0
        assert (tmp_path / f"{kind}.png").stat().st_size > 5000
