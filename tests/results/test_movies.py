"""Films: a frame for every dump, one range of colours, a window that travels, and refusals."""

import sys

import numpy as np
import pytest
from PIL import Image

from hydro2d.cli.main import call
from hydro2d.results import figures, movies
from hydro2d.results.reading import Results


def frames(path) -> list[np.ndarray]:
    with Image.open(path) as film:
        images = []
        for number in range(film.n_frames):
            film.seek(number)
            images.append(np.asarray(film.convert("RGB")).copy())
        return images


@pytest.fixture
def limits(monkeypatch):
    """The ranges of colours and the windows of the frames."""
    seen, draw = [], figures.draw_sections

    def noted(panels, field, mirror, window, ranges, figure):
        seen.append((dict(ranges), [window(dump) for row in panels for dump, _, _ in row], [len(row) for row in panels]))
        return draw(panels, field, mirror, window, ranges, figure)

    monkeypatch.setattr(figures, "draw_sections", noted)
    return seen


def test_a_frame_for_every_dump(finished, tmp_path, limits, capsys):
    film = tmp_path / "film.gif"
    assert call(["movie", str(finished), "-o", str(film), "--field", "plastic_strain", "--mirror", "material"]) == 0
    count = len(Results(finished).dumps)
    assert f"{count} frames" in capsys.readouterr().out
    images = frames(film)
    assert len(images) == count > 3
    assert {frame.shape for frame in images} == {images[0].shape}
    assert (images[0] != images[-1]).any()
    assert all(ranges == limits[0][0] for ranges, _, _ in limits)
    assert limits[0][0]["plastic_strain"][1] == pytest.approx(2.0, rel=0.2)
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == ["film.gif"]


def test_the_window_travels_with_the_body(finished, tmp_path, limits):
    run = Results(finished)
    assert movies.film([run], tmp_path / "film.gif", "density", window=(-0.01, 0.005, 0.01), follow="rod") == len(run.dumps)
    ends = np.array([windows[0][1] - 0.005 for _, windows, _ in limits])
    times = np.array([time for time, _ in run.dumps])
    assert ends == pytest.approx(1000.0 * times, abs=1e-3)


def test_several_runs_and_a_given_range(finished, tmp_path, limits):
    runs = [Results(finished), Results(finished)]
    movies.film(runs, tmp_path / "a.gif", "density", limits=(0.0, 20.0), beside=True)
    assert limits[0][0]["density"] == (0.0, 20.0)
    assert limits[0][2] == [2]
    movies.film(runs, tmp_path / "b.gif", "density")
    assert limits[-1][2] == [1, 1]


def test_mp4(finished, tmp_path):
    movies.film([Results(finished)], tmp_path / "film.mp4", "material")
    assert (tmp_path / "film.mp4").read_bytes()[4:8] == b"ftyp"


def test_without_ffmpeg_the_message_names_the_cure(finished, tmp_path, monkeypatch, capsys):
    from matplotlib import animation

    monkeypatch.setattr(animation.FFMpegWriter, "isAvailable", classmethod(lambda _: False))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert call(["movie", str(finished), "-o", str(tmp_path / "film.mp4")]) == 2
    assert "pip install 'hydro2d[movie]'" in capsys.readouterr().err
    assert not any(path.is_file() for path in tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["-o", "x.avi"], "unknown film format"),
        (["-o", "missing/x.gif"], "no such directory"),
        (["-o", "x.gif", "--follow", "rod"], "needs a window"),
        (["-o", "x.gif", "--follow", "rot", "--window", "0,1 m,1 m"], 'did you mean "rod"'),
        (["-o", "x.gif", "--field", "presure"], 'did you mean "pressure"'),
        (["-o", "x.gif", "--colours", "2,1"], "low must be less than high"),
        (["-o", "x.gif", "--colours", "red"], "two numbers"),
        (["-o", "x.gif", "--rate", "0"], "rate"),
    ],
)
def test_refused_movies(finished, tmp_path, monkeypatch, capsys, arguments, said):
    monkeypatch.chdir(tmp_path)
    assert call(["movie", str(finished), *arguments]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "x.gif").exists()


def test_plot_says_what_makes_a_film(finished, tmp_path, capsys):
    assert call(["plot", str(finished), "-o", str(tmp_path / "x.gif")]) == 2
    assert "hydro2d movie RUN -o x.gif" in capsys.readouterr().err
