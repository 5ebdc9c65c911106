"""Pictures in three dimensions: they are rendered, or a message says why not."""

import pytest

from hydro2d.results import cutaway
from hydro2d.results.reading import Results
from hydro2d.results.scales import FigureError


def test_cutaway_or_a_clear_error(finished, tmp_path):
    """Where nothing can be rendered, a message says so and no file is left behind."""
    said = ""
    try:
        cutaway.draw(Results(finished).dump_file(), tmp_path / "cut.png")
    except FigureError as error:
        said = str(error)
    assert "could not be rendered" in said or (tmp_path / "cut.png").read_bytes()[:4] == b"\x89PNG"
    assert {path.name for path in tmp_path.iterdir()} <= {"cut.png", "shot"}


def test_cutaway_tells_a_wrong_field(finished, tmp_path):
    with pytest.raises(FigureError, match="did you mean"):
        cutaway.draw(Results(finished).dump_file(), tmp_path / "cut.png", "presure")
